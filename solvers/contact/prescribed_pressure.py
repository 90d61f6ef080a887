"""Exact solution for a prescribed pressure, linear between knots, with σ_XY = g σ_YY.

A piece from x₀ to x₁ has its middle at m, its half-width h and its own coordinate w = (z - m)/h. With
L = log((w - 1)/(w + 1)) its part of ∫ σ/(t - z) dt is σ(w) L + σ₁ - σ₀. Where two pieces meet their
logarithms cancel; far away Gauss's rule serves, in which nothing does.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .edges import from_edge
from .panels import summed
from .pressure import Pressure

#: |w| from which Gauss's rule serves, and that rule: its error there is below rounding.
_FAR, (_t, _w) = 2.0, np.polynomial.legendre.leggauss(15)

#: A point nearer to a knot than this is moved to this distance, over a: the logarithms of two pieces
#: cancel there, but infinite ones would not.
_NEXT_TO_KNOT = 1e-30

#: Pairs of a piece and a point that are computed together.
_AT_ONCE = 50_000


#: Points of a panel, and of the coarser rule that measures the error of the finer one.
FINE, COARSE = 20, 14
#: Longest panel over the length of a kernel's variation; factor and number of steps by which panels
#: shorten towards a logarithm.
_SHARE, _GRADING, _STEPS = 1.2, 0.2, 20
#: Panels at most.
_MOST = 200_000


@dataclass(frozen=True)
class LinearPressure(Pressure):
    """σ_YY over N/(2a), linear between knots and 0 beside them.

    Integrals with the kernels of layers are by Gauss's rule on pieces between knots.

    Attributes:
        knots: positions X/a that grow from -1 to 1, (n,).
        values: σ_YY there, not all of them 0, (n,).
        nodes: number of points of such a piece.
        rough: True where the kernel has a logarithm at 0.
    """

    α, β, near = 0.0, 0.0, -1.0  # its Hilbert transform is exact everywhere

    knots: NDArray[np.float64]
    values: NDArray[np.float64]
    nodes: int = FINE
    rough: bool = False

    @property
    def breaks(self) -> NDArray[np.float64]:  # type: ignore[override]
        """Knots of the pressure, both ends among them."""
        return self.knots

    @property
    def resultant(self) -> float:  # type: ignore[override]
        """∫ σ_YY d(X/a) over N/(2a)."""
        return float(np.diff(self.knots) @ (self.values[1:] + self.values[:-1]) / 2.0)

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return np.interp(r, self.knots, self.values)

    def __call__(self, r: ArrayLike) -> NDArray[np.float64]:
        """σ_YY over N/(2a) at r = X/a."""
        return self.σ_YY(r)

    def hilbert(self, r: ArrayLike) -> NDArray[np.float64]:
        """(1/π) ⨍ σ_YY(t)/(t - r) dt on the surface; NaN at an end where the pressure is not 0."""
        r = np.asarray(r, dtype=float)
        infinite = (from_edge(r) == 0.0) & (self(r) != 0.0)
        return np.where(infinite, np.nan, self._integral(r))

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        """Φ(z), see :class:`galinx.solvers.solids.half_plane.Potential`."""
        return self._integral(z)

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        return self.hilbert(r)

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return self._weighted(self._cut(self.knots, finest))

    def integral(
        self, kernel: Callable[[NDArray], NDArray], r: NDArray, length: float
    ) -> NDArray[np.float64]:
        if not self.rough:
            return summed(kernel, r, *self.points(length))
        integrals = []
        for place in r.tolist():
            # Distances from the place: differences of positions may round to 0, an infinite kernel.
            away, σ = self._weighted(self._from(place, length), place)
            integrals.append(σ @ kernel(-away))
        return np.array(integrals)

    def _cut(self, ends: NDArray, finest: float) -> NDArray[np.float64]:
        """Ends of panels between ``ends``, none too long for functions that vary over ``finest``."""
        longest = max(_SHARE * finest, 2.0 / _MOST)
        panels = [ends[:1]]
        for low, high in zip(ends[:-1].tolist(), ends[1:].tolist()):
            count = max(int(np.ceil((high - low) / longest)), 1)
            panels.append(low + (high - low) * np.arange(1, count + 1) / count)
        return np.concatenate(panels)

    def _from(self, place: float, length: float) -> NDArray[np.float64]:
        """Ends of panels as distances from a place, towards which the panels get shorter."""
        near = length * np.append(_GRADING ** np.arange(_STEPS), 0.0)
        knots, more = self.knots - place, np.concatenate([-near, near])
        inside = more[(more > knots[0]) & (more < knots[-1])]
        return self._cut(np.unique(np.concatenate([knots, inside])), length)

    def _weighted(
        self, ends: NDArray, place: float = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        x, w = np.polynomial.legendre.leggauss(self.nodes)
        half = np.diff(ends) / 2.0
        t = ((ends[1:] + ends[:-1])[:, None] / 2.0 + half[:, None] * x).ravel()
        return t, (half[:, None] * w).ravel() * self(place + t)

    def _integral(self, z: NDArray) -> NDArray[Any]:
        """Φ, or its real part on the surface, by pieces that are loaded, as many as memory allows."""
        loaded = np.flatnonzero((self.values[1:] != 0.0) | (self.values[:-1] != 0.0))
        ends, together = np.stack([loaded, loaded + 1]), max(1, _AT_ONCE // max(z.size, 1))
        total: Any = 0.0
        for first in range(0, len(loaded), together):
            group = ends[:, first : first + together].reshape(2, -1, *(1,) * z.ndim)
            total = total + _of_pieces(self.knots[group], self.values[group], z).sum(axis=0)
        return np.asarray(total / np.pi)


def _of_pieces(ends: NDArray, values: NDArray, z: NDArray) -> NDArray[Any]:
    """Integrals ∫ σ/(t - z) dt over pieces of the pressure, (pieces, ...).

    Args:
        ends: positions of their two ends, (2, pieces, 1, ...).
        values: the pressure there, (2, pieces, 1, ...).
        z: points, (...); real ones are on the surface, and the integral is a principal value.
    """
    mean, slope = (values[0] + values[1]) / 2.0, (values[1] - values[0]) / 2.0
    # w + 1 and w - 1: each exact next to its end, where w is not.
    left, right = (_moved(z - end) / ((ends[1] - ends[0]) / 2.0) for end in ends)
    w, ratio = np.where(abs(left) < abs(right), left - 1.0, right + 1.0), right / left
    with np.errstate(divide="ignore", invalid="ignore"):
        far = sum(weight * (mean + t * slope) / (t - w) for t, weight in zip(_t, _w))
    L = np.log(ratio if np.iscomplexobj(ratio) else np.abs(ratio))
    near = (values[1] * left - values[0] * right) / 2.0 * L + 2.0 * slope
    return np.where(abs(w) > _FAR, far, near)


def _moved(distance: NDArray) -> NDArray[Any]:
    return np.where(abs(distance) < _NEXT_TO_KNOT, _NEXT_TO_KNOT, distance)
