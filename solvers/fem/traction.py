"""Half-plane under given surface tractions: the cheaper mode, in which the pressure is put in."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem.deformation import forces
from galinx.solvers.fem.direct import Factor
from galinx.solvers.fem.far import FarBoundary
from galinx.solvers.fem.lagrange import lagrange
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.surface import SurfaceFacets, surface_facets
from galinx.solvers.solids.solid import Response

#: σ over N/(2a) at the distances from the left and the right punch edge over a; both are given,
#: because next to an edge X/a itself no longer tells the distance.
Traction = Callable[[NDArray, NDArray], NDArray]

#: Facets at an edge are integrated in τ with distance ~ τ^8: traction grows like a root there.
_EDGE_POWER = 8
_POINTS = 48


class LoadedHalfPlane:
    """Half-plane without punch at one speed: one factor for many loads, which the far boundary follows.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.
        corrected: are corrections wanted?
    """

    def __init__(self, space: Space, response: Response, corrected: bool = False) -> None:
        self.space, self.response = space, response
        A = space.assemble(response)
        self._far = FarBoundary(space, response, A)
        A.zeroRowsColumns(space.far_dofs, 1.0)
        self.factor = Factor(A, space.clock, definite=not space.mixed)
        #: Two displacement fields a load: of σ_YY, and of σ_XY equal to it.
        self.fields: list[PETSc.Vec] = []
        #: ∫ σ_YY d(X/a) over N/(2a) of each load.
        self.resultants: list[float] = []
        #: What each field lacks where cells are small: its last digit is one of the motion of all.
        self.corrections: list[PETSc.Vec] = []
        self._corrected = corrected
        if self._far.loads:
            self._far.found(self.factor.solve_all(self._far.loads))
        self._facets = surface_facets(space, ("contact",))

    def load(self, σ_YY: Traction, knots: NDArray | tuple[float, ...] = ()) -> None:
        """Add the fields of σ_YY alone and of σ_XY = σ_YY alone, and the discrete load's resultant.

        Args:
            σ_YY: the load.
            knots: positions X over a, under the punch, between which it is smooth.
        """
        load = consistent_forces(self.space, self._facets, σ_YY, knots)
        node = self.space.numbers[self._facets.nodes.ravel()]
        comm, X = self.space.comm, self.space.chart.surface_position(self._facets.s)
        resultant = comm.allreduce(float(load.sum()))
        moments = comm.allreduce(self._far.tests(X.ravel()) @ load.ravel())
        for component in (1, 0):
            b = self.factor.A.createVecLeft()
            b.setValues(
                node + component,
                load.ravel(),
                addv=PETSc.InsertMode.ADD_VALUES,
            )
            b.assemble()
            self.fields.append(self.factor.solve(b))
            if self._far.fields:
                self.fields[-1].maxpy(moments.tolist(), self._far.fields[1 - component :: 2])
            if self._corrected:
                self.corrections.append(self._correction(self.fields[-1], b))
            b.destroy()
        self.resultants.append(resultant)

    def _correction(self, field: PETSc.Vec, load: PETSc.Vec) -> PETSc.Vec:
        """The field of what the forces of the cells' deformation leave of the load."""
        residual = forces(self.space, self.response, field)
        residual.aypx(-1.0, load)
        residual.setValues(self.space.far_dofs, np.zeros(len(self.space.far_dofs)))
        residual.assemble()
        found = self.factor.solve(residual)
        residual.destroy()
        return found

    def destroy(self) -> None:
        """Free factor and fields."""
        for held in (self.factor, self._far, *self.fields, *self.corrections):
            held.destroy()


def consistent_forces(
    space: Space, facets: SurfaceFacets, σ_YY: Traction, knots: NDArray | tuple[float, ...] = ()
) -> NDArray[np.float64]:
    """∫ σ_YY φ d(X/a) on each of this rank's facets under the punch, (F, p+1).

    Args:
        space: of the functions φ.
        facets: which.
        σ_YY: the load.
        knots: positions X over a, under the punch, between which it is smooth.
    """
    s, chart = facets.s, space.chart
    knots = chart.surface_coordinate(np.asarray(knots))
    forces = np.zeros_like(s)
    left, right = space.contact.s[[0, -1]]
    for i, nodes in enumerate(s):
        length = nodes[-1] - nodes[0]
        within = (knots[(nodes[0] < knots) & (knots < nodes[-1])] - nodes[0]) / length
        for a, b in pairwise([0.0, *within, 1.0]):
            from_a, from_b, w = _rule(nodes[0] == left and a == 0.0, nodes[-1] == right and b == 1.0)
            # How far from the facet's two ends, over its length; each is exact at its own end.
            start, end = a + (b - a) * from_a, (1.0 - b) + (b - a) * from_b
            basis, _ = lagrange((nodes - nodes[0]) / length, start)
            d_left, d_right, stretch = chart.under_punch(
                nodes[0] - left + length * start, right - nodes[-1] + length * end
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
