"""Rank and number of ranks, and tasks shared out over them; MPI is imported where there are several."""

import os
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from typing import TypeVar

#: Variables in which Open MPI, MPICH and Slurm give every rank its number and the number of ranks.
_RANKS = ("OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK")
_SIZES = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE")
#: Most parts that a rank may have computed before rank 0 takes them in.
AHEAD = 4

_Task = TypeVar("_Task")
_Part = TypeVar("_Part")


def from_environment() -> tuple[int, int]:
    """Rank and number of ranks by the environment, which may be that of another program."""
    rank, size = (
        next((int(os.environ[name]) for name in names if os.environ.get(name, "").isdecimal()), default)
        for names, default in ((_RANKS, 0), (_SIZES, 1))
    )
    return rank, size


@lru_cache(maxsize=1)
def _rank_and_size() -> tuple[int, int]:
    """Rank and number of ranks by MPI, which is imported only where the environment speaks of it."""
    if by_mpirun():
        try:
            from mpi4py import MPI
        except ImportError:
            return 0, 1
        return MPI.COMM_WORLD.rank, MPI.COMM_WORLD.size
    return 0, 1


def size() -> int:
    """Number of ranks that mpirun started, 1 without it."""
    return _rank_and_size()[1]


def by_mpirun() -> bool:
    """Return True if this process looks as if mpirun had started it, perhaps alone."""
    return any(name in os.environ for name in (*_RANKS, *_SIZES))


def rank() -> int:
    """Number of this rank, 0 without mpirun."""
    return _rank_and_size()[0]


def is_root() -> bool:
    """True on the one rank that prints and writes."""
    return rank() == 0


def abort(status: int) -> None:
    """End all ranks at once: one that fails alone would leave the others waiting for ever."""
    from mpi4py import MPI

    MPI.COMM_WORLD.Abort(status)


def shared_out(tasks: Sequence[_Task], solve: Callable[[_Task], Iterator[_Part]]) -> Iterator[_Part]:
    """Parts of all tasks, on rank 0 only, which works too and takes in the others' results.

    Without mpirun it solves them one after the other, without MPI. Collective over MPI's world.
    Nobody is more than ``AHEAD`` parts ahead of rank 0, so memory stays bounded.

    Args:
        tasks: ordered by their cost, so that all ranks get as much to do.
        solve: parts of a task, none of them None.
    """
    if size() == 1:
        for task in tasks:
            yield from solve(task)
        return
    from mpi4py import MPI

    world = MPI.COMM_WORLD
    mine = (part for task in tasks[world.rank :: world.size] for part in solve(task))
    if world.rank > 0:
        pending: list[MPI.Request] = []
        for part in mine:
            pending.append(world.issend(part, 0))
            if len(pending) > AHEAD:
                pending.pop(0).wait()
        MPI.Request.waitall([*pending, world.isend(None, 0)])
        return
    working, busy = world.size - 1, True
    while working or busy:
        if busy:
            own = next(mine, None)
            busy = own is not None
            if own is not None:
                yield own
        while working and (not busy or world.iprobe()):
            message = world.recv()
            if message is None:  # the last that a rank sends
                working -= 1
            else:
                yield message
