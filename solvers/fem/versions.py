"""dolfinx as its versions offer it, and the cache of compiled forms.

Nothing else in the program depends on the version of dolfinx.

FFCx compiles what dolfinx needs of a form, its elements, into a folder of this run's own. When all is
well the folder gets a digest and, by being renamed, the place where every run looks for the form. So
nobody meets what a killed run left, nobody has to wait for what is there, and what was damaged since is
noticed before it is loaded: that could end the program or change its numbers.
"""

import fcntl
import hashlib
import os
import re
import secrets
import shutil
import socket
import sysconfig
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import IO, Any

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

#: Compiled code of elements, which dolfinx would look for again with each space.
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
    """Return True if this process has loaded the compiled code of an element."""
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
    shape_address, layout_address = (
        int(module.ffi.cast("uintptr_t", address(part))) for part in (shape, layout)
    )
    own = dolfinx.cpp.fem.FiniteElement(shape_address)
    dofmap = dolfinx.cpp.fem.create_dofmap(mesh.comm, layout_address, mesh.topology, own)
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


#: Seconds until the user is told that this run waits for another, and until it no longer waits.
_SAID, _PATIENCE = 10.0, 60.0
#: Seconds after which an unfinished folder counts as abandoned.
_DAY = 86400.0
#: The file with the digest of all others in its folder.
_DIGEST = "digest"


@contextmanager
def compiling(
    comm: MPI.Comm, what: str, say: Callable[[str], None] = lambda _: None
) -> Iterator[dict[str, Any]]:
    """Options of dolfinx's form compiler, to be used inside this block by all ranks of ``comm``.

    Args:
        comm: the ranks; collective.
        what: everything that the compiled code depends on but compiler and processor.
        say: called on rank 0 with messages to the user.

    Raises:
        CompilerError: the form could not be compiled; the message says why.
    """
    try:
        with _folder(what, say) if comm.rank == 0 else nullcontext() as folder:
            yield {"cache_dir": comm.bcast(folder)}
            comm.barrier()  # the folder is renamed when all ranks have loaded what is in it
    except CompilerError:
        raise
    except Exception as error:
        raise CompilerError(f"compiling a form failed: {_why(error)}") from error


@contextmanager
def _folder(what: str, say: Callable[[str], None]) -> Iterator[str]:
    """Folder of a compiled form, or one to compile it into, which is then kept in the cache."""
    kept = _cache() / _key(what)
    if not _is_whole(kept):
        with _turn(kept, say):
            if not _is_whole(kept):
                if os.path.lexists(kept):
                    say(f"the compiled form in {kept} is damaged; it is compiled again")
                own = kept.with_suffix(f".{secrets.token_hex(4)}")
                with _writing(own):
                    own.mkdir()
                try:
                    yield str(own)
                    _keep(own, kept)
                finally:
                    _remove(own)
                return
    yield str(kept)


def _key(what: str) -> str:
    """Hash of everything that a form's code depends on, 24 digits."""
    python = [sysconfig.get_config_var(name) for name in ("SOABI", "CFLAGS")]
    description = repr([what, ffcx.__version__, dolfinx.__version__, *python])
    return hashlib.sha256(description.encode()).hexdigest()[:24]


def _is_whole(kept: Path) -> bool:
    """Return True if the folder of a form is there, unchanged since it was compiled."""
    try:
        return files.read(kept / _DIGEST, 100) == _digest(kept, kept.name)
    except OSError:
        return False


def _digest(folder: Path, name: str) -> bytes:
    """Digest of all files in a folder, and of the name that the folder has or will have."""
    digest = hashlib.sha256(name.encode())
    for path in sorted(folder.iterdir()):
        if path.name != _DIGEST:
            content = hashlib.sha256(files.read(path)).hexdigest()
            digest.update(f"{path.name} {content} ".encode(errors="surrogateescape"))
    return digest.hexdigest().encode()


def _keep(own: Path, kept: Path) -> None:
    """Move a compiled form to its place in the cache; a file system that refuses is no fault."""
    with suppress(OSError):
        for path in own.glob("*.[co]"):
            path.write_bytes(b"")  # FFCx asks whether there is a source, nobody reads it
        files.write(own / _DIGEST, _digest(own, kept.name))
        for path in own.iterdir():
            files.synchronise(path)
        if not _is_whole(kept):  # there may be another's by now
            _remove(kept)
            own.rename(kept)
            files.synchronise(kept.parent)


@contextmanager
def _turn(kept: Path, say: Callable[[str], None]) -> Iterator[None]:
    """Lock for a block that compiles. Other runs that need the form wait, for a limited time only."""
    with _writing(kept):
        kept.parent.mkdir(parents=True, exist_ok=True)
        handle = files.open_file(kept.with_suffix(".lock"), os.O_RDWR | os.O_CREAT)
    with open(handle, "r+", encoding="utf-8", errors="replace") as lock:
        started, said = time.monotonic(), False
        while not _taken(lock) and not _is_whole(kept):
            waited = time.monotonic() - started
            if waited > _PATIENCE:
                break
            if waited > _SAID and not said:
                said = True
                say(
                    f"{lock.read(100)} compiles the same form for {waited:.0f} s already, or is stopped; "
                    f"after {_PATIENCE:.0f} s it is no longer waited for"
                )
            time.sleep(0.1)
        _sweep(kept.parent)
        yield


def _taken(lock: IO[str]) -> bool:
    """Return True if this process has the lock, and write so in it; always where there are no locks."""
    with suppress(OSError):
        try:
            fcntl.lockf(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError):
            return False
        lock.seek(0)
        lock.truncate()
        lock.write(f"process {os.getpid()} on {socket.gethostname()}")
        lock.flush()
    return True


def _sweep(cache: Path) -> None:
    """Remove what killed runs left, and earlier versions of the program."""
    for path in cache.iterdir():
        with suppress(OSError):
            old = time.time() - path.stat().st_mtime > _DAY
            if old and not re.fullmatch("[0-9a-f]{24}", path.name):
                _remove(path)


def _remove(path: Path) -> None:
    with suppress(OSError):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink()


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    """Turn errors of a block that writes in the cache into a message with the remedy."""
    try:
        yield
    except OSError as error:
        raise CompilerError(
            f"the cache of compiled forms {path.parent} cannot be written ({error.strerror}); "
            "name another folder in the variable XDG_CACHE_HOME"
        ) from error


def _why(error: Exception) -> str:
    compiler = (sysconfig.get_config_var("CC") or "cc").split()[0]
    if shutil.which(compiler) is None:
        return f"there is no C compiler, expected {compiler}; install gcc and libc6-dev"
    return f"{error}"


def _cache() -> Path:
    """Folder of compiled forms."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "galinx" / "forms"
