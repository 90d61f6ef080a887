"""Methods that solve the contact, by the name that scenes use: titles, and quantities they refuse.

Scenes and plans need nothing else of methods; :mod:`galinx.app.run.make` makes them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from galinx.postprocess.quantities import Quantity, layers, states, stresses, validity, yielding
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, PUNCH, SIE
from galinx.registry import Registry
from galinx.solvers.contact import YIELD
from galinx.solvers.contact.solution import Body
from galinx.solvers.profiles import exponent, smooth


@dataclass(frozen=True)
class MethodKind:
    """A method that scenes can name.

    Attributes:
        about: title in a plan.
        made: makes a :class:`galinx.solvers.contact.method.Method` for a plan, a progress and a clock;
            None for the methods of galinx itself, which :func:`galinx.app.run.make.make` makes.
        refusal: reason why it does not give a quantity of a scene and a body, "" where it does; for the
            quantity None the reason why it gives no quantity at all.
        loads: True where its solvers take states under several loads; else each load has its own solver.
        of_layers: True for a method of layered solids alone, which plans of uniform solids omit.
    """

    about: str
    made: Callable[[Any, Any, Any], Any] | None = None
    refusal: Callable[[Any, Body, Quantity | None], str] = lambda scene, body, quantity: ""
    loads: bool = False
    of_layers: bool = False


def _layers_refusal(scene: Any, body: Body, quantity: Quantity | None) -> str:
    if not body.layered:
        return "the solid has no layers, and closed_form knows the solution"
    if body.pressure and quantity in _INTENSITIES_OF_LAYERS:
        return "the pressure is prescribed"
    return _free_ends_refusal(body, quantity) or _without_σ_ZZ(body, quantity)


def _without_σ_ZZ(body: Body, quantity: Quantity | None) -> str:
    """Reason why there is no von Mises stress, "" where there is."""
    needs_σ_ZZ = any(quantity is invariants[-1] for invariants in stresses.INVARIANTS_INSIDE.values())
    return (
        "σ_ZZ is not known without solid.stiffness_Z" if needs_σ_ZZ and not body.solid.knows_σ_ZZ else ""
    )


def _free_ends_refusal(body: Body, quantity: Quantity | None) -> str:
    """Reason why a contact with free ends has no such quantity, "" where it has."""
    if not body.found or quantity is None:
        return ""
    if quantity.asked_by == YIELD and not body.finite:
        return "stresses are infinite at a sharp edge or a tip, and any load makes these yield"
    if quantity in yielding.FIRST_LOAD.values() and not (exponent(body.profile) or 0.0) > 1.0:
        return "known where the height is a power of |X|: the contact grows with the load"
    if quantity.mode == PUNCH or quantity in _SHARP_EDGES_ONLY:
        return "the contact has free ends"
    return ""


#: Quantities of contacts with two sharp edges alone.
_SHARP_EDGES_ONLY = (states.K_I_BOTH, states.FITTED_ALPHA, states.FITTED_BETA, *validity.STRAINED)


def _closed_form_refusal(scene: Any, body: Body, quantity: Quantity | None) -> str:
    if body.layered:
        return "the solid has layers, and no closed form"
    if body.found:
        return _free_ends_refusal(body, quantity) or _without_σ_ZZ(body, quantity)
    if body.pressure:
        return "the pressure is prescribed" if quantity in _INTENSITIES else ""
    if quantity and not body.flat and quantity.asked_by in (stresses.BELOW, YIELD):
        return "known below flat punches only"
    if quantity and not body.flat and quantity is states.K_I_BOTH:
        return "the two ends differ"
    if quantity and not body.flat and quantity in validity.STRAINED:
        return "known of flat punches only"
    return _without_σ_ZZ(body, quantity)


#: Quantities that a prescribed pressure has not.
_INTENSITIES_OF_LAYERS = (*layers.K_I_LEFT.values(), *layers.K_I_RIGHT.values(), layers.ESTIMATE)
_INTENSITIES = (
    states.RESIDUAL[CLOSED_FORM],
    states.K_I_BOTH,
    states.K_I_LEFT[CLOSED_FORM],
    states.K_I_RIGHT[CLOSED_FORM],
)


def _fem_layers_refusal(scene: Any, body: Body, quantity: Quantity | None) -> str:
    """Reason why finite elements do not give a quantity of layers, "" where they do."""
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
    if quantity is states.RESIDUAL[FEM] and body.pressure:
        return "the pressure is prescribed"
    if quantity is states.INDENTATION:
        return "the far boundary moves with the load"
    if body.found and quantity is stresses.RAW_PRESSURE:
        return "σ_YY itself is that of the nodal forces there"
    if not body.flat and quantity is states.SLOPE:
        return "the punch is not flat"
    return _free_ends_refusal(body, quantity) or _without_σ_ZZ(body, quantity)


def _finite_elements_refusal(scene: Any, body: Body, quantity: Quantity | None) -> str:
    if body.layered:
        return _fem_layers_refusal(scene, body, quantity)
    if body.found and not smooth(body.profile):
        if quantity is None and (scene.solve.mesh != "confocal" or scene.solve.degree):
            return 'such a contact needs meshes of its own: mesh = "confocal", and no degree'
        if quantity is stresses.RAW_PRESSURE:
            return "σ_YY itself is that of the nodal forces there"
    if why := _free_ends_refusal(body, quantity):
        return why
    if quantity is states.RESIDUAL[FEM] and scene.solve.mode == "traction":
        return "the pressure is prescribed"
    if quantity is states.SLOPE and (body.pressure or not body.flat):
        return "the pressure is prescribed" if body.pressure else "the punch is not flat"
    return _without_σ_ZZ(body, quantity)


METHODS: Registry[MethodKind] = Registry(
    "method",
    {
        CLOSED_FORM: MethodKind("closed form", refusal=_closed_form_refusal, loads=True),
        SIE: MethodKind("singular integral equation of layers", refusal=_layers_refusal, of_layers=True),
        FEM: MethodKind("mesh and finite elements", refusal=_finite_elements_refusal, loads=True),
    },
    MethodKind,
)

#: Modes of the finite elements: a punch, or a prescribed pressure.
MODES = ("contact", "traction")
