"""Quadrilateral cells: places, shape functions and derivatives in a cell, its chart, congruent cells.

A cell is the bilinear image of the unit square; its vertices come in dolfinx's order 00, 10, 01, 11. Its
shape functions are products of Lagrange polynomials.

:class:`Contracted` is the chart in which a mesh is drawn, as speed contracts it.

Cells that are another cell, moved and scaled, have the same matrix in a plane: the energy of a
displacement does not change where lengths are scaled, nor does that of pressures over a cell's size.
Rings around an edge, each a share of the one outside it, and cells of one size cut from a larger one need
one matrix each kind, not one each cell (:func:`model_cells`).
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.charts import Chart

from ..approximation import lagrange
from ..solids.half_plane import HalfPlane


@dataclass(frozen=True)
class Contracted:
    """A chart of the plane X' = X + Re(p) Y, Y' = Im(p) Y instead of the physical one.

    A solid's fields live in two such planes, where their parts are analytic; isotropic ones at rest
    in the physical plane. Speed contracts them, and a mesh that follows sees fields like those at rest.
    The surface stays where it is.

    Attributes:
        chart: the chart.
        p: of the contraction, Im p > 0; 1j for none.
    """

    chart: Chart
    p: complex

    def to_physical(self, x: NDArray) -> NDArray[np.float64]:
        """Physical coordinates over a of points (..., 2) of the chart."""
        drawn = self.chart.to_physical(x)
        Y = drawn[..., 1] / self.p.imag
        return np.stack([drawn[..., 0] - self.p.real * Y, Y], axis=-1)

    def from_physical(self, X: NDArray) -> NDArray[np.float64]:
        """Points of the chart, (..., 2), of physical coordinates over a with Y <= 0."""
        X = np.asarray(X, dtype=float)
        return self.chart.from_physical(
            np.stack([X[..., 0] + self.p.real * X[..., 1], self.p.imag * X[..., 1]], axis=-1)
        )

    def physical_gradients(self, x: NDArray, gradients: NDArray) -> NDArray[np.float64]:
        """Derivatives along X and Y from those along the chart's axes, at its points x (n, 2).

        Args:
            x: points of the chart; not at a punch edge of a chart whose stretch vanishes there.
            gradients: array (n, component, axis, fields).
        """
        axes = self.axes(x) / self.chart.stretch(x)[:, None, None]
        return np.einsum("ncxf,nxX->ncXf", gradients, axes, optimize=True)

    def axes(self, x: NDArray) -> NDArray[np.float64]:
        """Matrices Rᵀ·M from the chart's axes to X and Y, but for the stretch, at x (n, 2): (n, 2, 2)."""
        with np.errstate(invalid="ignore"):  # at an end itself there is none
            cos, sin = (value * np.ones(len(x)) for value in self.chart.rotation(x.T))
        M = np.array([[1.0, self.p.real], [0.0, self.p.imag]])
        return np.array([[cos, sin], [-sin, cos]]).transpose(2, 0, 1) @ M


#: Step of Newton's method, over the cell's size, after which the next would change no digit: convergence
#: is quadratic. In small cells beside X = -a rounding alone makes steps of 1e-12, so it is no smaller.
_SETTLED = 1e-8


def image(vertices: NDArray, t: NDArray) -> NDArray[np.float64]:
    """Points of the mesh's chart at places t (..., 2) of the unit square: (..., 2)."""
    a, b = t[..., 0], t[..., 1]
    return np.stack([(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b], axis=-1) @ vertices


def jacobian(vertices: NDArray, t: NDArray) -> NDArray[np.float64]:
    """∂x/∂t at places t (..., 2) as [..., component of x, component of t].

    ``vertices`` are those of a single cell, (4, 2), or of a cell at each place, (..., 4, 2).
    """
    a, b = t[..., :1], t[..., 1:]
    v00, v10, v01, v11 = (vertices[..., i, :] for i in range(4))
    by_a = (1 - b) * (v10 - v00) + b * (v11 - v01)
    by_b = (1 - a) * (v01 - v00) + a * (v11 - v10)
    return np.stack([by_a, by_b], axis=-1)


def pull_back(vertices: NDArray, x: NDArray) -> NDArray[np.float64]:
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


def tensor_order(reference: NDArray) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Local nodes as a grid [i, j] along the two directions of the unit square, and their places."""
    n = round(np.sqrt(len(reference)))
    grid = np.lexsort(np.round(reference, 9).T[::-1]).reshape(n, n)
    return grid, reference[grid[:, 0], 0]


def reference_values(nodes: NDArray, t: NDArray, u: NDArray) -> NDArray[np.float64]:
    """Values at places t (n, 2) of nodal values u (p+1, p+1, ...): (n, ...)."""
    value_a, value_b = (lagrange(nodes, t[:, i])[0] for i in (0, 1))
    return np.einsum("ni,nj,ij...->n...", value_a, value_b, u, optimize=True)


def gradients_in_plane(
    vertices: NDArray, nodes: NDArray, t: NDArray, firsts: Sequence[int], u: Iterable[NDArray]
) -> Iterator[NDArray[np.float64]]:
    """Derivatives along the axes of the mesh's chart, at places t (n, 2) in cells, of displacements.

    Args:
        vertices: of the cell of each place, (n, 4, 2), or of a single cell, (4, 2).
        nodes: places of the cells' nodes along one direction, (p+1,).
        t: places in the unit square, those of a cell after each other.
        firsts: number of the first place of each cell, (cells,).
        u: nodal displacements in each cell, (p+1, p+1, 2, fields).

    Yields:
        Of each cell in turn, (its places, component, axis, fields).
    """
    (value_a, slope_a), (value_b, slope_b) = (lagrange(nodes, t[:, i]) for i in (0, 1))
    n, inverse = len(nodes), np.linalg.inv(jacobian(vertices, t))
    for first, end, own in zip(firsts, [*firsts[1:], len(t)], u):
        # Nodes along the second direction come last: the inner sum runs over contiguous memory.
        lines, at = np.moveaxis(own.reshape(n, n, -1), 1, 2).reshape(n, -1), slice(first, end)
        along = [
            np.einsum("nfj,nj->nf", (a[at] @ lines).reshape(end - first, -1, n), b[at])
            for a, b in ((slope_a, value_b), (value_a, slope_b))
        ]
        by_direction = np.stack(along, axis=1).reshape(end - first, 2, *own.shape[2:])
        yield np.einsum("nrcf,nrx->ncxf", by_direction, inverse[at])


#: Digits of a shape by which cells that may be congruent are grouped, before they are compared.
_DIGITS = 3

#: Largest distance between vertices of congruent cells, in roundings.
_ROUNDINGS = 64.0


#: Parts of every rank, in the order of ranks, from the part of one.
Gather = Callable[[Any], list[Any]]


def congruent_cells(
    corners: NDArray, kinds: NDArray, gather: Gather = lambda part: [part]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Cells that stand for all cells congruent to them but for size, and the model of each cell.

    The largest cell of each kind is its model, on whichever rank it lies: next to a punch edge small
    cells have few digits of their shape, so matrices by one of them would depend on which rank has it.

    Args:
        corners: vertices of this rank's cells, (n, 4, 2 or 3).
        kinds: whole numbers that differ where cells differ in more than their shape, (n,).
        gather: collects parts of all ranks; collective where the mesh is shared.

    Returns:
        Vertices of models, (m, 4, 2 or 3), and a place among these for each cell, (n,).
    """
    n = len(corners)
    first, _ = _largest(corners, kinds)
    corners = np.concatenate([corners, *gather(corners[first])])
    largest, group = _largest(corners, np.concatenate([kinds, *gather(kinds[first])]))
    model = largest[group[:n]]
    shape, size = _shapes(corners)
    # Vertices of a small cell far from the origin have few digits of its shape.
    rounding = np.finfo(float).eps * np.abs(corners[:n]).max(axis=(1, 2)) / size[:n]
    alone = np.abs(shape[:n] - shape[model]).max(axis=1) > _ROUNDINGS * rounding
    model[alone] = np.flatnonzero(alone)
    models, like = np.unique(model, return_inverse=True)
    return corners[models], like


def _shapes(corners: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Vertices relative to the first one over a cell's size, (n, 8 or 12), and the sizes, (n,)."""
    relative = (corners - corners[:, :1]).reshape(len(corners), math.prod(corners.shape[1:]))
    size = np.abs(relative).max(axis=1)
    return relative / size[:, None], size


def _largest(corners: NDArray, kinds: NDArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Numbers of the largest of the cells that seem congruent, (groups,), and the group of each, (n,)."""
    shape, size = _shapes(corners)
    key = np.column_stack([kinds, np.round(shape * 10**_DIGITS)])
    _, group = np.unique(key, axis=0, return_inverse=True)
    # Of equal sizes the same one, in whatever order ranks have them.
    order = np.lexsort([*corners.reshape(shape.shape).T, -size, group])
    return order[np.flatnonzero(np.diff(group[order], prepend=-1))], group


def model_cells(
    corners: NDArray, response: HalfPlane, constants: Sequence[str], gather: Gather = lambda part: [part]
) -> tuple[NDArray[np.float64], list[NDArray[np.int64]]]:
    """Model cells, whose matrices are those of all cells in a plane, and the cells that have each matrix.

    Args:
        corners: vertices of this rank's cells in the chart, (n, 4, 3).
        response: of the half-plane.
        constants: names of the weak form's constants.
        gather: as in :func:`congruent_cells`.

    Returns:
        Vertices of models, (m, 4, 3), and the numbers of this rank's cells like each.
    """
    kinds = response.solids(corners[..., 1].mean(axis=1))
    graded = np.array([len(rows) > 1 for rows in response.constants(constants)])[kinds]
    even = np.flatnonzero(~graded)
    models, like = congruent_cells(corners[even], kinds[even], gather)
    members = np.split(even[np.argsort(like, kind="stable")], np.cumsum(np.bincount(like))[:-1])
    # A cell of a graded solid is like no other.
    own = np.flatnonzero(graded)
    return np.concatenate([models, corners[own]]), [*members[: len(models)], *own[:, None]]
