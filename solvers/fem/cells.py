"""What one quadrilateral makes of its nodal values: places and derivatives.

A cell is the bilinear image of the unit square; its vertices come in dolfinx's order 00, 10, 01, 11.
"""

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.fem.lagrange import lagrange

#: Step of Newton's method, over the cell's size, after which the next would change no digit: convergence
#: is quadratic. In small cells beside X = -a rounding alone makes steps of 1e-12, so it is no smaller.
_SETTLED = 1e-8


def image(vertices: NDArray, t: NDArray) -> NDArray[np.float64]:
    """Points of the mesh's chart at places t (..., 2) of the unit square: (..., 2)."""
    a, b = t[..., 0], t[..., 1]
    return np.stack([(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b], axis=-1) @ vertices


def jacobian(vertices: NDArray, t: NDArray) -> NDArray[np.float64]:
    """∂x/∂t at places t (..., 2) as [..., component of x, component of t].

    ``vertices`` are of one cell, (4, 2), or of one at each place, (..., 4, 2).
    """
    a, b = t[..., :1], t[..., 1:]
    v00, v10, v01, v11 = (vertices[..., i, :] for i in range(4))
    by_a = (1 - b) * (v10 - v00) + b * (v11 - v01)
    by_b = (1 - a) * (v01 - v00) + a * (v11 - v10)
    return np.stack([by_a, by_b], axis=-1)


def pull_back(vertices: NDArray, x: NDArray) -> NDArray[np.float64]:
    """Places in the unit square of points x (n, 2) by cells (n, 4, 2): Newton's method for bilinear maps.

    NaN where that does not converge: the point is then far outside the cell.
    """
    t = np.full(x.shape, 0.5)
    moving = np.arange(len(x))
    for _ in range(25):
        if not len(moving):
            break
        at, corners = t[moving], vertices[moving]
        rest = x[moving] - image(corners, at[:, None])[:, 0]
        step = np.linalg.solve(jacobian(corners, at), rest[..., None])[..., 0]
        t[moving] = at + step
        size = np.maximum(1.0, np.abs(t[moving]).max(axis=1))
        moving = moving[~(np.abs(step).max(axis=1) < _SETTLED * size)]
    t[moving] = np.nan
    return t


def tensor_order(reference: NDArray) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Local nodes as a grid [i, j] along the two directions of the unit square, and their places."""
    n = round(np.sqrt(len(reference)))
    grid = np.lexsort(np.round(reference, 9).T[::-1]).reshape(n, n)
    return grid, reference[grid[:, 0], 0]


def reference_values(nodes: NDArray, t: NDArray, u: NDArray) -> NDArray[np.float64]:
    """Values at places t (n, 2) of nodal values u (p+1, p+1, ...): (n, ...)."""
    value_a, value_b = (lagrange(nodes, t[:, i])[0] for i in (0, 1))
    return np.einsum("ni,nj,ij...->n...", value_a, value_b, u, optimize=True)


def reference_gradients(nodes: NDArray, t: NDArray, u: NDArray) -> NDArray[np.float64]:
    """Derivatives along the unit square's directions, at places t, of nodal values u (p+1, p+1, ...).

    Returns:
        Array (n, 2, ...).
    """
    (value_a, slope_a), (value_b, slope_b) = (lagrange(nodes, t[:, i]) for i in (0, 1))
    n, rest = len(nodes), u.shape[2:]
    # Nodes along the second direction come last: the inner sum runs over what lies together.
    lines = np.moveaxis(u.reshape(n, n, -1), 1, 2).reshape(n, -1)
    along_a, along_b = (
        np.einsum("nfj,nj->nf", (a @ lines).reshape(len(t), -1, n), b)
        for a, b in ((slope_a, value_b), (value_a, slope_b))
    )
    return np.stack([along_a, along_b], axis=1).reshape(len(t), 2, *rest)


def gradients_in_plane(vertices: NDArray, nodes: NDArray, t: NDArray, u: NDArray) -> NDArray[np.float64]:
    """Derivatives along the axes of the mesh's chart, at places t (n, 2), of displacements u.

    Args:
        vertices: of the cell, (4, 2).
        nodes: places of its nodes along one direction, (p+1,).
        t: places in the unit square.
        u: nodal displacements, (p+1, p+1, 2, fields).

    Returns:
        Array (n, component, axis, fields).
    """
    inverse = np.linalg.inv(jacobian(vertices, t))
    return np.einsum("nrcf,nrx->ncxf", reference_gradients(nodes, t, u), inverse)
