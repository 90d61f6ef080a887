"""The half-plane by dolfinx's own assembler: ``fem.form``, ``assemble_matrix`` and ``dirichletbc``.

The weak form of Eqs 15-16 is a UFL form over ``dx`` here, and the traction of a friction state one over
``ds``. FFCx compiles both, every unknown stays in the matrix, and any form that is registered works as it
stands. This is the ordinary path. :class:`.space.Space` is proved against it; its element matrices by
tensor products, and condensation, are several times faster at the degrees that the program solves with.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from dolfinx import fem
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.meshes.rings import CONTACT

from ..approximation import interpolation
from ..contact.edges import EdgeTraction
from ..solids.half_plane import HalfPlane
from . import versions
from .cells import image
from .element import size_of_cells
from .forms import traction_form, weak_form
from .space import Space, Traction
from .versions import compiling

#: Degree to which the traction times a test function is integrated on facets: next to the edges of the
#: contact it is no polynomial.
_ON_FACETS = 401


class DolfinxSpace(Space):
    """Continuous vector Lagrange elements on a mesh, assembled by dolfinx; see :class:`.space.Space`."""

    @property
    def _quadrature(self) -> int:
        """Degree of quadrature: as many points as the element matrices by tensor products have."""
        return 2 * self.degree + 2

    @cached_property
    def _pressures(self) -> Any:
        """Discontinuous pressures, two degrees below the displacement."""
        return versions.space(self.mesh, versions.pressure_element(self.degree - 2))

    @cached_property
    def _plane(self) -> tuple[Any, Any]:
        """Re p and Im p of the plane X + pY in which the mesh is drawn."""
        return fem.Constant(self.mesh, 0.0), fem.Constant(self.mesh, 1.0)

    @cached_property
    def _constants(self) -> list[Any]:
        """The weak form's constants, which may change with depth: values at the points of quadrature."""
        Q = versions.space(self.mesh, versions.quadrature_element(self._quadrature))
        return [fem.Function(Q) for _ in self.form.constants]

    @cached_property
    def _sizes(self) -> Any:
        """Sizes of cells, by which pressures are divided: small cells' weigh as much as large ones'."""
        D = versions.space(self.mesh, versions.pressure_element(0))
        sizes, corners = fem.Function(D), self._all_corners
        sizes.x.array[versions.cell_nodes(D)[: len(corners), 0]] = size_of_cells(corners)
        return sizes

    @property
    def _all_corners(self) -> NDArray[np.float64]:
        """Vertices of all cells of this rank, ghosts included, (cells, 4, 3)."""
        cells = self.mesh.topology.index_map(2)
        return versions.vertices(self.mesh, cells.size_local + cells.num_ghosts)

    @cached_property
    def _form(self) -> Any:
        """The compiled weak form; blocks where there are pressures."""
        spaces = [self.V, self._pressures] if self.mixed else [self.V]
        forms = weak_form(
            self.form, spaces, self.chart, self._plane, self._constants,
            self._sizes if self.mixed else None, self._quadrature,
        )  # fmt: skip
        compiled = [[self._compiled(form) for form in row] for row in forms]
        return compiled if self.mixed else compiled[0][0]

    def _form_of(self, response: HalfPlane) -> Any:
        """The compiled weak form with the constants of a response."""
        p = self.contracted(response).p
        for constant, value in zip(self._plane, (p.real, p.imag)):
            constant.value = value
        points, corners = versions.quadrature_points(self._quadrature), self._all_corners
        Y = image(corners[:, None, :, :2], points)[..., 1].reshape(len(corners), len(points))
        solids = response.solids(corners[..., 1].mean(axis=1))
        tables = response.constants(self.form.constants)
        values = np.empty((*Y.shape, len(self.form.constants)))
        for i in np.unique(solids).tolist():
            cells = solids == i
            values[cells] = interpolation(response.share(i, Y[cells]), len(tables[i])) @ tables[i]
        for k, function in enumerate(self._constants):
            function.x.array[versions.cell_nodes(function.function_space)[: len(Y)]] = values[..., k]
        return self._form

    def _compiled(self, form: Any) -> Any:
        with self.clock("forms"), compiling(self.comm, form.signature()) as options:
            return versions.form(form, options)

    def assemble(self, response: HalfPlane) -> PETSc.Mat:
        """Matrix of the moving-frame form without boundary conditions."""
        form = self._form_of(response)
        with self.clock("assembly"):
            return versions.matrix(form, [])

    def held(self, A: PETSc.Mat, response: HalfPlane, parts: Sequence[str]) -> PETSc.Mat:
        """Matrix with Dirichlet conditions: "far" on the far boundary, "contact" for v under a punch.

        Args:
            A: the matrix with nothing held, which is destroyed.
            response: of the half-plane.
            parts: names of the held parts.
        """
        A.destroy()
        v, zero = self.V.sub(1), np.zeros(2)
        far, contact = (
            fem.locate_dofs_topological(of, 1, self.facets[part])
            for of, part in ((self.V, "far"), (v, "contact"))
        )
        conditions = {
            "far": lambda: fem.dirichletbc(zero, far, self.V),
            "contact": lambda: fem.dirichletbc(PETSc.ScalarType(-1.0), contact, v),
        }
        form = self._form_of(response)
        with self.clock("assembly"):
            return versions.matrix(form, [conditions[part]() for part in parts])

    @cached_property
    def _load(self) -> tuple[Any, EdgeTraction]:
        """The compiled form of a flat punch's σ_YY, and the constants in it."""
        traction = EdgeTraction(*(fem.Constant(self.mesh, 0.0) for _ in range(3)))
        form = traction_form(self.V, traction, self.chart, self.facet_tags, CONTACT, _ON_FACETS)
        return self._compiled(form), traction

    def nodal_forces(
        self, σ_YY: Traction, knots: NDArray | tuple[float, ...] = ()
    ) -> tuple[NDArray[np.int32], NDArray[np.float64], NDArray[np.float64]]:
        """Consistent nodal forces of the traction under a flat punch, by a linear form over ``ds``.

        Raises:
            TypeError: any other traction, for which there is no compiled form.
        """
        if not isinstance(σ_YY, EdgeTraction):
            raise TypeError("expected the traction under a flat punch")
        form, traction = self._load
        for constant, value in zip(vars(traction).values(), vars(σ_YY).values()):
            constant.value = float(value)
        b = versions.vector(form)
        forces = np.array(b.getValues(self.contact.dofs(1)))
        b.destroy()
        return self.contact.numbers, self.contact.s[self.contact.owned], forces

    def cell_values(
        self, fields: Sequence[PETSc.Vec], response: HalfPlane, cells: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """Values of fields at all nodes of some of this rank's cells, (cells, nodes, 2, fields).

        Collective.
        """
        return self.fetch(fields, self.numbers[self._cell_nodes[cells]])

    @cached_property
    def _inner(self) -> NDArray[np.bool_]:
        """False for every node: none is eliminated, (nodes,)."""
        return np.zeros(len(self.coordinates), dtype=bool)

    @property
    def _owned_pressures(self) -> int:
        return int(self._pressures.dofmap.index_map.size_local) if self.mixed else 0
