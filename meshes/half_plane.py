"""Meshes of the half-plane that scenes name.

Confocal ones are drawn in the rectangle of elliptic coordinates, where edge singularities are nearly
smooth; cells of graded ones and of the study's block have straight sides in the physical half-plane.
"""

from math import pi

import numpy as np
from numpy.typing import NDArray

from .charts import Confocal, Physical
from .kind import MESHES, MeshKind
from .rings import Refinement

#: Width and depth of the study's block over the half-width: l_p/W = 0.01, l_p/H = 0.02, l_p = 2a.
BOX_WIDTH, BOX_DEPTH = 200.0, 100.0


def image(points: NDArray, _: Refinement) -> NDArray[np.float64]:
    """Vertices of straight-sided cells."""
    return Confocal().to_physical(points)


def box(points: NDArray, refinement: Refinement) -> NDArray[np.float64]:
    """The graded mesh, drawn out from ellipses to the study's block in its last columns."""
    ξ, η = points.T
    of_columns = np.pi / 2.0 + np.concatenate([[0.0], np.cumsum(refinement.columns)])
    # Three columns change shape, so that none is distorted much.
    inner, outer = of_columns[-4], of_columns[-1]
    share = np.clip((ξ - inner) / (outer - inner), 0.0, 1.0)[:, None]
    ray = np.column_stack([np.cos(η), np.sin(η)])
    sides = np.array([BOX_WIDTH / 2.0, BOX_DEPTH])
    wall = ray / np.max(np.abs(ray) / sides, axis=1, keepdims=True)
    scaled = wall * (np.cosh(ξ) / np.cosh(outer))[:, None]
    X = image(points, refinement)
    X = np.where(share > 0.0, (1.0 - share) * X + share * scaled, X)
    X[np.abs(X[:, 1]) < 1e-12, 1] = 0.0
    return X


CONFOCAL = MeshKind(
    "confocal, graded towards the edges", Confocal(), ratio=0.35, column=3.0, alone=2.2,
    stressed=0.5, tight=0.6,
)  # fmt: skip

UNIFORM = MeshKind(
    "confocal, squares all over", Confocal(), ratio=0.5, column=pi / 4.0, rings=False
)  # fmt: skip

GRADED = MeshKind(
    "straight-sided, graded towards the edges",
    Physical(contracts=True),
    ratio=0.5,
    column=1.0,
    place=image,
    fan=True,
    innermost=1.0 / 150.0,
    beside=6.0,
    gentle=1.0,
    smallest=1e-5,
)

BOX = MeshKind(
    "the block of the study, with walls at 100 a", Physical(), ratio=0.5, column=0.7, place=box, fan=True,
    beside=6.0, gentle=1.0, smallest=1e-5, walls=BOX_DEPTH,
)  # fmt: skip

MESHES.register("confocal", CONFOCAL)
MESHES.register("uniform", UNIFORM)
MESHES.register("graded", GRADED)
MESHES.register("box", BOX)
