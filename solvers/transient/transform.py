"""A flat punch on a half-plane by Laplace's transform in time: pressure and indentation at each s.

The pressure is (1 - X)^α (1 + X)^β Σ a_j P_j(X), with the exponents of steady motion at that friction;
the equation is tested with the weighted polynomials of the mirror image. Responses are integrated over
distances in panels that are short enough for the waves at each s: the shorter the steps in time, the
shorter the panels.
"""

from functools import cached_property
from math import ceil, exp, lgamma, log, pi

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from ..approximation import gauss, gauss_in_panels
from ..contact.edges import EdgeExponents
from ..contact.equation import jacobi
from ..solids.half_plane import HalfPlane
from .line_load import both_sides, interpolation

#: Step of the double exponential rule along the overlap of two shifted contacts, of so many polynomials.
_STEP, _FOR = 0.056, 24
#: Distances, times the square of the polynomials' number, for which these fit into a processor's cache.
_AT_ONCE = 40_000


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
        """Polynomials without the weight, orthonormal with it, (..., terms)."""
        return np.ascontiguousarray(jacobi(self.terms, self.α, self.β, X)) / self._norms

    def __call__(self, X: NDArray) -> NDArray[np.float64]:
        """Polynomials times their weight, |X| < 1, (n, terms)."""
        weight = (1.0 - X) ** self.α * (1.0 + X) ** self.β
        return np.asarray(weight[:, None] * self.polynomials(X))

    def rule(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Gauss's points and weights, with the weight in them."""
        return gauss(points, self.α, self.β)

    def tested(self, others: "Weighted") -> NDArray[np.float64]:
        """∫ w P_j P'_i dX of polynomials P_j with their weight w and others P'_i, (others, terms)."""
        X, w = self.rule(max(self.terms, others.terms))
        return np.asarray((w[:, None] * others.polynomials(X)).T @ self.polynomials(X))

    @property
    def integral(self) -> float:
        """Integral of the first polynomial with its weight; that of the others is 0."""
        return float(self._norms[0])


class Basis:
    """Polynomials of the pressure where σ_XY = g σ_YY, and those that the equation is tested with.

    Attributes:
        g: σ_XY/σ_YY.
        pressure: polynomials with the exponents of the pressure.
        tests: polynomials with the exponents of the mirror image.
    """

    def __init__(self, response: HalfPlane, g: float, terms: int) -> None:
        self.g = g
        α = float(EdgeExponents(response, g).α)
        self.pressure = Weighted(α, -1.0 - α, terms)
        self.tests = Weighted(-1.0 - α, α, terms)

    @cached_property
    def moments(self) -> NDArray[np.float64]:
        """Integrals of each polynomial with its weight, and of X times it, (terms, 2)."""
        X, w = self.pressure.rule(self.pressure.terms)
        P = self.pressure.polynomials(X)
        return np.array([w @ P, (w * X) @ P]).T

    @cached_property
    def ends(self) -> NDArray[np.float64]:
        """Polynomials at X = -1 and X = 1, (2, terms): -σ_YY/(N/a) over the weight."""
        return self.pressure.polynomials(np.array([-1.0, 1.0]))


def shared(x: NDArray, length: NDArray, tests: Weighted, trials: Weighted) -> NDArray[np.float64]:
    """∫ τ_i(X) σ_j(X - x) dX of tests τ and trials σ with their weights, at distances x > 0 and at -x.

    Args:
        x: distances, (x,).
        length: of the overlap, 2 - x, which rounding would spoil where it is short, (x,).
        tests, trials: weighted polynomials.

    Returns:
        (2, x, tests, trials).
    """
    terms = max(tests.terms, trials.terms)
    if len(x) > 1 and len(x) * terms**2 > _AT_ONCE:
        halves = np.array_split(x, 2), np.array_split(length, 2)
        return np.concatenate([shared(*half, tests, trials) for half in zip(*halves)], axis=1)
    steepest = min(tests.α, tests.β, trials.α, trials.β)
    d, e, weights = double_exponential(length, _STEP * _FOR / max(terms, _FOR), steepest)
    x = x[:, None]
    products = []
    for from_right, from_left, trial_from_right, trial_from_left in (
        (e, x + d, x + e, d), (x + e, d, e, x + d),
    ):  # fmt: skip
        of_test = weights * from_right**tests.α * from_left**tests.β
        of_trial = trial_from_right**trials.α * trial_from_left**trials.β
        τ = tests.polynomials((from_left - from_right) / 2.0)
        σ = trials.polynomials((trial_from_left - trial_from_right) / 2.0)
        product = (of_test * of_trial)[..., None] * τ
        products.append(product.swapaxes(1, 2) @ σ)
    return np.array(products)


def _norm(j: int, α: float, β: float) -> float:
    """Root of the weighted square of Jacobi's polynomial where α + β = -1."""
    if j == 0:
        return exp(0.5 * (lgamma(α + 1.0) + lgamma(β + 1.0)))
    square = lgamma(j + α + 1.0) + lgamma(j + β + 1.0) - lgamma(j + 1.0) - lgamma(j)
    return exp(0.5 * (square - log(2.0 * j)))


#: Logarithm of 1 over the rounding to which the double exponential rule nears the ends; and its
#: half-length at most, where distances are little above the smallest number.
_ROUNDING, _LONGEST = 36.0, 5.6


def double_exponential(length: NDArray, step: float, exponent: float) -> tuple[NDArray, NDArray, NDArray]:
    """Double exponential rule on intervals: distances from both ends and weights, (n, points) each.

    Args:
        length: of each interval, (n,).
        step: of the rule's variable.
        exponent: of the distance from an end in the steepest of the integrands, > -1. The steeper they
            are, the nearer to the ends the rule begins.
    """
    half = min(float(np.arcsinh(_ROUNDING / (pi * (1.0 + exponent)))), _LONGEST)
    u = step * np.arange(-ceil(half / step), ceil(half / step) + 1.0)
    grown = pi * np.sinh(u)
    d, e = 1.0 / (1.0 + np.exp(-grown)), 1.0 / (1.0 + np.exp(grown))
    weights = step * pi * np.cosh(u) * d * e
    return length[:, None] * d, length[:, None] * e, length[:, None] * weights


#: Radians of the shortest wave in a panel, and decay after which it is negligible.
_TURN, _GONE = 10.0, 20.0


def turning_rate(x: NDArray, s: NDArray, slowest: float) -> NDArray[np.float64]:
    """Radians per length over a by which waves turn at distances from a load, the most of all s, (x,).

    A wave e^(-sζx) turns by Im s ζ per length as long as Re s ζ x has not damped it.

    Args:
        x: distances over a, > 0, (x,).
        s: over c_s/a, Re s >= 0, (n,).
        slowest: slowness ζ of the slowest wave, seen from the load.
    """
    felt = _GONE / np.maximum(np.multiply.outer(x, s.real), 1e-300)
    return np.asarray((np.abs(s.imag) * np.minimum(slowest, felt)).max(axis=1))


def divided(edges: NDArray, s: NDArray, slowest: float) -> NDArray[np.float64]:
    """Edges of panels, divided where they are too long for the waves.

    Args:
        edges: distances over a, rising from 0.
        s, slowest: of the waves, see :func:`turning_rate`.
    """
    pieces = [edges[:1]]
    most = turning_rate(np.maximum(edges[:-1], edges[1]), s, slowest)
    for near, far, turn in zip(edges[:-1].tolist(), edges[1:].tolist(), most.tolist()):
        count = max(ceil((far - near) * turn / _TURN), 1)
        pieces.append(np.linspace(near, far, count + 1)[1:])
    return np.concatenate(pieces)


#: Octaves of panels towards the distance 0 of points under the punch, of which the last leaves out a
#: logarithm times its width, and Gauss's points of each.
_NEAR, _POINTS = 36, 8
#: Steepest exponent of 2 - x in the overlap towards the distance 2 that is integrated to rounding.
_STEEPEST = -0.8
#: Largest width of a panel, and polynomials from which on it is shorter.
_EVEN, _MANY = 0.125, 24
#: Points at which the response is sampled over the last ``_EVEN`` before distance 2; the overlap of tests
#: and pressures has more there.
_SAMPLES = 24


class Transformed:
    """A flat punch at one speed for given s, with any friction.

    Args:
        response: of steady motion at that speed, with the solid's stiffness and the exponents.
        rayleigh: speed of the wave along the surface over c_s.
        s: over c_s/a, Re s >= 0 but not 0, (n,).
        terms: polynomials of the pressure.
        panel: largest width of a panel of distances over a.
        way: ±1, in which the punch moves along X.
    """

    def __init__(
        self, response: HalfPlane, rayleigh: float, s: NDArray, terms: int, panel: float = _EVEN,
        way: int = 1,
    ) -> None:  # fmt: skip
        self._response, self.s, self._terms = response, s, terms
        self._kernels = both_sides(response, rayleigh, way)
        near = 2.0 ** -np.arange(_NEAR, -1, -1.0)
        width = min(panel, _EVEN, _EVEN * _MANY / terms)
        even = np.linspace(width, 2.0 - _EVEN, ceil((2.0 - _EVEN - width) / width) + 1)
        slowest = 1.0 / (rayleigh - response.c)
        edges = divided(np.concatenate([[0.0], near[near < width], even]), s, slowest)
        x, weights = gauss_in_panels(edges, _POINTS)
        self._panels = x.reshape(-1, _POINTS)
        # Towards the distance 2 the overlap is short and singular, the response smooth.
        length, _, last = (of[0] for of in double_exponential(np.array([_EVEN]), _STEP, _STEEPEST))
        # Distances of the response, (distances,), what is left of 2, and their weights.
        self._x, self._length = np.append(x, 2.0 - length), np.append(2.0 - x, length)
        self._weights = np.append(weights, last)

    def basis(self, g: float) -> Basis:
        """Polynomials of the pressure where σ_XY = g σ_YY."""
        return Basis(self._response, g, self._terms)

    def answers(self, basis: Basis, terms: tuple[int, ...] = ()) -> tuple[NDArray[np.complex128], ...]:
        """Pressure and indentation by a load N̂ for every s, by so many polynomials, or by all.

        Returns:
            Coefficients of σ_YY over N̂/(2a), then v̂₀ over N̂/(2μ), (n, count + 1), for each of ``terms``.
        """
        matrices, solutions = self.tested(basis, basis.tests), []
        for count in terms or (self._terms,):
            whole = np.zeros((len(self.s), count + 1, count + 1), dtype=complex)
            whole[:, :-1, :-1] = matrices[:, :count, :count]
            whole[:, 0, -1] = basis.tests.integral
            whole[:, -1, 0] = basis.pressure.integral
            load = np.zeros((len(self.s), count + 1, 1))
            load[:, -1] = -2.0
            solutions.append(np.asarray(np.linalg.solve(whole, load)[..., 0], dtype=complex))
        return tuple(solutions)

    def tested(self, basis: Basis, tests: Weighted, along_X: bool = False) -> NDArray[np.complex128]:
        """Tested v̂, or û, of each polynomial of the pressure for every s, (s, tests, terms).

        Args:
            basis: of the pressure.
            tests: weighted polynomials.
            along_X: True for û.
        """
        first = 2 * along_X  # row of the responses to σ_YY; the next one is that to σ_XY
        both = shared(self._x, self._length, tests, basis.pressure)
        flat = both.reshape(2, len(self._x), -1) * self._weights[:, None]
        ahead, behind = (values[:, first] + basis.g * values[:, first + 1] for values in self._values)
        return (ahead @ flat[0] + behind @ flat[1]).reshape(-1, tests.terms, self._terms)

    @cached_property
    def _values(self) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Responses ahead and behind at all distances for every s, (s, 4, distances) each."""
        t, _ = leggauss(_SAMPLES)
        before, middle, half = self._panels.size, 2.0 - _EVEN / 2.0, _EVEN / 2.0
        between = interpolation(_SAMPLES, (self._x[before:] - middle) / half)
        x, values = (self._panels, (middle + half * t)[None]), []
        for kernel in self._kernels:
            whole = np.empty((len(self.s), 4, len(self._x)), dtype=complex)
            for n, s in enumerate(self.s):
                sampled = kernel(x, s, False)
                whole[n][:, :before] = sampled[:, :before]
                whole[n][:, before:] = sampled[:, before:] @ between.T
            values.append(whole)
        return values[0], values[1]
