"""Meshes of the half-plane under a flat punch, by name.

One row of ``MESHES`` is a mesh: the chart it is drawn in, and how the ring pattern is laid into it.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.charts import Confocal, Physical
from galinx.meshes.pieces import cut
from galinx.meshes.rings import QuadMesh, Refinement, rectangle

#: Width and depth of the study's block over the half-width: l_p/W = 0.01, l_p/H = 0.02, l_p = 2a.
BOX_WIDTH, BOX_DEPTH = 200.0, 100.0


@dataclass(frozen=True)
class MeshKind:
    """A way to mesh the half-plane.

    Attributes:
        chart: where the mesh is drawn.
        place: puts points (n, 2) of the pattern with a refinement into that chart.
        fan: what fills the innermost squares of the pattern, see :func:`galinx.meshes.rings.rectangle`.
    """

    chart: Confocal | Physical
    place: Callable[[NDArray, Refinement], NDArray]
    fan: bool

    def build(self, refinement: Refinement, cuts: int = 1, part: int = 0, parts: int = 1) -> QuadMesh:
        """The mesh, or a piece of it.

        Args:
            refinement: of the pattern.
            cuts: every cell of it is cut into so many along each side.
            part, parts: which of how many pieces.
        """
        piece = cut(rectangle(refinement, self.fan), cuts, part, parts)
        return QuadMesh(self.place(piece.points, refinement), piece.cells, piece.edges)


def _as_drawn(points: NDArray, _: Refinement) -> NDArray[np.float64]:
    return points


def _image(points: NDArray, _: Refinement) -> NDArray[np.float64]:
    """Vertices of straight-sided cells."""
    return Confocal().to_physical(points)


def _box(points: NDArray, refinement: Refinement) -> NDArray[np.float64]:
    """The graded mesh, drawn out from ellipses to the study's block in its last columns."""
    ξ, η = points.T
    of_columns = np.pi / 2.0 + np.concatenate([[0.0], np.cumsum(refinement.columns)])
    # Three columns change shape, so that none is distorted much.
    inner, outer = of_columns[-4], of_columns[-1]
    share = np.clip((ξ - inner) / (outer - inner), 0.0, 1.0)[:, None]
    ray = np.column_stack([np.cos(η), np.sin(η)])
    sides = np.array([BOX_WIDTH / 2.0, BOX_DEPTH])
    wall = ray / np.max(np.abs(ray) / sides, axis=1, keepdims=True)
    scaled = wall * (np.cosh(ξ) / np.cosh(outer))[:, None]
    X = _image(points, refinement)
    X = np.where(share > 0.0, (1.0 - share) * X + share * scaled, X)
    X[np.abs(X[:, 1]) < 1e-12, 1] = 0.0
    return X


#: Meshes by the name that scenes use.
MESHES = {
    "confocal": MeshKind(Confocal(), _as_drawn, fan=False),
    "uniform": MeshKind(Confocal(), _as_drawn, fan=False),
    "graded": MeshKind(Physical(), _image, fan=True),
    "box": MeshKind(Physical(), _box, fan=True),
}


def check_cells(mesh: QuadMesh) -> None:
    """Refuse a mesh with a degenerate or turned cell.

    Raises:
        ValueError: a corner of a quadrilateral has no positive area; the message says where.
    """
    corners = mesh.points[mesh.cells]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    area = ahead[..., 0] * behind[..., 1] - ahead[..., 1] * behind[..., 0]
    size = np.linalg.norm(ahead, axis=-1) * np.linalg.norm(behind, axis=-1)
    worst = np.argmin((area / size).min(axis=1))
    if not (area[worst] / size[worst]).min() > 1e-3:
        raise ValueError(
            f"cell {worst} at {corners[worst].mean(axis=0)} (over a) is degenerate; "
            "choose more sectors or a ratio nearer to 1"
        )


def edges(kind: MeshKind, mesh: QuadMesh, points: int = 17) -> NDArray[np.float64]:
    """Polylines along the cells' edges in the half-plane over a, each edge once, (edges, points, 2)."""
    sides = np.stack([mesh.cells, np.roll(mesh.cells, -1, axis=1)], axis=-1).reshape(-1, 2)
    first, last = np.unique(np.sort(sides, axis=1), axis=0).T
    t = np.linspace(0.0, 1.0, points)[:, None]
    lines = (1.0 - t) * mesh.points[first][:, None] + t * mesh.points[last][:, None]
    return kind.chart.to_physical(lines.reshape(-1, 2)).reshape(-1, points, 2)
