"""Gauss's rule on a panel, and functions there by Legendre polynomials."""

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray


def legendre_panel(nodes: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Points in (-1, 1) and weights, (nodes,), and from values to coefficients, (nodes, nodes)."""
    τ, w = leggauss(nodes)
    return τ, w, (np.arange(nodes) + 0.5)[:, None] * legvander(τ, nodes - 1).T * w
