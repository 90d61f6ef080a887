"""Meshes of the half-plane under a flat punch, by name.

One row of ``MESHES`` is a mesh: the plane it lives in, and how the ring pattern is laid into it.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshes.planes import Confocal, Physical
from meshes.rings import QuadMesh, Refinement, rectangle

#: Width and depth of the study's block over the half-width: l_p/W = 0.01, l_p/H = 0.02, l_p = 2a.
BOX_WIDTH, BOX_DEPTH = 200.0, 100.0


@dataclass(frozen=True)
class MeshKind:
    """A way to mesh the half-plane.

    Attributes:
        plane: where the mesh lives.
        build: makes the cells from a refinement.
    """

    plane: Confocal | Physical
    build: Callable[[Refinement], QuadMesh]


def _confocal(refinement: Refinement) -> QuadMesh:
    return rectangle(refinement)


def _graded(refinement: Refinement) -> QuadMesh:
    """Straight-sided cells whose vertices are the images of the ring pattern's."""
    pattern = rectangle(refinement, fan=True)
    return QuadMesh(Confocal().to_physical(pattern.points), pattern.cells, pattern.edges)


def _box(refinement: Refinement) -> QuadMesh:
    """The graded mesh, drawn out from ellipses to the study's block in its last columns."""
    pattern = rectangle(refinement, fan=True)
    points = Confocal().to_physical(pattern.points)
    ξ = pattern.points[:, 0]
    outer = ξ.max()
    inner = np.unique(ξ)[-4]  # three columns change shape, so that none is distorted much
    share = np.clip((ξ - inner) / (outer - inner), 0.0, 1.0)[:, None]
    η = pattern.points[:, 1]
    ray = np.column_stack([np.cos(η), np.sin(η)])
    sides = np.array([BOX_WIDTH / 2.0, BOX_DEPTH])
    wall = ray / np.max(np.abs(ray) / sides, axis=1, keepdims=True)
    scaled = wall * (np.cosh(ξ) / np.cosh(outer))[:, None]
    points = np.where(share > 0.0, (1.0 - share) * points + share * scaled, points)
    points[np.abs(points[:, 1]) < 1e-12, 1] = 0.0
    return QuadMesh(points, pattern.cells, pattern.edges)


#: Meshes by the name that scenes use.
MESHES = {
    "confocal": MeshKind(Confocal(), _confocal),
    "uniform": MeshKind(Confocal(), _confocal),
    "graded": MeshKind(Physical(), _graded),
    "box": MeshKind(Physical(), _box),
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
    return kind.plane.to_physical(lines.reshape(-1, 2)).reshape(-1, points, 2)
