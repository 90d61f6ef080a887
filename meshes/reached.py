"""Meshes for waves: straight cells of a bounded size, as far as waves come that are back in time.

What waves do farther away nobody under the punch will know before the end, so that the far boundary may
be held there and nothing has to absorb them.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import ceil, log

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.rings import CONTACT, FAR, FREE, QuadMesh, Refinement, corner, joined

#: Size of a ring over that of the ring outside it: straight cells ask for gentle ones.
_RATIO = 0.25
#: Half-width of the squares in which rings go towards the edges, over a: they meet in the middle.
_SQUARE = 1.0


@dataclass(frozen=True)
class Reached:
    """A rectangle below the surface.

    Attributes:
        half_width, depth: over a, at least 3 and 2.
        size: side over a of the cells that are next to those under the punch.
        growth: by which a cell further out is longer, over its distance from them.
        innermost: size of the cells at the edges of the punch over a.
    """

    half_width: float
    depth: float
    size: float
    growth: float
    innermost: float

    def drawn(self) -> QuadMesh:
        """The mesh."""
        levels = max(ceil(log(self.innermost) / log(_RATIO)), 1)
        beside, _ = corner(_SQUARE, Refinement(levels, _RATIO, 1, ()), fan=True)
        mirrored = (beside * [-1.0, 1.0])[:, ::-1]
        squares = [part + np.array([edge, 0.0]) for edge in (-1.0, 1.0) for part in (beside, mirrored)]
        outwards = np.concatenate([[0.0, 1.0], self._outwards(2.0, self.half_width)])
        X = np.concatenate([-outwards[:0:-1], outwards])
        Y = -np.concatenate([[0.0], self._outwards(1.0, self.depth)])
        boxes = np.array([
            [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
            for x0, x1 in pairwise(X)
            for y1, y0 in pairwise(Y)
            if y0 < -1.0 or abs(x0 + x1) > 4.0
        ])  # fmt: skip
        return _tagged(np.concatenate([boxes, *squares]), float(X[-1]))

    def _outwards(self, first: float, last: float) -> NDArray[np.float64]:
        """Lines from the first distance to the last one."""
        x = [0.0]
        while x[-1] < last - first:
            x.append(x[-1] + self.size + self.growth * x[-1])
        return first + np.array(x) * ((last - first) / x[-1])


def _tagged(quads: NDArray[np.float64], last: float) -> QuadMesh:
    mesh = joined(quads.reshape(-1, 2), last)
    sides = np.stack([mesh.cells, np.roll(mesh.cells, -1, axis=1)], axis=-1).reshape(-1, 2)
    _, index, count = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
    boundary = sides[index[count == 1]]
    X, Y = mesh.points[boundary].mean(axis=1).T
    top = Y == 0.0
    edges = {CONTACT: boundary[top & (np.abs(X) < 1.0)], FREE: boundary[top & (np.abs(X) > 1.0)],
             FAR: boundary[~top]}  # fmt: skip
    return QuadMesh(mesh.points, mesh.cells, edges)
