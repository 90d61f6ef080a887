"""dolfinx as its versions offer it: nothing else in the program knows that there is more than one."""

from collections.abc import Sequence
from typing import Any

import basix
import dolfinx
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

try:
    import basix.ufl as elements
except ImportError:  # elements were UFL's own
    elements = None

_CELL = "quadrilateral"

#: What FFCx made of an element, that dolfinx would look for again with each space.
_compiled: dict[Any, Any] = {}


def create_mesh(comm: MPI.Comm, cells: NDArray, points: NDArray, degree: int = 1) -> Any:
    """A mesh shared out over the ranks; nodes of cells evenly spaced, in the order of Lagrange's."""
    if elements:
        even = {"lagrange_variant": basix.LagrangeVariant.equispaced, "shape": (2,)}
        element = elements.element("Lagrange", _CELL, degree, **even)
        return dolfinx.mesh.create_mesh(comm, cells=cells, x=points, e=element)
    # FFCx names this variant in the element when it compiles, not when it finds the form in its cache;
    # named here, the form has one key in both cases.
    element = ufl.VectorElement("Lagrange", ufl.quadrilateral, degree, variant="equispaced")
    # An array would be refused first, with a message that prints all of it.
    table = dolfinx.cpp.graph.AdjacencyList_int64(np.asarray(cells, dtype=np.int64))
    return dolfinx.mesh.create_mesh(comm, table, points, ufl.Mesh(element))


def tag_facets(mesh: Any, edges: NDArray, tags: NDArray) -> Any:
    """Tags of the facets between the given vertices (n, 2), numbered as when the mesh was made."""
    mesh.topology.create_connectivity(1, 2)
    mesh.topology.create_connectivity(1, 0)
    own = getattr(mesh, "_mesh", mesh)
    entities, values = dolfinx.io.distribute_entity_data(own, 1, edges, tags)
    make = getattr(dolfinx.graph, "adjacencylist", None) or dolfinx.graph.create_adjacencylist
    return dolfinx.mesh.meshtags_from_entities(mesh, 1, make(entities), values.astype(np.int32))


def vector_element(degree: int) -> Any:
    """Continuous vector Lagrange elements on quadrilaterals."""
    if elements:
        return elements.element("Lagrange", _CELL, degree, shape=(2,))
    return ufl.VectorElement("Lagrange", _CELL, degree)


def pressure_element(degree: int) -> Any:
    """Discontinuous scalar elements on quadrilaterals."""
    if elements:
        return elements.element("Lagrange", _CELL, degree, discontinuous=True)
    return ufl.FiniteElement("DQ" if degree else "DG", _CELL, degree)


def quadrature_element(degree: int) -> Any:
    """Values at the points of quadrature of a degree, see :func:`quadrature_points`."""
    if elements:
        return elements.quadrature_element(_CELL, degree=degree)
    return ufl.FiniteElement("Quadrature", _CELL, degree, quad_scheme="default")


def quadrature_points(degree: int) -> NDArray[np.float64]:
    """Points of quadrature in the unit square, (n, 2)."""
    return basix.make_quadrature(basix.CellType.quadrilateral, degree)[0]


def function_space(mesh: Any, element: Any) -> Any:
    """The functions on a mesh."""
    make = getattr(fem, "functionspace", None) or fem.FunctionSpace
    return make(mesh, element)


def form(form: Any, options: dict[str, Any]) -> Any:
    """A compiled form, or nested lists of them; ``options`` are the compiler's."""
    name = "jit_options" if elements else "jit_params"
    return fem.form(form, **{name: options})


def matrix(form: Any, conditions: Sequence[Any]) -> Any:
    """The assembled matrix of a form, or of blocks of forms, with Dirichlet conditions."""
    blocks = getattr(petsc, "assemble_matrix_block", None) if isinstance(form, list) else None
    A = (blocks or petsc.assemble_matrix)(form, bcs=list(conditions))
    A.assemble()
    return A


def vector(form: Any) -> Any:
    """The assembled vector of a linear form, what ranks share added up."""
    b = petsc.assemble_vector(form)
    b.ghostUpdate(addv=PETSc.InsertMode.ADD_VALUES, mode=PETSc.ScatterMode.REVERSE)
    return b


def is_compiled(element: Any) -> bool:
    """Has this process loaded what was compiled of an element?"""
    return element in _compiled


def space(mesh: Any, element: Any, options: dict[str, Any]) -> Any:
    """The functions on a mesh; ``options`` are the compiler's, where a rank has not compiled the element.

    Then all ranks do: one that has worked alone before would leave the others waiting for it.
    """
    if hasattr(fem, "functionspace"):
        return fem.functionspace(mesh, element)
    if options or element not in _compiled:
        _compiled[element] = dolfinx.jit.ffcx_jit(mesh.comm, element, jit_params=options)
    (shape, layout), module, _ = _compiled[element]
    address = module.ffi.addressof
    known, dofs = (int(module.ffi.cast("uintptr_t", address(part))) for part in (shape, layout))
    own = dolfinx.cpp.fem.FiniteElement(known)
    dofmap = dolfinx.cpp.fem.create_dofmap(mesh.comm, dofs, mesh.topology, own)
    made = dolfinx.cpp.fem.FunctionSpace(getattr(mesh, "_mesh", mesh), own, dofmap)
    return fem.FunctionSpace(mesh, element, made)


def reference_nodes(V: Any) -> NDArray[np.float64]:
    """Positions of a cell's nodes in the unit square, (nodes, 2)."""
    points = V.element.interpolation_points
    return points() if callable(points) else points


def vertices(mesh: Any, cells: int) -> NDArray[np.float64]:
    """Coordinates of the vertices of the first ``cells`` of this rank's cells, (cells, 4, 3)."""
    geometry = mesh.geometry
    of_cell = geometry.dofmaps[0] if hasattr(geometry, "dofmaps") else geometry.dofmap
    return geometry.x[_table(of_cell, 4)[:cells]]


def cell_nodes(V: Any) -> NDArray[np.int32]:
    """Nodes of the cells this rank sees, its own first, (cells, nodes of a cell)."""
    return _table(V.dofmap.list, V.dofmap.dof_layout.num_dofs)


def _table(adjacency: Any, width: int) -> NDArray[np.int32]:
    return np.reshape(getattr(adjacency, "array", adjacency), (-1, width))
