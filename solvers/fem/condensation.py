"""Static condensation: each cell's inner unknowns are eliminated before the matrix is assembled.

At degree p all but 4p of a cell's (p + 1)² nodes lie inside it and couple with nothing else. Eliminating
them cell by cell with dense algebra leaves a matrix with about a sixth of the entries at p = 8, and
the factorisation is what gains. Loads act on the boundary only, so nothing is lost, and inner
values are found again where someone asks for them.
"""

from dataclasses import dataclass
from typing import Any

import cffi
import numpy as np
from numpy.typing import NDArray

#: Cells treated at once; keeps the dense blocks within some ten megabytes.
CHUNK = 64


@dataclass(frozen=True)
class CellMatrices:
    """The compiled kernel of a bilinear form, ready to be called cell by cell.

    Attributes:
        form: dolfinx's compiled form with one cell integral and no coefficients.
        nodes: nodes of a cell.
        inner: which of them lie inside it.
    """

    form: Any
    nodes: int
    inner: NDArray[np.int32]

    @property
    def outer(self) -> NDArray[np.int64]:
        """Local nodes on a cell's boundary."""
        return np.setdiff1d(np.arange(self.nodes), self.inner)

    @property
    def outer_dofs(self) -> NDArray[np.int64]:
        """Local unknowns on a cell's boundary, two a node."""
        return _dofs(self.outer)

    @property
    def inner_dofs(self) -> NDArray[np.int64]:
        """Local unknowns inside a cell, two a node."""
        return _dofs(self.inner)

    def tabulate(self, constants: NDArray, corners: NDArray) -> NDArray[np.float64]:
        """Element matrices of cells with the given vertex coordinates (m, 4, 3): (m, 2n, 2n)."""
        ffi = cffi.FFI()
        kernel = _kernel(self.form.ufcx_form)
        size = 2 * self.nodes
        result = np.zeros((len(corners), size, size))
        corners = np.ascontiguousarray(corners)
        constants = np.ascontiguousarray(constants)

        def pointer(array: NDArray) -> Any:
            return ffi.cast("double *", array.ctypes.data)

        nothing = ffi.NULL
        for K, x in zip(result, corners):
            kernel(pointer(K), nothing, pointer(constants), pointer(x), nothing, nothing)
        return result

    def condense(
        self, constants: NDArray, corners: NDArray
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Condensed element matrices, and what gives the inner unknowns from the outer ones.

        Returns:
            S = K_bb - K_bi K_ii⁻¹ K_ib, (m, b, b), and E = -K_ii⁻¹ K_ib, (m, i, b).
        """
        order, b = np.concatenate([self.outer_dofs, self.inner_dofs]), len(self.outer_dofs)
        K = self.tabulate(constants, corners).take(order, axis=1).take(order, axis=2)
        E = -np.linalg.solve(K[:, b:, b:], K[:, b:, :b])
        return _free_of_translations(K[:, :b, :b] + K[:, :b, b:] @ E), E


def _free_of_translations(S: NDArray) -> NDArray[np.float64]:
    """S with the forces of rigid translations, which are rounding, taken out: P S P.

    Near the Rayleigh speed the body moves far before it deforms; those forces times that motion would
    be what limits the contact forces' digits.
    """
    m, b, _ = S.shape
    n = b // 2
    nodes = S.reshape(m, n, 2, n, 2)
    force = nodes.sum(axis=3, keepdims=True) / n  # on each node by a translation, (m, n, 2, 1, 2)
    total = force.sum(axis=1, keepdims=True) / n
    return (nodes - force - force.transpose(0, 3, 4, 1, 2) + total).reshape(m, b, b)


def _kernel(ufcx_form: Any) -> Any:
    """The compiled function of the form's one cell integral."""
    cell = 0  # ufcx_integral_type: cell integrals come first
    return ufcx_form.integrals(cell)[0].tabulate_tensor_float64


def _dofs(nodes: NDArray) -> NDArray[np.int64]:
    return (2 * np.asarray(nodes, dtype=np.int64)[:, None] + np.arange(2)).ravel()
