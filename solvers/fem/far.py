"""What the far boundary does: it moves as in an infinite solid under whatever forces there are at the contact.

Far away a displacement is known by moments of these, Mₙ = ∫ (X/a)ⁿ σ d(X/a): of each of the first ones there is
a field, of a far boundary that moves as under it. What forces f cause is then that with the far boundary
held, f₀, and the sum of these fields with the moments that both together have,

    M = M(f₀) + B M,   B of the moments that the fields' own forces at the contact have.

What is left at the distance R is of the size R⁻²ⁿ after n moments: each falls like R⁻ⁿ out to there, and so
does what comes back.
"""

from collections.abc import Sequence

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem.held import forces_of_far
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import Response

#: Displacement at the far boundary over that of line loads, below which a moment is not followed: its
#: square is what would be seen at the contact.
_NEGLIGIBLE = 1e-12


class FarBoundary:
    """How the far boundary moves; it does not where the mesh holds it.

    Args:
        space: the finite element space, which says how many moments it follows.
        response: of the half-plane.
        A: the matrix, nothing held.

    Attributes:
        loads: nodal forces of each of the fields, by moments of σ_YY and σ_XY in turn.
        fields: displacements, once they are solved for.
    """

    def __init__(self, space: Space, response: Response, A: PETSc.Mat) -> None:
        self.fields: list[PETSc.Vec] = []
        self.loads: list[PETSc.Vec] = []
        if space.terms:
            X, Y = space.contracted(response).to_physical(space.coordinates[space.far_nodes]).T
            moved = response.far(X, Y, space.terms)
            size = np.abs(moved).max(axis=(1, 2, 3), initial=0.0)
            space.comm.Allreduce(MPI.IN_PLACE, size, MPI.MAX)
            followed = moved[size > _NEGLIGIBLE * size[0]].reshape(-1, *moved.shape[2:])
            self.loads = [forces_of_far(A, space, one) for one in followed]

    def moments(self, X: NDArray[np.float64], forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Moments that are followed of forces (2, n) in X and Y at positions X over a, of σ_YY and σ_XY in turn."""
        powers = X ** np.arange(len(self.loads) // 2)[:, None]
        return np.asarray((powers @ forces[::-1].T).ravel())

    def found(self, fields: Sequence[PETSc.Vec]) -> None:
        """Take the fields, and free the loads."""
        self.fields = list(fields)
        for load in self.loads:
            load.destroy()

    def take(self, X: NDArray[np.float64], forces: Sequence[NDArray[np.float64]]) -> None:
        """Learn the forces (2, n) of each field at contact nodes at X over a."""
        self._X, self._forces = X, np.array(forces)
        own = np.array([self.moments(X, one) for one in forces]).T
        self._all = np.linalg.inv(np.eye(len(own)) - own)

    def follow(self, field: PETSc.Vec, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Let a field, in place, have a far boundary that moves, not one that is held; returns its forces.

        Args:
            field, forces: displacement, and forces (2, n) at the contact nodes.
        """
        if not self.fields:
            return forces
        amplitudes = self._all @ self.moments(self._X, forces)
        field.maxpy(amplitudes.tolist(), self.fields)
        return np.asarray(forces + np.tensordot(amplitudes, self._forces, 1))

    def destroy(self) -> None:
        """Free the fields."""
        for field in self.fields:
            field.destroy()
