"""Tasks shared out over the ranks, and their results gathered on rank 0."""

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from .. import ranks

#: Most parts that a rank may have computed before rank 0 takes them in.
AHEAD = 4

_Task = TypeVar("_Task")
_Part = TypeVar("_Part")


def shared_out(tasks: Sequence[_Task], solve: Callable[[_Task], Iterator[_Part]]) -> Iterator[_Part]:
    """Parts of all tasks, on rank 0 only, which works too and takes in the others' results.

    Without mpirun it solves them one after the other, without MPI. Collective over MPI's world.
    Nobody is more than ``AHEAD`` parts ahead of rank 0, so memory stays bounded.

    Args:
        tasks: ordered by their cost, so that all ranks get as much to do.
        solve: parts of a task, none of them None.
    """
    if ranks.size() == 1:
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
