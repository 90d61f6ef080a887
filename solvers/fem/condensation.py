"""Static condensation: each cell's inner unknowns are eliminated before the matrix is assembled.

At degree p all but 4p of a cell's (p + 1)² nodes lie inside it and couple with nothing else. Eliminating
them cell by cell with dense algebra leaves a matrix with about a sixth of the entries at p = 8, and
the factorisation is what gains. Loads act on the boundary only, so nothing is lost, and inner
values are found again where someone asks for them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

#: Cells treated at once; keeps the dense blocks within some ten megabytes.
CHUNK = 64


@dataclass(frozen=True)
class CellMatrices:
    """The compiled kernel of a bilinear form, ready to be called cell by cell.

    Attributes:
        kernel: adds cells' matrices, from constants, of all or a row a cell, and vertices, to its first
            argument.
        nodes: nodes of a cell, two unknowns each.
        inner: which of them lie inside it.
        pressures: unknowns of a discontinuous pressure, which follow those of the nodes; 0 or at least 2.
            Two of them stay: without its mean the pressure inside a cell is not determined.
    """

    kernel: Callable[[NDArray, NDArray, NDArray], None]
    nodes: int
    inner: NDArray[np.int32]
    pressures: int = 0

    @cached_property
    def outer(self) -> NDArray[np.int64]:
        """Local nodes on a cell's boundary."""
        return np.setdiff1d(np.arange(self.nodes), self.inner)

    @cached_property
    def outer_dofs(self) -> NDArray[np.int64]:
        """Local unknowns that stay: two a node on the cell's boundary, and two pressures."""
        kept = 2 * self.nodes + np.arange(min(self.pressures, 2))
        return np.concatenate([_dofs(self.outer), kept])

    @cached_property
    def inner_dofs(self) -> NDArray[np.int64]:
        """Local unknowns that are eliminated."""
        return np.concatenate([_dofs(self.inner), 2 * self.nodes + np.arange(2, self.pressures)])

    def tabulate(self, constants: NDArray, corners: NDArray) -> NDArray[np.float64]:
        """Element matrices of cells with the given vertex coordinates (m, 4, 3): (m, 2n, 2n)."""
        size = 2 * self.nodes + self.pressures
        result = np.zeros((len(corners), size, size))
        corners = np.ascontiguousarray(corners)
        constants = np.ascontiguousarray(constants)
        self.kernel(result, constants, corners)
        return result

    def condense(self, constants: NDArray, corners: NDArray) -> tuple[NDArray, NDArray]:
        """Condensed element matrices, and what gives the inner unknowns from the outer ones.

        Returns:
            S = K_bb - K_bi K_ii⁻¹ K_ib, (m, b, b), and E = -K_ii⁻¹ K_ib, (m, i, b).
        """
        K = self.tabulate(constants, corners)
        if self.pressures:
            # The first of the two pressures that stay is the mean; the rest is orthogonal to it.
            n = self.pressures
            modes, _ = np.linalg.qr(np.column_stack([np.ones(n), np.eye(n)[:, 1:]]))
            # Over a cell's size: small cells' pressures weigh as much in the matrix as large ones'.
            scaled = modes / _size(corners)[:, None, None]
            K[:, -n:] = scaled.transpose(0, 2, 1) @ K[:, -n:]
            K[:, :, -n:] = K[:, :, -n:] @ scaled
        order, b = np.concatenate([self.outer_dofs, self.inner_dofs]), len(self.outer_dofs)
        K = K.take(order, axis=1).take(order, axis=2)
        E = -np.linalg.solve(K[:, b:, b:], K[:, b:, :b])
        S = K[:, :b, :b] + K[:, :b, b:] @ E
        return _free_of_translations(S, len(self.outer)), E


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


def _size(corners: NDArray) -> NDArray[np.float64]:
    """Roots of the areas of cells with vertices (m, 4, 3), to the order of magnitude."""
    along, across = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    return np.sqrt(np.abs(along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0]))


def _dofs(nodes: NDArray) -> NDArray[np.int64]:
    return (2 * np.asarray(nodes, dtype=np.int64)[:, None] + np.arange(2)).ravel()
