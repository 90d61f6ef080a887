"""The one place that meets gmsh: quadrilaterals become a gmsh model, that becomes a dolfinx mesh."""

from typing import Any

import gmsh
import numpy as np
from dolfinx.io import gmshio
from mpi4py import MPI

from meshes.rings import TAGS, QuadMesh

_LINE, _QUADRANGLE = 1, 3  # gmsh's element types


def distribute(mesh: QuadMesh, comm: MPI.Comm) -> tuple[Any, Any]:
    """Share a mesh out over the ranks of ``comm``.

    The model is built on rank 0 from discrete cells, so every gmsh version gives the same mesh.

    Args:
        mesh: the whole mesh; looked at on rank 0 only.
        comm: communicator.

    Returns:
        The dolfinx mesh and its facet tags.
    """
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        if comm.rank == 0:
            _build(mesh)
        result = gmshio.model_to_mesh(gmsh.model, comm, 0, gdim=2)
    finally:
        gmsh.finalize()
    return result[0], result[2]


def _build(mesh: QuadMesh) -> None:
    model = gmsh.model
    model.add("half-plane")
    surface = model.addDiscreteEntity(2)
    nodes = np.arange(1, len(mesh.points) + 1)
    coordinates = np.column_stack([mesh.points, np.zeros(len(mesh.points))])
    model.mesh.addNodes(2, surface, nodes, coordinates.ravel())
    model.mesh.addElementsByType(surface, _QUADRANGLE, [], (mesh.cells + 1).ravel())
    model.setPhysicalName(2, model.addPhysicalGroup(2, [surface]), "solid")
    for name, tag in TAGS.items():
        line = model.addDiscreteEntity(1)
        model.mesh.addElementsByType(line, _LINE, [], (mesh.edges[tag] + 1).ravel())
        model.addPhysicalGroup(1, [line], tag)
        model.setPhysicalName(1, tag, name)
