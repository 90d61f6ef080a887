"""Gauss's rule on a panel, and functions there by Legendre polynomials."""

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray


def legendre_panel(nodes: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Points in (-1, 1) and weights, (nodes,), and from values to coefficients, (nodes, nodes)."""
    τ, w = leggauss(nodes)
    return τ, w, (np.arange(nodes) + 0.5)[:, None] * legvander(τ, nodes - 1).T * w


def chebyshev_points(count: int) -> NDArray[np.float64]:
    """Points in [0, 1] at which a smooth function is tabulated, both ends among them from two on."""
    if count == 1:
        return np.zeros(1)
    return np.asarray((1.0 - np.cos(np.pi * np.arange(count) / (count - 1))) / 2.0)


def interpolation(s: NDArray, count: int) -> NDArray[np.float64]:
    """Values at s in [0, 1] by those at :func:`chebyshev_points`, (*s.shape, count)."""
    at_points, at_s = (chebvander(2.0 * x - 1.0, count - 1) for x in (chebyshev_points(count), s))
    return np.asarray(at_s @ np.linalg.inv(at_points))
