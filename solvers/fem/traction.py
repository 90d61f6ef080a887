"""Half-plane under given surface tractions: the cheaper mode, in which the pressure is put in."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem.direct import Factor
from galinx.solvers.fem.lagrange import lagrange
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.surface import surface_facets
from galinx.solvers.solids.solid import Response

#: σ over N/(2a) at the distances from the left and the right punch edge over a; both are given,
#: because next to an edge X/a itself no longer tells the distance.
Traction = Callable[[NDArray, NDArray], NDArray]

#: Facets at an edge are integrated in τ with distance ~ τ^8: traction grows like a root there.
_EDGE_POWER = 8
_POINTS = 48


class LoadedHalfPlane:
    """Half-plane without punch at one speed, held far away: one factor for many loads.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.
    """

    def __init__(self, space: Space, response: Response) -> None:
        self.space, self.response = space, response
        A = space.assemble(response)
        A.zeroRowsColumns(space.far_dofs, 1.0)
        self.factor = Factor(A, space.clock, definite=not space.mixed)
        #: Two displacement fields a load: of σ_YY, and of σ_XY equal to it.
        self.fields: list[PETSc.Vec] = []
        #: ∫ σ_YY d(X/a) over N/(2a) of each load.
        self.resultants: list[float] = []
        self._loads: list[PETSc.Vec] = []
        self._facets = surface_facets(space, ("contact",))

    def load(self, σ_YY: Traction) -> None:
        """Add the fields of σ_YY alone and of σ_XY = σ_YY alone, and the discrete load's resultant."""
        forces = self._consistent_forces(σ_YY)
        node = self.space.numbers[self._facets.nodes.ravel()]
        for component in (1, 0):
            b = self.factor.A.createVecLeft()
            b.setValues(
                (2 * node + component).astype(np.int32),
                forces.ravel(),
                addv=PETSc.InsertMode.ADD_VALUES,
            )
            b.assemble()
            self._loads.append(b)
            self.fields.append(self.factor.solve(b))
        self.resultants.append(self.space.comm.allreduce(float(forces.sum())))

    def corrections(self) -> list[PETSc.Vec]:
        """What the fields lack where cells are small, one vector each, for the caller to free.

        A field's last digit is one of the motion of all of the half-plane. Forces are told from the cells'
        deformation here, and what these leave of the load is solved for.
        """
        found = []
        for field, load in zip(self.fields, self._loads):
            residual = self.space.forces(field, self.response)
            residual.aypx(-1.0, load)
            residual.setValues(self.space.far_dofs, np.zeros(len(self.space.far_dofs)))
            residual.assemble()
            found.append(self.factor.solve(residual))
            residual.destroy()
        return found

    def destroy(self) -> None:
        """Free factor, fields and loads."""
        for held in (self.factor, *self.fields, *self._loads):
            held.destroy()

    def _consistent_forces(self, σ_YY: Traction) -> NDArray[np.float64]:
        """∫ σ_YY φ d(X/a) on each of this rank's contact facets, (F, p+1)."""
        s = self._facets.s
        forces = np.zeros_like(s)
        left, right = self.space.contact.s[[0, -1]]
        τ, weight = np.polynomial.legendre.leggauss(_POINTS)
        τ, weight = (τ + 1.0) / 2.0, weight / 2.0
        graded = τ**_EDGE_POWER, weight * _EDGE_POWER * τ ** (_EDGE_POWER - 1)
        for i, nodes in enumerate(s):
            length = nodes[-1] - nodes[0]
            at_left, at_right = nodes[0] == left, nodes[-1] == right
            t, w = graded if at_left or at_right else (τ, weight)
            from_left = nodes[0] - left + length * (1.0 - t if at_right else t)
            from_right = right - nodes[-1] + length * (t if at_right else 1.0 - t)
            position = 1.0 - t if at_right else t
            basis, _ = lagrange((nodes - nodes[0]) / length, position)
            d_left, d_right, stretch = self.space.chart.under_punch(from_left, from_right)
            forces[i] = (w * length * stretch * σ_YY(d_left, d_right)) @ basis
        return forces
