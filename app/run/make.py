"""Methods made for a plan: each imports its own libraries only then."""

from galinx.clock import Clock
from galinx.solvers.contact import CLOSED_FORM, FEM, SIE
from galinx.solvers.contact.method import Method

from ..console import Progress
from ..errors import finite_elements_installed
from ..methods import METHODS
from ..plan.task import Plan


def make(name: str, plan: Plan, progress: Progress, clock: Clock) -> Method:
    """Make the method of a name for a plan.

    Args:
        name: in :data:`galinx.app.methods.METHODS`.
        plan: the plan whose tasks the method will solve.
        progress: shows the work.
        clock: takes wall time by step.

    Raises:
        MachineFailure: a library that the method needs is missing.
    """
    return (METHODS[name].made or _OWN[name])(plan, progress, clock)


def _closed_form(plan: Plan, progress: Progress, clock: Clock) -> Method:
    from galinx.solvers.contact.exact import ClosedForm, ExactSolution

    return ClosedForm(ExactSolution)


def _layers(plan: Plan, progress: Progress, clock: Clock) -> Method:
    from galinx.solvers.contact.layered import Layers

    return Layers(plan.tolerance)


def _finite_elements(plan: Plan, progress: Progress, clock: Clock) -> Method:
    with clock("import of dolfinx"), finite_elements_installed():
        from galinx.solvers.fem.method import FiniteElements

        return FiniteElements(plan, progress, clock)


#: Methods of galinx itself, by name.
_OWN = {CLOSED_FORM: _closed_form, SIE: _layers, FEM: _finite_elements}
