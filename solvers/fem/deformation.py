"""What cells tell of fields by their deformation alone, to its last digits.

All of the half-plane moves with a load, and near the end of a load cells are a billionth of that motion:
in their displacement the deformation has lost its digits. It has them in a field and a small correction,
if these are added only after each cell's own motion is gone.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import Response


def forces(space: Space, response: Response, field: PETSc.Vec) -> PETSc.Vec:
    """Nodal forces of a condensed field; collective.

    The matrix times the field is the same, but for what rounding makes of the cells' motion.
    """
    result, numbers = field.duplicate(), space.outer_numbers
    result.zeroEntries()
    deformed = _deformed(space, [field])
    for cells in space.pieces(len(numbers)):
        condensed = space.condensed(response, cells)
        for rows, S, u in zip(numbers[cells] // 2, condensed, deformed[cells]):
            result.setValuesBlocked(rows, S @ u.ravel(), addv=PETSc.InsertMode.ADD_VALUES)
    result.assemble()
    return result


def shapes(
    space: Space, response: Response, fields: Sequence[PETSc.Vec], corrections: Sequence[PETSc.Vec]
) -> NDArray[np.float64]:
    """Values of fields plus corrections in all of this rank's cells, less those of a cell's first node.

    Collective.

    Returns:
        Array (cells, nodes of a cell, 2, fields).
    """
    outer = _deformed(space, fields) + _deformed(space, corrections)
    pieces = [space.extended(outer[:0], response, np.arange(0))]
    numbers = np.arange(len(outer))
    for cells in space.pieces(len(outer)):
        pieces.append(space.extended(outer[cells], response, numbers[cells]))
    return np.concatenate(pieces)


def _deformed(space: Space, fields: Sequence[PETSc.Vec]) -> NDArray[np.float64]:
    """Outer values of all of this rank's cells, displacements less that of the cell's first node."""
    outer = space.fetch(fields, space.outer_numbers)
    displacement = outer[:, : len(space.kernel.outer)]
    displacement -= displacement[:, :1].copy()
    return outer
