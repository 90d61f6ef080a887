"""Contact pressure, edge exponents and stress intensity factors from consistent nodal forces.

Nodal forces tested with smooth functions give moments of the pressure that converge at twice the
rate of the displacement. So K_I and the smooth pressure are taken from Jacobi moments, whose weight
uses the exponents of the local edge analysis; the exponents reported for the finite elements are
fitted from the raw pressure, which uses none.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BarycentricInterpolator
from scipy.linalg import solveh_banded
from scipy.special import eval_jacobi, gammaln

#: Moments used. The pressure under a flat punch has one; further ones carry what the mesh, the
#: truncation or another profile adds, and the highest say how well they are resolved.
MOMENTS = 9


@dataclass(frozen=True)
class JacobiPressure:
    """σ_YY/(N/2a) = (1 - r)^α (1 + r)^β Σ b_n P_n^(α,β)(r).

    Attributes:
        α, β: exponents at X = a and X = -a.
        b: coefficients, dimensionless, (``MOMENTS``,).
    """

    α: float
    β: float
    b: NDArray[np.float64]

    def σ_YY(self, r: ArrayLike) -> NDArray[np.float64]:
        """Contact stress over N/(2a) at r = X/a; NaN outside (-1, 1)."""
        r = np.asarray(r, dtype=float)
        with np.errstate(invalid="ignore", divide="ignore"):
            weight = (1.0 - r) ** self.α * (1.0 + r) ** self.β
        return np.where(np.abs(r) < 1.0, weight * self._series(r), np.nan)

    @property
    def K_I(self) -> tuple[float, float]:
        """Stress intensity factors at X = -a and X = a, dimensionless, as in Eqs 56-57."""
        left, right = -0.5 * self._series(np.array([-1.0, 1.0]))
        return float(left), float(right)

    def _series(self, r: NDArray[np.float64]) -> NDArray[np.float64]:
        n = np.arange(len(self.b))
        return eval_jacobi(n, self.α, self.β, r[..., None]) @ self.b


def from_moments(X: NDArray, forces: NDArray, α: float, β: float) -> JacobiPressure:
    """Pressure whose Jacobi moments are those of the nodal forces.

    Args:
        X: positions of the contact nodes over a, (n,).
        forces: consistent nodal forces over N/2, (n,).
        α, β: exponents at X = a and X = -a, from the local analysis, α + β = -1.
    """
    n = np.arange(MOMENTS)
    moments = forces @ eval_jacobi(n, α, β, np.clip(X, -1.0, 1.0)[:, None])
    return JacobiPressure(α, β, moments / _jacobi_norms(n, α, β))


def _jacobi_norms(n: NDArray, α: float, β: float) -> NDArray[np.float64]:
    """∫ (1-r)^α (1+r)^β P_n² dr for α + β = -1: Γ(n+α+1) Γ(n+β+1)/(2n n! Γ(n)), π/sin for n = 0."""
    safe = np.maximum(n, 1)
    logs = gammaln(safe + α + 1.0) + gammaln(safe + β + 1.0) - gammaln(safe + 1.0) - gammaln(safe)
    return np.where(n == 0, np.pi / np.sin(np.pi * (1.0 + α)), np.exp(logs) / (2.0 * safe))


@dataclass(frozen=True)
class RawPressure:
    """Piecewise polynomial density, per surface coordinate s, that has the given nodal forces.

    Attributes:
        s: nodes of each facet, (F, p+1).
        density: σ_YY dX/ds there, over N/(2a), (F, p+1).
    """

    s: NDArray[np.float64]
    density: NDArray[np.float64]

    def σ_YY(self, r: NDArray, plane: Any) -> NDArray[np.float64]:
        """Contact stress over N/(2a) at r = X/a; NaN outside (-1, 1)."""
        s = plane.surface_coordinate(r)
        facet = np.clip(np.searchsorted(self.s[:, 0], s, side="right") - 1, 0, len(self.s) - 1)
        start, length = self.s[facet, 0], self.s[facet, -1] - self.s[facet, 0]
        values = np.einsum("ni,ni->n", self.basis((s - start) / length), self.density[facet])
        inside = np.abs(r) < 1.0
        return np.where(inside, values / np.where(inside, plane.surface_stretch(s), 1.0), np.nan)

    def basis(self, t: NDArray) -> NDArray[np.float64]:
        """Lagrange polynomials of a facet at t in [0, 1], (len(t), p+1)."""
        nodes = (self.s[0] - self.s[0, 0]) / (self.s[0, -1] - self.s[0, 0])
        return BarycentricInterpolator(nodes, np.eye(len(nodes)))(t)


def raw_pressure(s: NDArray, forces: NDArray, degree: int) -> RawPressure:
    """Solve the contact's mass matrix for the pressure; no exponent is assumed.

    Args:
        s: surface coordinates of the contact nodes in order, (F p + 1,).
        forces: their consistent nodal forces over N/2.
        degree: polynomial degree p.
    """
    facets = (len(s) - 1) // degree
    index = np.arange(facets)[:, None] * degree + np.arange(degree + 1)
    t, w = np.polynomial.legendre.leggauss(degree + 1)
    nodes = s[index[0]]
    reference = (nodes - nodes[0]) / (nodes[-1] - nodes[0])
    basis = BarycentricInterpolator(reference, np.eye(degree + 1))((t + 1.0) / 2.0)
    unit_mass = basis.T * (w / 2.0) @ basis
    banded = np.zeros((degree + 1, len(s)))
    for nodes in index:
        mass = unit_mass * (s[nodes[-1]] - s[nodes[0]])
        for k in range(degree + 1):
            banded[degree - k, nodes[k:]] += np.diagonal(mass, k)
    return RawPressure(s[index], solveh_banded(banded, forces)[index])


def fitted_exponent(d: NDArray, σ: NDArray) -> float:
    """Exponent of σ ~ d^α by least squares on the logarithms; NaN if the pressure changes sign."""
    if len(d) < 2 or not (np.all(σ < 0.0) or np.all(σ > 0.0)):
        return float("nan")
    return float(np.polyfit(np.log(d), np.log(np.abs(σ)), 1)[0])


def edge_exponents(raw: RawPressure, plane: Any, farthest: float = 1e-3) -> tuple[float, float]:
    """Exponents at X = a and X = -a fitted from the raw pressure next to the edges.

    Args:
        raw: pressure of the contact.
        plane: the mesh's plane, see :class:`solvers.fem.plane.Plane`.
        farthest: of the facets within this distance of the edge, over a, the outer half is used, two
            facets at least: the innermost cannot follow the singularity and disturb their
            neighbours, and beyond this distance the pressure's second term biases the exponent.
    """
    left, right = raw.s[0, 0], raw.s[-1, -1]
    # Gauss points, where a polynomial fits best what it cannot represent.
    t, _ = np.polynomial.legendre.leggauss(raw.s.shape[1] - 1)
    t = (t + 1.0) / 2.0
    length = (raw.s[:, -1] - raw.s[:, 0])[:, None]
    from_left = raw.s[:, :1] - left + length * t
    from_right = right - raw.s[:, -1:] + length * (1.0 - t)
    d_left, d_right, stretch = plane.under_punch(from_left, from_right)
    σ = raw.density @ raw.basis(t).T / stretch
    exponents = []
    for d, stress in ((d_right[::-1], σ[::-1]), (d_left, σ)):  # facets from the edge inwards
        last = max(int((d.max(axis=1) < farthest).sum()), 3)
        used = slice(min(last // 2, last - 2), last)
        exponents.append(fitted_exponent(d[used].ravel(), stress[used].ravel()))
    return exponents[0], exponents[1]
