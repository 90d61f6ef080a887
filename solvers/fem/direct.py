"""PETSc's direct solver with the checks that PETSc leaves to its caller."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager

import numpy as np
from petsc4py import PETSc

from galinx.clock import Clock
from galinx.solvers.errors import SolveError

#: Prefix of the options database, so that ``-galinx_ksp_view`` and the like work.
PREFIX = "galinx_"

#: PETSc's options for MUMPS: in the plane the last front is too small to be spread over all ranks.
OPTIONS = {"mat_mumps_icntl_13": 1}

#: A direct solve that leaves more than this of its right-hand side has met a singular matrix, which
#: leaves about all of it. What less means for the results is measured on them: near the Rayleigh speed
#: the body moves far, so that a sound factor leaves 1e-7 where K_I has its seven digits.
RESIDUAL_LIMIT = 1e-4

#: Unknowns up to which the condition number is estimated; it then costs next to nothing.
ANALYSED = 200_000

#: MUMPS's statuses for a workspace that it estimated too small, and for memory that it did not get.
_TOO_SMALL = (-8, -9, -11, -14, -15, -17, -20)
_MEMORY = (-5, -7, -13, -19, -22)
#: Percent by which MUMPS enlarges its estimate of the workspace: its own default, then once more.
WORKSPACE = (35, 400)

#: Numbers of right-hand sides that are solved for at once: three times 64 MB.
_AT_ONCE = 8_000_000


class Factor:
    """Factor of a symmetric matrix, kept for many right-hand sides.

    Args:
        A: the matrix; it belongs to the factor from now on.
        clock: takes the time of factorisation and back-substitutions.
        definite: positive definite, so that Cholesky's method needs no pivots.

    Attributes:
        solves: back-substitutions done.
        iterations: 0, as of every direct solver.
        condition: MUMPS's estimate of the condition number, known after the first solve; 0 for a matrix
            of more than ``ANALYSED`` unknowns.
        largest_residual: the largest |b - Ax|/|b| met so far, dimensionless.
    """

    def __init__(self, A: PETSc.Mat, clock: Clock, definite: bool = True) -> None:
        A.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        A.setOption(PETSc.Mat.Option.SPD, definite)
        self.A, self.solves, self.iterations, self.largest_residual = A, 0, 0, 0.0
        self._clock = clock
        self._residual = A.createVecLeft()
        self.condition = 0.0
        with clock("factorisation"), defaults(OPTIONS):
            for percent in WORKSPACE:
                self._factorise(percent)
                if self._mumps.getMumpsInfog(1) not in _TOO_SMALL or percent == WORKSPACE[-1]:
                    break
                self._mumps.destroy(), self._ksp.destroy()
        self._check_factor()

    def _factorise(self, percent: int) -> None:
        self._ksp = PETSc.KSP().create(self.A.comm)
        self._ksp.setOptionsPrefix(PREFIX)
        self._ksp.setOperators(self.A)
        self._ksp.setType(PETSc.KSP.Type.PREONLY)
        pc = self._ksp.getPC()
        pc.setType(PETSc.PC.Type.CHOLESKY)
        pc.setFactorSolverType("mumps")
        self._ksp.setFromOptions()
        pc.setFactorSetUpSolverType()
        self._mumps = pc.getFactorMatrix()
        self._mumps.setMumpsIcntl(14, percent)
        try:
            self._ksp.setUp()
        except PETSc.Error as error:
            raise SolveError(f"the factorisation failed, PETSc's error {error.ierr}") from error

    def _check_factor(self) -> None:
        status = self._mumps.getMumpsInfog(1)
        if status == 0:
            return
        if status in _MEMORY + _TOO_SMALL:
            largest, total = (self._mumps.getMumpsInfog(i) for i in (16, 17))
            raise SolveError(
                f"the factorisation ran out of memory (MUMPS's status {status}); it wanted {largest} MB "
                f"a rank, {total} MB in all: use more ranks, a larger tolerance, or more memory"
            )
        raise SolveError(
            f"the factorisation failed (MUMPS's status {status}): the matrix is singular or not positive "
            "definite, as above the Rayleigh speed"
        )

    def solve(self, b: PETSc.Vec) -> PETSc.Vec:
        """Solution of A x = b.

        Raises:
            SolveError: PETSc did not converge, or x is not finite, or it does not solve the system.
        """
        with self._clock("back-substitutions"):
            if self.solves or b.getSize() > ANALYSED:
                return self._solve(b)
            self._mumps.setMumpsIcntl(11, 1)  # error analysis, worth a few back-substitutions
            x = self._solve(b)
            self._mumps.setMumpsIcntl(11, 0)
            self.condition = self._mumps.getMumpsRinfog(10)
            return x

    def solve_all(self, loads: Sequence[PETSc.Vec]) -> list[PETSc.Vec]:
        """Solutions of A x = b for several b at once, for which the factor is read once.

        Raises:
            SolveError: a solution is not finite, or does not solve its system.
        """
        if len(loads) == 1 or not self.solves:
            # The first alone gives the condition number, which several at once do not.
            first, rest = self.solve(loads[0]), loads[1:]
            return [first, *(self.solve_all(rest) if rest else [])]
        few = max(_AT_ONCE // loads[0].getSize(), 1)
        if len(loads) > few:
            return [*self.solve_all(loads[:few]), *self.solve_all(loads[few:])]
        with self._clock("back-substitutions"):
            rows = (loads[0].getLocalSize(), loads[0].getSize())
            B = PETSc.Mat().createDense((rows, (PETSc.DECIDE, len(loads))), comm=self.A.comm)
            B.setUp()
            B.getDenseArray()[:] = np.column_stack([b.array_r for b in loads])
            B.assemble()
            X = B.duplicate()
            self._mumps.matSolve(B, X)
            found = []
            for b, column in zip(loads, X.getDenseArray().T):
                x = self.A.createVecRight()
                x.setArray(column)
                self._check(x, b)
                found.append(x)
            B.destroy(), X.destroy()
            return found

    def _solve(self, b: PETSc.Vec) -> PETSc.Vec:
        x = self.A.createVecRight()
        self._ksp.solve(b, x)
        reason = self._ksp.getConvergedReason()
        if reason <= 0:
            raise SolveError(
                f"the linear solve failed, PETSc's converged reason {reason}: the right-hand side or the "
                "matrix is not finite, or memory ran out"
            )
        self._check(x, b)
        return x

    def _check(self, x: PETSc.Vec, b: PETSc.Vec) -> None:
        self.A.mult(x, self._residual)
        self._residual.aypx(-1.0, b)
        residual = self._residual.norm() / b.norm()
        if not residual <= RESIDUAL_LIMIT:  # also catches NaN
            raise SolveError(
                f"the linear solve left |b - Ax|/|b| = {residual:.3g}, expected at most "
                f"{RESIDUAL_LIMIT:g}: the matrix is singular or nearly so"
            )
        self.largest_residual = max(self.largest_residual, residual)
        self.solves += 1

    def destroy(self) -> None:
        """Free the factor's memory now; petsc4py would wait for a collective garbage collection."""
        for held in (self._mumps, self._ksp, self._residual, self.A):
            held.destroy()


@contextmanager
def defaults(options: Mapping[str, object]) -> Iterator[None]:
    """Puts options that the user has not given into PETSc's database, for as long as they are needed."""
    database = PETSc.Options(PREFIX)
    pushed = [name for name in options if not database.hasName(name)]
    for name in pushed:
        database[name] = options[name]
    try:
        yield
    finally:
        for name in pushed:
            database.delValue(name)
