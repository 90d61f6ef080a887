"""How a process begins, and ends where it is asked to stop; and the job of several ranks.

A rank's line to the job that started it, see :mod:`galinx.app.job`.

What MPIs and their mpirun say, and the status that it makes of its ranks', differs between them. So
ranks have the output and error streams of the job itself, and tell it how they end.

What a process does that is asked to stop: by Ctrl-C, a batch system, a terminal that is closed.
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
    """Join the job, if there is one, and take its streams for one's own: its output on rank 0 only."""
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
    _tell(rank=ranks.rank())
    _, streams, *_ = socket.recv_fds(line, 1, 2)
    if not ranks.is_root():
        streams[0] = os.open(os.devnull, os.O_WRONLY)
    # Open MPI's own words stay with mpirun's: of a rank that was killed the others' libraries tell, too.
    os.environ["OPAL_OUTPUT_STDERR_FD"] = str(os.dup(2))
    for number, stream in zip((1, 2), streams):
        os.dup2(stream, number)


def address(name: str) -> str:
    """Where a job of that name listens: in Linux's own space of names, so that no file is left."""
    return f"\0{name}"


def is_there() -> bool:
    """Is this a rank of a job?"""
    return _line is not None


def leave(words: str) -> None:
    """Whatever happens from now on, this is what there is to say of finished work."""
    _tell(left=words)


def interrupted() -> None:
    """This rank ends because it was asked to."""
    _tell(interrupted=True)


def end(status: int, words: str = "") -> None:
    """This rank ends with a status; ``words`` say why, which the job prints."""
    _tell(status=status, words=words)


def _tell(**told: int | str) -> None:
    if _line:
        with suppress(OSError):  # a job that is gone needs no answer
            _line.sendall(f"{json.dumps(told)}\n".encode())


SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
NOTHING = "nothing was written"
#: Seconds after which a process ends that has not ended in order: libraries drop exceptions.
_PATIENCE = 2
#: Seconds that other ranks leave to rank 0, where no job keeps order: if all fail alike it says so once,
#: and mpirun ends all.
_FIRST = 2.0

_leave: Callable[[], str] | None = None


class Asked(BaseException):
    """This process was asked to stop. No KeyboardInterrupt: click would print an empty line."""


def listen() -> None:
    """End in order when asked to; what is ignored already, as nohup wants it, stays ignored."""
    for number in SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _asked)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)  # run.sh has them wait until here
    signal.signal(signal.SIGALRM, lambda *_: end_stopped(NOTHING))
    os.environ.setdefault("UCX_DEBUG_SIGNO", "0")  # a library of MPIs, which would take SIGHUP for itself
    sys.unraisablehook = _dropped


@contextmanager
def leaving(tidy: Callable[[], str], words: str) -> Iterator[None]:
    """For a block that finishes work part by part: asked to stop, the process ends at once.

    No exception is raised: it would meet HDF5 or MPI at work, or a destructor that drops it.

    Args:
        tidy: tidies up, and returns what is said of the finished work.
        words: what is said of it where the process is killed.
    """
    global _leave
    _leave = tidy
    leave(words)
    try:
        yield
    finally:
        _leave = None


def too_late() -> None:
    """From now on the process is not stopped: what is left to do is done in a moment."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def end_stopped(words: str) -> NoReturn:
    """End a process that was asked to stop, and say what there is of its work."""
    files.give_up()
    if is_there():
        leave(words)
        interrupted()
    elif ranks.from_environment()[0] == 0:
        erase_bar()
        with suppress(OSError):  # below Python's stream, which the signal may have met at work
            os.write(2, f"error: interrupted; {words}\n".encode())
    os._exit(errors.FAILURE)


def erase_bar() -> None:
    """Leave a terminal as it was before a bar showed how far the work is, cursor included."""
    if os.isatty(2):
        os.write(2, b"\r\x1b[2K\x1b[?25h")


def finish(status: int, message: str = "") -> None:
    """Have this said of a process that is about to end: a job ends its ranks when one has failed."""
    too_late()
    end(status, message)


def fail(status: int, message: str) -> None:
    """Say once why the process is about to end, on whichever rank of all that it is about to."""
    finish(status, message)
    if not is_there():
        if ranks.from_environment()[0] > 0:
            time.sleep(_FIRST)
        complain(message)


def complain(message: str) -> None:
    """Say why the work ended."""
    with suppress(OSError):
        print(f"error: {message}", file=sys.stderr, flush=True)


def _dropped(exception: "sys.UnraisableHookArgs") -> None:
    """A library at work drops an exception: nothing is said of one that ends the process."""
    if not isinstance(exception.exc_value, Asked):
        sys.__unraisablehook__(exception)


def _asked(*_: object) -> None:
    too_late()
    if _leave:
        end_stopped(_leave())
    if ranks.from_environment()[0] > 0:  # rank 0 says what there is to say
        end_stopped(NOTHING)
    signal.alarm(_PATIENCE)
    raise Asked
