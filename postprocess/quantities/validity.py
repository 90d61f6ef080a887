"""Quantities of where the answers do not hold: limits of a steady, linear solution with friction."""

from collections.abc import Callable
from typing import Any

from galinx.solvers.contact.solution import CLOSED, FLAT, PUNCH, RESTING
from galinx.solvers.contact.stresses import tension
from galinx.solvers.parameters import Range

from .quantity import (
    ANYWHERE,
    CLOSED_FORM,
    FEM,
    LOCAL,
    NOT_NEGATIVE,
    OVER_A,
    QUANTITIES,
    SIE,
    STATE,
    X_OVER_A,
    Quantity,
    by_method,
)

#: Strain from which on a solid is not linear any more.
LARGE_STRAIN = 0.05

CROSSINGS = Quantity(
    "states/wave_crossings", "1",
    "wave crossings of a stroke, how often a wave of the speed c_s crosses the contact while it lasts: "
    "L/(2 a c); NaN at rest, and without strokes",
    (STATE,), nan_allowed=ANYWHERE, range=Range(above=0.0),
)  # fmt: skip

#: Signs of σ_XY/σ_YY.
SIGNS = ("positive", "negative")


#: Flutter thresholds by the sign of σ_XY/σ_YY.
FLUTTER = {
    sign: Quantity(
        f"states/flutter_{sign}", "1",
        f"flutter threshold for sigma_XY/sigma_YY {compared} 0, the |sigma_XY/sigma_YY| from which on "
        "waves along an interface with Coulomb friction grow, the shorter the faster; NaN for none",
        (STATE,), nan_allowed=ANYWHERE, range=NOT_NEGATIVE,
    )
    for sign, compared in zip(SIGNS, "><")
}  # fmt: skip


def _within(
    name: str, reach: str, what: str, of: Callable[[Any, Any], Any], requires: tuple[str, ...]
) -> tuple[Quantity, ...]:
    """Quantities of a distance from X = -a and from X = a, (2, states), under a flat punch.

    They are those of the closed form, whichever method solves: warnings rest on them.
    """
    return tuple(
        Quantity(
            f"states/closed_form/{name}_{side}", "1",
            f"{reach} from {at}, the distance within which {what}, over the half-width",
            (STATE,), lambda s, body, i=i: of(s, body)[i], LOCAL, PUNCH,
            range=NOT_NEGATIVE, scale=OVER_A, requires=requires,
        )
        for i, (side, at) in enumerate({"left": "X = -a", "right": "X = a"}.items())
    )  # fmt: skip


#: The slip velocity is V (1 + u,X).
SLIP_REVERSED = _within(
    "slip_reversed", "reach of reversed slip", "1 + u,X is negative at the load",
    lambda s, body: body.flat_punch(s.response, s.g).compressed_within(1.0 / body.strain),
    (CLOSED, FLAT, RESTING),
)  # fmt: skip
STRAIN = _within(
    "large_strain", "reach of large strain", "|u,X| is beyond 5 % at the load",
    lambda s, body: body.flat_punch(s.response, s.g).strained_within(LARGE_STRAIN / body.strain),
    (CLOSED, FLAT),
)  # fmt: skip


#: Largest tension under the punch, by method, and its place.
TENSION = by_method(
    "tension", "N/(2a)", "largest tension under the punch, 0 for none",
    lambda s, _: tension(*s.pressed)[0], (CLOSED_FORM, FEM, SIE), range=NOT_NEGATIVE,
)  # fmt: skip
TENSION_X = by_method(
    "tension_X_over_a", "1", "place of the largest tension, over the half-width; NaN for none",
    lambda s, _: tension(*s.pressed)[1], (CLOSED_FORM, FEM, SIE), nan_allowed=ANYWHERE,
    range=Range(at_least=-1.0, at_most=1.0), scale=X_OVER_A,
)  # fmt: skip

QUANTITIES.add_all(globals())
