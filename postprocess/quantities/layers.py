"""Quantities of layered half-planes: the singular integral equation's, and those at interfaces."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE
from galinx.solvers.contact.solution import SOLVED
from galinx.solvers.contact.stresses import extreme
from galinx.solvers.parameters import Range

from .quantity import (
    ALONG,
    BESIDE,
    CONTACT,
    EDGE,
    FEM,
    INTERFACE,
    OVER_A,
    POINT,
    QUANTITIES,
    SIE,
    STATE,
    X_OVER_A,
    Quantity,
)
from .stresses import components, extremes, invariants
from .validity import tensions


def _intensity(side: str, at: str, i: int) -> Quantity:
    return Quantity(
        f"states/sie/K_I_{side}", "1",
        f"normalised stress intensity factor at {at}, layered half-plane", (STATE,),
        lambda s, _: s.K_I[:, i], SIE, compared=("K_I of layers",), requires=(SOLVED,), scale=EDGE,
    )  # fmt: skip


K_I_LEFT = {SIE: _intensity("left", "X = -a", 0)}
K_I_RIGHT = {SIE: _intensity("right", "X = a", 1)}

ESTIMATE = Quantity(
    "states/sie/estimate", "1",
    "estimated relative error of K_I and pressure, by fewer unknowns and the kernel's error",
    (STATE,), lambda s, _: s.estimates[INTENSITIES], SIE,
    compared=("estimate of the integral equation",),
    range=Range(at_least=0.0), accuracy=True, requires=(SOLVED,),
)  # fmt: skip

PRESSURE = {
    SIE: Quantity(
        "surface/sie/sigma_YY", "N/(2a)", "contact stress, NaN outside the contact, layered half-plane",
        (STATE, POINT), lambda s, _: s.surface.σ_YY, SIE, asked_by=ON_SURFACE, nan_allowed=BESIDE,
        compared=("sigma_YY of layers",),
    )
}  # fmt: skip
IN_PLANE = {
    SIE: Quantity(
        "surface/sie/sigma_XX", "N/(2a)", "in-plane stress on the surface, layered half-plane",
        (STATE, POINT), lambda s, _: s.surface.σ_XX, SIE, asked_by=ON_SURFACE,
        compared=("sigma_XX of layers",),
    )
}  # fmt: skip

#: Word of output.quantities.

INTERFACE_DEPTH = Quantity(
    "interfaces/depth_over_a", "1", "depths of the interfaces over the half-width", (INTERFACE,),
    asked_by=AT_INTERFACES, range=Range(above=0.0), scale=OVER_A,
)  # fmt: skip
#: With free ends every state has its own half-width.
INTERFACE_DEPTH_IN_M = Quantity(
    "interfaces/depth", "m", "depths of the interfaces, where contacts have free ends", (INTERFACE,),
    asked_by=AT_INTERFACES, range=Range(above=0.0), scale=CONTACT,
)  # fmt: skip
#: Depths of interfaces by their unit.
DEPTHS = {row.unit: row for row in (INTERFACE_DEPTH, INTERFACE_DEPTH_IN_M)}
ALONG_X = Quantity(
    "interfaces/X_over_a", "1", "positions along interfaces over the half-width", (ALONG,),
    asked_by=AT_INTERFACES, scale=X_OVER_A,
)  # fmt: skip

_PARTS = {
    "sigma_YY": "normal traction",
    "sigma_XY": "shear traction",
    "sigma_XX_above": "in-plane stress above",
    "sigma_XX_below": "in-plane stress below",
}


def _along(method: str, i: int, name: str, what: str) -> Quantity:
    return Quantity(
        f"interfaces/{method}/{name}", "N/(2a)", f"{what} each interface", (STATE, INTERFACE, ALONG),
        lambda s, _: s.interfaces[i], method, asked_by=AT_INTERFACES,
        compared=("stresses at interfaces",) * (method == FEM),
    )  # fmt: skip


def _extremes(method: str, i: int, name: str, what: str) -> tuple[Quantity, ...]:
    """Quantities of the largest and the smallest value along each interface, with their places."""

    def quantity(end: str, sign: float, place: bool) -> Quantity:
        def read(s: Any, _: Any) -> NDArray[np.float64]:
            return extreme(s.interfaces[i], s.places.along, sign)[int(place)]

        word = {"max": "largest", "min": "smallest"}[end]
        path, over = f"interfaces/{method}/{name}_{end}", (STATE, INTERFACE)
        if place:
            about = f"place of the {word} {what} each interface, over the half-width"
            return Quantity(
                f"{path}_X_over_a", "1", about, over, read, method, asked_by=AT_INTERFACES, scale=X_OVER_A
            )
        about = f"{word} {what} each interface"
        return Quantity(path, "N/(2a)", about, over, read, method, asked_by=AT_INTERFACES)

    ends = (("max", 1.0), ("min", -1.0))
    return tuple(quantity(end, sign, place) for end, sign in ends for place in (False, True))


def _words(name: str, what: str) -> str:
    return what if "in-plane" in what else f"{what} at"


#: σ_YY, σ_XY, σ_XX above and below, by method.
INTERFACES = {
    method: tuple(
        _along(method, i, name, _words(name, what)) for i, (name, what) in enumerate(_PARTS.items())
    )
    for method in (SIE, FEM)
}
#: Extremes of the stresses at interfaces, by method.
INTERFACE_EXTREMES = {
    method: tuple(
        row
        for i, (name, what) in enumerate(_PARTS.items())
        for row in _extremes(method, i, name, _words(name, what))
    )
    for method in (SIE, FEM)
}


def _estimate(method: str, name: str, what: str, word: str, rule: str) -> Quantity:
    return Quantity(
        f"states/{method}/estimate_{name}", "1", f"estimated error of {what}", (STATE,),
        lambda s, _: s.estimates[word], method, asked_by=word, compared=(rule,),
        range=Range(at_least=0.0), accuracy=True,
    )  # fmt: skip


_ALONG = "stresses at interfaces over the largest along each, layered half-plane"
#: Estimates of stresses at interfaces, by method.
ESTIMATE_AT_INTERFACES = {
    method: _estimate(method, "interfaces", _ALONG, AT_INTERFACES, f"estimate at interfaces, {method}")
    for method in (SIE, FEM)
}
ESTIMATE_IN_PLANE = {
    SIE: _estimate(
        SIE, "sigma_XX", "sigma_XX on the surface over the larger of itself and its largest value "
        "further than 0.01 a from the edges, layered half-plane", ON_SURFACE, "estimate of sigma_XX, sie",
    )
}  # fmt: skip
ESTIMATE_INSIDE = {
    SIE: _estimate(
        SIE, "inside", "stresses inside over the larger of the largest there and further than 0.01 a "
        "from the edges, layered half-plane", BELOW, "estimate inside, sie",
    )
}  # fmt: skip

STRESSES_INSIDE = {SIE: components(SIE, "from the transform")}
INVARIANTS_INSIDE = {SIE: invariants(SIE)}

HIGHEST, HIGHEST_X, LOWEST, LOWEST_X = ({SIE: row} for row in extremes(SIE))
TENSION = {SIE: tensions(SIE)}

QUANTITIES.add_all(globals())
