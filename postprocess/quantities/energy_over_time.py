"""Where energy goes over time, one row for each motion."""

from galinx.postprocess.quantities.over_time import INSTANT, START, TIME
from galinx.postprocess.quantities.quantity import FEM, QUANTITIES, Quantity

#: In which box about the punch, that goes with it, energy is near.
_NEAR = "within 3 a of its middle and 2 a below it"


def _row(name: str, about: str) -> Quantity:
    return Quantity(
        f"time/fem/{name}", "N^2/(4mu)", f"{about}, since t = 0", (START, INSTANT), asked_by=TIME,
        method=FEM,
    )  # fmt: skip


DISSIPATED = Quantity(
    "time/dissipated", "N*a", "work that friction takes to first order since t = 0, f V load over time",
    (START, INSTANT), asked_by=TIME,
)  # fmt: skip
CARRIED = _row(
    "work_of_carrying",
    "work on the solid by being carried past the punch, V times the change of its momentum in the field",
)
STRAIN = _row("strain_near", f"strain energy of the solid near the punch, {_NEAR}")
KINETIC = _row("kinetic_near", f"kinetic energy of the solid near the punch, {_NEAR}")
RADIATED = _row(
    "radiated",
    "strain and kinetic energy of the solid farther from the punch, and what was absorbed there",
)

QUANTITIES.add_all(globals())
