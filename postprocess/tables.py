"""Tables on the terminal."""

import json
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table


def new_table(title: str, *columns: str) -> Table:
    """An empty table; columns are right-aligned, but for the first."""
    # No colours: mpirun hands its ranks a terminal even where the output goes to a file.
    table = Table(
        title=title, box=box.SIMPLE_HEAD, title_justify="left", title_style="", header_style="",
        pad_edge=False, padding=(0, 1, 0, 0),
    )  # fmt: skip
    for i, column in enumerate(columns):
        table.add_column(column, justify="left" if i == 0 else "right", no_wrap=True)
    return table


def new_console(file: Any = None) -> Console:
    """A console without colours or guesses about what numbers are."""
    return Console(file=file, highlight=False, markup=False, color_system=None, soft_wrap=True)


def print_states(data: dict[str, Any], attributes: dict[str, Any], limit: int = 24) -> None:
    """Print the states of an archive, at most ``limit`` of them, and the verdict."""
    console = new_console()
    columns = ["", "X/L", "c", "f"]
    series = [data[f"states/{name}"] for name in ("motion", "X_over_L", "c", "f")]
    formats = ["{}", "{:g}", "{:.4g}", "{:+.4f}"]
    for name, label in (
        ("states/closed_form/K_I", "K exact"),
        ("states/fem/K_I_left", "K(-a)"),
        ("states/fem/K_I_right", "K(a)"),
    ):
        if name in data:
            columns.append(label)
            series.append(data[name])
            formats.append("{:.6f}")
    if "states/fem/alpha" in data:
        columns += ["α", "β"]
        series += [data["states/fem/alpha"], data["states/fem/beta"]]
        formats += ["{:.4f}", "{:.4f}"]
    table = new_table(attributes["title"] or "States", *columns)
    for row in list(zip(*series))[:limit]:
        table.add_row(*(text.format(value) for text, value in zip(formats, row)))
    console.print(table)
    hidden = len(data["states/f"]) - limit
    if hidden > 0:
        console.print(f"and {hidden} more states; show --json lists all")
    console.print("all columns are dimensionless; K is K_I, c the speed over the shear wave speed")
    if "states/fem/alpha" in data:
        console.print("K(-a), K(a): finite elements; α (X = a) and β (X = -a): exponents fitted there")
    for text, value in json.loads(attributes["comparisons"]).items():
        console.print(f"  {text}: {value:.1e}")
    console.print(f"verdict: {attributes['verdict']}")
    for reason in json.loads(attributes["verdict_reasons"]):
        console.print(f"  {reason}")
