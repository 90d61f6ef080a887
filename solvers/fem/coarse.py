"""Damping of waves that cells are too large for.

Where cells grow outwards, a wave that comes among cells which cannot hold it would be thrown back by
them. So it is damped there: of the velocity seen from the punch, the higher Legendre polynomials of each
cell lose energy (spectral viscosity: Maday, Ould Kaber & Tadmor, SIAM J. Numer. Anal. 30, 321, 1993)::

    w·D w = Σ_cells rate Σ_ij (d_i + d_j) w_ij²,      d_j = exp(-((p - j)/(j - m))²) for j > m

What a cell holds well is left alone, and steady motion altogether. Near the punch nothing is damped,
but where it turns round: waves that begin at the edges then, suddenly, are sharp, and no cell holds them.
"""

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from galinx.solvers.fem import cells
from galinx.solvers.fem.lagrange import lagrange
from galinx.solvers.fem.space import Space

#: Rate at which the highest polynomial is damped, over c_s and the cell's shorter side; the share of
#: polynomials that are not.
_RATE, _KEPT = 5.0, 0.6
#: The same of all cells where the punch turns round.
_SHARP_RATE, _SHARP_KEPT = 20.0, 0.4
#: Distance from the punch, over a, at which it begins.
_FROM = 1.0


def damping(space: Space, sharp: bool = False) -> NDArray[np.float64]:
    """The form D of each cell and scalar fields, (cells, nodes, nodes).

    Args:
        space: of the fields.
        sharp: are there waves that no cell holds?
    """
    grid, nodes = cells.tensor_order(space.reference_nodes)
    p = len(nodes) - 1
    points, weights = leggauss(p + 2)
    values, _ = lagrange(nodes, (points + 1.0) / 2.0)
    orders = np.arange(p + 1)
    normed = legvander(points, p) * np.sqrt(2.0 * orders + 1.0)
    along = normed.T @ (weights[:, None] / 2.0 * values)
    place = np.argsort(grid.ravel())
    both = np.einsum("ia,jb->ijab", along, along).reshape(len(place), len(place))[:, place]
    d = _damped(orders, _SHARP_KEPT if sharp else _KEPT)
    of_unit = both.T @ (np.add.outer(d, d).reshape(-1, 1) * both)
    return of_unit * _weights(space.vertices[:, :, :2], sharp)[:, None, None]


def _damped(orders: NDArray, kept: float) -> NDArray[np.float64]:
    p = int(orders[-1])
    m = round(kept * p)
    high = np.maximum(orders - m, 1e-9)
    return np.asarray(np.exp(-(((p - orders) / high) ** 2)), dtype=np.float64)


def _weights(corners: NDArray, sharp: bool) -> NDArray[np.float64]:
    """Area times rate of each cell."""
    middle = corners.mean(axis=1)
    J = cells.jacobian(corners, np.full((len(corners), 2), 0.5))
    shorter = np.linalg.norm(J, axis=1).min(axis=1)
    far = np.maximum(np.abs(middle[:, 0]) - 1.0, -middle[:, 1]) > _FROM
    rates = _SHARP_RATE if sharp else np.where(far, _RATE, 0.0)
    return np.asarray(np.abs(np.linalg.det(J)) * rates / shorter)
