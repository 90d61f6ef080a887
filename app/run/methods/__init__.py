"""Methods that solve the contact, by the name that scenes use.

A method is made for a plan, and answers each of its tasks, one speed, with a solver of friction states.
What only one method needs is imported when that is made.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, Protocol

from numpy.typing import NDArray

from galinx.app.console.progress import Progress
from galinx.app.errors import finite_elements_installed
from galinx.app.plan.task import Plan, Task
from galinx.app.scene.scene import Scene
from galinx.clock import Clock
from galinx.postprocess.quantities import Quantity, states, stresses
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.registry import Registry
from galinx.solvers.solution import Body, Solution


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


@dataclass(frozen=True)
class MethodKind:
    """A method that scenes can name.

    Attributes:
        about: what a plan calls it.
        made: makes it for a plan.
        refusal: why it does not give a quantity of a scene and a body, "" where it does; of the quantity
            None: why it gives none at all.
    """

    about: str
    made: Callable[[Plan, Progress, Clock], Method]
    refusal: Callable[[Scene, Body, Quantity | None], str] = lambda scene, body, quantity: ""


def _closed_form(plan: Plan, progress: Progress, clock: Clock) -> Method:
    from galinx.app.run.methods.closed_form import ClosedForm

    return ClosedForm()


def _closed_form_refusal(scene: Scene, body: Body, quantity: Quantity | None) -> str:
    if scene.solve.own_pressure:
        return "the pressure is given"
    if quantity and not body.flat and quantity.asked_by == stresses.BELOW:
        return "known below flat punches only"
    if quantity and not body.flat and quantity is states.K_I_BOTH:
        return "the two ends differ"
    return ""


def _finite_elements(plan: Plan, progress: Progress, clock: Clock) -> Method:
    with clock("import of dolfinx"), finite_elements_installed():
        from galinx.app.run.methods.fem import FiniteElements

        return FiniteElements(plan, progress, clock)


def _finite_elements_refusal(scene: Scene, body: Body, quantity: Quantity | None) -> str:
    if quantity and not body.flat and quantity is states.SLOPE:
        return "the punch is not flat"
    return ""


METHODS: Registry[MethodKind] = Registry(
    "method",
    {
        CLOSED_FORM: MethodKind("closed form", _closed_form, _closed_form_refusal),
        FEM: MethodKind("mesh and finite elements", _finite_elements, _finite_elements_refusal),
    },
)

#: What the finite elements may be given: a punch, or the pressure under it.
MODES = ("contact", "traction")
