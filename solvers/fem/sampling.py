"""A combination of condensed fields, sampled over whole cells: what a picture of the solid shows.

Cells of high degree are cut into small quadrilaterals. Each cell has points of its own, since stresses
jump from cell to cell.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem.cells import (
    gradients_in_plane,
    image,
    pull_back,
    reference_values,
    tensor_order,
)
from galinx.solvers.fem.chart import Contracted
from galinx.solvers.fem.clipping import clipped, in_quads
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import Response

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

    def gathered(self, comm: MPI.Comm) -> "SampledField | None":
        """The pieces of all ranks in one, on rank 0; None on the others. Collective."""
        pieces = comm.gather(self)
        return None if pieces is None else _joined(pieces)


def sample(
    space: Space,
    response: Response,
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
    wanted = np.all((low < extent) & (high > -extent), axis=2)
    whole = np.all((low >= -extent) & (high <= extent), axis=2)
    cells = np.flatnonzero(wanted.any(axis=1))
    field = fields[0].duplicate()
    field.zeroEntries()
    field.maxpy(weights.tolist(), list(fields[: len(weights)]))
    grid, nodes = tensor_order(space.reference_nodes)
    pieces = []
    for piece in space.pieces(space.comm.allreduce(len(cells), MPI.MAX)):
        some = cells[piece]
        for cell, u in zip(some, space.cell_values([field], response, some)[:, grid]):
            crossing = corners[wanted[cell] & ~whole[cell]]
            at, cut = _cut(chart, vertices[cell], t, crossing, extent)
            quads = np.concatenate([corners[whole[cell]], cut])
            displacement = reference_values(nodes, at, u)[..., 0]
            gradient = _gradients(chart, vertices[cell], nodes, at, u, n)
            points = chart.to_physical(image(vertices[cell], at))
            pieces.append(_without_unused(SampledField(points, quads, displacement, gradient)))
    field.destroy()
    return _joined(pieces)


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
        if len(polygon) >= 3:
            cells = np.broadcast_to(vertices, (len(polygon), 4, 2))
            points.append(pull_back(cells, chart.from_physical(polygon)))
            cut.append(count + in_quads(len(polygon)))
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
    gradients = gradients_in_plane(vertices, nodes, t, u)
    return chart.physical_gradients(image(vertices, t), gradients)[..., 0]


def _without_unused(field: SampledField) -> SampledField:
    """The same without points that no quadrilateral has."""
    used, quads = np.unique(field.quads, return_inverse=True)
    return SampledField(
        field.points[used], quads.reshape(-1, 4), field.displacement[used], field.gradient[used]
    )


def _joined(pieces: Sequence[SampledField]) -> SampledField:
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
