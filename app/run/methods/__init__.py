"""Methods that solve the contact, by the name that scenes use.

What only one method needs is imported when that is made for a plan.
"""

from galinx.app.console.progress import Progress
from galinx.app.errors import finite_elements_installed
from galinx.app.plan.task import Plan
from galinx.app.run.methods.method import Method, MethodKind
from galinx.app.scene.scene import Scene
from galinx.clock import Clock
from galinx.postprocess.quantities import Quantity, states, stresses, validity
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.registry import Registry
from galinx.solvers.solution import Body

__all__ = ["METHODS", "MODES", "Method", "MethodKind"]


def _closed_form(plan: Plan, progress: Progress, clock: Clock) -> Method:
    from galinx.app.run.methods.closed_form import ClosedForm

    return ClosedForm()


def _without_σ_ZZ(body: Body, quantity: Quantity | None) -> str:
    """Why von Mises is not told."""
    asked = any(quantity is invariants[-1] for invariants in stresses.INVARIANTS_INSIDE.values())
    return "σ_ZZ is not known without solid.stiffness_Z" if asked and not body.solid.knows_σ_ZZ else ""


def _closed_form_refusal(scene: Scene, body: Body, quantity: Quantity | None) -> str:
    if body.pressure:
        return "the pressure is given" if quantity in _INTENSITIES else ""
    if quantity and not body.flat and quantity.asked_by in (stresses.BELOW, stresses.YIELD):
        return "known below flat punches only"
    if quantity and not body.flat and quantity is states.K_I_BOTH:
        return "the two ends differ"
    if quantity and not body.flat and quantity in validity.STRAINED:
        return "known of flat punches only"
    return _without_σ_ZZ(body, quantity)


#: What only a punch has.
_INTENSITIES = (states.K_I_BOTH, states.K_I_LEFT[CLOSED_FORM], states.K_I_RIGHT[CLOSED_FORM])


def _finite_elements(plan: Plan, progress: Progress, clock: Clock) -> Method:
    with clock("import of dolfinx"), finite_elements_installed():
        from galinx.app.run.methods.fem import FiniteElements

        return FiniteElements(plan, progress, clock)


def _finite_elements_refusal(scene: Scene, body: Body, quantity: Quantity | None) -> str:
    if quantity is states.SLOPE and (body.pressure or not body.flat):
        return "the pressure is given" if body.pressure else "the punch is not flat"
    return _without_σ_ZZ(body, quantity)


METHODS: Registry[MethodKind] = Registry(
    "method",
    {
        CLOSED_FORM: MethodKind("closed form", _closed_form, _closed_form_refusal),
        FEM: MethodKind("mesh and finite elements", _finite_elements, _finite_elements_refusal),
    },
)

#: What the finite elements may be given: a punch, or the pressure under it.
MODES = ("contact", "traction")
