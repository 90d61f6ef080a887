"""What is asked of a mesh's cells: are they sound, and where are their edges?"""

import numpy as np
from numpy.polynomial import Legendre
from numpy.typing import NDArray

from galinx.meshes.kind import MeshKind
from galinx.meshes.rings import QuadMesh


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


def nodes(kind: MeshKind, mesh: QuadMesh, degree: int) -> NDArray[np.float64]:
    """Where the unknowns of a degree are in the half-plane over a, those of neighbours twice, (n, 2).

    Args:
        kind, mesh: the mesh.
        degree: polynomial degree; nodes are those of Gauss, Lobatto and Legendre.
    """
    inner = Legendre.basis(degree).deriv().roots().real
    t = (1.0 + np.array([-1.0, *inner, 1.0])) / 2.0
    s, t = (z.ravel()[:, None] for z in np.meshgrid(t, t))
    corners = mesh.points[mesh.cells][:, :, None]
    shapes = (1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t
    points = sum(shape * corners[:, n] for n, shape in enumerate(shapes))
    return kind.chart.to_physical(np.reshape(points, (-1, 2)))
