"""Motions in time: what a pressure and its punch do over time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, lettered, panels
from galinx.postprocess.figures.style import PAGE, looks, styled

#: What panels show.
_LABELS = (
    "centre of pressure$/a$", r"indentation $v_0/(N/2\mu)$", "$K_I$ at $X = -a$", "$K_I$ at $X = a$",
)  # fmt: skip
#: Points of the other method along a curve.
_POINTS = 15


@dataclass(frozen=True)
class Start:
    """A start.

    Attributes:
        label: names it in a legend.
        curves: of each panel, (times,) each.
        beside: the same by another method, or none.
        steady: centre of the pressure over a if it were at once that of steady motion, (times,).
    """

    label: str
    curves: Sequence[NDArray]
    beside: Sequence[NDArray]
    steady: NDArray


@styled
def time_figure(t: NDArray, starts: Sequence[Start], size: Size | None = None) -> Figure:
    """A panel over time for each of the curves that is not NaN.

    Args:
        t: times over a/c_s.
        starts: what to draw.
        size: of the figure.
    """
    size = size or Size(PAGE)
    styles = looks(len(starts))
    legend = Legend([handle(look, start.label) for look, start in zip(styles, starts)], size.width)
    wide = size.width > 4.5
    room = Room(0.6, 0.1, 0.42 + legend.height, 0.2, 0.65, 0.5)
    shown = [
        n for n in range(len(_LABELS)) if any(np.isfinite(start.curves[n]).any() for start in starts)
    ]
    across = 2 if wide else 1
    figure, axes = panels(len(shown) // across, across, size, 0.62, room)
    every = max(len(t) // _POINTS, 1)
    for axis, n in zip(axes.flat, shown):
        for look, start in zip(styles, starts):
            axis.plot(t, start.curves[n], color=look.colour, linestyle=look.line)
            if start.beside:
                axis.plot(
                    t[::every],
                    start.beside[n][::every],
                    "o",
                    color=look.colour,
                    markersize=2.5,
                    mfc="none",
                )
            if n == 0:
                axis.plot(t, start.steady, color=look.colour, linewidth=0.7, linestyle=":", zorder=0)
        axis.set(xlabel="time $t/(a/c_s)$", ylabel=_LABELS[n], xlim=(0.0, t[-1]))
    lettered(axes.flat)
    legend.put(figure)
    return figure
