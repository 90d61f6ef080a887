"""A rank's line to the job that started it, see :mod:`galinx.app.process.job`.

What MPIs and their mpirun say, and the status that it makes of its ranks', differs between them. So
ranks have the output and error streams of the job itself, and tell it how they end.
"""

import json
import os
import socket
from contextlib import suppress

from galinx.app import ranks

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
