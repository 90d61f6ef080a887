"""Lines over an axis: errors, changes, whatever spans decades."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, panels
from galinx.postprocess.figures.style import COLUMN, GREY, looks, styled


@styled
def lines_figure(
    x: NDArray, lines: dict[str, NDArray], x_label: str, y_label: str, title: str, log_x: bool
) -> Figure:
    """Lines by label over x, the y axis logarithmic."""
    styles = looks(len(lines))
    legend = Legend([handle(look, label) for look, label in zip(styles, lines)], 5.0)
    figure, axes = panels(1, 1, Size(5.0), 0.65, Room(0.62, 0.1, 0.43 + legend.height, 0.22))
    axis = axes[0, 0]
    for y, look in zip(lines.values(), styles):
        axis.plot(x, y, color=look.colour, linestyle=look.line, marker=look.marker)
    axis.set(yscale="log", xlabel=x_label, ylabel=y_label, title=title)
    if log_x:
        axis.set_xscale("log")
    legend.put(figure)
    return figure


@styled
def degrees_figure(
    labels: list[str],
    change: NDArray,
    degree: NDArray,
    estimate: NDArray,
    true_error: NDArray | None,
    size: Size | None = None,
) -> Figure:
    """How the numbers settle as the polynomial degree rises, by speed.

    Args:
        labels: of the speeds, n.
        change: largest relative change of K_I and moments from the degree before, by degree; 0 where
            not computed, (n, degrees).
        degree: the one whose numbers are archived, (n,).
        estimate, true_error: largest of each speed's states, relative, (n,).
        size: of the figure.
    """
    size, styles = size or Size(COLUMN), looks(len(labels), ordered=True)
    told = [handle(look, label, marker=look.marker) for look, label in zip(styles, labels)]
    told.append(
        Line2D([], [], color=GREY, marker="_", markersize=9, linestyle="none", label="estimated error")
    )
    if true_error is not None:
        told.append(Line2D([], [], color=GREY, marker="x", linestyle="none", label="true error"))
    legend = Legend(told, size.width)
    figure, axes = panels(1, 1, size, 0.72, Room(0.62, 0.1, 0.43 + legend.height, 0.1))
    axis = axes[0, 0]
    # Speeds stand beside one another: their errors are nearly the same.
    aside = 0.16 * (np.arange(len(labels)) - (len(labels) - 1) / 2.0) / max(1, len(labels) - 1)
    for n, look in enumerate(styles):
        known = np.flatnonzero(change[n] > 0.0)
        axis.plot(known, change[n][known], color=look.colour, linestyle=look.line, marker=look.marker)
        at = degree[n] + aside[n]
        axis.plot(at, estimate[n], "_", color=look.colour, markersize=9, markeredgewidth=1.2)
        if true_error is not None:
            axis.plot(at, true_error[n], "x", color=look.colour, markersize=4)
    axis.set(yscale="log", xlabel="polynomial degree", ylabel="relative change or error of $K_I$")
    axis.xaxis.get_major_locator().set_params(integer=True)
    axis.margins(x=0.12)
    legend.put(figure)
    return figure
