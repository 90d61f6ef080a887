"""Quantities of archives in SI: what is over N/(2a), a and the wave speed, in Pa, m and m/s."""

from typing import NamedTuple

from galinx.app.scene.scene import Scene
from galinx.postprocess.quantities import Quantity
from galinx.postprocess.quantities.states import SPEED
from galinx.postprocess.quantities.stresses import INSIDE_X, INSIDE_Y, SURFACE_X
from galinx.solvers.solution import Body

_OVER_HALF_WIDTH = {SURFACE_X.path: "X", INSIDE_X.path: "X", INSIDE_Y.path: "Y"}


class Scaled(NamedTuple):
    """What a quantity is called in SI, its unit, and what its numbers are multiplied by."""

    name: str
    unit: str
    factor: float

    @property
    def head(self) -> str:
        """Of a column."""
        return self.name if self.unit == "none" else f"{self.name} [{self.unit}]"


def in_si(row: Quantity, name: str, scene: Scene) -> Scaled:
    """A quantity in SI; dimensionless ones that are over no length, stress or speed stay.

    Args:
        row: in the table of quantities.
        name: what it is called as archived.
        scene: that the archive is of.
    """
    body = Body(scene.solid, scene.punch.profile, scene.punch.load)
    if row.unit == "N/(2a)":
        return Scaled(name, "Pa", body.stress)
    if row.path in _OVER_HALF_WIDTH:
        return Scaled(_OVER_HALF_WIDTH[row.path], "m", body.profile.half_width)
    if row.path == SPEED.path:
        return Scaled("speed", "m/s", body.solid.c_s)
    return Scaled(name, row.unit, 1.0)
