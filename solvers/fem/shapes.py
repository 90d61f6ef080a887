"""Shape functions of a cell and their slopes at the points of a rule."""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from galinx.solvers.fem import cells
from galinx.solvers.fem.lagrange import lagrange


@dataclass(frozen=True)
class Shapes:
    """Of the unit square, by Gauss's rule that is exact for their products on parallelograms.

    Attributes:
        t: points, (points, 2).
        weights: of these, (points,).
        values: (points, nodes).
        slopes: along both directions of the square, (2, points, nodes).
    """

    t: NDArray[np.float64]
    weights: NDArray[np.float64]
    values: NDArray[np.float64]
    slopes: NDArray[np.float64]

    @classmethod
    def of(cls, reference: NDArray) -> "Shapes":
        """Of the nodes at places in the unit square, (nodes, 2)."""
        grid, nodes = cells.tensor_order(reference)
        x, w = leggauss(len(nodes) + 1)
        x, w = (x + 1.0) / 2.0, w / 2.0
        value, slope = lagrange(nodes, x)
        t = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
        place = np.argsort(grid.ravel())
        φ, along, across = (
            np.einsum("qi,rj->qrij", a, b).reshape(len(t), -1)[:, place]
            for a, b in ((value, value), (slope, value), (value, slope))
        )
        return cls(t, np.outer(w, w).ravel(), φ, np.array([along, across]))

    def on(self, corners: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Weights, and what makes derivatives along the axes of those along a cell's directions.

        Args:
            corners: of a cell, (4, 2).

        Returns:
            Arrays (points,) and [point, direction, axis].
        """
        J = cells.jacobian(corners, self.t)
        weights = np.asarray(self.weights * np.abs(np.linalg.det(J)), dtype=np.float64)
        return weights, np.asarray(np.linalg.inv(J), dtype=np.float64)
