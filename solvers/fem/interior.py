"""Displacement gradients inside the half-plane, of combinations of fields, at any points.

Inner unknowns were condensed; they are found again for the cells that hold a point, and for no other.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from solvers.errors import MeshError
from solvers.fem.lagrange import lagrange
from solvers.fem.space import Space

#: How far outside a cell, over its size, a point still counts as inside.
_SLACK = 1e-9


class InteriorGradients:
    """Displacement gradients along X and Y at given points.

    Args:
        space: the finite element space.
        κ, c: Kolosov's constant and the speed of the fields.
        fields: displacements over N/(2μ), condensed.
        points: positions over a with Y <= 0, (n, 2).

    Raises:
        MeshError: a point lies outside the mesh.
    """

    def __init__(
        self, space: Space, κ: float, c: float, fields: Sequence[PETSc.Vec], points: NDArray
    ) -> None:
        x = space.plane.from_physical(points)
        vertices = space.vertices[..., :2]
        held = _locate(vertices, x)
        found = space.comm.allreduce(np.bincount(held.point, minlength=len(points)))
        if not found.all():
            X, Y = points[np.argmin(found)]
            raise MeshError(f"the point X/a = {X:g}, Y/a = {Y:g} lies outside the mesh")
        cells = np.unique(held.cell)
        values = space.cell_values(fields, κ, c, cells)
        gradients = np.zeros((len(points), 2, 2, len(fields)))
        grid, nodes = _tensor_order(space.reference_nodes)
        for cell, u in zip(cells, values[:, grid]):
            here = held.cell == cell
            reference = _reference_gradients(nodes, held.t[here], u)
            J = np.array([_jacobian(vertices[cell], t) for t in held.t[here]])
            in_plane = np.einsum("nrcf,nrx->ncxf", reference, np.linalg.inv(J))
            np.add.at(gradients, held.point[here], in_plane)
        # On the border between cells the gradient jumps; it is their mean.
        gradients = space.comm.allreduce(gradients) / found[:, None, None, None]
        cos, sin = (value * np.ones(len(x)) for value in space.plane.rotation(x.T, np))
        R = np.array([[cos, -sin], [sin, cos]]) / space.plane.stretch(x)
        self._basis = np.einsum("ncxf,Xxn->ncXf", gradients, R)

    def of(self, weights: NDArray) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over N/(2a) of combinations with weights (states, fields): (states, n, 2, 2)."""
        return np.einsum("nijf,sf->snij", self._basis[..., : weights.shape[1]], weights)


@dataclass(frozen=True)
class _Held:
    """Pairs of a point and a cell of this rank that holds it.

    Attributes:
        point, cell: their numbers, (n,).
        t: place of the point in the cell's unit square, (n, 2).
    """

    point: NDArray[np.int64]
    cell: NDArray[np.int64]
    t: NDArray[np.float64]


def _locate(vertices: NDArray, x: NDArray) -> _Held:
    low, high = vertices.min(axis=1), vertices.max(axis=1)
    slack = _SLACK * (high - low)
    found = []
    for n, point in enumerate(x):
        for cell in np.flatnonzero(np.all((low - slack <= point) & (point <= high + slack), axis=1)):
            t = _pull_back(vertices[cell], point)
            if np.all((t >= -_SLACK) & (t <= 1.0 + _SLACK)):
                found.append((n, cell, *t))
    pairs = np.reshape(np.array(found, dtype=float), (-1, 4))
    return _Held(pairs[:, 0].astype(int), pairs[:, 1].astype(int), pairs[:, 2:])


def _jacobian(vertices: NDArray, t: NDArray) -> NDArray[np.float64]:
    """∂x/∂t as [component of x, component of t]; vertices in dolfinx's order 00, 10, 01, 11."""
    a, b = t
    by_a = (1 - b) * (vertices[1] - vertices[0]) + b * (vertices[3] - vertices[2])
    by_b = (1 - a) * (vertices[2] - vertices[0]) + a * (vertices[3] - vertices[1])
    return np.column_stack([by_a, by_b])


def _pull_back(vertices: NDArray, x: NDArray) -> NDArray[np.float64]:
    """Place in the unit square of a point, by Newton's method for the bilinear map.

    NaN where that does not converge: the point is then far outside the cell.
    """
    t = np.array([0.5, 0.5])
    for _ in range(25):
        a, b = t
        image = np.array([(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b]) @ vertices
        step = np.linalg.solve(_jacobian(vertices, t), x - image)
        t = t + step
        if np.abs(step).max() < 1e-14 * max(1.0, np.abs(t).max()):
            return t
    return np.full(2, np.nan)


def _tensor_order(reference: NDArray) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Local nodes as a grid [i, j] along the two directions of the unit square, and their places."""
    n = round(np.sqrt(len(reference)))
    grid = np.lexsort(np.round(reference, 9).T[::-1]).reshape(n, n)
    return grid, reference[grid[:, 0], 0]


def _reference_gradients(nodes: NDArray, t: NDArray, u: NDArray) -> NDArray[np.float64]:
    """Derivatives along the unit square's directions at points t of nodal values u (p+1, p+1, ...)."""
    (value_a, slope_a), (value_b, slope_b) = (lagrange(nodes, t[:, i]) for i in (0, 1))
    along_a = np.einsum("ni,nj,ij...->n...", slope_a, value_b, u, optimize=True)
    along_b = np.einsum("ni,nj,ij...->n...", value_a, slope_b, u, optimize=True)
    return np.stack([along_a, along_b], axis=1)
