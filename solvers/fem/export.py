"""Displacement fields for export: pictures of the solid, and functions of dolfinx.

For a picture of the solid a combination of condensed fields is sampled over whole cells
(:class:`SampledField`). Cells of high degree are cut into small quadrilaterals, polygons along the sides
of a box. Each cell has points of its own, since stresses jump from cell to cell.

For users who go on in dolfinx a displacement is exported as a dolfinx function on a mesh of the physical
plane (:func:`in_physical_plane`). The program's own meshes are drawn in charts; in the exported mesh
every cell is curved as the chart bends it, by polynomials of the degree of the displacement, whose nodal
values stay the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from dolfinx import fem
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from ..solids.half_plane import HalfPlane
from . import versions
from .cells import Contracted, gradients_in_plane, image, pull_back, reference_values, tensor_order
from .space import Space


def clipped(corners: NDArray, extent: float) -> NDArray[np.float64]:
    """The part of a convex polygon with |X| <= extent and Y >= -extent.

    Args:
        corners: in turn, over a, (k, 2).
        extent: over a.

    Returns:
        Its corners in turn, (n, 2); none where nothing remains.
    """
    polygon = corners
    for axis, bound, sign in ((0, extent, 1.0), (0, -extent, -1.0), (1, -extent, -1.0)):
        beyond, kept = sign * (polygon[:, axis] - bound), []
        for i, corner in enumerate(polygon):
            before, after = beyond[i - 1], beyond[i]
            if before * after < 0.0:
                crossing = polygon[i - 1] + before / (before - after) * (corner - polygon[i - 1])
                crossing[axis] = bound
                kept.append(crossing)
            if after <= 0.0:
                kept.append(corner)
        polygon = np.reshape(kept, (-1, 2))
    return polygon


def in_physical_plane(
    space: Space,
    response: HalfPlane,
    fields: Sequence[PETSc.Vec],
    weights: NDArray,
    length: float,
    displacement: float,
) -> Any:
    """A combination of displacement fields as a dolfinx function in the physical plane; on one rank only.

    Args:
        space: the finite element space.
        response: that the fields are solutions for.
        fields: displacements over N/(2μ), condensed.
        weights: of the first of the fields, or of all.
        length: a, in the unit of the mesh.
        displacement: N/(2μ), in the unit of the displacement.

    Returns:
        A dolfinx ``Function`` of two components, named displacement; its space and mesh come with it.
    """
    vertices, reference = space.vertices[..., :2], space.reference_nodes
    _, side = tensor_order(reference)
    # Spaced evenly as in all versions of dolfinx's own cells.
    nodes = np.abs(reference[..., None] - side).argmin(axis=-1) / (len(side) - 1.0)
    cells = versions.cell_nodes(space.V)
    places = np.empty((cells.max() + 1, 2))
    places[cells] = space.contracted(response).to_physical(image(vertices, nodes))
    mesh = versions.create_mesh(space.comm, cells.astype(np.int64), length * places, space.degree)
    field, numbers = _combination(fields, weights), np.arange(len(vertices))
    values = displacement * np.concatenate([
        space.cell_values([field], response, numbers[piece])[..., 0]
        for piece in space.pieces(len(numbers))
    ])  # fmt: skip
    field.destroy()
    function = fem.Function(
        versions.space(mesh, versions.vector_element(space.degree)), name="displacement"
    )
    # dolfinx evaluates it at all nodes of one cell after the other.
    function.interpolate(lambda x: values[mesh.topology.original_cell_index].reshape(-1, 2).T)
    function.x.scatter_forward()
    return function


def _combination(fields: Sequence[PETSc.Vec], weights: NDArray) -> PETSc.Vec:
    """Sum of the first of the fields, or of all, with weights (fields,)."""
    field = fields[0].duplicate()
    field.zeroEntries()
    field.maxpy(weights.tolist(), list(fields[: len(weights)]))
    return field


#: Share of a cell's largest stretch below which a point is a punch edge; the next point has about 1/n.
_VANISHING = 1e-6


@dataclass(frozen=True)
class SampledField:
    """A displacement field at the corners of small quadrilaterals.

    Attributes:
        points: positions over a, (n, 2).
        quads: points of each quadrilateral counterclockwise, (m, 4); a triangle's last is doubled.
        displacement: over N/(2μ), (n, 2).
        gradient: μ ∂u_i/∂X_j over N/(2a), (n, 2, 2).
    """

    points: NDArray[np.float64]
    quads: NDArray[np.int64]
    displacement: NDArray[np.float64]
    gradient: NDArray[np.float64]


def sample(
    space: Space,
    response: HalfPlane,
    fields: Sequence[PETSc.Vec],
    weights: NDArray,
    extent: float,
    n: int,
) -> SampledField:
    """This rank's piece of a combination of fields, in the part |X|, |Y| <= extent of the solid.

    Collective. Quadrilaterals that reach beyond that part are cut along its sides.

    Args:
        space: the finite element space.
        response: that the fields are solutions for.
        fields: displacements over N/(2μ), condensed.
        weights: of the first of the fields, or of all.
        extent: half the width, and the depth, of what is sampled, over a.
        n: quadrilaterals along each side of a cell, about the degree.
    """
    t, corners = _split(n)
    vertices = space.vertices[..., :2]
    chart = space.contracted(response)
    X = chart.to_physical(image(vertices, t))
    low, high = (bound(X[:, corners], axis=2) for bound in (np.min, np.max))
    touched = np.all((low < extent) & (high > -extent), axis=2)
    whole = np.all((low >= -extent) & (high <= extent), axis=2)
    cells = np.flatnonzero(touched.any(axis=1))
    field = _combination(fields, weights)
    grid, nodes = tensor_order(space.reference_nodes)
    pieces = []
    for piece in space.pieces(space.comm.allreduce(len(cells), MPI.MAX)):
        numbers = cells[piece]
        for cell, u in zip(numbers, space.cell_values([field], response, numbers)[:, grid]):
            crossing = corners[touched[cell] & ~whole[cell]]
            at, cut = _cut(chart, vertices[cell], t, crossing, extent)
            used, quads = np.unique(np.concatenate([corners[whole[cell]], cut]), return_inverse=True)
            displacement = reference_values(nodes, at, u)[..., 0]
            gradient = _gradients(chart, vertices[cell], nodes, at, u, n)
            points = chart.to_physical(image(vertices[cell], at))
            pieces.append(
                SampledField(points[used], quads.reshape(-1, 4), displacement[used], gradient[used])
            )
    field.destroy()
    return joined(pieces)


def _split(n: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The unit square cut into n x n: its (n+1)² points, and the corners of each part in turn."""
    side = np.linspace(0.0, 1.0, n + 1)
    t = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    number = np.arange(len(t)).reshape(n + 1, n + 1)
    around = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
    return t, np.stack(around, axis=-1).reshape(-1, 4)


def _cut(
    chart: Contracted, vertices: NDArray, t: NDArray, quads: NDArray, extent: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A cell's quadrilaterals cut along a box: points of the unit square, new ones last, and quads."""
    points, cut, count = [t], [np.empty((0, 4), dtype=np.int64)], len(t)
    for corners in chart.to_physical(image(vertices, t[quads])):  # counterclockwise, as all cells are
        polygon = clipped(corners, extent)
        if (last := len(polygon) - 1) >= 2:
            cells = np.broadcast_to(vertices, (len(polygon), 4, 2))
            points.append(pull_back(cells, chart.from_physical(polygon)))
            parts = [(0, i, min(i + 1, last), min(i + 2, last)) for i in range(1, last, 2)]
            cut.append(count + np.array(parts))  # the last corner of a triangle is doubled
            count += len(polygon)
    return np.concatenate(points), np.concatenate(cut)


def _gradients(
    chart: Contracted, vertices: NDArray, nodes: NDArray, t: NDArray, u: NDArray, n: int
) -> NDArray[np.float64]:
    """Physical displacement gradients of one field at places t of a cell, all finite: (m, 2, 2)."""
    # At a punch edge the chart's stretch is 0 and the stress infinite. What stands there is the stress
    # in the middle of the small quadrilateral at that corner, the mean a viewer would paint it with.
    stretch = chart.chart.stretch(image(vertices, t))
    at_edge = stretch < _VANISHING * stretch.max()
    t = np.where(at_edge[:, None], np.clip(t, 0.5 / n, 1.0 - 0.5 / n), t)
    (gradients,) = gradients_in_plane(vertices, nodes, t, [0], [u])
    return chart.physical_gradients(image(vertices, t), gradients)[..., 0]


def joined(pieces: Sequence[SampledField]) -> SampledField:
    """All pieces in one, in their order."""
    first = np.cumsum([0, *(len(piece.points) for piece in pieces)])
    return SampledField(
        np.concatenate([np.empty((0, 2)), *(piece.points for piece in pieces)]),
        np.concatenate(
            [np.empty((0, 4), dtype=np.int64), *(piece.quads + k for piece, k in zip(pieces, first))]
        ),
        np.concatenate([np.empty((0, 2)), *(piece.displacement for piece in pieces)]),
        np.concatenate([np.empty((0, 2, 2)), *(piece.gradient for piece in pieces)]),
    )
