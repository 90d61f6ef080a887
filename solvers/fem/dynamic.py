"""Equations of motion in a frame that moves: matrices, damping and energies.

The matrices are stiffness, momentum, what the frame carries along, and damping. All unknowns stay: inside
cells waves have to be followed as they are at their boundaries.

**Damping** is for waves that cells are too large for. Where cells grow outwards, a wave that comes among
cells which cannot resolve it would be reflected by them. So it is damped there: of the velocity seen from
the punch, the higher Legendre polynomials of each cell lose energy (spectral viscosity: Maday, Ould Kaber
& Tadmor, SIAM J. Numer. Anal. 30, 321, 1993)::

    w·D w = Σ_cells rate Σ_ij (d_i + d_j) w_ij²,      d_j = exp(-((p - j)/(j - m))²) for j > m

What a cell resolves well is not damped, and neither is steady motion. Under the punch friction feeds what
no cell resolves, which would grow the faster the shorter the steps are. Where the punch turns round more
is damped: waves that begin at the edges then, suddenly, are sharp.

**Energies** are those of the whole solid, and of a box round the punch that goes with it. With u̇ as seen
from the punch, whose velocity is C, the solid moves at u̇ - C u,X (lengths over a, times over a/c_s). Its
kinetic energy is half of ∫(u̇ - C u,X)², its strain energy half of ∫(K's density + C² u,X²), and its
momentum in the field Π = -∫(u̇ - C u,X)·u,X, by which energies seen from both differ::

    strain + kinetic = (energy of the motion seen from the punch) + C Π
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csr_matrix

from ..approximation import lagrange
from ..solids.half_plane import HalfPlane
from ..transient.punch import BOX
from . import cells, versions
from .space import Space

#: Rate at which the highest polynomial is damped, over c_s and the cell's shorter side; the share of
#: polynomials that are not.
_RATE, _KEPT = 5.0, 0.6
#: Rate and share for all cells where the punch turns round.
_SHARP_RATE, _SHARP_KEPT = 20.0, 0.4


class Quadrature:
    """Gauss's rule in cells, exact for products of shape functions on parallelograms.

    Fields in cells are values at their nodes along both directions, (cells, components, n, n); at points
    they are (cells, components, q, q).

    Args:
        nodes: places of a cell's nodes along one direction, (n,).
        corners: of the cells, (cells, 4, 2).

    Attributes:
        value, slope: of the shape functions along one direction at points, (q, n).
        weights: of the points, (cells, 1, q, q).
        inverse: inverse Jacobians, [direction, axis, cell, 0, point, point].
    """

    def __init__(self, nodes: NDArray, corners: NDArray) -> None:
        x, w = leggauss(len(nodes) + 1)
        x, w = (x + 1.0) / 2.0, w / 2.0
        self.value, self.slope = lagrange(nodes, x)
        J = cells.jacobian(corners[:, None, None], np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1))
        self.weights = (np.outer(w, w) * np.abs(np.linalg.det(J)))[:, None]
        inverse = np.moveaxis(np.linalg.inv(J), (3, 4), (0, 1))
        self.inverse = np.ascontiguousarray(inverse)[:, :, :, None]
        self._both = np.concatenate([self.value, self.slope])

    def values(self, U: NDArray) -> NDArray[np.float64]:
        """Values of fields at points, (cells, components, q, q)."""
        return np.asarray(self.value @ (U @ self.value.T))

    def gradients(self, U: NDArray) -> NDArray[np.float64]:
        """Derivatives of two components along both axes at points, (cells, components, axes, q, q)."""
        (m, _, n, _), q = U.shape, len(self.value)
        along = (U.reshape(-1, n) @ self._both.T).reshape(m, 2, n, 2 * q)
        slopes = self.slope @ along[..., :q], self.value @ along[..., q:]
        gradients = np.empty((m, 2, 2, q, q))
        for axis in (0, 1):
            first, second = self.inverse[:, axis]
            gradients[:, :, axis] = first * slopes[0] + second * slopes[1]
        return gradients

    def tested(self, fluxes: NDArray) -> NDArray[np.float64]:
        """Sums over points of weighted fluxes times derivatives of shapes: the adjoint of gradients."""
        (m, _, _, q, _), n = fluxes.shape, self.value.shape[1]
        result = np.empty((m, 2, n, 2 * q))
        for direction, factor, part in ((0, self.slope, slice(q)), (1, self.value, slice(q, None))):
            of_X, of_Y = self.inverse[direction]
            result[..., part] = factor.T @ (of_X * fluxes[:, :, 0] + of_Y * fluxes[:, :, 1])
        return np.asarray(result.reshape(-1, 2 * q) @ self._both)


@dataclass(frozen=True)
class Motion:
    """Equations M ü + (D - 2c B) u̇ + K u = forces of a space on one rank, in the physical chart.

    Node i has the unknowns 2i and 2i + 1. Products with fields are by quadrature in each direction of
    each cell: a product with an assembled matrix waits for its entries. At degree 10 a cell's stiffness
    matrix has 58 564, while its 144 points have a weight and an inverse Jacobian each.

    Args:
        space: the space.
        response: of the half-plane at a speed; layers of it are uniform.
        sharp: True where there are waves that no cell resolves, as where a punch turns round.
    """

    space: Space
    response: HalfPlane
    sharp: bool = False

    @cached_property
    def K(self) -> csr_matrix:
        """Matrix of the steady form, (unknowns, unknowns)."""
        space, dofs = self.space, np.arange(self.space.kernel.size)
        chart = space.contracted(self.response)
        matrices = space.kernel.matrices(self.H, chart, space.vertices, [(dofs, dofs)])[0]
        return self._sum(matrices, versions.cell_nodes(space.V))

    @cached_property
    def M(self) -> csr_matrix:
        """Matrix of momentum ∫ ρ u·w, for one component: the other has an equal one."""
        return self._weighted(lambda _: np.kron(self.quadrature.value, self.quadrature.value))

    @cached_property
    def B(self) -> csr_matrix:
        """Matrix of what the frame carries along, ∫ ρ u,X·w, for one component."""
        rule = self.quadrature
        slopes = np.array([np.kron(rule.slope, rule.value), np.kron(rule.value, rule.slope)])
        by_X = rule.inverse[:, 0].reshape(2, len(rule.weights), -1, 1)
        return self._weighted(lambda cell: (by_X[:, cell] * slopes).sum(axis=0))

    @cached_property
    def D(self) -> csr_matrix:
        """Damping of waves that cells are too large for, for one component."""
        legendre, rates = self._damping
        both = np.kron(legendre, legendre)
        matrices = both.T @ (rates.reshape(len(rates), both.shape[1], 1) * both)
        return self._sum(matrices, self._nodes)

    @property
    def impedance(self) -> NDArray[np.float64]:
        """Impedance of each cell to shear waves over that of the solid at the surface, (cells,)."""
        return np.sqrt(self.ρ * self._of_cells("c66"))

    @cached_property
    def ρ(self) -> NDArray[np.float64]:
        """Density of each cell over that of the solid at the surface, (cells,)."""
        return self._of_cells("ρ")

    @cached_property
    def H(self) -> NDArray[np.float64]:
        """The steady form at unit gradients, (4, 4) or (cells, 4, 4)."""
        return self.space.densities(self.response, self.space.vertices)

    def _of_cells(self, name: str) -> NDArray[np.float64]:
        """A constant of each cell over that of the solid at the surface, (cells,)."""
        response, Y = self.response, self.space.vertices[:, :, 1].mean(axis=1)
        by_solid = np.array([float(rows[0, 0]) for rows in response.constants([name])])
        return by_solid[response.solids(Y)]

    @cached_property
    def quadrature(self) -> Quadrature:
        """Rule of all cells."""
        _, nodes = cells.tensor_order(self.space.reference_nodes)
        return Quadrature(nodes, self.space.vertices[:, :, :2])

    @cached_property
    def dofs(self) -> NDArray[np.int64]:
        """Unknowns of the cells by component and nodes along both directions, (cells, 2, n, n)."""
        n = len(self.quadrature.value.T)
        return 2 * self._nodes.reshape(-1, 1, n, n) + np.arange(2)[:, None, None]

    @cached_property
    def _nodes(self) -> NDArray[np.int64]:
        grid, _ = cells.tensor_order(self.space.reference_nodes)
        return versions.cell_nodes(self.space.V)[:, grid.ravel()].astype(np.int64)

    @cached_property
    def _damping(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Damping of waves that no cell resolves.

        Returns:
            Coefficients of orthonormal Legendre polynomials from values at a cell's nodes, (n, n); and
            rates d_i + d_j of pairs of these, times the area and the rate of each cell, (cells, 1, n, n).
        """
        _, nodes = cells.tensor_order(self.space.reference_nodes)
        points, weights = leggauss(len(nodes) + 1)
        values, _ = lagrange(nodes, (points + 1.0) / 2.0)
        orders, p = np.arange(len(nodes)), len(nodes) - 1
        normed = legvander(points, p) * np.sqrt(2.0 * orders + 1.0)
        high = np.maximum(orders - round((_SHARP_KEPT if self.sharp else _KEPT) * p), 1e-9)
        d = np.exp(-(((p - orders) / high) ** 2))
        corners = self.space.vertices[:, :, :2]
        J = cells.jacobian(corners, np.full((len(corners), 2), 0.5))
        rates = np.abs(np.linalg.det(J)) / np.linalg.norm(J, axis=1).min(axis=1) * self.impedance
        rates *= _SHARP_RATE if self.sharp else _RATE
        of_pairs = rates[:, None, None, None] * np.add.outer(d, d)
        return normed.T @ (weights[:, None] / 2.0 * values), of_pairs

    @cached_property
    def contact(self) -> NDArray[np.int64]:
        """Nodes under the punch from left to right."""
        nodes = self.space.nodes_on("contact").astype(np.int64)
        return nodes[np.argsort(self.space.coordinates[nodes, 0])]

    @property
    def X(self) -> NDArray[np.float64]:
        """Positions of the contact nodes over a, (nodes,)."""
        return np.asarray(self.space.coordinates[self.contact, 0])

    @cached_property
    def far(self) -> NDArray[np.int64]:
        """Nodes of the far boundary."""
        return self.space.nodes_on("far").astype(np.int64)

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return 2 * len(self.space.coordinates)

    def _weighted(self, trials: Callable[[int], NDArray]) -> csr_matrix:
        """Matrix of ρ times shapes and trials, which are given at the points of a cell, (q², n²)."""
        shapes = np.kron(self.quadrature.value, self.quadrature.value)
        weights = self.ρ[:, None, None] * self.quadrature.weights.reshape(len(self.ρ), -1, 1)
        matrices = [(weight * shapes).T @ trials(cell) for cell, weight in enumerate(weights)]
        return self._sum(np.array(matrices), self._nodes)

    def _sum(self, matrices: NDArray, nodes: NDArray) -> csr_matrix:
        components = matrices.shape[1] // nodes.shape[1]
        dofs = components * nodes[:, :, None] + np.arange(components, dtype=nodes.dtype)
        dofs = dofs.reshape(len(dofs), -1)
        rows = np.broadcast_to(dofs[:, :, None], matrices.shape)
        columns = np.broadcast_to(dofs[:, None, :], matrices.shape)
        size = components * self.size // 2
        entries = (matrices.ravel(), (rows.ravel(), columns.ravel()))
        return coo_matrix(entries, shape=(size, size)).tocsr()

    def stiffness(self, u: NDArray) -> NDArray[np.float64]:
        """K u of displacements (unknowns,)."""
        fluxes = self.quadrature.gradients(u[self.dofs])
        fluxes *= self.quadrature.weights[:, :, None]
        flat = fluxes.reshape(len(fluxes), 4, -1)
        return self._summed(self.quadrature.tested((self.H @ flat).reshape(fluxes.shape)))

    def momentum(self, w: NDArray) -> NDArray[np.float64]:
        """M w of both components of velocities (unknowns,)."""
        values, value = self.quadrature.values(w[self.dofs]), self.quadrature.value
        values *= self._weighted_ρ
        return self._summed(value.T @ values @ value)

    @cached_property
    def _weighted_ρ(self) -> NDArray[np.float64]:
        return np.asarray(self.ρ[:, None, None, None] * self.quadrature.weights)

    def dissipation(self, w: NDArray) -> float:
        """w·D w of velocities (unknowns,)."""
        legendre, rates = self._damping
        coefficients = legendre @ (w[self.dofs] @ legendre.T)
        return float(np.vdot(coefficients, rates * coefficients))

    def _summed(self, by_cell: NDArray) -> NDArray[np.float64]:
        return np.asarray(np.bincount(self.dofs.ravel(), by_cell.ravel(), self.size), dtype=np.float64)


def of_both(A: csr_matrix, w: NDArray) -> NDArray[np.float64]:
    """A @ w, where A is of one component and w has both of each node."""
    product = np.empty_like(w)
    product[0::2], product[1::2] = A @ w[0::2], A @ w[1::2]  # SciPy is slow with two columns
    return product


class Energies:
    """Energies and momentum of displacements and velocities.

    Args:
        motion: the equations.
    """

    def __init__(self, motion: Motion) -> None:
        self._motion = motion
        corners = motion.space.vertices[:, :, :2]
        low, high = corners.min(axis=1), corners.max(axis=1)
        lowest, highest = np.array([-BOX[0], -BOX[1]]), np.array([BOX[0], 0.0])
        self._inside = np.all((low >= lowest - 1e-12) & (high <= highest + 1e-12), axis=1)
        touched = np.all((np.minimum(high, highest) - np.maximum(low, lowest)) > 1e-12, axis=1)
        self._cut = np.flatnonzero(touched & ~self._inside)
        # Cells that are cut are rectangles; so are their parts, with the nodes of cells of their own.
        low, high = np.maximum(low[self._cut], lowest), np.minimum(high[self._cut], highest)
        _, nodes = cells.tensor_order(motion.space.reference_nodes)
        grid = np.stack(np.meshgrid(nodes, nodes, indexing="ij"), axis=-1).reshape(-1, 2)
        self._onto = np.empty((len(low), len(grid), len(grid)))
        for i, own in enumerate(corners[self._cut]):
            points = low[i] + grid * (high[i] - low[i])
            places = cells.pull_back(np.broadcast_to(own, (len(grid), 4, 2)), points)
            first, second = (lagrange(nodes, along)[0] for along in places.T)
            self._onto[i] = (first[:, :, None] * second[:, None, :]).reshape(len(grid), -1)
        unit = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
        self._parts = Quadrature(nodes, low[:, None] + unit * (high - low)[:, None])

    def __call__(self, u: NDArray, w: NDArray, way: int) -> NDArray[np.float64]:
        """Strain and kinetic energy in the box, then of all, over N²/(4μ), and Π, over N²/(4μ c_s): (5,).

        Args:
            u: displacements, (unknowns,).
            w: velocities seen from the punch.
            way: direction of the punch, ±1.
        """
        motion = self._motion
        U, W = u[motion.dofs], w[motion.dofs]
        whole = self._of(motion.quadrature, U, W, way, slice(None))
        cut = [
            (self._onto @ field[self._cut].reshape(len(self._cut), 2, -1).swapaxes(1, 2))
            .swapaxes(1, 2)
            .reshape(-1, *field.shape[1:])
            for field in (U, W)
        ]
        near = whole[:2, self._inside].sum(axis=1)
        near = near + self._of(self._parts, *cut, way, self._cut)[:2].sum(axis=1)
        return np.concatenate([near, whole.sum(axis=1)])

    def _of(
        self, rule: Quadrature, U: NDArray, W: NDArray, way: int, which: NDArray | slice
    ) -> NDArray[np.float64]:
        """Strain and kinetic energy and momentum of each cell, (3, cells).

        Args:
            rule: of the cells.
            U, W: displacements and velocities at their nodes, (cells, 2, n, n).
            way: direction of the punch, ±1.
            which: numbers of these cells in the mesh, or of those whose parts they are.
        """
        motion, c = self._motion, self._motion.response.c
        gradients = rule.gradients(U)
        u_X, flat = gradients[:, :, 0], gradients.reshape(len(gradients), 4, -1)
        H, ρ = motion.H if motion.H.ndim == 2 else motion.H[which], motion.ρ[which][:, None, None, None]
        moving = rule.values(W) - way * c * u_X
        of_strain = (flat * (H @ flat)).reshape(gradients.shape).sum(axis=2) + ρ * (c * u_X) ** 2
        densities = of_strain / 2.0, ρ * moving**2 / 2.0, -ρ * moving * u_X
        return np.array([(density * rule.weights).sum(axis=(1, 2, 3)) for density in densities])
