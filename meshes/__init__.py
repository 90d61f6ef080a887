"""Meshes of the half-plane, by the name that scenes use."""

from . import confocal, graded  # noqa: F401 - each adds its meshes
from .confocal import CONFOCAL
from .kind import MESHES, MeshKind, Wanted

__all__ = ["CONFOCAL", "MESHES", "MeshKind", "Wanted"]
