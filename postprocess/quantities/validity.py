"""Where the answers do not hold: what a user has to know of a steady, linear solution with friction."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities.quantity import (
    ANYWHERE,
    CLOSED_FORM,
    FEM,
    PUNCH,
    QUANTITIES,
    STATE,
    Quantity,
)
from galinx.postprocess.quantities.stresses import ON_SURFACE
from galinx.postprocess.stresses import tension
from galinx.solvers.parameters import Range

_NOT_NEGATIVE = Range(at_least=0.0)

#: Strain from which on a solid is not linear any more.
LARGE_STRAIN = 0.05

CROSSINGS = Quantity(
    "states/wave_crossings", "1",
    "how often a wave of the speed c_s crosses the contact while a stroke lasts, L/(2 a c); NaN at rest",
    (STATE,), nan_allowed=ANYWHERE, range=Range(above=0.0),
)  # fmt: skip


def _within(name: str, strain: float, what: tuple[str, str]) -> tuple[Quantity, Quantity]:
    """At X = -a and X = a."""

    def end(side: str, at: str, i: int) -> Quantity:
        return Quantity(
            f"states/closed_form/{name}_{side}", "1",
            f"{what[0]}: distance from {at}, under the punch, within which {what[1]}, over the "
            "half-width",
            (STATE,), lambda s, _: s.strained_within(strain)[:, i], CLOSED_FORM, PUNCH,
            range=_NOT_NEGATIVE,
        )  # fmt: skip

    return end("left", "X = -a", 0), end("right", "X = a", 1)


#: The slip velocity is V (1 + u,X).
SLIP_REVERSED = _within(
    "slip_reversed", 1.0, ("slip turned round", "1 + u,X is negative at the load")
)  # fmt: skip
STRAIN = _within(
    "large_strain", LARGE_STRAIN, ("strain beyond 5 %", "that of the surface along X is, at the load")
)  # fmt: skip
STRAINED = (*SLIP_REVERSED, *STRAIN)


def _tension(method: str) -> tuple[Quantity, Quantity]:
    def of(i: int) -> Any:
        def values(s: Any, _: Any) -> NDArray[np.float64]:
            return tension(s.surface)[i]

        return values

    return (
        Quantity(
            f"states/{method}/tension", "N/(2a)", "largest tension under the punch, 0 for none", (STATE,),
            of(0), method, asked_by=ON_SURFACE, range=_NOT_NEGATIVE,
        ),
        Quantity(
            f"states/{method}/tension_X_over_a", "1", "where that is, over the half-width; NaN for none",
            (STATE,), of(1), method, asked_by=ON_SURFACE, nan_allowed=ANYWHERE,
            range=Range(at_least=-1.0, at_most=1.0),
        ),
    )  # fmt: skip


#: How large, and where, by method.
TENSION = {method: _tension(method) for method in (CLOSED_FORM, FEM)}

QUANTITIES.add_all(globals())
