"""How a result looks in a notebook: its title, verdict and states as HTML."""

import json
from collections.abc import Iterable
from html import escape
from typing import Any

from galinx.postprocess.tables import states_sheet

_COLOURS = {"PASS": "#1a7f37", "FAIL": "#c1121f"}


def html(data: dict[str, Any], attributes: dict[str, Any]) -> str:
    """A few lines and a table; all of it plain, without scripts or styles of its own.

    Args:
        data, attributes: of an archive.
    """
    verdict = attributes["verdict"]
    colour = _COLOURS.get(verdict, "inherit")
    sheet = states_sheet(data, attributes["title"])
    reasons = json.loads(attributes["verdict_reasons"])
    warnings = [f"warning: {text}" for text in json.loads(attributes["warnings"])]
    heads = "".join(f"<th>{escape(column)}</th>" for column in sheet.columns)
    rows = "".join(f"<tr>{_cells(row)}</tr>" for row in sheet.rows)
    return (
        f"<p><b>{escape(sheet.title or 'galinx')}</b>: "
        f'<b style="color: {colour}">{escape(verdict)}</b></p>'
        f"{_lines(warnings)}<table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>"
        f"{_lines([*sheet.notes, *reasons])}"
    )


def _cells(row: Iterable[str]) -> str:
    return "".join(f"<td>{escape(cell)}</td>" for cell in row)


def _lines(texts: Iterable[str]) -> str:
    """Small print."""
    told = "<br>".join(map(escape, texts))
    return f"<p><small>{told}</small></p>" if told else ""
