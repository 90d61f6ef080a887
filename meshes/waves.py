"""Meshes for waves: straight cells that grow outwards, as far as waves reach that are back in time.

Waves that go farther do not come back to the punch before the end, so that the far boundary may be held
there. Waves that are too short for the cells out there have to be damped.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import ceil, inf, log

import numpy as np
from numpy.typing import NDArray

from .rings import QuadMesh, Refinement, corner, lines_and_corners

#: Largest half-width of the squares in which rings go towards the edges, over a: they meet in the middle.
_SQUARE = 1.0
#: Distance of a line over that of the one before, where only a steady field is resolved.
_BEYOND = 2.5


@dataclass(frozen=True)
class Reached:
    """A rectangle below the surface, graded towards both edges of the punch.

    Attributes:
        half_width, depth: over a, at least 3 and 2.
        size: side over a of the cells next to the rings around the edges.
        growth: additional length of a cell farther out, over its distance from these.
        innermost: size of the cells at the edges of the punch over a.
        beyond: half-width and depth over a of the whole mesh where a steady field is held there; 0 for
            no more than waves need.
        ratio: size of a ring at the edges over that of the ring outside it.
        depths: of interfaces over a, rising, which lines of cells follow.
        finest: largest side over a of cells within ``around``, where fields are output.
        around: half-width and depth over a of these.
    """

    half_width: float
    depth: float
    size: float
    growth: float
    innermost: float
    beyond: float = 0.0
    ratio: float = 0.25
    depths: tuple[float, ...] = ()
    finest: float = inf
    around: tuple[float, float] = (0.0, 0.0)

    def drawn(self) -> QuadMesh:
        """The mesh."""
        square = min(_SQUARE, self.size, self.finest, *self.depths[:1])
        levels = max(ceil(log(self.innermost / square) / log(self.ratio)), 1)
        between = np.linspace(0.0, 1.0 - square, ceil((1.0 - square) / min(self.size, self.finest)) + 1)
        outwards = np.concatenate([
            between, [1.0], self._lines(1.0 + square, self.half_width, self.around[0]),
            self._beyond(self.half_width),
        ])  # fmt: skip
        X = np.concatenate([-outwards[:0:-1], outwards])
        # Rows go through all interfaces.
        first, around = square, self.around[1]
        rows = [first, *(depth for depth in self.depths if depth > first * (1.0 + 1e-9))]
        rows.append(max(self.depth, rows[-1] + self.size))
        lines = [self._lines(*ends, around, ends[0] - first) for ends in pairwise(rows)]
        below = [of[:-1] for of in lines[:-1]]
        depths = np.concatenate([[0.0], *below, lines[-1], self._beyond(rows[-1])])
        rings, _ = corner(1.0, Refinement(levels, self.ratio, 1), fan=True)
        return lines_and_corners(X, depths, (-1.0, 1.0), (square, square), rings)

    def _lines(
        self, first: float, last: float, around: float, before: float = 0.0
    ) -> NDArray[np.float64]:
        """Lines from the first distance to the last; the first is ``before`` from the small cells."""
        x = [0.0]
        while x[-1] < last - first:
            side = self.size + self.growth * (before + x[-1])
            x.append(x[-1] + (min(side, self.finest) if first + x[-1] < around else side))
        return first + np.array(x) * ((last - first) / x[-1])

    def _beyond(self, last: float) -> NDArray[np.float64]:
        """Lines from the last distance that waves need on, to where a steady field is held."""
        more = max(ceil(log(max(self.beyond, last) / last) / log(_BEYOND)), 0)
        return np.asarray(last * _BEYOND ** np.arange(1.0, more + 1.0))
