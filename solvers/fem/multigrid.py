"""Conjugate gradients with algebraic multigrid: for matrices whose factor does not fit into memory."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.clock import Clock
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.direct import PREFIX, defaults

#: |b - Ax|/|b| that is asked for. Contact forces need more; refinement gives it.
TOLERANCE = 1e-10
LIMIT = 1000

#: PETSc's options by the name that scenes use; those of the options database go before them.
#: HMIS coarsening with extended interpolation takes a sixth fewer steps than BoomerAMG's default, and a
#: step with Chebyshev's smoother costs a third. GAMG wants the rigid motions.
OPTIONS: dict[str, dict[str, object]] = {
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
        solves: solves done.
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
        with clock("multigrid set-up"), defaults(OPTIONS[chosen]):
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
        """Free what PETSc holds."""
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
