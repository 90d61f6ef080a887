"""Displacement fields of the half-plane on its surface and inside it, and the stresses by them.

On the surface Y = 0 displacements are piecewise polynomials, gathered from all ranks. Inside, gradients
of combinations of fields are evaluated at any points: inner unknowns were condensed, and are recovered
for the cells that hold a point, and for no other.

:class:`Displacement` has the stresses of one speed. Next to free ends of a contact, or to knots of a
prescribed pressure, slopes may be continued from a little farther away, where finite elements have more
digits.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from petsc4py import PETSc

from ..approximation import lagrange
from ..contact.solution import Task
from ..contact.stresses import Surface
from ..errors import MeshError
from ..solids.half_plane import HalfPlane
from .cells import gradients_in_plane, pull_back, tensor_order
from .space import Space

#: Distance over a facet's length within which a point counts as between it and the one on the left.
_BETWEEN = 1e-9


def unit_facet(s: NDArray) -> NDArray[np.float64]:
    """Places of nodes on the unit facet, (p+1,), by those of all facets, (F, p+1), from the widest."""
    widest = s[np.argmax(s[:, -1] - s[:, 0])]
    return np.asarray((widest - widest[0]) / (widest[-1] - widest[0]))


@dataclass(frozen=True)
class SurfaceTrace:
    """Displacements of several fields along the surface, the same on every rank.

    Attributes:
        s: surface coordinates of the nodes of each facet in order of X, (F, p+1).
        u: displacements there, over Na/(2aμ), (F, p+1, 2, fields).
    """

    s: NDArray[np.float64]
    u: NDArray[np.float64]

    def derivative(self, s: ArrayLike) -> NDArray[np.float64]:
        """du/ds and dv/ds of every field at surface coordinates ``s``: (n, 2, fields).

        Between two facets they jump; there the right facet's values are taken.
        """
        by_node, u, length = self._around(s)
        # The motion of a facet has no derivative, but its rounding over a small length would be one.
        return np.einsum("ni,ni...->n...", by_node, u - u[:, :1]) / length[:, None, None]

    def rounding(self, s: ArrayLike) -> NDArray[np.float64]:
        """Error by rounding of du/ds and dv/ds of every field at ``s``: (n, 2, fields)."""
        by_node, u, length = self._around(s)
        worst = np.einsum("ni,ni...->n...", np.abs(by_node), np.abs(u)) / length[:, None, None]
        return np.finfo(float).eps * worst

    def _around(self, s: ArrayLike) -> tuple[NDArray, NDArray, NDArray]:
        """Derivatives by nodal values of the facets at ``s``, these values, and the facets' lengths."""
        s = np.asarray(s, dtype=float)
        first = self.s[:, 0] - _BETWEEN * (self.s[:, -1] - self.s[:, 0])
        facet = np.maximum(np.searchsorted(first, s, side="right") - 1, 0)
        start, length = self.s[facet, 0], self.s[facet, -1] - self.s[facet, 0]
        _, by_node = lagrange(unit_facet(self.s), (s - start) / length)
        return by_node, self.u[facet], length


@dataclass(frozen=True)
class Slopes:
    """Derivatives along X, on the surface, of combinations of displacement fields.

    Attributes:
        basis: μ u,X and μ v,X of every field over N/(2a), (2, n, fields).
        noise: error of the former by rounding, (n, fields).
    """

    basis: NDArray[np.float64]
    noise: NDArray[np.float64]

    def of(self, weights: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """μ u,X and μ v,X over N/(2a) of combinations with weights (states, fields): (states, n)."""
        u_X, v_X = (weights @ slopes[:, : weights.shape[1]].T for slopes in self.basis)
        return u_X, v_X

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        """Error by rounding of μ u,X of combinations with weights (states, fields): (states, n)."""
        return np.abs(weights) @ self.noise[:, : weights.shape[1]].T

    def continued(self, of_samples: NDArray) -> "Slopes":
        """Slopes at other places, (m,), by a matrix that continues those at these, (m, n)."""
        return Slopes(of_samples @ self.basis, np.abs(of_samples) @ self.noise)


def surface_slopes(space: Space, fields: Sequence[PETSc.Vec], X: NDArray) -> Slopes:
    """Slopes of displacement fields over N/(2μ) at positions X over a. Collective."""
    s = space.chart.surface_coordinate(X)
    stretch = space.chart.surface_stretch(s)[:, None]
    trace = gather(space, fields)
    basis = np.moveaxis(trace.derivative(s), 1, 0) / stretch
    return Slopes(basis, trace.rounding(s)[:, 0] / stretch)


def gather(space: Space, fields: Sequence[PETSc.Vec]) -> SurfaceTrace:
    """Trace of displacement fields on the whole surface. Collective."""
    nodes, s = space.surface_facets(("contact", "free surface"))
    parts = space.comm.allgather((s, space.fetch(fields, space.numbers[nodes])))
    s = np.concatenate([part[0] for part in parts])
    order = np.argsort(s[:, 0])
    return SurfaceTrace(s[order], np.concatenate([part[1] for part in parts])[order])


#: How far outside a cell, over its size, a point still counts as inside.
_SLACK = 1e-9

#: Points whose gradients are held at once.
TOGETHER = 4_000


#: Values of fields at all nodes of some of this rank's cells, (cells, nodes, 2, fields). Collective.
Values = Callable[[NDArray[np.int64]], NDArray]


class KeptValues:
    """Values of condensed fields in this rank's cells, computed once for each cell.

    Args:
        space: the finite element space.
        response: that the fields are solutions for.
        fields: displacements over N/(2μ), condensed.
    """

    def __init__(self, space: Space, response: HalfPlane, fields: Sequence[PETSc.Vec]) -> None:
        self._compute = lambda cells: space.cell_values(fields, response, cells)
        self._kept: dict[int, NDArray] = {}

    def __call__(self, cells: NDArray[np.int64]) -> NDArray[np.float64]:
        """Values at all nodes of cells, (cells, nodes, 2, fields). Collective."""
        new = np.array([cell for cell in cells.tolist() if cell not in self._kept], dtype=np.int64)
        values = self._compute(new)
        self._kept |= dict(zip(new.tolist(), values))
        return np.array([self._kept[cell] for cell in cells.tolist()]).reshape(-1, *values.shape[1:])


class Gradients:
    """Displacement gradients at given points, by those of the fields; kept where the points are few.

    Args:
        batches: for some points after others, μ ∂u_i/∂X_j over N/(2a) of every field, (n, 2, 2, fields).
    """

    def __init__(self, batches: Sequence[Callable[[], NDArray]]) -> None:
        self._batches = batches
        if len(batches) == 1:
            basis = batches[0]()
            self._batches = [lambda: basis]

    def of_fields(self) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over N/(2a) of every field, (n, 2, 2, fields), the same on every rank."""
        return np.concatenate([batch() for batch in self._batches])

    def of(self, weights: NDArray) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over N/(2a) of combinations with weights (states, fields): (states, n, 2, 2)."""
        return np.concatenate([gradients for _, gradients in self.by_batches(weights)], axis=1)

    def by_batches(self, weights: NDArray) -> Iterator[tuple[slice, NDArray[np.float64]]]:
        """Slices of m points in turn, and gradients there as of :meth:`of`, (states, m, 2, 2).

        Collective.
        """
        first = 0
        for batch in self._batches:
            basis = batch()[..., : weights.shape[1]]
            yield slice(first, first + len(basis)), np.einsum("nijf,sf->snij", basis, weights)
            first += len(basis)


class InteriorGradients(Gradients):
    """Displacement gradients along X and Y at given points by the fields' values at nodes.

    Args:
        space: the finite element space.
        response: that the fields are solutions for.
        values: of the fields in cells, over N/(2μ), such as :class:`KeptValues`.
        points: positions over a with Y <= 0, (n, 2).
        side: 1 for the solid above an interface at its points, -1 for that below.

    Raises:
        MeshError: a point lies outside the mesh.
    """

    def __init__(
        self, space: Space, response: HalfPlane, values: Values, points: NDArray, side: int = 1
    ) -> None:
        firsts = range(0, max(len(points), 1), TOGETHER)
        batches = [points[first : first + TOGETHER] for first in firsts]
        super().__init__([_at_points(space, response, values, batch, side) for batch in batches])


def _at_points(
    space: Space, response: HalfPlane, values: Values, points: NDArray, side: int
) -> Callable[[], NDArray]:
    """Function that evaluates gradients at points, which are located now; see :class:`InteriorGradients`.

    Raises:
        MeshError: a point lies outside the mesh.
    """
    chart, comm, vertices = space.contracted(response), space.comm, space.vertices[..., :2]
    grid, nodes = tensor_order(space.reference_nodes)
    cell, point, t = _located(vertices, chart.from_physical(points))
    of_cells = response.solids(vertices[..., 1].mean(axis=1))
    of_points = response.solids(points[:, 1], side)
    order = np.argsort(cell, kind="stable")
    order = order[(of_cells[cell] == of_points[point])[order]]
    cell, point, t = cell[order], point[order].astype(np.int32), t[order]
    cells, firsts = np.unique(cell, return_index=True)
    count = comm.allreduce(np.bincount(point, minlength=len(points)))
    if not count.all():
        X, Y = points[np.argmin(count)]
        raise MeshError(f"the point X/a = {X:g}, Y/a = {Y:g} lies outside the mesh")
    #: How many cells hold a point, which are many on a border only.
    sharing = count.astype(np.int16)

    def gradients() -> NDArray[np.float64]:
        u = values(cells)[:, grid]
        result = np.zeros((len(points), 2, 2, u.shape[-1]))
        for first, each in zip(firsts, gradients_in_plane(vertices[cell], nodes, t, firsts, u)):
            # A cell holds a point once.
            result[point[first : first + len(each)]] += each
        # On the border between cells the gradient jumps; the mean of both is taken.
        result = comm.allreduce(result) / sharing[:, None, None, None]
        return chart.physical_gradients(chart.from_physical(points), result)

    return gradients


def _located(vertices: NDArray, x: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Pairs of a cell and a point of the chart that it holds, and the point's place in the unit square.

    Returns:
        Numbers of cells (m,) and points (m,), places (m, 2).
    """
    low, high = vertices.min(axis=1), vertices.max(axis=1)
    slack = _SLACK * (high - low)
    low, high = low - slack, high + slack
    order = np.argsort(x[:, 0], kind="stable")
    along, across = x[order].T
    first = np.searchsorted(along, low[:, 0], side="left")
    last = np.searchsorted(along, high[:, 0], side="right")
    # Points in the smallest box around each cell: in its stretch of the first axis, then of the second.
    count = last - first
    cell = np.repeat(np.arange(len(vertices)), count)
    at = np.arange(len(cell)) + np.repeat(first - np.cumsum(count) + count, count)
    inside = (low[cell, 1] <= across[at]) & (across[at] <= high[cell, 1])
    cell, point = cell[inside], order[at[inside]]
    t = pull_back(vertices[cell], x[point])
    held = np.all((t >= -_SLACK) & (t <= 1.0 + _SLACK), axis=1)
    return cell[held], point[held], t[held]


class Displacement:
    """Stresses of combinations of displacement fields; each derivative is taken once, when first needed.

    Args:
        task: the speed, and the places.
        space: the finite element space.
        fields: displacements over N/(2μ).
        slopes: slopes of the fields along X on the surface, from a fit; computed if None.
        continuation: gives, for places X over a on the surface, the samples of slopes that are needed,
            and the map from slopes there to slopes at the places; None for slopes at the places.
        gradients: gives gradients of the fields at points (n, 2), see :class:`Gradients`, where these are
            no fields of a space.
    """

    def __init__(
        self, task: Task, space: Any = None, fields: Sequence[Any] = (),
        slopes: Slopes | None = None,
        continuation: Callable[[NDArray], tuple[NDArray, NDArray]] | None = None,
        gradients: Callable[[NDArray], NDArray] | None = None,
    ) -> None:  # fmt: skip
        self._task, self._space, self._fields, self._continuation = task, space, fields, continuation
        self._gradients = gradients
        self._kept: dict[tuple[int, int], Gradients] = {}
        if slopes is not None:
            self.slopes = slopes

    @cached_property
    def slopes(self) -> Slopes:
        """Slopes of the fields along X at the places on the surface."""
        X = self._task.places.X
        if self._gradients is not None:
            basis = self._gradients(np.column_stack([X, np.zeros(len(X))]))[:, :, 0]
            return Slopes(np.moveaxis(basis, 1, 0), np.zeros((len(X), basis.shape[-1])))
        if self._continuation is None:
            return surface_slopes(self._space, self._fields, X)
        samples, of_samples = self._continuation(X)
        return surface_slopes(self._space, self._fields, samples).continued(of_samples)

    def strains(self, X: NDArray, weights: NDArray) -> NDArray[np.float64]:
        """Strain μ u,X over N/(2a) at X on the surface, by weights (states, fields): (states, n)."""
        return surface_slopes(self._space, self._fields, X).of(weights)[0]

    @cached_property
    def _values(self) -> KeptValues:
        return KeptValues(self._space, self._task.response, self._fields)

    @cached_property
    def _along(self) -> list[NDArray[np.float64]]:
        """Points along each interface, (n, 2)."""
        places = self._task.places
        return [
            np.column_stack([places.along, np.full_like(places.along, -depth)])
            for depth in places.interfaces
        ]

    def _at(self, points: NDArray, side: int = 1) -> Gradients:
        """Gradients at points (n, 2), above an interface (side 1) or below it (-1)."""
        if self._gradients is not None:
            return Gradients([partial(self._gradients, points)])
        return InteriorGradients(self._space, self._task.response, self._values, points, side)

    def _stresses(self, points: NDArray, weights: NDArray, side: int = 1) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, states, n), at points of the task, (n, 2); gradients are kept."""
        key = id(points), side
        if key not in self._kept:
            self._kept[key] = self._at(points, side)
        σ = np.empty((3, len(weights), len(points)))
        for batch, gradients in self._kept[key].by_batches(weights):
            σ[:, :, batch] = self._task.response.stresses_at(points[batch, 1], gradients, side)
        return σ

    def surface(
        self, ratio: NDArray, weights: NDArray, σ_YY: NDArray, raw: NDArray | None = None
    ) -> Surface:
        """Stresses on the surface, by weights (states, fields) and σ_YY, (states, n) or (n,).

        Args:
            ratio: σ_XY/σ_YY, (states, n) or (states, 1).
            weights, σ_YY, raw: of the states.
        """
        u_X, v_X = self.slopes.of(weights)
        places = self._task.places
        σ = np.where(places.under, σ_YY, 0.0)
        σ_XX = self._task.response.σ_XX(u_X, σ, ratio * σ)
        σ_YY = np.broadcast_to(np.where(places.under, σ_YY, np.nan), σ_XX.shape)
        return Surface(places, σ_YY, σ_XX, raw, v_X)

    def inside(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY inside by weights (states, fields), (3, states, m)."""
        return self._stresses(self._task.places.points, weights)

    def around(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at the points checked for yield, (3, states, k)."""
        return self._stresses(self._task.places.around, weights)

    def at(self, points: NDArray, weights: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, states, n), at points (1, n, 2) of all states or (states, n, 2)."""
        flat, response = points.reshape(-1, 2), self._task.response
        gradients = self._at(flat)
        if len(points) == 1:
            return response.stresses_at(flat[:, 1], gradients.of(weights))
        (states, n, _), fields = points.shape, weights.shape[1]
        of_states = gradients.of_fields()[..., :fields].reshape(states, n, 2, 2, fields)
        each = np.einsum("snijf,sf->snij", of_states, weights)
        return response.stresses_at(flat[:, 1], each.reshape(1, -1, 2, 2)).reshape(3, states, n)

    def interfaces(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n).

        Tractions, which both sides share, are taken from the softer side rather than from the stiffer,
        whose other stresses may be large beside them: each side's weight goes with the other's modulus.
        """
        each = [
            self._tractions_first(i, partial(self._stresses, points, weights))
            for i, points in enumerate(self._along)
        ]
        return np.stack(each, axis=2)

    def at_interface(self, i: int, X: NDArray, weights: NDArray) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below interface ``i`` at positions X, (n,): (4, states, n)."""
        points = np.column_stack([X, np.full_like(X, -self._task.places.interfaces[i])])
        return self._tractions_first(
            i, lambda side: self._task.response.stresses_at(
                points[:, 1], self._at(points, side).of(weights), side
            )
        )  # fmt: skip

    def _tractions_first(self, i: int, stresses: Callable[[int], NDArray]) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below an interface by σ_XX, σ_YY, σ_XY on a side of it."""
        above, below = stresses(1), stresses(-1)
        upper, lower = self._task.body.solid.beside(i)  # type: ignore[attr-defined]
        share = lower.μ / (upper.μ + lower.μ)
        tractions = share * above[1:] + (1.0 - share) * below[1:]
        return np.array([*tractions, above[0], below[0]])

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        """Effect of rounding of the fields on σ_XX on the surface, (states, n)."""
        noise = self.slopes.rounding(weights)
        return np.abs(self._task.response.σ_XX(noise, 0.0 * noise, 0.0 * noise))
