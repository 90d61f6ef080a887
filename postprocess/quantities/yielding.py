"""Quantities of yield by von Mises, σ_ZZ included: at which load, where, and how deep."""

from collections.abc import Callable
from typing import Any

from numpy.typing import NDArray

from galinx.solvers.contact import YIELD
from galinx.solvers.contact.solution import FINITE, POWER, PUNCH
from galinx.solvers.contact.yielding import Peak
from galinx.solvers.parameters import Range

from .quantity import (
    ANYWHERE,
    CLOSED_FORM,
    FEM,
    OVER_A,
    QUANTITIES,
    STATE,
    X_OVER_A,
    Quantity,
)

_NOT_NEGATIVE, _BELOW = Range(at_least=0.0), Range(at_most=0.0)
_INFINITE = "NaN where it is infinite: with friction, where the pressure ends in a jump"
_BEYOND = "NaN beyond 10 a: no solid carries that"


def _both(
    name: str,
    unit: str,
    about: str,
    of: Callable[[Any, Any], NDArray],
    mode: str = "",
    compared: str = "",
    range: Range = _NOT_NEGATIVE,
    requires: tuple[str, ...] = (),
    scale: str = "",
) -> dict[str, Quantity]:
    """Quantity of a state by both methods."""
    return {
        method: Quantity(
            f"states/{method}/{name}", unit, about, (STATE,), of, method, mode, YIELD,
            nan_allowed=ANYWHERE, compared=(compared,) * (method == FEM and bool(compared)), range=range,
            requires=requires, scale=scale,
        )
        for method in (CLOSED_FORM, FEM)
    }  # fmt: skip


def _largest(
    name: str, stress: str, of: Callable[[Any], Peak], direction: str = ""
) -> tuple[dict[str, Quantity], ...]:
    """Quantities of the largest stress, and of both coordinates of its place."""
    about, place = (
        f"largest {stress}{direction}, on the surface and inside",
        f"place of the largest {stress}",
    )
    return (
        _both(
            name, "N/(2a)", f"{about}; {_INFINITE}", lambda s, _: of(s).value, FINITE,
            "largest stresses",
        ),
        _both(
            f"{name}_X_over_a", "1", f"{place} along the surface, over the half-width",
            lambda s, _: of(s).X, FINITE, range=Range(), scale=X_OVER_A,
        ),
        _both(
            f"{name}_Y_over_a", "1", f"{place} outwards, over the half-width",
            lambda s, _: of(s).Y, FINITE, range=_BELOW, scale=OVER_A,
        ),
    )  # fmt: skip


VON_MISES, VON_MISES_X, VON_MISES_Y = _largest(
    "von_mises", "von Mises stress", lambda s: s.strength.von_mises
)
SHEAR, SHEAR_X, SHEAR_Y = _largest(
    "max_shear", "shear stress", lambda s: s.strength.shear, direction=" in the plane"
)
FIRST_LOAD = _both(
    "first_yield_load", "N/m",
    "load at first yield, N per depth at which the solid yields somewhere; 0 where its stress is "
    "infinite",
    lambda s, _: s.strength.first_load, FINITE, requires=(POWER,),
)  # fmt: skip
REACH_LEFT = _both(
    "yield_reach_left", "1",
    "reach of yield from X = -a, the largest distance on its side of the middle at which the von Mises "
    f"stress reaches the yield strength at the load, over the half-width; {_BEYOND}",
    lambda s, _: s.strength.reach[:, 0], PUNCH, "yielded zone", scale=OVER_A,
)  # fmt: skip
REACH_RIGHT = _both(
    "yield_reach_right", "1",
    f"reach of yield from X = a, the same there, over the half-width; {_BEYOND}",
    lambda s, _: s.strength.reach[:, 1], PUNCH, "yielded zone", scale=OVER_A,
)  # fmt: skip
DEPTH = _both(
    "yield_depth", "1",
    "depth of yield, the largest at which the von Mises stress reaches the yield strength at the load, "
    f"over the half-width; {_BEYOND}",
    lambda s, _: s.strength.depth, compared="depth of yield", scale=OVER_A,
)  # fmt: skip
ESTIMATE_YIELD = Quantity(
    "states/fem/estimate_yield", "1",
    "estimated error of the stresses from which yield is computed, over the larger of the largest there "
    "and further than 0.01 a from the edges, no closed form used",
    (STATE,), lambda s, _: s.estimates[YIELD], FEM, asked_by=YIELD, compared=("estimate of yield",),
    range=_NOT_NEGATIVE, accuracy=True,
)  # fmt: skip

QUANTITIES.add_all(globals())
