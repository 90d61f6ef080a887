"""Stresses on the surface at chosen times, one row for each motion in time."""

from galinx.postprocess.quantities.over_time import START, TIME
from galinx.postprocess.quantities.quantity import ANYWHERE, FEM, NEVER, QUANTITIES, SIE, Quantity
from galinx.solvers.parameters import Range

#: Dimensions: chosen times, and places.
OUTPUT, PLACE = "chosen times", "places along the surface"

_HOW = {FEM: "finite elements", SIE: "integral equation"}

TIMES = Quantity(
    "time/surface/t", "a/c_s", "times at which stresses along the surface are told", (OUTPUT,),
    asked_by=TIME, range=Range(at_least=0.0),
)  # fmt: skip
PLACES = Quantity(
    "time/surface/X_over_a", "1", "positions along the surface over the half-width", (PLACE,),
    asked_by=TIME,
)  # fmt: skip


def _by_method(name: str, about: str) -> dict[str, Quantity]:
    return {
        method: Quantity(
            f"time/surface/{method}/{name}", "N/(2a)", f"{about}, {told}", (START, OUTPUT, PLACE),
            asked_by=TIME, method=method, nan_allowed=NEVER if method == FEM else ANYWHERE,
        )
        for method, told in _HOW.items()
    }  # fmt: skip


IN_PLANE = _by_method("sigma_XX", "in-plane stress on the surface over time")
PRESSURE = _by_method("sigma_YY", "contact stress over time")
SHEAR = _by_method("sigma_XY", "friction stress over time")

ESTIMATE = Quantity(
    "time/surface/fem/estimate", "1",
    "estimated error of sigma_XX and sigma_YY along the surface over time, further than 0.01 a from the "
    "edges, over the largest of each there",
    (START,), asked_by=TIME, method=FEM, range=Range(at_least=0.0), accuracy=True,
)  # fmt: skip

QUANTITIES.add_all(globals())
