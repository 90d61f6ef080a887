"""What a user wants drawn, and how large: options of plot, checked against what an archive has."""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
        unit: of stresses, N/(2a), in MPa, that of each state where they differ, (states,); 0: they are
            drawn over it.
        ends: half-widths and middles of contacts [mm], (states,) each, where every state has its own and
            is drawn in mm; None: positions are over the half-width.
    """

    figures: tuple[str, ...] = ()
    states: tuple[int, ...] = ()
    quantities: tuple[str, ...] = ()
    method: str = ""
    x: str = ""
    y: tuple[str, ...] = ()
    by: str = ""
    size: Size | None = None
    unit: Any = 0.0
    ends: tuple[NDArray, NDArray] | None = None

    @property
    def given(self) -> set[str]:
        """Options that say what is drawn."""
        names = ("states", "quantities", "method", "x", "y", "by")
        return {name for name in names if getattr(self, name)}

    @property
    def in_si(self) -> bool:
        """Are stresses drawn in MPa?"""
        return bool(np.any(self.unit))

    def scale(self, row: Quantity) -> NDArray[np.float64]:
        """What a quantity's numbers are multiplied by, (1, 1) or (states, 1)."""
        unit = self.unit if self.in_si and row.unit == "N/(2a)" else 1.0
        return np.reshape(np.asarray(unit, dtype=float), (-1, 1))

    def scale_of(self, row: Quantity, state: int) -> float:
        """The same of a state."""
        scale = self.scale(row)
        return float(scale[state if len(scale) > 1 else 0, 0])

    def frames(self, states: Sequence[int]) -> list[tuple[float, float]]:
        """Half-width and middle [mm] of some states' contacts; none where positions are over a."""
        return [] if self.ends is None else [(self.ends[0][i], self.ends[1][i]) for i in states]

    def called(self, row: Quantity) -> str:
        """A quantity without a symbol, with its unit where that is not N/(2a)."""
        return noun(row) + " (MPa)" * (self.in_si and row.unit == "N/(2a)")

    def label(self, stress: str, symbol: str, between: str = " ") -> str:
        """What a stress is called, its symbol in TeX, and its unit."""
        unit = "$ (MPa)" if self.in_si else "/(N/2a)$"
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
