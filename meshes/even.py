"""Even meshes for waves of given tractions: squares of one size, with nothing to refine for."""

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.rings import QuadMesh, tagged


@dataclass(frozen=True)
class Even:
    """A rectangle below the surface, of cells that do not cross X = -a and X = a.

    Attributes:
        half_width, depth: over a, more than 1 and 0.
        size: largest side of a cell over a.
    """

    half_width: float
    depth: float
    size: float

    def drawn(self) -> QuadMesh:
        """The mesh."""
        under = np.linspace(-1.0, 1.0, ceil(2.0 / self.size) + 1)
        beside = _even(1.0, self.half_width, self.size)
        X = np.concatenate([-beside[:0:-1], under, beside[1:]])
        Y = _even(-self.depth, 0.0, self.size)
        left, low = (grid.ravel() for grid in np.meshgrid(X[:-1], Y[:-1]))
        right, high = (grid.ravel() for grid in np.meshgrid(X[1:], Y[1:]))
        quads = np.array([[left, low], [right, low], [right, high], [left, high]])
        return tagged(np.moveaxis(quads, 2, 0), float(X[-1]))


def _even(first: float, last: float, size: float) -> NDArray[np.float64]:
    return np.linspace(first, last, max(ceil((last - first) / size), 1) + 1)
