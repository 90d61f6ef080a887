"""Friction: loops with their strokes, stick-slip of sliders, and measured friction with a fitted law.

Each stroke of a loop has its line, its direction and its name. Of a slider the velocity is drawn over
time, and the friction over velocity in its last cycle; of a fit the friction over position and its
residuals.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import ceil
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .canvas import Legend, Room, Size, handle, lettered, panels
from .style import (
    COLOURS,
    COLUMN,
    GREY,
    LINES,
    PAGE,
    SMALL,
    Look,
    looks,
    styled,
)

#: Axes of a loop.
X_LABEL, F_LABEL = "position on the stroke $X/L$", "friction coefficient $f = F/N$"

#: Points of a stroke between its name and its arrow, over all its points, and strokes nearer than this
#: share of the axes, which one name serves.
_APART, _SAME = 0.2, 0.012
#: Points of a stroke that are tried for the place of its name.
_POINTS = 100

#: Variation of friction, over its size, from which on zero is on the axis.
_LEVEL = 0.2


@dataclass(frozen=True)
class Loop:
    """Loop of friction along all strokes in the order of travel.

    Attributes:
        label: its name in a legend.
        X_over_L, f: position over the pre-sliding displacement and friction coefficient, (n,).
        strokes: names of their pieces, each of as many points; pieces of one name that follow each other
            are one stroke.
    """

    label: str
    X_over_L: NDArray
    f: NDArray
    strokes: Sequence[str]

    def along(self) -> Iterator[tuple[str, NDArray, NDArray]]:
        """Name, positions and friction coefficient of each stroke."""
        points, first = len(self.f) // len(self.strokes), 0
        for name, pieces in groupby(self.strokes):
            last = first + points * len(list(pieces))
            yield name, self.X_over_L[first:last], self.f[first:last]
            first = last


@dataclass(frozen=True)
class Panel:
    """Panel of loops; ``ordered``: they follow a number."""

    title: str
    loops: Sequence[Loop]
    ordered: bool = False


@styled
def loops_figure(shown: Sequence[Panel], size: Size | None = None) -> Figure:
    """Figure of friction loops side by side.

    A loop alone has a colour and a name for every stroke; of several each has its colour, and strokes
    are told apart by their lines.
    """
    size = size or Size(COLUMN if len(shown) == 1 else PAGE)
    rows = ceil(len(shown) / max(1, int(size.width / 2.0)))
    columns = ceil(len(shown) / rows)
    entries = [_entries(panel) for panel in shown]
    common = len({tuple(str(line.get_label()) for line in lines) for lines in entries}) == 1
    strokes = _of_strokes(shown)
    foot = Legend([*(entries[0] if common else []), *strokes], size.width)
    wide = (size.width - 0.58) / columns - 0.35
    legends = [Legend([] if common else lines, wide) for lines in entries]
    below = max(legend.height for legend in legends)
    above = 0.2 if len(shown) > 1 or shown[0].title else 0.08
    room = Room(0.48, 0.1, 0.42 + below + foot.height, above, 0.35, 0.55 + below)
    figure, axes = panels(rows, columns, size, 0.62 if columns == 2 else 0.78, room)
    for axis in axes.flat[len(shown) :]:
        axis.remove()
    for n, (axis, panel) in enumerate(zip(axes.flat, shown)):
        draw(axis, panel)
        axis.set_xlabel(X_LABEL)
        if n % columns == 0:
            axis.set_ylabel(F_LABEL)
        legends[n].below(axis, 0.42)
    lettered(axes.flat[: len(shown)], [panel.title for panel in shown])
    foot.put(figure)
    return figure


@styled
def motion_figure(t: NDArray, panel: Panel, size: Size | None = None) -> Figure:
    """Figure of position and friction of a motion over time, and its loop.

    Args:
        t: time over that of a cycle, along all strokes, (points,).
        panel: one loop.
        size: of the figure.
    """
    loop, (_, force) = panel.loops[0], looks(2)
    place = handle(Look(GREY, LINES[1], ""), "position $X/L$")
    legend = Legend([place, handle(force, "friction $f$", linestyle="-")], 3.0)
    room = Room(0.48, 0.1, 0.42 + legend.height, 0.2, 0.5)
    figure, axes = panels(1, 2, size or Size(PAGE), 0.62, room)
    over_time, over_X = axes[0]
    over_time.plot(t, loop.X_over_L, color=GREY, linestyle=LINES[1])
    over_time.plot(t, loop.f, color=force.colour)
    over_time.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
    over_time.set(xlabel="time over that of a cycle", ylabel="position $X/L$, friction $f$")
    over_time.margins(x=0.0)
    draw(over_X, panel)
    over_X.set(xlabel=X_LABEL, ylabel=F_LABEL)
    legend.below(over_time, 0.42)
    lettered(axes.flat, ["over time", "over position"])
    return figure


def _entries(panel: Panel) -> list[Any]:
    if len(panel.loops) == 1:
        return []
    loops = zip(panel.loops, looks(len(panel.loops), panel.ordered))
    return [handle(look, loop.label, linestyle="-") for loop, look in loops]


def _of_strokes(shown: Sequence[Panel]) -> list[Any]:
    """Handles that explain lines as strokes where colours stand for loops."""
    several = [panel for panel in shown if len(panel.loops) > 1]
    names = [name for name, *_ in several[0].loops[0].along()] if several else []
    return [handle(Look(GREY, LINES[n % len(LINES)], ""), name) for n, name in enumerate(names)]


def draw(axis: Axes, panel: Panel) -> None:
    """Draw the loops of a panel, without names of its axes."""
    alone = len(panel.loops) == 1
    f = np.array([loop.f for loop in panel.loops])
    low, high = float(f.min()), float(f.max())
    if high - low > _LEVEL * max(abs(low), abs(high)):  # else zero would flatten all loops
        low, high = min(0.0, low), max(0.0, high)
    margin = 0.06 * (high - low) or 1.0
    axis.set(xlim=(-0.03, 1.03), ylim=(low - margin, high + margin))
    axis.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
    for k, (loop, look) in enumerate(zip(panel.loops, looks(len(panel.loops), panel.ordered))):
        strokes = list(loop.along())
        # Loops that are the same are drawn one in the other, the first as the widest line.
        again = sum(np.array_equal(loop.f, later.f) for later in panel.loops[k + 1 :])
        for n, (stroke_look, (_, X, values)) in enumerate(zip(looks(len(strokes)), strokes)):
            colour = stroke_look.colour if alone else look.colour
            if again:
                axis.plot(X, values, color=colour, linewidth=1.0 + 1.2 * again)
                continue
            axis.plot(X, values, color=colour, linestyle=LINES[n % len(LINES)])
            at = _freest(axis, strokes, n) if alone else int(len(X) * (0.25 + 0.5 * k / len(panel.loops)))
            if at is not None:
                _point(axis, X, values, at, colour, strokes[n][0] if alone else "")


def _freest(axis: Axes, strokes: Sequence[tuple[str, NDArray, NDArray]], n: int) -> int | None:
    """Index of the point of a stroke farthest from others; None where an earlier stroke is the same."""
    _, X, f = strokes[n]
    if len(strokes) == 1:
        return len(X) // 2
    scale = np.array([np.ptp(axis.get_xlim()), np.ptp(axis.get_ylim())])
    own = np.column_stack([X, f]) / scale
    coarse = max(1, len(X) // _POINTS)
    inner = np.arange(len(X) // 6, len(X) - len(X) // 3, coarse)
    nearest = []
    for _, other_X, other_f in strokes:
        other = np.column_stack([other_X, other_f])[::coarse] / scale
        gaps = own[inner, None] - other[None]
        nearest.append(np.hypot(gaps[..., 0], gaps[..., 1]).min(axis=1))
    distinct = [gap for m, gap in enumerate(nearest) if m != n and (m < n or gap.max() >= _SAME)]
    free = np.min(distinct, axis=0) if distinct else np.ones(len(inner))
    at = int(np.argmax(free))
    return None if free[at] < _SAME else int(inner[at])


def _point(axis: Axes, X: NDArray, f: NDArray, at: int, colour: Any, name: str) -> None:
    """Draw an arrow along a stroke, and its name."""
    ahead = min(at + int(_APART * len(X)) * bool(name), len(X) - 3)
    axis.annotate(
        "", (X[ahead + 1], f[ahead + 1]), (X[ahead], f[ahead]),
        arrowprops={
            "arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9,
        },
    )  # fmt: skip
    if name:
        box = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}
        axis.text(X[at], f[at], name, color=colour, fontsize=SMALL, ha="center", va="center", bbox=box)


#: Steps of a cycle between its beginning and an arrow, over all.
_ARROWS = (0.25, 0.75)


@dataclass(frozen=True)
class Slide:
    """Motion of a slider.

    Attributes:
        label: its name in a legend.
        v: velocity at the times [m/s].
        cycle_v, cycle_f: velocity [m/s] and friction coefficient in the last cycle, NaN for none.
    """

    label: str
    v: NDArray
    cycle_v: NDArray
    cycle_f: NDArray


@styled
def slider_figure(
    t: NDArray, slides: Sequence[Slide], drive_speed: float, ordered: bool, size: Size | None = None
) -> Figure:
    """Figure of sliders side by side: all velocities over time, and the loops of their last cycles.

    Args:
        t: times [s].
        slides: what to draw.
        drive_speed: of the spring's other end [m/s], a line.
        ordered: the sliders follow a number.
        size: of the figure.
    """
    size = size or Size(PAGE)
    styles = looks(len(slides), ordered)
    several = len(slides) > 1
    handles = [handle(look, slide.label) for look, slide in zip(styles, slides)] if several else []
    legend = Legend(handles, size.width)
    wide = size.width > 4.5
    room = Room(0.6, 0.1, 0.42 + legend.height, 0.2, 0.65, 0.65)
    figure, axes = panels(1 if wide else 2, 2 if wide else 1, size, 0.62, room)
    first, second = axes.flat
    for look, slide in zip(styles, slides):
        first.plot(t, slide.v, color=look.colour, linestyle=look.line)
        if np.isfinite(slide.cycle_v).all():
            second.plot(slide.cycle_v, slide.cycle_f, color=look.colour, linestyle=look.line)
            for share in _ARROWS:
                _arrow(second, slide, share, look.colour)
    for draw in (first.axhline, second.axvline):
        draw(drive_speed, color=GREY, linewidth=0.4, zorder=0)
    first.set(xlabel="time $t$ (s)", ylabel=r"velocity $v$ (m/s)", xlim=(0.0, t[-1]))
    second.set(xlabel=r"velocity $v$ (m/s)", ylabel="friction coefficient $f = F/N$")
    lettered(axes.flat)
    legend.put(figure)
    return figure


def _arrow(axis: Axes, slide: Slide, share: float, colour: Any) -> None:
    """Draw an arrow along a loop, where the share of its length on the page is done."""
    spans = np.ptp(slide.cycle_v) or 1.0, np.ptp(slide.cycle_f) or 1.0
    steps = np.hypot(np.diff(slide.cycle_v) / spans[0], np.diff(slide.cycle_f) / spans[1])
    way = np.append(0.0, np.cumsum(steps))
    from_, to = np.searchsorted(way, [share * way[-1], (share + 0.02) * way[-1]])
    to = min(max(int(to), int(from_) + 1), len(way) - 1)
    axis.annotate(
        "", (slide.cycle_v[to], slide.cycle_f[to]), (slide.cycle_v[from_], slide.cycle_f[from_]),
        arrowprops={
            "arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9,
        },
    )  # fmt: skip


#: Powers of ten of a metre with its prefix, from which on lengths are written so.
_PREFIXES = ((1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm"))


@styled
def fitted_figure(t: NDArray, X: NDArray, f: NDArray, law: NDArray, timed: bool) -> Figure:
    """Figure of friction over position, and the residuals over time or slip.

    Args:
        t: time [s], (samples,).
        X: position [m], (samples,).
        f: measured friction coefficient, (samples,).
        law: friction coefficient of the law, NaN where it has none, (samples,).
        timed: time was measured.
    """
    size = Size(PAGE)
    legend = Legend(
        [
            handle(Look(COLOURS[0], "none", "."), "measured", marker="."),
            handle(Look(COLOURS[1], "-", ""), "fitted"),
        ],
        size.width,
    )
    room = Room(0.55, 0.1, 0.42 + legend.height, 0.2, 0.7)
    figure, axes = panels(1, 2, size, 0.66, room)
    first, second = axes.flat
    scale, unit = next(
        ((metre, name) for metre, name in _PREFIXES if np.ptp(X) >= metre), _PREFIXES[-1]
    )  # fmt: skip
    first.plot(X / scale, f, ".", color=COLOURS[0], markersize=2.0)
    first.plot(X / scale, law, color=COLOURS[1])
    over, label = (t, "time (s)") if timed else (X / scale, f"slip ({unit})")
    second.plot(over, f - law, ".", color=COLOURS[0], markersize=2.0)
    second.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
    for axis in (first, second):
        axis.set_ylabel("friction coefficient $f$" if axis is first else "measured less fitted $f$")
    first.set_xlabel(f"position ({unit})" if timed else f"slip ({unit})")
    second.set_xlabel(label)
    lettered(axes.flat)
    legend.put(figure)
    return figure
