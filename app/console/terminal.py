"""What commands print at their end."""

import json
import os
import sys
import textwrap
from collections.abc import Iterable
from typing import Any

from galinx.app import ranks
from galinx.app.console.streams import plain, width
from galinx.app.process import link
from galinx.clock import Clock


def say(text: str, hang: int = 2) -> None:
    """Print a line, folded at the terminal's width (80 columns where it is none)."""
    print(textwrap.fill(plain(text), width(), subsequent_indent=" " * hang, break_on_hyphens=False))


def colours() -> bool:
    """Only for a terminal, without NO_COLOR: mpirun hands its ranks one even where there is none."""
    own = link.is_there() or not ranks.by_mpirun()
    return own and sys.stdout.isatty() and not os.environ.get("NO_COLOR")


def print_summary(data: dict[str, Any], attributes: dict[str, Any], quiet: bool = False) -> None:
    """States, comparisons and verdict unless quiet; warnings go to the error stream."""
    if not quiet:
        from galinx.postprocess.tables import states_sheet

        print_sheets([states_sheet(data, attributes["title"])], attributes)
    print_warnings(attributes)


def print_sheets(sheets: Iterable[Any], attributes: dict[str, Any]) -> None:
    """Tables of an archive, comparisons and verdict."""
    from galinx.app.console.sheets import new_console, print_sheet, print_verdict

    console = new_console(colours=colours())
    for sheet in sheets:
        print_sheet(console, sheet)
    print_verdict(console, attributes)


def print_warnings(attributes: dict[str, Any]) -> None:
    """Warnings of an archive, on the error stream."""
    for text in json.loads(attributes["warnings"]):
        print(f"warning: {text}", file=sys.stderr)


def print_times(clock: Clock) -> None:
    """Wall time of the process, and of the steps that took most of it."""
    clock.lap()
    steps = sorted(((seconds, name) for name, seconds in clock.items()), reverse=True)
    told = ", ".join(f"{name} {seconds:.2g} s" for seconds, name in steps[:4] if seconds >= 0.01)
    say(f"time: {sum(clock.values()):.3g} s{f' ({told})' if told else ''}")
