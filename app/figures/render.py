"""The one renderer of figures: panels of curves and maps, laid out by what they measure.

A figure is a list of panels in rows. Letters, ticks, titles, colour bars and legends are measured as they
are printed, and panels take the room that is left: nothing is cut, nothing overlaps, and a figure is no
taller than a page.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import ceil, floor, log10
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke
from matplotlib.text import Text
from matplotlib.ticker import LogLocator, MaxNLocator
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from galinx.texts import folded, in_tex, number, plain

from .style import DPI, GREY, PAGE, SMALL, TALLEST, Look, styled

#: Least side of a legible panel, and free space around a figure, between columns and between rows [in].
_LEAST, _EDGE, _ASIDE, _BELOW = 0.35, 0.04, 0.1, 0.05
#: Height that panels have at least where a page has room [in], and markers along a curve.
_LOW, _MARKERS = 0.95, 16
#: Distance of names of axes from their numbers, and of a title from its panel [in].
_PAD = 2.5 / 72.0
#: Numbers beyond these are over a power of ten, which stands beside their unit.
_SHORT, _LONG = 1e-2, 1e5

#: Forms of curves: solutions are lines, finite elements markers; both joined where they are alone.
LINE, MARKERS, JOINED, DOTS = "line", "markers", "joined", "dots"


class TooSmall(ValueError):
    """A figure does not fit on its prescribed size."""


class Size(NamedTuple):
    """Width and height of a figure [in]; without a height the figure takes what it needs."""

    width: float
    height: float | None = None


@dataclass(frozen=True)
class Curve:
    """Numbers over numbers, (n,) each, NaN where there are none.

    Attributes:
        x, y: the numbers.
        look: colour, line and marker.
        label: name in the legend, "" for none.
        form: LINE, MARKERS (as many as can be told apart, between those of others), JOINED (both) or DOTS
            (every number).
        width: of the line [pt].
        turn: place of its markers between those of others, 0 to 1.
        arrows: shares of its length on the page at which arrows point along it.
    """

    x: NDArray
    y: NDArray
    look: Look
    label: str = ""
    form: str = LINE
    width: float = 1.0
    turn: float = 0.0
    arrows: Sequence[float] = ()


@dataclass(frozen=True)
class Map:
    """Numbers on a grid, in colours.

    Attributes:
        X, Y: places along both axes, (columns,) and (rows,).
        values: the numbers, (rows, columns).
        label: of the colour bar; "" for none.
        limit: largest number with a colour of its own.
        signed: zero is in the middle of the colours.
        extend: ends of the bar at which colours are clipped.
        lines: draw lines of equal numbers; colours begin at the least of all.
        level: number of each Y that is reached along a white line, (rows,); infinite for none.
        above: numbers at -Y, (rows, columns), and their level; None for nothing above Y = 0.
        equal: both axes have one scale.
        log: colours go with the logarithm.
    """

    X: NDArray
    Y: NDArray
    values: NDArray
    label: str = ""
    limit: float = 1.0
    signed: bool = False
    extend: str = "neither"
    lines: bool = False
    level: Any = np.inf
    above: tuple[NDArray, Any] | None = None
    equal: bool = True
    log: bool = False


@dataclass(frozen=True)
class Panel:
    """Curves or a map between two axes.

    Attributes:
        x, y: names of the axes; None leaves its numbers away as well.
        unit: of y, which a power of ten may stand before; "" for none.
        curves, map: what is drawn.
        title: above the panel.
        xlim, ylim: limits; None for what fits.
        log: names of logarithmic axes.
        bands: parts of x that are shaded.
        at_x, at_y: thin grey lines.
        beside: a second axis on top: its name, and what x is multiplied by.
        own_legend: names of its curves stand below it.
        tall: height over that of other rows.
        bar: black bar along the top, from where to where.
        dashes: y of dashed lines.
        whole: ticks of x are whole numbers.
        ticks: of x, where they have room; else, and by default, round numbers.
    """

    x: str | None = ""
    y: str | None = ""
    unit: str = ""
    curves: Sequence[Curve] = ()
    map: Map | None = None
    title: str = ""
    xlim: tuple[float, float] | None = None
    ylim: tuple[float, float] | None = None
    log: str = ""
    bands: Sequence[tuple[float, float]] = ()
    at_x: Sequence[float] = ()
    at_y: Sequence[float] = ()
    beside: tuple[str, float] | None = None
    own_legend: bool = False
    tall: float = 1.0
    bar: tuple[float, float] | None = None
    dashes: Sequence[float] = ()
    whole: bool = False
    ticks: Sequence[float] = ()


def as_text(label: str) -> str:
    """Label from a user, in which dollars begin no formula."""
    return label.replace("$", r"\$")


def note(look: Look, label: str, form: str = LINE, width: float = 1.0) -> Curve:
    """Entry of a legend that is of no curve in particular."""
    return Curve(np.empty(0), np.empty(0), look, label, form, width)


def with_dot(panel: Panel, x: float, y: float) -> Panel:
    """A panel with a black dot, the place that a frame of a film shows."""
    dot = Curve(np.array([x]), np.array([y]), Look("black", "none", "o"), form=MARKERS)
    return replace(panel, curves=[*panel.curves, dot])


def lines_and_markers(lines: str, markers: str) -> list[Curve]:
    """Entries of a legend that say what lines and what markers are."""
    look = Look(GREY, "-", "o")
    return [note(look, f"lines: {lines}"), note(look, f"markers: {markers}", MARKERS)]


@styled
def render(
    panels: Sequence[Panel],
    size: Size | None = None,
    columns: int = 0,
    notes: Sequence[Curve] = (),
    high: float = 0.62,
) -> Figure:
    """Draw panels in rows.

    Args:
        panels: what to draw.
        size: of the figure; a page wide if not given.
        columns: panels in a row, as many as are legible if not given.
        notes: more entries of the legend, after those of the curves.
        high: height of a panel over its width; a map has that of its grid.

    Raises:
        TooSmall: panels would not be legible; the message says how large the figure has to be.
    """
    size = size or Size(PAGE)
    columns = min(columns or across(size.width, len(panels)), len(panels))
    rows = ceil(len(panels) / columns)
    # Texts are typeset once: their sizes are measured at the resolution of files.
    figure = Figure((size.width, size.height or TALLEST), dpi=DPI)
    FigureCanvasAgg(figure)
    made = []
    for n, panel in enumerate(panels):
        letter = f"({chr(97 + n)})  " if len(panels) > 1 else ""
        made.append(_Drawn(figure.add_axes((0.0, 0.0, 1.0, 1.0), label=str(n)), panel, letter))
    named = {c.label: c for p in panels if not p.own_legend for c in p.curves if c.label}
    foot = _legend(figure, [*named.values()], notes)
    _arrange(figure, made, size, (rows, columns), high, foot)
    figure.panels = tuple(panels)  # type: ignore[attr-defined]  # for charts on pages
    return figure


def across(width: float, count: int, least: float = 1.55) -> int:
    """Panels in a row of a figure so wide [in], as evenly as rows can be filled."""
    most = max(1, min(3, int(width / least)))
    if count == 4 and most == 3:
        return 2
    return ceil(count / ceil(count / most))


def _style(curve: Curve) -> dict[str, Any]:
    """Colour, line and marker of a curve, and of its entry in a legend."""
    style = {"color": curve.look.colour, "linewidth": curve.width, "markerfacecolor": "none"}
    line = curve.look.line if curve.form in (LINE, JOINED) else "none"
    return style | {"linestyle": line, "marker": "none" if curve.form == LINE else curve.look.marker}


def spaced(x: NDArray, turn: float) -> NDArray[np.int64]:
    """Numbers of the points that have markers, evenly along x, between those of another turn."""
    finite = np.flatnonzero(np.isfinite(x))
    if len(finite) <= _MARKERS:
        return finite
    low, high = float(x[finite].min()), float(x[finite].max())
    places = low + (high - low) * (np.arange(_MARKERS) + 0.5 * turn + 0.25) / _MARKERS
    return finite[np.unique(np.abs(x[finite, None] - places).argmin(axis=0))]


def _power(panel: Panel) -> int:
    """Power of ten over which numbers are neither long nor short; a multiple of three."""
    if "y" in panel.log or panel.map or not panel.curves:
        return 0
    values = np.concatenate([np.ravel(curve.y) for curve in panel.curves])
    values = np.abs(values[np.isfinite(values)])
    largest = float(values.max()) if len(values) else 0.0
    if panel.ylim:
        largest = min(largest, float(np.abs(panel.ylim).max()))
    return 3 * floor(log10(largest) / 3.0) if largest and not _SHORT <= largest < _LONG else 0


class _Drawn:
    """A panel on its axes: what is drawn does not change with its place; texts are folded to fit."""

    def __init__(self, axis: Axes, panel: Panel, letter: str) -> None:
        self.axis, self.panel, self.letter = axis, panel, letter
        self.legend = self.bar = self.other = None
        # Nothing is to be placed by matplotlib, which measures everything for it at every drawing.
        self.title = axis.set_title("", loc="left", y=1.0)
        axis.xaxis.set_label_coords(0.5, 0.0)
        axis.yaxis.set_label_coords(0.0, 0.5)
        self.power = _power(panel)
        for low, high in panel.bands:
            axis.axvspan(low, high, color="#F2F2F2", linewidth=0.0, zorder=-1)
        for x in panel.at_x:
            axis.axvline(x, color=GREY, linewidth=0.4, zorder=0)
        for y in panel.at_y:
            axis.axhline(y / 10.0**self.power, color=GREY, linewidth=0.4, zorder=0)
        for name in panel.log:
            getattr(axis, f"set_{name}scale")("log")
        lines = [self._curve(curve) for curve in panel.curves]
        if panel.map:
            image = _draw_map(axis, panel.map, panel.log)
        if panel.map and panel.map.label:
            beside = axis.inset_axes((1.04, 0.0, 0.04, 1.0))
            beside.set_axes_locator(self._beside)
            self.bar = axis.figure.colorbar(image, cax=beside, extend=panel.map.extend)
            self.bar.ax.tick_params(labelsize=SMALL)
            self.bar.set_label(panel.map.label, fontsize=SMALL)
        for y in panel.dashes:
            axis.axhline(y, color="black", linewidth=0.6, linestyle=(0, (5.0, 2.5)))
        if panel.bar:
            axis.plot(
                panel.bar, [0.0, 0.0], color="black", linewidth=2.5, clip_on=False, solid_capstyle="butt"
            )
        if panel.xlim:
            axis.set_xlim(panel.xlim)
        if panel.ylim:
            axis.set_ylim([y / 10.0**self.power for y in panel.ylim])
        for curve, points in zip(panel.curves, (line.get_xydata() for line in lines)):
            for share in curve.arrows:
                at = point_along(points.T, share, np.ptp([axis.get_xlim(), axis.get_ylim()], axis=1))
                arrow(axis, points[at], points[at + 1], curve.look.colour)
        if panel.beside and panel.beside[1]:
            label, factor = panel.beside
            axis.tick_params(top=False)
            self.other = axis.secondary_xaxis(
                "top", functions=(lambda x: factor * x, lambda x: x / factor)
            )
            self.other.set_xlabel(label)
        if panel.x is None:
            axis.tick_params(labelbottom=False)
        if panel.y is None:
            axis.tick_params(labelleft=False)
        if panel.own_legend and (entries := _entries(panel.curves)):
            self.legend = axis.legend(
                handles=entries, loc="upper center", borderaxespad=0.0, labelspacing=0.2,
                columnspacing=1.2,
            )  # fmt: skip

    def _beside(self, axis: Axes, renderer: Any) -> Bbox:
        """Place of the colour bar."""
        x, y, w, h = self.axis.get_position().bounds
        wide = self.axis.figure.get_figwidth()
        return Bbox.from_bounds(x + w + 0.06 / wide, y, 0.09 / wide, h)

    def _curve(self, curve: Curve) -> Line2D:
        x, y = np.asarray(curve.x, dtype=float), np.asarray(curve.y) / 10.0**self.power
        style = _style(curve) | {"gid": "curve"}
        with np.errstate(divide="ignore", invalid="ignore"):
            along = np.log(x) if "x" in self.panel.log else x  # markers are even on the paper
        if curve.form == MARKERS:
            at = spaced(along, curve.turn)
            x, y = x[at], y[at]
            style["markersize"] = 2.8
        elif curve.form == JOINED:
            at = spaced(along, curve.turn)
            style |= {"linewidth": 0.6 * curve.width, "markevery": at.tolist()}
        elif curve.form == DOTS:
            style["markersize"] = 2.0 * curve.width
            if curve.look.marker == ".":  # many
                colour = curve.look.colour
                style |= {"markerfacecolor": colour, "markeredgewidth": 0.0, "rasterized": True}
        return self.axis.plot(x, y, **style)[0]

    def measure(self, wide: float, tall: float, beside: float) -> "_Room":
        """Choose ticks, and fold texts, for a panel so wide and so tall, with so much beside it [in]."""
        axis, panel, figure = self.axis, self.panel, self.axis.figure
        renderer, dpi = figure.canvas.get_renderer(), figure.dpi
        axis.set_position((0.0, 0.0, wide / figure.get_figwidth(), tall / figure.get_figheight()))
        for scale, side, apart in ((axis.xaxis, wide, 0.42), (axis.yaxis, tall, 0.26)):
            scale.label.set_text("")
            if scale.get_scale() == "linear":
                whole = panel.whole and scale is axis.xaxis
                count = max(2, min(8, int(side / apart)))
                scale.set_major_locator(MaxNLocator(count, integer=whole, steps=[1, 2, 2.5, 5, 10]))
        few, span = len(panel.ticks) > 1 and axis.get_xscale() == "linear", np.ptp(axis.get_xlim())
        if few and np.diff(panel.ticks).min() * wide > 0.3 * span:
            axis.set_xticks(panel.ticks)
        if self.bar is not None:
            assert panel.map
            fit_text(self.bar.ax.yaxis.label, panel.map.label, tall + 0.25)
            if not panel.map.log:
                self.bar.locator = MaxNLocator(max(2, int(4.0 * tall)))
                self.bar.update_ticks()
        if self.other is not None:
            self.other.xaxis.set_major_locator(MaxNLocator(max(2, int(wide / 0.5))))
        boxes = [scale.get_tightbbox(renderer) for scale in (axis.xaxis, axis.yaxis, *axis.child_axes)]
        box = Bbox.union([axis.bbox, *filter(None, boxes)])
        left, below, right, above = np.abs(np.subtract(box.extents, axis.bbox.extents)) / dpi
        unit = in_tex(panel.unit)
        if self.power:
            unit = f"$10^{{{self.power}}}${' ' + unit if unit else ''}"
        y = panel.y and (f"{panel.y} ({unit})" if unit else panel.y)
        over = fit_text(self.title, self.letter + panel.title, wide + (_ASIDE if self.letter else 0.3))
        name = fit_text(axis.xaxis.label, panel.x or "", wide + beside)
        upright = fit_text(axis.yaxis.label, y or "", tall + 0.25)
        legend = (0.0, 0.0)
        if self.legend is not None:
            legend = self.legend.get_window_extent(renderer).size / dpi + (0.0, 0.03)
        aside = (max(name[0], legend[0]) - wide) / 2.0
        return _Room(
            left, right, above, below, upright[0], over[1], name[1] + legend[1],
            (upright[1] - tall) / 2.0, aside, max(aside, over[0] - wide),
        )  # fmt: skip

    def place(self, box: tuple[float, float, float, float], room: "_Room") -> None:
        """Put a panel and its texts into their places.

        Args:
            box: its left and lower end, width and height [in].
            room: around it; numbers of axes as wide as in its row and column.
        """
        axis, (x, y, wide, tall) = self.axis, box
        width, height = axis.figure.get_size_inches()
        axis.set_position((x / width, y / height, wide / width, tall / height))
        self.title.set_y(1.0 + room.above / tall)
        axis.xaxis.set_label_coords(0.5, -(room.below + _PAD) / tall)
        axis.yaxis.set_label_coords(-(room.left + _PAD) / wide, 0.5)
        if self.legend is not None:
            high = self.legend.get_window_extent(axis.figure.canvas.get_renderer()).height
            below = room.below + room.name - high / axis.figure.dpi
            self.legend.set_bbox_to_anchor((0.5, -below / tall), axis.transAxes)


def arrow(axis: Axes, start: Sequence[float], end: Sequence[float], colour: str = "black") -> None:
    """Draw an arrow."""
    style = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9}
    axis.annotate("", end, start, arrowprops=style)


def point_along(points: NDArray, share: float, scale: Any) -> int:
    """Number of the point of a polyline, (2, n), from which its next side is at a share of its length.

    Args:
        points: x and y.
        share: 0 to 1.
        scale: lengths along both axes that are drawn alike, (2,).
    """
    way = np.append(0.0, np.cumsum(np.hypot(*np.diff(points) / np.reshape(scale, (2, 1)))))
    return min(int(np.searchsorted(way, share * way[-1])), len(way) - 2)


def fit_text(text: Text, words: str, room: float) -> NDArray[np.float64]:
    """Set a text, in as many lines as it needs where it has so much room [in].

    Returns:
        Its width and height [in], across lines with its distance from what is beside it; 0 for no words.
    """
    along, renderer = int(text.get_rotation() > 0.0), text.figure.canvas.get_renderer()

    def measured(words: str) -> NDArray[np.float64]:
        text.set_text(words)
        return text.get_window_extent(renderer).size / text.figure.dpi

    if not words.strip():
        return np.zeros(2)
    size = measured(words)
    lines = ceil(size[along] / room)
    for count in range(lines, lines + 3) if lines > 1 else ():
        size = measured(folded(words, max(6, ceil(len(plain(words)) / count * 1.12))))
        if size[along] <= room:
            break
    size[1 - along] += _PAD
    return size


def _draw_map(axis: Axes, shown: Map, log: str) -> ScalarMappable:
    """Draw a map, on axes of which some are logarithmic; what its colour bar is of."""
    X, Y = shown.X, shown.Y
    half_X, half_Y = (abs(z[-1] - z[0]) / max(len(z) - 1, 1) / 2.0 for z in (X, Y))
    along, heights = (X[0] - half_X, X[-1] + half_X), np.array([Y[0] - half_Y, Y[-1] + half_Y])
    lowest, colours = (-shown.limit, "RdBu_r") if shown.signed else (0.0, "viridis")
    if shown.lines and not shown.signed:
        lowest = float(np.nanmin(shown.values))
    norm, locator = Normalize(lowest, shown.limit), MaxNLocator(9)
    if shown.log:
        norm = LogNorm(lowest, shown.limit)
        locator = LogLocator(subs=(1.0, 2.0, 5.0))
    if log:
        axis.tick_params(axis="x", pad=5.0)  # a power at the end of each axis
    top = -Y[0] if shown.above else max(Y[-1], 0.0) if shown.equal else Y[-1]
    axis.set(xlim=(X[0], X[-1]), ylim=(Y[0], top))
    bodies = [(1.0, shown.values, shown.level), *([(-1.0, *shown.above)] if shown.above else ())]
    for side, values, level in bodies:
        image: ScalarMappable
        if log or not all(np.ptp(np.diff(z)) <= 1e-6 * np.ptp(z) for z in (X, Y)):
            image = axis.pcolormesh(
                X, Y, values, cmap=colours, norm=norm, shading="gouraud", rasterized=True
            )
        else:
            image = axis.imshow(
                values, extent=(*along, *side * heights), origin="lower", interpolation="bilinear",
                aspect="auto", cmap=colours, norm=norm,
            )  # fmt: skip
            # A colour reaches half a cell farther than its point; none is shown beyond the outermost.
            corner, tall = (X[0], min(side * Y[0], side * Y[-1])), abs(Y[-1] - Y[0])
            image.set_clip_path(Rectangle(corner, X[-1] - X[0], tall, transform=axis.transData))
        if shown.lines:
            levels = locator.tick_values(lowest, shown.limit)
            lines = axis.contour(X, side * Y, values, levels, colors="black", linewidths=0.3)
            style = {"fmt": lambda level: f"${number(level)}$", "fontsize": SMALL, "inline_spacing": 1}
            for text in axis.clabel(lines, **style):
                text.set_path_effects([withStroke(linewidth=1.0, foreground="white")])
                part = (axis.transData - axis.transAxes).transform(text.get_position())
                text.set_visible(bool((np.abs(part - 0.5) < 0.46).all()))  # a frame cuts through others
        share = values / np.reshape(level, (-1, 1))
        if share.max() > 1.0:
            axis.contour(X, side * Y, share, [1.0], colors="white", linewidths=1.0)
    return image


def _entries(curves: Sequence[Curve]) -> list[Line2D]:
    """Entries of a legend, of the curves that have a label."""
    return [Line2D([], [], label=curve.label, **_style(curve)) for curve in curves if curve.label]


#: What is beside the texts of a legend, over the size of letters.
_BESIDE_TEXTS = {"columnspacing": 1.2, "handletextpad": 0.5, "handlelength": 2.2}


def _legend(figure: Figure, curves: Sequence[Curve], notes: Sequence[Curve]) -> float:
    """Draw a legend at the foot of a figure, in as few lines as it fits on; its height [in].

    Several notes stand in columns of their own, where there are columns.
    """
    named, noted = _entries(curves), _entries(notes)
    if not (most := len(named) + len(noted)):
        return 0.0
    blank = Line2D([], [], linestyle="none", label=" ")
    width, dpi, renderer = figure.get_figwidth(), figure.dpi, figure.canvas.get_renderer()
    room, widths, beside, frame = (width - 0.1) * dpi, dict[Line2D, float](), 0.0, 0.0
    for rows in range(1, most + 1):
        gap = -len(named) % rows if len(noted) > 1 and rows < most else 0
        handles = [*named, *[blank] * gap, *noted]
        handles += [blank] * (-len(handles) % rows)
        columns = len(handles) // rows
        # Widths follow from those of the first try, which is slow as each is.
        each = np.array([widths.get(entry, 0.0) for entry in handles]).reshape(columns, rows).max(axis=1)
        if 1 < rows < most and frame + columns * beside + each.sum() > room:
            continue
        figure.legends.clear()
        legend = figure.legend(
            handles=handles, ncols=columns, loc="lower center", borderaxespad=0.15, labelspacing=0.3,
            fontsize=SMALL, **_BESIDE_TEXTS,
        )  # fmt: skip
        box = legend.get_window_extent(renderer)
        if box.width <= room:
            break
        if rows == 1:
            widths = {
                entry: text.get_window_extent(renderer).width
                for entry, text in zip(handles, legend.get_texts())
            }
            beside = sum(_BESIDE_TEXTS.values()) * SMALL * dpi / 72.0
            frame = box.width - sum(widths.values()) - columns * beside
    for text in legend.get_texts() if box.width > room else ():
        fit_text(text, text.get_text(), width - 0.5)
    return legend.get_window_extent(renderer).height / dpi + 0.05


class _Room(NamedTuple):
    """Room around a panel [in].

    Attributes:
        left, right, above, below: of numbers of axes, and colour bars.
        upright, title, name: of the name of the axis of y, of the title, and of the name of the axis of x
            with the panel's legend.
        taller, aside, beyond: over the panel's ends, of texts along y, and of those along x on the left
            and on the right.
    """

    left: Any
    right: Any
    above: Any
    below: Any
    upright: Any
    title: Any
    name: Any
    taller: Any
    aside: Any
    beyond: Any


def _arrange(
    figure: Figure, drawn: Sequence[_Drawn], size: Size, shape: tuple[int, int], high: float, foot: float
) -> None:
    """Give panels the room that texts and the legend leave, and a figure the height that panels need.

    All panels are equally wide, and as tall as their rows; names of axes of y are aligned in a column.

    Raises:
        TooSmall: panels would not be legible.
    """
    rows, columns = shape
    talls = np.array([view.panel.tall for view in drawn[::columns]])
    maps = [view.axis for view in drawn if view.panel.map and view.panel.map.equal]
    ratio = float(np.ptp(maps[0].get_ylim()) / np.ptp(maps[0].get_xlim())) if maps else high
    beside = 0.35 if all(view.panel.y for view in drawn) else 0.1
    wide = size.width / columns - 0.8
    tall = max(wide * ratio, _LOW)
    if size.height:
        tall = min(tall, (size.height - foot) / talls.sum() - 0.5)
    room = np.zeros((rows * columns, len(_Room._fields)))
    for _ in range(2):  # texts are folded, and ticks chosen, by the room that they leave
        wide, tall = max(wide, _LEAST), max(tall, _LEAST)
        room[: len(drawn)] = [view.measure(wide, tall * view.panel.tall, beside) for view in drawn]
        of_columns, of_rows = (_Room(*room.reshape(rows, columns, -1).max(axis=n).T) for n in (0, 1))
        left, right = of_columns.left + of_columns.upright, of_columns.right.copy()
        left[0], right[-1] = max(left[0], of_columns.aside[0]), max(right[-1], of_columns.beyond[-1])
        top = np.maximum(of_rows.above + of_rows.title, of_rows.taller)
        bottom = np.maximum(of_rows.below + of_rows.name, of_rows.taller)
        across_ = left.sum() + right.sum() + 2.0 * _EDGE + (columns - 1) * _ASIDE
        along = top.sum() + bottom.sum() + 2.0 * _EDGE + (rows - 1) * _BELOW + foot
        wide = (size.width - across_) / columns
        total = along + talls.sum() * max(wide * ratio, 0.0 if maps else _LOW)
        height = size.height or min(total, TALLEST)
        tall = (height - along) / talls.sum()
        if maps:
            wide, tall = min(wide, tall / ratio), min(tall, wide * ratio)
    if min(wide, tall) < _LEAST:
        if size.height is None and foot > height / 2.0:
            raise TooSmall("its legend takes most of the page; choose fewer curves, or a wider figure")
        needed = f"{across_ + columns * _LEAST / min(ratio, 1.0):.1f} in"
        if size.height is not None:
            needed = f"{across_ + columns * _LEAST:.1f} in x {along + talls.sum() * _LEAST:.1f} in"
        raise TooSmall(f"expected at least {needed} for {rows} x {columns} panels")
    figure.set_size_inches(size.width, height)
    spare = (size.width - across_ - columns * wide) / 2.0  # maps may be narrower than their room
    x = _EDGE + spare + np.cumsum(left + np.append(0.0, right[:-1] + _ASIDE + wide))
    y = height - _EDGE - np.cumsum(top + talls * tall + np.append(0.0, bottom[:-1] + _BELOW))
    for n, view in enumerate(drawn):
        i, j = divmod(n, columns)
        around = _Room(*room[n])._replace(
            left=of_columns.left[j], above=of_rows.above[i], below=of_rows.below[i]
        )
        view.place((x[j], y[i], wide, tall * view.panel.tall), around)


class Film:
    """Figure that changes from frame to frame.

    Args:
        panels: function of a frame's number that gives its panels, of the same curves and maps.
        frames: number of frames.
        size: of the figure.
    """

    def __init__(
        self, panels: Callable[[int], Sequence[Panel]], frames: int, size: Size | None = None
    ) -> None:
        self._panels, self.frames = panels, frames
        first = panels(0)
        self.figure = render(first, size, columns=len(first), high=0.85)
        self._count, self._scales = len(first), [10.0 ** _power(panel) for panel in first]

    def show(self, frame: int) -> None:
        """Draw a frame."""
        for axis, panel, scale in zip(self.figure.axes, self._panels(frame), self._scales):
            curves = [line for line in axis.lines if line.get_gid() == "curve"]
            for line, curve in zip(curves, panel.curves):
                line.set_data(curve.x, np.asarray(curve.y) / scale)
            if panel.map:
                axis.images[0].set_data(panel.map.values)
            letter = axis.get_title(loc="left")[:5] if self._count > 1 else ""
            axis.set_title(letter + panel.title, loc="left")
