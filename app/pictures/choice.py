"""What a user wants drawn, and how large: options of plot, checked against what an archive has."""

import re
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from galinx.app.errors import BadInput
from galinx.app.scene.excerpt import nearest, short
from galinx.postprocess.figures.canvas import Size
from galinx.postprocess.quantities import Quantity
from galinx.postprocess.quantities.states import SPEED

_INCHES = {"in": 1.0, "cm": 1.0 / 2.54, "mm": 1.0 / 25.4, "pt": 1.0 / 72.0}
_LENGTH = r"(\d+(?:\.\d*)?|\.\d+)\s*(in|cm|mm|pt)"
_SIZE = re.compile(rf"\s*{_LENGTH}(?:\s*[x×]\s*{_LENGTH})?\s*")

#: Widths and heights that paper and films have [in].
_LEAST, _MOST = 1.5, 40.0


@dataclass(frozen=True)
class Choice:
    """What is drawn; what is not given is chosen by itself.

    Attributes:
        figures: their names.
        states: numbers of states.
        quantities: names of quantities, as the columns of ``csv`` end.
        method: of solution.
        x, by: what curves are drawn over, and what tells them apart.
        y: names of what is drawn over ``x``.
        size: of every figure.
        unit: of stresses, N/(2a), in MPa; 0: they are drawn over it.
    """

    figures: tuple[str, ...] = ()
    states: tuple[int, ...] = ()
    quantities: tuple[str, ...] = ()
    method: str = ""
    x: str = ""
    y: tuple[str, ...] = ()
    by: str = ""
    size: Size | None = None
    unit: float = 0.0

    @property
    def given(self) -> set[str]:
        """Options that say what is drawn."""
        names = ("states", "quantities", "method", "x", "y", "by")
        return {name for name in names if getattr(self, name)}

    def scale(self, row: Quantity) -> float:
        """What a quantity's numbers are multiplied by."""
        return self.unit if self.unit and row.unit == "N/(2a)" else 1.0

    def called(self, row: Quantity) -> str:
        """A quantity without a symbol, with its unit where that is not N/(2a)."""
        return noun(row) + " (MPa)" * (self.scale(row) != 1.0)

    def label(self, stress: str, symbol: str, between: str = " ") -> str:
        """What a stress is called, its symbol in TeX, and its unit."""
        unit = "$ (MPa)" if self.unit else "/(N/2a)$"
        return f"{stress}{between}${symbol}{unit}"

    def check_states(self, data: dict[str, Any]) -> None:
        """
        Raises:
            BadInput: the archive has no such state.
        """
        count = len(data[SPEED.path])
        for state in self.states:
            if not 0 <= state < count:
                raise BadInput(
                    f"--states: found {state}, expected numbers from 0 to {count - 1}; show lists them"
                )


def noun(row: Quantity) -> str:
    """What a quantity is, without how it was found."""
    told = re.split(r"[,;:]| \(", row.about)[0]
    return f"{told} over $a$" if "over the half-width" in row.about else told


def words(text: str) -> tuple[str, ...]:
    """The words between commas."""
    return tuple(word.strip() for word in text.split(",") if word.strip())


def size(text: str) -> Size | None:
    """``3.5in``, or with a height ``89mm x 60mm``.

    Raises:
        BadInput: it is no size, or one that no figure has.
    """
    if not text:
        return None
    found = _SIZE.fullmatch(text)
    if not found:
        raise BadInput(
            f"--size: found {text!r}, expected a width or width x height in in, cm, mm or pt, as 3.5in "
            "or 89mm x 60mm"
        )
    width, in_width, height, in_height = found.groups()
    sides = [float(width) * _INCHES[in_width]]
    sides += [float(height) * _INCHES[in_height]] if height else []
    for side in sides:
        if not _LEAST <= side <= _MOST:
            raise BadInput(f"--size: found {text}, expected {_LEAST:g} to {_MOST:g} in")
    return Size(*sides)


def one_of(what: str, word: str, known: Collection[str]) -> str:
    """A word that is known.

    Raises:
        BadInput: it is not; the message names the nearest, or all.
    """
    if word in known:
        return word
    raise BadInput(f"{what} {short(word)!r}: there is none{nearest(word, known)}")
