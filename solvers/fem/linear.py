"""PETSc's direct solver with the checks that PETSc leaves to its caller."""

from typing import Any

import numpy as np
from petsc4py import PETSc

from solvers.errors import SolveError
from solvers.fem.clock import Clock

#: Prefix of the options database, so that ``-galinx_ksp_view`` and the like work.
PREFIX = "galinx_"

#: A direct solve that leaves more than this of its right-hand side has met a singular matrix: the
#: meshes' condition numbers let a sound factor reach about 1e-12.
RESIDUAL_LIMIT = 1e-8


class Factor:
    """Cholesky factor of a symmetric positive definite matrix, kept for many right-hand sides.

    Args:
        A: the matrix; it belongs to the factor from now on.
        clock: takes the time of factorisation and back-substitutions.

    Attributes:
        solves: back-substitutions done.
        largest_residual: the largest |b - Ax|/|b| met so far, dimensionless.
    """

    def __init__(self, A: PETSc.Mat, clock: Clock) -> None:
        A.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        A.setOption(PETSc.Mat.Option.SPD, True)
        self.A, self.solves, self.largest_residual = A, 0, 0.0
        self._clock = clock
        self._residual = A.createVecLeft()
        self._ksp = PETSc.KSP().create(A.comm)
        self._ksp.setOptionsPrefix(PREFIX)
        self._ksp.setOperators(A)
        self._ksp.setType(PETSc.KSP.Type.PREONLY)
        pc = self._ksp.getPC()
        pc.setType(PETSc.PC.Type.CHOLESKY)
        pc.setFactorSolverType("mumps")
        self._ksp.setFromOptions()
        try:
            with clock("factorisation"):
                self._ksp.setUp()
        except PETSc.Error as error:
            raise SolveError(f"the factorisation failed, PETSc's error {error.ierr}") from error

    def solve(self, b: PETSc.Vec) -> PETSc.Vec:
        """Solution of A x = b.

        Raises:
            SolveError: PETSc did not converge, or x is not finite, or it does not solve the system.
        """
        with self._clock("back-substitutions"):
            return self._solve(b)

    def _solve(self, b: PETSc.Vec) -> PETSc.Vec:
        x = self.A.createVecRight()
        self._ksp.solve(b, x)
        self.solves += 1
        reason = self._ksp.getConvergedReason()
        if reason <= 0:
            raise SolveError(
                f"the linear solve failed, PETSc's converged reason {reason}: the factorisation met a "
                "matrix that is not positive definite, or memory ran out"
            )
        self.A.mult(x, self._residual)
        self._residual.aypx(-1.0, b)
        residual = self._residual.norm() / b.norm()
        if not residual <= RESIDUAL_LIMIT:  # also catches NaN
            raise SolveError(
                f"the linear solve left |b - Ax|/|b| = {residual:.3g}, expected at most "
                f"{RESIDUAL_LIMIT:g}: the matrix is singular or nearly so"
            )
        self.largest_residual = max(self.largest_residual, residual)
        return x

    def destroy(self) -> None:
        """Free the factor's memory now; petsc4py would wait for a collective garbage collection."""
        for held in (self._ksp, self._residual, self.A):
            held.destroy()


def largest(x: PETSc.Vec) -> float:
    """Largest absolute entry over all ranks."""
    return float(x.norm(PETSc.NormType.NORM_INFINITY))


def array(x: PETSc.Vec) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Entries owned by this rank, a view."""
    return x.getArray(readonly=True)
