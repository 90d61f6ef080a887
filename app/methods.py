"""Methods that solve the contact, by the name that scenes use: titles, and what they do not give.

Each is made for a plan, and imports its own libraries only then. What a contact has not, whatever the
method, it says itself: :attr:`galinx.solvers.contact.solution.Contact.lacks`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from galinx.postprocess.quantities import Quantity, states, stresses
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, SIE
from galinx.registry import Registry
from galinx.solvers.contact import BELOW, FREE_ENDS, OWN_PRESSURE, YIELD
from galinx.solvers.contact.fem_plan import (
    FREE_ON_LAYERS,
    OWN_MESHES,
    PRESCRIBED_ON_LAYERS,
    SHARP_ON_LAYERS,
    crowded_kinks,
)
from galinx.solvers.contact.solution import (
    FLAT,
    FREE,
    IN_PUNCH,
    ONE_FREE,
    PRESCRIBED,
    PUNCH,
    SHARP,
    SOLVED,
    Contact,
    Method,
)

from .errors import finite_elements_installed

#: Methods of galinx itself, the default of scenes: each solves what it can.
OWN_METHODS = (CLOSED_FORM, SIE, FEM)
#: Modes of the finite elements that scenes name: a punch, or a prescribed pressure.
CONTACT, TRACTION = MODES = ("contact", "traction")


@dataclass(frozen=True)
class MethodKind:
    """A method that scenes can name.

    Attributes:
        about: title in a plan.
        made: makes a :class:`galinx.solvers.contact.solution.Method` for a plan, a progress and a clock.
            MachineFailure says that a library is missing.
        refusal: reason why it does not give a quantity of a scene and a body, "" where it does; for the
            quantity None the reason why it gives no quantity at all.
        loads: True where its solvers take states under several loads; else each load has its own solver.
        of_layers: True for a method that serves uniform solids only where no other is named; their plans
            omit it.
    """

    about: str
    made: Callable[[Any, Any, Any], Method]
    refusal: Callable[[Any, Contact, Quantity | None], str] = lambda scene, body, quantity: ""
    loads: bool = False
    of_layers: bool = False


def _refusal(quantity: Quantity | None, body: Contact, lacks: dict[str, str]) -> str:
    """Reason why there is no quantity of a contact, "" where there is one, and for None.

    Args:
        quantity: the quantity.
        body: the contact.
        lacks: what its method does not give, with reasons, as in :attr:`Contact.lacks` or by a path.
    """
    if quantity is None:
        return ""
    reasons = body.lacks | lacks
    words = quantity.path, quantity.asked_by, *quantity.requires, quantity.mode
    return next((reasons[word] for word in words if word in reasons), "")


#: What the closed form does not give of punches with two sharp edges that are not flat.
_OF_FLAT_PUNCHES = {
    states.K_I_BOTH.path: "the two ends differ: K_I_left, K_I_right",
    BELOW: "known below flat punches with one friction only",
    YIELD: "known below flat punches with one friction only",
    PUNCH: "known of flat punches with one friction only",
}


def _closed_form_refusal(scene: Any, body: Contact, quantity: Quantity | None) -> str:
    if body.no_closed_form:
        return body.no_closed_form
    lacks = _OF_FLAT_PUNCHES if FLAT in body.lacks and body.ends == SHARP else {}
    if body.along:
        lacks = {word: why for word, why in lacks.items() if word != BELOW}
    return _refusal(quantity, body, lacks)


def _integral_equation_refusal(scene: Any, body: Contact, quantity: Quantity | None) -> str:
    if body.no_closed_form:
        return _refusal(quantity, body, {})
    if SOLVED in body.lacks or CLOSED_FORM in scene.solve.methods:
        return "the solid has no layers, and closed_form knows the solution"
    return _refusal(
        quantity, body, dict.fromkeys((BELOW, YIELD), "in a uniform solid closed_form gives it")
    )


#: Modes of the finite elements by the ends of a contact, on one mesh and on meshes of their own, without
#: and with layers.
_MODES = {
    SHARP: ((CONTACT, CONTACT), (SHARP_ON_LAYERS, SHARP_ON_LAYERS)),
    PRESCRIBED: ((OWN_PRESSURE, OWN_PRESSURE), (PRESCRIBED_ON_LAYERS, PRESCRIBED_ON_LAYERS)),
    FREE: ((FREE_ENDS, OWN_MESHES), (FREE_ON_LAYERS, FREE_ON_LAYERS)),
    ONE_FREE: ((FREE_ENDS, OWN_MESHES), (FREE_ON_LAYERS, FREE_ON_LAYERS)),
}
_RECOVERED = {stresses.RAW_PRESSURE.path: "σ_YY itself is that of the nodal forces there"}
_PRESCRIBED = {SOLVED: "the pressure is prescribed"}
#: What finite elements do not give in a mode, with the reason.
_LACKING = {
    TRACTION: _PRESCRIBED,
    OWN_PRESSURE: _PRESCRIBED | {FLAT: "the pressure is prescribed"},
    OWN_MESHES: _RECOVERED | {IN_PUNCH: "under kinks the other methods have the punch's stresses"},
    FREE_ON_LAYERS: _RECOVERED,
}


def fem_mode(scene: Any) -> str:
    """Mode of a scene's finite elements, see :class:`galinx.solvers.contact.fem_plan.FemPlan`."""
    body = scene.body
    mode = body.fem_mode or _MODES[body.ends][bool(scene.layers)][body.own_meshes]
    return scene.solve.mode if mode == CONTACT else mode


def _finite_elements_refusal(scene: Any, body: Contact, quantity: Quantity | None) -> str:
    mode, solve = fem_mode(scene), scene.solve
    other = SIE if body.no_closed_form else CLOSED_FORM
    if of_friction := crowded_kinks(body.friction_kinks):
        return f"friction has {of_friction}; {other} takes it"
    lacks = _LACKING.get(mode, {})
    if body.solid.nearly_incompressible:
        lacks = lacks | dict.fromkeys((BELOW, YIELD), "finite elements give none inside for ν > 0.49")
    if scene.elastic_punch and body.solid.nearly_incompressible:
        return "one of two elastic bodies is nearly incompressible; closed_form takes such bodies"
    if scene.layers:
        if body.solid.nearly_incompressible:
            return "a solid is nearly incompressible; the integral equation takes such layers"
        if solve.degree or solve.mesh != "confocal":
            return "layers have meshes of their own: no mesh, and no degree"
        lacks = lacks | {states.INDENTATION.path: "the far boundary moves with the load"}
    elif mode == OWN_MESHES and (solve.mesh != "confocal" or solve.degree):
        return 'such a contact needs meshes of its own: mesh = "confocal", and no degree'
    elif mode == OWN_MESHES and not quantity:
        ends = (body.loaded(of(scene.punch.loads)) for of in (min, max))
        crowded = [crowded_kinks(under.kinks_at_rest) for under in ends]  # type: ignore[attr-defined]
        if all(crowded):
            return f"the punch has {crowded[0]}; {other} takes it"
    return _refusal(quantity, body, lacks)


def _closed_form(plan: Any, progress: Any, clock: Any) -> Method:
    from galinx.solvers.contact.exact import ClosedForm

    return ClosedForm()


def _integral_equation(plan: Any, progress: Any, clock: Any) -> Method:
    from galinx.solvers.contact.exact import Layers

    return Layers(plan.tolerance)


def _finite_elements(plan: Any, progress: Any, clock: Any) -> Method:
    with clock("import of dolfinx"), finite_elements_installed():
        from galinx.solvers.fem.method import FiniteElements

        return FiniteElements(plan, progress, clock)


METHODS: Registry[MethodKind] = Registry(
    "method",
    {
        CLOSED_FORM: MethodKind("closed form", _closed_form, refusal=_closed_form_refusal, loads=True),
        SIE: MethodKind(
            "singular integral equation",
            _integral_equation,
            refusal=_integral_equation_refusal,
            of_layers=True,
        ),
        FEM: MethodKind(
            "mesh and finite elements", _finite_elements, refusal=_finite_elements_refusal, loads=True
        ),
    },
    MethodKind,
)
