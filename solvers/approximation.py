"""Approximation of functions of one variable: Legendre and Chebyshev polynomials, rational functions.

On a panel a function is a sum of Legendre polynomials, by Gauss's rule; on [0, 1] it is a polynomial
through its values at Chebyshev's points.

Rational functions are in the barycentric form r(z) = Σ_k b_k(z) f_k, b_k(z) = (w_k/(z - z_k)) / Σ_j
w_j/(z - z_j), which passes through the values f_k at the nodes z_k whatever the weights w_k are. Here one
set of weights serves many functions: their denominator is that of the set-valued AAA algorithm
(Nakatsukasa, Sète & Trefethen, SIAM J. Sci. Comput. 40, 2018; Lietaert, Meerbergen, Pérez & Vandereycken,
IMA J. Numer. Anal. 42, 2022).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.legendre import legder, leggauss, legvander
from numpy.typing import ArrayLike, NDArray


@lru_cache
def legendre_panel(nodes: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Gauss's points in (-1, 1) and weights, (nodes,) each, and a matrix (nodes, nodes).

    The matrix takes values at the points to coefficients of Legendre polynomials.
    """
    τ, w = leggauss(nodes)
    return τ, w, (np.arange(nodes) + 0.5)[:, None] * legvander(τ, nodes - 1).T * w


def gauss(points: int, α: float, β: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points and weights of Gauss's rule for the weight (1 - t)^α (1 + t)^β, (points,) each."""
    from scipy.special import roots_jacobi  # a slow import

    with np.errstate(invalid="ignore", divide="ignore"):  # SciPy evaluates a branch it then discards
        t, w = roots_jacobi(points, α, β)
    return t, w


def gauss_in_panels(edges: NDArray, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gauss's points in panels between edges, panel by panel, and weights, (panels·points,) each."""
    t, w, _ = legendre_panel(points)
    half = np.diff(edges)[:, None] / 2.0
    return (edges[:-1, None] + half * (1.0 + t)).ravel(), (half * w).ravel()


def lagrange(nodes: NDArray, t: ArrayLike) -> tuple[NDArray, NDArray]:
    """Values and derivatives at ``t`` of the polynomials that are 1 at one node, 0 at the others.

    They are expanded in Legendre polynomials, which is well conditioned for nodes that crowd at the ends;
    SciPy's barycentric interpolation takes the nodes in random order, so no two runs would agree in
    their last digits.

    Args:
        nodes: positions of the nodes in [0, 1], (p+1,), p >= 1.
        t: positions, (n,).

    Returns:
        Two arrays (n, p+1).
    """
    p, x = len(nodes) - 1, 2.0 * np.asarray(t, dtype=float) - 1.0
    coefficients = _in_legendre(tuple(np.asarray(nodes).tolist()))
    return legvander(x, p) @ coefficients, 2.0 * legvander(x, p - 1) @ legder(coefficients)


@lru_cache
def _in_legendre(nodes: tuple[float, ...]) -> NDArray[np.float64]:
    """Legendre coefficients of the polynomials of :func:`lagrange`, (p+1, p+1)."""
    return np.asarray(np.linalg.inv(legvander(2.0 * np.array(nodes) - 1.0, len(nodes) - 1)), np.float64)


def chebyshev_points(count: int) -> NDArray[np.float64]:
    """Chebyshev's points in [0, 1], with both ends from two points on, (count,)."""
    if count == 1:
        return np.zeros(1)
    return np.asarray((1.0 - np.cos(np.pi * np.arange(count) / (count - 1))) / 2.0)


def interpolation(s: NDArray, count: int) -> NDArray[np.float64]:
    """Matrix from values at :func:`chebyshev_points` to values at s in [0, 1], (*s.shape, count)."""
    at_points, at_s = (chebvander(2.0 * x - 1.0, count - 1) for x in (chebyshev_points(count), s))
    return np.asarray(at_s @ np.linalg.inv(at_points))


def barycentric(nodes: NDArray, weights: NDArray, z: NDArray) -> NDArray[np.float64]:
    """Matrix from values at nodes to values at z, (len(z), nodes); its rows sum to 1.

    Args:
        nodes: all different, (nodes,).
        weights: of the barycentric form, (nodes,).
        z: points of evaluation, (n,).
    """
    step = z[:, None] - nodes
    met = step == 0.0
    b = np.where(met.any(axis=1)[:, None], 1.0 * met, weights / np.where(met, 1.0, step))
    return np.asarray(b / b.sum(axis=1)[:, None])


@dataclass(frozen=True)
class Barycentric:
    """A rational function through values of many functions at nodes, in the barycentric form.

    Attributes:
        nodes: all different, (nodes,).
        weights: of the form, (nodes,).
    """

    nodes: NDArray[np.float64]
    weights: NDArray[np.float64]

    def shares(self, z: NDArray) -> NDArray[np.float64]:
        """Matrix from values at the nodes to values at z, (len(z), nodes)."""
        return barycentric(self.nodes, self.weights, z)


def polynomial_through(nodes: NDArray) -> Barycentric:
    """Polynomial through values at any nodes, all different, (nodes,)."""
    step = nodes[:, None] - nodes + np.eye(len(nodes))
    logs = np.log(np.abs(step)).sum(axis=1)
    return Barycentric(nodes, np.prod(np.sign(step), axis=1) * np.exp(logs.min() - logs))


def chebyshev_nodes(count: int, low: float, high: float) -> NDArray[np.float64]:
    """Chebyshev's nodes between low and high, rising, (count,)."""
    angle = np.pi * (2.0 * np.arange(count) + 1.0) / (2.0 * count)
    return np.asarray((low + high) / 2.0 - (high - low) / 2.0 * np.cos(angle))


def fit_rational(z: NDArray, values: NDArray, noise: float = 0.0) -> Barycentric:
    """Rational function through samples, with the denominator of the AAA algorithm.

    The algorithm takes the sample with the largest error as its next node until it comes near all
    others; if it had to follow their last digits, or no more than one other sample, it would put poles
    anywhere. The numerator is the polynomial that interpolates all samples.

    Args:
        z: of the samples, all different, (K,), K >= 2.
        values: of the functions there, (K, functions).
        noise: root of the sum of squares of the rounding errors of a sample.
    """
    count = len(z)
    # A rotation of the functions among themselves changes no norm, and leaves at most K of them.
    values = rotated(values)
    fit, nodes = np.tile(values.mean(axis=0), (count, 1)), np.zeros(0, dtype=np.int64)
    weights, rest = np.zeros(0), np.arange(count)
    for _ in range(max(count - _OTHERS, 1)):
        error = np.linalg.norm(values - fit, axis=1)
        error[nodes] = -1.0
        if error.max() <= noise and len(nodes):
            break
        nodes = np.append(nodes, error.argmax())
        rest = np.setdiff1d(np.arange(count), nodes)
        loewner = (values[rest][:, None] - values[nodes]) / (z[rest][:, None] - z[nodes])[..., None]
        rows = loewner.transpose(0, 2, 1).reshape(-1, len(nodes))
        weights = np.linalg.svd(rows)[2][-1]
        fit = barycentric(z[nodes], weights, z) @ values[nodes]
    return Barycentric(z, _through_all(z, nodes, weights, rest))


def rotated(values: NDArray) -> NDArray[np.float64]:
    """Rotated values of functions, (K, at most K): the rotation changes no norm over the functions.

    Args:
        values: (K, functions).
    """
    return np.asarray(np.linalg.qr(values.T, mode="r")).T


def _through_all(z: NDArray, nodes: NDArray, weights: NDArray, rest: NDArray) -> NDArray[np.float64]:
    """Weights of the form with the same denominator and a node at every sample."""
    size = np.ptp(z) / 4.0
    all_weights = np.zeros(len(z))
    all_weights[nodes] = weights / np.prod((z[nodes][:, None] - z[rest]) / size, axis=1)
    denominator = (size / (z[rest][:, None] - z[nodes])) @ weights
    others = (z[rest][:, None] - z[rest]) / size + np.eye(len(rest))
    all_weights[rest] = denominator / np.prod(others, axis=1)
    return all_weights


#: Samples that are no nodes of the AAA algorithm, at least: they determine the denominator.
_OTHERS = 2

#: Distance over that of the ends within which points count as equal.
_EQUAL = 1e-10


def leja(z: NDArray, chosen: Sequence[int]) -> int | None:
    """Number of the next Leja point: where the polynomial with zeros at the chosen points is largest.

    None where the polynomial vanishes at all points.

    Args:
        z: points; two that are equal to ten digits count as one, (n,).
        chosen: numbers of the points that are chosen already.
    """
    steps = np.abs(z[:, None] - z[list(chosen)]) / (np.ptp(z) or 1.0)
    with np.errstate(divide="ignore"):
        logs = np.log(np.where(steps > _EQUAL, steps, 0.0)).sum(axis=1)
    return int(logs.argmax()) if logs.max() > -np.inf else None


#: Steps of Newton's method, and halvings of an interval, that are always enough; step after which
#: Newton's next is no digit.
_STEPS, _LAST = 60, 1e-10


def inverted(
    function: Callable[[NDArray], tuple[NDArray, NDArray]], values: NDArray, start: NDArray,
    low: Any = 0.0, high: Any = np.inf,
) -> NDArray[np.float64]:  # fmt: skip
    """Arguments at which a growing function has given values, by Newton's method, (n,).

    Args:
        function: gives its values and slopes at arguments, (n,) each.
        values: of the function, (n,).
        start: arguments to begin with, (n,).
        low, high: bounds of the arguments, of all or of each.
    """
    x = start
    for _ in range(_STEPS):
        now, slope = function(x)
        step = (values - now) / slope
        x = np.clip(x + step, low, high)
        if np.all(np.abs(step) <= _LAST):
            break
    return x


def bisected(
    holds: Callable[[float], bool], high: float, low: float = 0.0, accuracy: float = 0.0
) -> float:
    """Highest number up to which a condition holds, from ``low``, where it does, up to ``high``.

    Args:
        holds: the condition.
        high, low: ends of the interval.
        accuracy: relative; 0 for the last digit.
    """
    if holds(high):
        return high
    for _ in range(_STEPS):
        middle = (low + high) / 2.0
        if high - low <= accuracy * high or not low < middle < high:
            break
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low
