"""Maps of stresses below the punch."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib import colors
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from numpy.typing import NDArray

#: Names of the mapped quantities, in order, all over N/(2a); the first three have a sign.
QUANTITIES = (
    r"$\sigma_{XX}$", r"$\sigma_{YY}$", r"$\sigma_{XY}$", "von Mises", r"$\tau_{max}$, in plane",
)  # fmt: skip
_SIGNED = 3


@dataclass(frozen=True)
class Row:
    """A row of maps.

    Attributes:
        label: what is mapped.
        values: the quantities on the grid, over N/(2a), (5, rows, columns).
        difference: it is one: mapped by size, over the largest of ``values``' own quantity ``scale``.
        scale: sets the colours, so that rows with the same scale can be compared, (5, ...).
    """

    label: str
    values: NDArray
    scale: NDArray
    difference: bool = False


@plt.rc_context({"axes.grid": False})
def maps_figure(X: NDArray, Y: NDArray, rows: Sequence[Row]) -> Figure:
    """Maps, a column for each quantity and a row for each solution.

    Args:
        X, Y: positions over a, (columns,) and (rows,).
        rows: what to map.
    """
    high = len(rows) * (1.8 * (Y[-1] - Y[0]) / (X[-1] - X[0]) + 0.2) + 0.8
    figure, axes = plt.subplots(
        len(rows), len(QUANTITIES), figsize=(11.0, high), sharex=True, sharey=True, squeeze=False
    )
    extent = (X[0], X[-1], Y[0], Y[-1])
    for row, line in zip(rows, axes):
        for n, (name, axis) in enumerate(zip(QUANTITIES, line)):
            shown, style = _colours(row, n)
            picture = axis.imshow(shown, extent=extent, origin="lower", interpolation="bilinear", **style)
            bar = figure.colorbar(picture, cax=axis.inset_axes((1.03, 0.0, 0.04, 1.0)))
            bar.ax.tick_params(labelsize=6)
            axis.plot([-1.0, 1.0], [0.0, 0.0], color="black", linewidth=3.0, clip_on=False)
            axis.set_ylim(Y[0], 0.0)
            axis.tick_params(labelsize=7)
            if row is rows[0]:
                axis.set_title(name, fontsize=9)
            if row is rows[-1]:
                axis.set_xlabel("$X/a$ (dimensionless)", fontsize=7)
        line[0].set_ylabel(f"{row.label}\n$Y/a$", fontsize=7)
    text = "stresses over $N/2a$, differences over the largest (dimensionless)"
    figure.suptitle(text, fontsize=8, y=1.0 - 0.12 / high)
    figure.subplots_adjust(0.07, 0.5 / high, 0.955, 1.0 - 0.5 / high, wspace=0.3, hspace=0.12)
    return figure


def _colours(row: Row, n: int) -> tuple[NDArray, dict]:
    if row.difference:
        size = np.abs(row.values[n]) / np.abs(row.scale[n]).max()
        low, high = np.quantile(size[size > 0.0], (0.02, 1.0)) if np.any(size) else (1e-16, 1.0)
        return np.maximum(size, low), {"cmap": "cividis", "norm": colors.LogNorm(low, max(high, 2 * low))}
    # The edges of the punch would leave no colours for the rest.
    limit = np.quantile(np.abs(row.scale[n]), 0.985)
    if n < _SIGNED:
        return row.values[n], {"cmap": "RdBu_r", "vmin": -limit, "vmax": limit}
    return row.values[n], {"cmap": "viridis", "vmin": 0.0, "vmax": limit}
