"""Meshes over layers: straight cells in the physical half-plane, whose lines follow the interfaces.

Columns grow outwards from both edges of the punch, rows with depth, and an interface is always between
two rows. Only inside a square around each edge, of at most half the uppermost layer's thickness, L-shaped
rings go on towards it: their lines do not run through the whole mesh.

Sizes of rows and columns follow the lengths over which fields change in layers (:meth:`OnLayers.change`).
Fields of a solid are functions of X + pY. The punch's edges, where these are singular, are seen from a
depth at the complex distance Σ p H of the solids that lie between; with S the least of its imaginary
parts, fields change over S along X and over S/|p| along Y. From a place at the side an edge is at least
as far as the distance times Im p/|p|.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, log, log10

import numpy as np
from numpy.typing import NDArray

from .charts import Chart, Physical
from .kind import DEGREES, MeshKind, Requirements
from .rings import QuadMesh, Refinement, corner, lines_and_corners

#: Halvings in search of the share with which a number of rows just fits.
_HALVINGS = 25


def fitted(
    length: Callable[[float], float], first: float, last: float, share: float
) -> NDArray[np.float64]:
    """Positions from first to before last, in the fewest steps that a share of ``length`` allows."""
    count = len(_marched(length, first, last, share))
    low, high = 0.0, share
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        low, high = (
            (middle, high) if len(_marched(length, first, last, middle)) > count else (low, middle)
        )
    return np.array(_marched(length, first, last, high))


def _marched(length: Callable[[float], float], first: float, last: float, share: float) -> list[float]:
    positions = [first]
    while (following := positions[-1] + share * length(positions[-1])) < last * (1.0 - 1e-9):
        positions.append(following)
    return positions


def between(low: float, high: float, growth: float) -> NDArray[np.float64]:
    """Positions from low to below high, each ``growth`` times the one before or less."""
    count = max(ceil(log(high / low) / log(growth) - 1e-9), 1) if high > low else 0
    return low * (high / low) ** (np.arange(count) / max(count, 1))


#: Distance of a line over that of the one before, from an edge and from the surface.
_GROWTH = 4.0
#: That growth under the punch, where facets resolve the functions that recover the pressure.
_UNDER = 1.8
#: That growth over a thin uppermost layer, and the thickness over a below which it is thin.
_GENTLE_GROWTH, _THIN = 2.5, 0.4
#: For stresses: size of a cell over the length on which fields change there, at a tolerance of 1e-6, and
#: how much less it is for each digit more.
_RESOLVED, _A_DIGIT = 1.2, 0.15
#: End of that region over the farthest point, and over the last interface; growth of lines beyond it.
_BEYOND, _DEEPER, _FAR_GROWTH = 1.1, 3.0, 3.0
#: Tolerance of the innermost cells over that of stresses.
_OF_INNERMOST = 0.3
#: Tolerance of stresses below which the degree is one more from the first.
_TIGHT = 1e-5
#: Least growth of columns: beside solids along whose planes fields go far aside they would never end.
_LEAST_GROWTH = 1.25
#: Size of a ring over that of the one outside it, and where stresses are output beside it.
_RATIO, _NEAR_RATIO = 0.45, 0.5
#: Additional cells along a leg of an L over the spread of the planes of the fields.
_LEGS = 0.5
#: Largest ratio of sides of the rectangle around an edge.
_WIDEST = 4.0
#: Largest square around an edge, over a, and its size over the uppermost layer's thickness.
_SQUARE, _SHARE = 0.5, 0.5
#: Relative error of K_I by the far boundary: over its inverse distance squared, by what the pressure's
#: own moment moves there, and over the cube of the layers' length over it, less where that is so long
#: that the remaining displacement there strains little. The first grows as the inverse of how far
#: the speed is from that of a wave along the substrate, the second as its root, beside what the length
#: grows by; measured, with a factor of 2. The last is the share of the tolerance for each.
#: What moves the substrate strains layers that are stiffer and thick by so much more stress: the first is
#: larger by that, and the second less small; measured with layers of 0.3 to 100 times the substrate's
#: modulus, 0.2 to 8 a thick, with boundaries at up to 20 lengths of the layers. Their length over their
#: depth, alike; how thick a layer is for that; and how much longer is long where a layer is thicker.
_MOMENT, _CUBED, _LONG, _OF_FAR = 0.5, 0.1, 30.0, 0.1
_ALIKE, _THICK, _LONGER = 2.0, 2.0, 6.0
#: Factor by which that share is smaller for stresses.
_SMALLER = 5.0
#: Distance of the far boundary over a at most: longer cells lose digits.
_FARTHEST = 2e5


@dataclass(frozen=True)
class OnLayers(MeshKind):
    """A kind of meshes for layers.

    Attributes:
        depths: of the interfaces over a.
        wide: geometric mean Im p of the uppermost solid, width over height of a rectangle that its fields
            see as a square.
        far_length: length over a of the layers' effect far away.
        left: 1 at rest, 0 where a wave runs along the substrate with the load.
        roots: p of every solid from the top down, those of the substrate last; of one at rest if empty.
        changes: length over which each layer's own constants change, infinite where it is uniform; empty
            where all are.
        places: positions over a towards which cells are graded, rising from -1 to 1.
    """

    about: str = "straight-sided, along the interfaces"
    chart: Chart = Physical()
    ratio: float = 0.5
    column: float = 1.0
    fan: bool = True
    innermost: float = 1.0 / 150.0
    beside: float = 6.0
    gentle: float = 1.0
    smallest: float = 5e-6
    depths: tuple[float, ...] = ()
    wide: float = 1.0
    far_length: float = 1.0
    left: float = 1.0
    roots: tuple[tuple[complex, ...], ...] = ()
    changes: tuple[float, ...] = ()
    places: tuple[float, ...] = (-1.0, 1.0)

    @property
    def solids(self) -> tuple[tuple[complex, ...], ...]:
        """p of every solid from the top down."""
        return self.roots or ((1j,),) * (len(self.depths) + 1)

    @property
    def aside(self) -> float:
        """Least distance of an edge from a point, over the offset of the point along X."""
        return min(p.imag / abs(p) for roots in self.solids for p in roots)

    def change(self, depth: float) -> float:
        """Length over a over which fields change along Y just below a depth."""
        S, top = 0.0, 0.0
        changes = (*(self.changes or (np.inf,) * len(self.depths)), np.inf)
        for bottom, roots, change in zip((*self.depths, np.inf), self.solids, changes):
            if depth < bottom:
                return min(change, *((S + p.imag * (depth - top)) / abs(p) for p in roots))
            S += min(p.imag for p in roots) * (bottom - top)
            top = bottom
        return S

    def rows(self, first: float, last: float, share: float) -> NDArray[np.float64]:
        """Depths of rows from first to before last, none higher than a share of :meth:`change`."""
        lines = [first, *(depth for depth in self.depths if first * (1.0 + 1e-9) < depth < last), last]
        return np.concatenate([fitted(self.change, *ends, share) for ends in pairwise(lines)])

    def reach(self, required: Requirements) -> float:
        """Half the width of the mesh, and its depth, over a."""
        allowed = _OF_FAR * required.tolerance
        if required.nearest is not None:
            # Stresses far away are small beside the error by the boundary.
            allowed /= _SMALLER * max(1.0, min(self.depths[-1], required.farthest))
        far = max(
            (self._moment / allowed) ** 0.5, self.far_length * (self._cubed / allowed) ** (1.0 / 3.0)
        )
        return max(min(far, _FARTHEST), 30.0 * max(1.0, self.depths[-1]), 10.0 * required.farthest)

    def truncation(self, required: Requirements, margin: float = 1.0) -> float:
        """Estimated relative error of K_I by the far boundary, which moves as that below line loads."""
        R = self.reach(required)
        return self._moment / R**2 + self._cubed * (self.far_length / R) ** 3

    def terms(self, required: Requirements) -> int:
        """One moment, the resultant: of others the far field over layers is not computed."""
        return 1

    @property
    def _moment(self) -> float:
        depth = self.depths[-1]
        contrast = max(self.left * self.far_length / (_ALIKE * depth), 1.0)
        #: Stiffness under the punch over that of the substrate, at least 1.
        stiffer = 1.0 + (contrast - 1.0) * depth**2 / (depth**2 + _THICK**2)
        return _MOMENT * stiffer / self.left

    @property
    def _cubed(self) -> float:
        at_rest = self.left * self.far_length
        long = _LONG * max(1.0, _LONGER * (self.depths[-1] / _THICK) ** 2)
        return _CUBED * min(1.0, long / at_rest) / self.left**0.5

    def _innermost(self, required: Requirements) -> float:
        if required.nearest is None:
            return super()._innermost(required)
        # The error of these cells in stresses beside them does not fall with the degree.
        return super()._innermost(replace(required, tolerance=_OF_INNERMOST * required.tolerance))

    def degree(self, required: Requirements, margin: float) -> int:
        """Degree, one less than usual for K_I alone: the measured error raises it where needed."""
        degree = super().degree(required, margin)
        if required.nearest is None:
            return max(degree - 1, DEGREES[0] + 1)
        return min(degree + (required.tolerance < _TIGHT), DEGREES[1])

    def drawn(self, required: Requirements) -> QuadMesh:
        """The mesh."""
        gaps = np.diff(self.places)
        square = _SQUARE * min(gaps) / 2.0 / max(self._width, 1.0)
        b, R = min(_SHARE * self.depths[0], square), self.reach(required)
        near = required.nearest is not None and required.nearest < b
        legs = (2 if near else 1) + ceil(_LEGS * required.spread - 0.5)
        wide, in_square = self._width * b, b * np.arange(1, legs) / legs
        beside, below, growth = self._lines(required, b)
        X = [np.array(self.places), 1.0 + self._width * in_square, 1.0 + beside]
        X += [-beyond for beyond in X[1:]]
        for X_left, X_right in pairwise(self.places):
            half = (X_right - X_left) / 2.0
            inner = np.concatenate([self._width * in_square, between(wide, half, growth)])
            X += [X_left + inner, np.array([X_left + half]), X_right - inner]
        rows = np.concatenate([[0.0], in_square, below, [R]])
        ratio = _NEAR_RATIO if near else _RATIO
        last = max(self._innermost(required) ** 2, 1e-11) / b
        rings = Refinement(max(ceil(log(last) / log(ratio)), 1), ratio, legs)
        return lines_and_corners(
            np.unique(np.concatenate(X)), rows, self.places, (wide, b), corner(1.0, rings, False)[0]
        )

    @property
    def _width(self) -> float:
        """Width over height of the rectangles around the edges."""
        return min(max(self.wide, 1.0 / _WIDEST), _WIDEST)

    def _lines(self, required: Requirements, b: float) -> tuple[NDArray, NDArray, float]:
        """Lines of columns and rows outside the squares around the edges.

        Returns:
            Distances over a of columns from an edge beside the punch, depths over a of rows below b, and
            the growth of columns under the punch.
        """
        R, wide = self.reach(required), self._width * b
        if required.nearest is None:
            growth = _GENTLE_GROWTH if self.depths[0] < _THIN else _GROWTH
            beside = between(wide, R, growth)
            fixed = [b, *(d for d in self.depths if d > b * (1.0 + 1e-9)), R]
            below = np.concatenate([between(*pair, growth) for pair in pairwise(fixed)])
        else:
            share = _RESOLVED + _A_DIGIT * (6.0 + log10(required.tolerance))
            growth = max(1.0 + share * self.aside, _LEAST_GROWTH)
            far = min(max(_DEEPER * self.depths[-1], self.far_length, _BEYOND * required.farthest), R)
            beyond = between(far, R, _FAR_GROWTH)
            beside = np.append(between(wide, far, growth), beyond)
            below = np.append(self.rows(b, far, share), beyond)
        return np.append(beside, R), below, min(_UNDER, growth)
