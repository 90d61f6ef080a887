"""Linear systems by PETSc: factors of symmetric and unsymmetric matrices, and algebraic multigrid.

:class:`LinearSolver` keeps a factor, or conjugate gradients with algebraic multigrid for matrices whose
factor does not fit into memory, with the checks that PETSc leaves to its caller. Both are options of
PETSc (:data:`METHODS`).
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.sparse import csr_matrix

from galinx.clock import Clock

from ..errors import SolveError

#: Prefix of the options database, so that ``-galinx_ksp_view`` and the like work.
PREFIX = "galinx_"

#: Largest |b - Ax|/|b| that conjugate gradients leave, and the most steps. Contact forces need more;
#: refinement gives it.
TOLERANCE = 1e-10
LIMIT = 1000

#: In the plane the last front is too small to be spread over all ranks (ICNTL(13)). Approximate minimum
#: degree leaves a tenth less fill than what MUMPS chooses without libraries for graphs (ICNTL(7)).
_MUMPS = {
    "ksp_type": "preonly",
    "pc_factor_mat_solver_type": "mumps",
    "mat_mumps_icntl_13": 1,
    "mat_mumps_icntl_7": 6,
}
_GRADIENTS = {
    "ksp_type": "cg", "ksp_norm_type": "unpreconditioned", "ksp_rtol": TOLERANCE, "ksp_max_it": LIMIT,
}  # fmt: skip

#: PETSc's options by the name of a solver; those of the options database go before them.
#: HMIS coarsening with extended interpolation takes a sixth fewer steps than BoomerAMG's default, and a
#: step with Chebyshev's smoother costs a third. GAMG wants the rigid motions.
METHODS: dict[str, dict[str, object]] = {
    "direct": _MUMPS | {"pc_type": "cholesky"},
    "unsymmetric": _MUMPS | {"pc_type": "lu"},
    "boomeramg": _GRADIENTS
    | {
        "pc_type": "hypre",
        "pc_hypre_type": "boomeramg",
        "pc_hypre_boomeramg_strong_threshold": 0.5,
        "pc_hypre_boomeramg_coarsen_type": "HMIS",
        "pc_hypre_boomeramg_interp_type": "ext+i",
        "pc_hypre_boomeramg_relax_type_all": "Chebyshev",
    },
    "gamg": _GRADIENTS | {"pc_type": "gamg", "pc_gamg_threshold": 0.02, "mg_levels_ksp_max_it": 3},
}

#: A direct solve that leaves more than this of its right-hand side has met a singular matrix, which
#: leaves about all of it. What less means for the results is measured on them: near the Rayleigh speed
#: the body moves far, so that a sound factor leaves 1e-7 where K_I has its seven digits.
RESIDUAL_LIMIT = 1e-4

#: MUMPS's statuses for a workspace that it estimated too small, and for memory that it did not get.
_TOO_SMALL = (-8, -9, -11, -14, -15, -17, -20)
_MEMORY = (-5, -7, -13, -19, -22)
#: Percent by which MUMPS enlarges its estimate of the workspace: its own default, then once more.
WORKSPACE = (35, 400)

#: Numbers of right-hand sides that are solved for at once: three times 64 MB.
_AT_ONCE = 8_000_000


def available() -> tuple[str, ...]:
    """Multigrids that the installed PETSc has, the best first."""
    return ("boomeramg", "gamg") if PETSc.Sys.hasExternalPackage("hypre") else ("gamg",)


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


class LinearSolver:
    """Solver of one matrix, kept for many right-hand sides.

    Args:
        A: the matrix; it belongs to the solver from now on.
        clock: takes the time of set-up and solves.
        method: a name of :data:`METHODS`, or ``"multigrid"`` for the best that PETSc has.
        definite: a symmetric matrix is positive definite, so that Cholesky's method needs no pivots.
        places: coordinates of the nodes at this rank's rows, (rows,), by which multigrid knows the rigid
            motions of the plane; a factor needs none.

    Attributes:
        direct: True where a factor is kept.
        solves: number of right-hand sides that were solved for.
        iterations: the most steps of conjugate gradients that a solve took; 0 of a factor.
        condition: lower bound of the condition number in the maximum norm, |A| |x|/|b| of the solutions.
        largest_residual: the largest |b - Ax|/|b| met so far, dimensionless.

    Raises:
        SolveError: the matrix cannot be factored, or PETSc lacks the method.
    """

    def __init__(
        self, A: PETSc.Mat, clock: Clock, method: str = "direct", definite: bool = True,
        places: NDArray[np.float64] | None = None,
    ) -> None:  # fmt: skip
        chosen = available()[0] if method == "multigrid" else method
        self.direct = "pc_factor_mat_solver_type" in METHODS[chosen]
        if not self.direct and chosen not in available():
            raise SolveError(
                f"this PETSc has no {chosen}, only {', '.join(available())}; name another solver"
            )
        A.setOption(PETSc.Mat.Option.SYMMETRIC, chosen != "unsymmetric")
        #: The matrix in the form that the method takes.
        self._operator = operator = A
        if "baij" in A.getType():
            self._operator = operator = A.convert("sbaij" if self.direct else "aij", out=PETSc.Mat())
        if chosen != "unsymmetric":
            operator.setOption(PETSc.Mat.Option.SYMMETRIC, True)
            operator.setOption(PETSc.Mat.Option.SPD, definite)
        if places is not None and not self.direct:
            coordinates = vector(A, places)
            coordinates.setBlockSize(2)
            operator.setNearNullSpace(PETSc.NullSpace().createRigidBody(coordinates))
        self.A, self.solves, self.iterations = A, 0, 0
        self.condition, self.largest_residual = 0.0, 0.0
        self._norm, self._clock = A.norm(PETSc.NormType.INFINITY), clock
        self._comm = A.comm.tompi4py()
        with clock("factorisation" if self.direct else "multigrid set-up"):
            for percent in WORKSPACE:
                room = {"mat_mumps_icntl_14": percent} if self.direct else {}
                self._set_up(METHODS[chosen] | room)
                status = self._mumps.getMumpsInfog(1) if self.direct else 0
                if status not in _TOO_SMALL or percent == WORKSPACE[-1]:
                    break
                self._free()
        if status:
            raise SolveError(f"the factorisation {self._reason(status)}")

    def _set_up(self, options: Mapping[str, object]) -> None:
        self._ksp = PETSc.KSP().create(self.A.comm)
        self._ksp.setOptionsPrefix(PREFIX)
        self._ksp.setOperators(self._operator)
        with defaults(options):
            self._ksp.setFromOptions()
            try:
                self._ksp.setUp()
            except PETSc.Error as error:
                raise SolveError(f"the factorisation failed, PETSc's error {error.ierr}") from error
        self._mumps: Any = self._ksp.getPC().getFactorMatrix() if self.direct else None

    def _reason(self, status: int) -> str:
        if status in _MEMORY + _TOO_SMALL:
            largest, total = (self._mumps.getMumpsInfog(i) for i in (16, 17))
            return (
                f"ran out of memory (MUMPS's status {status}); it needs {largest} MB a rank, {total} MB "
                "in all: use more ranks, a larger tolerance, or more memory"
            )
        return (
            f"failed (MUMPS's status {status}): the matrix is singular or not positive definite, as "
            "above the Rayleigh speed"
        )

    def solve(self, b: NDArray, checked: bool = True) -> NDArray[np.float64]:
        """Solutions at this rank's rows, (rows, n); a factor is read once for all right-hand sides.

        Args:
            b: right-hand sides at this rank's rows, (rows, n).
            checked: measure what a factor leaves of them; the caller does so if not, by :meth:`check`.

        Raises:
            SolveError: a solution is not finite, or does not solve its system.
        """
        x = self._solved(b)
        if checked:
            self.check(b, x)
        return x

    def _solved(self, b: NDArray) -> NDArray[np.float64]:
        self.solves += b.shape[1]
        with self._clock("back-substitutions" if self.direct else "multigrid solves"):
            if not self.direct:
                return np.column_stack([self._solve_one(column) for column in b.T])
            x = np.empty_like(b)
            count = max(_AT_ONCE // self.A.getSize()[0], 1)
            for start in range(0, b.shape[1], count):
                columns = slice(start, start + count)
                B = dense(self.A, b[:, columns])
                X = B.duplicate()
                self._mumps.matSolve(B, X)
                x[:, columns] = X.getDenseArray()
                B.destroy(), X.destroy()
            return x

    def _solve_one(self, load: NDArray) -> NDArray[np.float64]:
        """Solution by conjugate gradients, (rows,)."""
        b, x = vector(self.A, load), self.A.createVecRight()
        self._ksp.solve(b, x)
        steps, residual = self._ksp.getIterationNumber(), self._ksp.getResidualNorm() / b.norm()
        if self._ksp.getConvergedReason() <= 0:
            raise SolveError(
                f"conjugate gradients left |b - Ax|/|b| = {residual:.3g} after {steps} steps, "
                f"expected {TOLERANCE:g}; the matrix is nearly singular, as near the Rayleigh speed: use "
                'solver = "direct"'
            )
        self.iterations = max(self.iterations, steps)
        self.largest_residual = max(self.largest_residual, residual)
        solution = np.array(x.array_r)
        b.destroy(), x.destroy()
        return solution

    def check(self, b: NDArray, x: NDArray, residuals: NDArray | None = None) -> None:
        """Raise SolveError where a factor's solutions x leave too much of b, all (rows, n).

        Args:
            b, x: right-hand sides and solutions.
            residuals: b - Ax, computed if None.
        """
        if not self.direct:
            return
        left = self._squares(b - times(self.A, x) if residuals is None else residuals)
        for residual in np.sqrt(left / self._squares(b)):
            if not residual <= RESIDUAL_LIMIT:  # also catches NaN
                raise SolveError(
                    f"the linear solve left |b - Ax|/|b| = {residual:.3g}, expected at most "
                    f"{RESIDUAL_LIMIT:g}: the matrix is singular or nearly so"
                )
            self.largest_residual = max(self.largest_residual, float(residual))
        sizes = np.abs([x, b]).max(axis=1, initial=0.0)
        self._comm.Allreduce(MPI.IN_PLACE, sizes, MPI.MAX)
        self.condition = max(self.condition, float(self._norm * (sizes[0] / sizes[1]).max()))

    def _squares(self, columns: NDArray) -> NDArray[np.float64]:
        """Squares of the norms of columns, summed over ranks."""
        squares = np.einsum("ij,ij->j", columns, columns)
        self._comm.Allreduce(MPI.IN_PLACE, squares)
        return squares

    def destroy(self) -> None:
        """Free PETSc's memory now; petsc4py would wait for a collective garbage collection."""
        self._free()
        self._operator.destroy(), self.A.destroy()

    def _free(self) -> None:
        for held in (self._mumps, self._ksp):
            if held is not None:
                held.destroy()


def on_this_rank(A: csr_matrix) -> PETSc.Mat:
    """A SciPy matrix as one of PETSc, on this rank alone."""
    entries = (A.indptr.astype(np.int32), A.indices.astype(np.int32), A.data)
    return PETSc.Mat().createAIJ(A.shape, csr=entries, comm=PETSc.COMM_SELF)


def vector(A: PETSc.Mat, values: NDArray) -> PETSc.Vec:
    """A vector with these values at this rank's rows of a matrix."""
    x = A.createVecRight()
    x.setArray(values)
    return x


def dense(A: PETSc.Mat, columns: NDArray) -> PETSc.Mat:
    """A dense matrix of columns, (rows, n), at this rank's columns of another matrix."""
    B = PETSc.Mat().createDense((A.getSizes()[1], (PETSc.DECIDE, columns.shape[1])), comm=A.comm)
    B.setUp()
    B.getDenseArray()[:] = columns
    B.assemble()
    return B


def times(A: PETSc.Mat, columns: NDArray) -> NDArray[np.float64]:
    """A times columns of this rank's part, (columns of A, n): (rows of A, n); A is read once for all."""
    B = dense(A, columns)
    product = A.matMult(B)
    result = np.array(product.getDenseArray())
    B.destroy(), product.destroy()
    return result
