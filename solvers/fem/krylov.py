"""The Krylov space in which the contact forces of every friction lie, made by Arnoldi's method."""

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc
from scipy.linalg import schur

from galinx.solvers.errors import SolveError

#: Least relative residual of contact forces that is asked for; the last digits are rounding.
LEAST = 1e-13
LIMIT = 120

#: Numbers of frictions up to which each is solved for itself; beyond, all share a triangular form.
_FEW = 40


class KrylovSpace:
    """The space of (T, R₀), by Arnoldi's method.

    Args:
        field: the punch without friction.
        forces: its forces in X and Y at the contact nodes, (2, n).
        refines: solutions are refined.
        left: relative residual of the contact forces that may be left, if it is above the least.

    Attributes:
        fields, forces: the first, then those of each tangential load.
        complete: the space holds every answer.
    """

    def __init__(self, field: PETSc.Vec, forces: NDArray, refines: bool, left: float) -> None:
        self.fields, self.forces, self.refines = [field], [forces], refines
        self._left = max(left, LEAST)
        self._size = np.linalg.norm(forces[1])
        self._V = [forces[1] / self._size]
        self._H = np.zeros((LIMIT + 1, LIMIT))
        self._triangle = np.empty((0, 0)), np.empty((0, 0))
        self.complete = False

    @property
    def last(self) -> NDArray[np.float64]:
        """The load that is not yet applied, (n,)."""
        return self._V[len(self.fields) - 1]

    def take(self, field: PETSc.Vec, forces: NDArray) -> None:
        """One Arnoldi step: the field and the forces that the last load causes."""
        j = len(self.fields) - 1
        self.fields.append(field)
        self.forces.append(forces)
        w = forces[1]
        for _ in range(2):  # twice is enough
            h = np.array(self._V) @ w
            self._H[: j + 1, j] += h
            w = w - np.array(self._V).T @ h
        self._H[j + 1, j] = np.linalg.norm(w)
        # A happy breakdown: the space holds every answer.
        self.complete = bool(self._H[j + 1, j] <= 1e-15 * np.linalg.norm(self._H[: j + 1, j]))
        if not self.complete:
            self._V.append(w / self._H[j + 1, j])

    def converged(self, g: NDArray) -> NDArray[np.float64] | None:
        """Coefficients y of R = V y for every g, (states, m); None where the space is too small.

        Raises:
            SolveError: it has grown to its limit.
        """
        m = len(self.fields) - 1
        if not m:
            return None
        y, left = self.solve(g)
        worst = int(np.argmax(left))
        if self.complete or left[worst] <= self._left:
            return y
        if m == LIMIT:
            raise SolveError(
                f"the contact forces at g = {g[worst]:g} (dimensionless) did not converge in "
                f"{LIMIT} steps: residual {left[worst]:.3g}, wanted {self._left:g}"
            )
        return None

    def solve(self, g: NDArray) -> tuple[NDArray, NDArray]:
        """Coefficients y of R = V y for every g, (states, m), and their relative residuals, (states,)."""
        m = len(self.fields) - 1
        if len(g) <= _FEW:
            first = np.zeros((len(g), m, 1))
            first[:, 0] = self._size
            y = np.linalg.solve(np.eye(m) - g[:, None, None] * self._H[:m, :m], first)[..., 0]
            return y, self._residuals(g, y)
        T, Q = self._triangle
        if len(T) != m:  # once for all g: Schur's form keeps the digits that eigenvectors may lose
            T, Q = self._triangle = schur(self._H[:m, :m], output="complex")
        solved = np.tile((self._size * Q[0].conj())[:, None], len(g))
        for i in reversed(range(m)):
            solved[i] += g * (T[i, i + 1 :] @ solved[i + 1 :])
            solved[i] /= 1.0 - g * T[i, i]
        y = (Q @ solved).real.T
        return y, self._residuals(g, y)

    def _residuals(self, g: NDArray, y: NDArray) -> NDArray[np.float64]:
        """Of coefficients (states, m), relative, (states,)."""
        m = y.shape[1]
        return np.asarray(np.abs(g * self._H[m, m - 1] * y[:, -1]) / np.linalg.norm(y, axis=1))
