"""What the pressure under a flat punch is made of, and what it is tested with.

The pressure is (1 - X)^α (1 + X)^β Σ a_j P_j(X), its exponents those of steady motion at that friction,
tested with the same of the mirror image.
"""

from functools import cached_property
from math import exp, lgamma, log, pi

import numpy as np
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from galinx.solvers.solids.solid import Response

#: Steps, for so many polynomials, and half-length of the double exponential rule along what two shifted
#: contacts have in common.
_STEPS, _FOR, _LENGTH = 121, 24, 3.4


class Weighted:
    """Jacobi's polynomials with their weight (1 - X)^α (1 + X)^β, α + β = -1.

    Args:
        α, β: exponents at X = 1 and X = -1.
        terms: their number, > 1.
    """

    def __init__(self, α: float, β: float, terms: int) -> None:
        self.α, self.β, self.terms = α, β, terms
        self._norms = np.array([_norm(j, α, β) for j in range(terms)])

    def polynomials(self, X: NDArray) -> NDArray[np.float64]:
        """Without the weight, their weighted squares 1, (..., terms)."""
        return _jacobi(np.asarray(X, dtype=float), self.α, self.β, self.terms) / self._norms

    def __call__(self, X: NDArray) -> NDArray[np.float64]:
        """With the weight, |X| < 1, (n, terms)."""
        weight = (1.0 - X) ** self.α * (1.0 + X) ** self.β
        return np.asarray(weight[:, None] * self.polynomials(X))

    def rule(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Gauss's points and weights, with the weight in them."""
        with np.errstate(
            invalid="ignore", divide="ignore"
        ):  # SciPy divides 0 by 0 where α + β = -1, and replaces that
            X, w = roots_jacobi(points, self.α, self.β)
        return X, w

    def tested(self, others: "Weighted") -> NDArray[np.float64]:
        """∫ of each with its weight, times others without, (others, terms)."""
        X, w = self.rule(max(self.terms, others.terms))
        return np.asarray((w[:, None] * others.polynomials(X)).T @ self.polynomials(X))

    @property
    def integral(self) -> float:
        """∫ of the first with its weight; that of the others is 0."""
        return float(self._norms[0])


class Basis:
    """Of the pressure where σ_XY = g σ_YY.

    Attributes:
        g: friction.
        pressure: polynomials with the exponents of the pressure.
        tests: with those of the mirror image.
    """

    def __init__(self, response: Response, g: float, terms: int) -> None:
        self.g = g
        cot = g * response.q / (response.n + g * response.n12)
        α = -0.5 - float(np.arctan(cot)) / pi
        self.pressure = Weighted(α, -1.0 - α, terms)
        self.tests = Weighted(-1.0 - α, α, terms)

    @cached_property
    def moments(self) -> NDArray[np.float64]:
        """∫ and ∫ X of each polynomial with its weight, (terms, 2)."""
        X, w = self.pressure.rule(self.pressure.terms)
        P = self.pressure.polynomials(X)
        return np.array([w @ P, (w * X) @ P]).T

    @cached_property
    def ends(self) -> NDArray[np.float64]:
        """Polynomials at X = -1 and X = 1, (2, terms): -σ_YY/(N/a) over the weight."""
        return self.pressure.polynomials(np.array([-1.0, 1.0]))


def shared(x: NDArray, tests: Weighted, trials: Weighted) -> NDArray[np.float64]:
    """∫ τ_i(X) σ_j(X - x) dX of both with their weights, at distances x > 0, and at -x.

    Returns:
        (2, x, tests, trials).
    """
    terms = max(tests.terms, trials.terms)
    d, e, weights = _overlap(2.0 - x, _STEPS * max(terms, _FOR) // _FOR)
    x = x[:, None]
    found = []
    for right, left, other_right, other_left in (
        (e, x + d, x + e, d), (x + e, d, e, x + d),
    ):  # fmt: skip
        of_test = weights * right**tests.α * left**tests.β
        of_trial = other_right**trials.α * other_left**trials.β
        τ = tests.polynomials((left - right) / 2.0)
        σ = trials.polynomials((other_left - other_right) / 2.0)
        product = (of_test * of_trial)[..., None] * τ
        found.append(product.swapaxes(1, 2) @ σ)
    return np.array(found)


def _jacobi(X: NDArray, α: float, β: float, terms: int) -> NDArray[np.float64]:
    """Jacobi's polynomials by their recurrence, α + β = -1, (..., terms), terms > 1."""
    P = np.empty((*X.shape, terms))
    P[..., 0] = 1.0
    P[..., 1] = (α + 1.0) + (X - 1.0) / 2.0
    for j in range(2, terms):
        by_X = (2.0 * j - 2.0) * ((2.0 * j - 1.0) * (2.0 * j - 3.0) * X + (β - α))
        back = 2.0 * (j + α - 1.0) * (j + β - 1.0) * (2.0 * j - 1.0)
        P[..., j] = (by_X * P[..., j - 1] - back * P[..., j - 2]) / (
            2.0 * j * (j - 1.0) * (2.0 * j - 3.0)
        )
    return P


def _norm(j: int, α: float, β: float) -> float:
    """Root of the weighted square of Jacobi's polynomial where α + β = -1."""
    if j == 0:
        return exp(0.5 * (lgamma(α + 1.0) + lgamma(β + 1.0)))
    square = lgamma(j + α + 1.0) + lgamma(j + β + 1.0) - lgamma(j + 1.0) - lgamma(j)
    return exp(0.5 * (square - log(2.0 * j)))


def _overlap(length: NDArray, steps: int) -> tuple[NDArray, NDArray, NDArray]:
    """Double exponential rule on intervals: distances from both ends and weights, (n, steps) each."""
    u = np.linspace(-_LENGTH, _LENGTH, steps)
    grown = pi / 2.0 * np.sinh(u)
    d, e = 1.0 / (1.0 + np.exp(-2.0 * grown)), 1.0 / (1.0 + np.exp(2.0 * grown))
    weights = (u[1] - u[0]) * pi * np.cosh(u) * d * e
    return length[:, None] * d, length[:, None] * e, length[:, None] * weights
