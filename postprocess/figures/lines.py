"""Lines over an axis: errors, changes, whatever spans decades."""

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import COLOURS, MARKERS


def lines_figure(
    x: NDArray, lines: dict[str, NDArray], x_label: str, y_label: str, title: str, log_x: bool
) -> Figure:
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


def degrees_figure(
    c: NDArray, change: NDArray, degree: NDArray, estimate: NDArray, true_error: NDArray | None
) -> Figure:
    """How the numbers settle as the polynomial degree rises, by speed.

    Args:
        c: speeds over the shear wave speed, (n,).
        change: largest relative change of K_I and moments from the degree before, by degree; 0 where
            not computed, (n, degrees).
        degree: the one whose numbers are archived, (n,).
        estimate, true_error: largest of each speed's states, relative, (n,).
    """
    figure, axis = plt.subplots(figsize=(5.5, 4.0))
    for n, speed in enumerate(c[: len(COLOURS)]):
        known = np.flatnonzero(change[n] > 0.0)
        axis.plot(
            known,
            change[n][known],
            color=COLOURS[n],
            marker=MARKERS[n],
            markersize=4,
            label=f"c = {speed:g}",
        )
        axis.plot(degree[n], estimate[n], "_", color=COLOURS[n], markersize=12, markeredgewidth=2)
        if true_error is not None:
            axis.plot(degree[n], true_error[n], "x", color=COLOURS[n], markersize=6)
    told = "bar: estimated error" + ("   cross: true error" if true_error is not None else "")
    axis.set_title(f"markers: change from the degree before   {told}", fontsize=8)
    axis.set_yscale("log")
    axis.set_xlabel("polynomial degree (dimensionless)")
    axis.set_ylabel("of $K_I$ and moments, relative (dimensionless)")
    axis.xaxis.get_major_locator().set_params(integer=True)
    axis.legend(fontsize=7)
    figure.tight_layout()
    return figure
