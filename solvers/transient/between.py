"""Pressures of any friction of a range by those of a few: analytic in g, so Chebyshev's points serve."""

from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.solvers.solids.solid import Response
from galinx.solvers.transient.basis import Basis

#: Accuracy over the largest, frictions at most, and frictions and places at which it is looked at.
_ACCURACY, _MOST, _LOOKED = 1e-10, 24, 7
_PLACES = -np.cos(pi * (np.arange(64) + 0.5) / 64)
#: Range of friction that is none: differences of it are rounding.
_SAME = 1e-13


class Between:
    """All frictions from g_least to g_most.

    Args:
        response: of steady motion.
        least, most: g = σ_XY/σ_YY.
        terms: polynomials of the pressure.

    Attributes:
        bases: at the few frictions.
        middle: at the middle of the range.
    """

    def __init__(self, response: Response, least: float, most: float, terms: int) -> None:
        self._response, self._terms = response, terms
        self._middle, self._half = (least + most) / 2.0, (most - least) / 2.0
        self.middle = Basis(response, self._middle, terms)
        count = 1 if self._half < _SAME else 2
        self._take(count)
        while 1 < count < _MOST and self._off() > _ACCURACY:
            count += 1
            self._take(count)

    def _take(self, count: int) -> None:
        self._angles = pi * (np.arange(count) + 0.5) / count
        self.bases = [
            Basis(self._response, self._middle + self._half * one, self._terms)
            for one in np.cos(self._angles)
        ]

    def _off(self) -> float:
        known = np.array([one.pressure(_PLACES) for one in self.bases])
        off = 0.0
        for share in np.cos(pi * np.arange(_LOOKED) / (_LOOKED - 1)):
            g = self._middle + self._half * share
            exact = Basis(self._response, g, self._terms).pressure(_PLACES)
            found = np.tensordot(self.shares(g), known, 1)
            off = max(off, float(np.abs(found - exact).max() / np.abs(exact).max()))
        return off

    def shares(self, g: ArrayLike) -> NDArray[np.float64]:
        """Of each of the few in what there is at frictions (...,): (..., few)."""
        count = len(self._angles)
        x = np.clip((np.asarray(g) - self._middle) / max(self._half, _SAME), -1.0, 1.0)
        orders = np.arange(count)
        known = np.cos(np.outer(self._angles, orders)) * np.where(orders == 0, 1.0, 2.0) / count
        return np.asarray(np.cos(np.arccos(x)[..., None] * orders) @ known.T)
