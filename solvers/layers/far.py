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

from galinx.solvers.layers.medium import Medium, inverse
from galinx.solvers.solids.line_loads import DATUM, LOADS, line_loads


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
        """Under ∫σ_YY = 1 and ∫σ_XY = 1, relative to where layers are no longer seen: (2, 2, n)."""
        below, datum = np.minimum(Y + self.D, 0.0), DATUM * max(1.0, self.length)
        (found,) = line_loads(self.substrate.response, X, below, datum=datum) / self.substrate.modulus
        z = X[:, None, None] * np.eye(2) + below[:, None, None] * self.substrate.G.conj()
        heights, which = np.unique(np.maximum(Y, -self.D), return_inverse=True)
        more = np.array([self._moved(height) for height in heights.tolist()])[which]
        w = inverse(z) @ (self._below + more)
        for load, t in zip(found, LOADS):
            load += (1j * w @ t).real.T / np.pi
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
