"""Options of figures, what they are drawn from, and figures with their captions.

A choice says which figures, states and quantities are drawn, over what, how large and in which units.
"""

import re
from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.quantities import Quantity, table
from galinx.postprocess.quantities.quantity import FEM, METHODS, TEXT
from galinx.postprocess.units import Scaled, Units, as_archived

from ..errors import BadInput, nearest, short
from ..scene.scene import Scene
from .measured import Measured
from .render import Curve, Size, lines_and_markers
from .states import StateLabels
from .style import Look

_INCHES = {"in": 1.0, "cm": 1.0 / 2.54, "mm": 1.0 / 25.4, "pt": 1.0 / 72.0}
_LENGTH = r"(\d+(?:\.\d*)?|\.\d+)\s*(in|cm|mm|pt)"
_SIZE = re.compile(rf"\s*{_LENGTH}(?:\s*[x×]\s*{_LENGTH})?\s*")

#: Widths and heights that paper and films have [in].
_LEAST, _MOST = 1.5, 40.0


@dataclass(frozen=True)
class Choice:
    """Options of a figure; what an empty attribute leaves open is chosen automatically.

    Attributes:
        figures: their names.
        states: numbers of states.
        quantities: names of quantities, as the columns of ``csv`` end.
        method: of solution.
        x, by: names of the numbers that curves are drawn over, and of those that distinguish curves.
        y: names of the numbers drawn over ``x``.
        size: of every figure.
        units: of the result's numbers; None: dimensionless.
        measured: points that lie over figures, as :func:`galinx.app.figures.measured.read` gives them.
    """

    figures: tuple[str, ...] = ()
    states: tuple[int, ...] = ()
    quantities: tuple[str, ...] = ()
    method: str = ""
    x: str = ""
    y: tuple[str, ...] = ()
    by: str = ""
    size: Size | None = None
    units: Units | None = None
    measured: Measured | None = None

    @property
    def given(self) -> set[str]:
        """Names of the options set by the user that say what is drawn."""
        names = ("states", "quantities", "method", "x", "y", "by", "measured")
        return {name for name in names if getattr(self, name)}


def short_name(row: Quantity) -> str:
    """Name of a quantity, from the beginning of its description."""
    name = re.split(r"[,;:]| \(", row.about)[0]
    return f"{name} over $a$" if "over the half-width" in row.about else name


def words(text: str) -> tuple[str, ...]:
    """The words between commas."""
    return tuple(word.strip() for word in text.split(",") if word.strip())


def size(text: str) -> Size | None:
    """Size of a figure from ``3.5in``, or with a height ``89mm x 60mm``; None where the text is empty.

    Raises:
        BadInput: it is no size, or one that no figure has.
    """
    if not text:
        return None
    match = _SIZE.fullmatch(text)
    if not match:
        raise BadInput(
            f"--size: found {text!r}, expected a width or width x height in in, cm, mm or pt, as 3.5in "
            "or 89mm x 60mm"
        )
    width, in_width, height, in_height = match.groups()
    sides = [float(width) * _INCHES[in_width]]
    sides += [float(height) * _INCHES[in_height]] if height else []
    for side in sides:
        if not _LEAST <= side <= _MOST:
            raise BadInput(f"--size: found {text}, expected {_LEAST:g} to {_MOST:g} in")
    return Size(*sides)


def require_one_of(what: str, word: str, valid: Collection[str]) -> str:
    """A word that is one of the valid ones.

    Raises:
        BadInput: it is not; the message names the nearest, or all.
    """
    if word in valid:
        return word
    raise BadInput(f"{what} {short(word)!r}: there is none{nearest(word, valid)}")


@dataclass(frozen=True)
class Drawing:
    """A figure with its caption.

    Attributes:
        name: for files.
        caption: what it shows, what to see in it, and what it leaves out; plain text.
        figure: the matplotlib figure.
        pixels: True where a page should embed it as pixels.
        left_out: which states it does not show and how to draw them; "" where it shows all.
    """

    name: str
    caption: str
    figure: Figure
    pixels: bool = False
    left_out: str = ""

    @property
    def full_caption(self) -> str:
        """Caption, with the states that are left out."""
        return f"{self.caption} {self.left_out}".strip()


class Archive:
    """Source of figures: an archive, its scene, and a choice of what is drawn.

    Args:
        data: datasets by path.
        scene: of the archive.
        choice: states, quantities, axes, size and units.
    """

    def __init__(self, data: dict[str, Any], scene: Scene, choice: Choice) -> None:
        self.data, self.scene, self.choice = data, scene, choice
        self.units = choice.units or Units(scene.body, data, dimensionless=True)

    @cached_property
    def labels(self) -> StateLabels:
        """Parameters that distinguish the states."""
        return StateLabels(self.data, self.scene, self.units)

    def has(self, *rows: Quantity) -> bool:
        """Return True if the archive holds all of these quantities."""
        return all(row.path in self.data for row in rows)

    def by_method(self, *over: str, method: str | None = None) -> dict[str, dict[str, Quantity]]:
        """Quantities over some dimensions, by name and method.

        Args:
            over: dimensions.
            method: the only one whose quantities are returned; "" for all, by default that of the choice.
        """
        method = self.choice.method if method is None else method
        quantities: dict[str, dict[str, Quantity]] = {}
        for path, row in table().items():
            selected = path in self.data and row.over == over and row.type != TEXT and not row.symbol
            if selected and method in ("", row.method):
                quantities.setdefault(path.rpartition("/")[2], {})[row.method] = row
        return quantities

    def scaled(self, row: Quantity) -> Scaled:
        """Unit and scale of a quantity."""
        return self.units(row, "") or as_archived(row, "")

    def values(self, row: Quantity) -> NDArray[np.float64]:
        """Numbers of a quantity in the figure's units."""
        return self.scaled(row).of(self.data[row.path])

    def selected(self) -> NDArray[np.int64]:
        """Chosen states, all by default."""
        return np.array(self.choice.states) if self.choice.states else self.labels.all

    @property
    def size(self) -> Size | None:
        """Size of the figure, where the user set one."""
        return self.choice.size


def named(words: str, unit: str) -> str:
    """Name of an axis with its unit: ``load (N/mm)``, ``pressure $/(N/2a)$``."""
    if unit in ("", "1", "none"):
        return words
    return f"{words} $/({unit.replace('(2a)', '2a')})$" if unit.startswith("N/(") else f"{words} ({unit})"


def both(
    x: NDArray, values: dict[str, NDArray], look: Look, label: str = "", turn: float = 0.0
) -> list[Curve]:
    """Curves of one solution: a line of the closed form or the integral equation, markers of finite
    elements; these joined where they are alone.

    Args:
        x: places, (n,).
        values: numbers there by method, (n,) each.
    """
    lines = [(method, y) for method, y in values.items() if method != FEM]
    curves = [Curve(x, y, look, label) for _, y in lines[:1]]
    if FEM in values:
        form = "markers" if curves else "joined"
        curves.append(Curve(x, values[FEM], look, "" if curves else label, form, turn=turn))
    return curves


def explained(methods: Collection[str]) -> list[Any]:
    """Handles that explain lines and markers, where a figure has both."""
    lines = next((METHODS[name] for name in METHODS if name in methods and name != FEM), "")
    return lines_and_markers(lines, METHODS[FEM]) if lines and FEM in methods else []
