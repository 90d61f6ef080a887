"""Options of a figure, checked against an archive, and the files that figures are written to.

A choice says which figures, states and quantities are drawn, over what, how large and in which units. A
drawing is a figure with its caption. Files have names, formats and a resolution; all are written, or
none.
"""

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures import canvas, maps
from galinx.postprocess.figures.canvas import Size
from galinx.postprocess.figures.maps import Film
from galinx.postprocess.quantities import Quantity, table
from galinx.postprocess.quantities.quantity import TEXT
from galinx.postprocess.quantities.states import SPEED
from galinx.postprocess.target import Folder, Kind, Target

from ..errors import BadInput, nearest, short

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
        unit: N/(2a) [MPa], in which stresses are archived, that of each state where states differ in it,
            (states,); 0: stresses are drawn over N/(2a).
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
        """Names of the options set by the user that say what is drawn."""
        names = ("states", "quantities", "method", "x", "y", "by")
        return {name for name in names if getattr(self, name)}

    @property
    def in_si(self) -> bool:
        """True where stresses are drawn in MPa."""
        return bool(np.any(self.unit))

    def scale(self, row: Quantity) -> NDArray[np.float64]:
        """Factor by which the numbers of a quantity are multiplied, (1, 1) or (states, 1)."""
        unit = self.unit if self.in_si and row.unit == "N/(2a)" else 1.0
        return np.reshape(np.asarray(unit, dtype=float), (-1, 1))

    def scale_of(self, row: Quantity, state: int) -> float:
        """Factor by which the numbers of a quantity in one state are multiplied."""
        scale = self.scale(row)
        return float(scale[state if len(scale) > 1 else 0, 0])

    def frames(self, states: Sequence[int]) -> list[tuple[float, float]]:
        """Half-width and middle [mm] of some states' contacts; none where positions are over a."""
        return [] if self.ends is None else [(self.ends[0][i], self.ends[1][i]) for i in states]

    def called(self, row: Quantity) -> str:
        """Name of a quantity without a symbol, with MPa where it is a stress drawn in SI."""
        return short_name(row) + " (MPa)" * (self.in_si and row.unit == "N/(2a)")

    def label(self, stress: str, symbol: str, between: str = " ") -> str:
        """Axis label of a stress: its name, its symbol in TeX, and its unit, MPa or N/(2a)."""
        unit = "$ (MPa)" if self.in_si else "/(N/2a)$"
        return f"{stress}{between}${symbol}{unit}"

    def check_states(self, data: dict[str, Any]) -> None:
        """Refuse numbers of states that an archive does not have.

        Raises:
            BadInput: the archive has no such state.
        """
        count = len(data[SPEED.path])
        for state in self.states:
            if not 0 <= state < count:
                raise BadInput(
                    f"--states: found {state}, expected numbers from 0 to {count - 1}; show lists them"
                )


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


def has_quantities(data: Mapping[str, Any], *rows: Quantity) -> bool:
    """Return True if an archive holds all of these quantities."""
    return all(row.path in data for row in rows)


def by_method(
    data: Mapping[str, Any], over: tuple[str, ...], method: str = ""
) -> dict[str, dict[str, Quantity]]:
    """Quantities of an archive over some dimensions, by name and method.

    Args:
        data: datasets of the archive by path.
        over: dimensions.
        method: the only method whose quantities are returned; "": those of all methods.
    """
    quantities: dict[str, dict[str, Quantity]] = {}
    for path, row in table().items():
        selected = path in data and row.over == over and row.type != TEXT and not row.symbol
        if selected and method in ("", row.method):
            quantities.setdefault(path.rpartition("/")[2], {})[row.method] = row
    return quantities


#: Dots per inch that a file may have.
_DPI = range(30, 2401)


class Written(NamedTuple):
    """A file that was written.

    Attributes:
        path: its name.
        noun: what it is.
        left_out: which states it does not show and how to draw them.
    """

    path: Path
    noun: str
    left_out: str


@dataclass(frozen=True)
class Files:
    """Destination of figures: folder or file, names, formats and resolution.

    Attributes:
        to: a folder, or a file whose ending is its format.
        name: prefix of the names of files in a folder; with "" they are the figures' own.
        formats: endings; () for the usual ones.
        dpi: dots per inch, 0 for the usual ones.
        overwrite: files of any kind are replaced.
        inputs: files that are read, and never replaced.
    """

    to: Path
    name: str = ""
    formats: tuple[str, ...] = ()
    dpi: int = 0
    overwrite: bool = False
    inputs: tuple[Path, ...] = ()

    @property
    def ending(self) -> str:
        """Ending of a single file, "" for a folder."""
        suffix = self.to.suffix.removeprefix(".").lower()
        return "" if self.to.is_dir() or not suffix.isalnum() or len(suffix) > 4 else suffix

    def check(self, names: Sequence[str]) -> None:
        """Refuse formats that cannot be written, before anything is drawn.

        Args:
            names: of the figures.

        Raises:
            BadInput: a format, or a file for several figures; the message says what to do.
        """
        if self.dpi and self.dpi not in _DPI:
            raise BadInput(f"--dpi: found {self.dpi}, expected {_DPI[0]} to {_DPI[-1]}")
        for name in names:
            valid, option = _formats(name), f"-o {self.to}" if self.ending else "--format"
            for ending in (self.ending,) if self.ending else self.formats:
                if ending not in valid:
                    raise BadInput(
                        f"{option}: found {ending!r} for the {_noun(name)} {name}, expected "
                        f"{', '.join(valid)}{' or a folder' * bool(self.ending)}{_converted(ending)}"
                    )
                if ending in maps.FORMATS and not maps.can_write(ending):
                    raise BadInput(
                        f"{option}: {ending} needs ffmpeg, which is not installed; gif does not"
                    )
        if self.ending and self.formats not in ((), (self.ending,)):
            raise BadInput(f"--format {','.join(self.formats)} is not the ending of {self.to}; give one")
        if self.ending and len(names) != 1:
            raise BadInput(
                f"-o {self.to} is one file, found {len(names)} figures; choose one by --figure: "
                f"{', '.join(names)}; or name a folder"
            )

    def endings(self, name: str) -> tuple[str, ...]:
        """Formats of a figure."""
        usual = ("mp4" if maps.can_write("mp4") else "gif",) if name == FILM else canvas.USUAL
        return (self.ending,) if self.ending else self.formats or usual

    def target(self, name: str, ending: str, folder: Folder | None) -> Target:
        """A figure's file.

        Raises:
            Occupied: something is there that may not be replaced.
        """
        if folder is None:
            return Target(self.to, _formats(name)[ending], self.overwrite, self.inputs)
        return folder.target(f"{self.name}_{name}.{ending}".removeprefix("_"), _formats(name)[ending])

    def write(
        self, drawings: Iterator[Drawing], made: Callable[[], tuple[Film, str]] | None
    ) -> list[Written]:
        """Write all figures, and the film if ``made`` is given; none where one cannot be written."""
        folder = None if self.ending else Folder(self.to, self.overwrite, self.inputs)
        files, said = [], []
        for name, left_out, content in self._contents(drawings, made):
            for ending in self.endings(name):
                target = self.target(name, ending, folder)
                files.append((target, content(ending)))
                said.append(Written(target.path, _noun(name), left_out))
        canvas.write(files)
        return said

    def _contents(
        self, drawings: Iterator[Drawing], made: Callable[[], tuple[Film, str]] | None
    ) -> Iterator[tuple[str, str, Callable[[str], bytes]]]:
        """Name of each picture, states that it leaves out, and a function that makes its file."""
        for drawing in drawings:
            yield (
                drawing.name,
                drawing.left_out,
                partial(canvas.content, drawing.figure, dpi=self.dpi or canvas.DPI),
            )
        if made:
            moving, left_out = made()
            yield FILM, left_out, partial(maps.content, moving, dpi=self.dpi or maps.DPI)


#: The picture that moves.
FILM = "film"


def _formats(name: str) -> dict[str, Kind]:
    if name == FILM:
        return maps.FORMATS
    return {ending: kind for ending, (_, kind) in canvas.FORMATS.items()}


def _noun(name: str) -> str:
    return "film" if name == FILM else "figure"


def _converted(ending: str) -> str:
    vector = ending in ("eps", "ps", "emf")
    return f"; convert a {'pdf' if vector else 'png'} for {ending}" if vector or ending in _PIXELS else ""


#: Formats that other programs make of PNG.
_PIXELS = ("jpg", "jpeg", "tif", "tiff", "bmp")
