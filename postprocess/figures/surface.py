"""Stresses along the surface, and along interfaces of layers: markers of finite elements on exact lines.

Lines are those of the closed form along the surface, and of the integral equation over layers.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from galinx.solvers.contact.edges import from_edge, under_punch

from ..quantities.quantity import CLOSED_FORM, FEM, METHODS, SIE
from .canvas import Legend, Room, Size, handle, lettered, of_methods, panels
from .friction import Loop
from .style import COLUMN, GREY, PAGE, SMALL, Look, styled

#: Positions shown of a stress all along the surface, and of one under the punch alone [a].
_BESIDE, _UNDER = 2.0, 1.04
#: Distance over a from an edge within which stresses may run out of the picture.
_EDGE = 0.09
#: Columns whose ranges differ more have limits of their own.
_APART = 4.0
#: Size of an inset, of the names of its axes, and where it may begin, all over that of the panel.
_INSET, _NAMES = (0.27, 0.31), (0.07, 0.12)
_CORNERS = ((0.37, 0.18), (0.075, 0.13), (0.7, 0.13), (0.075, 0.64), (0.7, 0.64))
#: Markers in a panel.
_MARKERS = 36


@dataclass(frozen=True)
class Stress:
    """Stress along the surface.

    Attributes:
        label: of its axis.
        values: by method, (states, points).
    """

    label: str
    values: Mapping[str, NDArray]


@dataclass(frozen=True)
class Curve:
    """Curve of a state, with its name and its look."""

    state: int
    label: str
    look: Look


@dataclass(frozen=True)
class Place:
    """Place of a state on a friction loop."""

    loop: Loop
    X_over_L: float
    f: float


@dataclass(frozen=True)
class Column:
    """Column of a figure, with its states.

    Attributes:
        title: of the column.
        curves: of the states.
        places: place of each state on its loop; none draws no inset.
    """

    title: str
    curves: Sequence[Curve]
    places: Sequence[Place] = ()


@styled
def surface_figure(
    X: NDArray,
    stresses: Sequence[Stress],
    columns: Sequence[Column],
    size: Size | None = None,
    ends: tuple[NDArray, NDArray] | None = None,
) -> Figure:
    """Figure of stresses along the surface: a row for each, one column for each group of states.

    Args:
        X: positions over a, (points,).
        stresses: what to draw.
        columns: of which states.
        size: of the figure.
        ends: half-widths and middles of contacts [mm], (states,) each; positions are drawn in mm then.
    """
    size = size or Size(COLUMN if len(columns) == 1 else PAGE)
    curves = {curve.label: curve for column in columns for curve in column.curves}
    methods = {method for stress in stresses for method in stress.values}
    named = [handle(curve.look, label) for label, curve in curves.items() if len(curves) > 1 and label]
    legend = Legend([*named, *_of_methods(methods)], size.width)
    ranges = [_ranges(X, stress, columns) for stress in stresses]
    apart = any(len(set(row)) > 1 for row in ranges)
    room = Room(0.55, 0.1, 0.42 + legend.height, _top(columns, stresses), 0.42 if apart else 0.2, 0.52)
    figure, axes = panels(len(stresses), len(columns), size, 0.6, room)
    for row, stress, limits_ in zip(axes, stresses, ranges):
        half = half_width(X, [stress])
        for axis, column, y in zip(row, columns, limits_):
            _draw(axis, X, stress, column, half, ends)
            axis.set_ylim(y)
            _positions(axis, column, half, ends)
            axis.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
            if axis is not row[0] and not apart:
                axis.set_yticklabels([])
        row[0].set_ylabel(stress.label)
    for row, stress in zip(axes, stresses):
        if half_width(X, [stress]) < _BESIDE:  # there is room below the pressure
            _insets(row, columns)
            break
    lettered(axes.flat, [column.title for column in columns])
    figure.align_ylabels(axes[:, 0])
    legend.put(figure)
    return figure


def _of_methods(methods: set[str]) -> list[Line2D]:
    """Handles that explain lines and markers."""
    lines = METHODS[CLOSED_FORM if CLOSED_FORM in methods else SIE]
    return of_methods(bool(methods - {FEM}), FEM in methods, lines)


def _positions(axis: Axes, column: Column, half: float, ends: tuple[NDArray, NDArray] | None) -> None:
    """Set the axis of positions, over a or in mm, and shade the contact where all have the same."""
    if ends is not None:
        h, m = (values[[curve.state for curve in column.curves]] for values in ends)
        axis.set(
            xlim=(np.nanmin(m - half * h), np.nanmax(m + half * h)),
            xlabel="position on the surface $X$ (mm)",
        )
        axis.locator_params(axis="x", nbins=6)
        return
    over_a(axis, half)
    axis.set_xlabel("position on the surface $X/a$")


def over_a(axis: Axes, half: float) -> None:
    """Set positions over a from -half to half, and shade the contact where something is beside it."""
    axis.set_xlim(-half, half)
    axis.xaxis.set_major_locator(MultipleLocator(0.5 if half < _BESIDE else 1.0))
    axis.xaxis.set_minor_locator(MultipleLocator(0.25))
    if half == _BESIDE:
        axis.axvspan(-1.0, 1.0, color="#F2F2F2", linewidth=0.0, zorder=-1)


def _top(columns: Sequence[Column], stresses: Sequence[Stress]) -> float:
    """Room for titles and letters [in]."""
    return 0.2 if len(columns) * len(stresses) > 1 or columns[0].title else 0.08


def _ranges(X: NDArray, stress: Stress, columns: Sequence[Column]) -> list[tuple[float, float]]:
    """Limits of each column: the same for all, unless a few would hardly be visible then."""
    values = next(iter(stress.values.values()))
    every = [limits(X, values[[curve.state for curve in column.curves]]) for column in columns]
    low, high = min(y[0] for y in every), max(y[1] for y in every)
    if (high - low) > _APART * min(y[1] - y[0] for y in every):
        return every
    return [(low, high)] * len(every)


def _draw(
    axis: Axes,
    X: NDArray,
    stress: Stress,
    column: Column,
    half: float,
    ends: tuple[NDArray, NDArray] | None,
) -> None:
    exact, fem = stress.values.get(CLOSED_FORM, stress.values.get(SIE)), stress.values.get(FEM)
    lines = exact if exact is not None else fem
    assert lines is not None
    for n, curve in enumerate(column.curves):
        h, m = (1.0, 0.0) if ends is None else (values[curve.state] for values in ends)
        places = m + h * X
        x, y = broken(X, lines[curve.state])
        axis.plot(m + h * x, y, color=curve.look.colour, linestyle=curve.look.line)
        if exact is not None and fem is not None:
            pick = picked(X, half, n, len(column.curves))
            axis.plot(
                places[pick], fem[curve.state][pick], curve.look.marker, color=curve.look.colour,
                markerfacecolor="none",
            )  # fmt: skip


def half_width(X: NDArray, stresses: Sequence[Stress]) -> float:
    """Half-width over a of the part of the surface shown: there may be no stress beside the punch."""
    return max(along(X, values) for stress in stresses for values in stress.values.values())


def along(X: NDArray, values: NDArray) -> float:
    """Half-width over a of the part of the surface shown for values, (states, points)."""
    return _UNDER if np.isnan(values[:, ~under_punch(X)]).all() else _BESIDE


def picked(X: NDArray, half: float, n: int, curves: int, most: int = _MARKERS) -> NDArray[np.int64]:
    """Points with markers of the n-th of several curves, between the markers of the others."""
    count = max(7, most // curves)
    step = 2.0 * half / count
    spaced = -half + step * (np.arange(count) + (n + 0.5) / curves)
    return np.unique(np.abs(X[:, None] - spaced).argmin(axis=0))


def broken(X: NDArray, values: NDArray) -> tuple[NDArray, NDArray]:
    """Positions and values of a line that is broken at the edges of the punch, for one call of plot."""
    gap = [np.nan]
    pieces = [(X[part], values[part]) for part in parts(X) if not np.isnan(values[part]).all()]
    xs, ys = ([part for piece in pieces for part in (piece[n], gap)] for n in (0, 1))
    return np.concatenate([*xs, gap]), np.concatenate([*ys, gap])


def parts(X: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Positions beside, under and beside the punch: a line across an edge would be a lie."""
    beside = ~under_punch(X)
    return beside & (X < 0.0), under_punch(X), beside & (X > 0.0)


def limits(X: NDArray, values: NDArray) -> tuple[float, float]:
    """Room for the regular part; the singular ends run out of the picture."""
    regular = values[:, from_edge(X) > _EDGE]
    if np.nanmax(np.abs(values)) <= 1.05 * np.nanmax(np.abs(regular)):
        regular = values  # nothing runs out: the ends of the contact are smooth
    low, high = np.nanmin(regular), np.nanmax(regular)
    if 0.0 < -high < 0.2 * (high - low):  # zero is near
        high = 0.0
    margin = 0.08 * (high - low) or 1.0
    return low - margin, high + margin


def _insets(row: Sequence[Axes], columns: Sequence[Column]) -> None:
    """Draw an inset with the places of states on their loops, once where all columns have the same."""
    same = all(_sits(column) == _sits(columns[0]) for column in columns)
    for axis, column in list(zip(row, columns))[: 1 if same else None]:
        if column.places:
            _inset(axis, column)


def _sits(column: Column) -> list[Any]:
    return [(place.X_over_L, place.f, id(place.loop)) for place in column.places]


def _free(axis: Axes) -> tuple[float, float] | None:
    """Corner of a panel, over its size, where no curve runs through an inset and its axes' names."""
    to_panel = axis.transData + axis.transAxes.inverted()
    points = np.concatenate([to_panel.transform(line.get_xydata()) for line in axis.lines])
    points = points[np.isfinite(points).all(axis=1)]
    for corner in _CORNERS:
        first, last = np.array(corner) - _NAMES, np.array(corner) + _INSET + 0.02
        if not ((first <= points) & (points <= last)).all(axis=1).any():
            return corner
    return None


def _inset(axis: Axes, column: Column) -> None:
    """Draw an inset: a loop that all share is grey. It shows places, not values: axes have no numbers.

    Where curves leave it no room there is none.
    """
    corner = _free(axis)
    if corner is None:
        return
    inset = axis.inset_axes((*corner, *_INSET))
    shared = all(place.loop is column.places[0].loop for place in column.places)
    for n, (curve, place) in enumerate(zip(column.curves, column.places)):
        if n == 0 or not shared:
            colour = GREY if shared else curve.look.colour
            inset.plot(place.loop.X_over_L, place.loop.f, color=colour, linewidth=0.6)
        inset.plot(place.X_over_L, place.f, curve.look.marker, color=curve.look.colour, markersize=4)
    inset.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
    inset.set(xticks=[], yticks=[])
    inset.margins(0.08, 0.12)
    inset.set_xlabel("$X/L$", fontsize=SMALL, labelpad=1.0)
    inset.set_ylabel("$f$", fontsize=SMALL, labelpad=1.0, rotation=0, va="center", ha="right")


#: Largest positions shown: over a, and over the depth of the interface.
_OVER_A, _OVER_DEPTH = 2.0, 2.5
#: Lines of a stress that differs on both sides, above and below.
_SIDES = ("-", (0, (4.0, 1.5)))
#: Markers along a curve.
_MARKERS_ALONG = 15


@dataclass(frozen=True)
class Row:
    """Stress along interfaces.

    Attributes:
        label: of its axis.
        sides: by method (states, interfaces, points): once, or above and below.
    """

    label: str
    sides: Sequence[Mapping[str, NDArray]]


@dataclass(frozen=True)
class Interface:
    """Interface that has a column.

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
            _draw_interface(axis, X, line, interface, curves, frames or [(1.0, 0.0)] * len(curves))
        row[0].set_ylabel(line.label)
    for axis in axes[-1]:
        axis.set_xlabel(f"position along the interface {'$X$ [mm]' if frames else '$X/a$'}")
    lettered(axes.flat, [interface.title for interface in interfaces])
    figure.align_ylabels(axes[:, 0])
    legend.put(figure)
    return figure


def _draw_interface(
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
            values = {method: stress[curve.state, interface.number] for method, stress in side.items()}
            drawn = next(iter(values.values()))
            x = centre + a * X
            shown = (x >= low) & (x <= high)
            axis.plot(x[shown], drawn[shown], color=curve.look.colour, linestyle=line)
            if len(values) > 1:
                # Those of one curve stand between those of the others.
                step = 2.0 * half / _MARKERS_ALONG
                spaced = -half + step * (np.arange(_MARKERS_ALONG) + (n + 0.5) / len(curves))
                pick = np.unique(np.abs(X[:, None] - spaced).argmin(axis=0))
                axis.plot(
                    x[pick], values[FEM][pick], curve.look.marker, color=curve.look.colour,
                    markerfacecolor="none",
                )  # fmt: skip
    axis.set_xlim(low, high)
