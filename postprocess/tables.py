"""Tables as text."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from galinx.postprocess.named import parameters
from galinx.postprocess.page.symbols import plain
from galinx.postprocess.quantities import Quantity
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


#: Columns of the states' table after what tells states apart: (head, quantity, form).
_EITHER = [("K_I", of.K_I_BOTH, "{:.6f}"), ("error", of.TRUE_ERROR, "{:.1e}")]
_ALONE = [("K(-a)", of.K_I_LEFT[FEM], "{:.6f}"), ("K(a)", of.K_I_RIGHT[FEM], "{:.6f}")]
_BOTH = [
    ("estimate", of.ESTIMATE, "{:.1e}"), ("v₀ (m)", of.INDENTATION, "{:.4e}"),
    ("α", of.ALPHA, "{:.4f}"), ("β", of.BETA, "{:.4f}"),
]  # fmt: skip


def states_sheet(data: dict[str, Any], title: str) -> Sheet:
    """The first states of an archive: what tells them apart, and the main results."""
    apart = {path: row for path, row in parameters(data).items() if path != of.MOTION.path}
    varied = {path: row for path, row in apart.items() if len(np.unique(data[path])) > 1}
    shown = {_head(row): (row, "{:.4g}") for row in varied.values()}
    results = _EITHER if of.K_I_BOTH.path in data else _ALONE
    for head, row, form in (("f", of.FRICTION, "{:+.4f}"), *results, *_BOTH):
        if row.path in data:
            shown[head] = row, form
    series = [data[row.path][:LIMIT].tolist() for row, _ in shown.values()]
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
    notes.append("dimensionless where no unit stands; c is the speed over the shear wave speed")
    if "error" in shown:
        notes.append("K_I: closed form, at both edges; error and estimate: of finite elements, relative")
    if "α" in shown:
        notes.append("α, β: exponents of the pressure at X = a and X = -a")
    return Sheet(title or "States", ["state", *shown], rows, notes)


def _head(row: Quantity) -> str:
    unit = "" if row.unit == "1" else f" ({row.unit})"
    return plain(f"${row.symbol}$") + unit
