"""Canvas of figures: sheets of panels in inches, their letters and legends, and files made of them."""

import os
from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from io import BytesIO
from math import ceil
from multiprocessing import get_context
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from ..target import PDF, PNG, SVG, Folder, Kind, Target
from .style import DPI, GREY, SMALL, Look, plain, styled

#: Key of a file's metadata that names its maker, and the kind of file, by the format's ending.
FORMATS: dict[str, tuple[str, Kind]] = {
    "pdf": ("Creator", PDF),
    "png": ("Software", PNG),
    "svg": ("Creator", SVG),
}

#: Formats by default: text that stays text, and pixels for everything else.
USUAL = ("pdf", "png")

#: Figures from which on a process of its own draws a format sooner.
_WORTH_A_PROCESS = 4

#: Least size of a legible panel [in].
_LEAST = 0.35

#: Approximate width of a legend's letter, of the space beside its text, and height of a line [in].
_LETTER, _BESIDE, _LINE = 0.048, 0.62, 0.155


class Size(NamedTuple):
    """Width and height of a figure [in]; without a height the figure takes what it needs."""

    width: float
    height: float | None = None


class Room(NamedTuple):
    """Free space around panels and between them [in]."""

    left: float = 0.5
    right: float = 0.08
    bottom: float = 0.4
    top: float = 0.2
    across: float = 0.5
    down: float = 0.45


class TooSmall(ValueError):
    """A figure does not fit on its prescribed size."""


def panels(
    rows: int, columns: int, size: Size, high: float, room: Room, heights: Sequence[float] | None = None
) -> tuple[Figure, NDArray]:
    """Figure with a grid of axes, (rows, columns).

    Args:
        rows, columns: of the grid.
        size: of the figure.
        high: height of a panel over its width where ``size`` has no height.
        room: around and between.
        heights: of the rows over each other, all the same if not given, (rows,).

    Raises:
        TooSmall: panels would not be legible; the message says how large the figure has to be.
    """
    beside = room.left + room.right + (columns - 1) * room.across
    above = room.bottom + room.top + (rows - 1) * room.down
    wide = (size.width - beside) / columns
    tall = wide * high if size.height is None else (size.height - above) / rows
    if min(wide, tall) < _LEAST:
        needed = f"{beside + columns * _LEAST / min(high, 1.0):.1f} in"
        if size.height is not None:
            needed = f"{beside + columns * _LEAST:.1f} in x {above + rows * _LEAST:.1f} in"
        raise TooSmall(f"expected at least {needed} for {rows} x {columns} panels")
    height = above + rows * tall
    figure = Figure((size.width, height))
    FigureCanvasAgg(figure)
    place: dict[str, Any] = {
        "height_ratios": heights,
        "left": room.left / size.width, "right": 1.0 - room.right / size.width,
        "bottom": room.bottom / height, "top": 1.0 - room.top / height,
        "wspace": room.across / wide, "hspace": room.down / tall,
    }  # fmt: skip
    return figure, figure.subplots(rows, columns, squeeze=False, gridspec_kw=place)


def lettered(axes: Iterable[Axes], titles: Sequence[str] = (), above: bool = False) -> None:
    """Give panels their letters, each before its title; a panel alone needs none.

    Args:
        axes: the panels.
        titles: of the first of them.
        above: something is drawn above panels, and titles have to make way for it. Measuring it takes
            matplotlib a tenth of all its time.
    """
    axes = list(axes)
    all_titles = [*titles, *[""] * (len(axes) - len(titles))]
    for n, (axis, title) in enumerate(zip(axes, all_titles)):
        letter = f"({chr(97 + n)})  " if len(axes) > 1 else ""
        if letter or title:
            axis.set_title(letter + title, y=None if above else 1.0)


class Legend:
    """Legend below all panels, which meets no curve.

    Args:
        handles: lines with labels.
        width: of the figure [in].
    """

    def __init__(self, handles: Sequence[Line2D], width: float) -> None:
        self._handles = handles
        widths = [len(plain(str(handle.get_label()))) * _LETTER + _BESIDE for handle in handles]
        rows = next((n for n in range(1, len(widths)) if _wide(widths, n) < width - 0.1), len(widths))
        self._columns = ceil(len(handles) / max(1, rows))
        #: Height that it needs [in].
        self.height = rows * _LINE + 0.08 if handles else 0.0

    def below(self, axis: Axes, lowered: float) -> None:
        """Draw it under a panel, so far [in]."""
        if self._handles:
            figure = axis.get_figure()
            place = -lowered / (axis.get_position().height * figure.get_figheight())
            axis.legend(
                handles=self._handles, ncols=self._columns, loc="upper center",
                bbox_to_anchor=(0.5, place), borderaxespad=0.0, columnspacing=1.4, labelspacing=0.2,
            )  # fmt: skip

    def put(self, figure: Figure) -> None:
        """Draw it at the foot of a figure."""
        if self._handles:
            figure.legend(
                handles=self._handles, ncols=self._columns, loc="lower center", borderaxespad=0.15,
                columnspacing=1.4, labelspacing=0.3, fontsize=SMALL,
            )  # fmt: skip


def _wide(widths: Sequence[float], rows: int) -> float:
    """Width [in] of a legend that is filled column by column."""
    return sum(max(widths[n : n + rows]) for n in range(0, len(widths), rows))


def handle(look: Look, label: str, **style: Any) -> Line2D:
    """Line of a legend, for which curves have this look."""
    return Line2D([], [], **({"color": look.colour, "linestyle": look.line, "label": label} | style))


def of_methods(exact: bool, fem: bool, lines: str = "closed form") -> list[Line2D]:
    """Handles that explain lines and markers, where a figure has both; else none."""
    if not (exact and fem):
        return []
    return [
        Line2D([], [], color=GREY, label=f"lines: {lines}"),
        Line2D(
            [], [], color=GREY, linestyle="none", marker="o", markerfacecolor="none",
            label="markers: finite elements",
        ),
    ]  # fmt: skip


@styled
def content(figure: Figure, ending: str, dpi: int = DPI) -> bytes:
    """Bytes of a figure's file.

    Args:
        figure: the figure.
        ending: one of ``FORMATS``.
        dpi: dots per inch of what is made of pixels.
    """
    says, _ = FORMATS[ending]
    data = BytesIO()  # matplotlib leaves half of a figure on a full disk
    # Without a date a figure that is drawn again is the same file.
    metadata = {says: "galinx"} | ({"Date": None} if ending == "svg" else {})
    # Pixels that are nearly all white are packed as well at once as after a search.
    packed = {"pil_kwargs": {"compress_level": 1}} if ending == "png" else {}
    figure.savefig(data, format=ending, dpi=dpi, metadata=metadata, **packed)
    figure.set_layout_engine("none")  # laid out once
    return data.getvalue()


def save(figures: Iterable[tuple[str, Figure]], folder: Folder) -> dict[str, bytes]:
    """Write figures by name into a folder in the usual formats; none where one may not be written.

    Returns:
        The pixels of each by name, as PNG, for pages.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    made = _in_usual_formats(dict(figures))
    write(
        (folder.target(f"{name}.{ending}", FORMATS[ending][1]), data)
        for ending, contents in made.items()
        for name, data in contents.items()
    )
    return made["png"]


def _in_usual_formats(figures: Mapping[str, Figure]) -> dict[str, dict[str, bytes]]:
    """Contents of figures by format and name, each format on a core of its own where there is one.

    The other process is a copy of this one, so that no figure has to be handed over. It meets neither
    files nor MPI.
    """
    first, *others = USUAL
    cores = len(os.sched_getaffinity(0))
    # So many pages are drawn in the time that a process takes.
    if cores < len(USUAL) or len(figures) < _WORTH_A_PROCESS:
        return {ending: _contents(figures, ending) for ending in USUAL}
    made: dict[str, dict[str, bytes]] = {}
    with ProcessPoolExecutor(len(others), get_context("fork"), _inherit, (figures,)) as pool:
        drawn = {ending: pool.submit(_inherited_contents, ending) for ending in others}
        made[first] = _contents(figures, first)
        for ending, future in drawn.items():
            try:
                made[ending] = future.result()
            except BrokenProcessPool:  # somebody ended it
                made[ending] = _contents(figures, ending)
    return made


def _contents(figures: Mapping[str, Figure], ending: str) -> dict[str, bytes]:
    return {name: content(figure, ending) for name, figure in figures.items()}


#: The figures of the process that this one is a copy of.
_inherited: dict[str, Figure] = {}


def _inherit(figures: Mapping[str, Figure]) -> None:
    _inherited.update(figures)


def _inherited_contents(ending: str) -> dict[str, bytes]:
    return _contents(_inherited, ending)


def write(files: Iterable[tuple[Target, bytes]]) -> None:
    """Write files; none where one of them cannot be made.

    Args:
        files: each with its bytes, which are all made before the first is written.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    for target, data in list(files):
        target.write(data)


@styled
def in_a_page(figure: Figure, pixels: bool) -> str:
    """Data URI of a figure for a page.

    Args:
        figure: what to show.
        pixels: as PNG, for pictures with too many elements to draw each; else as SVG, without ground.
    """
    data = BytesIO()
    if pixels:
        figure.savefig(data, format="png", dpi=160)
    else:
        figure.savefig(data, format="svg", transparent=True, metadata={"Date": None})
    figure.set_layout_engine("none")
    return embedded(data.getvalue(), "png" if pixels else "svg+xml")


def embedded(data: bytes, kind: str = "png") -> str:
    """Data URI of the bytes of a picture's file."""
    return f"data:image/{kind};base64,{b64encode(data).decode()}"


#: Dots per inch on a screen.
_DPI = 110


def for_notebook(figure: Figure) -> Figure:
    """Figure that notebooks can show, which otherwise know only figures of pyplot."""
    figure._repr_png_ = lambda: _png(figure)  # type: ignore[attr-defined]
    return figure


@styled
def _png(figure: Figure) -> bytes:
    data = BytesIO()
    figure.savefig(data, format="png", dpi=_DPI)
    return data.getvalue()
