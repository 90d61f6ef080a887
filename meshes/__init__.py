"""Meshes of the half-plane, by the name that scenes use."""

from .kind import MESHES, MeshKind, Requirements

#: The mesh of scenes that name none.
CONFOCAL = MESHES["confocal"]

__all__ = ["CONFOCAL", "MESHES", "MeshKind", "Requirements"]
