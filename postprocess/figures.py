"""Figures: finite elements as markers on closed-form lines, each as PDF and PNG."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from numpy.typing import NDArray

matplotlib.use("Agg")
from matplotlib import pyplot as plt

#: Okabe and Ito's colours, told apart by colour-blind readers.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")

_STRESSES = {"sigma_YY": r"$\sigma_{YY}/(N/2a)$", "sigma_XX": r"$\sigma_{XX}/(N/2a)$"}

plt.rcParams.update(
    {"font.size": 9, "axes.grid": True, "grid.alpha": 0.25, "lines.linewidth": 1.1, "pdf.fonttype": 42}
)


@dataclass(frozen=True)
class Curves:
    """States drawn in one column of a figure: their indices, labels, and the column's title."""

    states: Sequence[int]
    labels: Sequence[str]
    title: str


def lines_figure(
    x: NDArray, lines: dict[str, NDArray], x_label: str, y_label: str, title: str, log_x: bool
) -> plt.Figure:
    """Lines by label over x, the y axis logarithmic."""
    figure, axis = plt.subplots(figsize=(5.5, 4.0))
    for (label, y), colour, marker in zip(lines.items(), COLOURS * 2, MARKERS * 2):
        axis.plot(x, y, color=colour, marker=marker, markersize=4, label=label)
    axis.set_yscale("log")
    if log_x:
        axis.set_xscale("log")
    axis.set_xlabel(x_label)
    axis.set_ylabel(y_label)
    axis.set_title(title, fontsize=9)
    axis.legend(fontsize=7)
    figure.tight_layout()
    return figure


def surface_figure(
    data: dict[str, Any], columns: Sequence[Curves], loops: dict[str, Any] | None = None
) -> plt.Figure:
    """σ_YY and σ_XX along the surface: two rows, one column for each group of states.

    Args:
        data: an archive with surface stresses.
        columns: what to draw.
        loops: an archive of friction loops; draws where on its loop each state sits.
    """
    figure, axes = plt.subplots(
        2, len(columns), figsize=(3.6 * len(columns) + 0.6, 5.2), sharex=True, squeeze=False
    )
    for column, curves in enumerate(columns):
        for row, (stress, label) in enumerate(_STRESSES.items()):
            axis = axes[row, column]
            values = [_draw(axis, data, i, stress, n) for n, i in enumerate(curves.states)]
            axis.set_ylim(*_limits(data["surface/X_over_a"], np.array(values)))
            axis.set_xlim(-2.0, 2.0)
            if column == 0:
                axis.set_ylabel(label)
        axes[0, column].set_title(curves.title, fontsize=9)
        axes[1, column].set_xlabel("$X/a$")
        if loops is not None:
            _inset(axes[0, column], data, loops, curves)
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


def _draw(axis: plt.Axes, data: dict[str, Any], state: int, stress: str, n: int) -> NDArray:
    X, drawn = data["surface/X_over_a"], []
    exact, found = (data.get(f"surface/{method}/{stress}") for method in ("closed_form", "fem"))
    for part in (X < -1.0, np.abs(X) < 1.0, X > 1.0):  # a line across an edge would be a lie
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
    regular = values[:, np.abs(1.0 - np.abs(X)) > 0.06]
    low, high = np.nanmin(regular), np.nanmax(regular)
    margin = 0.08 * (high - low) or 1.0
    return low - margin, high + margin


def _inset(axis: plt.Axes, data: dict[str, Any], loops: dict[str, Any], curves: Curves) -> None:
    inset = axis.inset_axes((0.37, 0.14, 0.28, 0.32))
    first = curves.states[0]
    same = np.all([loops[f"states/{key}"] == data[f"states/{key}"][first] for key in _PARAMETERS], axis=0)
    draw_loop(inset, loops, same, "#888888")
    for n, i in enumerate(curves.states):
        inset.plot(
            data["states/X_over_L"][i], data["states/f"][i], MARKERS[n % 8], color=COLOURS[n % 8],
            markersize=4,
        )  # fmt: skip
    inset.tick_params(labelsize=5, length=2, pad=1)
    inset.set_xlabel("$X/L$", fontsize=6, labelpad=0)
    inset.set_ylabel("$f$", fontsize=6, labelpad=0)


_PARAMETERS = ("mu_c", "sigma0_over_load", "delta")


def draw_loop(
    axis: plt.Axes, data: dict[str, Any], states: NDArray, colour: str, label: str | None = None
) -> None:
    """Friction along all strokes of the chosen states, in the order of travel."""
    axis.plot(data["states/X_over_L"][states], data["states/f"][states], color=colour, label=label)


def loops_figure(data: dict[str, Any], panels: Sequence[tuple[str, dict[str, NDArray]]]) -> plt.Figure:
    """Friction loops side by side: each panel a title and its curves, label -> chosen states."""
    figure, axes = plt.subplots(1, len(panels), figsize=(3.2 * len(panels) + 0.8, 3.1), squeeze=False)
    for axis, (title, curves) in zip(axes[0], panels):
        for n, (label, states) in enumerate(curves.items()):
            draw_loop(axis, data, states, COLOURS[n % 8], label)
        axis.set_title(title, fontsize=9)
        axis.set_xlabel("$X/L$ (dimensionless)")
        axis.legend(fontsize=7, frameon=False)
    axes[0, 0].set_ylabel("$f = F/N$ (dimensionless)")
    figure.tight_layout()
    return figure


def save(figure: plt.Figure, folder: Path, name: str) -> list[Path]:
    """Write a figure as PDF and PNG and close it."""
    paths = [folder / f"{name}.pdf", folder / f"{name}.png"]
    for path in paths:
        figure.savefig(path, dpi=160)
    plt.close(figure)
    return paths


def parameters_match(data: dict[str, Any], **values: float) -> NDArray[np.bool_]:
    """States whose named parameters have the given values."""
    return np.all([data[f"states/{key}"] == value for key, value in values.items()], axis=0)


def draw_archive(data: dict[str, Any], folder: Path, name: str) -> list[Path]:
    """Every figure that an archive has the data for: friction, and surface stresses by speed."""
    paths = save(_friction_of(data), folder, f"{name}_friction")
    if "surface/X_over_a" in data:
        columns = []
        for c in np.unique(data["states/c"]):
            states = np.flatnonzero(data["states/c"] == c)[: len(COLOURS)]
            labels = [
                f"{data['states/motion'][i]}, X/L = {data['states/X_over_L'][i]:g}, "
                f"f = {data['states/f'][i]:+.3f}"
                for i in states
            ]
            columns.append(Curves(states, labels, f"c = {c:g} (first {len(states)} states)"))
        paths += save(surface_figure(data, columns[:4]), folder, f"{name}_surface")
    return paths


def _friction_of(data: dict[str, Any]) -> plt.Figure:
    keys = np.column_stack([data[f"states/{key}"] for key in _PARAMETERS])
    curves = {}
    for row in np.unique(keys, axis=0)[: len(COLOURS)]:
        first_speed = data["states/c"] == data["states/c"][0]
        label = f"$\\mu_C$ = {row[0]:g}, $\\sigma_0 l/N$ = {row[1]:g}/m, $\\delta$ = {row[2]:g}"
        curves[label] = np.all(keys == row, axis=1) & first_speed
    return loops_figure(data, [("Friction", curves)])
