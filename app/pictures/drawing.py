"""A picture of an archive, and what pictures ask of archives."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from matplotlib.figure import Figure

from galinx.postprocess.quantities import Quantity, table
from galinx.postprocess.quantities.quantity import TEXT


@dataclass(frozen=True)
class Drawing:
    """A figure.

    Attributes:
        name: for files.
        caption: what it shows, what to see in it, and what it leaves out; plain text.
        figure: it.
        pixels: a page should hold it as such.
        left_out: which states it does not show and how to get them; nothing where it shows all.
    """

    name: str
    caption: str
    figure: Figure
    pixels: bool = False
    left_out: str = ""

    @property
    def told(self) -> str:
        """Caption and what is left out."""
        return f"{self.caption} {self.left_out}".strip()


def there(data: Mapping[str, Any], *rows: Quantity) -> bool:
    """Does an archive hold all of these?"""
    return all(row.path in data for row in rows)


def by_method(
    data: Mapping[str, Any], over: tuple[str, ...], method: str = ""
) -> dict[str, dict[str, Quantity]]:
    """An archive's numbers over some dimensions, by name and method.

    Args:
        data: the archive's.
        over: dimensions.
        method: that is wanted alone, if any.
    """
    found: dict[str, dict[str, Quantity]] = {}
    for path, row in table().items():
        told = path in data and row.over == over and row.type != TEXT and not row.symbol
        if told and method in ("", row.method):
            found.setdefault(path.rpartition("/")[2], {})[row.method] = row
    return found
