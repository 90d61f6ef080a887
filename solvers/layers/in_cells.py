"""Layers as finite elements see them: constants cell by cell, and how the far boundary moves."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import log1p  # NumPy's loses digits for small complex arguments

from galinx.solvers.layers.layered import LayeredResponse
from galinx.solvers.layers.medium import Medium, inverse
from galinx.solvers.solids.solid import Solid


@dataclass(frozen=True)
class LayersInCells(LayeredResponse):
    """The same as finite elements see it, whose cells have constants of their own.

    See :class:`galinx.solvers.solids.solid.ByCells`.

    Attributes:
        a: length that lengths are divided by [m].
    """

    a: float = 1.0

    #: Meshes along interfaces are drawn in the plane itself.
    contraction = 1j  # type: ignore[assignment]

    def constants(self, Y: NDArray, names: Sequence[str]) -> NDArray[np.float64]:
        depths = -np.mean(Y, axis=1)
        layer = np.searchsorted(self.solid.depths / self.a, depths)
        by_layer = [self._constants(one.solid, names) for one in self.solid.layers]
        by_layer.append(self._constants(self.solid.substrate, names))
        return np.array(by_layer)[layer]

    def _constants(self, solid: Solid, names: Sequence[str]) -> list[float]:
        """Stiffness over the surface's μ, and the speed over the surface's wave speed by density."""
        C = stiffness(solid) / self.solid.μ
        inertia = self.c * (solid.ρ / self.solid.ρ) ** 0.5
        known = {"c11": C[0, 0], "c12": C[0, 1], "c16": C[0, 2], "c22": C[1, 1], "c26": C[1, 2],
                 "c66": C[2, 2], "c": inertia}  # fmt: skip
        return [float(known[name]) for name in names]

    def far(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        medium = self.medium(self.solid.substrate)
        return line_load(medium, X, Y) * np.array(-2.0)


def stiffness(solid: Solid) -> NDArray[np.float64]:
    """σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY [Pa], (3, 3)."""
    response = solid.response(0.0)
    strains = np.array([[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [0.0, 0.0]]])
    return np.asarray(solid.μ * response.stresses(strains))


def line_load(medium: Medium, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
    """Displacements under moving line loads at the origin, ∫σ_YY = 1 and ∫σ_XY = 1: (2, 2, n).

    u = Im[log(X + Y G) 𝐘 t]/π, the logarithm of a matrix by that of its eigenvalues; up to a translation.
    """
    p, other = medium.response.roots.each
    z = X + p * np.minimum(Y, 0.0) - 0.0j
    z = np.where(Y < 0.0, z, X + np.where(X < 0.0, -1e-300j, 0.0))
    step = (other - p) * Y / z
    log, change = np.log(z), np.where(step == 0.0, Y / z, log1p(step) / np.where(step == 0, 1, other - p))
    beyond = medium.G - p * np.eye(2)
    Y_surface = inverse(medium.modulus * np.asarray(medium.response.L))
    found = []
    for t in ([0.0, 1.0], [1.0, 0.0]):
        one, two = Y_surface @ t, beyond @ Y_surface @ t
        found.append([(log * one[i] + change * two[i]).imag / np.pi for i in (0, 1)])
    return np.array(found)
