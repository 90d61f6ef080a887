"""Confocal meshes: the rectangle of elliptic coordinates, where edge singularities are nearly smooth."""

from math import pi

from .charts import Confocal
from .kind import MESHES, MeshKind

CONFOCAL = MeshKind(
    "confocal, graded towards the edges", Confocal(), ratio=0.35, column=3.0, alone=2.2,
    stressed=0.5, tight=0.6,
)  # fmt: skip

UNIFORM = MeshKind(
    "confocal, squares all over", Confocal(), ratio=0.5, column=pi / 4.0, rings=False
)  # fmt: skip

MESHES.register("confocal", CONFOCAL)
MESHES.register("uniform", UNIFORM)
