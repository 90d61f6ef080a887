"""Measured points that lie over figures: stresses along the surface, and friction over slip."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.units import Units, number
from galinx.texts import plain

from ..errors import BadInput, listed
from ..scene.units import to_si
from ..text_table import read_table
from .render import DOTS, Curve, Panel, as_text
from .style import Look

POSITION, SLIP, PRESSURE, TENSION, FRICTION = "position", "slip", "sigma_YY", "sigma_XX", "f"

#: Columns by what they are, and their SI units.
_COLUMNS = {
    "position": (POSITION, "m"), "slip": (SLIP, "m"), "pressure": (PRESSURE, "Pa"),
    "sigma_XX": (TENSION, "Pa"), "friction": (FRICTION, ""),
}  # fmt: skip
#: Figures that show what was measured.
_FIGURES = {PRESSURE: "surface", TENSION: "surface", FRICTION: "friction"}
_FORM = '"position [mm],pressure [MPa],sigma_XX [MPa]" or "slip [mm],f [1]"'


@dataclass(frozen=True)
class Measured:
    """Points of a table.

    Attributes:
        name: of the file.
        points: position from the punch's axis or slip [m], and pressure (positive) or stress [Pa] or
            friction coefficient, (n,) each, by the name of the stress along the surface, or ``"f"``.
    """

    name: str
    points: dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]

    def lies_in(self, figure: str, quantities: Collection[str] = ()) -> bool:
        """True if a figure shows what was measured.

        Args:
            figure: its name.
            quantities: that it draws; () for all.
        """
        shown = [name for name in self.points if _FIGURES[name] == figure]
        return any(not quantities or figure == _FIGURES[FRICTION] or name in quantities for name in shown)

    def over_stress(self, panel: Panel, name: str, units: Units) -> Panel:
        """A panel of a stress along the surface with the points of that stress over it.

        Raises:
            BadInput: none lies in the panel, or states have no common half-width or load to divide by.
        """
        if name not in self.points:
            return panel
        X, values = self.points[name]
        if not units.dimensionless:
            x = X / to_si(f"1 {units.position.unit}", "m")
            return self._over(panel, x, values / to_si(f"1 {units.stress.unit}", "Pa"))
        if np.ndim(units.half_width) or np.ndim(units.load):
            raise BadInput(
                f"--measured {self.name}: contacts or loads of states differ in size, so that "
                "measured positions have no X/a; leave --dimensionless away"
            )
        a = units.half_width
        return self._over(panel, (X - units.middle) / a, values * 2.0 * a / units.load)

    def over_loops(self, panel: Panel, lengths: NDArray) -> Panel:
        """A panel of friction over X/L with the measured friction over it.

        Args:
            panel: the panel.
            lengths: pre-sliding displacements L [m] of the states that it shows.

        Raises:
            BadInput: no point lies in the panel, or L differs.
        """
        if FRICTION not in self.points:
            return panel
        if len(different := np.unique(lengths)) > 1:
            raise BadInput(
                f"--measured {self.name}: states have {len(different)} pre-sliding displacements, so "
                "that a measured slip has no X/L; choose states with one by --states"
            )
        slip, f = self.points[FRICTION]
        return self._over(panel, slip / different[0], f)

    def _over(self, panel: Panel, x: NDArray, y: NDArray) -> Panel:
        assert panel.xlim and panel.ylim
        (first, last), (low, high) = panel.xlim, panel.ylim
        inside = (first <= x) & (x <= last)
        if not inside.any():
            raise BadInput(
                f"--measured {self.name}: found points at {number(x.min())} to {number(x.max())}, the "
                f"figure shows {number(first)} to {number(last)} of its {plain(panel.x or 'axis')}; "
                "check the unit, and where positions are counted from"
            )
        margin, bottom, top = 0.05 * (high - low), float(y[inside].min()), float(y[inside].max())
        if bottom < low or top > high:
            low, high = min(low, bottom - margin), max(high, top + margin)
        few = f" ({inside.sum()} of {len(x)} points)" * (not inside.all())
        points = Curve(x, y, Look("black", "none", "o"), f"measured, {as_text(self.name)}{few}", DOTS)
        return replace(panel, curves=[*panel.curves, points], ylim=(low, high))


def read(path: Path) -> Measured:
    """Read measured points from a table.

    Args:
        path: a file whose first line names the columns, units in brackets: position and pressure or
            sigma_XX; slip (or position) and f; with any others beside them.

    Raises:
        BadInput: it is no such table; the message says what was found.
    """
    table = read_table(path, _FORM)
    columns: dict[str, NDArray[np.float64]] = {}
    for n, (name, what) in enumerate(zip(table.names, table.kinds)):
        if what not in _COLUMNS:
            continue
        kind, unit = _COLUMNS[what]
        if kind in columns:
            raise BadInput(f"{path}, line 1: found two columns of {name}, expected one")
        if unit and not table.units[n]:
            example = "mm" if unit == "m" else "MPa"
            raise BadInput(f"{path}, line 1: {name} has no unit, expected one as in {name} [{example}]")
        if unit and table.units[n] in ("1", "-"):
            raise BadInput(
                f"{path}, line 1: {name} has the unit {table.units[n]}, expected one of {unit}"
            )
        columns[kind] = table.numbers(n, unit)
    places = {name: columns.get(POSITION) for name in _FIGURES}
    places[FRICTION] = columns.get(SLIP, columns.get(POSITION))
    points = {
        name: (place, columns[name])
        for name, place in places.items()
        if name in columns and place is not None and len(place)
    }
    if not points or len(points) < len(_FIGURES.keys() & columns.keys()):
        held = f"{listed(table.names)} in {len(table.rows)} rows"
        raise BadInput(f"{path}: found {held}, expected {_FORM} and rows of numbers{table.near_miss}")
    return Measured(path.name, points)
