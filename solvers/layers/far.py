"""How layers on a substrate move far from a load: as under line loads, and what the layers do to that.

With t the loads of a field e^(ikX), Z₋ of the substrate, and through layers that are thin beside 1/k

    t' = k² A u - ik B t,   u' = -ik Bᵀ u + T⁻¹ t,   A = Q - R T⁻¹ Rᵀ,   B = R T⁻¹   (Y upwards),

the substrate, whose surface lies at the depth D, carries t + k E t and moves there by

    u = Z₋⁻¹ t/k + Z₋⁻¹ E t + O(k),   E = -∫ (A Z₋⁻¹ - i B) dY,

a height inside the layers by ∫ (T⁻¹ - i Bᵀ Z₋⁻¹) dY t more. The first term is the line load's
logarithm, the others fall like 1/X; what is left falls like its square.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import log1p  # NumPy's loses digits for small complex arguments

from galinx.solvers.layers.medium import Medium, inverse

#: Unit loads: ∫σ_YY = 1 and ∫σ_XY = 1, as (σ_XY, σ_YY).
_LOADS = ((0.0, 1.0), (1.0, 0.0))


@dataclass(frozen=True)
class FarField:
    """Displacements of layers on a substrate far from line loads at the origin.

    Attributes:
        substrate: the half-plane below, at its speed.
        D: depth of its surface over a.
        through: ∫ A, ∫ B and ∫ T⁻¹ over the layers from -D up to a height over a, (3, 2, 2).
    """

    substrate: Medium
    D: float
    through: Callable[[float], NDArray[np.float64]]

    def __call__(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """Under ∫σ_YY = 1 and ∫σ_XY = 1, up to a translation: (2, 2, n)."""
        below = np.minimum(Y + self.D, 0.0)
        found = line_load(self.substrate, X, below)
        z = X[:, None, None] * np.eye(2) + below[:, None, None] * self.substrate.G.conj()
        heights, which = np.unique(np.maximum(Y, -self.D), return_inverse=True)
        more = np.array([self._moved(height) for height in heights.tolist()])[which]
        w = inverse(z) @ (self._below + more)
        for load, t in zip(found, _LOADS):
            load += (1j * w @ np.array(t)).real.T / np.pi
        return found

    @cached_property
    def _compliance(self) -> NDArray[np.complex128]:
        return inverse(self.substrate.down)

    @property
    def length(self) -> float:
        """Over which the layers are seen, over a: of the terms beside the line load's."""
        moved, compliance, loaded = (
            float(np.linalg.norm(one, 2)) for one in (self._moved(0.0), self._compliance, self._loaded)
        )
        return max(self.D, moved / compliance, loaded)

    @cached_property
    def _loaded(self) -> NDArray[np.complex128]:
        """E."""
        A, B, _ = self.through(0.0)
        return np.asarray(1j * B - A @ self._compliance)

    @cached_property
    def _below(self) -> NDArray[np.complex128]:
        """Z₋⁻¹ E."""
        return np.asarray(self._compliance @ self._loaded)

    def _moved(self, height: float) -> NDArray[np.complex128]:
        """∫ (T⁻¹ - i Bᵀ Z₋⁻¹) dY from the substrate up to a height."""
        _, B, T_inverse = self.through(height)
        return np.asarray(T_inverse - 1j * B.T @ self._compliance)


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
    for t in _LOADS:
        one, two = Y_surface @ t, beyond @ Y_surface @ t
        found.append([(log * one[i] + change * two[i]).imag / np.pi for i in (0, 1)])
    return np.array(found)
