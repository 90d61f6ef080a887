"""Lagrange polynomials of an element's nodes."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BarycentricInterpolator


def lagrange(nodes: NDArray, t: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Values and derivatives at ``t`` of the polynomials that are 1 at one node, 0 at the others.

    Args:
        nodes: positions of the nodes, (p+1,).
        t: positions, (n,).

    Returns:
        Two arrays (n, p+1).
    """
    n = len(nodes)
    interpolator = BarycentricInterpolator(nodes, np.eye(n))
    values = interpolator(np.asarray(t, dtype=float))
    # Differentiate at the nodes, where it is exact, and interpolate the result.
    w = interpolator.wi
    D = (w[None, :] / w[:, None]) / (nodes[:, None] - nodes[None, :] + np.eye(n))
    np.fill_diagonal(D, 0.0)
    np.fill_diagonal(D, -D.sum(axis=1))
    return values, values @ D
