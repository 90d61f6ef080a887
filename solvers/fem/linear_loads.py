"""Half-plane under the two linear loads of an interval: with these every piece of a pressure is made.

The half-plane has no length of its own, so the interval is [-1, 1] and one mesh serves pieces of every
width. Displacements are known relative to each cell's own place, to the last digits of how the cell
deforms: next to an end of the interval a cell is a billionth of the distance that all of it moves.
"""

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.fem.deformation import shapes
from galinx.solvers.fem.interior import gradients_at
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.traction import LoadedHalfPlane
from galinx.solvers.solids.solid import Response

#: Fields: of σ_YY that falls from 1 at -1 to 0 at 1 and of σ_XY equal to it, and of their mirror images.
FIELDS = 4


class LinearLoads:
    """Displacement gradients of the ``FIELDS``; collective.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.

    Attributes:
        resultants: ∫ σ_YY dX of the discrete loads of the first and of the second kind, 1 each.
        factor: of the linear system, freed, with numbers of its work.
    """

    def __init__(self, space: Space, response: Response) -> None:
        self.space, self.response = space, response
        with space.keeping(response):
            loaded = LoadedHalfPlane(space, response, corrected=True)
            try:
                loaded.load(lambda left, right: right / 2.0)
                loaded.load(lambda left, right: left / 2.0)
                self._shapes = shapes(space, response, loaded.fields, loaded.corrections)
            finally:
                loaded.destroy()
        self.resultants, self.factor = np.array(loaded.resultants), loaded.factor

    def gradients(self, points: NDArray) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over the load's largest stress, at points (n, 2) with Y <= 0: (n, 2, 2, FIELDS).

        Raises:
            MeshError: a point lies outside the mesh.
        """
        return gradients_at(self.space, self.response, points, lambda cells: self._shapes[cells])
