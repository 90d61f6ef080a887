"""Stresses along the surface side by side, row by row: curves as lines, others as markers beside them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from .canvas import Legend, Room, Size, handle, lettered, panels
from .friction import F_LABEL, X_LABEL, Panel, draw
from .style import COLOURS, GREY, LINES, PAGE, Look, styled
from .surface import along, broken, limits, over_a, picked

#: Height of a row [in], and of the panels of differences over it.
_HIGH, _FLAT = 1.62, 0.5
#: Markers in a panel.
_MARKERS = 60
#: Differences below this are those of rounding [N/(2a)].
_LEAST = 1e-15


@dataclass(frozen=True)
class Curve:
    """Curve with one name and one look in a row: a line, markers, or both.

    Attributes:
        label: its name in the legend, "" for none.
        look: of line and markers.
        line, markers: of each column, (columns, points); None for none.
        width: of the line [pt].
    """

    label: str
    look: Look
    line: NDArray | None = None
    markers: NDArray | None = None
    width: float = 1.0


@dataclass(frozen=True)
class Row:
    """Curves of one row of panels."""

    title: str
    curves: Sequence[Curve]


@styled
def rows_figure(
    X: NDArray,
    labels: Sequence[str],
    rows: Sequence[Row],
    says: tuple[str, str],
    differences: Mapping[str, NDArray] | None = None,
    size: Size | None = None,
) -> Figure:
    """Figure of stresses along the surface, a column for each, with the same limits in all rows.

    Args:
        X: positions over a, (points,).
        labels: of the stresses.
        rows: from the top down.
        says: names of the methods of lines and of markers.
        differences: between two methods by name, (columns, points) each; they get a row of their own.
        size: of the figure.
    """
    size, differences = size or Size(PAGE), differences or {}
    named = {curve.label: curve for row in rows for curve in row.curves if curve.label}
    entries = [
        handle(curve.look, label, linewidth=curve.width)
        if curve.line is not None
        else handle(curve.look, label, linestyle="none", marker=curve.look.marker, markerfacecolor="none")
        for label, curve in named.items()
    ]
    marked = Line2D(
        [], [], color=GREY, linestyle="none", marker="o", markerfacecolor="none", label=says[1]
    )
    legend = Legend([*entries, Line2D([], [], color=GREY, label=says[0]), marked], size.width)
    heights = [1.0] * len(rows) + [_FLAT] * bool(differences)
    room = Room(0.55, 0.1, 0.42 + legend.height, 0.2, 0.52, 0.26)
    if size.height is None:
        beside = room.bottom + room.top + (len(heights) - 1) * room.down
        size = Size(size.width, beside + sum(heights) * _HIGH)
    figure, axes = panels(len(heights), len(labels), size, 0.5, room, heights)
    for column, label in enumerate(labels):
        _draw_column(axes[:, column], X, rows, column)
        _difference(axes[:, column], X, {name: values[column] for name, values in differences.items()})
        for axis in axes[: len(rows), column]:
            axis.set_ylabel(label)
    titles = [row.title for row in rows for _ in labels]
    if differences:
        how = ", ".join(f"{name} {line}" for name, line in zip(differences, ("line", "dashes")))
        titles += [f"largest difference of both methods: {how}"] * len(labels)
    lettered(axes.flat, titles)
    figure.align_ylabels(axes)
    legend.put(figure)
    return figure


@styled
def laws_figure(
    loops: Panel, X: NDArray, labels: Sequence[str], row: Row, says: tuple[str, str], places: NDArray
) -> Figure:
    """Figure of friction laws side by side: their loops, and the stresses of one place on them.

    Args:
        loops: of the laws.
        X: positions over a, (points,).
        labels: of two stresses.
        row: curves of the laws, in the order and with the looks of their loops.
        says: names of the methods of lines and of markers.
        places: of each law, position X/L and friction coefficient, (laws, 2).
    """
    entries = [handle(curve.look, curve.label, linestyle="-") for curve in row.curves]
    marked = Line2D(
        [], [], color=GREY, linestyle="none", marker="o", markerfacecolor="none", label=says[1]
    )
    legend = Legend([*entries, Line2D([], [], color=GREY, label=says[0]), marked], PAGE)
    room = Room(0.5, 0.08, 0.42 + legend.height, 0.2, 0.5)
    figure, axes = panels(1, 3, Size(PAGE), 0.95, room)
    draw(axes[0, 0], loops)
    axes[0, 0].set(xlabel=X_LABEL, ylabel=F_LABEL)
    for curve, (at, f) in zip(row.curves, places):
        axes[0, 0].plot(at, f, curve.look.marker, color=curve.look.colour)
    for column, label in enumerate(labels):
        _draw_column(axes[:, column + 1], X, [row], column)
        axes[0, column + 1].set_ylabel(label)
    lettered(axes.flat, ["loops, and the place shown", row.title, row.title])
    legend.put(figure)
    return figure


def _draw_column(axes: NDArray, X: NDArray, rows: Sequence[Row], column: int) -> None:
    """Rows of one stress, all between the same limits; positions are named below the last axis."""
    both = [values for row in rows for curve in row.curves for values in (curve.line, curve.markers)]
    shown = np.array([values[column] for values in both if values is not None])
    half, y = along(X, shown), limits(X, shown)
    for axis in axes:
        over_a(axis, half)
        axis.set_xlabel("position on the surface $X/a$" if axis is axes[-1] else "")
        if axis is not axes[-1]:
            axis.tick_params(labelbottom=False)
    for axis, row in zip(axes, rows):
        axis.set_ylim(y)
        axis.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
        for n, curve in enumerate(row.curves):
            if curve.line is not None:
                axis.plot(
                    *broken(X, curve.line[column]), color=curve.look.colour, linestyle=curve.look.line,
                    linewidth=curve.width,
                )  # fmt: skip
            if curve.markers is not None:
                at = picked(X, half, n, len(row.curves), _MARKERS)
                axis.plot(
                    X[at], curve.markers[column][at], curve.look.marker, color=curve.look.colour,
                    markerfacecolor="none", markersize=2.7,
                )  # fmt: skip


def _difference(axes: NDArray, X: NDArray, differences: Mapping[str, NDArray]) -> None:
    if not differences:
        return
    axis: Axes = axes[-1]
    for n, values in enumerate(differences.values()):
        x, y = broken(X, np.maximum(values, _LEAST))
        axis.plot(x, y, color=COLOURS[-2], linestyle=LINES[n], linewidth=0.8)
    axis.set_yscale("log")
    axis.set_ylabel(r"$|\Delta\sigma|/(N/2a)$")
