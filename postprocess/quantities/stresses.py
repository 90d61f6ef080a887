"""Quantities of stresses on the surface and inside."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact import BELOW, ON_SURFACE, VARYING
from galinx.solvers.contact.solution import IN_PUNCH, OUT_OF_PLANE, ZZ_IN_PUNCH
from galinx.solvers.contact.stresses import principal, von_mises
from galinx.solvers.parameters import Range

from .quantity import (
    ALONE,
    BESIDE,
    CLOSED_FORM,
    FEM,
    INSIDE,
    LOCAL,
    NOT_NEGATIVE,
    OVER_A,
    POINT,
    QUANTITIES,
    SIE,
    STATE,
    X_OVER_A,
    Quantity,
    by_method,
    entry,
)

SURFACE_X = Quantity(
    "surface/X_over_a",
    "1",
    "position on the surface over the half-width",
    (POINT,),
    asked_by=ON_SURFACE,
    scale=X_OVER_A,
)
RATIO_ALONG = Quantity(
    "surface/g", "1", "sigma_XY/sigma_YY along the contact, NaN outside", (STATE, POINT),
    lambda s, body: np.where(s.places.under, body.ratio(s.g, s.places.X, s.half_width), np.nan),
    LOCAL, VARYING, ON_SURFACE, nan_allowed=BESIDE,
)  # fmt: skip
PRESSURE = by_method(
    "sigma_YY", "N/(2a)", "contact stress",
    lambda s, _: s.surface.σ_YY, {
        CLOSED_FORM: {"about": "contact stress, NaN outside the contact (Eq 55)"},
        FEM: {
            "about": "contact stress from Jacobi moments of the nodal forces, NaN outside the contact",
        },
        SIE: {"about": "contact stress, NaN outside the contact, layered half-plane"},
    }, "surface", over=(STATE, POINT), asked_by=ON_SURFACE, nan_allowed=BESIDE,
)  # fmt: skip
RAW_PRESSURE = Quantity(
    "surface/fem/sigma_YY_raw", "N/(2a)",
    "contact stress from the nodal forces through the mass matrix, NaN outside the contact",
    (STATE, POINT), lambda s, _: s.surface.raw, FEM, "contact", ON_SURFACE, nan_allowed=BESIDE,
)  # fmt: skip
IN_PLANE = by_method(
    "sigma_XX", "N/(2a)", "in-plane stress on the surface",
    lambda s, _: s.surface.σ_XX, {
        CLOSED_FORM: {"about": "in-plane stress on the surface (Eq 32)"},
        FEM: {},
        SIE: {"about": "in-plane stress on the surface, layered half-plane"},
    }, "surface", over=(STATE, POINT), asked_by=ON_SURFACE,
)  # fmt: skip

#: Distance over a from the middle up to which stresses along the surface are output.
FARTHEST = 5.0
_METHODS = (CLOSED_FORM, FEM, SIE)


def _extreme(end: str, what: str, i: int) -> tuple[dict[str, Quantity], dict[str, Quantity]]:
    """Quantities of the highest or the lowest in-plane stress, and of its place."""
    value = by_method(
        f"sigma_XX_{end}", "N/(2a)",
        f"{what} in-plane stress on the surface, as far as its positions go, free ends included, further "
        "than 0.01 a from sharp edges and 0.02 a from tips, where it is infinite",
        lambda s, _: s.extremes_in_plane[i][0], _METHODS, asked_by=ON_SURFACE,
    )  # fmt: skip
    place = by_method(
        f"sigma_XX_{end}_X_over_a", "1", f"place of the {what} in-plane stress, over the half-width",
        lambda s, _: s.extremes_in_plane[i][1], _METHODS, asked_by=ON_SURFACE, scale=X_OVER_A,
    )  # fmt: skip
    return value, place


HIGHEST, HIGHEST_X = _extreme("max", "highest", 0)
LOWEST, LOWEST_X = _extreme("min", "lowest", 1)


def estimate(word: str, name: str, **own: str) -> dict[str, Quantity]:
    """Estimates of the error of the stresses that a word of output.quantities asks for, by method.

    Args:
        word: the word.
        name: end of the quantity's name.
        own: what is estimated, in words, by method.
    """
    return by_method(
        f"estimate_{name}", "1", "", lambda s, _: s.estimates[word],
        {method: {"about": f"estimated error of {about}"} for method, about in own.items()},
        asked_by=word, range=NOT_NEGATIVE, accuracy=True,
    )  # fmt: skip


_FAR, _NOT_USED = "further than 0.01 a from the edges", "no closed form used"
_LAYERED = "layered half-plane"
ESTIMATE_IN_PLANE = estimate(
    ON_SURFACE,
    "sigma_XX",
    fem=f"sigma_XX on the surface over the larger of itself and its largest value {_FAR}, {_NOT_USED}",
    sie=f"sigma_XX on the surface over the larger of itself and its largest value {_FAR}, {_LAYERED}",
)
ESTIMATE_INSIDE = estimate(
    BELOW,
    "inside",
    fem=f"stresses inside over the larger of the largest there and {_FAR}, {_NOT_USED}",
    sie=f"stresses inside over the larger of the largest there and {_FAR}, {_LAYERED}",
)

RESIDUAL_INSIDE = Quantity(
    "states/closed_form/residual_inside", "1",
    "residual of stresses inside, their difference from sums of line loads at some of the points and "
    "that of their resultants at a depth from equilibrium, over the largest",
    (STATE,), lambda s, _: s.residual_inside, CLOSED_FORM, ALONE, BELOW, range=NOT_NEGATIVE,
    accuracy=True,
)  # fmt: skip

INSIDE_X = Quantity(
    "interior/X_over_a", "1", "positions inside, along the surface, over the half-width", (INSIDE,),
    asked_by=BELOW, scale=X_OVER_A,
)  # fmt: skip
INSIDE_Y = Quantity(
    "interior/Y_over_a", "1", "positions inside, outwards, over the half-width; negative", (INSIDE,),
    asked_by=BELOW, range=Range(at_most=0.0), scale=OVER_A,
)  # fmt: skip
MAP = Quantity(
    "interior/map", "1", "rows and columns of the grid that the first points inside form, by rows",
    ("2",), asked_by=BELOW, whole=True, range=Range(at_least=1.0),
)  # fmt: skip


_COMPONENTS = {
    "XX": "in-plane normal stress along X", "YY": "normal stress along Y", "XY": "shear stress",
}  # fmt: skip
_SOURCES = {
    CLOSED_FORM: "from the potentials", FEM: "from the displacement", SIE: "from the transform",
}  # fmt: skip
#: σ_XX, σ_YY, σ_XY inside, by method.
STRESSES_INSIDE = {
    method: tuple(
        Quantity(
            f"interior/{method}/sigma_{ij}", "N/(2a)", f"{what} inside, {source}", (STATE, INSIDE),
            entry(lambda s: s.inside, i), method, asked_by=BELOW,
        )
        for i, (ij, what) in enumerate(_COMPONENTS.items())
    )
    for method, source in _SOURCES.items()
}  # fmt: skip

#: Names of invariants, their meaning, how they are read, and what they require.
_INVARIANTS: tuple[tuple[str, str, Callable[[Any, Any], NDArray], tuple[str, ...]], ...] = (
    ("sigma_1", "larger principal stress in the plane", lambda s, _: principal(*s.inside)[0], ()),
    ("sigma_2", "smaller principal stress in the plane", lambda s, _: principal(*s.inside)[1], ()),
    ("von_mises", "von Mises stress, sigma_ZZ included",
     lambda s, _: von_mises(*(*s.inside, s.σ_ZZ)), (OUT_OF_PLANE,)),
)  # fmt: skip
#: Principal stresses and von Mises inside, by method.
INVARIANTS_INSIDE = {
    method: tuple(
        Quantity(
            f"interior/{method}/{name}", "N/(2a)", f"{about} inside", (STATE, INSIDE), of, method,
            asked_by=BELOW, requires=requires,
        )
        for name, about, of, requires in _INVARIANTS
    )
    for method in _METHODS
}  # fmt: skip


#: Names of stresses in an elastic punch, their meaning, and how they are read.
_IN_PUNCH: list[tuple[str, str, Callable[[Any, Any], NDArray], tuple[str, ...]]] = [
    *(
        (f"sigma_{ij}", what, entry(lambda s: s.inside_punch, i), ())
        for i, (ij, what) in enumerate(_COMPONENTS.items())
    ),
    ("von_mises", "von Mises stress, sigma_ZZ included,",
     lambda s, body: von_mises(*(*s.inside_punch, body.of_punch.solid.σ_ZZ(*s.inside_punch))),
     (ZZ_IN_PUNCH,)),
]  # fmt: skip
#: σ_XX, σ_YY, σ_XY and von Mises in an elastic punch, by method.
STRESSES_IN_PUNCH = {
    method: tuple(
        Quantity(
            f"interior/{method}/punch_{name}", "N/(2a)",
            f"{about} in the elastic punch, at X and -Y of the points inside", (STATE, INSIDE), of,
            method, asked_by=BELOW, requires=(IN_PUNCH, *requires),
        )
        for name, about, of, requires in _IN_PUNCH
    )
    for method in (CLOSED_FORM, SIE, FEM)
}  # fmt: skip

QUANTITIES.add_all(globals())
