"""Stresses along interfaces of layers: finite elements as markers on the integral equation's lines."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, lettered, of_methods, panels
from galinx.postprocess.figures.style import COLUMN, GREY, PAGE, styled
from galinx.postprocess.figures.surface import Curve
from galinx.postprocess.quantities.quantity import FEM, METHODS, SIE

#: How far positions are shown: over a, and over the depth of the interface.
_OVER_A, _OVER_DEPTH = 2.0, 2.5
#: Lines of what is told on one side alone, above and below.
_SIDES = ("-", (0, (4.0, 1.5)))
#: Markers along a curve.
_MARKERS = 15


@dataclass(frozen=True)
class Row:
    """A stress along interfaces.

    Attributes:
        label: of its axis.
        sides: by method (states, interfaces, points): once, or above and below.
    """

    label: str
    sides: Sequence[Mapping[str, NDArray]]


@dataclass(frozen=True)
class Interface:
    """An interface that has a column.

    Attributes:
        number: among all, from 0.
        depth: over a.
        title: of the column.
    """

    number: int
    depth: float
    title: str


@styled
def interfaces_figure(
    X: NDArray,
    rows: Sequence[Row],
    interfaces: Sequence[Interface],
    curves: Sequence[Curve],
    size: Size | None = None,
    frames: Sequence[tuple[float, float]] = (),
) -> Figure:
    """Stresses along interfaces: a row for each stress, a column for each interface.

    Args:
        X: positions over a, (points,).
        rows: what to draw.
        interfaces: of which interfaces.
        curves: of which states.
        size: of the figure.
        frames: half-width and middle [mm] of each state's contact, from whose punch's axis positions are
            drawn; over a for none.
    """
    size = size or Size(COLUMN if len(interfaces) == 1 else PAGE)
    methods = {method for row in rows for side in row.sides for method in side}
    named = [handle(curve.look, curve.label, linestyle="-") for curve in curves if len(curves) > 1]
    both = any(len(row.sides) > 1 for row in rows)
    of_sides = [
        handle(curves[0].look, f"{side} the interface", color=GREY, linestyle=line)
        for side, line in zip(("above", "below"), _SIDES)
    ]
    lines = of_methods(SIE in methods, FEM in methods, METHODS[SIE])
    legend = Legend([*named, *(of_sides if both else []), *lines], size.width)
    room = Room(0.55, 0.1, 0.42 + legend.height, 0.2, 0.42, 0.3)
    figure, axes = panels(len(rows), len(interfaces), size, 0.6, room)
    for row, line in zip(axes, rows):
        for axis, interface in zip(row, interfaces):
            _draw(axis, X, line, interface, curves, frames or [(1.0, 0.0)] * len(curves))
        row[0].set_ylabel(line.label)
    for axis in axes[-1]:
        axis.set_xlabel(f"position along the interface {'$X$ [mm]' if frames else '$X/a$'}")
    lettered(axes.flat, [interface.title for interface in interfaces])
    figure.align_ylabels(axes[:, 0])
    legend.put(figure)
    return figure


def _draw(
    axis: Axes, X: NDArray, row: Row, interface: Interface, curves: Sequence[Curve],
    frames: Sequence[tuple[float, float]],
) -> None:  # fmt: skip
    half = max(_OVER_A, _OVER_DEPTH * interface.depth)
    low, high = (
        min(centre - half * a for a, centre in frames),
        max(centre + half * a for a, centre in frames),
    )
    for a, centre in sorted(set(frames)):
        axis.axvspan(centre - a, centre + a, color="#F2F2F2", linewidth=0.0, zorder=-1)
    axis.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
    for side, line in zip(row.sides, _SIDES):
        for n, (curve, (a, centre)) in enumerate(zip(curves, frames)):
            values = {method: found[curve.state, interface.number] for method, found in side.items()}
            drawn = next(iter(values.values()))
            x = centre + a * X
            seen = (x >= low) & (x <= high)
            axis.plot(x[seen], drawn[seen], color=curve.look.colour, linestyle=line)
            if len(values) > 1:
                # Those of one curve stand between those of the others.
                step = 2.0 * half / _MARKERS
                wanted = -half + step * (np.arange(_MARKERS) + (n + 0.5) / len(curves))
                pick = np.unique(np.abs(X[:, None] - wanted).argmin(axis=0))
                axis.plot(
                    x[pick], values[FEM][pick], curve.look.marker, color=curve.look.colour,
                    markerfacecolor="none",
                )  # fmt: skip
    axis.set_xlim(low, high)
