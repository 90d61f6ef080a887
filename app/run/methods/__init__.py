"""Methods that solve the contact, by the name that scenes use.

What only one method needs is imported when that is made for a plan.
"""

from galinx.app.console.progress import Progress
from galinx.app.errors import finite_elements_installed
from galinx.app.plan.fem import DOLFINX, TENSOR
from galinx.app.plan.task import Plan
from galinx.app.run.methods.method import Method, MethodKind
from galinx.app.scene.scene import Scene
from galinx.clock import Clock
from galinx.postprocess.quantities import Quantity, states, strata, stresses, validity, yielding
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, PUNCH, SIE
from galinx.registry import Registry
from galinx.solvers.profiles import exponent, smooth
from galinx.solvers.solution import Body

__all__ = ["METHODS", "MODES", "Method", "MethodKind"]


def _closed_form(plan: Plan, progress: Progress, clock: Clock) -> Method:
    from galinx.app.run.methods.closed_form import ClosedForm, with_given_ends

    if plan.body.found:
        from galinx.app.run.methods.found_ends import FoundPunches

        return ClosedForm(FoundPunches)
    return ClosedForm(with_given_ends)


def _layers(plan: Plan, progress: Progress, clock: Clock) -> Method:
    from galinx.app.run.methods.on_layers import Layers

    return Layers(plan.tolerance)


def _layers_refusal(scene: Scene, body: Body, quantity: Quantity | None) -> str:
    if not body.layered:
        return "the solid has no layers, and closed_form knows the solution"
    if body.pressure and quantity in _INTENSITIES_OF_LAYERS:
        return "the pressure is given"
    return _of_found_ends(body, quantity) or _without_σ_ZZ(body, quantity)


def _without_σ_ZZ(body: Body, quantity: Quantity | None) -> str:
    """Why von Mises is not told."""
    asked = any(quantity is invariants[-1] for invariants in stresses.INVARIANTS_INSIDE.values())
    return "σ_ZZ is not known without solid.stiffness_Z" if asked and not body.solid.knows_σ_ZZ else ""


def _of_found_ends(body: Body, quantity: Quantity | None) -> str:
    """Why a contact whose ends are found has no such quantity, "" where it has."""
    if not body.found or quantity is None:
        return ""
    if quantity.asked_by == stresses.YIELD and not body.finite:
        return "stresses are infinite at a sharp edge or a tip, and any load makes these yield"
    if quantity in yielding.FIRST_LOAD.values() and not (exponent(body.profile) or 0.0) > 1.0:
        return "known where the height is a power of |X|: the contact grows with the load"
    if quantity.mode == PUNCH or quantity in _OF_SHARP_EDGES:
        return "the ends of the contact are found"
    return ""


#: What is told of two sharp edges alone.
_OF_SHARP_EDGES = (states.K_I_BOTH, states.FITTED_ALPHA, states.FITTED_BETA, *validity.STRAINED)


def _closed_form_refusal(scene: Scene, body: Body, quantity: Quantity | None) -> str:
    if body.layered:
        return "the solid has layers, and no closed form"
    if body.found:
        return _of_found_ends(body, quantity) or _without_σ_ZZ(body, quantity)
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
_INTENSITIES_OF_LAYERS = (*strata.K_I_LEFT.values(), *strata.K_I_RIGHT.values(), strata.ESTIMATE)
_INTENSITIES = (
    states.RESIDUAL[CLOSED_FORM],
    states.K_I_BOTH,
    states.K_I_LEFT[CLOSED_FORM],
    states.K_I_RIGHT[CLOSED_FORM],
)


def _finite_elements(plan: Plan, progress: Progress, clock: Clock) -> Method:
    with clock("import of dolfinx"), finite_elements_installed():
        from galinx.app.run.methods.fem import FiniteElements

        return FiniteElements(plan, progress, clock)


def _of_layers(scene: Scene, body: Body, quantity: Quantity | None) -> str:
    """Why finite elements do not give a quantity of layers, "" where they do."""
    if body.solid.nearly_incompressible:
        return "a solid is nearly incompressible; the integral equation takes such layers"
    if scene.solve.degree or scene.solve.mesh != "confocal":
        return "layers have meshes of their own: no mesh, and no degree"
    if body.found and not (body.free and smooth(body.profile)):
        return (
            "over layers meshes follow contacts of smooth punches with two free ends alone; sie takes all"
        )
    if quantity is None:
        return ""
    if quantity is states.RESIDUAL[FEM]:
        return "the equation of layers is a method of its own, sie"
    if quantity is states.INDENTATION:
        return "the far boundary moves with the load"
    if body.found and quantity is stresses.RAW_PRESSURE:
        return "σ_YY itself is that of the nodal forces there"
    if not body.flat and quantity is states.SLOPE:
        return "the punch is not flat"
    return _of_found_ends(body, quantity) or _without_σ_ZZ(body, quantity)


def _finite_elements_refusal(scene: Scene, body: Body, quantity: Quantity | None) -> str:
    if body.layered:
        return _of_layers(scene, body, quantity)
    if body.found and not smooth(body.profile):
        if quantity is None and (scene.solve.mesh != "confocal" or scene.solve.degree):
            return 'such a contact needs meshes of its own: mesh = "confocal", and no degree'
        if quantity is stresses.RAW_PRESSURE:
            return "σ_YY itself is that of the nodal forces there"
    if why := _of_found_ends(body, quantity):
        return why
    if quantity is states.RESIDUAL[FEM] and scene.solve.mode == "traction":
        return "the pressure is put in"
    if quantity is states.SLOPE and (body.pressure or not body.flat):
        return "the pressure is given" if body.pressure else "the punch is not flat"
    return _without_σ_ZZ(body, quantity)


METHODS: Registry[MethodKind] = Registry(
    "method",
    {
        CLOSED_FORM: MethodKind("closed form", _closed_form, _closed_form_refusal, loads=True),
        SIE: MethodKind("singular integral equation of layers", _layers, _layers_refusal, of_layers=True),
        FEM: MethodKind(
            "mesh and finite elements", _finite_elements, _finite_elements_refusal, loads=True
        ),
    },
    MethodKind,
)

#: What the finite elements may be given: a punch, or the pressure under it.
MODES = ("contact", "traction")

#: Assemblers of their matrices: element matrices by tensor products, or dolfinx's own.
ASSEMBLERS = (TENSOR, DOLFINX)
