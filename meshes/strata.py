"""Over which lengths fields change in layers under a punch: what rows and columns have to follow.

Fields of a solid are functions of X + pY. The punch's edges, where these are singular, are seen from a
depth at the complex distance Σ p H of the solids that lie between; with S the least of its imaginary
parts, fields change over S along X and over S/|p| along Y. From a place at the side an edge is at least
as far as the distance times Im p/|p|.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, log

import numpy as np
from numpy.typing import NDArray

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
