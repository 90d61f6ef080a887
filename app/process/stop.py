"""What a process does that is asked to stop: by Ctrl-C, a batch system, a terminal that is closed."""

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import NoReturn

from galinx import files
from galinx.app import errors, ranks
from galinx.app.process import link

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
    signal.signal(signal.SIGALRM, lambda *_: end(NOTHING))
    os.environ.setdefault("UCX_DEBUG_SIGNO", "0")  # a library of MPIs, which would take SIGHUP for itself
    sys.unraisablehook = _dropped


@contextmanager
def leaving(leave: Callable[[], str], words: str) -> Iterator[None]:
    """For a block that finishes work part by part: asked to stop, the process ends at once.

    No exception is raised: it would meet HDF5 or MPI at work, or a destructor that drops it.

    Args:
        leave: tidies up, and returns what is said of the finished work.
        words: what is said of it where the process is killed.
    """
    global _leave
    _leave = leave
    link.leave(words)
    try:
        yield
    finally:
        _leave = None


def too_late() -> None:
    """From now on the process is not stopped: what is left to do is done in a moment."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def end(words: str) -> NoReturn:
    """End a process that was asked to stop, and say what there is of its work."""
    files.give_up()
    if link.is_there():
        link.leave(words)
        link.interrupted()
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
    link.end(status, message)


def fail(status: int, message: str) -> None:
    """Say once why the process is about to end, on whichever rank of all that it is about to."""
    finish(status, message)
    if not link.is_there():
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
        end(_leave())
    if ranks.from_environment()[0] > 0:  # rank 0 says what there is to say
        end(NOTHING)
    signal.alarm(_PATIENCE)
    raise Asked
