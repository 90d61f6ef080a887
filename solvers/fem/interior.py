"""Displacement gradients inside the half-plane, of combinations of fields, at any points.

Inner unknowns were condensed; they are found again for the cells that hold a point, and for no other.
"""

from collections.abc import Callable, Iterator, Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.errors import MeshError
from galinx.solvers.fem.cells import gradients_in_plane, pull_back, tensor_order
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import ByCells, Response

#: How far outside a cell, over its size, a point still counts as inside.
_SLACK = 1e-9

#: Points whose gradients are held at once: of every field, or of every state.
TOGETHER = 20_000


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
    """Displacement gradients along X and Y at given points, some of them at a time.

    Where they are many, what is kept of the fields are their values at nodes, of which there are fewer.

    Args:
        space: the finite element space.
        response: that the fields are solutions for.
        fields: displacements over N/(2μ), condensed.
        points: positions over a with Y <= 0, (n, 2).
        values: of the fields in cells, as of :class:`KeptValues`; found anew if not given.
        side: at an interface 1 for what is above it, -1 for what is below.

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
        side: int = 1,
    ) -> None:
        values = values or (lambda cells: space.cell_values(fields, response, cells))
        self._count, self._fields = len(points), len(fields)
        self._batches = [
            _Batch(space, response, points[first : first + TOGETHER], side)
            for first in range(0, max(len(points), 1), TOGETHER)
        ]
        cells = np.unique(np.concatenate([batch.cells for batch in self._batches]))
        self._nodal = _Nodal(space, cells, values(cells))
        #: Gradients of all fields, where one batch has all points.
        self._basis: NDArray[np.float64] | None = None
        if len(self._batches) == 1:
            self._basis = self._batches[0].gradients(self._nodal)
            self._nodal = self._nodal.combined(np.empty((0, 0)))  # no longer needed

    def of(self, weights: NDArray) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over N/(2a) of combinations with weights (states, fields): (states, n, 2, 2)."""
        return np.concatenate([found for _, found in self.by_batches(weights)], axis=1)

    def by_batches(self, weights: NDArray) -> Iterator[tuple[slice, NDArray[np.float64]]]:
        """The same, and of which points it is, for some points after the others. Collective."""
        states, fields = weights.shape
        for i, batch in enumerate(self._batches):
            some = slice(i * TOGETHER, min((i + 1) * TOGETHER, self._count))
            if self._basis is None and states < self._fields:
                combined = batch.gradients(self._nodal.combined(weights))
                yield some, np.moveaxis(combined, -1, 0)
            else:
                basis = batch.gradients(self._nodal) if self._basis is None else self._basis
                yield some, np.einsum("nijf,sf->snij", basis[..., :fields], weights)

    def of_each(self, weights: NDArray) -> NDArray[np.float64]:
        """The same where the points are those of the first combination, of the second, and so on.

        Returns:
            Array (states, n/states, 2, 2).
        """
        basis = self._basis
        if basis is None:
            basis = np.concatenate([batch.gradients(self._nodal) for batch in self._batches])
        states, fields = weights.shape
        each = basis[..., :fields].reshape(states, -1, 2, 2, fields)
        return np.einsum("snijf,sf->snij", each, weights)


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
    batch = _Batch(space, response, points)
    return batch.gradients(_Nodal(space, batch.cells, values(batch.cells)))


class _Nodal:
    """Values of fields at the nodes of some cells.

    Args:
        space: the finite element space.
        cells: numbers of this rank's cells, sorted, (m,).
        values: at their local nodes, (m, nodes, 2, fields).

    Attributes:
        nodes: places of the nodes along a side of the unit square, (p+1,).
        values: (m, p+1, p+1, 2, fields).
    """

    def __init__(self, space: Space, cells: NDArray[np.int64], values: NDArray) -> None:
        grid, self.nodes = tensor_order(space.reference_nodes)
        self.cells, self.values = cells, values[:, grid]

    def combined(self, weights: NDArray) -> "_Nodal":
        """Combinations of the fields with weights (states, fields) as fields."""
        other = copy(self)
        other.values = self.values[..., : weights.shape[1]] @ weights.T
        return other

    def of(self, cell: int) -> NDArray[np.float64]:
        """Of one of the cells, (p+1, p+1, 2, fields)."""
        return self.values[np.searchsorted(self.cells, cell)]


class _Batch:
    """Points, and where in this rank's cells they lie.

    Args:
        space: the finite element space.
        response: for which the mesh is contracted.
        points: positions over a with Y <= 0, (n, 2).
        side: see :class:`InteriorGradients`.

    Attributes:
        cells: this rank's cells that hold a point, sorted.

    Raises:
        MeshError: a point lies outside the mesh.
    """

    def __init__(self, space: Space, response: Response, points: NDArray, side: int = 1) -> None:
        self._chart, self._comm = space.contracted(response), space.comm
        self._points, self._vertices = points, space.vertices[..., :2]
        held = _locate(self._vertices, self._chart.from_physical(points))
        if isinstance(response, ByCells):
            of_cells = response.solids(self._vertices[..., 1].mean(axis=1))
            of_points = response.solids(points[:, 1], side)
            held = held.some(of_cells[held.cell] == of_points[held.point])
        order = np.argsort(held.cell, kind="stable")
        self._point, self._t = held.point[order].astype(np.int32), held.t[order]
        self.cells, self._first = np.unique(held.cell[order], return_index=True)
        found = self._comm.allreduce(np.bincount(held.point, minlength=len(points)))
        if not found.all():
            X, Y = points[np.argmin(found)]
            raise MeshError(f"the point X/a = {X:g}, Y/a = {Y:g} lies outside the mesh")
        #: How many cells hold a point, which are many on a border only.
        self._found = found.astype(np.int16)

    def gradients(self, nodal: _Nodal) -> NDArray[np.float64]:
        """Gradients along X and Y, (n, 2, 2, fields), the same on every rank. Collective."""
        result = np.zeros((len(self._points), 2, 2, nodal.values.shape[-1]))
        ends = np.append(self._first[1:], len(self._point))
        for cell, first, end in zip(self.cells, self._first, ends):
            # A cell holds a point once.
            result[self._point[first:end]] += gradients_in_plane(
                self._vertices[cell], nodal.nodes, self._t[first:end], nodal.of(cell)
            )
        # On the border between cells the gradient jumps; it is their mean.
        result = self._comm.allreduce(result) / self._found[:, None, None, None]
        return self._chart.physical_gradients(self._chart.from_physical(self._points), result)


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

    def some(self, which: NDArray) -> "_Held":
        """Those of the pairs."""
        return _Held(self.point[which], self.cell[which], self.t[which])


def _locate(vertices: NDArray, x: NDArray) -> _Held:
    cell, point = _near(vertices, x)
    t = pull_back(vertices[cell], x[point])
    return _Held(point, cell, t).some(np.all((t >= -_SLACK) & (t <= 1.0 + _SLACK), axis=1))


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
