"""Rank and number of ranks for the command line, without importing MPI where there is only one
process."""

import os
from functools import lru_cache

#: Variables in which Open MPI, MPICH and Slurm give every rank its number and the number of ranks.
_RANKS = ("OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK")
_SIZES = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE")


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
