"""Friction loops."""

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import COLOURS


@dataclass(frozen=True)
class Loop:
    """Friction along all strokes in the order of travel.

    Attributes:
        label: names it in a legend.
        X_over_L, f: position over the pre-sliding displacement and friction coefficient, (n,).
    """

    label: str
    X_over_L: NDArray
    f: NDArray


def loops_figure(panels: Sequence[tuple[str, Sequence[Loop]]]) -> Figure:
    """Friction loops side by side: each panel a title and its loops."""
    figure, axes = plt.subplots(1, len(panels), figsize=(3.2 * len(panels) + 0.8, 3.1), squeeze=False)
    for axis, (title, loops) in zip(axes[0], panels):
        for n, loop in enumerate(loops):
            axis.plot(loop.X_over_L, loop.f, color=COLOURS[n % 8], label=loop.label)
        axis.set_title(title, fontsize=9)
        axis.set_xlabel("$X/L$ (dimensionless)")
        axis.legend(fontsize=7, frameon=False)
    axes[0, 0].set_ylabel("$f = F/N$ (dimensionless)")
    figure.tight_layout()
    return figure
