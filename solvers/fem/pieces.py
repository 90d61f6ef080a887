"""Fields of a pressure that is linear between knots: the sum of those of its pieces.

Every piece is an interval with two linear loads on the mesh of all, so no kink of the pressure lies
inside a cell, however narrow the piece is.
"""

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.fem.linear_loads import FIELDS, LinearLoads
from galinx.solvers.rays import NEAR, rays

#: Pieces that meet have at most this ratio of widths, so that both meshes resolve what cancels there.
_RATIO = 8.0

#: Pairs of a piece and a point that are looked at together; keeps memory within some ten megabytes.
_AT_ONCE = 50_000


class Pieces:
    """A pressure cut into pieces.

    Args:
        knots: positions X over a that grow, (n,).
        values: σ_YY there over N/(2a), (n,).
    """

    def __init__(self, knots: NDArray, values: NDArray) -> None:
        #: Knots of the pieces: those given, and more where a narrow piece meets a wide one.
        self.knots = _graded(knots)
        self.values = np.interp(self.knots, knots, values)

    def resultant(self, loads: LinearLoads) -> float:
        """∫ σ_YY d(X/a) over N/(2a) of the discrete loads."""
        return float(self._half @ self._ends @ loads.resultants)

    def gradients(self, loads: LinearLoads, points: NDArray) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over N/(2a) of σ_YY alone and of σ_XY equal to it, at points (n, 2) over a, Y <= 0.

        Collective.

        Returns:
            Array (n, 2, 2, 2).
        """
        half, jumps = self._half, np.zeros(len(self.knots), dtype=bool)
        jumps[[0, -1]] = self.values[[0, -1]] != 0.0
        near = NEAR * np.minimum(np.append(half, np.inf), np.append(np.inf, half))
        found = rays(points, self.knots, near, jumps)
        result = np.zeros((len(found.origins), 2, 2, 2))
        loaded = np.flatnonzero(self._ends.any(axis=1))
        together = max(1, _AT_ONCE // max(len(found.origins), 1))
        for start in range(0, len(loaded), together):
            some = loaded[start : start + together]
            seen = self._seen_from(some, found.origins, found.offsets)
            G = loads.gradients(seen.reshape(-1, 2)).reshape(*seen.shape[:2], 2, 2, 2, FIELDS // 2)
            result += np.einsum("pe,pnijed->nijd", self._ends[some], G)
        return found.continued(result)

    @property
    def _half(self) -> NDArray[np.float64]:
        return np.diff(self.knots) / 2.0

    @property
    def _ends(self) -> NDArray[np.float64]:
        """σ_YY at both ends of each piece, (pieces, 2)."""
        return np.column_stack([self.values[:-1], self.values[1:]])

    def _seen_from(self, pieces: NDArray, origins: NDArray, offsets: NDArray) -> NDArray[np.float64]:
        """Places in the pieces' own coordinates, (pieces, n, 2); next to an end it is told from there."""
        half = self._half[pieces][:, None]
        left, right = (
            ((origins - self.knots[pieces + i][:, None]) + offsets[:, 0]) / half for i in (0, 1)
        )
        w = np.where(np.abs(left) < np.abs(right), left - 1.0, right + 1.0)
        return np.stack([w, offsets[:, 1] / half], axis=-1)


def _graded(knots: NDArray) -> NDArray[np.float64]:
    """Knots among which no interval is more than ``_RATIO`` times as wide as its neighbour."""
    found = [float(knot) for knot in knots]
    for direction in (1, -1):  # narrow ones to the left of wide ones, then to the right
        found = sorted(found) if direction == 1 else sorted(found, reverse=True)
        graded = found[:2]
        for knot in found[2:]:
            width = abs(graded[-1] - graded[-2])
            while abs(knot - graded[-1]) > _RATIO * width:
                width *= _RATIO / 2.0
                graded.append(graded[-1] + direction * width)
            graded.append(knot)
        found = graded
    return np.array(sorted(found))
