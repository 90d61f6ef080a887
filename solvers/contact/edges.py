"""Edges of a punch: positions under it, exponents of the pressure, and the singular contact stress."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..solids.half_plane import HalfPlane


def under_punch(X: ArrayLike) -> NDArray[np.bool_]:
    """True where a position X over a on the surface is under the punch; False at its edges."""
    return np.abs(np.asarray(X, dtype=float)) < 1.0


def from_edge(X: ArrayLike) -> NDArray[np.float64]:
    """Distance over a from the nearer edge of the punch."""
    return np.abs(1.0 - np.abs(np.asarray(X, dtype=float)))


def weights_hilbert(α: Any, β: Any, r: NDArray) -> NDArray[np.float64]:
    """(1/π) ⨍ (1 - t)^α (1 + t)^β/(t - r) dt, α + β = -1."""
    size = np.abs(1.0 - r) ** α * np.abs(1.0 + r) ** β
    under = under_punch(r)
    return np.where(under, size / np.tan(np.pi * α), np.sign(r) * size / np.sin(np.pi * α))


@dataclass(frozen=True)
class EdgeTraction:
    """Stress on the contact of a flat punch over N/(2a) (Eq 55); numbers, arrays, or symbols of a form.

    Attributes:
        amplitude: of the stress, negative.
        α, β: exponents at X = a and X = -a.
    """

    amplitude: Any
    α: Any
    β: Any

    def __call__(self, left: Any, right: Any) -> Any:
        """The stress at the distances 1 + X/a and 1 - X/a from the two edges."""
        return self.amplitude * right**self.α * left**self.β


@dataclass(frozen=True)
class EdgeExponents:
    """Local analysis of a punch's sharp edges at one speed and friction, or at several frictions.

    Properties are numbers, or arrays of the shape of ``g``.

    Args:
        response: of the half-plane at that speed.
        g: σ_XY/σ_YY under the punch, dimensionless and signed; an array broadcasts against positions.
    """

    response: HalfPlane
    g: float | NDArray[np.float64]

    @cached_property
    def _cot(self) -> Any:
        """cot(πα) = g q/(n + g n₁₂) (Eq 42)."""
        return self.g * self.response.q / (self.response.n + self.g * self.response.n12)

    @cached_property
    def α(self) -> Any:
        """Exponent of the pressure at X = a, in (-1, 0): cot(πα) = g q/n (Eq 42)."""
        return -0.5 - np.arctan(self._cot) / np.pi

    @cached_property
    def β(self) -> Any:
        """Exponent of the pressure at X = -a: β = -1 - α (Eq 43)."""
        return -0.5 + np.arctan(self._cot) / np.pi

    @cached_property
    def _sin(self) -> Any:
        """sin(πα), negative; through the cotangent, so that no digit is lost."""
        return -1.0 / np.hypot(1.0, self._cot)

    @property
    def K_I(self) -> Any:
        """Normalised mode I stress intensity factor, the same number at both ends (Eqs 56-58).

        The limit at X = ±a of -σ_YY/(N/a) divided by (1 - r)^α (1 + r)^β; dimensionless. The two ends
        are not equally severe for all that: their exponents differ.
        """
        return -self._sin / np.pi


@dataclass(frozen=True)
class Exponents:
    """Exponents of the pressure at the right and the left end, (states,) each."""

    α: NDArray[np.float64]
    β: NDArray[np.float64]
