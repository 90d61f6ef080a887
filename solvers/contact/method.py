"""Protocols of methods: a method answers each task of a plan, a speed, with a solver of states."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, NamedTuple, Protocol

from numpy.typing import NDArray

from .solution import Solution, Task

#: σ_YY over N/(2a) at positions X over a under the punch.
Pressure = Callable[[NDArray], NDArray]


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


class Mode(NamedTuple):
    """Functions and classes with which finite elements solve one kind of contact at a speed.

    Attributes:
        solver: context manager of a :class:`Solver`, by discretisation, task and frictions.
        one_state: context manager of the fields of a single state, by discretisation, task, friction and
            degree; None where there is none.
        level: solution at one degree, which a fit through speeds puts together; None where none does.
        at_speed: punches at a speed, by their ladder and error, that such a fit answers with.
    """

    solver: Callable[..., Any]
    one_state: Any = None
    level: Any = None
    at_speed: Any = None
