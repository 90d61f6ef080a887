"""Closed form of a rigid flat punch that slides over a half-plane at constant speed (Eqs 38-58).

Lengths are divided by the half-width a, stresses by N/(2a); positions r = X/a. ``g`` is the signed
ratio σ_XY/σ_YY under the punch: g = -f for a punch that drags the surface along with it.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.solvers.solids.isotropic import MovingFrame


@dataclass(frozen=True)
class FlatPunch:
    """The exact solution at one speed and friction, or at several frictions.

    Properties are numbers, or arrays of the shape of ``g``.

    Args:
        frame: constants of the moving frame.
        g: σ_XY/σ_YY under the punch, dimensionless and signed; an array broadcasts against positions.
    """

    frame: MovingFrame
    g: float | NDArray[np.float64]

    @property
    def α(self) -> Any:
        """Exponent of the pressure at X = a, in (-1, 0): cot(πα) = g q/n (Eq 42)."""
        return -0.5 - np.arctan(self.g * self.frame.q / self.frame.n) / np.pi

    @property
    def β(self) -> Any:
        """Exponent of the pressure at X = -a: β = -1 - α (Eq 43)."""
        return -0.5 + np.arctan(self.g * self.frame.q / self.frame.n) / np.pi

    @property
    def _cot(self) -> Any:
        return self.g * self.frame.q / self.frame.n

    @property
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

    def σ_YY(self, r: ArrayLike) -> NDArray[np.float64]:
        """Contact stress over N/(2a) at r = X/a; 0 outside the contact, NaN at |r| = 1 (Eq 55).

        The study's Eq 55 has lost the sign of its Eq 37; the stress is compressive.
        """
        r = np.asarray(r, dtype=float)
        with np.errstate(invalid="ignore", divide="ignore"):
            inside = 2.0 * self._sin / np.pi * self._weight(r)
        return np.where(np.abs(r) < 1.0, inside, np.where(np.abs(r) > 1.0, 0.0, np.nan))

    def σ_YY_by_distance(self, left: ArrayLike, right: ArrayLike) -> NDArray[np.float64]:
        """Contact stress over N/(2a) at the distances 1 + X/a and 1 - X/a from the two edges."""
        left, right = np.asarray(left, dtype=float), np.asarray(right, dtype=float)
        return 2.0 * self._sin / np.pi * right**self.α * left**self.β

    def hilbert(self, r: ArrayLike) -> NDArray[np.float64]:
        """(1/π) ⨍ σ_YY(t)/(t - r) dt on the whole surface over N/(2a); NaN at |r| = 1."""
        r = np.asarray(r, dtype=float)
        with np.errstate(invalid="ignore", divide="ignore"):
            outside = np.abs(r - 1.0) ** self.α * np.abs(r + 1.0) ** self.β / self._sin
            F = np.where(np.abs(r) < 1.0, self._cot * self._weight(r), np.sign(r) * outside)
        return np.where(np.abs(r) == 1.0, np.nan, 2.0 * self._sin / np.pi * F)

    def σ_XX(self, r: ArrayLike) -> NDArray[np.float64]:
        """In-plane stress over N/(2a) on the whole surface Y = 0; NaN at |r| = 1 (Eq 32)."""
        κ, frame = self.frame.κ, self.frame
        own = (3.0 - κ) / (κ + 1.0) + 8.0 * frame.q / (κ + 1.0)
        return own * self.σ_YY(r) + 8.0 * frame.m / (κ + 1.0) * self.g * self.hilbert(r)

    def _weight(self, r: NDArray[np.float64]) -> NDArray[np.float64]:
        """(1 - r)^α (1 + r)^β, NaN outside (-1, 1)."""
        return (1.0 - r) ** self.α * (1.0 + r) ** self.β
