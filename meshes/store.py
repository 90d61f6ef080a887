"""Meshes of earlier runs, kept in the user's cache folder."""

import hashlib
import os
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from galinx.meshes.rings import QuadMesh

#: Part of every key; raised when what is kept, or how it is made, changes.
_FORMAT = 1


def _path(pattern: QuadMesh) -> Path:
    """Where the mesh of a pattern is kept; the name is a hash of everything that it depends on."""
    key = hashlib.sha256(f"{_FORMAT}".encode())
    for array in (pattern.points, pattern.cells, *pattern.edges.values()):
        key.update(f"{array.dtype}{array.shape}".encode() + array.tobytes())
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(home) / "galinx" / "meshes" / f"{key.hexdigest()[:24]}.npz"


def is_kept(pattern: QuadMesh) -> bool:
    """Was a mesh of this pattern made before?"""
    return _path(pattern).is_file()


def obtain(pattern: QuadMesh) -> QuadMesh:
    """The mesh of a pattern: that of an earlier run, or gmsh's, which is then kept."""
    kept = _load(_path(pattern))
    if kept:
        return kept
    from galinx.meshes.gmsh_model import through_gmsh  # a slow import, for nothing if the mesh is kept

    mesh = through_gmsh(pattern)
    _keep(_path(pattern), mesh)
    return mesh


def _load(path: Path) -> QuadMesh | None:
    """The mesh in a file; None if there is none, or a damaged one."""
    try:
        with np.load(path) as file:
            edges = {int(name): file[name] for name in file.files if name.isdigit()}
            return QuadMesh(file["points"], file["cells"], edges)
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None


def _keep(path: Path, mesh: QuadMesh) -> None:
    """Write a mesh at once or not at all; a folder that cannot be written is no fault."""
    temporary = path.with_name(f"{path.name}.{os.getpid()}.npz")
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        edges: dict[str, Any] = {str(tag): edges for tag, edges in mesh.edges.items()}
        np.savez(temporary, points=mesh.points, cells=mesh.cells, **edges)
        os.replace(temporary, path)
