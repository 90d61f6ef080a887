"""Works, and stresses on the surface, over time, one row for each motion."""

from galinx.postprocess.quantities.over_time import INSTANT, START, TIME
from galinx.postprocess.quantities.quantity import ANYWHERE, FEM, QUANTITIES, SIE, Quantity

_HOW = {FEM: "finite elements", SIE: "integral equation"}


def _by_method(name: str, unit: str, about: str) -> dict[str, Quantity]:
    return {
        method: Quantity(
            f"time/{method}/{name}", unit, f"{about}, {told}", (START, INSTANT), asked_by=TIME,
            method=method, nan_allowed=ANYWHERE,
        )
        for method, told in _HOW.items()
    }  # fmt: skip


OF_LOAD = _by_method("work_of_load", "N^2/(4mu)", "work of the load")
OF_FRICTION = _by_method(
    "work_of_friction", "N^2/(4mu)",
    "work of friction on the surface, by velocities seen from the punch besides being carried past it",
)  # fmt: skip
LEFT = _by_method("sigma_XX_left", "N/(2a)", "in-plane stress on the free surface at X = -1.05 a")
RIGHT = _by_method("sigma_XX_right", "N/(2a)", "in-plane stress on the free surface at X = 1.05 a")

#: Dimension of places under the punch.
PLACE = "places"
PLACES = Quantity(
    "time/X_over_a", "1", "positions under the punch over the half-width", (PLACE,), asked_by=TIME,
    method=SIE,
)  # fmt: skip
PRESSURE = Quantity(
    "time/sie/sigma_YY", "N/(2a)", "contact stress, integral equation", (START, INSTANT, PLACE),
    asked_by=TIME, method=SIE, nan_allowed=ANYWHERE,
)  # fmt: skip

#: In the order in which a course of the integral equation tells them.
ALL = OF_LOAD[SIE], OF_FRICTION[SIE], PRESSURE, LEFT[SIE], RIGHT[SIE]

QUANTITIES.add_all(globals())
