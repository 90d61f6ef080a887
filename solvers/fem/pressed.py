"""A matrix with a rigid flat punch on its contact nodes, whose friction may be any.

Sought are x and the normal reactions r with A x = b + (g r along X, r along Y), x = -η along Y under the
punch, x = 0 far away, and Σ r given. With the normal reactions P of unit tangential forces ::

    (I - g P) r = ρ + η ρ_η

where ρ are those to b. The fields of these forces and of η are solved for once.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve
from scipy.sparse import csr_matrix

from galinx.clock import Clock
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.unsymmetric import UnsymmetricFactor


class Pressed:
    """A matrix of a space's unknowns under a punch.

    Args:
        A: the matrix.
        motion: tells which nodes are under the punch, and which far away.
        clock: takes the time of what is done.

    Raises:
        SolveError: the matrix could not be factorised.
    """

    def __init__(self, A: csr_matrix, motion: Motion, clock: Clock) -> None:
        self._Y, X = 2 * motion.contact + 1, 2 * motion.contact
        held = np.zeros(motion.size, dtype=bool)
        held[self._Y] = True
        held[2 * motion.far] = held[2 * motion.far + 1] = True
        self._free = np.flatnonzero(~held)
        self._factor = UnsymmetricFactor(A[self._free][:, self._free].tocsr(), clock)
        self._rows = A[self._Y].tocsr()
        place = np.full(motion.size, -1)
        place[self._free] = np.arange(len(self._free))
        loads = np.zeros((len(self._free), len(X) + 1))
        loads[place[X], np.arange(len(X))] = 1.0
        # The contact moves by -1 along Y.
        loads[:, -1] = np.asarray(A[self._free][:, self._Y].sum(axis=1)).ravel()
        self._fields = np.zeros((motion.size, len(X) + 1))
        self._fields[self._free] = self._factor.solve(loads)
        self._fields[self._Y, -1] = -1.0
        self._reactions = self._rows @ self._fields

    def solve(
        self, b: NDArray, g: float, total: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """x and normal reactions r with Σ r = total, for forces b and friction g."""
        x = np.zeros(len(b))
        x[self._free] = self._factor.solve(b[self._free])
        ρ = self._rows @ x - b[self._Y]
        P, ρ_η = self._reactions[:, :-1], self._reactions[:, -1]
        found = lu_solve(lu_factor(np.eye(len(P)) - g * P), np.column_stack([ρ, ρ_η]))
        parts = found.sum(axis=0)
        η = (total - parts[0]) / parts[1]
        r = found[:, 0] + η * found[:, 1]
        x += self._fields @ np.append(g * r, η)
        return x, r

    def destroy(self) -> None:
        """Free the factor."""
        self._factor.destroy()
