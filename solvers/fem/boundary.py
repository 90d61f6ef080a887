"""Displacements that are held, and the far boundary, which moves as in an infinite solid.

The contact and the far boundary are held; the forces that this needs are :func:`held_forces`.

Far away a displacement is determined by moments of the forces at the contact, Mₙ = ∫ (X/a)ⁿ σ d(X/a): for
each of the first ones there is a field, of a far boundary that moves as under it. The solution under
forces f₀ with the boundary held becomes that in the infinite solid by adding these fields with the
moments that both have together,

    M = M(f₀) + B M,   B of the moments that the fields' own forces at the contact have.

After n moments the error goes as R⁻ⁿ⁻¹, R the distance over a: the first one that is left out has fallen
like R⁻ⁿ there, and what holds it reaches the contact as a strain, with R⁻¹.
"""

from collections.abc import Sequence

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from ..solids.half_plane import HalfPlane
from .linear import times
from .space import Space


def held_forces(
    A: PETSc.Mat, space: Space, dofs: NDArray[np.int32], displacements: NDArray
) -> NDArray[np.float64]:
    """Nodal forces of held displacements, and these themselves where unknowns are held: (rows, k).

    Args:
        A: the matrix, nothing held.
        space: the finite element space.
        dofs: owned unknowns that are moved, (n,).
        displacements: of each, (n, k).
    """
    first = A.getOwnershipRange()[0]
    held = np.zeros((A.getLocalSize()[0], displacements.shape[1]))
    held[dofs - first] = displacements
    b = -times(A, held)
    b[space.held_dofs - first] = 0.0
    return b + held


#: Displacement at the far boundary over that of line loads, below which a moment is not followed: its
#: effect at the contact is the square of that.
_NEGLIGIBLE = 1e-12


class FarBoundary:
    """Motion of the far boundary under the forces at the contact; none where the mesh holds it.

    Args:
        space: the finite element space, with the number of moments that the boundary follows.
        response: of the half-plane.
        A: the matrix, nothing held.

    Attributes:
        loads: nodal forces of each of the fields, by moments of σ_YY and σ_XY in turn, (rows, fields).
        fields: displacements, once they are solved for.
    """

    def __init__(self, space: Space, response: HalfPlane, A: PETSc.Mat) -> None:
        self.fields: list[PETSc.Vec] = []
        moved = np.empty((2 * len(space.far_nodes), 0))
        if space.terms:
            X, Y = space.contracted(response).to_physical(space.coordinates[space.far_nodes]).T
            by_moment = response.far(X, Y, space.terms)  # (moments, 2, component, nodes)
            size = np.abs(by_moment).max(axis=(1, 2, 3), initial=0.0)
            space.comm.Allreduce(MPI.IN_PLACE, size, MPI.MAX)
            followed = by_moment[size > _NEGLIGIBLE * size[0]]
            # A rank may have no node of the far boundary, and takes part all the same.
            moved = followed.reshape(2 * len(followed), -1).T
        self.loads = held_forces(A, space, space.far_dofs, moved)

    def tests(self, X: NDArray[np.float64]) -> NDArray[np.float64]:
        """Powers of positions X over a that forces are tested with, (moments, n)."""
        return np.vander(X, self.loads.shape[1] // 2, increasing=True).T

    def take(
        self, fields: Sequence[PETSc.Vec], X: NDArray[np.float64], forces: NDArray[np.float64]
    ) -> None:
        """Take the fields and the forces (2, n) of each at contact nodes at X over a."""
        self.fields, self._tests, self._forces = list(fields), self.tests(X), forces
        own = np.array([self._moments(force) for force in forces]).T
        self._all = np.linalg.inv(np.eye(len(own)) - own)

    def _moments(self, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Moments of forces (2, n) that the boundary follows, of σ_YY and σ_XY in turn, (moments,)."""
        return np.asarray((self._tests @ forces[::-1].T).ravel())

    def follow(self, forces: NDArray, field: PETSc.Vec | None = None) -> NDArray[np.float64]:
        """Forces (2, n) at the contact nodes once the far boundary moves that was held.

        Args:
            forces: those under the held boundary.
            field: displacement that causes them; it is moved in place.
        """
        if not self.fields:
            return forces
        amplitudes = self._all @ self._moments(forces)
        if field is not None:
            field.maxpy(amplitudes.tolist(), self.fields)
        return np.asarray(forces + np.tensordot(amplitudes, self._forces, 1))

    def destroy(self) -> None:
        """Free the fields."""
        for field in self.fields:
            field.destroy()
