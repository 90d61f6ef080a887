"""Start and end of a process: its streams, what the machine has to offer, signals, and why it ends.

A process is interrupted by Ctrl-C, by a batch system, or by a terminal that is closed. Under mpirun
rank 0 speaks for all; mpirun ends the other ranks where one fails, is killed or is interrupted.
"""

import fcntl
import io
import os
import resource
import signal
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any, NoReturn

from galinx import files

from . import errors, ranks
from .console import Output, for_people, on_terminal

#: Bytes of address space that finite elements need with all libraries; with less some wait for ever.
_ADDRESS_SPACE = 10**9

#: Least number of pieces of work for which another process is started.
_PIECES = 8

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
NOTHING = "nothing was written"

_leave: Callable[[], str] | None = None


class Interrupted(BaseException):
    """This process was interrupted. No KeyboardInterrupt: click would print an empty line."""


def begin() -> None:
    """Make the process ready: streams, signals, warnings; or end it where it could do nothing."""
    _open_streams()
    listen()
    _prepare_streams()
    if any(option.startswith("error") for option in sys.warnoptions):
        warnings.simplefilter("ignore")  # those of libraries are no errors of the user's
    _check_machine()


def _open_streams() -> None:
    """Open the null device for closed streams: the next file would get their number, and all output.

    An output that is open for reading only becomes the null device, too: where the error stream is
    closed, bash hands on its script under that number.
    """
    for number in range(3):
        try:
            flags = fcntl.fcntl(number, fcntl.F_GETFL)
        except OSError:
            # The lowest number that is free is this one.
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)
            continue
        if number > 0 and flags & os.O_ACCMODE == os.O_RDONLY:
            null = os.open(os.devnull, os.O_RDWR)
            os.dup2(null, number)
            os.close(null)


def _prepare_streams() -> None:
    """Encodings that lack a character write another."""
    encoding = sys.stdout.encoding if sys.stdout else "utf-8"  # there is none where it was closed
    below = io.BufferedWriter(Output(1, "w", closefd=False))
    sys.stdout = io.TextIOWrapper(below, encoding, errors="replace", line_buffering=os.isatty(1))
    stderr: Any = sys.stderr or os.fdopen(2, "w", encoding="utf-8", closefd=False)
    stderr.reconfigure(errors="replace")
    sys.stderr = stderr


def _check_machine() -> None:
    if sys.flags.optimize > 1:
        refuse(
            "Python leaves texts out that compilers of forms need; unset PYTHONOPTIMIZE, or set it to 1"
        )
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit != resource.RLIM_INFINITY and limit < _ADDRESS_SPACE:
        refuse(
            f"the address space is limited to {limit / 1e6:.0f} MB, expected at least "
            f"{_ADDRESS_SPACE / 1e6:.0f} MB; raise the limit (ulimit -v, in kB)"
        )
    try:
        os.environ["TMPDIR"] = tempfile.gettempdir()  # MPI ends the process where TMPDIR names none
    except OSError as error:
        refuse(f"{error.strerror}; set TMPDIR to a folder that can be written")
    if os.path.expanduser("~") == "~":
        refuse(
            f"no home folder is known: HOME is not set, and user {os.getuid()} has no entry in passwd; "
            "set HOME to a folder that can be written"
        )


def listen() -> None:
    """Let signals end the process in order; an ignored signal, as nohup wants it, stays ignored."""
    for number in SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _on_signal)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)  # run.sh has them wait until here
    signal.signal(signal.SIGALRM, lambda *_: end_stopped(NOTHING))
    os.environ.setdefault("UCX_DEBUG_SIGNO", "0")  # a library of MPIs, which would take SIGHUP for itself


@contextmanager
def leaving(tidy: Callable[[], str]) -> Iterator[None]:
    """Context for work that is finished part by part: interrupted there, the process ends at once.

    No exception is raised: it would meet HDF5 or MPI at work, or a destructor that drops it.

    Args:
        tidy: tidies up, and returns the sentence on the finished work.
    """
    global _leave
    _leave = tidy
    try:
        yield
    finally:
        _leave = None


def too_late() -> None:
    """Ignore interruptions from now on: the work that remains is done in a moment."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def _on_signal(*_: object) -> None:
    if ranks.from_environment()[0] > 0:  # as one that is killed: rank 0 cannot go on, and may hang
        files.give_up()
        os.kill(os.getpid(), signal.SIGKILL)
    too_late()
    if _leave:
        end_stopped(_leave())
    signal.alarm(2)  # seconds until it ends where it has not ended in order: libraries drop exceptions
    raise Interrupted


def end_stopped(words: str) -> NoReturn:
    """End an interrupted process, and print the sentence on its finished work."""
    files.give_up()
    if on_terminal():  # on which a bar may have shown the progress, without a cursor
        os.write(2, b"\r\x1b[2K\x1b[?25h")
    with suppress(OSError):  # below Python's stream, which the signal may have met at work
        os.write(2, f"error: interrupted; {words}\n".encode())
    os._exit(errors.FAILURE)


def side_by_side(work: Sequence[Callable[[], bytes]]) -> list[bytes]:
    """Do pieces of work, much of it by as many processes as there are cores, copies of this one.

    A copy waits for this process alone, and ends where that is no more. What a copy that fails or is
    killed leaves is done here, where it can be reported.
    """
    import multiprocessing  # most commands do without

    fork, cores = multiprocessing.get_context("fork"), len(os.sched_getaffinity(0))
    count = max(1, min(cores // ranks.from_environment()[1], len(work) // _PIECES))
    others = []
    for n in range(1, count):
        receiver, sender = fork.Pipe(duplex=False)
        others.append(receiver)
        fork.Process(target=_send, args=(work[n::count], sender, others), daemon=True).start()
        sender.close()
    done = {n: piece() for n, piece in enumerate(work) if n % count == 0}
    for n, receiver in enumerate(others, 1):
        for i in range(n, len(work), count):
            try:
                done[i] = receiver.recv_bytes()
            except EOFError:
                done[i] = work[i]()
    return [done[n] for n in range(len(work))]


def _send(work: Sequence[Callable[[], bytes]], sender: Any, receivers: Sequence[Any]) -> None:
    """Do work in a copy of a process, which answers for signals; then send it."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)
    for receiver in receivers:  # whose copies here would keep the pipes open
        receiver.close()
    with suppress(Exception):
        for data in [piece() for piece in work]:
            sender.send_bytes(data)


def refuse(message: str) -> NoReturn:
    """End with a failure that all ranks share."""
    complain(message)
    sys.exit(errors.FAILURE)


def complain(message: str) -> None:
    """Print why the process is about to end, once where all ranks are about to."""
    too_late()
    if ranks.from_environment()[0] > 0:
        time.sleep(3.0)  # for rank 0: if all fail alike it says so once, and mpirun ends all
    with suppress(OSError):
        print(for_people(f"error: {message}"), file=sys.stderr, flush=True)
