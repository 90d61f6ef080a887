"""Meshes whose lines follow the interfaces of layers: straight cells in the physical half-plane.

Columns grow outwards from both edges of the punch, rows with depth, and an interface is always between
two rows. Only inside a square around each edge, of at most half the uppermost layer's thickness, L-shaped
rings go on towards it: their lines do not run through the whole mesh.

Over which lengths fields change in layers under a punch: what rows and columns have to follow.

Fields of a solid are functions of X + pY. The punch's edges, where these are singular, are seen from a
depth at the complex distance Σ p H of the solids that lie between; with S the least of its imaginary
parts, fields change over S along X and over S/|p| along Y. From a place at the side an edge is at least
as far as the distance times Im p/|p|.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import asinh, ceil, isfinite, log, log10

import numpy as np
from numpy.typing import NDArray

from .charts import Physical
from .kind import DEGREES, MeshKind, Wanted
from .rings import QuadMesh, tagged

#: Halvings in search of the share with which a number of rows just fits.
_HALVINGS = 25


@dataclass(frozen=True)
class Strata:
    """Layers on a substrate.

    Attributes:
        depths: of the interfaces, rising.
        roots: p of every solid from the top down, those of the substrate last.
        changes: length over which each layer's own constants change, infinite where it is uniform; none
            where all are.
    """

    depths: tuple[float, ...]
    roots: tuple[tuple[complex, ...], ...]
    changes: tuple[float, ...] = ()

    @property
    def aside(self) -> float:
        """Least distance of an edge over how far aside it is."""
        return min(p.imag / abs(p) for roots in self.roots for p in roots)

    def length(self, depth: float) -> float:
        """Over which fields change along Y just below a depth."""
        S, top = 0.0, 0.0
        changes = (*(self.changes or (np.inf,) * len(self.depths)), np.inf)
        for bottom, roots, change in zip((*self.depths, np.inf), self.roots, changes):
            if depth < bottom:
                return min(change, *((S + p.imag * (depth - top)) / abs(p) for p in roots))
            S += min(p.imag for p in roots) * (bottom - top)
            top = bottom
        return S

    def rows(self, first: float, last: float, share: float) -> NDArray[np.float64]:
        """Depths from the first to before the last: rows no higher than a share of the length there."""
        lines = [first, *(depth for depth in self.depths if first * (1.0 + 1e-9) < depth < last), last]
        return np.concatenate([fitted(self.length, *ends, share) for ends in pairwise(lines)])


def fitted(
    length: Callable[[float], float], first: float, last: float, share: float
) -> NDArray[np.float64]:
    """From the first to before the last, in as few steps as the share of a length there allows."""
    count = len(_marched(length, first, last, share))
    low, high = 0.0, share
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        low, high = (
            (middle, high) if len(_marched(length, first, last, middle)) > count else (low, middle)
        )
    return np.array(_marched(length, first, last, high))


def _marched(length: Callable[[float], float], first: float, last: float, share: float) -> list[float]:
    found = [first]
    while (following := found[-1] + share * length(found[-1])) < last * (1.0 - 1e-9):
        found.append(following)
    return found


def between(low: float, high: float, growth: float) -> NDArray[np.float64]:
    """From low to below high, by a factor."""
    count = max(ceil(log(high / low) / log(growth) - 1e-9), 1) if high > low else 0
    return low * (high / low) ** (np.arange(count) / max(count, 1))


#: Distance of a line over that of the one before, from an edge and from the surface.
_GROWTH = 4.0
#: The same under the punch, where facets have to follow what the pressure is read off by.
_UNDER = 1.8
#: The same over an uppermost layer that is thinner than so many a.
_GENTLE_GROWTH, _THIN = 2.5, 0.4
#: Where stresses are wanted: size of a cell over the length on which fields change there, at 1e-6, and
#: how much less it is for each digit more.
_RESOLVED, _A_DIGIT = 1.2, 0.15
#: How much beyond the last place, or the last interface, that holds; then lines grow by a factor.
_BEYOND, _DEEPER, _FAR_GROWTH = 1.1, 3.0, 3.0
#: By how much the edges of the contact seem off, over the size of the innermost cells and over the
#: degree's inverse square; measured on 22 stacks at degrees 4 to 12: 0.3 to 0.65.
_MOVED = 0.8
#: Functions by which the pressure over a solid that is graded from the surface on is read off with the
#: share of the tolerance that the innermost cells take otherwise: that share falls with their square.
_FUNCTIONS = 6.0
#: Share of the tolerance of stresses that the innermost cells take half of.
_OF_INNERMOST = 0.3
#: Tolerance of stresses below which one degree more is always asked for.
_TIGHT = 1e-5
#: The least growth of columns: beside solids along whose planes fields go far aside there is no end.
_LEAST_GROWTH = 1.25
#: Size of a ring over that of the one outside it, and where stresses are wanted beside it.
_RATIO, _NEAR_RATIO = 0.45, 0.5
#: Cells along a leg of an L by how far apart the planes are in which fields live.
_LEGS = 0.5
#: How far from squares what is round an edge may be.
_WIDEST = 4.0
#: Moments of the pressure over the logarithm of the tolerance: of any, and of how thin the layer is.
_MOMENTS = 0.27, 0.54
#: Fewest, two degrees below the first.
_FEWEST = 12
#: Largest square around an edge, over a, and its size over the uppermost layer's thickness.
_SQUARE, _SHARE = 0.5, 0.5
#: Relative error of K_I by the far boundary: over its inverse distance squared, by what the pressure's
#: own moment moves there, and over the cube of the layers' length over it, less where that is so long
#: that what is left of the displacement there strains little. The first grows as the inverse of how far
#: the speed is from that of a wave along the substrate, the second as its root, beside what the length
#: grows by; measured, with a factor of 2. The share of the tolerance that is left to each.
#: What moves the substrate strains layers that are stiffer and thick by so much more stress: the first is
#: larger by that, and the second less small; measured with layers of 0.3 to 100 times the substrate's
#: modulus, 0.2 to 5 a thick. Their length over their depth, alike; and how thick a layer is for that.
_MOMENT, _CUBED, _LONG, _OF_FAR = 0.5, 0.1, 30.0, 0.1
_ALIKE, _THICK = 2.0, 2.0
#: How much smaller that has to be for stresses.
_SMALLER = 5.0
#: Distance of the far boundary over a at most: longer cells lose digits.
_FARTHEST = 2e5


@dataclass(frozen=True)
class OnLayers(MeshKind):
    """A mesh for layers.

    Attributes:
        depths: of the interfaces over a.
        drawn_together: smallest Im p of the uppermost solid: its fields see depths so much smaller.
        wide: Im p midway between both: width over height of what its fields take for a square.
        far_length: over which the layers are seen from far, over a.
        left: 1 at rest, 0 where a wave runs along the substrate with the load.
        roots: p of every solid from the top down, those of the substrate last; of one at rest if empty.
        changes: of :class:`galinx.meshes.layered.Strata`.
        places: positions over a towards which cells are graded, rising from -1 to 1.
    """

    depths: tuple[float, ...] = ()
    drawn_together: float = 1.0
    wide: float = 1.0
    far_length: float = 1.0
    left: float = 1.0
    roots: tuple[tuple[complex, ...], ...] = ()
    changes: tuple[float, ...] = ()
    places: tuple[float, ...] = (-1.0, 1.0)

    def radius(self, wanted: Wanted) -> float:
        """Half the width of the mesh, and its depth, over a."""
        left = _OF_FAR * wanted.tolerance
        if wanted.nearest is not None:
            # Stresses far away are small beside what the boundary adds.
            left /= _SMALLER * max(1.0, min(self.depths[-1], wanted.farthest))
        far = max((self._moment / left) ** 0.5, self.far_length * (self._cubed / left) ** (1.0 / 3.0))
        return max(min(far, _FARTHEST), 30.0 * max(1.0, self.depths[-1]), 10.0 * wanted.farthest)

    def reach(self, wanted: Wanted) -> float:
        return self.radius(wanted)

    def truncation(self, wanted: Wanted, margin: float = 1.0) -> float:
        """Relative error of K_I by the far boundary, which moves as far below line loads."""
        R = self.radius(wanted)
        return self._moment / R**2 + self._cubed * (self.far_length / R) ** 3

    def terms(self, wanted: Wanted) -> int:
        """Of the resultants alone it is known what layers do to their fields."""
        return 1

    @property
    def _moment(self) -> float:
        return _MOMENT * self._stiffer / self.left

    @property
    def _stiffer(self) -> float:
        """Stiffness under the punch over that of the substrate, at least 1."""
        depth = self.depths[-1]
        contrast = max(self.left * self.far_length / (_ALIKE * depth), 1.0)
        return 1.0 + (contrast - 1.0) * depth**2 / (depth**2 + _THICK**2)

    @property
    def _cubed(self) -> float:
        at_rest = self.left * self.far_length
        long = _LONG * max(1.0, 2.0 * (self.depths[-1] / _THICK) ** 2)
        return _CUBED * min(1.0, long / at_rest) / self.left**0.5

    @property
    def length(self) -> float:
        """Over which the pressure changes next to the edges: their mirror image in the interface."""
        return 2.0 * self.depths[0] * self.drawn_together

    def moments(self, wanted: Wanted) -> int:
        """Of the pressure, that tell it to a tenth of the tolerance; measured on thirty stacks."""
        share, of_length = _MOMENTS
        count = (share + of_length * asinh(2.0 / self.length)) * log(30.0 / wanted.tolerance)
        return max(ceil(count), _FEWEST) + 2 * self._one_more(wanted)

    @property
    def graded(self) -> bool:
        """Is the solid graded from the surface on?"""
        return bool(self.changes) and isfinite(self.changes[0])

    def innermost_size(self, wanted: Wanted) -> float:
        """Of the cells at the edges, over a."""
        size = self._innermost(wanted) ** 2
        if self.graded:
            # What the pressure is read off by is steep at the ends there.
            size *= (_FUNCTIONS / self.moments(wanted)) ** 2
        return max(size, 1e-11)

    def _innermost(self, wanted: Wanted) -> float:
        if wanted.nearest is None:
            return super()._innermost(wanted)
        # What these cells spoil beside them no degree mends.
        return super()._innermost(replace(wanted, tolerance=_OF_INNERMOST * wanted.tolerance))

    def unseen(self, wanted: Wanted, degree: int, cuts: int, margin: float) -> float:
        return 0.3 * self.innermost_size(wanted) / margin**0.4

    def moved_edges(self, wanted: Wanted, degree: int, margin: float) -> float:
        """Distance over a by which the edges of the contact seem off: what the innermost cells make of
        the singularity.

        Args:
            wanted: what the mesh is for.
            degree: of the cells.
            margin: of the solid's response.
        """
        return _MOVED * self.innermost_size(wanted) / (degree**2 * margin**0.4)

    def degree(self, wanted: Wanted, margin: float) -> int:
        """One less than usual for K_I alone: the measured error asks for more where it is needed."""
        degree = super().degree(wanted, margin)
        if wanted.nearest is None:
            return max(degree - 1, DEGREES[0] + 1)
        return min(degree + self._one_more(wanted), DEGREES[1])

    def _one_more(self, wanted: Wanted) -> bool:
        """Is a degree more asked for from the first, with its moments?"""
        return wanted.nearest is not None and wanted.tolerance < _TIGHT

    def drawn(self, wanted: Wanted) -> QuadMesh:
        """The mesh."""
        gaps = np.diff(self.places)
        square = _SQUARE * min(gaps) / 2.0 / max(self.wide, 1.0)
        b, R = min(_SHARE * self.depths[0], square), self.radius(wanted)
        near = wanted.nearest is not None and wanted.nearest < b
        legs = (2 if near else 1) + ceil(_LEGS * wanted.spread - 0.5)
        wide, in_square = self.wide * b, b * np.arange(1, legs) / legs
        beside, below, growth = self._lines(wanted, b)
        X = [np.array(self.places), 1.0 + self.wide * in_square, 1.0 + beside]
        X += [-beyond for beyond in X[1:]]
        for left, right in pairwise(self.places):
            half = (right - left) / 2.0
            inner = np.concatenate([self.wide * in_square, between(wide, half, growth)])
            X += [left + inner, np.array([left + half]), right - inner]
        columns = np.unique(np.concatenate(X))
        rows = -np.concatenate([[0.0], in_square, below, [R]])
        cells = [
            [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
            for x0, x1 in pairwise(columns.tolist())
            for y1, y0 in pairwise(rows.tolist())
            if y0 < -b or min(abs((x0 + x1) / 2.0 - place) for place in self.places) > wide
        ]
        ratio, last = _NEAR_RATIO if near else _RATIO, self.innermost_size(wanted) / b
        squares = [
            _rings(place, (side * wide, b), legs, ratio, last)
            for place in self.places
            for side in (-1.0, 1.0)
        ]
        return tagged(np.concatenate([np.array(cells), *squares]), 1.0 + R)

    def _lines(self, wanted: Wanted, b: float) -> tuple[NDArray, NDArray, float]:
        """Distances of columns from an edge beside the punch; depths of rows below b; and by what factor
        columns grow under it."""
        R, wide = self.radius(wanted), self.wide * b
        if wanted.nearest is None:
            growth = _GENTLE_GROWTH if self.depths[0] < _THIN else _GROWTH
            beside = between(wide, R, growth)
            fixed = [b, *(d for d in self.depths if d > b * (1.0 + 1e-9)), R]
            below = np.concatenate([between(*pair, growth) for pair in pairwise(fixed)])
        else:
            roots = self.roots or ((1j,),) * (len(self.depths) + 1)
            strata = Strata(self.depths, roots, self.changes)
            share = _RESOLVED + _A_DIGIT * (6.0 + log10(wanted.tolerance))
            growth = max(1.0 + share * strata.aside, _LEAST_GROWTH)
            far = min(max(_DEEPER * self.depths[-1], self.far_length, _BEYOND * wanted.farthest), R)
            beyond = between(far, R, _FAR_GROWTH)
            beside = np.append(between(wide, far, growth), beyond)
            below = np.append(strata.rows(b, far, share), beyond)
        return np.append(beside, R), below, min(_UNDER, growth)


def _rings(
    edge: float, size: tuple[float, float], legs: int, ratio: float, innermost: float
) -> NDArray[np.float64]:
    """L-shaped rings in a rectangle beside an edge, and what fills what is left, (cells, 4, 2).

    Args:
        edge: X of the edge.
        size: of the rectangle: width, negative to the left of the edge, and depth.
        legs: cells along each leg of an L.
        ratio: of the sizes of rings.
        innermost: size of the last rectangle over that of the first.
    """
    count = max(ceil(log(1.0 / innermost) / -log(ratio)), 1)
    sizes = ratio ** np.arange(count + 1)
    t = np.arange(legs + 1) / legs
    # Along the L from the surface down, and back to below the edge.
    leg = np.concatenate([np.column_stack([np.ones(legs + 1), -t]),
                          np.column_stack([1.0 - t, -np.ones(legs + 1)])[1:]])  # fmt: skip
    cells = [
        [near * leg[i], far * leg[i], far * leg[i + 1], near * leg[i + 1]]
        for far, near in pairwise(sizes.tolist())
        for i in range(2 * legs)
    ]
    last = float(sizes[-1])
    for x0, x1 in pairwise(last * t):
        cells += [[(x0, -y0), (x1, -y0), (x1, -y1), (x0, -y1)] for y0, y1 in pairwise(last * t)]
    # Clockwise as they are.
    found = np.array(cells) * size + [edge, 0.0]
    return found[:, ::-1] if size[0] > 0.0 else found


def on_layers(
    depths: Sequence[float],
    drawn_together: float = 1.0,
    wide: float = 1.0,
    far_length: float = 1.0,
    left: float = 1.0,
    roots: tuple[tuple[complex, ...], ...] = (),
    changes: tuple[float, ...] = (),
    places: tuple[float, ...] = (-1.0, 1.0),
) -> OnLayers:
    """The kind of mesh for layers with interfaces at these depths over a, see :class:`OnLayers`."""
    return OnLayers(
        "straight-sided, along the interfaces", Physical(), ratio=0.5, column=1.0, fan=True,
        innermost=1.0 / 150.0, beside=6.0, gentle=1.0, smallest=5e-6, depths=tuple(depths),
        drawn_together=drawn_together, wide=min(max(wide, 1.0 / _WIDEST), _WIDEST),
        far_length=far_length, left=left, roots=roots, changes=changes, places=places,
    )  # fmt: skip
