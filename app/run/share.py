"""Tasks shared out over the ranks: a free rank takes the next, by a counter that all ranks share."""

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray


class Counter:
    """Counter from 0 whose numbers each go to a single rank; collective to make and to free."""

    def __init__(self, comm: MPI.Comm) -> None:
        self._next = MPI.Win.Allocate(8 if comm.rank == 0 else 0, 8, comm=comm)
        if comm.rank == 0:
            np.frombuffer(self._next.tomemory(), dtype=np.int64)[:] = 0
        comm.barrier()

    def until(self, end: int) -> Iterator[int]:
        """Iterate over this rank's numbers below ``end``."""
        increment, number = np.ones(1, dtype=np.int64), np.empty(1, dtype=np.int64)
        while True:
            self._next.Lock(0)
            self._next.Fetch_and_op(increment, number, 0)
            self._next.Unlock(0)
            if number[0] >= end:
                return
            yield int(number[0])

    def free(self) -> None:
        """Free the counter, when every rank is done."""
        self._next.Free()


#: Most parts that a rank may have computed before rank 0 takes them in.
AHEAD = 4

_Task = TypeVar("_Task")
_Part = TypeVar("_Part")


def shared_out(tasks: Sequence[_Task], solve: Callable[[_Task], Iterator[_Part]]) -> Iterator[_Part]:
    """Parts of all tasks, on rank 0 only, which works too and takes in the others' results.

    Collective over MPI's world. Nobody is more than ``AHEAD`` parts ahead of rank 0, so memory stays
    bounded.

    Args:
        tasks: the dearest first: begun last, they would leave the other ranks waiting.
        solve: parts of a task, none of them None.
    """
    world = MPI.COMM_WORLD
    counter = Counter(world)
    mine = (part for i in counter.until(len(tasks)) for part in solve(tasks[i]))
    if world.rank > 0:
        pending: list[MPI.Request] = []
        for part in mine:
            pending.append(world.issend(part, 0))
            if len(pending) > AHEAD:
                pending.pop(0).wait()
        MPI.Request.waitall([*pending, world.isend(None, 0)])
    else:
        yield from _taken_in(world, mine)
    counter.free()


def _taken_in(world: MPI.Comm, mine: Iterator[_Part]) -> Iterator[_Part]:
    working, busy = world.size - 1, True
    while working or busy:
        if busy:
            part = next(mine, None)
            busy = part is not None
            if part is not None:
                yield part
        while working and (not busy or world.iprobe()):
            message = world.recv()
            if message is None:  # the last that a rank sends
                working -= 1
            else:
                yield message


def same_on_all(finished: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Broadcast of rank 0's finished states, (states,), to every rank."""
    return MPI.COMM_WORLD.bcast(finished)
