"""What commands print at their end."""

import json
import sys
from typing import Any

from app import ranks


def colours() -> bool:
    """Only for a terminal: mpirun hands its ranks one even where the output goes to a file."""
    return ranks.size() == 1 and sys.stdout.isatty()


def print_summary(data: dict[str, Any], attributes: dict[str, Any], quiet: bool = False) -> None:
    """States, comparisons and verdict unless quiet; warnings go to the error stream."""
    from postprocess.tables import new_console, print_sheet, print_verdict, states_sheet

    if not quiet:
        console = new_console(colours=colours())
        print_sheet(console, states_sheet(data, attributes["title"]))
        print_verdict(console, attributes)
    for text in json.loads(attributes["warnings"]):
        print(f"warning: {text}", file=sys.stderr)


def print_times(data: dict[str, Any]) -> None:
    """Wall time of the steps that took some, longest first."""
    steps = sorted(zip(data["run/seconds"].tolist(), data["run/steps"].tolist()), reverse=True)
    told = ", ".join(f"{name} {seconds:.2g} s" for seconds, name in steps[:4] if seconds >= 0.01)
    print(f"time: {sum(seconds for seconds, _ in steps):.2g} s{f' ({told})' if told else ''}")
