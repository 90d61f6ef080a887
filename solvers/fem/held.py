"""What is held: the contact, the far boundary, and the forces that this needs."""

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem.space import Space


def forces_of_profile(A: PETSc.Mat, space: Space, height: NDArray[np.float64]) -> PETSc.Vec:
    """Forces of a contact held at the profile's height, which stands where it is held."""
    held = A.createVecRight()
    held.setValues(space.contact.dofs(1), height[space.contact.owned])
    return _forces(A, space, held)


def forces_of_far(A: PETSc.Mat, space: Space, displacement: NDArray[np.float64]) -> PETSc.Vec:
    """Forces of a far boundary that moves, (2, nodes), which stands where it is held."""
    held, numbers = A.createVecRight(), space.numbers[space.far_nodes]
    for i in (0, 1):
        held.setValues(numbers + i, displacement[i])
    return _forces(A, space, held)


def _forces(A: PETSc.Mat, space: Space, held: PETSc.Vec) -> PETSc.Vec:
    """Forces of what is held at ``held``, and there the displacements themselves; frees ``held``."""
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
