"""Meshes of earlier runs, kept in the user's cache folder."""

import hashlib
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from galinx import files, sealed
from galinx.meshes.rings import QuadMesh

#: Part of every key; raised when what is kept, or how it is made, changes.
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
    """Was a mesh of this pattern made before, and is it whole?"""
    return _load(_key(pattern)) is not None


def obtain(pattern: QuadMesh, say: Callable[[str], None] = lambda _: None) -> QuadMesh:
    """The mesh of a pattern: that of an earlier run, or gmsh's, which is then kept.

    Args:
        pattern: cells and tagged edges.
        say: is told what the user should know: that a kept mesh was damaged.
    """
    key = _key(pattern)
    if kept := _load(key):
        return kept
    if os.path.lexists(_path(key)):
        say(f"the mesh kept in {_path(key)} is damaged; it is made again")
    from galinx.meshes.gmsh_model import through_gmsh  # a slow import, for nothing if the mesh is kept

    mesh = through_gmsh(pattern)
    _keep(key, mesh)
    return mesh


def _load(key: str) -> QuadMesh | None:
    """The mesh of that key; None if there is none, or it is damaged or another's."""
    told, arrays = sealed.read(_path(key)) or (None, {})
    if told != key:
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
