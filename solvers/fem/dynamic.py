"""Matrices of motion in a frame that moves: stiffness, momentum and what the frame carries along.

All unknowns stay: inside cells waves have to be followed as they are at their boundaries.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csr_matrix

from galinx.solvers.fem import adapter
from galinx.solvers.fem.coarse import damping
from galinx.solvers.fem.element import Element
from galinx.solvers.fem.forms import carried_density, momentum_density
from galinx.solvers.fem.shapes import Shapes
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import ByCells, Response


@dataclass(frozen=True)
class Motion:
    """Equations M ü + (D - 2c B) u̇ + K u = forces of a space on one rank, in the physical chart.

    Node i has the unknowns 2i and 2i + 1.

    Args:
        space: the space.
        response: of the half-plane at a speed; layers of it are uniform.
        sharp: are there waves that no cell holds, as where a punch turns round?
    """

    space: Space
    response: Response
    sharp: bool = False

    @cached_property
    def K(self) -> csr_matrix:
        """The steady form."""
        space, element = self.space, Element(self.space.reference_nodes)
        dofs = np.arange(element.size)
        H = space.densities(self.response, space.vertices)
        chart = space.contracted(self.response)
        return self._sum(element.matrices(H, chart, space.vertices, [(dofs, dofs)])[0])

    @cached_property
    def M(self) -> csr_matrix:
        """Of momentum, of one component: the other has the same."""
        return self._sum(self._weighted(_of_component(self._products[0], momentum_density())))

    @cached_property
    def B(self) -> csr_matrix:
        """Of what is carried along, u,X·w, of one component."""
        return self._sum(self._weighted(_of_component(self._products[1], carried_density())))

    @cached_property
    def D(self) -> csr_matrix:
        """Of waves that far cells are too large for, of one component."""
        impedance = np.sqrt(self.ρ * self._of_cells("c66"))
        return self._sum(impedance[:, None, None] * damping(self.space, self.sharp))

    @property
    def ρ(self) -> NDArray[np.float64]:
        """Density of each cell over that of the solid at the surface, (cells,)."""
        return self._of_cells("ρ")

    def _of_cells(self, name: str) -> NDArray[np.float64]:
        """A constant of each cell over that of the solid at the surface."""
        response, Y = self.response, self.space.vertices[:, :, 1].mean(axis=1)
        if not isinstance(response, ByCells):
            return np.ones(len(Y))
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
        """Where these are, over a."""
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
        for corners in self.space.vertices[:, :, :2]:
            weights, inverse = shapes.on(corners)
            weighted = shapes.values * weights[:, None]
            slopes = np.einsum("dqn,qdx->xqn", shapes.slopes, inverse)
            mass.append([weighted.T @ shapes.values])
            gradient.append([weighted.T @ one for one in slopes])
        return np.array(mass), np.array(gradient)

    def _sum(self, matrices: NDArray) -> csr_matrix:
        dofs = adapter.cell_nodes(self.space.V)
        components = matrices.shape[1] // dofs.shape[1]
        dofs = components * dofs[:, :, None] + np.arange(components, dtype=np.int32)
        dofs = dofs.reshape(len(dofs), -1)
        rows = np.broadcast_to(dofs[:, :, None], matrices.shape)
        columns = np.broadcast_to(dofs[:, None, :], matrices.shape)
        size = components * self.size // 2
        entries = (matrices.ravel(), (rows.ravel(), columns.ravel()))
        return coo_matrix(entries, shape=(size, size)).tocsr()


def _of_component(products: NDArray, density: NDArray) -> NDArray[np.float64]:
    """Element matrices of one component from products of shapes: it meets only itself, both alike.

    Args:
        products: (cells, axes, a, b).
        density: by components of the test, and of the trial with its axes, (2, 2·axes).
    """
    return np.einsum("mxab,x->mab", products, density[0, : products.shape[1]])


def of_both(A: csr_matrix, w: NDArray) -> NDArray[np.float64]:
    """A @ w, where A is of one component and w has both of each node."""
    found = np.empty_like(w)
    found[0::2], found[1::2] = A @ w[0::2], A @ w[1::2]  # SciPy is slow with two columns
    return found
