"""A uniform solid between two depths, seen from a load that moves: what goes up in it and what goes down.

For a field e^(ikX), k > 0, displacements u = e^(ik Ḡ Y) a decay downwards and u = e^(ik G Y) b upwards, G
of the solid's own half-plane, and their tractions t = (σ_XY, σ_YY) are k Z₋ u and k Z₊ u with

    Z₋ = i conj(L),   Z₊ = i L,   L = Rᵀ + T G.

Below the speed of the solid's surface wave Z₋ is positive and Z₊ negative, both Hermitian.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray


def inverse(M: NDArray) -> NDArray[Any]:
    """Of matrices (..., 2, 2), by the formula."""
    a, b, c, d = M[..., 0, 0], M[..., 0, 1], M[..., 1, 0], M[..., 1, 1]
    adjugate = np.stack([np.stack([d, -b], axis=-1), np.stack([-c, a], axis=-1)], axis=-2)
    return np.asarray(adjugate / (a * d - b * c)[..., None, None])


def least(Z: NDArray) -> NDArray[np.float64]:
    """Smaller eigenvalue of Hermitian matrices (..., 2, 2); NaN stays."""
    a, d = Z[..., 0, 0].real, Z[..., 1, 1].real
    across = np.abs(Z[..., 0, 1] + Z[..., 1, 0].conj()) / 2.0
    half = np.hypot((a - d) / 2.0, across)
    # The product over the larger one where both are positive: nothing cancels.
    larger = (a + d) / 2.0 + half
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(larger > 0.0, (a * d - across**2) / larger, (a + d) / 2.0 - half)


@dataclass(frozen=True)
class Medium:
    """A solid at a speed.

    Attributes:
        response: of its half-plane at that speed.
        modulus: what its stiffness is given over, over the modulus of the surface's solid.
    """

    response: Any
    modulus: float

    @cached_property
    def G(self) -> NDArray[Any]:
        """u,Y = G u,X of what decays upwards for k > 0, (2, 2)."""
        return np.asarray(self.response.G)

    @cached_property
    def down(self) -> NDArray[Any]:
        """Z₋, (2, 2)."""
        return np.asarray(1j * self.modulus * self.response.L.conj())

    @cached_property
    def up(self) -> NDArray[Any]:
        """Z₊, (2, 2)."""
        return np.asarray(1j * self.modulus * self.response.L)

    @cached_property
    def T_inverse(self) -> NDArray[np.float64]:
        """Inverse of the stiffness across, (2, 2)."""
        return np.asarray(self.response.T_inverse / self.modulus)

    def upwards(self, kh: NDArray) -> NDArray[Any]:
        """e^(ik G h) for h >= 0, (n, 2, 2); what decays downwards is its conjugate at the same distance.

        Args:
            kh: k times h, (n,).
        """
        p, other = self.response.roots.each
        middle, half = (p + other) / 2.0, (p - other) / 2.0
        one, two = np.exp(1j * kh * p), np.exp(1j * kh * other)
        x = kh * half
        near = np.abs(x) < 0.5
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            by_series = np.exp(1j * kh * middle) * kh * np.sinc(np.where(near, x, 0.0) / np.pi)
            by_difference = (one - two) / (2j * half)
        change = np.where(near, by_series, by_difference)
        beyond = self.G - middle * np.eye(2)
        return np.asarray(
            ((one + two) / 2.0)[:, None, None] * np.eye(2) + 1j * change[:, None, None] * beyond
        )
