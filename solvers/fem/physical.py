"""A displacement as a dolfinx function on a mesh of the physical plane, for those who go on in dolfinx.

The program's own meshes are drawn in charts. Here every cell is curved as the chart bends it, by
polynomials of the degree of the displacement, whose nodal values stay the same.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from dolfinx import fem
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem import adapter
from galinx.solvers.fem.cells import image, tensor_order
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import Response


def in_physical_plane(
    space: Space,
    response: Response,
    fields: Sequence[PETSc.Vec],
    weights: NDArray,
    length: float,
    displacement: float,
) -> Any:
    """A combination of displacement fields; on one rank only.

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
    vertices, nodes = space.vertices[..., :2], _evenly(space.reference_nodes)
    cells = adapter.cell_nodes(space.V)
    places = np.empty((cells.max() + 1, 2))
    places[cells] = space.contracted(response).to_physical(image(vertices, nodes))
    mesh = adapter.create_mesh(space.comm, cells.astype(np.int64), length * places, space.degree)
    values = displacement * _nodal(space, response, fields, weights)
    V = adapter.space(mesh, adapter.vector_element(space.degree), {})
    found = fem.Function(V, name="displacement")
    # It is asked for at all nodes of one cell after the other.
    found.interpolate(lambda x: values[mesh.topology.original_cell_index].reshape(-1, 2).T)
    found.x.scatter_forward()
    return found


def _evenly(reference: NDArray) -> NDArray[np.float64]:
    """The same nodes of a cell, spaced evenly, which all versions of dolfinx take a cell's own for."""
    _, side = tensor_order(reference)
    return np.abs(reference[..., None] - side).argmin(axis=-1) / (len(side) - 1.0)


def _nodal(
    space: Space, response: Response, fields: Sequence[PETSc.Vec], weights: NDArray
) -> NDArray[np.float64]:
    """Values of a combination of fields at the nodes of every cell, (cells, nodes, 2)."""
    field = fields[0].duplicate()
    field.zeroEntries()
    field.maxpy(weights.tolist(), list(fields[: len(weights)]))
    numbers = np.arange(len(space.vertices))
    found = [
        space.cell_values([field], response, numbers[cells])[..., 0]
        for cells in space.pieces(len(numbers))
    ]
    field.destroy()
    return np.concatenate(found)
