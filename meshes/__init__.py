"""Meshes of the half-plane, by the name that scenes use."""

from .kind import MESHES, MeshKind, Requirements

__all__ = ["MESHES", "MeshKind", "Requirements"]
