"""Displacements that are held, and the far boundary, which moves as in an infinite solid.

The contact and the far boundary are held; the forces that this needs are :func:`forces_of_profile` and
:func:`forces_of_far`.

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

from ..solids.solid import Far, Response
from .space import Space


def forces_of_profile(A: PETSc.Mat, space: Space, height: NDArray[np.float64]) -> PETSc.Vec:
    """Nodal forces of a contact held at the profile's height; at held unknowns, the height itself."""
    held = A.createVecRight()
    held.setValues(space.contact.dofs(1), height[space.contact.owned])
    return _forces(A, space, held)


def forces_of_far(A: PETSc.Mat, space: Space, displacement: NDArray[np.float64]) -> PETSc.Vec:
    """Nodal forces of a far boundary moved by (2, nodes); at held unknowns, the displacement itself."""
    held, numbers = A.createVecRight(), space.numbers[space.far_nodes]
    for i in (0, 1):
        held.setValues(numbers + i, displacement[i])
    return _forces(A, space, held)


def _forces(A: PETSc.Mat, space: Space, held: PETSc.Vec) -> PETSc.Vec:
    """Nodal forces of held displacements, and these themselves where they are held; frees ``held``."""
    held.assemble()
    b = product(A, held)
    b.scale(-1.0)
    set_zero(b, space.held_dofs)
    b.axpy(1.0, held)
    held.destroy()
    return b


def ones(A: PETSc.Mat, dofs: NDArray[np.int32]) -> PETSc.Vec:
    """A vector that is 1 at this rank's ``dofs`` and 0 elsewhere."""
    x = A.createVecRight()
    x.setValues(dofs, np.ones(len(dofs)))
    x.assemble()
    return x


def product(A: PETSc.Mat, x: PETSc.Vec) -> PETSc.Vec:
    y = A.createVecLeft()
    A.mult(x, y)
    return y


def set_zero(x: PETSc.Vec, dofs: NDArray[np.int32]) -> None:
    x.setValues(dofs, np.zeros(len(dofs)))
    x.assemble()


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
        loads: nodal forces of each of the fields, by moments of σ_YY and σ_XY in turn.
        fields: displacements, once they are solved for.
    """

    def __init__(self, space: Space, response: Response, A: PETSc.Mat) -> None:
        self.fields: list[PETSc.Vec] = []
        self.loads: list[PETSc.Vec] = []
        if space.terms:
            assert isinstance(response, Far)
            X, Y = space.contracted(response).to_physical(space.coordinates[space.far_nodes]).T
            moved = response.far(X, Y, space.terms)
            size = np.abs(moved).max(axis=(1, 2, 3), initial=0.0)
            space.comm.Allreduce(MPI.IN_PLACE, size, MPI.MAX)
            followed = moved[size > _NEGLIGIBLE * size[0]]
            # A rank may have no node of the far boundary, and takes part all the same.
            self.loads = [
                forces_of_far(A, space, displacement) for pair in followed for displacement in pair
            ]

    def tests(self, X: NDArray[np.float64]) -> NDArray[np.float64]:
        """Powers of positions X over a that forces are tested with, (moments, n)."""
        return np.vander(X, len(self.loads) // 2, increasing=True).T

    def set_fields(self, fields: Sequence[PETSc.Vec]) -> None:
        """Take the fields, and free the loads."""
        self.fields = list(fields)
        for load in self.loads:
            load.destroy()

    def take(self, X: NDArray[np.float64], forces: Sequence[NDArray[np.float64]]) -> None:
        """Take the forces (2, n) of each field at contact nodes at X over a."""
        self._tests, self._forces = self.tests(X), np.array(forces)
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
