"""The one renderer of figures: panels of curves and maps, laid out by what they measure.

A figure is a list of panels in rows. Letters, ticks, titles, colour bars and legends are measured as they
are printed, and panels take the room that is left: nothing is cut, nothing overlaps, and a figure is no
taller than a page.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, floor, isfinite, log10
from typing import Any, NamedTuple

import numpy as np
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from galinx.texts import folded, plain

from .style import GREY, PAGE, SMALL, TALLEST, Look, styled

#: Least side of a legible panel, free space around a figure and between panels [in].
_LEAST, _EDGE, _BETWEEN = 0.35, 0.04, 0.14
#: Height that panels have at least where a page has room [in], and markers along a curve.
_LOW, _MARKERS = 0.95, 16
#: Numbers beyond these are over a power of ten, which stands beside their unit.
_SHORT, _LONG = 1e-2, 1e5
#: Times that a layout is measured: texts that are folded need other room.
_ROUNDS = 4

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
        least: smallest one, for colours over decades; 0 for colours that begin at -limit or 0.
        signed: zero is in the middle of the colours.
        extend: ends of the bar at which colours are clipped.
        lines: draw lines of equal numbers.
        level: number along which a white line is drawn; 0 for none.
        equal: both axes have one scale.
    """

    X: NDArray
    Y: NDArray
    values: NDArray
    label: str = ""
    limit: float = 1.0
    least: float = 0.0
    signed: bool = False
    extend: str = "neither"
    lines: bool = False
    level: float = 0.0
    equal: bool = True


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


def handle(look: Look, label: str, **style: Any) -> Line2D:
    """Line of a legend, for which curves have this look."""
    return Line2D([], [], **({"color": look.colour, "linestyle": look.line, "label": label} | style))


def lines_and_markers(lines: str, markers: str) -> list[Line2D]:
    """Handles that say what lines and what markers are."""
    return [handle(Look(GREY, "-", ""), f"lines: {lines}"), marked(f"markers: {markers}")]


def marked(label: str, marker: str = "o") -> Line2D:
    """Marker of a legend, of no curve in particular."""
    return Line2D(
        [], [], color=GREY, linestyle="none", marker=marker, markerfacecolor="none", label=label
    )


@styled
def render(
    panels: Sequence[Panel],
    size: Size | None = None,
    columns: int = 0,
    notes: Sequence[Line2D] = (),
    high: float = 0.62,
) -> Figure:
    """Draw panels in rows.

    Args:
        panels: what to draw.
        size: of the figure; a page wide if not given.
        columns: panels in a row, as many as are legible if not given.
        notes: more handles of the legend, after those of the curves.
        high: height of a panel over its width; a map has that of its grid.

    Raises:
        TooSmall: panels would not be legible; the message says how large the figure has to be.
    """
    size = size or Size(PAGE)
    columns = min(columns or across(size.width, len(panels)), len(panels))
    rows = ceil(len(panels) / columns)
    figure = Figure((size.width, size.height or TALLEST / 2.0))
    FigureCanvasAgg(figure)
    made = []
    for n, panel in enumerate(panels):
        axis = figure.add_subplot(rows, columns, n + 1)
        letter = f"({chr(97 + n)})  " if len(panels) > 1 else ""
        made.append(_Drawn(axis, panel, letter))
    named = {c.label: c for p in panels if not p.own_legend for c in p.curves if c.label}
    handles = [_entry(curve) for curve in named.values()] + list(notes)
    _Layout(figure, made, columns, size, high, handles).arrange()
    for drawn in made:
        for curve in drawn.panel.curves:
            _draw_arrows(drawn.axis, curve)
    figure.panels = tuple(panels)  # type: ignore[attr-defined]  # for charts on pages
    return figure


def across(width: float, count: int, least: float = 1.55) -> int:
    """Panels in a row of a figure so wide [in], as evenly as rows can be filled."""
    most = max(1, min(3, int(width / least)))
    if count == 4 and most == 3:
        return 2
    return ceil(count / ceil(count / most))


def _entry(curve: Curve) -> Line2D:
    marker = {} if curve.form == LINE else {"marker": curve.look.marker, "markerfacecolor": "none"}
    line = {"linestyle": "none"} if curve.form in (MARKERS, DOTS) else {}
    return handle(curve.look, curve.label, linewidth=curve.width, **marker, **line)


def spaced(x: NDArray, turn: float, most: int = _MARKERS) -> NDArray[np.int64]:
    """Numbers of at most so many points, evenly along x, between those of curves with another turn."""
    finite = np.flatnonzero(np.isfinite(x))
    if len(finite) <= most:
        return finite
    low, high = float(x[finite].min()), float(x[finite].max())
    wanted = low + (high - low) * (np.arange(most) + 0.5 * turn + 0.25) / most
    return finite[np.unique(np.abs(x[finite, None] - wanted).argmin(axis=0))]


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
        self.axis, self.panel, self.letter, self.legend = axis, panel, letter, None
        self.power = _power(panel)
        for low, high in panel.bands:
            axis.axvspan(low, high, color="#F2F2F2", linewidth=0.0, zorder=-1)
        for x in panel.at_x:
            axis.axvline(x, color=GREY, linewidth=0.4, zorder=0)
        for y in panel.at_y:
            axis.axhline(y / 10.0**self.power, color=GREY, linewidth=0.4, zorder=0)
        self.lines = [self._curve(curve) for curve in panel.curves]
        if panel.map:
            _draw_map(axis, panel.map)
        for y in panel.dashes:
            axis.axhline(y, color="black", linewidth=0.6, linestyle=(0, (5.0, 2.5)))
        if panel.bar:
            axis.plot(panel.bar, [0.0, 0.0], color="black", linewidth=2.5, clip_on=False)
        for name in panel.log:
            getattr(axis, f"set_{name}scale")("log")
        if panel.xlim:
            axis.set_xlim(panel.xlim)
        if panel.ylim:
            axis.set_ylim([y / 10.0**self.power for y in panel.ylim])
        if panel.beside and panel.beside[1]:
            label, factor = panel.beside
            axis.tick_params(top=False)
            other = axis.secondary_xaxis(
                "top", functions=(lambda x, by=factor: by * x, lambda x, by=factor: x / by)
            )
            other.set_xlabel(label)
        if panel.whole:
            axis.xaxis.get_major_locator().set_params(integer=True)
        if panel.x is None:
            axis.tick_params(labelbottom=False)
        if panel.y is None:
            axis.tick_params(labelleft=False)
        if panel.own_legend:
            entries = [_entry(curve) for curve in panel.curves if curve.label]
            if entries:
                self.legend = axis.legend(
                    handles=entries, loc="upper center", borderaxespad=0.0, labelspacing=0.2,
                    columnspacing=1.2,
                )  # fmt: skip

    def _curve(self, curve: Curve) -> Line2D:
        y = np.asarray(curve.y) / 10.0**self.power
        style: dict[str, Any] = {
            "gid": "curve",
            "color": curve.look.colour,
            "linewidth": curve.width,
            "markerfacecolor": "none",
        }
        if curve.form == LINE:
            return self.axis.plot(curve.x, y, linestyle=curve.look.line, **style)[0]
        if curve.form == DOTS:
            if curve.look.marker == ".":  # many
                style |= {
                    "markerfacecolor": curve.look.colour,
                    "markeredgewidth": 0.0,
                    "rasterized": True,
                }
            size = 2.0 * curve.width
            return self.axis.plot(curve.x, y, curve.look.marker, markersize=size, **style)[0]
        at = spaced(np.asarray(curve.x, dtype=float), curve.turn)
        if curve.form == JOINED:
            style |= {
                "linewidth": 0.6 * curve.width,
                "linestyle": curve.look.line,
                "markevery": at.tolist(),
            }
            return self.axis.plot(curve.x, y, marker=curve.look.marker, **style)[0]
        return self.axis.plot(np.asarray(curve.x)[at], y[at], curve.look.marker, **style, markersize=2.8)[
            0
        ]

    def fit(self, wide: float, tall: float) -> None:
        """Fold texts, and thin out ticks, to a panel so wide and so tall [in]."""
        axis, panel = self.axis, self.panel
        dpi = axis.figure.dpi
        unit = panel.unit
        if self.power:
            unit = f"$10^{{{self.power}}}${' ' + unit if unit else ''}"
        label = panel.y if panel.y is None or not unit else f"{panel.y} ({unit})"
        for text, words, room in (
            (axis._left_title, self.letter + panel.title, wide + (0.3 if not self.letter else 0.0)),
            (axis.xaxis.label, panel.x or "", wide + 0.35),
            (axis.yaxis.label, label or "", tall + 0.25),
        ):
            if words.strip():
                fit_text(text, words, room * dpi)
        for one, side, apart in ((axis.xaxis, wide, 0.42), (axis.yaxis, tall, 0.26)):
            if one.get_scale() == "linear":
                one.set_major_locator(
                    MaxNLocator(
                        max(2, min(8, int(side / apart))),
                        integer=panel.whole and one is axis.xaxis,
                        steps=[1, 2, 2.5, 5, 10],
                    )
                )
        for other in axis.child_axes:
            if hasattr(other, "_functions") and panel.beside:
                other.xaxis.set_major_locator(MaxNLocator(max(2, int(wide / 0.5))))
        if self.legend is not None:
            self._place_legend(wide, tall)

    def _place_legend(self, wide: float, tall: float) -> None:
        """Put the panel's own legend under what is below it."""
        axis = self.axis
        assert self.legend is not None
        below = axis.bbox.y0 - min(box.y0 for box in _boxes(axis, of_legend=False))
        self.legend.set_bbox_to_anchor((0.5, -(below / axis.figure.dpi + 0.03) / tall), axis.transAxes)


def _draw_arrows(axis: Axes, curve: Curve) -> None:
    """Draw arrows along a curve, once its panel has its place."""
    style = {"arrowstyle": "-|>", "color": curve.look.colour, "shrinkA": 0, "shrinkB": 0}
    points = np.column_stack([curve.x, curve.y])
    for share in curve.arrows:
        steps = np.hypot(*np.diff(axis.transData.transform(points), axis=0).T)
        way = np.append(0.0, np.cumsum(steps))
        at = min(int(np.searchsorted(way, share * way[-1])), len(way) - 2)
        axis.annotate("", points[at + 1], points[at], arrowprops=style | {"mutation_scale": 9})


def fit_text(text: Text, words: str, room: float) -> None:
    """Set a text, in as many lines as it needs where it has so much room [pixels]."""
    text.set_text(words)
    box = text.get_window_extent(text.figure.canvas.get_renderer())
    long = max(box.height, box.width) if text.get_rotation() else box.width
    if long > room:
        lines = ceil(long / room)
        for count in range(lines, lines + 3):
            text.set_text(folded(words, max(6, ceil(len(plain(words)) / count * 1.12))))
            box = text.get_window_extent(text.figure.canvas.get_renderer())
            if (max(box.height, box.width) if text.get_rotation() else box.width) <= room:
                return


def _draw_map(axis: Axes, shown: Map) -> None:
    X, Y = shown.X, shown.Y
    half_X, half_Y = (abs(z[-1] - z[0]) / max(len(z) - 1, 1) / 2.0 for z in (X, Y))
    extent = (X[0] - half_X, X[-1] + half_X, Y[0] - half_Y, Y[-1] + half_Y)
    if shown.least:
        scale: dict[str, Any] = {"norm": colors.LogNorm(shown.least, max(shown.limit, 2.0 * shown.least))}
    else:
        scale = {"vmin": -shown.limit if shown.signed else 0.0, "vmax": shown.limit}
    colours = "cividis" if shown.least else "RdBu_r" if shown.signed else "viridis"
    axis.imshow(
        np.maximum(shown.values, shown.least) if shown.least else shown.values, extent=extent,
        origin="lower", interpolation="bilinear", aspect="auto", cmap=colours, **scale,
    )  # fmt: skip
    if shown.lines:
        levels = MaxNLocator(9).tick_values(-shown.limit if shown.signed else 0.0, shown.limit)
        axis.contour(X, Y, shown.values, levels, colors="black", linewidths=0.3)
    if shown.values.max() > shown.level > 0.0:
        axis.contour(X, Y, shown.values, [shown.level], colors="white", linewidths=1.0)
    axis.set(xlim=(X[0], X[-1]), ylim=(Y[0], max(Y[-1], 0.0) if shown.equal else Y[-1]))


def _boxes(axis: Axes, of_legend: bool = True) -> list[Any]:
    """Boxes of what stands around a panel and in it [pixels]."""
    renderer = axis.figure.canvas.get_renderer()
    parts: list[Any] = [axis.bbox]
    parts += [one.get_tightbbox(renderer) for one in (axis.xaxis, axis.yaxis)]
    if axis._left_title.get_text():
        parts.append(axis._left_title.get_window_extent(renderer))
    parts += [child.get_tightbbox(renderer) for child in axis.child_axes]
    if of_legend and axis.get_legend():
        parts.append(axis.get_legend().get_window_extent(renderer))
    return [box for box in parts if box is not None and isfinite(box.x0 + box.y1)]


class _Layout:
    """Places of panels, colour bars and the legend of a figure."""

    def __init__(
        self, figure: Figure, drawn: Sequence[_Drawn], columns: int, size: Size, high: float,
        handles: Sequence[Line2D],
    ) -> None:  # fmt: skip
        self.figure, self.drawn, self.columns, self.size, self.high = figure, drawn, columns, size, high
        self.rows = ceil(len(drawn) / columns)
        self.foot = self._legend(handles)
        self.bars = {
            n: self._bar(one) for n, one in enumerate(drawn) if one.panel.map and one.panel.map.label
        }
        tall = [1.0] * self.rows
        for n, one in enumerate(drawn):
            tall[n // columns] = one.panel.tall
        self.tall = np.array(tall)

    def _legend(self, handles: Sequence[Line2D]) -> tuple[Legend | None, float]:
        """Legend at the foot in as few lines as it fits on, and its height [in]."""
        if not handles:
            return None, 0.0
        figure, room = self.figure, (self.size.width - 0.1) * self.figure.dpi
        widths = [0.05 * len(plain(str(one.get_label()))) + 0.5 for one in handles]
        rows = max(1, floor(sum(widths) / self.size.width))
        while True:
            legend = figure.legend(
                handles=handles, ncols=ceil(len(handles) / rows), loc="lower center", borderaxespad=0.15,
                columnspacing=1.2, labelspacing=0.3, handletextpad=0.5, fontsize=SMALL, handlelength=2.2,
            )  # fmt: skip
            box = legend.get_window_extent(figure.canvas.get_renderer())
            if box.width <= room or rows >= len(handles):
                break
            legend.remove()
            rows += 1
        for text in legend.get_texts() if box.width > room else ():
            fit_text(text, text.get_text(), room - 0.4 * figure.dpi)
        box = legend.get_window_extent(figure.canvas.get_renderer())
        return legend, box.height / figure.dpi + 0.05

    def _bar(self, one: _Drawn) -> Any:
        shown = one.panel.map
        assert shown
        beside, panel, wide = one.axis.inset_axes((1.04, 0.0, 0.04, 1.0)), one.axis, self.size.width

        def locate(axis: Axes, renderer: Any) -> Bbox:
            x, y, w, h = panel.get_position().bounds
            return Bbox.from_bounds(x + w + 0.06 / wide, y, 0.09 / wide, h)

        beside.set_axes_locator(locate)
        bar = self.figure.colorbar(one.axis.images[0], cax=beside, extend=shown.extend)
        bar.ax.tick_params(labelsize=SMALL)
        return bar

    def arrange(self) -> None:
        """Put everything in its place.

        Raises:
            TooSmall: panels would not be legible.
        """
        self._align()
        wide, tall = self.size.width / self.columns - 0.6, 1.0
        rooms = np.tile([0.45, 0.1, 0.35, 0.2], (len(self.drawn), 1))
        for _ in range(_ROUNDS):
            wide, tall = self._place(rooms)
            for n, one in enumerate(self.drawn):
                one.fit(wide, tall * self.tall[n // self.columns])
                if n in self.bars:
                    self._fit_bar(self.bars[n], one, tall)
            rooms = np.array([self._room(one.axis) for one in self.drawn])
        self._place(rooms)
        for one in self.drawn:
            if one.legend is not None:
                one._place_legend(wide, tall)

    def _fit_bar(self, bar: Any, one: _Drawn, tall: float) -> None:
        label = one.panel.map.label if one.panel.map else ""
        bar.set_label(label, fontsize=SMALL)
        fit_text(bar.ax.yaxis.label, label, (tall + 0.25) * self.figure.dpi)
        if not one.panel.map.least:  # type: ignore[union-attr]
            bar.locator = MaxNLocator(max(2, int(4.0 * tall)))
            bar.update_ticks()

    def _room(self, axis: Axes) -> NDArray[np.float64]:
        """Space that a panel takes to its left, right, below and above [in]."""
        boxes = _boxes(axis)
        low = [min(getattr(box, side) for box in boxes) for side in ("x0", "y0")]
        title = axis._left_title.get_window_extent(axis.figure.canvas.get_renderer())
        right = [box for box in boxes if box.y0 < title.y0 or not axis._left_title.get_text()]
        high = [max(box.x1 for box in right), max(box.y1 for box in boxes)]
        near = axis.bbox
        pixels = [near.x0 - low[0], high[0] - near.x1, near.y0 - low[1], high[1] - near.y1]
        return np.maximum(pixels, 0.0) / axis.figure.dpi

    def _place(self, rooms: NDArray) -> tuple[float, float]:
        """Place panels with so much space around each, (panels, 4); width and height of one [in]."""
        rows, columns, figure = self.rows, self.columns, self.figure
        every = np.zeros((rows * columns, 4))
        every[: len(rooms)] = rooms
        around = every.reshape(rows, columns, 4)
        left, right = around[..., 0].max(axis=0), around[..., 1].max(axis=0)
        below, above = around[..., 2].max(axis=1), around[..., 3].max(axis=1)
        foot = self.foot[1]
        beside = left.sum() + right.sum() + (columns - 1) * _BETWEEN + 2.0 * _EDGE
        between = below.sum() + above.sum() + (rows - 1) * _BETWEEN + 2.0 * _EDGE + foot
        wide = (self.size.width - beside) / columns
        share = self.tall.sum()
        ratio = self._ratio()
        tall = wide * ratio if self.size.height is None else (self.size.height - between) / share
        if self.size.height is None:
            tall = min(max(tall, _LOW * (not self._maps)), (TALLEST - between) / share)
        if min(wide, tall * self.tall.max()) < _LEAST:
            needed = f"{beside + columns * _LEAST / min(ratio, 1.0):.1f} in"
            if self.size.height is not None:
                needed = f"{beside + columns * _LEAST:.1f} in x {between + share * _LEAST:.1f} in"
            raise TooSmall(f"expected at least {needed} for {rows} x {columns} panels")
        spare = 0.0
        if self._maps and tall < wide * ratio:
            spare, wide = (wide - tall / ratio) * columns, tall / ratio
        height = self.size.height or between + share * tall
        figure.set_size_inches(self.size.width, height)
        y = height - _EDGE
        for row in range(rows):
            y -= above[row] + tall * self.tall[row]
            x = _EDGE + spare / 2.0
            for column in range(columns):
                x += left[column]
                n = row * columns + column
                if n < len(self.drawn):
                    self.drawn[n].axis.set_position(
                        [
                            x / self.size.width,
                            y / height,
                            wide / self.size.width,
                            tall * self.tall[row] / height,
                        ]
                    )
                x += wide + right[column] + _BETWEEN
            y -= below[row] + _BETWEEN
        return wide, tall

    @property
    def _maps(self) -> bool:
        """True for maps whose axes have one scale."""
        return any(one.panel.map and one.panel.map.equal for one in self.drawn)

    def _ratio(self) -> float:
        """Height of a panel over its width."""
        for one in self.drawn:
            if one.panel.map and one.panel.map.equal:
                axis = one.axis
                return float(np.ptp(axis.get_ylim()) / np.ptp(axis.get_xlim()))
        return self.high

    def _align(self) -> None:
        self.figure.align_ylabels([one.axis for one in self.drawn])


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
