"""Works, and stresses on the surface, over time of starts from rest, one row for each."""

from galinx.postprocess.quantities.over_time import INSTANT, START, TIME
from galinx.postprocess.quantities.quantity import ANYWHERE, QUANTITIES, SIE, Quantity


def _row(name: str, unit: str, about: str) -> Quantity:
    return Quantity(
        f"time/sie/{name}", unit, f"{about}, integral equation", (START, INSTANT), asked_by=TIME,
        method=SIE, nan_allowed=ANYWHERE,
    )  # fmt: skip


OF_LOAD = _row("work_of_load", "N^2/(4mu)", "work of the load")
OF_FRICTION = _row(
    "work_of_friction", "N^2/(4mu)",
    "work of friction on the surface, by velocities seen from the punch besides being carried past it",
)  # fmt: skip
LEFT = _row("sigma_XX_left", "N/(2a)", "in-plane stress on the free surface at X = -1.05 a")
RIGHT = _row("sigma_XX_right", "N/(2a)", "in-plane stress on the free surface at X = 1.05 a")

#: Dimension of places under the punch.
PLACE = "places"
PLACES = Quantity(
    "time/X_over_a", "1", "positions under the punch over the half-width", (PLACE,), asked_by=TIME,
    method=SIE,
)  # fmt: skip
PRESSURE = Quantity(
    "time/sie/sigma_YY", "N/(2a)", "contact stress, integral equation", (START, INSTANT, PLACE),
    asked_by=TIME, method=SIE,
)  # fmt: skip

#: In the order in which a course tells them.
ALL = OF_LOAD, OF_FRICTION, PRESSURE, LEFT, RIGHT

QUANTITIES.add_all(globals())
