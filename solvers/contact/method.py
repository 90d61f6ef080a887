"""Protocols of methods: a method answers each task of a plan, a speed, with a solver of states."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, Protocol

from numpy.typing import NDArray

from .solution import Solution, Task

#: σ_YY over N/(2a) at positions X over a under the punch.
ContactStress = Callable[[NDArray], NDArray]


class Solver(Protocol):
    """Solver of friction states at one speed."""

    def states(self, g: NDArray) -> Solution:
        """Solve the states with values g of σ_XY/σ_YY, (states,), under the load of the task's body.

        The solvers of a method whose kind has ``loads`` take a second argument, ``load``: the load of
        each state [N/m], (states,), or None for the task's.

        Raises:
            SolveError: the states could not be solved.
        """

    def record(self) -> dict[str, Any]:
        """Numbers of the work done, by the names of ``quantities.runs.RECORD``; may be empty."""


class Method(Protocol):
    """A way to solve the contact, for one plan.

    The ``begin()`` of a method that has it is called once, collectively over all ranks, before speeds are
    shared out over the ranks.
    """

    def at(self, task: Task, g: NDArray) -> AbstractContextManager[Solver]:
        """A solver at one speed.

        Args:
            task: the speed.
            g: all values of σ_XY/σ_YY that will be solved, sorted.

        Raises:
            SolveError: the equations could not be solved there.
        """
