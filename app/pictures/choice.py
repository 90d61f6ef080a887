"""What a user wants drawn, and how large: options of plot, checked against what an archive has."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

from galinx.app.errors import BadInput
from galinx.postprocess.figures.canvas import Size
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
    """

    figures: tuple[str, ...] = ()
    states: tuple[int, ...] = ()
    quantities: tuple[str, ...] = ()
    method: str = ""
    x: str = ""
    y: tuple[str, ...] = ()
    by: str = ""
    size: Size | None = None

    @property
    def given(self) -> set[str]:
        """Options that say what is drawn."""
        names = ("states", "quantities", "method", "x", "y", "by")
        return {name for name in names if getattr(self, name)}

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


def words(text: str) -> tuple[str, ...]:
    """The words between commas."""
    return tuple(word.strip() for word in text.split(",") if word.strip())


def numbers(text: str) -> tuple[int, ...]:
    """Numbers of states: ``0,4,7`` or ``0-3,8``.

    Raises:
        BadInput: there is something else.
    """
    found: list[int] = []
    for word in words(text):
        parts = re.fullmatch(r"(\d{1,9})(?:-(\d{1,9}))?", word)
        if not parts:
            raise BadInput(f"--states: found {word!r}, expected numbers as in 0,4,7 or 0-3")
        first, last = int(parts[1]), int(parts[2] or parts[1])
        if last - first > 1_000_000:
            raise BadInput(f"--states: found {word!r}, expected fewer states")
        found += range(first, last + 1)
    return tuple(dict.fromkeys(found))


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


def one_of(option: str, word: str, known: Iterable[str]) -> str:
    """A word that is known.

    Raises:
        BadInput: it is not; the message names the nearest, and all.
    """
    known = list(known)
    if word in known:
        return word
    close = get_close_matches(word, known, 1)
    hint = f" (did you mean {close[0]}?)" if close else ""
    raise BadInput(f"{option}: found {word}{hint}, expected one of {', '.join(known) or 'none'}")
