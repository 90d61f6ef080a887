"""Equations of motion in a frame that moves: matrices, damping and energies.

The matrices are stiffness, momentum, what the frame carries along, and damping. All unknowns stay: inside
cells waves have to be followed as they are at their boundaries.

**Damping** is for waves that cells are too large for. Where cells grow outwards, a wave that comes among
cells which cannot resolve it would be reflected by them. So it is damped there: of the velocity seen from
the punch, the higher Legendre polynomials of each cell lose energy (spectral viscosity: Maday, Ould Kaber
& Tadmor, SIAM J. Numer. Anal. 30, 321, 1993)::

    w·D w = Σ_cells rate Σ_ij (d_i + d_j) w_ij²,      d_j = exp(-((p - j)/(j - m))²) for j > m

What a cell resolves well is not damped, and neither is steady motion. Near the punch nothing is damped,
but where it turns round: waves that begin at the edges then, suddenly, are sharp, and no cell resolves
them.

**Energies** are those of the whole solid, and of a box round the punch that goes with it. With u̇ as seen
from the punch, whose velocity is C, the solid moves at u̇ - C u,X (lengths over a, times over a/c_s). Its
kinetic energy is half of ∫(u̇ - C u,X)², its strain energy half of ∫(K's density + C² u,X²), and its
momentum in the field Π = -∫(u̇ - C u,X)·u,X, by which energies seen from both differ::

    strain + kinetic = (energy of the motion seen from the punch) + C Π
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csr_matrix

from ..approximation import lagrange
from ..solids.half_plane import HalfPlane
from . import cells, versions
from .element import Element
from .forms import carried_density, momentum_density
from .space import Space

#: Rate at which the highest polynomial is damped, over c_s and the cell's shorter side; the share of
#: polynomials that are not.
_RATE, _KEPT = 5.0, 0.6
#: Rate and share for all cells where the punch turns round.
_SHARP_RATE, _SHARP_KEPT = 20.0, 0.4
#: Distance from the punch, over a, at which damping begins.
_FROM = 1.0


def damping(space: Space, sharp: bool = False) -> NDArray[np.float64]:
    """Damping matrices D of all cells for scalar fields, (cells, nodes, nodes).

    Args:
        space: the finite element space.
        sharp: True where there are waves that no cell resolves.
    """
    grid, nodes = cells.tensor_order(space.reference_nodes)
    along, place = _to_legendre(nodes), np.argsort(grid.ravel())
    both = np.einsum("ia,jb->ijab", along, along).reshape(len(place), len(place))[:, place]
    of_unit = both.T @ (_damped(len(nodes), sharp).reshape(-1, 1) * both)
    return of_unit * _weights(space.vertices[:, :, :2], sharp)[:, None, None]


def _to_legendre(nodes: NDArray) -> NDArray[np.float64]:
    """Coefficients of orthonormal Legendre polynomials from values at the nodes, (p+1, p+1)."""
    points, weights = leggauss(len(nodes) + 1)
    values, _ = lagrange(nodes, (points + 1.0) / 2.0)
    normed = legvander(points, len(nodes) - 1) * np.sqrt(2.0 * np.arange(len(nodes)) + 1.0)
    return np.asarray(normed.T @ (weights[:, None] / 2.0 * values))


def _damped(count: int, sharp: bool) -> NDArray[np.float64]:
    """d_i + d_j of pairs of polynomials, (count, count)."""
    orders, p = np.arange(count), count - 1
    high = np.maximum(orders - round((_SHARP_KEPT if sharp else _KEPT) * p), 1e-9)
    d = np.exp(-(((p - orders) / high) ** 2))
    return np.asarray(np.add.outer(d, d))


def _weights(corners: NDArray, sharp: bool) -> NDArray[np.float64]:
    """Area times rate of each cell."""
    middle = corners.mean(axis=1)
    J = cells.jacobian(corners, np.full((len(corners), 2), 0.5))
    shorter = np.linalg.norm(J, axis=1).min(axis=1)
    far = np.maximum(np.abs(middle[:, 0]) - 1.0, -middle[:, 1]) > _FROM
    rates = _SHARP_RATE if sharp else np.where(far, _RATE, 0.0)
    return np.asarray(np.abs(np.linalg.det(J)) * rates / shorter)


@dataclass(frozen=True)
class Shapes:
    """Shape functions of the unit square at points of Gauss's rule, exact for products on parallelograms.

    Attributes:
        t: points, (points, 2).
        weights: of the points, (points,).
        values: of the shape functions, (points, nodes).
        slopes: their derivatives along both directions of the square, (2, points, nodes).
    """

    t: NDArray[np.float64]
    weights: NDArray[np.float64]
    values: NDArray[np.float64]
    slopes: NDArray[np.float64]

    @classmethod
    def of(cls, reference: NDArray) -> "Shapes":
        """Shape functions of nodes at places in the unit square, (nodes, 2)."""
        grid, nodes = cells.tensor_order(reference)
        x, w = leggauss(len(nodes) + 1)
        x, w = (x + 1.0) / 2.0, w / 2.0
        value, slope = lagrange(nodes, x)
        t = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
        place = np.argsort(grid.ravel())
        φ, along, across = (
            np.einsum("qi,rj->qrij", a, b).reshape(len(t), -1)[:, place]
            for a, b in ((value, value), (slope, value), (value, slope))
        )
        return cls(t, np.outer(w, w).ravel(), φ, np.array([along, across]))

    def on(self, corners: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Weights of the points in cells, and inverse Jacobians there.

        Args:
            corners: of the cells, (cells, 4, 2).

        Returns:
            Arrays (cells, points) and [cell, point, direction, axis].
        """
        J = cells.jacobian(corners[:, None], self.t)
        weights = np.asarray(self.weights * np.abs(np.linalg.det(J)), dtype=np.float64)
        return weights, np.asarray(np.linalg.inv(J), dtype=np.float64)


@dataclass(frozen=True)
class Motion:
    """Equations M ü + (D - 2c B) u̇ + K u = forces of a space on one rank, in the physical chart.

    Node i has the unknowns 2i and 2i + 1.

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
        space, element = self.space, Element(self.space.reference_nodes)
        dofs = np.arange(element.size)
        H = space.densities(self.response, space.vertices)
        chart = space.contracted(self.response)
        return self._sum(element.matrices(H, chart, space.vertices, [(dofs, dofs)])[0])

    @cached_property
    def M(self) -> csr_matrix:
        """Matrix of momentum, for one component: the other has an equal one."""
        return self._sum(self._weighted(_of_component(self._products[0], momentum_density())))

    @cached_property
    def B(self) -> csr_matrix:
        """Matrix of what the frame carries along, u,X·w, for one component."""
        return self._sum(self._weighted(_of_component(self._products[1], carried_density())))

    @cached_property
    def D(self) -> csr_matrix:
        """Damping of waves that far cells are too large for, for one component."""
        return self._sum(self.impedance[:, None, None] * damping(self.space, self.sharp))

    @property
    def impedance(self) -> NDArray[np.float64]:
        """Impedance of each cell to shear waves over that of the solid at the surface, (cells,)."""
        return np.sqrt(self.ρ * self._of_cells("c66"))

    @property
    def ρ(self) -> NDArray[np.float64]:
        """Density of each cell over that of the solid at the surface, (cells,)."""
        return self._of_cells("ρ")

    def _of_cells(self, name: str) -> NDArray[np.float64]:
        """A constant of each cell over that of the solid at the surface, (cells,)."""
        response, Y = self.response, self.space.vertices[:, :, 1].mean(axis=1)
        by_solid = np.array([float(rows[0, 0]) for rows in response.constants([name])])
        return by_solid[response.solids(Y)]

    def _weighted(self, matrices: NDArray) -> NDArray[np.float64]:
        return np.asarray(self.ρ[:, None, None] * matrices)

    @cached_property
    def contact(self) -> NDArray[np.int64]:
        """Nodes under the punch from left to right."""
        nodes = self._on("contact")
        return nodes[np.argsort(self.space.coordinates[nodes, 0])]

    @property
    def X(self) -> NDArray[np.float64]:
        """Positions of the contact nodes over a, (nodes,)."""
        return np.asarray(self.space.coordinates[self.contact, 0])

    @cached_property
    def far(self) -> NDArray[np.int64]:
        """Nodes of the far boundary."""
        return self._on("far")

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return 2 * len(self.space.coordinates)

    def _on(self, part: str) -> NDArray[np.int64]:
        return np.asarray(self.space.nodes_on(part), dtype=np.int64)

    @cached_property
    def _products(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """∫ φ_a φ_b, (cells, 1, a, b), and ∫ φ_a ∂φ_b, by the two axes, (cells, 2, a, b)."""
        shapes, mass, gradient = Shapes.of(self.space.reference_nodes), [], []
        for weights, inverse in zip(*shapes.on(self.space.vertices[:, :, :2])):
            weighted = shapes.values * weights[:, None]
            slopes = np.einsum("dqn,qdx->xqn", shapes.slopes, inverse)
            mass.append([weighted.T @ shapes.values])
            gradient.append([weighted.T @ slope for slope in slopes])
        return np.array(mass), np.array(gradient)

    def _sum(self, matrices: NDArray) -> csr_matrix:
        dofs = versions.cell_nodes(self.space.V)
        components = matrices.shape[1] // dofs.shape[1]
        dofs = components * dofs[:, :, None] + np.arange(components, dtype=np.int32)
        dofs = dofs.reshape(len(dofs), -1)
        rows = np.broadcast_to(dofs[:, :, None], matrices.shape)
        columns = np.broadcast_to(dofs[:, None, :], matrices.shape)
        size = components * self.size // 2
        entries = (matrices.ravel(), (rows.ravel(), columns.ravel()))
        return coo_matrix(entries, shape=(size, size)).tocsr()


def _of_component(products: NDArray, density: NDArray) -> NDArray[np.float64]:
    """Element matrices of one component from products of shapes; components are uncoupled and equal.

    Args:
        products: (cells, axes, a, b).
        density: by components of the test, and of the trial with its axes, (2, 2·axes).
    """
    return np.einsum("mxab,x->mab", products, density[0, : products.shape[1]])


class Products:
    """Products of the matrices of motion with fields, by quadrature in each direction of each cell.

    A product with an assembled matrix waits for its entries: at degree 10 a cell's stiffness matrix has
    58 564, while its 144 points of quadrature have a weight and an inverse Jacobian each. Points and
    weights are those of the matrices, so that results differ by rounding.

    Args:
        motion: the equations.
    """

    def __init__(self, motion: Motion) -> None:
        space, corners = motion.space, motion.space.vertices[:, :, :2]
        shapes = Shapes.of(space.reference_nodes)
        grid, nodes = cells.tensor_order(space.reference_nodes)
        x, _ = leggauss(len(nodes) + 1)
        self._value, self._slope = lagrange(nodes, (x + 1.0) / 2.0)
        self._both = np.concatenate([self._value, self._slope])
        dofs = versions.cell_nodes(space.V)[:, grid]
        self._dofs = 2 * dofs[:, None].astype(np.int64) + np.arange(2)[:, None, None]
        m, q, self._size = len(corners), len(x), motion.size
        weights, inverse = shapes.on(corners)
        weights, inverse = weights.reshape(m, q, q), inverse.reshape(m, q, q, 2, 2)
        # By direction of the cell and axis, (direction, axis, cells, 1, first, second).
        self._to_axes = np.ascontiguousarray(np.moveaxis(inverse, (3, 4), (0, 1)))[:, :, :, None]
        self._weights = weights[:, None]
        self._weighted_ρ = (motion.ρ[:, None, None] * weights)[:, None]
        H = space.densities(motion.response, space.vertices)
        self._H = np.broadcast_to(H, (m, 4, 4))
        rates = motion.impedance * _weights(corners, motion.sharp)
        self._legendre, self._rates = _to_legendre(nodes), _damped(len(nodes), motion.sharp)
        self._damped = np.flatnonzero(rates)
        self._rates = rates[self._damped, None, None, None] * self._rates

    def stiffness(self, u: NDArray) -> NDArray[np.float64]:
        """K u of displacements (unknowns,)."""
        m, _, n, _ = (U := u[self._dofs]).shape
        q = len(self._value)
        along = (U.reshape(-1, n) @ self._both.T).reshape(m, 2, n, 2 * q)
        slopes = self._slope @ along[..., :q], self._value @ along[..., q:]
        gradients = np.empty((m, 2, 2, q, q))
        for axis in (0, 1):
            first, second = self._to_axes[:, axis]
            gradients[:, :, axis] = first * slopes[0] + second * slopes[1]
        gradients *= self._weights[:, :, None]
        fluxes = (self._H @ gradients.reshape(m, 4, -1)).reshape(gradients.shape)
        by_X, by_Y = fluxes[:, :, 0], fluxes[:, :, 1]
        result = np.empty((m, 2, n, 2 * q))
        for direction, factor, part in ((0, self._slope, slice(q)), (1, self._value, slice(q, None))):
            of_X, of_Y = self._to_axes[direction]
            result[..., part] = factor.T @ (of_X * by_X + of_Y * by_Y)
        return self._summed(result.reshape(-1, 2 * q) @ self._both)

    def momentum(self, w: NDArray) -> NDArray[np.float64]:
        """M w of both components of velocities (unknowns,)."""
        values = self._value @ (w[self._dofs] @ self._value.T)
        values *= self._weighted_ρ
        return self._summed(self._value.T @ values @ self._value)

    def dissipation(self, w: NDArray) -> float:
        """w·D w of velocities (unknowns,)."""
        coefficients = self._legendre @ (w[self._dofs[self._damped]] @ self._legendre.T)
        return float(np.vdot(coefficients, self._rates * coefficients))

    def _summed(self, by_cell: NDArray) -> NDArray[np.float64]:
        return np.asarray(np.bincount(self._dofs.ravel(), by_cell.ravel(), self._size), dtype=np.float64)


def of_both(A: csr_matrix, w: NDArray) -> NDArray[np.float64]:
    """A @ w, where A is of one component and w has both of each node."""
    product = np.empty_like(w)
    product[0::2], product[1::2] = A @ w[0::2], A @ w[1::2]  # SciPy is slow with two columns
    return product


#: Half-width and depth over a of the box.
BOX = 3.0, 2.0
#: Cells that are treated together, so that they stay near the processor.
_TOGETHER = 64


class Energies:
    """Energies and momentum of displacements and velocities.

    Args:
        motion: the equations.
    """

    def __init__(self, motion: Motion) -> None:
        space, self._c = motion.space, motion.response.c
        self._H, self._ρ = space.densities(motion.response, space.vertices), motion.ρ[:, None]
        self._nodes = versions.cell_nodes(space.V)
        self._shapes = Shapes.of(space.reference_nodes)
        vertices = space.vertices[:, :, :2]
        self._all = self._shapes.on(vertices)
        low, high = vertices.min(axis=1), vertices.max(axis=1)
        lowest, highest = np.array([-BOX[0], -BOX[1]]), np.array([BOX[0], 0.0])
        inside = np.all((low >= lowest - 1e-12) & (high <= highest + 1e-12), axis=1)
        touched = np.all((np.minimum(high, highest) - np.maximum(low, lowest)) > 1e-12, axis=1)
        self._inside, self._cut = np.flatnonzero(inside), np.flatnonzero(touched & ~inside)
        parts = [np.array([np.maximum(low[i], lowest), np.minimum(high[i], highest)]) for i in self._cut]
        self._parts = self._shapes.on(_rectangles(parts))
        self._onto = np.array([
            self._restricted(space.reference_nodes, vertices[i], part)
            for i, part in zip(self._cut, parts)
        ]).reshape(len(parts), *2 * (len(space.reference_nodes),))  # fmt: skip

    def __call__(self, u: NDArray, w: NDArray, way: int) -> NDArray[np.float64]:
        """Strain and kinetic energy in the box, then of all, over N²/(4μ), and Π, over N²/(4μ c_s): (5,).

        Args:
            u: displacements, (unknowns,).
            w: velocities seen from the punch.
            way: direction of the punch, ±1.
        """
        fields = np.stack([u.reshape(-1, 2), w.reshape(-1, 2)], axis=-1)[self._nodes]
        whole = self._of(self._all, fields, way, np.arange(len(fields)))
        cut = np.einsum("mkn,mncf->mkcf", self._onto, fields[self._cut])
        near = whole[self._inside].sum(axis=0) + self._of(self._parts, cut, way, self._cut).sum(axis=0)
        total = whole.sum(axis=0)
        return np.array([near[0], near[1], total[0], total[1], total[2]])

    def _of(
        self, rule: tuple[NDArray, NDArray], fields: NDArray, way: int, which: NDArray
    ) -> NDArray[np.float64]:
        """Strain and kinetic energy and momentum of each cell, (cells, 3).

        Args:
            rule: weights of the points of the cells, and inverse Jacobians, see :meth:`Shapes.on`.
            fields: displacements and velocities at their nodes, (cells, nodes, component, 2).
            way: direction of the punch, ±1.
            which: numbers of these cells in the mesh, or of those whose parts they are, (cells,).
        """
        weights, inverse = rule
        energies = np.empty((len(fields), 3))
        for start in range(0, len(fields), _TOGETHER):
            batch = slice(start, start + _TOGETHER)
            u, w = fields[batch, ..., 0], fields[batch, ..., 1]
            by_cell = np.einsum("dqn,mnc->mqcd", self._shapes.slopes, u, optimize=True)
            slopes = np.einsum("mqcd,mqdx->mqcx", by_cell, inverse[batch])
            u_X = slopes[..., 0]
            moving = self._shapes.values @ w - way * self._c * u_X
            gradients = slopes.reshape(*slopes.shape[:2], 4)
            H, ρ = self._H if self._H.ndim == 2 else self._H[which[batch]], self._ρ[which[batch]]
            strain = ((gradients @ H) * gradients).sum(axis=-1) + ρ * self._c**2 * (u_X**2).sum(axis=-1)
            momentum, kinetic = -ρ * (moving * u_X).sum(axis=-1), ρ * (moving**2).sum(axis=-1)
            densities = strain / 2.0, kinetic / 2.0, momentum
            energies[batch] = np.stack(
                [(density * weights[batch]).sum(axis=1) for density in densities], axis=-1
            )
        return energies

    def _restricted(self, reference: NDArray, corners: NDArray, part: NDArray) -> NDArray[np.float64]:
        """Values at the nodes of a part of a cell from those at its own, (nodes, nodes).

        Args:
            reference: places of nodes in the unit square.
            corners: of the cell, a rectangle along the axes.
            part: lowest and highest corner of the part.
        """
        grid, nodes = cells.tensor_order(reference)
        places = cells.pull_back(
            np.broadcast_to(corners, (len(reference), 4, 2)), part[0] + reference * (part[1] - part[0])
        )
        first, second = (lagrange(nodes, places[:, axis])[0] for axis in (0, 1))
        product = (first[:, :, None] * second[:, None, :]).reshape(len(reference), -1)
        return np.asarray(product[:, np.argsort(grid.ravel())])


def _rectangles(parts: list[NDArray]) -> NDArray[np.float64]:
    """Vertices of rectangles from their lowest and highest corners, in dolfinx's order, (n, 4, 2)."""
    return np.array([
        [low, [high[0], low[1]], [low[0], high[1]], high] for low, high in parts
    ]).reshape(-1, 4, 2)  # fmt: skip
