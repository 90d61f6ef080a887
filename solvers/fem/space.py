"""The finite element space on a mesh of the half-plane, shared out over ranks.

A :class:`Space` assembles the condensed matrix, in a parallel matrix with room for what cells will add to
it. It numbers nodes and facets on parts of the surface, and makes the nodal forces of tractions on them.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from dolfinx import fem, la
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.clock import Clock
from galinx.meshes.charts import Chart
from galinx.meshes.rings import TAGS, QuadMesh

from ..approximation import interpolation, lagrange
from ..errors import MeshError
from ..solids.half_plane import HalfPlane
from . import versions
from .cells import Contracted, model_cells
from .element import Element
from .forms import FORMS
from .versions import create_mesh, tag_facets

#: dolfinx numbers a quadrilateral's vertices row by row, others go round it.
_ORDER = [0, 1, 3, 2]


def distribute(mesh: QuadMesh | None, comm: MPI.Comm) -> tuple[Any, Any]:
    """Share a mesh out over the ranks of ``comm``.

    Args:
        mesh: the mesh on one rank, None on the others.
        comm: communicator.

    Returns:
        The dolfinx mesh and its facet tags.
    """
    points, cells = np.empty((0, 2)), np.empty((0, 4), dtype=np.int64)
    edges, tags = np.empty((0, 2), dtype=np.int64), np.empty(0, dtype=np.int32)
    if mesh:
        points, cells = mesh.points, mesh.cells[:, _ORDER]
        edges = np.concatenate(list(mesh.edges.values()))
        tags = np.repeat(np.array([*mesh.edges], np.int32), [len(part) for part in mesh.edges.values()])
    result = create_mesh(comm, cells, points)
    return result, tag_facets(result, edges, tags)


def empty_matrix(numbers: NDArray[np.int32], first: int, last: int, comm: MPI.Comm) -> PETSc.Mat:
    """A matrix with two rows a node, and room for cells that couple all their nodes.

    Collective.

    Args:
        numbers: global numbers of the nodes of this rank's cells, (cells, nodes of a cell).
        first, last: range of the nodes that this rank owns, the last excluded.
        comm: communicator.
    """
    owned, width = last - first, numbers.shape[1]
    on_rank = (first <= numbers) & (numbers < last)

    def brought(cells: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Most blocks that cells bring to the rows of the nodes that this rank owns, (nodes,)."""
        nodes = numbers[cells][on_rank[cells]] - first
        return width * np.bincount(nodes, minlength=owned)

    # Cells of other ranks bring entries to nodes on the border; without room for those PETSc would move
    # the whole matrix at each.
    border = PETSc.Vec().createMPI((owned, None), comm=comm)
    abroad = numbers[~on_rank]
    border.setValues(abroad, np.full(len(abroad), float(width)), addv=PETSc.InsertMode.ADD_VALUES)
    border.assemble()
    from_others = border.array_r.astype(np.int64)
    border.destroy()
    within = np.maximum(brought(np.ones(len(numbers), dtype=bool)) + from_others, 1)  # a diagonal
    across = brought(np.any(~on_rank, axis=1)) + from_others
    room = np.minimum(within, owned), np.minimum(across, comm.allreduce(owned))

    A = PETSc.Mat().create(comm)
    A.setSizes(((2 * owned, None), (2 * owned, None)), bsize=2)
    A.setType(PETSc.Mat.Type.BAIJ)  # it takes a cell's matrix four times faster than AIJ
    A.setPreallocationNNZ(tuple(blocks.astype(np.int32) for blocks in room))
    # As PETSc does on ranks that have rows; where ranks differ, the assembly waits for ever.
    A.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, True)
    return A


#: σ over N/(2a) by the distances from the left and the right punch edge over a; both are needed,
#: because next to an edge the distance has lost its digits in X/a.
Traction = Callable[[NDArray, NDArray], NDArray]

#: Facets at an edge are integrated in τ with distance ~ τ^8: traction grows like a root there.
_EDGE_POWER = 8
_POINTS = 48


@dataclass(frozen=True)
class SurfaceNodes:
    """Nodes of a part of the surface, in order of X, the same on every rank.

    Attributes:
        s: surface coordinates in the mesh's chart, (n,).
        owned: positions in ``s`` of the nodes this rank owns.
        numbers: global numbers of their first unknowns, those along X; the second ones follow.
    """

    s: NDArray[np.float64]
    owned: NDArray[np.int64]
    numbers: NDArray[np.int32]

    def dofs(self, component: int) -> NDArray[np.int32]:
        """Global numbers of the owned unknowns, component 0 for u and 1 for v."""
        return np.asarray(self.numbers + np.int32(component))


def consistent_forces(
    s: NDArray, chart: Chart, ends: NDArray, σ_YY: Traction, knots: NDArray | tuple[float, ...] = ()
) -> NDArray[np.float64]:
    """∫ σ_YY φ d(X/a) on facets under the punch, (F, p+1).

    Args:
        s: surface coordinates of the facets' nodes, (F, p+1).
        chart: of the mesh.
        ends: surface coordinates of both ends of the contact.
        σ_YY: the load.
        knots: positions X over a, under the punch, between which it is smooth.
    """
    knots = chart.surface_coordinate(np.asarray(knots))
    forces = np.zeros_like(s)
    first, last = ends
    for i, nodes in enumerate(s):
        length = nodes[-1] - nodes[0]
        within = (knots[(nodes[0] < knots) & (knots < nodes[-1])] - nodes[0]) / length
        for a, b in pairwise([0.0, *within, 1.0]):
            from_a, from_b, w = _rule(nodes[0] == first and a == 0.0, nodes[-1] == last and b == 1.0)
            # How far from the facet's two ends, over its length; each is exact at its own end.
            start, end = a + (b - a) * from_a, (1.0 - b) + (b - a) * from_b
            basis, _ = lagrange((nodes - nodes[0]) / length, start)
            d_left, d_right, stretch = chart.under_punch(
                nodes[0] - first + length * start, last - nodes[-1] + length * end
            )
            forces[i] += (w * (b - a) * length * stretch * σ_YY(d_left, d_right)) @ basis
    return forces


def _rule(at_left: bool, at_right: bool) -> tuple[NDArray, NDArray, NDArray]:
    """Distances of the points from both ends of an interval of length 1, and weights."""
    τ, weight = np.polynomial.legendre.leggauss(_POINTS)
    τ, weight = (τ + 1.0) / 2.0, weight / 2.0
    if not (at_left or at_right):
        return τ, 1.0 - τ, weight
    τ, weight = τ**_EDGE_POWER, weight * _EDGE_POWER * τ ** (_EDGE_POWER - 1)
    return (1.0 - τ, τ, weight) if at_right else (τ, 1.0 - τ, weight)


class Space:
    """Continuous vector Lagrange elements of one degree on one mesh.

    Args:
        mesh, facet_tags: dolfinx mesh and tags of its boundary facets, by :data:`.rings.TAGS`.
        chart: the chart that the mesh is drawn in.
        degree: polynomial degree, at least 1.
        form: name of the solid's weak form.
        terms: moments of the forces at the contact that the far boundary follows; 0 where it is held.
        clock: takes the time of what is done with the space.

    Raises:
        MeshError: a part of the boundary has no facet.
    """

    def __init__(
        self,
        mesh: Any,
        facet_tags: Any,
        chart: Chart,
        degree: int,
        form: str = "isotropic",
        terms: int = 0,
        clock: Clock | None = None,
    ) -> None:
        self.mesh, self.chart, self.degree, self.form = mesh, chart, degree, FORMS[form]
        self.terms = terms
        self.mixed = self.form.mixed
        self.clock = Clock() if clock is None else clock
        self.comm: MPI.Comm = mesh.comm
        mesh.topology.create_connectivity(1, 2)
        mesh.topology.create_connectivity(2, 1)
        with self.clock("forms"):
            self.V = versions.space(mesh, versions.vector_element(degree))
        self.facet_tags = facet_tags
        self.facets = {name: facet_tags.find(tag) for name, tag in TAGS.items()}
        for name, tag in TAGS.items():
            if not self.comm.allreduce(len(self.facets[name])):
                raise MeshError(f'no facet of the mesh carries tag {tag}, the part "{name}"')

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return 2 * self.V.dofmap.index_map.size_global

    @property
    def cells(self) -> int:
        """Number of cells."""
        return self.mesh.topology.index_map(2).size_global

    @cached_property
    def coordinates(self) -> NDArray[np.float64]:
        """Coordinates of this rank's nodes in the chart, ghosts included, (n, 2)."""
        return self.V.tabulate_dof_coordinates()[:, :2]

    @cached_property
    def contact(self) -> SurfaceNodes:
        """Nodes under the punch, both edges included."""
        blocks = self.nodes_on("contact")
        s = self.chart.along_surface(self.coordinates[blocks])
        parts = self.comm.allgather(s)
        everyone = np.concatenate(parts)
        rank_of = np.argsort(np.argsort(everyone, kind="stable"), kind="stable")
        start = sum(len(part) for part in parts[: self.comm.rank])
        owned = rank_of[start : start + len(s)]
        return SurfaceNodes(np.sort(everyone), owned, self.numbers[blocks])

    def contracted(self, response: HalfPlane) -> Contracted:
        """The chart as the plane is contracted at a response's speed."""
        return Contracted(self.chart, response.contraction if self.chart.contracts else 1j)

    @cached_property
    def translations(self) -> NDArray[np.float64]:
        """Both translations of the body at this rank's rows of a matrix, (rows, 2)."""
        owned, rows = len(self._owned_nodes), self._range[1] - self._range[0]
        return np.pad(np.tile(np.eye(2), (owned, 1)), [(0, rows - 2 * owned), (0, 0)])

    def places(self, response: HalfPlane) -> NDArray[np.float64]:
        """X and Y over a of this rank's nodes, as the rows of their unknowns, (2 nodes,)."""
        return self.contracted(response).to_physical(self.coordinates[self._owned_nodes]).ravel()

    @cached_property
    def far_nodes(self) -> NDArray[np.int32]:
        """Local numbers of the owned nodes on the far boundary."""
        return self.nodes_on("far")

    @cached_property
    def far_dofs(self) -> NDArray[np.int32]:
        """Global numbers of the owned unknowns on the far boundary, both components."""
        numbers = self.numbers[self.far_nodes]
        return np.concatenate([numbers, numbers + 1])

    @cached_property
    def held_dofs(self) -> NDArray[np.int32]:
        """Global numbers of the owned unknowns that a punch holds: v under it, and the far boundary."""
        return np.concatenate([self.contact.dofs(1), self.far_dofs])

    def assemble(self, response: HalfPlane) -> PETSc.Mat:
        """Matrix of the moving-frame form without boundary conditions, inner unknowns condensed."""
        blocks = self.outer_numbers // 2
        with self.clock("assembly"):
            first, last = self._range
            A = empty_matrix(blocks, first // 2, last // 2, self.comm)
            for S, cells in self._matrices(response):
                for rows in blocks[cells]:
                    A.setValuesBlocked(rows, rows, S.ravel(), addv=PETSc.InsertMode.ADD_VALUES)
            A.assemble()
        return A

    def _matrices(self, response: HalfPlane) -> Iterator[tuple[NDArray, NDArray]]:
        """Condensed matrices, and the numbers of this rank's cells that have each; collective."""
        if not self.chart.similar:
            cells = np.arange(len(self.vertices))[:, None]
            for batch in self.pieces(len(cells)):
                yield from zip(self.condensed(response, batch), cells[batch])
            return
        models, members = model_cells(self.vertices, response, self.form.constants, self.comm.allgather)
        for batch in self.pieces(len(models)):
            yield from zip(self._cells(self.kernel.condense, response, models[batch]), members[batch])

    def fetch(self, fields: Sequence[PETSc.Vec], numbers: NDArray[np.int32]) -> NDArray[np.float64]:
        """Values of fields at nodes, (*numbers.shape, 2, fields), by their first unknowns' numbers.

        Collective; every rank passes the numbers that it needs.
        """
        index = (numbers.ravel()[:, None] + np.arange(2, dtype=np.int32)).ravel()
        values = PETSc.Vec().createSeq(len(index))
        where = PETSc.IS().createGeneral(index, comm=PETSc.COMM_SELF)
        scatter = PETSc.Scatter().create(fields[0], where, values, None)
        u = np.empty((*numbers.shape, 2, len(fields)))
        for i, field in enumerate(fields):
            scatter.scatter(field, values)
            u[..., i] = values.array_r.reshape(u.shape[:-1])
        for held in (scatter, where, values):
            held.destroy()
        return u

    def cell_values(
        self, fields: Sequence[PETSc.Vec], response: HalfPlane, cells: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """Values of condensed fields at all nodes of some of this rank's cells.

        Collective. Inner values follow from the outer ones by the form that gave the fields, at
        this response.

        Returns:
            Array (cells, nodes of a cell, 2, fields).
        """
        return self.extended(self.fetch(fields, self.outer_numbers[cells]), response, cells)

    def extended(
        self, outer: NDArray, response: HalfPlane, cells: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """Values at all nodes of some of this rank's cells from the outer ones.

        Args:
            outer: at the nodes of ``outer_numbers``, (cells, nodes, 2, fields).
            response: that the fields are solutions for.
            cells: numbers of the cells.

        Returns:
            Array (cells, nodes of a cell, 2, fields).
        """
        E = self._cells(self.kernel.extend, response, self.vertices[cells])
        kernel, fields = self.kernel, outer.shape[-1]
        u = np.empty((len(cells), kernel.nodes, 2, fields))
        u[:, kernel.outer] = outer[:, : len(kernel.outer)]
        inner = E @ outer.reshape(len(cells), 2 * outer.shape[1], fields)
        count = len(kernel.inner)
        u[:, kernel.inner] = inner[:, : 2 * count].reshape(len(cells), count, 2, fields)
        return u

    @property
    def reference_nodes(self) -> NDArray[np.float64]:
        """Positions of a cell's local nodes in the unit square, the same for every cell, (nodes, 2)."""
        return versions.reference_nodes(self.V)

    @cached_property
    def vertices(self) -> NDArray[np.float64]:
        """Coordinates of the vertices of the cells this rank owns, (cells, 4, 3)."""
        return versions.vertices(self.mesh, self.mesh.topology.index_map(2).size_local)

    @cached_property
    def kernel(self) -> Element:
        """Condensed matrices of cells, and the nodes that condensation leaves."""
        inner = np.array(self.V.dofmap.dof_layout.entity_dofs(2, 0))
        # Two degrees less make displacement and pressure a stable pair on quadrilaterals.
        return Element(self.reference_nodes, inner, (self.degree - 1) * self.mixed)

    @cached_property
    def _cell_nodes(self) -> NDArray[np.int32]:
        """Local nodes of the cells this rank owns, (cells, nodes of a cell)."""
        return versions.cell_nodes(self.V)[: self.mesh.topology.index_map(2).size_local]

    @cached_property
    def outer_numbers(self) -> NDArray[np.int32]:
        """Global numbers of what condensation leaves of each cell of this rank: boundary nodes, pressure.

        The two pressures of a cell are numbered like the two unknowns of a node, by the first.
        """
        nodes = self.numbers[self._cell_nodes[:, self.kernel.outer]]
        if not self.mixed:
            return nodes
        cells = self._range[1] - 2 * len(nodes) + 2 * np.arange(len(nodes), dtype=np.int32)
        return np.column_stack([nodes, cells])

    def pieces(self, count: int) -> Iterator[slice]:
        """Slices of ``count`` cells, each to be treated at once."""
        step = self.kernel.at_once
        return (slice(start, start + step) for start in range(0, count, step))

    def condensed(self, response: HalfPlane, cells: Any) -> NDArray[np.float64]:
        """Condensed matrices of some of this rank's cells, see :meth:`.element.Element.condense`."""
        return self._cells(self.kernel.condense, response, self.vertices[cells])

    def _cells(
        self, part: Callable[..., NDArray], response: HalfPlane, corners: NDArray
    ) -> NDArray[np.float64]:
        return part(self.densities(response, corners), self.contracted(response), corners)

    def surface_facets(self, parts: Sequence[str]) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """Facets of the named parts of the boundary whose cell this rank owns.

        Returns:
            Local numbers of each facet's nodes in order of X, and their surface coordinates, (F, p+1).
        """
        topology, dofmap = self.mesh.topology, self.V.dofmap
        to_cell, to_facet = topology.connectivity(1, 2), topology.connectivity(2, 1)
        owned_cells = topology.index_map(2).size_local
        nodes = []
        for facet in np.concatenate([self.facets[part] for part in parts]):
            cell = to_cell.links(facet)[0]
            if cell < owned_cells:
                local = int(np.flatnonzero(to_facet.links(cell) == facet)[0])
                closure = dofmap.dof_layout.entity_closure_dofs(1, local)
                nodes.append(dofmap.cell_dofs(cell)[closure])
        index = np.array(nodes, dtype=np.int32).reshape(-1, self.degree + 1)
        s = self.chart.along_surface(self.coordinates[index])
        order = np.argsort(s, axis=1)
        return np.take_along_axis(index, order, 1), np.take_along_axis(s, order, 1)

    def nodal_forces(
        self, σ_YY: Traction, knots: NDArray | tuple[float, ...] = ()
    ) -> tuple[NDArray[np.int32], NDArray[np.float64], NDArray[np.float64]]:
        """Consistent nodal forces ∫ σ φ d(X/a) over N/(2a) of a traction on the contact.

        Args:
            σ_YY: the traction over N/(2a).
            knots: positions X over a, under the punch, between which it is smooth.

        Returns:
            Global numbers of nodes' first unknowns, their surface coordinates, and this rank's part of
            the forces, (n,) each; a node stands once for each of its facets.
        """
        nodes, s = self.surface_facets(("contact",))
        forces = consistent_forces(s, self.chart, self.contact.s[[0, -1]], σ_YY, knots)
        return self.numbers[nodes.ravel()], s.ravel(), forces.ravel()

    def held(self, A: PETSc.Mat, response: HalfPlane, parts: Sequence[str]) -> PETSc.Mat:
        """The matrix with displacements held: "far" on the far boundary, "contact" for v under a punch.

        Args:
            A: the matrix with nothing held; it is changed in place.
            response: of the half-plane.
            parts: names of the held parts.
        """
        dofs = {"far": self.far_dofs, "contact": self.contact.dofs(1)}
        A.zeroRowsColumns(np.concatenate([dofs[part] for part in parts]), 1.0)
        return A

    def densities(self, response: HalfPlane, corners: NDArray) -> NDArray[np.float64]:
        """The form at unit gradients: one for all cells, for each cell, or for each point of quadrature.

        Arrays (4, 4) or (5, 5), (cells, 4, 4), (cells, 4, 4, points, points).
        """
        by_solid = [self.form.densities(rows) for rows in response.constants(self.form.constants)]
        if len(by_solid) == 1:
            return np.asarray(by_solid[0][0])
        solid = response.solids(corners[..., 1].mean(axis=1))
        if all(len(by_solid[i]) == 1 for i in np.unique(solid)):
            return np.array([by_solid[i][0] for i in solid])
        heights = self.kernel.heights(corners)
        H = np.empty((len(corners), *by_solid[0].shape[1:], *heights.shape[1:]))
        for i in np.unique(solid).tolist():
            cells = solid == i
            share = response.share(i, heights[cells])
            basis = interpolation(share, len(by_solid[i]))
            H[cells] = np.einsum("myxn,nij->mijyx", basis, by_solid[i], optimize=True)
        return H

    def nodes_on(self, part: str) -> NDArray[np.int32]:
        """Local numbers of the owned nodes on a part of the boundary."""
        blocks = fem.locate_dofs_topological(self.V, 1, self.facets[part])
        return blocks[blocks < self.V.dofmap.index_map.size_local]

    @cached_property
    def _inner(self) -> NDArray[np.bool_]:
        """True for those of this rank's nodes, ghosts included, that lie inside a cell, (nodes,)."""
        local = np.array(self.V.dofmap.dof_layout.entity_dofs(2, 0), dtype=np.int32)
        result = np.zeros(len(self.coordinates), dtype=bool)
        result[versions.cell_nodes(self.V)[:, local]] = True
        return result

    @cached_property
    def _range(self) -> tuple[int, int]:
        """Unknowns that this rank owns, from the first to below the last: of nodes, then pressures."""
        owned = 2 * len(self._owned_nodes) + self._owned_pressures
        last = self.comm.scan(owned)
        return last - owned, last

    @cached_property
    def _owned_nodes(self) -> NDArray[np.int64]:
        """Local numbers of this rank's nodes that have unknowns in the matrix."""
        return np.flatnonzero(~self._inner[: self.V.dofmap.index_map.size_local])

    @property
    def _owned_pressures(self) -> int:
        """Number of this rank's unknown pressures in the matrix."""
        return 2 * self.mesh.topology.index_map(2).size_local * self.mixed

    @cached_property
    def numbers(self) -> NDArray[np.int32]:
        """Global number of each local node's first unknown, ghosts included; -1 where it has none.

        That along X is the first, that along Y the next one.
        """
        shared = la.vector(self.V.dofmap.index_map)  # in floating point, exact for any number of nodes
        shared.array[:] = -1.0
        shared.array[self._owned_nodes] = self._range[0] + 2 * np.arange(len(self._owned_nodes))
        shared.scatter_forward()
        return shared.array.astype(np.int32)
