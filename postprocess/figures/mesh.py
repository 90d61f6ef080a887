"""Pictures of meshes."""

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import COLOURS


def mesh_figure(edges: NDArray, zooms: tuple[float, ...] = (4.0, 0.5, 0.01)) -> Figure:
    """A mesh below the punch, then nearer and nearer to the edge X = a.

    Args:
        edges: polylines of the cells' edges over a, (edges, points, 2).
        zooms: half-widths of the panels over a; the first is centred on the punch.
    """
    figure, axes = plt.subplots(1, len(zooms), figsize=(3.3 * len(zooms), 2.5))
    for n, (axis, half) in enumerate(zip(axes, zooms)):
        centre = 0.0 if n == 0 else 1.0
        near = np.abs(edges - (centre, 0.0)).min(axis=1).max(axis=1) < 2.0 * half
        # Coordinates from the panel's centre: far-away points would lose the picture's digits.
        axis.add_collection(LineCollection(edges[near] - (centre, 0.0), colors="#666666", linewidths=0.5))
        axis.plot([-1.0 - centre, 1.0 - centre], [0.0, 0.0], color=COLOURS[1], linewidth=2.5)
        axis.set_xlim(-half, half)
        axis.set_ylim(-1.2 * half, 0.1 * half)
        axis.set_aspect("equal")
        axis.grid(False)
        axis.set_xlabel("$X/a$" if n == 0 else "$X/a - 1$")
        axis.tick_params(labelsize=7)
        axis.locator_params(nbins=5)
    axes[0].set_ylabel("$Y/a$ (dimensionless)")
    figure.tight_layout()
    return figure
