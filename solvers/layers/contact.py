"""The singular integral equation of a punch on a layered half-plane.

    (n̂/π) ⨍ σ(t)/(t - r) dt - g q σ(r) + ∫ K(r - t) σ(t) dt = μ v,X(r),   ∫ σ dr = -2,

σ = σ_YY, n̂ = n + g n₁₂ of the surface's solid, K of :mod:`galinx.solvers.layers.kernel`. The dominant part
is that of a half-plane, and so are the exponents. The pressure is a sum of Jacobi polynomials under their
weight; its integrals with K are done by Gauss's rule, or piece by piece where K is rough.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import eval_jacobi

from galinx.solvers.errors import SolveError
from galinx.solvers.layers.kernel import Kernel
from galinx.solvers.layers.pressure import Polynomial, Pressure, gauss
from galinx.solvers.sie.collocation import Expansion

#: Polynomials at first, by how much more next time, and at most.
FIRST, _MORE, MOST = 24, 1.5, 1400
#: Where pressures of two numbers of polynomials are compared.
_LOOKED_AT = np.cos(np.pi * (np.arange(25) + 0.5) / 25)
#: Panels towards a place where a kernel is rough: their grading, number, and points.
_GRADING, _STEPS = 0.25, 18
_POINTS = 12


@dataclass(frozen=True)
class Equation:
    """The equation at one speed and friction.

    Attributes:
        response: of the surface's solid.
        kernel: of the layers.
        g: σ_XY/σ_YY under the punch.
        slope: μ v,X under the punch over N/(2a) at given r.
    """

    response: Any
    kernel: Kernel
    g: float
    slope: Callable[[NDArray], NDArray]

    @property
    def _n(self) -> float:
        return float(self.response.n + self.g * self.response.n12)

    @cached_property
    def α(self) -> float:
        """Exponent at X = a: that of the surface's solid."""
        return float(-0.5 - np.arctan2(self.g * self.response.q, self._n) / np.pi)

    @property
    def β(self) -> float:
        """Exponent at X = -a."""
        return -1.0 - self.α

    def solved(self, terms: int) -> Expansion:
        """The pressure with so many polynomials."""
        t, w = gauss(terms, self.α, self.β)
        r, _ = gauss(terms - 1, -self.α, -self.β)
        P = eval_jacobi(np.arange(terms), self.α, self.β, t[:, None])
        A = np.empty((terms, terms))
        A[:-1] = self._n / np.pi * (w / (t - r[:, None])) @ P
        by_kernel = self.integrals(r, terms)
        A[:-1] += by_kernel[..., 3] + self.g * by_kernel[..., 2]
        A[-1] = w @ P
        return Expansion(self.α, self.β, np.linalg.solve(A, np.append(self.slope(r), -2.0)))

    def integrals(self, r: NDArray, terms: int) -> NDArray[np.float64]:
        """∫ K(r - t) of every polynomial under the weight, (len(r), terms, 4)."""
        if not self.kernel.rough:
            t, w = gauss(terms, self.α, self.β)
            weighted = w[:, None] * eval_jacobi(np.arange(terms), self.α, self.β, t[:, None])
            return np.einsum("rtf,tn->rnf", self.kernel(r[:, None] - t), weighted, optimize=True)
        found = np.empty((len(r), terms, 4))
        for i, place in enumerate(r.tolist()):
            d, w, t = points_around(place, self.α, self.β)
            weighted = w[:, None] * eval_jacobi(np.arange(terms), self.α, self.β, t[:, None])
            found[i] = weighted.T @ self.kernel(d)
        return found


def points_around(r: float, α: float, β: float) -> tuple[NDArray, NDArray, NDArray]:
    """Differences r - t, weights and t for integrals under the weight of what is rough at t = r."""
    steps = np.concatenate([[0.0], _GRADING ** np.arange(_STEPS, -1, -1.0)])
    x, w = np.polynomial.legendre.leggauss(_POINTS)
    parts = []
    for end, own, other in ((1.0, α, β), (-1.0, β, α)):
        # s: distance from r over that of the end, from which it is 1 - s.
        length = 1.0 - end * r
        if length <= 0.0:
            continue
        if length >= 2.0:  # all lies on this side
            length = 2.0 if abs(r) == 1.0 else length
        near, far = steps[:-1] / 2.0, steps[1:] / 2.0
        s = ((near + far)[:, None] / 2.0 + (far - near)[:, None] / 2.0 * x).ravel()
        ds = ((far - near)[:, None] / 2.0 * w).ravel()
        y, dy = gauss(2 * _POINTS, own, 0.0)  # the rest, up to the end
        u, du = (1.0 - y) / 4.0, dy * 4.0 ** (-1.0 - own) * 1.0
        own_distance = np.concatenate([1.0 - s, u]) * length
        d = np.concatenate([s, 1.0 - u]) * length
        weight = np.concatenate([ds * (1.0 - s) ** own, du]) * length ** (1.0 + own)
        parts.append((-end * d, weight * (2.0 - own_distance) ** other, end * (1.0 - own_distance)))
    d, weights, t = (np.concatenate(some) for some in zip(*parts))
    return d, weights, t


@dataclass(frozen=True)
class Found:
    """A pressure, and by how much it changed with the number of polynomials.

    Attributes:
        pressure: the pressure.
        change: of it and its intensities, relative.
    """

    pressure: Pressure
    change: float


def found(equation: Equation, tolerance: float, first: int = FIRST) -> Found:
    """The pressure to a tolerance.

    Raises:
        SolveError: it was not reached; the message says with how many polynomials.
    """
    terms = max(first, FIRST)
    before = equation.solved(max(int(terms / _MORE), 8))
    while True:
        now = equation.solved(terms)
        change = _change(before, now)
        if change <= tolerance / 4.0 or change <= 1e-14 * terms:
            return Found(Polynomial(now), change)
        if terms >= MOST:
            break
        before, terms = now, min(int(_MORE * terms), MOST)
    raise SolveError(
        f"with {terms} polynomials the pressure still changes by {change:.2g}, expected {tolerance:g}: "
        "the uppermost layer is very thin over the contact's width; take a larger tolerance"
    )


def _change(before: Expansion, now: Expansion) -> float:
    """Of intensities and pressure without its weight, over the larger one."""
    at = np.concatenate([[-1.0, 1.0], _LOOKED_AT])
    one, other = before.series(at), now.series(at)
    return float(np.abs(one - other).max() / np.abs(other).max())
