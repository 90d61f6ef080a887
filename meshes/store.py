"""Meshes by gmsh, and those of earlier runs, kept in the user's cache folder."""

import hashlib
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import files, sealed

from .rings import TAGS, QuadMesh

_LINE, _QUADRANGLE = 1, 3  # gmsh's element types


def through_gmsh(mesh: QuadMesh) -> QuadMesh:
    """The mesh as a gmsh model holds it, cells and tagged edges as physical groups.

    The model is built of discrete cells, so every gmsh version gives the same mesh.
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
    """The current model's quadrilaterals and the edges of its tagged lines."""
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


#: Part of every key; raised when the content of files, or the way to make it, changes.
_FORMAT = 3


def _key(pattern: QuadMesh) -> str:
    """A hash of everything that the mesh of a pattern depends on."""
    key = hashlib.sha256(f"{_FORMAT}".encode())
    for array in (pattern.points, pattern.cells, *pattern.edges.values()):
        key.update(f"{array.dtype}{array.shape}".encode() + array.tobytes())
    return key.hexdigest()


def _path(key: str) -> Path:
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(home) / "galinx" / "meshes" / f"{key[:24]}.mesh"


def is_kept(pattern: QuadMesh) -> bool:
    """True where a mesh of this pattern was made before, and its file is whole."""
    return _load(_key(pattern)) is not None


def obtain(pattern: QuadMesh, say: Callable[[str], None] = lambda _: None) -> QuadMesh:
    """The mesh of a pattern: that of an earlier run, or gmsh's, which is then kept.

    Args:
        pattern: cells and tagged edges.
        say: called with a message to the user where a kept mesh is damaged.
    """
    key = _key(pattern)
    if kept := _load(key):
        return kept
    if os.path.lexists(_path(key)):
        say(f"the mesh kept in {_path(key)} is damaged; it is made again")

    mesh = through_gmsh(pattern)
    _keep(key, mesh)
    return mesh


def _load(key: str) -> QuadMesh | None:
    """The mesh of a key; None if there is none, or its file is damaged or of another key."""
    stored_key, arrays = sealed.read(_path(key)) or (None, {})
    if stored_key != key:
        return None
    points, cells = arrays.pop("points"), arrays.pop("cells")
    return QuadMesh(points, cells, {int(tag): edges for tag, edges in arrays.items()})


def _keep(key: str, mesh: QuadMesh) -> None:
    """Write a mesh at once or not at all; a folder that cannot be written is no fault."""
    edges = {str(tag): edges for tag, edges in mesh.edges.items()}
    content = sealed.packed(key, {"points": mesh.points, "cells": mesh.cells, **edges})
    with suppress(OSError):
        _path(key).parent.mkdir(parents=True, exist_ok=True)
        files.write(_path(key), b"".join(content))
