"""Pictures of meshes: cells, and the nodes that carry the unknowns."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Room, Size, lettered, panels
from galinx.postprocess.figures.style import COLOURS, PAGE, styled

#: Nodes nearer to each other than this share of a panel print as one.
_DOT = 1.0 / 500.0


@styled
def mesh_figure(
    edges: NDArray,
    nodes: NDArray,
    size: Size | None = None,
    zooms: tuple[float, ...] = (4.0, 0.5, 0.01),
    first: str = "under the punch",
) -> Figure:
    """A mesh below the punch, then nearer and nearer to the edge X = a.

    Args:
        edges: polylines of the cells' edges over a, (edges, points, 2).
        nodes: where its unknowns are, over a, (n, 2).
        size: of the figure.
        zooms: half-widths of the panels over a; the first is centred on the punch.
        first: title of that one.
    """
    size = size or Size(PAGE)
    columns = max(1, min(len(zooms), int(size.width / 2.0)))
    rows = -(-len(zooms) // columns)
    figure, axes = panels(rows, columns, size, 0.65, Room(0.55, 0.2, 0.38, 0.2, 0.6, 0.55))
    for n, (axis, half) in enumerate(zip(axes.flat, zooms)):
        centre = (0.0 if n == 0 else 1.0, 0.0)
        # Coordinates from the panel's centre: far-away points would lose the picture's digits.
        lines, dots = edges - centre, nodes - centre
        near = np.abs(lines).min(axis=1).max(axis=1) < 2.0 * half
        axis.add_collection(LineCollection(lines[near], colors="#555555", linewidths=0.5))
        seen = dots[np.abs(dots).max(axis=1) < 1.5 * half]
        printed = np.unique(np.round(seen / (2.0 * half * _DOT)), axis=0) * (2.0 * half * _DOT)
        axis.plot(
            *printed.T, linestyle="none", marker=".", markersize=1.3, markeredgewidth=0.0,
            color=COLOURS[0], rasterized=True,
        )  # fmt: skip
        punch = np.clip([-1.0 - centre[0], 1.0 - centre[0]], -half, half)
        axis.fill_between(punch, 0.0, 0.12 * half, color=COLOURS[1], linewidth=0.0)
        axis.set(xlim=(-half, half), ylim=(-1.18 * half, 0.12 * half))
        axis.set_xlabel("$X/a$" if n == 0 else "$X/a - 1$")
        axis.set_ylabel("$Y/a$")
        axis.locator_params(nbins=5)
    for axis in axes.flat[len(zooms) :]:
        axis.remove()
    titles = [first, *[f"{zooms[0] / half:.0f} times larger" for half in zooms[1:]]]
    lettered(axes.flat[: len(zooms)], titles)
    return figure
