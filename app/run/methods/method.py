"""What a method is: it answers each task of a plan, one speed, with a solver of friction states."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, NamedTuple, Protocol

from numpy.typing import NDArray

from galinx.solvers.solution import Solution

from ...plan.task import Task

#: σ_YY over N/(2a) at positions X over a under the punch.
Pressure = Callable[[NDArray], NDArray]


class Solver(Protocol):
    """Friction states at one speed."""

    def states(self, g: NDArray) -> Solution:
        """The states with these values of σ_XY/σ_YY, under the load of the task's body.

        A method that says so by ``loads`` takes a second argument, ``load``: that of each state [N/m],
        (states,), or None for the task's.

        Raises:
            SolveError: they could not be found.
        """

    def record(self) -> dict[str, Any]:
        """Numbers of the work that was done, by the names of ``quantities.runs.RECORD``; or none."""


class Method(Protocol):
    """A way to solve the contact, for one plan.

    One that has a ``begin()`` is asked, on all ranks together, for what serves all speeds before these
    are shared out over the ranks.
    """

    def at(self, task: Task, g: NDArray) -> AbstractContextManager[Solver]:
        """A solver at one speed.

        Args:
            task: the speed.
            g: all values of σ_XY/σ_YY that will be asked for, sorted.

        Raises:
            SolveError: the equations could not be solved there.
        """


class Mode(NamedTuple):
    """How finite elements solve one kind of contact at a speed.

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
