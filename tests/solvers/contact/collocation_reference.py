"""Expansion and collocation of the singular integral equation of a uniform half-plane (Eqs 38-41, 52-53).

    (n/π) ⨍ σ_YY(t)/(t - r) dt - q g σ_YY(r) = μ v,X(r),   ∫ σ_YY dr = -2.
"""

import numpy as np
from scipy.special import eval_jacobi, roots_jacobi


class Collocation:
    """Pressure (1 - r)^α (1 + r)^β Σ c_j P_j^(α,β)(r) under two sharp edges, and K_I at both."""

    def __init__(self, response, g, terms, slope=np.zeros_like):
        n = response.n + g * response.n12
        self.α = -0.5 - np.arctan2(g * response.q, n) / np.pi
        self.β = -1.0 - self.α
        t, w = roots_jacobi(terms, self.α, self.β)
        r, _ = roots_jacobi(terms - 1, -self.α, -self.β)
        P = eval_jacobi(np.arange(terms), self.α, self.β, t[:, None])
        A = np.vstack([n / np.pi * (w / (t - r[:, None])) @ P, w @ P])
        self.c = np.linalg.solve(A, np.append(slope(r), -2.0))

    def series(self, r):
        return eval_jacobi(np.arange(len(self.c)), self.α, self.β, np.asarray(r)[..., None]) @ self.c

    def σ_YY(self, r):
        return (1.0 - r) ** self.α * (1.0 + r) ** self.β * self.series(r)

    @property
    def K_I(self):
        return -0.5 * self.series(np.array([-1.0, 1.0]))
