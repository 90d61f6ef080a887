"""dolfinx as its versions offer it, and the cache of compiled forms.

Nothing else in the program depends on the version of dolfinx.

FFCx compiles forms and elements into a folder of this run's own. When all is well the folder gets, by
being renamed, the place where every run looks for the form. dolfinx's own cache would wait for what a
killed run left.
"""

import hashlib
import os
import secrets
import shutil
import sysconfig
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import basix
import dolfinx
import ffcx
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx import files

from ..errors import CompilerError

try:
    import basix.ufl as elements
except ImportError:  # elements were UFL's own
    elements = None

_CELL = "quadrilateral"


def create_mesh(comm: MPI.Comm, cells: NDArray, points: NDArray, degree: int = 1) -> Any:
    """A mesh shared out over the ranks; nodes of cells evenly spaced, in the order of Lagrange's."""
    if elements:
        even = {"lagrange_variant": basix.LagrangeVariant.equispaced, "shape": (2,)}
        element = elements.element("Lagrange", _CELL, degree, **even)
        return dolfinx.mesh.create_mesh(comm, cells=cells, x=points, e=element)
    # FFCx names this variant in the element when it compiles, not when it finds the form in its cache;
    # named here, the form has one key in both cases.
    element = ufl.VectorElement("Lagrange", ufl.quadrilateral, degree, variant="equispaced")
    table = dolfinx.graph.create_adjacencylist(np.asarray(cells, dtype=np.int64))
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


def space(mesh: Any, element: Any) -> Any:
    """The functions of an element on a mesh; collective."""
    if hasattr(fem, "functionspace"):  # nothing is compiled
        return fem.functionspace(mesh, element)
    with compiling(mesh.comm, repr(element)) as options:
        return fem.FunctionSpace(mesh, element, jit_params=options)


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


@contextmanager
def compiling(comm: MPI.Comm, what: str) -> Iterator[dict[str, Any]]:
    """Options of dolfinx's form compiler, to be used inside this block by all ranks of ``comm``.

    Args:
        comm: the ranks; collective.
        what: everything that the compiled code depends on but compiler and processor.

    Raises:
        CompilerError: the form could not be compiled; the message says why.
    """
    own = kept = _place(what)
    try:
        if comm.rank == 0 and not kept.is_dir():
            own = kept.with_suffix(f".{secrets.token_hex(4)}")
            own.mkdir(parents=True)
        own = comm.bcast(own)
        yield {"cache_dir": str(own)}
        comm.barrier()  # the folder is renamed when all ranks have loaded what is in it
        if comm.rank == 0 and own != kept:
            with suppress(OSError):  # another's may be there by now
                for path in own.iterdir():
                    files.synchronise(path)
                own.rename(kept)
    except Exception as error:
        raise CompilerError(_why(error, kept.parent)) from error
    finally:
        if comm.rank == 0 and own != kept:
            shutil.rmtree(own, ignore_errors=True)


def _place(what: str) -> Path:
    """Folder of a compiled form in the cache, by all that its code depends on."""
    python = [sysconfig.get_config_var(name) for name in ("SOABI", "CFLAGS")]
    key = repr([what, ffcx.__version__, dolfinx.__version__, *python])
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "galinx" / "forms"
    return cache / hashlib.sha256(key.encode()).hexdigest()[:24]


def _why(error: Exception, cache: Path) -> str:
    compiler = (sysconfig.get_config_var("CC") or "cc").split()[0]
    if isinstance(error, OSError) and not os.access(cache, os.W_OK):
        return (
            f"the cache of compiled forms {cache} cannot be written ({error.strerror}); name another "
            "folder in the variable XDG_CACHE_HOME"
        )
    missing = f"there is no C compiler, expected {compiler}; install gcc and libc6-dev"
    return f"compiling a form failed: {error if shutil.which(compiler) else missing}"
