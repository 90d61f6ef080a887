"""Meshes of the half-plane, by the name that scenes use."""

from galinx.meshes.confocal import CONFOCAL, UNIFORM
from galinx.meshes.graded import BOX, GRADED
from galinx.meshes.kind import MeshKind
from galinx.registry import Registry

MESHES: Registry[MeshKind] = Registry(
    "mesh", {"confocal": CONFOCAL, "graded": GRADED, "box": BOX, "uniform": UNIFORM}
)
