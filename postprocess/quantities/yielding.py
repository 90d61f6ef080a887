"""Quantities of yield by von Mises, σ_ZZ included: at which load, where, and how deep."""

from collections.abc import Callable
from functools import partial
from typing import Any

from galinx.solvers.contact import YIELD
from galinx.solvers.contact.solution import (
    FINITE,
    IN_PUNCH,
    LAYERED,
    POWER,
    PUNCH,
    PUNCH_STRENGTH,
    STRENGTH,
    UNIFORM,
    ZZ_IN_PUNCH,
)
from galinx.solvers.contact.yielding import Peak
from galinx.solvers.parameters import Range

from .quantity import (
    ANYWHERE,
    CLOSED_FORM,
    FEM,
    LAYER,
    NOT_NEGATIVE,
    OVER_A,
    QUANTITIES,
    SIE,
    STATE,
    X_OVER_A,
    Quantity,
    by_method,
    entry,
)

_BELOW = Range(at_most=0.0)
_INFINITE = "NaN where infinite: with friction, at a jump of the pressure"
_BEYOND = "NaN beyond 10 a"


#: Quantity of a state by the methods of uniform solids.
_both = partial(
    by_method, own=(CLOSED_FORM, SIE, FEM), asked_by=YIELD, range=NOT_NEGATIVE, nan_allowed=ANYWHERE,
    requires=(UNIFORM,),
)  # fmt: skip
#: Quantity of each layer and the solid below, by both methods of layered solids.
_of_layers = partial(
    by_method, own=(SIE, FEM), section="layers", over=(STATE, LAYER), mode=FINITE, asked_by=YIELD,
    range=NOT_NEGATIVE, nan_allowed=ANYWHERE, requires=(LAYERED,),
)  # fmt: skip


def _largest(
    name: str,
    stress: str,
    of: Callable[[Any], Peak],
    direction: str = "",
    heights: Range = _BELOW,
    **options: Any,
) -> tuple[dict[str, Quantity], ...]:
    """Quantities of the largest stress, and of both coordinates of its place."""
    about, place = (
        f"largest {stress}{direction}, on the surface and inside",
        f"place of the largest {stress}",
    )
    return (
        _both(
            name, "N/(2a)", f"{about}; {_INFINITE}", lambda s, _: of(s).value, mode=FINITE,
            **options,
        ),
        _both(
            f"{name}_X_over_a", "1", f"{place} along the surface, over the half-width",
            lambda s, _: of(s).X, mode=FINITE, range=Range(), scale=X_OVER_A, **options,
        ),
        _both(
            f"{name}_Y_over_a", "1", f"{place} outwards, over the half-width",
            lambda s, _: of(s).Y, mode=FINITE, range=heights, scale=OVER_A, **options,
        ),
    )  # fmt: skip


VON_MISES, VON_MISES_X, VON_MISES_Y = _largest(
    "von_mises", "von Mises stress", lambda s: s.strength.von_mises, requires=(),
)  # fmt: skip
SHEAR, SHEAR_X, SHEAR_Y = _largest(
    "max_shear", "shear stress", lambda s: s.strength.shear, direction=" in the plane"
)


def _in_punch(s: Any) -> Peak:
    peak = s.strength_of_punch.von_mises
    return Peak(peak.value, peak.X, 0.0 - peak.Y)


PUNCH_VON_MISES, PUNCH_VON_MISES_X, PUNCH_VON_MISES_Y = _largest(
    "punch_von_mises", "von Mises stress in the elastic punch", _in_punch, heights=NOT_NEGATIVE,
    requires=(IN_PUNCH, ZZ_IN_PUNCH),
)  # fmt: skip
PUNCH_FIRST_LOAD = _both(
    "punch_first_yield_load", "N/m", "load at first yield of the elastic punch, N per depth",
    lambda s, _: s.strength_of_punch.first_load, mode=FINITE, 
    requires=(POWER, IN_PUNCH, ZZ_IN_PUNCH, PUNCH_STRENGTH, UNIFORM),
)  # fmt: skip
FIRST_LOAD = _both(
    "first_yield_load", "N/m",
    "load at first yield, N per depth at which the solid yields somewhere; 0 where its stress is "
    "infinite",
    lambda s, _: s.strength.first_load, mode=FINITE, requires=(POWER, STRENGTH, UNIFORM),
)  # fmt: skip
REACH_LEFT, REACH_RIGHT = (
    _both(
        f"yield_reach_{side}", "1",
        f"reach of yield from {at}, the largest distance on its side of the middle, at the load, over "
        f"the half-width; {_BEYOND}",
        entry(lambda s: s.strength.reach, ..., i), mode=PUNCH, scale=OVER_A, own=(CLOSED_FORM, FEM),
    )
    for i, (side, at) in enumerate((("left", "X = -a"), ("right", "X = a")))
)  # fmt: skip
DEPTH = _both(
    "yield_depth", "1",
    f"depth of yield, the largest at the load, over the half-width; {_BEYOND}",
    lambda s, _: s.strength.depth, requires=(STRENGTH, UNIFORM), scale=OVER_A, range=NOT_NEGATIVE,
)  # fmt: skip
ESTIMATE_YIELD = Quantity(
    "states/fem/estimate_yield", "1",
    "estimated error of the stresses from which yield is computed, over the larger of the largest there "
    "and further than 0.01 a from the edges, no closed form used",
    (STATE,), lambda s, _: s.estimates[YIELD], FEM, asked_by=YIELD,
    range=NOT_NEGATIVE, accuracy=True,
)  # fmt: skip


#: Largest von Mises stress of each layer and of the solid below, its place, and the stress over strength.
OF_LAYERS = _of_layers(
    "von_mises", "N/(2a)", "largest von Mises stress in each layer and the solid below",
    lambda s, _: s.strength.peaks.value,
)  # fmt: skip
OF_LAYERS_X = _of_layers(
    "von_mises_X_over_a", "1",
    "place of the largest von Mises stress along the surface, over the half-width",
    lambda s, _: s.strength.peaks.X, range=Range(), scale=X_OVER_A,
)  # fmt: skip
OF_LAYERS_Y = _of_layers(
    "von_mises_Y_over_a", "1", "place of the largest von Mises stress outwards, over the half-width",
    lambda s, _: s.strength.peaks.Y, range=_BELOW, scale=OVER_A,
)  # fmt: skip
OVER_STRENGTH = _of_layers(
    "von_mises_over_strength", "1",
    "largest von Mises stress over the yield strength, 1 or more where it yields; NaN where the strength "
    "is not given",
    lambda s, _: s.strength.over_strength, requires=(LAYERED, STRENGTH),
)  # fmt: skip

QUANTITIES.add_all(globals())
