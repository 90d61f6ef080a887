"""Element matrices of quadrilaterals by tensor products, and static condensation of inner unknowns.

A basis function is a product of one polynomial along each direction, and so are points and weights of the
quadrature. The sum over all points is then one over a direction and one over the other, each a product of
dense matrices: at degree 10 about seven times faster than a loop over points and pairs of functions.

At degree p all but 4p of a cell's (p + 1)² nodes lie inside it and couple with nothing else. Eliminating
them cell by cell with dense algebra, before the matrix is assembled, leaves a matrix with about a sixth
of the entries at p = 8, and the factorisation gains most. Loads act on the boundary only, so nothing is
lost, and inner values are recovered where they are needed.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.polynomial.legendre import legvander
from numpy.typing import NDArray
from scipy.linalg.blas import dtrsm
from scipy.special import roots_legendre

from ..approximation import lagrange
from . import cells
from .cells import Contracted

#: Products of functions that are computed at once, so that they stay in the processor's cache.
_PRODUCTS = 700_000
#: Numbers of the element matrices that are treated at once: some ten megabytes.
_NUMBERS = 2_000_000

#: Factors of functions: values (points, functions) along the first direction, and along the second.
_Factors = tuple[NDArray, NDArray]


class Element:
    """Displacements of one degree, and pressures if there are any, on a cell.

    Args:
        reference: places of the nodes in the unit square, (nodes, 2).
        inner: numbers of the nodes inside the cell, whose unknowns are eliminated.
        pressures: polynomials along each direction for an unknown discontinuous pressure, orthonormal on
            the unit square; the first of their products is constant. 0 or at least 2: two unknowns stay,
            as without its mean the pressure inside a cell is not determined.

    Attributes:
        size: unknowns of a cell: two of each node, then the pressures.
        nodes: number of nodes.
        at_once: number of cells that are treated at once.
    """

    def __init__(self, reference: NDArray, inner: NDArray[np.int32], pressures: int = 0) -> None:
        grid, nodes = cells.tensor_order(reference)
        # The integrand is not polynomial in a conformal chart; so many points, exact to two degrees above
        # the product of gradients, integrate it as well as the space can tell.
        points, weights = roots_legendre(len(nodes) + 1)
        self._points, weights = (points + 1.0) / 2.0, weights / 2.0
        self._weights = np.outer(weights, weights)
        value, slope = lagrange(nodes, self._points)
        gradient = [(slope, value), (value, slope)]
        self.nodes, self.inner = len(reference), np.asarray(inner, dtype=int)
        self.size = 2 * len(reference) + pressures**2
        self.at_once = max(16, _NUMBERS // self.size**2)
        self._pressures, self._side = pressures, len(nodes)
        self._blocks = [_Block(3, gradient, gradient)]
        if pressures:
            orders = np.arange(pressures)
            legendre = legvander(points, pressures - 1) * np.sqrt(2.0 * orders + 1.0)
            scalar = [(legendre, legendre)]
            self._blocks += [_Block(2, gradient, scalar), _Block(1, scalar, scalar)]
        self._index = self._places(grid)

    def matrices(
        self, H: NDArray, chart: Contracted, corners: NDArray, parts: Sequence[tuple[NDArray, NDArray]]
    ) -> list[NDArray[np.float64]]:
        """Blocks of the element matrices of cells.

        Args:
            H: the form at unit gradients and pressure, symmetric, see :meth:`.forms.Form.densities`; one
                for all cells, (4, 4) or (5, 5); one for each, (m, 4, 4); or one for each of their points
                of quadrature, (m, 4, 4, second, first).
            chart: of the mesh, at a speed.
            corners: vertices, (m, 4, 3).
            parts: rows and columns of each block to be computed.

        Returns:
            Array (m, rows, columns) for each of ``parts``.
        """
        indices = [self._index[np.ix_(*part)] for part in parts]
        blocks = [np.empty((len(corners), *index.shape)) for index in indices]
        step = max(4, _PRODUCTS // sum(block.size for block in self._blocks))
        for start in range(0, len(corners), step):
            batch = slice(start, start + step)
            products = self._products(H if H.ndim == 2 else H[batch], chart, corners[batch, :, :2])
            for index, block in zip(indices, blocks):
                np.take(products, index, axis=1, out=block[batch], mode="clip")
        return blocks

    def heights(self, corners: NDArray) -> NDArray[np.float64]:
        """Second coordinates of the points of quadrature, (m, second, first).

        Args:
            corners: vertices, (m, 4, 3).
        """
        return cells.image(corners[:, None, :, :2], self._places_of_points())[..., 1]

    def _places_of_points(self) -> NDArray[np.float64]:
        """Points of quadrature in the unit square, (second, first, 2)."""
        return np.stack(np.meshgrid(self._points, self._points), axis=-1)

    def _products(self, H: NDArray, chart: Contracted, corners: NDArray) -> NDArray[np.float64]:
        """All products of functions along the first direction with those along the second, (m, …)."""
        T, weights = self._gradients(chart, corners)
        m, Q = len(corners), len(self._points)
        two_gradients = np.einsum("maAyx,mbByx->mABabyx", T, T * weights[:, None, None])
        # One form for all cells or one for each: points last, a single one where the form is constant.
        H = H.reshape(-1, *H.shape[-2:], 1, 1) if H.ndim < 5 else H
        rows = np.stack([H[:, :2, :2], H[:, :2, 2:4], H[:, 2:4, 2:4]], axis=1)
        densities = [_contracted(rows, 4, two_gradients.reshape(m, 4, -1, Q, Q))]
        if self._pressures:
            by_gradient = np.einsum("maAyx,myx->mAayx", T, weights)
            densities.append(_contracted(H[:, :4, 4], 2, by_gradient))
            densities.append(_contracted(H[:, 4:, 4:], 1, weights[:, None, None]))
        result = np.empty((m, sum(block.size for block in self._blocks)))
        start = 0
        for block, density in zip(self._blocks, densities):
            block.fill(
                result[:, start : start + block.size], density.reshape(*density.shape[:2], -1, Q, Q)
            )
            start += block.size
        return result

    def _gradients(self, chart: Contracted, corners: NDArray) -> tuple[NDArray, NDArray]:
        """Factors from slopes along a cell's directions to the form's gradients, and weights of points.

        Returns:
            Array [cell, direction, axis, second, first], array [cell, second, first].
        """
        t = self._places_of_points()
        J = cells.jacobian(corners[:, None, None], t)
        determinant = J[..., 0, 0] * J[..., 1, 1] - J[..., 0, 1] * J[..., 1, 0]
        inverse = np.empty_like(J)
        inverse[..., 0, 0], inverse[..., 1, 1] = J[..., 1, 1], J[..., 0, 0]
        inverse[..., 0, 1], inverse[..., 1, 0] = -J[..., 0, 1], -J[..., 1, 0]
        x = cells.image(corners[:, None], t)
        axes = chart.axes(x.reshape(-1, 2)).reshape(*x.shape, 2) / np.sqrt(chart.p.imag)
        T = np.einsum("myxac,myxcA->maAyx", inverse / determinant[..., None, None], axes)
        return T, self._weights * np.abs(determinant)

    def _places(self, grid: NDArray) -> NDArray[np.int64]:
        """Places of the entries of an element matrix among the products, (size, size)."""
        n, k = self._side, self._pressures
        # Of each unknown: its component, 2 for a pressure, and its function along both directions.
        of_nodes = np.divmod(np.argsort(grid.ravel()), n)
        of_pressures = np.divmod(np.arange(k * k), max(k, 1))
        component = np.concatenate([np.arange(2 * n * n) % 2, np.full(k * k, 2)])
        along = np.concatenate([np.repeat(of_nodes, 2, axis=1), of_pressures], axis=1)
        row, column = np.indices((self.size, self.size))
        # The form is symmetric: both entries of a pair are one number, that whose component comes first.
        rank = component * self.size + np.arange(self.size)
        swapped = rank[row] > rank[column]
        row, column = np.where(swapped, column, row), np.where(swapped, row, column)
        c, d = component[row], component[column]
        block = np.where(d < 2, 0, np.where(c < 2, 1, 2))
        within = np.where(d < 2, c + d, np.where(c < 2, c, 0))
        lefts, rights = np.where(c < 2, n, k), np.where(d < 2, n, k)
        first, second = along[:, row] * rights + along[:, column]
        starts = np.cumsum([0] + [block.size for block in self._blocks])
        return starts[block] + (within * lefts * rights + first) * lefts * rights + second

    @cached_property
    def outer(self) -> NDArray[np.int64]:
        """Local nodes on a cell's boundary."""
        return np.setdiff1d(np.arange(self.nodes), self.inner)

    @cached_property
    def _split(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Local unknowns that stay, two of each outer node and two pressures, and the others."""
        pressures = np.arange(2 * self.nodes, self.size)
        outer, inner = np.split(pressures, [2])
        return np.concatenate([_dofs(self.outer), outer]), np.concatenate([_dofs(self.inner), inner])

    def condense(self, H: NDArray, chart: Contracted, corners: NDArray) -> NDArray[np.float64]:
        """Condensed element matrices S = K_bb - K_bi K_ii⁻¹ K_ib, (m, b, b).

        Args:
            H, chart, corners: see :meth:`matrices`.
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
        """Extensions E = -K_ii⁻¹ K_ib, which give inner unknowns from outer ones, (m, i, b)."""
        _, K_ib, K_ii = self._parts(H, chart, corners)
        return -np.linalg.solve(K_ii, K_ib)

    def _parts(self, H: NDArray, chart: Contracted, corners: NDArray) -> list[NDArray[np.float64]]:
        """Blocks K_bb, K_ib and K_ii of the element matrices, b outer and i inner unknowns."""
        b, i = self._split
        K_bb, K_ib, K_ii = self.matrices(H, chart, corners, [(b, b), (i, b), (i, i)])
        if self._pressures:
            # Over a cell's size: small cells' pressures weigh as much in the matrix as large ones'.
            unit = 1.0 / size_of_cells(corners)[:, None]
            of_b, of_i = (np.where(dofs < 2 * self.nodes, 1.0, unit) for dofs in (b, i))
            K_bb *= of_b[:, :, None] * of_b[:, None, :]
            K_ib *= of_i[:, :, None] * of_b[:, None, :]
            K_ii *= of_i[:, :, None] * of_i[:, None, :]
        return [K_bb, K_ib, K_ii]


def _contracted(H: NDArray, entries: int, gradients: NDArray) -> NDArray[np.float64]:
    """Sums over pairs of axes, [cell, components, derivatives, second, first].

    Args:
        H: the form of one cell or of each, (1 or m, ..., second, first); of a single point where it is
            constant.
        entries: number of entries of a component.
        gradients: products of gradients, [cell, entries, derivatives, second, first].
    """
    m, _, *rest = gradients.shape
    by_component = H.reshape(len(H), -1, entries, *H.shape[-2:])
    if H.shape[-1] == 1:
        sums = by_component[..., 0, 0] @ gradients.reshape(m, entries, -1)
        return np.asarray(sums.reshape(m, -1, *rest))
    return np.einsum("mceyx,medyx->mcdyx", by_component, gradients, optimize=True)


class _Block:
    """Products of two kinds of functions: pairs along the first direction with pairs along the second.

    Args:
        components: pairs of components.
        left, right: factors of the derivatives of either kind.
    """

    def __init__(self, components: int, left: list[_Factors], right: list[_Factors]) -> None:
        first, second = (
            [_pairs(a[direction], b[direction]) for a in left for b in right] for direction in (0, 1)
        )
        self._first, self._second = first, np.concatenate(second)
        self._pairs = first[0].shape[1]
        #: Number of products of a cell.
        self.size = components * self._pairs**2

    def fill(self, result: NDArray, density: NDArray) -> None:
        """Sum over points.

        Args:
            result: takes the products of each cell, (m, size).
            density: weighted, [cell, components, derivatives, second, first].
        """
        m, components, derivatives, Q, _ = density.shape
        summed = np.empty((m, components, derivatives, Q, self._pairs))
        for n, pairs in enumerate(self._first):
            summed[:, :, n] = density[:, :, n] @ pairs
        by_second = summed.reshape(m, components, derivatives * Q, self._pairs).swapaxes(2, 3)
        np.matmul(by_second, self._second, out=result.reshape(m, components, self._pairs, self._pairs))


def _pairs(left: NDArray, right: NDArray) -> NDArray[np.float64]:
    """Products of each function of one kind with each of another, (points, pairs)."""
    return (left[:, :, None] * right[:, None, :]).reshape(len(left), -1)


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
