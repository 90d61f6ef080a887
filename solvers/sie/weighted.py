"""Pressures (1 - s)^α (1 + s)^β (A + B s) whose exponents' sum is whole: exact on and below the surface.

Cauchy's integral of such a pressure is elementary: with X(z) = (z - 1)^α (z + 1)^β and q = A + B s

    Φ(z) = (1/π) ∫ σ_YY(t)/(t - z) dt = (X(z) q(z) - [X q])/sin(πα),

[X q] the part of X q that does not vanish at infinity. It serves parabolic and tilted flat punches.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import log1p  # NumPy's loses digits for small complex arguments

from galinx.solvers.contact import from_edge, under_punch

#: |z| from which powers of 1/z serve, and how many of them: 3^-36 is no digit any more.
_FAR, _POWERS = 3.0, 36


@dataclass(frozen=True)
class Weighted:
    """σ_YY = (1 - s)^α (1 + s)^β (A + B s) over N/(2a); all broadcast against positions.

    Attributes:
        α, β: exponents at the right and the left end; their sum is ``order``.
        A, B: coefficients, dimensionless.
        order: -1, 0 or 1, the same for all states.
    """

    α: Any
    β: Any
    A: Any
    B: Any
    order: int

    def σ_YY(self, r: ArrayLike) -> NDArray[np.float64]:
        """Contact stress at r; 0 beside the contact, and NaN at an end where it is infinite."""
        r = np.asarray(r, dtype=float)
        with np.errstate(invalid="ignore", divide="ignore"):
            inside = (1.0 - r) ** self.α * (1.0 + r) ** self.β * (self.A + self.B * r)
        beside = np.where(from_edge(r) > 0.0, 0.0, np.nan)
        return np.where(under_punch(r), inside, beside)

    def hilbert(self, r: ArrayLike) -> NDArray[np.float64]:
        """(1/π) ⨍ σ_YY(t)/(t - r) dt on the whole surface off the ends."""
        r = np.asarray(r, dtype=float)
        with np.errstate(invalid="ignore", divide="ignore"):
            size = np.abs(1.0 - r) ** self.α * np.abs(1.0 + r) ** self.β * (self.A + self.B * r)
            sign = np.where(under_punch(r), np.cos(np.pi * self.α), 1.0)
            # Left of the contact both factors of X are negative: (-1)^(α + β).
            sign = np.where(r < -1.0, (-1.0) ** self.order, sign)
            near = (sign * size - self._polynomial(r)) / self._sin
        return np.where(np.abs(r) > _FAR, self._far(np.where(np.abs(r) > _FAR, r, np.inf)), near)

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        """Φ(z), see :class:`galinx.solvers.solids.solid.Potential`."""
        far = np.abs(z) > _FAR
        near = (self._X(z) * (self.A + self.B * z) - self._polynomial(z)) / self._sin
        return np.where(far, self._far(np.where(far, z, np.inf)), near)

    def change(self, z: NDArray, step: NDArray, share: complex) -> NDArray[np.complex128]:
        by_right, by_left = step / (z - 1.0), step / (z + 1.0)
        if share == 0.0:
            growth = self.α * by_right + self.β * by_left
        else:
            exponent = self.α * log1p(share * by_right) + self.β * log1p(share * by_left)
            growth = np.expm1(exponent) / share
        moved = z + share * step
        near = self._X(z) * (growth * (self.A + self.B * moved) + self.B * step)
        near = (near - self._leading * step) / self._sin
        far = np.minimum(np.abs(z), np.abs(moved)) > _FAR
        return np.where(far, self._far_change(np.where(far, z, np.inf), step, share), near)

    @property
    def _sin(self) -> Any:
        return np.sin(np.pi * self.α)

    def _X(self, z: NDArray) -> NDArray[np.complex128]:
        return np.exp(self.α * np.log(z - 1.0) + self.β * np.log(z + 1.0))

    @property
    def _leading(self) -> Any:
        """What [X q] has of the first power of z: of the orders 0 and -1 it is a constant."""
        return self.A if self.order == 1 else 0.0

    def _polynomial(self, z: Any) -> Any:
        """[X q]; B vanishes where the order is 0 or 1."""
        if self.order == 1:
            return self.A * (z + self.β - self.α)
        return self.A if self.order == 0 else self.B

    @cached_property
    def _powers(self) -> list[Any]:
        """Coefficients of z^-1, z^-2, … of Φ, from those of (1 - y)^α (1 + y)^β, y = 1/z."""
        lean, total = self.β - self.α, self.order
        e = [1.0 + 0.0 * lean, lean]
        for k in range(1, _POWERS + 2):
            e.append((lean * e[k] + (k - 1 - total) * e[k - 1]) / (k + 1))
        # X q = Σ e_k z^(order - k) (A + B z)
        return [
            (self.A * e[j + total] + self.B * e[j + total + 1]) / self._sin for j in range(1, _POWERS)
        ]

    def _far(self, z: NDArray) -> Any:
        y, found = 1.0 / z, 0.0
        for coefficient in reversed(self._powers):
            found = (found + coefficient) * y
        return found

    def _far_change(self, z: NDArray, step: NDArray, share: complex) -> Any:
        with np.errstate(invalid="ignore"):
            y, other = 1.0 / z, 1.0 / (z + share * step)
        value, divided = 0.0, 0.0  # of the sum so far at y, and its divided difference
        for coefficient in reversed(self._powers):
            value, divided = (value + coefficient) * y, (value + coefficient) + divided * other
        return -step * y * other * divided

    @property
    def K_I(self) -> NDArray[np.float64]:
        """Intensity at the left and the right end as in Eqs 56-57, 0 at one that is free: (..., 2)."""
        left = np.where(self.β < 0.0, 0.5 * (self.B - self.A) * 2.0 ** (self.α + self.β + 1.0), 0.0)
        right = np.where(self.α < 0.0, -0.5 * (self.A + self.B) * 2.0 ** (self.α + self.β + 1.0), 0.0)
        return np.stack(np.broadcast_arrays(left, right), axis=-1)
