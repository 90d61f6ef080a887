"""Meshes of the half-plane, by the name that scenes use."""

from .half_plane import CONFOCAL
from .kind import MESHES, MeshKind, Requirements

__all__ = ["CONFOCAL", "MESHES", "MeshKind", "Requirements"]
