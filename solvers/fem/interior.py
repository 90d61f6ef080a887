"""Displacement gradients inside the half-plane, of combinations of fields, at any points.

Inner unknowns were condensed; they are found again for the cells that hold a point, and for no other.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.errors import MeshError
from galinx.solvers.fem.cells import gradients_in_plane, image, jacobian, tensor_order
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import Response

#: How far outside a cell, over its size, a point still counts as inside.
_SLACK = 1e-9

#: Step of Newton's method, over the cell's size, after which the next would change no digit: convergence
#: is quadratic. In small cells beside X = -a rounding alone makes steps of 1e-12, so it is no smaller.
_SETTLED = 1e-8


#: Values of fields at all nodes of some of this rank's cells, (cells, nodes, 2, fields).
Values = Callable[[NDArray[np.int64]], NDArray]


class KeptValues:
    """Values of condensed fields in this rank's cells, found once for each that is asked for.

    Args:
        space: the finite element space.
        response: that the fields are solutions for.
        fields: displacements over N/(2μ), condensed.
    """

    def __init__(self, space: Space, response: Response, fields: Sequence[PETSc.Vec]) -> None:
        self._new = lambda cells: space.cell_values(fields, response, cells)
        self._kept: dict[int, NDArray] = {}

    def __call__(self, cells: NDArray[np.int64]) -> NDArray[np.float64]:
        """Collective; see ``Values``."""
        new = np.array([cell for cell in cells.tolist() if cell not in self._kept], dtype=np.int64)
        found = self._new(new)
        self._kept |= dict(zip(new.tolist(), found))
        u = np.empty((len(cells), *found.shape[1:]))
        for i, cell in enumerate(cells.tolist()):
            u[i] = self._kept[cell]
        return u


class InteriorGradients:
    """Displacement gradients along X and Y at given points.

    Args:
        space: the finite element space.
        response: that the fields are solutions for.
        fields: displacements over N/(2μ), condensed.
        points: positions over a with Y <= 0, (n, 2).
        values: of the fields in cells, as of :class:`KeptValues`; found anew if not given.

    Raises:
        MeshError: a point lies outside the mesh.
    """

    def __init__(
        self,
        space: Space,
        response: Response,
        fields: Sequence[PETSc.Vec],
        points: NDArray,
        values: Values | None = None,
    ) -> None:
        values = values or (lambda cells: space.cell_values(fields, response, cells))
        self._basis = gradients_at(space, response, points, values)

    def of(self, weights: NDArray) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over N/(2a) of combinations with weights (states, fields): (states, n, 2, 2)."""
        return np.einsum("nijf,sf->snij", self._basis[..., : weights.shape[1]], weights)

    def of_each(self, weights: NDArray) -> NDArray[np.float64]:
        """The same where the points are those of the first combination, of the second, and so on.

        Returns:
            Array (states, n/states, 2, 2).
        """
        basis = self._basis[..., : weights.shape[1]].reshape(len(weights), -1, 2, 2, weights.shape[1])
        return np.einsum("snijf,sf->snij", basis, weights)


def gradients_at(
    space: Space, response: Response, points: NDArray, values: Values
) -> NDArray[np.float64]:
    """Gradients along X and Y at points over a, (n, 2, 2, fields), the same on every rank.

    Args:
        space: the finite element space.
        response: that the fields are solutions for.
        points: with Y <= 0, (n, 2).
        values: of the fields in cells.

    Raises:
        MeshError: a point lies outside the mesh.
    """
    chart = space.contracted(response)
    x = chart.from_physical(points)
    vertices = space.vertices[..., :2]
    held = _locate(vertices, x)
    found = space.comm.allreduce(np.bincount(held.point, minlength=len(points)))
    if not found.all():
        X, Y = points[np.argmin(found)]
        raise MeshError(f"the point X/a = {X:g}, Y/a = {Y:g} lies outside the mesh")
    cells = np.unique(held.cell)
    u = values(cells)
    gradients = np.zeros((len(points), 2, 2, u.shape[-1]))
    grid, nodes = tensor_order(space.reference_nodes)
    for cell, nodal in zip(cells, u[:, grid]):
        here = held.cell == cell
        in_plane = gradients_in_plane(vertices[cell], nodes, held.t[here], nodal)
        np.add.at(gradients, held.point[here], in_plane)
    # On the border between cells the gradient jumps; it is their mean.
    gradients = space.comm.allreduce(gradients) / found[:, None, None, None]
    return chart.physical_gradients(x, gradients)


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
    cell, point = _near(vertices, x)
    t = _pull_back(vertices[cell], x[point])
    inside = np.all((t >= -_SLACK) & (t <= 1.0 + _SLACK), axis=1)
    return _Held(point[inside], cell[inside], t[inside])


def _near(vertices: NDArray, x: NDArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of a cell and a point within the smallest box around it."""
    low, high = vertices.min(axis=1), vertices.max(axis=1)
    slack = _SLACK * (high - low)
    low, high = low - slack, high + slack
    order = np.argsort(x[:, 0], kind="stable")
    along, across = x[order].T
    first = np.searchsorted(along, low[:, 0], side="left")
    last = np.searchsorted(along, high[:, 0], side="right")
    cell, point = [np.empty(0, dtype=np.int64)], [np.empty(0, dtype=np.int64)]
    for i in np.flatnonzero(first < last):
        some = slice(first[i], last[i])
        found = order[some][(low[i, 1] <= across[some]) & (across[some] <= high[i, 1])]
        cell.append(np.full(len(found), i))
        point.append(found)
    return np.concatenate(cell), np.concatenate(point)


def _pull_back(vertices: NDArray, x: NDArray) -> NDArray[np.float64]:
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
