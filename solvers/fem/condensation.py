"""Static condensation: each cell's inner unknowns are eliminated before the matrix is assembled.

At degree p all but 4p of a cell's (p + 1)² nodes lie inside it and couple with nothing else. Eliminating
them cell by cell with dense algebra leaves a matrix with about a sixth of the entries at p = 8, and
the factorisation is what gains. Loads act on the boundary only, so nothing is lost, and inner
values are found again where someone asks for them.
"""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dtrsm

from galinx.solvers.fem.chart import Contracted
from galinx.solvers.fem.element import Element

#: Numbers of the element matrices that are treated at once: some ten megabytes.
_NUMBERS = 2_000_000


class CellMatrices:
    """Element matrices, inner unknowns eliminated.

    Args:
        reference: places of a cell's nodes in the unit square, (nodes, 2), two unknowns each.
        inner: which of the nodes lie inside it.
        pressures: polynomials along each direction for a discontinuous pressure, whose unknowns follow
            those of the nodes; 0 or at least 2. Two unknowns stay: without its mean the pressure inside
            a cell is not determined.
    """

    def __init__(self, reference: NDArray, inner: NDArray[np.int32], pressures: int = 0) -> None:
        self.nodes, self.inner, self._pressures = len(reference), inner, pressures
        self._element = Element(reference, pressures)
        #: How many cells are to be treated at once.
        self.at_once = max(16, _NUMBERS // self._element.size**2)

    @cached_property
    def outer(self) -> NDArray[np.int64]:
        """Local nodes on a cell's boundary."""
        return np.setdiff1d(np.arange(self.nodes), self.inner)

    @cached_property
    def outer_dofs(self) -> NDArray[np.int64]:
        """Local unknowns that stay: two a node on the cell's boundary, and two pressures."""
        kept = 2 * self.nodes + np.arange(min(self._pressures, 2))
        return np.concatenate([_dofs(self.outer), kept])

    @cached_property
    def inner_dofs(self) -> NDArray[np.int64]:
        """Local unknowns that are eliminated."""
        first = 2 * self.nodes + min(self._pressures, 2)
        return np.concatenate([_dofs(self.inner), np.arange(first, self._element.size)])

    def heights(self, corners: NDArray) -> NDArray[np.float64]:
        """Heights of the points of quadrature in the chart, (m, points, points)."""
        return self._element.heights(corners)

    def condense(self, H: NDArray, chart: Contracted, corners: NDArray) -> NDArray[np.float64]:
        """Condensed element matrices S = K_bb - K_bi K_ii⁻¹ K_ib, (m, b, b).

        Args:
            H, chart, corners: of :meth:`.element.Element.matrices`.
        """
        K_bb, K_ib, K_ii = self._parts(H, chart, corners)
        if self._pressures:
            S = K_bb - K_ib.swapaxes(1, 2) @ np.linalg.solve(K_ii, K_ib)
        else:
            for L, half in zip(np.linalg.cholesky(K_ii), K_ib):
                half.T[:] = dtrsm(1.0, L.T, half.T, side=1, overwrite_b=True)  # L⁻¹ K_ib
            S = K_bb - K_ib.swapaxes(1, 2) @ K_ib
        return _free_of_translations(S, len(self.outer))

    def extend(self, H: NDArray, chart: Contracted, corners: NDArray) -> NDArray[Any]:
        """What gives the inner unknowns from the outer ones: E = -K_ii⁻¹ K_ib, (m, i, b)."""
        _, K_ib, K_ii = self._parts(H, chart, corners)
        return -np.linalg.solve(K_ii, K_ib)

    def _parts(self, H: NDArray, chart: Contracted, corners: NDArray) -> list[NDArray[np.float64]]:
        """K_bb, K_ib and K_ii."""
        b, i = self.outer_dofs, self.inner_dofs
        K_bb, K_ib, K_ii = self._element.matrices(H, chart, corners, [(b, b), (i, b), (i, i)])
        if self._pressures:
            # Over a cell's size: small cells' pressures weigh as much in the matrix as large ones'.
            unit = 1.0 / size_of_cells(corners)[:, None]
            of_b, of_i = (np.where(dofs < 2 * self.nodes, 1.0, unit) for dofs in (b, i))
            K_bb *= of_b[:, :, None] * of_b[:, None, :]
            K_ib *= of_i[:, :, None] * of_b[:, None, :]
            K_ii *= of_i[:, :, None] * of_i[:, None, :]
        return [K_bb, K_ib, K_ii]


def _free_of_translations(S: NDArray, nodes: int) -> NDArray[np.float64]:
    """S with the forces of rigid translations, which are rounding, taken out: P S P.

    Near the Rayleigh speed the body moves far before it deforms; those forces times that motion would
    be what limits the contact forces' digits.
    """
    T = np.zeros((S.shape[1], 2))
    T[: 2 * nodes : 2, 0] = T[1 : 2 * nodes : 2, 1] = 1.0
    force = S @ T / nodes
    outer = force @ T.T
    return S - outer - outer.transpose(0, 2, 1) + T @ (T.T @ force / nodes) @ T.T


def size_of_cells(corners: NDArray) -> NDArray[np.float64]:
    """Roots of the areas of cells with vertices (m, 4, 3), from their diagonals."""
    rising, falling = corners[:, 3, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 1, :2]
    return np.sqrt(np.abs(rising[:, 0] * falling[:, 1] - rising[:, 1] * falling[:, 0]) / 2.0)


def _dofs(nodes: NDArray) -> NDArray[np.int64]:
    return (2 * np.asarray(nodes, dtype=np.int64)[:, None] + np.arange(2)).ravel()
