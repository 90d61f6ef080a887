"""Expansion-collocation solution of the singular integral equation (Eqs 38-41, 52-53).

    (n/π) ⨍ σ_YY(t)/(t - r) dt - q g σ_YY(r) = μ v,X(r),   ∫ σ_YY dr = -2,

lengths over a, stresses over N/(2a). The pressure is expanded in Jacobi polynomials under their weight,
the Cauchy integrals are done by Gauss's rule, and the equation is collocated at the zeros of the
conjugate polynomial, where the rule is exact. Unlike the closed form this takes any punch profile.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import eval_jacobi, roots_jacobi

from ..solids.solid import Response
from .edges import under_punch


def jacobi(count: int, α: float, β: float, r: NDArray) -> NDArray[np.float64]:
    """Jacobi polynomials P_0^(α,β), P_1^(α,β), … at r by the recurrence, (*r.shape, count)."""
    r, s = np.asarray(r, dtype=float), α + β
    P = np.empty((count, *r.shape))
    P[0] = 1.0
    if count > 1:
        P[1] = α + 1.0 + (s + 2.0) * (r - 1.0) / 2.0
    for n in range(1, count - 1):
        m = 2.0 * n + s
        now = (m + 1.0) * ((m + 2.0) * m * r + (α - β) * s) * P[n]
        before = 2.0 * (n + α) * (n + β) * (m + 2.0) * P[n - 1]
        P[n + 1] = (now - before) / (2.0 * (n + 1.0) * (n + s + 1.0) * m)
    return np.moveaxis(P, 0, -1)


@dataclass(frozen=True)
class Expansion:
    """σ_YY/(N/2a) = (1 - r)^α (1 + r)^β Σ c_j P_j^(α,β)(r); ``c`` is dimensionless, (terms,)."""

    α: float
    β: float
    c: NDArray[np.float64]

    def series(self, r: NDArray) -> NDArray[np.float64]:
        """Pressure without its weight, Σ c_j P_j(r)."""
        r = np.asarray(r, dtype=float)
        return jacobi(len(self.c), self.α, self.β, r) @ self.c

    def σ_YY(self, r: NDArray) -> NDArray[np.float64]:
        """Contact stress over N/(2a) at r in (-1, 1)."""
        return (1.0 - r) ** self.α * (1.0 + r) ** self.β * self.series(r)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """Stress intensity factors at X = -a and X = a, dimensionless, as in Eqs 56-57: (2,)."""
        return -0.5 * self.series(np.array([-1.0, 1.0]))

    def hilbert(self, r: NDArray) -> NDArray[np.float64]:
        """(1/π) ⨍ σ_YY(t)/(t - r) dt over N/(2a) on the surface, r off the edges.

        Far from the contact by Gauss's rule; near it and under it by the weight's own transform, and
        the rest is a polynomial.
        """
        r = np.asarray(r, dtype=float)
        t, w = _gauss(_FINE, self.α, self.β)
        p = self.series(t)
        far = np.abs(r) > _NEAR
        transform = np.empty_like(r)
        transform[far] = p / (t - r[far, None]) @ w
        near = r[~far]
        p_near = self.series(near)
        transform[~far] = np.pi * p_near * weights_hilbert(self.α, self.β, near)
        transform[~far] += (p - p_near[:, None]) / (t - near[:, None]) @ w
        return transform / np.pi


#: Points of the rule for transforms, and |r| from which it serves alone: its error falls there by 1.5 a
#: point. Nearer, polynomials have not yet grown.
_FINE, _NEAR = 96, 1.1


def _gauss(points: int, α: float, β: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    with np.errstate(invalid="ignore"):  # SciPy evaluates a branch it then discards
        t, w = roots_jacobi(points, α, β)
    return t, w


def weights_hilbert(α: float, β: float, r: NDArray) -> NDArray[np.float64]:
    """(1/π) ⨍ (1 - t)^α (1 + t)^β/(t - r) dt, α + β = -1."""
    size = np.abs(1.0 - r) ** α * np.abs(1.0 + r) ** β
    under = under_punch(r)
    return np.where(under, size / np.tan(np.pi * α), np.sign(r) * size / np.sin(np.pi * α))


def solve(
    response: Response,
    g: float,
    terms: int,
    slope: Callable[[NDArray], NDArray] = np.zeros_like,
) -> Expansion:
    """Coefficients of the contact pressure under a punch with two sharp edges.

    Args:
        response: of the half-plane at that speed.
        g: σ_XY/σ_YY under the punch, dimensionless.
        terms: number of Jacobi polynomials, at least 2.
        slope: μ v,X under the punch over N/(2a) at given r; 0 for a flat punch.

    Returns:
        The expansion; for a flat punch all but its first coefficient vanish.
    """
    n = response.n + g * response.n12
    # The exponents solve cot(πα) = g q/n: the dominant part's index is 1, both ends singular.
    α = -0.5 - np.arctan2(g * response.q, n) / np.pi
    β = -1.0 - α
    t, w = _gauss(terms, α, β)
    r, _ = _gauss(terms - 1, -α, -β)
    P = eval_jacobi(np.arange(terms), α, β, t[:, None])
    A = np.empty((terms, terms))
    A[:-1] = n / np.pi * (w / (t[None, :] - r[:, None])) @ P
    A[-1] = w @ P
    b = np.append(slope(r), -2.0)
    return Expansion(float(α), float(β), np.linalg.solve(A, b))
