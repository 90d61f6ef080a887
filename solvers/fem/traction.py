"""Half-plane under given surface tractions: the cheaper mode, in which the pressure is put in."""

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem.deformation import forces
from galinx.solvers.fem.direct import Factor
from galinx.solvers.fem.far import FarBoundary
from galinx.solvers.fem.nodes import Traction
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import Response


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
        A = space.held(A, response, ("far",))
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

    def load(self, σ_YY: Traction, knots: NDArray | tuple[float, ...] = ()) -> None:
        """Add the fields of σ_YY alone and of σ_XY = σ_YY alone, and the discrete load's resultant.

        Args:
            σ_YY: the load.
            knots: positions X over a, under the punch, between which it is smooth.
        """
        load, comm = self.space.nodal_forces(σ_YY, knots), self.space.comm
        X = self.space.chart.surface_position(load.s)
        resultant = comm.allreduce(float(load.forces.sum()))
        moments = comm.allreduce(self._far.tests(X) @ load.forces)
        for component in (1, 0):
            b = self.factor.A.createVecLeft()
            b.setValues(load.numbers + component, load.forces, addv=PETSc.InsertMode.ADD_VALUES)
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
