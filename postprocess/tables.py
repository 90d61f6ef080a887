"""Tables, and how they look on a terminal."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table

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


def new_console(file: Any = None, colours: bool = False) -> Console:
    """A console that guesses nothing about what numbers are, and wraps no line."""
    return Console(
        file=file, highlight=False, markup=False, soft_wrap=True,
        color_system="auto" if colours else None,
    )  # fmt: skip


def print_sheet(console: Console, sheet: Sheet) -> None:
    """Print a table, labels to the left and numbers to the right."""
    table = Table(
        title=sheet.title, box=box.SIMPLE_HEAD, title_justify="left", title_style="", header_style="bold",
        pad_edge=False, padding=(0, 1, 0, 0),
    )  # fmt: skip
    for i, column in enumerate(sheet.columns):
        table.add_column(column, justify="left" if i == 0 else "right", no_wrap=True)
    for row in sheet.rows:
        table.add_row(*row)
    console.print(table)
    for note in sheet.notes:
        console.print(note)


def print_verdict(console: Console, attributes: dict[str, Any]) -> None:
    """Print the comparisons and the verdict of an archive."""
    for text, value in json.loads(attributes["comparisons"]).items():
        console.print(f"  {text}: {value:.1e}")
    styles = {"PASS": "bold green", "FAIL": "bold red"}
    console.print(f"verdict: {attributes['verdict']}", style=styles.get(attributes["verdict"]))
    for reason in json.loads(attributes["verdict_reasons"]):
        console.print(f"  {reason}")
