"""Linear solvers of PETSc: factors of symmetric and unsymmetric matrices, and algebraic multigrid.

:class:`Factor` is PETSc's direct solver with the checks that PETSc leaves to its caller.
:class:`Multigrid` runs conjugate gradients with algebraic multigrid, for matrices whose factor does not
fit into memory. :class:`UnsymmetricFactor` is the direct solver for matrices that are not symmetric, on
one rank.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.sparse import csr_matrix

from galinx.clock import Clock

from ..errors import SolveError

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
        solves: number of back-substitutions.
        iterations: 0, as for every direct solver.
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
                f"the factorisation ran out of memory (MUMPS's status {status}); it needs {largest} MB "
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
            solutions = []
            for b, column in zip(loads, X.getDenseArray().T):
                x = self.A.createVecRight()
                x.setArray(column)
                self._check(x, b)
                solutions.append(x)
            B.destroy(), X.destroy()
            return solutions

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
    """Put options that the user has not set into PETSc's database, for as long as they are needed."""
    database = PETSc.Options(PREFIX)
    pushed = [name for name in options if not database.hasName(name)]
    for name in pushed:
        database[name] = options[name]
    try:
        yield
    finally:
        for name in pushed:
            database.delValue(name)


#: Largest |b - Ax|/|b|. Contact forces need more; refinement gives it.
TOLERANCE = 1e-10
LIMIT = 1000

#: PETSc's options by the name that scenes use; those of the options database go before them.
#: HMIS coarsening with extended interpolation takes a sixth fewer steps than BoomerAMG's default, and a
#: step with Chebyshev's smoother costs a third. GAMG wants the rigid motions.
PRECONDITIONERS: dict[str, dict[str, object]] = {
    "boomeramg": {
        "pc_type": "hypre",
        "pc_hypre_type": "boomeramg",
        "pc_hypre_boomeramg_strong_threshold": 0.5,
        "pc_hypre_boomeramg_coarsen_type": "HMIS",
        "pc_hypre_boomeramg_interp_type": "ext+i",
        "pc_hypre_boomeramg_relax_type_all": "Chebyshev",
    },
    "gamg": {"pc_type": "gamg", "pc_gamg_threshold": 0.02, "mg_levels_ksp_max_it": 3},
}


def available() -> tuple[str, ...]:
    """Multigrids that the installed PETSc has, the best first."""
    return ("boomeramg", "gamg") if PETSc.Sys.hasExternalPackage("hypre") else ("gamg",)


class Multigrid:
    """Conjugate gradients for a symmetric positive definite matrix and many right-hand sides.

    Args:
        A: the matrix; it belongs to the solver from now on.
        clock: takes the time of set-up and solves.
        kind: a name of ``OPTIONS``, or ``"multigrid"`` for the best that PETSc has.
        rigid: the three rigid motions at this rank's rows, (rows, 3).

    Attributes:
        solves: number of solves.
        iterations: the most that a solve took.
        condition: 0, it is not estimated.
        largest_residual: the largest |b - Ax|/|b| met so far, dimensionless.
    """

    def __init__(self, A: PETSc.Mat, clock: Clock, kind: str, rigid: NDArray[np.float64]) -> None:
        A.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        A.setOption(PETSc.Mat.Option.SPD, True)
        self.A, self.solves, self.iterations = A, 0, 0
        self.condition, self.largest_residual = 0.0, 0.0
        self._clock = clock
        A.setNearNullSpace(_orthonormal(A, rigid.T))
        chosen = available()[0] if kind == "multigrid" else kind
        if chosen not in available():
            raise SolveError(
                f"this PETSc has no {chosen}, only {', '.join(available())}; name another solver"
            )
        with clock("multigrid set-up"), defaults(PRECONDITIONERS[chosen]):
            self._ksp = PETSc.KSP().create(A.comm)
            self._ksp.setOptionsPrefix(PREFIX)
            self._ksp.setOperators(A)
            self._ksp.setType(PETSc.KSP.Type.CG)
            self._ksp.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
            self._ksp.setTolerances(rtol=TOLERANCE, max_it=LIMIT)
            self._ksp.setFromOptions()
            self._ksp.setUp()

    def solve(self, b: PETSc.Vec) -> PETSc.Vec:
        """Solution of A x = b.

        Raises:
            SolveError: conjugate gradients did not converge.
        """
        with self._clock("multigrid solves"):
            x = self.A.createVecRight()
            self._ksp.solve(b, x)
        self.solves += 1
        self.iterations = max(self.iterations, self._ksp.getIterationNumber())
        residual = self._ksp.getResidualNorm() / b.norm()
        if self._ksp.getConvergedReason() <= 0:
            raise SolveError(
                f"conjugate gradients left |b - Ax|/|b| = {residual:.3g} after "
                f"{self._ksp.getIterationNumber()} steps, expected {TOLERANCE:g}; near the Rayleigh "
                'speed the matrix is nearly singular: use solver = "direct"'
            )
        self.largest_residual = max(self.largest_residual, residual)
        return x

    def solve_all(self, loads: Sequence[PETSc.Vec]) -> list[PETSc.Vec]:
        """Solutions of A x = b for several b, one after the other."""
        return [self.solve(b) for b in loads]

    def destroy(self) -> None:
        """Free PETSc's memory now."""
        self._ksp.destroy(), self.A.destroy()


def _orthonormal(A: PETSc.Mat, modes: Iterable[NDArray]) -> PETSc.NullSpace:
    basis: list[PETSc.Vec] = []
    for mode in modes:
        x = A.createVecRight()
        x.setArray(np.ascontiguousarray(mode))
        for earlier in basis:
            x.axpy(-x.dot(earlier), earlier)
        x.normalize()
        basis.append(x)
    return PETSc.NullSpace().create(vectors=basis, comm=A.comm)


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
            SolveError: a solution does not solve its system.
        """
        with self._clock("back-substitutions"):
            if b.ndim == 1:
                x, y = (PETSc.Vec().createWithArray(np.array(b), comm=PETSc.COMM_SELF) for _ in range(2))
                self._mumps.solve(x, y)
                solution = np.array(y.array_r)
                x.destroy(), y.destroy()
            else:
                solution = self._many(b)
        if not self._checked or b.ndim == 2:
            residual = float(np.linalg.norm(self._A @ solution - b)) / max(
                float(np.linalg.norm(b)), 1e-300
            )
            if np.any(b) and not residual <= _RESIDUAL:
                raise SolveError(
                    f"a linear solve left |b - Ax|/|b| = {residual:.3g}, expected {_RESIDUAL:g}"
                )
            self._checked = True
        return solution

    def _many(self, b: NDArray) -> NDArray[np.float64]:
        loads = PETSc.Mat().createDense(b.shape, array=np.asfortranarray(b), comm=PETSc.COMM_SELF)
        solutions = PETSc.Mat().createDense(b.shape, comm=PETSc.COMM_SELF)
        solutions.setUp()
        self._mumps.matSolve(loads, solutions)
        values = np.array(solutions.getDenseArray())
        loads.destroy(), solutions.destroy()
        return values

    def destroy(self) -> None:
        """Free the factors' memory now."""
        for held in (self._mumps, self._pc, self._matrix):
            held.destroy()
