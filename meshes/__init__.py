"""Meshes of the half-plane, by the name that scenes use."""

from galinx.meshes import confocal, graded  # noqa: F401 - each adds its meshes
from galinx.meshes.confocal import CONFOCAL
from galinx.meshes.kind import MESHES, MeshKind, Wanted

__all__ = ["CONFOCAL", "MESHES", "MeshKind", "Wanted"]
