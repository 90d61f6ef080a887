"""How tables and verdicts look on a terminal."""

import json
import sys
import textwrap
from typing import Any

from rich import box
from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

from galinx.app.console.streams import bare, plain, width
from galinx.postprocess.tables import Sheet


class _PlainConsole(Console):
    """Its colours are its own: those of texts are shown as the characters they are."""

    def render_str(self, text: str, **options: Any) -> Text:
        return super().render_str(plain(text), **options)


def new_console(file: Any = None, colours: bool = False) -> Console:
    """A console that guesses nothing about what numbers are, and wraps no line."""
    return _PlainConsole(
        file=bare(file or sys.stdout), highlight=False, markup=False, soft_wrap=True, width=width(),
        color_system="auto" if colours else None,
    )  # fmt: skip


def print_sheet(console: Console, sheet: Sheet) -> None:
    """Print a table, labels to the left and numbers to the right, in parts where it is too wide."""
    for number, columns in enumerate(_parts(sheet, console.width)):
        table = Table(
            title=None if number else sheet.title, box=box.SIMPLE_HEAD, title_justify="left",
            title_style="", header_style="bold", pad_edge=False, padding=(0, 1, 0, 0),
        )  # fmt: skip
        for i in columns:
            words = sheet.words or not i
            table.add_column(sheet.columns[i], justify="left" if words else "right", no_wrap=not words)
        for row in sheet.rows:
            table.add_row(*(row[i] for i in columns))
        console.print(table)
    for note in sheet.notes:
        text = textwrap.fill(plain(note), console.width, subsequent_indent="  ", break_on_hyphens=False)
        console.print(text)


def _parts(sheet: Sheet, width: int) -> list[list[int]]:
    """Columns that stand side by side, the first of all in every part."""
    if sheet.words:
        return [list(range(len(sheet.columns)))]
    wide = [max(map(cell_len, column)) + 2 for column in zip(sheet.columns, *sheet.rows)]
    wide[0] = min(wide[0], max(width // 2, 12))  # labels may take several lines
    parts = [[0]]
    for i in range(1, len(wide)):
        if len(parts[-1]) > 1 and sum(wide[k] for k in parts[-1]) + wide[i] > width:
            parts.append([0])
        parts[-1].append(i)
    return parts


def print_verdict(console: Console, attributes: dict[str, Any]) -> None:
    """Print the comparisons and the verdict of an archive."""
    for text, value in json.loads(attributes["comparisons"]).items():
        console.print(f"  {text}: {value:.1e}")
    styles = {"PASS": "bold green", "FAIL": "bold red"}
    console.print(f"verdict: {attributes['verdict']}", style=styles.get(attributes["verdict"]))
    for reason in json.loads(attributes["verdict_reasons"]):
        console.print(f"  {reason}")
