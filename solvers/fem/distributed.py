"""Meshes shared out over ranks."""

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from galinx.solvers.fem.adapter import create_mesh, tag_facets

#: dolfinx numbers a quadrilateral's vertices row by row, others go round it.
_ORDER = [0, 1, 3, 2]


class Quadrilaterals(Protocol):
    """``points`` (n, 2), ``cells`` (m, 4) going round, and ``edges`` (k, 2) by their tag."""

    @property
    def points(self) -> NDArray: ...
    @property
    def cells(self) -> NDArray: ...
    @property
    def edges(self) -> Mapping[int, NDArray]: ...


def distribute(mesh: Quadrilaterals | None, comm: MPI.Comm) -> tuple[Any, Any]:
    """Share a mesh out over the ranks of ``comm``.

    Args:
        mesh: what this rank has of it, None for nothing. Vertices are numbered over all ranks; ``points``
            are those of the next numbers after the ranks before.
        comm: communicator.

    Returns:
        The dolfinx mesh and its facet tags.
    """
    points, cells = np.empty((0, 2)), np.empty((0, 4), dtype=np.int64)
    edges, tags = np.empty((0, 2), dtype=np.int64), np.empty(0, dtype=np.int32)
    if mesh:
        points, cells = mesh.points, mesh.cells[:, _ORDER]
        edges = np.concatenate(list(mesh.edges.values()))
        tags = np.repeat(np.array([*mesh.edges], np.int32), [len(part) for part in mesh.edges.values()])
    result = create_mesh(comm, cells, points)
    return result, tag_facets(result, edges, tags)
