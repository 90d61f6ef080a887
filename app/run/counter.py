"""A counter that all ranks share: who is free takes the next number."""

from collections.abc import Iterator

import numpy as np
from mpi4py import MPI


class Counter:
    """Numbers from 0, each given to one rank; collective to make and to free."""

    def __init__(self, comm: MPI.Comm) -> None:
        self._next = MPI.Win.Allocate(8 if comm.rank == 0 else 0, 8, comm=comm)
        if comm.rank == 0:
            np.frombuffer(self._next.tomemory(), dtype=np.int64)[:] = 0
        comm.barrier()

    def until(self, end: int) -> Iterator[int]:
        """This rank's numbers below ``end``."""
        one, got = np.ones(1, dtype=np.int64), np.empty(1, dtype=np.int64)
        while True:
            self._next.Lock(0)
            self._next.Fetch_and_op(one, got, 0)
            self._next.Unlock(0)
            if got[0] >= end:
                return
            yield int(got[0])

    def free(self) -> None:
        """End it, when every rank is done."""
        self._next.Free()
