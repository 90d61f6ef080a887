"""What the command line knows of MPI without importing it."""

import os


def _from_environment(*names: str) -> int | None:
    for name in names:
        if name in os.environ:
            return int(os.environ[name])
    return None


def size() -> int:
    """Number of ranks that mpirun started, 1 without it."""
    return _from_environment("OMPI_COMM_WORLD_SIZE", "PMI_SIZE") or 1


def by_mpirun() -> bool:
    """Was this process started by mpirun, though perhaps alone?"""
    return _from_environment("OMPI_COMM_WORLD_SIZE", "PMI_SIZE") is not None


def rank() -> int:
    """Number of this rank, 0 without mpirun."""
    return _from_environment("OMPI_COMM_WORLD_RANK", "PMI_RANK") or 0


def is_root() -> bool:
    """True on the one rank that prints and writes."""
    return rank() == 0


def abort(status: int) -> None:
    """End all ranks at once: one that fails alone would leave the others waiting for ever."""
    from mpi4py import MPI

    MPI.COMM_WORLD.Abort(status)
