"""Stresses along the surface: finite elements as markers on closed-form lines."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import COLOURS, MARKERS
from galinx.postprocess.figures.loops import Loop
from galinx.postprocess.quantities import Quantity
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.postprocess.quantities.states import FRICTION, POSITION
from galinx.postprocess.quantities.stresses import IN_PLANE, PRESSURE, SURFACE_X
from galinx.solvers.contact import from_edge, under_punch

_STRESSES = ((PRESSURE, r"$\sigma_{YY}/(N/2a)$"), (IN_PLANE, r"$\sigma_{XX}/(N/2a)$"))


@dataclass(frozen=True)
class Column:
    """States drawn in one column of a figure.

    Attributes:
        title: of the column.
        states: their indices.
        labels: of the states.
        loops: the friction loop that each sits on; none draws no inset.
    """

    title: str
    states: Sequence[int]
    labels: Sequence[str]
    loops: Sequence[Loop] = ()


def surface_figure(data: dict[str, Any], columns: Sequence[Column]) -> Figure:
    """σ_YY and σ_XX along the surface: two rows, one column for each group of states.

    Args:
        data: an archive with surface stresses.
        columns: what to draw.
    """
    figure, axes = plt.subplots(
        2, len(columns), figsize=(3.6 * len(columns) + 0.6, 5.2), sharex=True, squeeze=False
    )
    for column, shown in enumerate(columns):
        for row, (stress, label) in enumerate(_STRESSES):
            axis = axes[row, column]
            values = [_draw(axis, data, i, stress, n) for n, i in enumerate(shown.states)]
            axis.set_ylim(*_limits(data[SURFACE_X.path], np.array(values)))
            axis.set_xlim(-2.0, 2.0)
            if column == 0:
                axis.set_ylabel(label)
        axes[0, column].set_title(shown.title, fontsize=9)
        axes[1, column].set_xlabel("$X/a$")
        if shown.loops:
            _inset(axes[0, column], data, shown)
    handles = [
        plt.Line2D([], [], color=COLOURS[n % 8], marker=MARKERS[n % 8], markersize=3, label=text)
        for n, text in enumerate(columns[0].labels)
    ]
    figure.legend(handles=handles, ncols=3, loc="lower center", frameon=False, fontsize=8)
    figure.text(
        0.5, 0.985, "lines: closed form    markers: finite elements    all axes dimensionless",
        ha="center", va="top", fontsize=7,
    )  # fmt: skip
    figure.tight_layout(rect=(0.0, 0.05 * ((len(handles) + 2) // 3), 1.0, 0.97))
    return figure


def _draw(
    axis: plt.Axes, data: dict[str, Any], state: int, stress: dict[str, Quantity], n: int
) -> NDArray:
    X, drawn = data[SURFACE_X.path], []
    beside = ~under_punch(X)
    exact, found = (data.get(stress[method].path) for method in (CLOSED_FORM, FEM))
    for part in (
        beside & (X < 0.0),
        under_punch(X),
        beside & (X > 0.0),
    ):  # a line across an edge would be a lie
        if exact is not None:
            drawn.append(exact[state])
            axis.plot(X[part], exact[state][part], color=COLOURS[n % 8])
    if found is not None:
        drawn.append(found[state])
        wanted = np.linspace(-1.95, 1.95, 40) + 0.04 * n / 8.0
        pick = np.unique(np.abs(X[:, None] - wanted).argmin(axis=0))
        style = {} if exact is not None else {"linestyle": ":"}
        axis.plot(
            X[pick], found[state][pick], MARKERS[n % 8], color=COLOURS[n % 8], markersize=3,
            markerfacecolor="none", markeredgewidth=0.7, **style,
        )  # fmt: skip
    return drawn[0]


def _limits(X: NDArray, values: NDArray) -> tuple[float, float]:
    """Room for the regular part; the singular ends run out of the picture."""
    regular = values[:, from_edge(X) > 0.06]
    low, high = np.nanmin(regular), np.nanmax(regular)
    margin = 0.08 * (high - low) or 1.0
    return low - margin, high + margin


def _inset(axis: plt.Axes, data: dict[str, Any], column: Column) -> None:
    """Where on its loop each state sits; a loop that all share is grey."""
    inset = axis.inset_axes((0.37, 0.14, 0.28, 0.32))
    shared = all(loop is column.loops[0] for loop in column.loops)
    for n, (i, loop) in enumerate(zip(column.states, column.loops)):
        colour = "#888888" if shared else COLOURS[n % 8]
        if n == 0 or not shared:
            inset.plot(loop.X_over_L, loop.f, color=colour, linewidth=0.7)
        inset.plot(
            data[POSITION.path][i], data[FRICTION.path][i], MARKERS[n % 8], color=COLOURS[n % 8],
            markersize=4,
        )  # fmt: skip
    inset.tick_params(labelsize=5, length=2, pad=1)
    inset.set_xlabel("$X/L$", fontsize=6, labelpad=0)
    inset.set_ylabel("$f$", fontsize=6, labelpad=0)
