"""Meshes shared out over ranks as dolfinx meshes."""

from typing import Any

import dolfinx
import numpy as np
import ufl
from mpi4py import MPI

from meshes.rings import QuadMesh

#: dolfinx numbers a quadrilateral's vertices row by row, the pattern and gmsh go round it.
_ORDER = [0, 1, 3, 2]


def distribute(mesh: QuadMesh, comm: MPI.Comm) -> tuple[Any, Any]:
    """Share a mesh out over the ranks of ``comm``.

    Args:
        mesh: the whole mesh; looked at on rank 0 only.
        comm: communicator.

    Returns:
        The dolfinx mesh and its facet tags.
    """
    points, cells = np.empty((0, 2)), np.empty((0, 4), dtype=np.int64)
    edges, tags = np.empty((0, 2), dtype=np.int64), np.empty(0, dtype=np.int32)
    if comm.rank == 0:
        points, cells = mesh.points, mesh.cells[:, _ORDER]
        edges = np.concatenate(list(mesh.edges.values()))
        tags = np.repeat(np.array([*mesh.edges], np.int32), [len(part) for part in mesh.edges.values()])
    # The form compiler names this variant in the element when it compiles, not when it finds the form in
    # its cache; named here, the form has one key in both cases.
    element = ufl.VectorElement("Lagrange", ufl.quadrilateral, 1, variant="equispaced")
    domain = ufl.Mesh(element)
    result = dolfinx.mesh.create_mesh(comm, cells, points, domain)
    facet = result.topology.dim - 1
    entities, values = dolfinx.cpp.io.distribute_entity_data(result._mesh, facet, edges, tags)
    result.topology.create_connectivity(facet, facet + 1)
    adjacency = dolfinx.cpp.graph.AdjacencyList_int32(entities)
    return result, dolfinx.mesh.meshtags_from_entities(result, facet, adjacency, values.astype(np.int32))
