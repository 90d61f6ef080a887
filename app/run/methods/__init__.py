"""Methods that solve the contact, by the name that scenes use.

A method is made for a plan, and answers each of its tasks, one speed, with a solver of friction states.
What only one method needs is imported when that is made.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, Protocol

from numpy.typing import NDArray

from galinx.app.console.progress import Progress
from galinx.app.errors import finite_elements_installed
from galinx.app.plan.plan import Plan, Task
from galinx.clock import Clock
from galinx.registry import Registry
from galinx.solvers.solution import Solution


class Solver(Protocol):
    """Friction states at one speed."""

    def states(self, g: NDArray) -> Solution:
        """The states with these values of σ_XY/σ_YY.

        Raises:
            SolveError: they could not be found.
        """

    def record(self) -> dict[str, Any]:
        """Numbers of the work that was done, as ``postprocess.quantities.RECORD`` names them; or none."""


class Method(Protocol):
    """A way to solve the contact, for one plan."""

    def at(self, task: Task, g: NDArray) -> AbstractContextManager[Solver]:
        """A solver at one speed.

        Args:
            task: the speed.
            g: all values of σ_XY/σ_YY that will be asked for, sorted.

        Raises:
            SolveError: the equations could not be solved there.
        """


def _closed_form(plan: Plan, progress: Progress, clock: Clock) -> Method:
    from galinx.app.run.methods.closed_form import ClosedForm

    return ClosedForm()


def _finite_elements(plan: Plan, progress: Progress, clock: Clock) -> Method:
    with clock("import of dolfinx"), finite_elements_installed():
        from galinx.app.run.methods.fem import FiniteElements

        return FiniteElements(plan, progress, clock)


#: What makes a method for a plan, by the method's name.
METHODS: Registry[Callable[[Plan, Progress, Clock], Method]] = Registry(
    "method", {"closed_form": _closed_form, "fem": _finite_elements}
)
