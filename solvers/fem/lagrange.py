"""Lagrange polynomials of an element's nodes."""

import numpy as np
from numpy.polynomial.legendre import legder, legvander
from numpy.typing import ArrayLike, NDArray


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
    coefficients = np.linalg.inv(legvander(2.0 * np.asarray(nodes) - 1.0, p))
    return legvander(x, p) @ coefficients, 2.0 * legvander(x, p - 1) @ legder(coefficients)
