"""Tables as text."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from galinx.postprocess.quantities import states as of
from galinx.postprocess.quantities.quantity import FEM

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


def states_sheet(data: dict[str, Any], title: str) -> Sheet:
    """The first states of an archive."""
    shown = {head: entry for head, entry in _COLUMNS.items() if entry[0].path in data}
    forms = [form for _, form in shown.values()]
    series = [data[row.path][:LIMIT] for row, _ in shown.values()]
    rows = [[form.format(value) for form, value in zip(forms, row)] for row in zip(*series)]
    for number, row in enumerate(rows):
        row[0] = f"{number} {row[0]}"
    notes = ["all columns are dimensionless; K is K_I, c the speed over the shear wave speed"]
    if "α" in shown:
        notes.append("K(-a), K(a): finite elements; α (X = a) and β (X = -a): exponents fitted there")
    hidden = len(data[of.FRICTION.path]) - LIMIT
    if hidden > 0:
        notes.insert(0, f"and {hidden} more states; show --json lists all")
    return Sheet(title or "States", list(shown), rows, notes)
