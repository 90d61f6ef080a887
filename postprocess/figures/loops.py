"""Friction loops: each stroke with its line, its direction and its name."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import ceil
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, lettered, panels
from galinx.postprocess.figures.style import COLUMN, GREY, LINES, PAGE, SMALL, Look, looks, styled

#: Axes of a loop.
X_LABEL, F_LABEL = "position on the stroke $X/L$", "friction coefficient $f = F/N$"

#: Points of a stroke between its name and its arrow, over all its points, and strokes nearer than this
#: share of the axes, which one name serves.
_APART, _SAME = 0.2, 0.012
#: Points of a stroke that are looked at for where its name may stand.
_POINTS = 100

#: Variation of friction, over its size, from which on zero is on the axis.
_LEVEL = 0.2


@dataclass(frozen=True)
class Loop:
    """Friction along all strokes in the order of travel.

    Attributes:
        label: names it in a legend.
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
    """Loops that are drawn in one panel; ``ordered``: they follow a number."""

    title: str
    loops: Sequence[Loop]
    ordered: bool = False


@styled
def loops_figure(shown: Sequence[Panel], size: Size | None = None) -> Figure:
    """Friction loops side by side.

    A loop alone has a colour and a name for every stroke; of several each has its colour, and strokes
    are told apart by their lines.
    """
    size = size or Size(COLUMN if len(shown) == 1 else PAGE)
    rows = ceil(len(shown) / max(1, int(size.width / 2.0)))
    columns = ceil(len(shown) / rows)
    entries = [_entries(panel) for panel in shown]
    common = len({tuple(map(str, (one.get_label() for one in some))) for some in entries}) == 1
    strokes = _of_strokes(shown)
    foot = Legend([*(entries[0] if common else []), *strokes], size.width)
    wide = (size.width - 0.58) / columns - 0.35
    legends = [Legend([] if common else some, wide) for some in entries]
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
    """Position and friction of a motion over time, and its loop.

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
    found = zip(panel.loops, looks(len(panel.loops), panel.ordered))
    return [handle(look, loop.label, linestyle="-") for loop, look in found]


def _of_strokes(shown: Sequence[Panel]) -> list[Any]:
    """What the lines stand for where colours stand for loops."""
    several = [panel for panel in shown if len(panel.loops) > 1]
    names = [name for name, *_ in several[0].loops[0].along()] if several else []
    return [handle(Look(GREY, LINES[n % len(LINES)], ""), name) for n, name in enumerate(names)]


def draw(axis: Axes, panel: Panel) -> None:
    """Draw the loops of a panel, without names of its axes."""
    alone = len(panel.loops) == 1
    f = np.array([loop.f for loop in panel.loops])
    low, high = float(f.min()), float(f.max())
    if high - low > _LEVEL * max(abs(low), abs(high)):  # else zero would leave nothing to be seen
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
    """Where on a stroke no other is near; None where an earlier stroke is the same all along."""
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
    """An arrow along a stroke, and its name."""
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
