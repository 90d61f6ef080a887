"""How tables and verdicts look on a terminal."""

import json
import sys
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from galinx.app.console.streams import bare, plain
from galinx.postprocess.tables import Sheet


class _PlainConsole(Console):
    """Its colours are its own: those of texts are shown as the characters they are."""

    def render_str(self, text: str, **options: Any) -> Text:
        return super().render_str(plain(text), **options)


def new_console(file: Any = None, colours: bool = False) -> Console:
    """A console that guesses nothing about what numbers are, and wraps no line."""
    return _PlainConsole(
        file=bare(file or sys.stdout), highlight=False, markup=False, soft_wrap=True,
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
