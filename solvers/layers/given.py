"""A pressure that is put in on layers, linear between knots, as what is read off a found one.

Gauss's rule on pieces between knots, cut as short as the kernel asks for; where the kernel has a
logarithm, graded towards it. What the half-plane of the surface's solid does is known exactly.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.sie.linear import LinearPressure

#: Points of a panel, and of the coarser rule that measures the error of that.
FINE, COARSE = 20, 14
#: Longest panel over what kernels vary over; by what factor, and how often, lengths of panels fall
#: towards a logarithm.
_SHARE, _GRADING, _STEPS = 1.2, 0.2, 20
#: Panels at most.
_MOST = 200_000


@dataclass(frozen=True)
class Given:
    """A pressure; see :class:`galinx.solvers.layers.pressure.Pressure`, of which it has the integrals.

    Attributes:
        pressure: σ_YY over N/(2a).
        nodes: points of a panel.
        length: over a, over which the kernel on the surface varies.
        rough: has that a logarithm at 0?
    """

    pressure: LinearPressure
    nodes: int
    length: float
    rough: bool

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """t and weights times σ_YY for integrals with what varies over ``finest``, (n,) each."""
        return self._weighted(self._cut(self.pressure.knots, finest))

    def integral(self, kernel: Callable[[NDArray], NDArray], r: NDArray) -> NDArray[np.float64]:
        """∫ kernel(r - t) σ(t) dt, (len(r), functions)."""
        whole = self.points(self.length)
        found = []
        for place in r.tolist():
            t, σ = self._weighted(self._towards(place)) if self.rough else whole
            found.append(σ @ kernel(place - t))
        return np.array(found)

    def _cut(self, ends: NDArray, finest: float) -> NDArray[np.float64]:
        """Ends of panels between others, none longer than what varies over ``finest`` allows."""
        longest = max(_SHARE * finest, 2.0 / _MOST)
        found = [ends[:1]]
        for low, high in zip(ends[:-1].tolist(), ends[1:].tolist()):
            count = max(int(np.ceil((high - low) / longest)), 1)
            found.append(low + (high - low) * np.arange(1, count + 1) / count)
        return np.concatenate(found)

    def _towards(self, place: float) -> NDArray[np.float64]:
        """Ends of panels that get shorter towards a place."""
        near = self.length * np.append(_GRADING ** np.arange(_STEPS), 0.0)
        knots = self.pressure.knots
        more = np.concatenate([place - near, place + near])
        inside = more[(more > knots[0]) & (more < knots[-1])]
        return self._cut(np.unique(np.concatenate([knots, inside])), self.length)

    def _weighted(self, ends: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        x, w = np.polynomial.legendre.leggauss(self.nodes)
        half = np.diff(ends) / 2.0
        t = ((ends[1:] + ends[:-1])[:, None] / 2.0 + half[:, None] * x).ravel()
        return t, (half[:, None] * w).ravel() * self.pressure(t)
