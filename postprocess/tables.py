"""Tables as text."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from galinx.postprocess.figures.typeset import plain
from galinx.postprocess.named import parameters
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


#: Columns of the states' table after what tells states apart: (head, quantity, form).
_EITHER = [("K_I", of.K_I_BOTH, "{:.6f}"), ("error", of.TRUE_ERROR, "{:.1e}")]
_ALONE = [("K(-a)", of.K_I_LEFT[FEM], "{:.6f}"), ("K(a)", of.K_I_RIGHT[FEM], "{:.6f}")]
_BOTH = [
    ("estimate", of.ESTIMATE, "{:.1e}"), ("v₀ (m)", of.INDENTATION, "{:.4e}"),
    ("α", of.ALPHA, "{:.4f}"), ("β", of.BETA, "{:.4f}"),
]  # fmt: skip


def states_sheet(data: dict[str, Any], title: str, scaling: Scaling = as_archived) -> Sheet:
    """The first states of an archive: what tells them apart, and the main results."""
    apart = {path: row for path, row in parameters(data).items() if path != of.MOTION.path}
    varied = {path: row for path, row in apart.items() if len(np.unique(data[path])) > 1}
    shown = {_head(row): (row, "{:.4g}") for row in varied.values()}
    results = _EITHER if of.K_I_BOTH.path in data else _ALONE
    for head, row, form in (("f", of.FRICTION, "{:+.4f}"), *results, *_BOTH):
        if row.path in data:
            shown[head] = row, form
    told = [scaling(row, head) or as_archived(row, head) for head, (row, _) in shown.items()]
    series = [
        (one.factor * data[row.path][:LIMIT]).tolist() for one, (row, _) in zip(told, shown.values())
    ]
    heads = [
        head if one.unit == row.unit else one.head for one, (head, (row, _)) in zip(told, shown.items())
    ]
    forms = [form for _, form in shown.values()]
    labels = [f"{n} {motion}" for n, motion in enumerate(data[of.MOTION.path][:LIMIT].tolist())]
    rows = [
        [label, *(form.format(value) for form, value in zip(forms, row))]
        for label, row in zip(labels, zip(*series))
    ]
    notes = []
    hidden = len(data[of.FRICTION.path]) - LIMIT
    if hidden > 0:
        notes.append(f"and {hidden} more states; csv and show --json list all")
    same = [f"{_head(row)} = {data[path][0]:.4g}" for path, row in apart.items() if path not in varied]
    if same:
        notes.append(f"the same in all: {', '.join(same)}")
    about = "; c is the speed over the shear wave speed" * (_head(of.SPEED) in heads)
    notes.append(f"dimensionless where no unit stands{about}")
    if "error" in shown:
        notes.append("K_I: closed form, at both edges; error and estimate: of finite elements, relative")
    if "α" in shown:
        notes.append("α, β: exponents of the pressure at X = a and X = -a")
    return Sheet(title or "States", ["state", *heads], rows, notes)


def _head(row: Quantity) -> str:
    unit = "" if row.unit == "1" else f" ({row.unit})"
    return plain(f"${row.symbol}$") + unit


#: Numbers of states that are lengths over the half-width.
LENGTHS = (
    *validity.STRAINED,
    *(where for _, where in validity.TENSION.values()),
    *(row for rows in yielding.OVER_HALF_WIDTH for row in rows.values()),
)

#: What tells where a solid yields and where answers do not hold, by what a table calls it.
_LIMITS: tuple[tuple[str, dict[str, Quantity]], ...] = (
    ("largest von Mises", yielding.VON_MISES),
    ("  at X", yielding.VON_MISES_X),
    ("  at Y", yielding.VON_MISES_Y),
    ("largest shear", yielding.SHEAR),
    ("  at X", yielding.SHEAR_X),
    ("  at Y", yielding.SHEAR_Y),
    ("load at first yield", yielding.FIRST_LOAD),
    ("yield within, left", yielding.REACH_LEFT),
    ("yield within, right", yielding.REACH_RIGHT),
    ("depth of yield", yielding.DEPTH),
    ("waves in a stroke", {"": validity.CROSSINGS}),
    ("slip turned, left", {CLOSED_FORM: validity.SLIP_REVERSED[0]}),
    ("slip turned, right", {CLOSED_FORM: validity.SLIP_REVERSED[1]}),
    ("strain > 5 %, left", {CLOSED_FORM: validity.STRAIN[0]}),
    ("strain > 5 %, right", {CLOSED_FORM: validity.STRAIN[1]}),
    ("tension", {method: rows[0] for method, rows in validity.TENSION.items()}),
    ("  at X", {method: rows[1] for method, rows in validity.TENSION.items()}),
)
_METHODS = {CLOSED_FORM: "exact", FEM: "FE", "": ""}


def limits_sheet(data: dict[str, Any], scaling: Scaling = as_archived) -> Sheet:
    """Where the solid yields, and where answers do not hold: least and most of all states."""
    rows = []
    for label, by_method in _LIMITS:
        for method, row in by_method.items():
            told = scaling(row, "")
            if row.path in data and told and np.nan_to_num(values := data[row.path]).any():
                ends = (f"{told.factor * end(values):.4g}" for end in (np.nanmin, np.nanmax))
                unit = "a" if told.unit == row.unit and row in LENGTHS else told.unit
                rows.append([label, _METHODS[method], unit, *ends])
    notes = [
        "left, right: how far from X = -a and X = a; waves: how often one crosses the contact",
        "exact: closed form, FE: finite elements",
    ]
    return Sheet("Yield, and where answers hold", ["", "by", "unit", "least", "most"], rows, notes)
