"""Quantities of layered half-planes: the singular integral equation's, and those at interfaces."""

from galinx.postprocess.quantities.quantity import BESIDE, POINT, QUANTITIES, SIE, STATE, Quantity
from galinx.postprocess.quantities.stresses import ON_SURFACE, extremes
from galinx.postprocess.quantities.validity import tensions
from galinx.solvers.parameters import Range


def _intensity(side: str, at: str, i: int) -> Quantity:
    return Quantity(
        f"states/sie/K_I_{side}", "1",
        f"normalised stress intensity factor at {at}, layered half-plane", (STATE,),
        lambda s, _: s.K_I[:, i], SIE,
    )  # fmt: skip


K_I_LEFT = {SIE: _intensity("left", "X = -a", 0)}
K_I_RIGHT = {SIE: _intensity("right", "X = a", 1)}

ESTIMATE = Quantity(
    "states/sie/estimate", "1",
    "estimated relative error of K_I and pressure, by fewer unknowns and the kernel's error",
    (STATE,), lambda s, _: s.estimates, SIE, compared=("estimate of the integral equation",),
    range=Range(at_least=0.0), accuracy=True,
)  # fmt: skip

PRESSURE = {
    SIE: Quantity(
        "surface/sie/sigma_YY", "N/(2a)", "contact stress, NaN outside the contact, layered half-plane",
        (STATE, POINT), lambda s, _: s.surface.σ_YY, SIE, asked_by=ON_SURFACE, nan_allowed=BESIDE,
    )
}  # fmt: skip
IN_PLANE = {
    SIE: Quantity(
        "surface/sie/sigma_XX", "N/(2a)", "in-plane stress on the surface, layered half-plane",
        (STATE, POINT), lambda s, _: s.surface.σ_XX, SIE, asked_by=ON_SURFACE,
    )
}  # fmt: skip

HIGHEST, LOWEST = ({SIE: one} for one in extremes(SIE))
TENSION = {SIE: tensions(SIE)}

QUANTITIES.add_all(globals())
