"""Meshes as Gmsh models, and those of earlier runs, kept in the user's cache folder."""

import hashlib
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import files

from .rings import TAGS, QuadMesh

_LINE, _QUADRANGLE = 1, 3  # Gmsh's element types


def through_gmsh(mesh: QuadMesh) -> QuadMesh:
    """Mesh as a Gmsh model holds it, cells and tagged edges as physical groups.

    The model is built of discrete cells, so every version of Gmsh gives the same mesh.
    """
    import gmsh  # a slow import, not needed if the mesh is kept

    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        _build(gmsh.model, mesh)
        return _read(gmsh.model)
    finally:
        gmsh.finalize()


def _build(model: Any, mesh: QuadMesh) -> None:
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


def _read(model: Any) -> QuadMesh:
    """Quadrilaterals of the current model, and the edges of its tagged lines."""
    numbers, coordinates, _ = model.mesh.getNodes()
    order = np.argsort(numbers)
    position = np.empty(int(numbers.max()) + 1, dtype=np.int64)
    position[numbers[order].astype(np.int64)] = np.arange(len(numbers))
    points = coordinates.reshape(-1, 3)[order, :2]

    def elements(kind: int, entities: NDArray, corners: int) -> NDArray[np.int64]:
        parts = [model.mesh.getElementsByType(kind, entity)[1] for entity in entities]
        return position[np.concatenate(parts).astype(np.int64)].reshape(-1, corners)

    groups = model.getPhysicalGroups()
    of = {group: model.getEntitiesForPhysicalGroup(*group) for group in groups}
    cells = [elements(_QUADRANGLE, entities, 4) for (dim, _), entities in of.items() if dim == 2]
    edges = {tag: elements(_LINE, entities, 2) for (dim, tag), entities in of.items() if dim == 1}
    return QuadMesh(points, np.concatenate(cells), edges)


def obtain(pattern: QuadMesh) -> QuadMesh:
    """Mesh of a pattern: that of an earlier run, or a new one by Gmsh, which is then kept.

    A kept file that is damaged is replaced: the checksums of its arrays show it.

    Args:
        pattern: cells and tagged edges.
    """
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    path = home / "galinx" / "meshes" / f"{_key(pattern)}.npz"
    with suppress(Exception):  # each bit of a file raises what it likes where it is flipped
        if path.is_file():
            with np.load(path) as arrays:
                edges = {tag: arrays[str(tag)] for tag in pattern.edges}
                return QuadMesh(arrays["points"], arrays["cells"], edges)
    mesh = through_gmsh(pattern)
    with suppress(OSError):  # a folder that cannot be written is no fault
        path.parent.mkdir(parents=True, exist_ok=True)
        with files.NewFile(path) as file:
            arrays = {str(tag): edges for tag, edges in mesh.edges.items()}
            with open(file.temporary, "wb") as stream:
                np.savez(stream, points=mesh.points, cells=mesh.cells, **arrays)
            file.publish(replace=path.exists())
    return mesh


def _key(pattern: QuadMesh) -> str:
    """Hash of everything that the mesh of a pattern depends on."""
    key = hashlib.sha256()
    for array in (pattern.points, pattern.cells, *pattern.edges.values()):
        key.update(f"{array.dtype}{array.shape}".encode() + array.tobytes())
    return key.hexdigest()[:24]
