"""Start and end of a process, also where it is interrupted, and its line to a job of several ranks.

A rank has a line to the job that started it, see :mod:`galinx.app.job`: MPIs and their mpirun differ in
what they print, and in the status that they make of their ranks'. So ranks have the output and error
streams of the job itself, and report to it how they end.

A process is interrupted by Ctrl-C, by a batch system, or by a terminal that is closed.
"""

import json
import os
import signal
import socket
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import NoReturn

from galinx import files

from . import errors, ranks

#: Where the job listens; only what it starts has this variable.
VARIABLE = "GALINX_JOB"

_line: socket.socket | None = None


def join() -> None:
    """Join the job, if there is one, and take over its streams: its output on rank 0 only."""
    global _line
    name = os.environ.pop(VARIABLE, None)
    if name is None:
        return
    line = socket.socket(socket.AF_UNIX)
    try:
        line.connect(address(name))
    except OSError:  # a job of another time
        return
    _line = line
    ranks.trust_environment()
    _report(rank=ranks.rank())
    _, streams, *_ = socket.recv_fds(line, 1, 2)
    if not ranks.is_root():
        streams[0] = os.open(os.devnull, os.O_WRONLY)
    # Open MPI's own words stay with mpirun's: of a rank that was killed the others' libraries tell, too.
    os.environ["OPAL_OUTPUT_STDERR_FD"] = str(os.dup(2))
    for number, stream in zip((1, 2), streams):
        os.dup2(stream, number)


def address(name: str) -> str:
    """Address at which a job of that name listens: in Linux's own name space, so that no file is left."""
    return f"\0{name}"


def is_there() -> bool:
    """Return True if this process is a rank of a job."""
    return _line is not None


def _report(**report: int | str) -> None:
    if _line:
        with suppress(OSError):  # a job that is gone needs no answer
            _line.sendall(f"{json.dumps(report)}\n".encode())


SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
NOTHING = "nothing was written"
#: Seconds after which a process ends that has not ended in order: libraries drop exceptions.
_PATIENCE = 2
#: Seconds that other ranks leave to rank 0, where no job keeps order: if all fail alike it says so once,
#: and mpirun ends all.
_FIRST = 2.0

_leave: Callable[[], str] | None = None


class Interrupted(BaseException):
    """This process was interrupted. No KeyboardInterrupt: click would print an empty line."""


def listen() -> None:
    """Let signals end the process in order; an ignored signal, as nohup wants it, stays ignored."""
    for number in SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _on_signal)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)  # run.sh has them wait until here
    signal.signal(signal.SIGALRM, lambda *_: end_stopped(NOTHING))
    os.environ.setdefault("UCX_DEBUG_SIGNO", "0")  # a library of MPIs, which would take SIGHUP for itself


@contextmanager
def leaving(tidy: Callable[[], str], words: str) -> Iterator[None]:
    """Context for work that is finished part by part: interrupted there, the process ends at once.

    No exception is raised: it would meet HDF5 or MPI at work, or a destructor that drops it.

    Args:
        tidy: tidies up, and returns the sentence on the finished work.
        words: the sentence that the job prints where the process is killed.
    """
    global _leave
    _leave = tidy
    _report(left=words)
    try:
        yield
    finally:
        _leave = None


def too_late() -> None:
    """Ignore interruptions from now on: the work that remains is done in a moment."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def end_stopped(words: str) -> NoReturn:
    """End an interrupted process, and print the sentence on its finished work."""
    files.give_up()
    if is_there():
        _report(left=words)
    elif ranks.from_environment()[0] == 0:
        erase_bar()
        with suppress(OSError):  # below Python's stream, which the signal may have met at work
            os.write(2, f"error: interrupted; {words}\n".encode())
    os._exit(errors.FAILURE)


def erase_bar() -> None:
    """Restore a terminal on which a bar showed the progress, cursor included."""
    if os.isatty(2):
        os.write(2, b"\r\x1b[2K\x1b[?25h")


def finish(status: int, message: str = "") -> None:
    """Report to the job the status with which this rank ends, and why, which the job prints."""
    too_late()
    _report(status=status, words=message)


def fail(status: int, message: str) -> None:
    """Print once why the process is about to end, on whichever ranks it is about to."""
    finish(status, message)
    if not is_there():
        if ranks.from_environment()[0] > 0:
            time.sleep(_FIRST)
        complain(message)


def complain(message: str) -> None:
    """Print why the work ended."""
    with suppress(OSError):
        print(f"error: {message}", file=sys.stderr, flush=True)


def _on_signal(*_: object) -> None:
    too_late()
    if _leave:
        end_stopped(_leave())
    if ranks.from_environment()[0] > 0:  # rank 0 says what there is to say
        end_stopped(NOTHING)
    signal.alarm(_PATIENCE)
    raise Interrupted
