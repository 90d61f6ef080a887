"""Tables as text."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from galinx.postprocess.quantities import Quantity, validity, yielding
from galinx.postprocess.quantities import states as of
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM

#: States that a table shows at most.
LIMIT = 24


@dataclass(frozen=True)
class Sheet:
    """A table as text: the first column is a label, the others are numbers.

    Attributes:
        title: of the table.
        columns: their heads, with units.
        rows: cells as text.
        notes: lines below.
    """

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    notes: Sequence[str] = ()


class Scaled(NamedTuple):
    """What a quantity is called where it is told, its unit, and what its numbers are multiplied by."""

    name: str
    unit: str
    factor: float

    @property
    def head(self) -> str:
        """Of a column."""
        return self.name if self.unit == "none" else f"{self.name} [{self.unit}]"


#: How a quantity of some name is told; None where it is not.
Scaling = Callable[[Quantity, str], Scaled | None]


def as_archived(row: Quantity, name: str) -> Scaled:
    """In its own unit."""
    return Scaled(name, row.unit, 1.0)


#: Column of the states' table -> (quantity, form).
_COLUMNS = {
    "state": (of.MOTION, "{}"),
    "X/L": (of.POSITION, "{:g}"),
    "c": (of.SPEED, "{:.4g}"),
    "f": (of.FRICTION, "{:+.4f}"),
    "K exact": (of.K_I_BOTH, "{:.6f}"),
    "K(-a)": (of.K_I_LEFT[FEM], "{:.6f}"),
    "K(a)": (of.K_I_RIGHT[FEM], "{:.6f}"),
    "α": (of.FITTED_ALPHA, "{:.3f}"),
    "β": (of.FITTED_BETA, "{:.3f}"),
}


def states_sheet(data: dict[str, Any], title: str, scaling: Scaling = as_archived) -> Sheet:
    """The first states of an archive."""
    shown = {head: entry for head, entry in _COLUMNS.items() if entry[0].path in data}
    forms = [form for _, form in shown.values()]
    series = [data[row.path][:LIMIT] for row, _ in shown.values()]
    if (speed := scaling(of.SPEED, "c")) and speed.unit != "1":
        at = list(shown).index("c")
        series[at] = speed.factor * series[at]
        shown = {speed.head if head == "c" else head: entry for head, entry in shown.items()}
    rows = [[form.format(value) for form, value in zip(forms, row)] for row in zip(*series)]
    for number, row in enumerate(rows):
        row[0] = f"{number} {row[0]}"
    notes = ["all columns are dimensionless; K is K_I, c the speed over the shear wave speed"]
    if "c" not in shown:
        notes = ["columns without a unit are dimensionless; K is K_I"]
    if "α" in shown:
        notes.append("K(-a), K(a): finite elements; α (X = a) and β (X = -a): exponents fitted there")
    hidden = len(data[of.FRICTION.path]) - LIMIT
    if hidden > 0:
        notes.insert(0, f"and {hidden} more states; show --json lists all")
    return Sheet(title or "States", list(shown), rows, notes)


#: Numbers of states that are lengths over the half-width.
LENGTHS = (
    *validity.STRAINED,
    *(where for _, where in validity.TENSION.values()),
    *(row for rows in yielding.OVER_HALF_WIDTH for row in rows.values()),
)

#: What tells where a solid yields and where answers do not hold, by what a table calls it.
_LIMITS: tuple[tuple[str, dict[str, Quantity]], ...] = (
    ("largest von Mises stress", yielding.VON_MISES),
    ("  at X", yielding.VON_MISES_X),
    ("  at Y", yielding.VON_MISES_Y),
    ("largest shear stress", yielding.SHEAR),
    ("  at X", yielding.SHEAR_X),
    ("  at Y", yielding.SHEAR_Y),
    ("load at first yield", yielding.FIRST_LOAD),
    ("yield within, from X = -a", yielding.REACH_LEFT),
    ("yield within, from X = a", yielding.REACH_RIGHT),
    ("depth of the yielded zone", yielding.DEPTH),
    ("wave crossings in a stroke", {"": validity.CROSSINGS}),
    ("slip turned round, from X = -a", {CLOSED_FORM: validity.SLIP_REVERSED[0]}),
    ("slip turned round, from X = a", {CLOSED_FORM: validity.SLIP_REVERSED[1]}),
    ("strain beyond 5 %, from X = -a", {CLOSED_FORM: validity.STRAIN[0]}),
    ("strain beyond 5 %, from X = a", {CLOSED_FORM: validity.STRAIN[1]}),
    ("tension under the punch", {method: rows[0] for method, rows in validity.TENSION.items()}),
    ("  at X", {method: rows[1] for method, rows in validity.TENSION.items()}),
)
_METHODS = {CLOSED_FORM: "exact", FEM: "FE", "": ""}


def limits_sheet(data: dict[str, Any], scaling: Scaling = as_archived) -> Sheet:
    """Where the solid yields, and where answers do not hold: least and most of all states."""
    rows = []
    for label, by_method in _LIMITS:
        for method, row in by_method.items():
            told = scaling(row, "")
            if row.path in data and told and np.isfinite(values := data[row.path]).any():
                ends = (f"{told.factor * end(values):.4g}" for end in (np.nanmin, np.nanmax))
                unit = "a" if told.unit == row.unit and row in LENGTHS else told.unit
                rows.append([label, _METHODS[method], unit, *ends])
    notes = ["exact: closed form, FE: finite elements; slip and strain at the edges, at the load"]
    return Sheet("Yield, and where answers hold", ["", "by", "unit", "least", "most"], rows, notes)
