"""The one renderer of figures: panels of curves and maps in rows, by matplotlib's constrained layout.

Texts are folded, and ticks chosen, for the size of panels; a figure is as tall as its panels need, and no
taller than a page.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, floor, log10
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox, ScaledTranslation
from numpy.typing import NDArray

from galinx.texts import folded, in_tex, plain

from .style import GREY, PAGE, SMALL, TALLEST, Look, styled

#: Least side of a legible panel, free space around it, and what names of axes of y may be longer [in].
_LEAST, _EDGE, _OVER = 0.35, 0.04, 0.25
#: Height that panels have at least where a page has room [in], and markers along a curve.
_LOW, _MARKERS = 0.95, 16
#: Numbers beyond these are over a power of ten, which stands beside their unit.
_SHORT, _LONG = 1e-2, 1e5
#: Times that the room around panels is measured, and what a figure is larger meanwhile [in].
_ROUNDS, _SPARE = 2, 9.0

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
        lines: draw lines of equal numbers.
        level: number along which a white line is drawn; 0 for none.
        above: numbers at -Y, (rows, columns), and their level; None for nothing above Y = 0.
        equal: both axes have one scale.
    """

    X: NDArray
    Y: NDArray
    values: NDArray
    label: str = ""
    limit: float = 1.0
    signed: bool = False
    extend: str = "neither"
    lines: bool = False
    level: float = 0.0
    above: tuple[NDArray, float] | None = None
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


def note(look: Look, label: str, form: str = LINE, width: float = 1.0) -> Curve:
    """Entry of a legend that is of no curve in particular."""
    return Curve(np.empty(0), np.empty(0), look, label, form, width)


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
    figure = Figure((size.width, size.height or TALLEST), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(rows, columns, height_ratios=[panel.tall for panel in panels[::columns]])
    drawn = []
    for n, panel in enumerate(panels):
        letter = f"({chr(97 + n)})  " if len(panels) > 1 else ""
        drawn.append(_Drawn(figure.add_subplot(grid[divmod(n, columns)]), panel, letter))
    named = {c.label: c for p in panels if not p.own_legend for c in p.curves if c.label}
    foot = _legend(figure, [_entry(curve) for curve in (*named.values(), *notes)])
    _arrange(drawn, size, (rows, columns), high, foot)
    figure.panels = tuple(panels)  # type: ignore[attr-defined]  # for charts on pages
    return figure


def across(width: float, count: int, least: float = 1.55) -> int:
    """Panels in a row of a figure so wide [in], as evenly as rows can be filled."""
    most = max(1, min(3, int(width / least)))
    if count == 4 and most == 3:
        return 2
    return ceil(count / ceil(count / most))


def _entry(curve: Curve) -> Line2D:
    look, style = curve.look, dict[str, Any](linestyle=curve.look.line)
    if curve.form != LINE:
        style |= {"marker": look.marker, "markerfacecolor": "none"}
    if curve.form in (MARKERS, DOTS):
        style["linestyle"] = "none"
    return Line2D([], [], color=look.colour, label=curve.label, linewidth=curve.width, **style)


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
        self.axis, self.panel, self.letter = axis, panel, letter
        self.legend = self.bar = self.other = None
        # Nothing stands above most panels, where matplotlib would look for it at every drawing.
        self.title = axis.set_title("", loc="left", y=None if panel.beside else 1.0)
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
        if panel.map and panel.map.label:
            beside = axis.inset_axes((1.0, 0.0, 1.0, 1.0))
            beside.set_axes_locator(lambda *_: _aside(axis))
            self.bar = axis.figure.colorbar(axis.images[0], cax=beside, extend=panel.map.extend)
            self.bar.ax.tick_params(labelsize=SMALL)
            self.bar.set_label(panel.map.label, fontsize=SMALL)
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
            self.other = axis.secondary_xaxis(
                "top", functions=(lambda x: factor * x, lambda x: x / factor)
            )
            self.other.set_xlabel(label)
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
        x, y, look = np.asarray(curve.x), np.asarray(curve.y) / 10.0**self.power, curve.look
        style: dict[str, Any] = {
            "gid": "curve", "color": look.colour, "linewidth": curve.width, "markerfacecolor": "none",
        }  # fmt: skip
        if curve.form in (LINE, JOINED):
            style["linestyle"] = look.line
        else:
            style |= {"linestyle": "none", "markersize": 2.8}
        if curve.form != LINE:
            style["marker"] = look.marker
        if curve.form == MARKERS:
            at = spaced(x.astype(float), curve.turn)
            x, y = x[at], y[at]
        elif curve.form == JOINED:
            at = spaced(x.astype(float), curve.turn)
            style |= {"linewidth": 0.6 * curve.width, "markevery": at.tolist()}
        elif curve.form == DOTS:
            style["markersize"] = 2.0 * curve.width
            if look.marker == ".":  # many
                style |= {"markerfacecolor": look.colour, "markeredgewidth": 0.0, "rasterized": True}
        return self.axis.plot(x, y, **style)[0]

    def fit(self, wide: float, tall: float) -> None:
        """Choose ticks, and fold texts, for a panel so wide and so tall [in]."""
        axis, panel, figure = self.axis, self.panel, self.axis.figure
        for one, side, apart in ((axis.xaxis, wide, 0.42), (axis.yaxis, tall, 0.26)):
            if one.get_scale() == "linear":
                whole = panel.whole and one is axis.xaxis
                count = max(2, min(8, int(side / apart)))
                one.set_major_locator(MaxNLocator(count, integer=whole, steps=[1, 2, 2.5, 5, 10]))
        if self.bar is not None:
            assert panel.map
            fit_text(self.bar.ax.yaxis.label, panel.map.label, tall + _OVER)
            self.bar.locator = MaxNLocator(max(2, int(4.0 * tall)))
            self.bar.update_ticks()
        if self.other is not None:
            self.other.xaxis.set_major_locator(MaxNLocator(max(2, int(wide / 0.5))))
        unit = in_tex(panel.unit)
        if self.power:
            unit = f"$10^{{{self.power}}}${' ' + unit if unit else ''}"
        y = panel.y and (f"{panel.y} ({unit})" if unit else panel.y)
        fit_text(self.title, self.letter + panel.title, wide + _EDGE)
        fit_text(axis.xaxis.label, panel.x or "", wide + _EDGE)
        fit_text(axis.yaxis.label, y or "", tall + _OVER * bool(self.letter))
        if self.legend is not None:
            ticks = axis.xaxis.get_tightbbox(figure.canvas.get_renderer())
            lower = (ticks.y0 - axis.bbox.y0) / figure.dpi - _EDGE
            below = axis.transAxes + ScaledTranslation(0.0, lower, figure.dpi_scale_trans)
            self.legend.set_bbox_to_anchor((0.5, 0.0), below)


def _aside(axis: Axes) -> Bbox:
    """Place of the colour bar of a panel."""
    x, y, w, h = axis.get_position().bounds
    wide = axis.figure.get_figwidth()
    return Bbox.from_bounds(x + w + 0.06 / wide, y, 0.09 / wide, h)


def _draw_arrows(axis: Axes, line: Line2D, shares: Sequence[float]) -> None:
    """Draw arrows along a curve, once its panel has its place."""
    style = {"arrowstyle": "-|>", "color": line.get_color(), "shrinkA": 0, "shrinkB": 0}
    points = line.get_xydata()
    for share in shares:
        at = point_along(axis.transData.transform(points).T, share)
        axis.annotate("", points[at + 1], points[at], arrowprops=style | {"mutation_scale": 9})


def point_along(points: NDArray, share: float, scale: NDArray | None = None) -> int:
    """Number of the point of a polyline, (2, n), from which its next side is at a share of its length.

    Args:
        points: x and y.
        share: 0 to 1.
        scale: lengths along both axes that are drawn alike, (2,).
    """
    steps = np.diff(points) if scale is None else np.diff(points) / scale[:, None]
    way = np.append(0.0, np.cumsum(np.hypot(*steps)))
    return min(int(np.searchsorted(way, share * way[-1])), len(way) - 2)


def fit_text(text: Text, words: str, room: float) -> None:
    """Set a text, in as many lines as it needs where it has so much room [in]."""
    along, renderer = int(text.get_rotation() > 0.0), text.figure.canvas.get_renderer()
    text.set_text(words)
    lines = ceil(text.get_window_extent(renderer).size[along] / text.figure.dpi / room)
    for count in range(lines, lines + 3) if lines > 1 and words.strip() else ():
        text.set_text(folded(words, max(6, ceil(len(plain(words)) / count * 1.12))))
        if text.get_window_extent(renderer).size[along] / text.figure.dpi <= room:
            break


def _draw_map(axis: Axes, shown: Map) -> None:
    X, Y = shown.X, shown.Y
    half_X, half_Y = (abs(z[-1] - z[0]) / max(len(z) - 1, 1) / 2.0 for z in (X, Y))
    along, heights = (X[0] - half_X, X[-1] + half_X), np.array([Y[0] - half_Y, Y[-1] + half_Y])
    lowest, colours = (-shown.limit, "RdBu_r") if shown.signed else (0.0, "viridis")
    bodies = [(1.0, shown.values, shown.level), *([(-1.0, *shown.above)] if shown.above else ())]
    for side, values, level in bodies:
        axis.imshow(
            values, extent=(*along, *side * heights), origin="lower", interpolation="bilinear",
            aspect="auto", cmap=colours, vmin=lowest, vmax=shown.limit,
        )  # fmt: skip
        if shown.lines:
            levels = MaxNLocator(9).tick_values(lowest, shown.limit)
            axis.contour(X, side * Y, values, levels, colors="black", linewidths=0.3)
        if values.max() > level > 0.0:
            axis.contour(X, side * Y, values, [level], colors="white", linewidths=1.0)
    top = -Y[0] if shown.above else max(Y[-1], 0.0) if shown.equal else Y[-1]
    axis.set(xlim=(X[0], X[-1]), ylim=(Y[0], top))


def _legend(figure: Figure, handles: Sequence[Line2D]) -> float:
    """Draw a legend at the foot of a figure, in as few lines as it fits on; its height [in]."""
    if not handles:
        return 0.0
    width, dpi = figure.get_figwidth(), figure.dpi
    room = (width - 0.1) * dpi
    rows = max(1, floor(sum(0.05 * len(plain(str(one.get_label()))) + 0.5 for one in handles) / width))
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
        fit_text(text, text.get_text(), width - 0.5)
    return legend.get_window_extent(figure.canvas.get_renderer()).height / dpi + 0.05


def _arrange(
    drawn: Sequence[_Drawn], size: Size, shape: tuple[int, int], high: float, foot: float
) -> None:
    """Give panels the room that texts and the legend leave, and a figure the height that panels need.

    Raises:
        TooSmall: panels would not be legible.
    """
    (rows, columns), figure = shape, drawn[0].axis.figure
    talls = sum(one.panel.tall for one in drawn[::columns])
    maps = [one.axis for one in drawn if one.panel.map and one.panel.map.equal]
    ratio = float(np.ptp(maps[0].get_ylim()) / np.ptp(maps[0].get_xlim())) if maps else high
    figure.align_ylabels()

    def arranged(width: float, height: float) -> tuple[float, float]:
        """Width and height around all columns and rows of panels on such a figure [in]."""
        figure.set_size_inches(width, height)
        engine, share = figure.get_layout_engine(), foot / height
        engine.set(w_pad=_EDGE, h_pad=_EDGE, hspace=0.0, wspace=0.0, rect=(0.0, share, 1.0, 1.0 - share))
        engine.execute(figure)
        sides = np.array([one.axis.get_position(original=True).size for one in drawn])
        return width * (1.0 - sides[:columns, 0].sum()), height * (1.0 - sides[::columns, 1].sum())

    wide = size.width / columns - 0.8
    tall = ((size.height - foot) / rows - 0.5) if size.height else max(wide * ratio, _LOW)
    for _ in range(_ROUNDS):
        for one in drawn:
            one.fit(max(wide, _LEAST), max(tall * one.panel.tall, _LEAST))
        across_, along = arranged(size.width + _SPARE, TALLEST + _SPARE)
        wide = (size.width - across_) / columns
        height = size.height or min(along + talls * max(wide * ratio, 0.0 if maps else _LOW), TALLEST)
        tall = (height - along) / talls
        if maps:
            wide, tall = min(wide, tall / ratio), min(tall, wide * ratio)
    if min(wide, tall) < _LEAST:
        needed = f"{across_ + columns * _LEAST / min(ratio, 1.0):.1f} in"
        if size.height is not None:
            needed = f"{across_ + columns * _LEAST:.1f} in x {along + talls * _LEAST:.1f} in"
        raise TooSmall(f"expected at least {needed} for {rows} x {columns} panels")
    figure.set_layout_engine("compressed")  # maps that are narrower than their room stay together
    for axis in maps:
        axis.set_box_aspect(ratio)
    arranged(size.width, height)
    figure.set_layout_engine("none")  # which would arrange them again at every drawing
    for one in drawn:
        for curve, line in zip(one.panel.curves, one.lines):
            _draw_arrows(one.axis, line, curve.arrows)


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
