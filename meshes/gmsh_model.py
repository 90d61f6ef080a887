"""The one place that meets gmsh."""

import gmsh
import numpy as np
from numpy.typing import NDArray

from galinx.meshes.rings import TAGS, QuadMesh

_LINE, _QUADRANGLE = 1, 3  # gmsh's element types


def through_gmsh(mesh: QuadMesh) -> QuadMesh:
    """The mesh as a gmsh model holds it, cells and tagged edges as physical groups.

    The model is built of discrete cells, so every gmsh version gives the same mesh.
    """
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        _build(mesh)
        return _read()
    finally:
        gmsh.finalize()


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


def _read() -> QuadMesh:
    """The current model's quadrilaterals and the edges of its tagged lines."""
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(numbers)
    position = np.empty(int(numbers.max()) + 1, dtype=np.int64)
    position[numbers[order].astype(np.int64)] = np.arange(len(numbers))
    points = coordinates.reshape(-1, 3)[order, :2]

    def elements(kind: int, entities: NDArray, corners: int) -> NDArray[np.int64]:
        parts = [gmsh.model.mesh.getElementsByType(kind, entity)[1] for entity in entities]
        return position[np.concatenate(parts).astype(np.int64)].reshape(-1, corners)

    groups = gmsh.model.getPhysicalGroups()
    of = {group: gmsh.model.getEntitiesForPhysicalGroup(*group) for group in groups}
    cells = [elements(_QUADRANGLE, entities, 4) for (dim, _), entities in of.items() if dim == 2]
    edges = {tag: elements(_LINE, entities, 2) for (dim, tag), entities in of.items() if dim == 1}
    return QuadMesh(points, np.concatenate(cells), edges)
