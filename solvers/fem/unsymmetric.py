"""PETSc's direct solver for matrices that are not symmetric, on one rank."""

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.sparse import csr_matrix

from galinx.clock import Clock
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.direct import PREFIX, WORKSPACE

#: Largest residual of a solution, over its right-hand side.
_RESIDUAL = 1e-6


class UnsymmetricFactor:
    """LU factors of a matrix, kept for many right-hand sides.

    Args:
        A: the matrix.
        clock: takes the time of factorisation and back-substitutions.

    Raises:
        SolveError: the factorisation failed.
    """

    def __init__(self, A: csr_matrix, clock: Clock) -> None:
        self._clock, self._A = clock, A
        parts = (A.indptr.astype(np.int32), A.indices.astype(np.int32), A.data)
        self._matrix = PETSc.Mat().createAIJ(A.shape, csr=parts, comm=PETSc.COMM_SELF)
        with clock("factorisation"):
            self._pc = PETSc.PC().create(PETSc.COMM_SELF)
            self._pc.setOptionsPrefix(PREFIX)
            self._pc.setOperators(self._matrix)
            self._pc.setType(PETSc.PC.Type.LU)
            self._pc.setFactorSolverType("mumps")
            self._pc.setFactorSetUpSolverType()
            self._mumps = self._pc.getFactorMatrix()
            self._mumps.setMumpsIcntl(14, WORKSPACE[-1])
            try:
                self._pc.setUp()
            except PETSc.Error as error:
                raise SolveError(f"the factorisation failed, PETSc's error {error.ierr}") from error
        if status := self._mumps.getMumpsInfog(1):
            raise SolveError(
                f"the factorisation failed (MUMPS's status {status}): memory ran out, or the matrix is "
                "singular; expected a shorter time.end or a larger solve.tolerance"
            )
        self._checked = False

    def solve(self, b: NDArray) -> NDArray[np.float64]:
        """Solutions for right-hand sides (n,) or (n, count).

        Raises:
            SolveError: a solution is not one.
        """
        with self._clock("back-substitutions"):
            if b.ndim == 1:
                x, y = (PETSc.Vec().createWithArray(np.array(b), comm=PETSc.COMM_SELF) for _ in range(2))
                self._mumps.solve(x, y)
                found = np.array(y.array_r)
                x.destroy(), y.destroy()
            else:
                found = self._many(b)
        if not self._checked or b.ndim == 2:
            left = float(np.linalg.norm(self._A @ found - b)) / max(float(np.linalg.norm(b)), 1e-300)
            if np.any(b) and not left <= _RESIDUAL:
                raise SolveError(f"a linear solve left |b - Ax|/|b| = {left:.3g}, expected {_RESIDUAL:g}")
            self._checked = True
        return found

    def _many(self, b: NDArray) -> NDArray[np.float64]:
        given = PETSc.Mat().createDense(b.shape, array=np.asfortranarray(b), comm=PETSc.COMM_SELF)
        found = PETSc.Mat().createDense(b.shape, comm=PETSc.COMM_SELF)
        found.setUp()
        self._mumps.matSolve(given, found)
        values = np.array(found.getDenseArray())
        given.destroy(), found.destroy()
        return values

    def destroy(self) -> None:
        """Free the factors' memory now."""
        for held in (self._mumps, self._pc, self._matrix):
            held.destroy()
