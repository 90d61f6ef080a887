"""The pressure of a contact with free ends and kinks, from its nodal forces alone.

Its moments converge slowly where it has a logarithm. Cells are small and many there instead, so that the
piecewise polynomial that has the nodal forces is as good as they are; towards the ends it falls as the
local analysis says.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.near_ends import Series, places_at_end, towards_cusp, towards_end
from galinx.postprocess.pressure import density_of_forces, facets_of, lagrange, reference_nodes
from galinx.solvers.contact import under_punch

#: Most tops that are looked at more nearly; places at a time; steps between them that are small enough.
_TOPS, _LOOKED_AT, _STEP = 4, 41, 2e-5


def gaps_of(kinks: NDArray) -> tuple[float, float]:
    """Distances of the left and the right end from the nearest kink, or from one another."""
    return 1.0 + float(kinks.min(initial=1.0)), 1.0 - float(kinks.max(initial=-1.0))


class KinkedPressure:
    """σ_YY over N/(2a) of one state.

    Args:
        s: surface coordinates of the contact nodes in order of X, (F p + 1,).
        degree: polynomial degree p.
        chart: the mesh's chart, see :class:`galinx.solvers.fem.chart.Chart`.
        forces: consistent nodal forces over N/2, (F p + 1,).
        kinks: places of the kinks over a, in their order.
        exponents: of the pressure at the left and the right end, positive.
        cusp: exponent of the distance from a kink with which the pressure leaves its value there, if it
            is below 1; 0 for none.
    """

    def __init__(
        self,
        s: NDArray,
        degree: int,
        chart: Any,
        forces: NDArray,
        kinks: NDArray,
        exponents: tuple[float, float],
        cusp: float = 0.0,
    ) -> None:
        facets = facets_of(s, degree)
        self._chart, self.kinks, self._exponents, self._cusp = chart, kinks, exponents, cusp
        self._start, self._length = s[facets[:, 0]], s[facets[:, -1]] - s[facets[:, 0]]
        self._nodes = reference_nodes(s, facets)
        self._density = density_of_forces(s, facets, forces)[facets]
        self._known = [places_at_end(gap) for gap in gaps_of(kinks)]
        self._there = [self._piecewise(self._known[0] - 1.0), self._piecewise(1.0 - self._known[1])]

    @property
    def breaks(self) -> NDArray[np.float64]:
        """Positions over a between which it is a polynomial but for the chart's stretch."""
        return np.asarray(self._chart.surface_position(self._start[1:]))

    def σ_YY(self, r: NDArray) -> NDArray[np.float64]:
        """At positions over a, (n,); NaN beside the contact."""
        found, inside = np.full(len(r), np.nan), under_punch(r)
        found[inside] = self._piecewise(r[inside])
        ends = zip((1.0 + r, 1.0 - r), self._known, self._there, self._exponents)
        for d, known, values, exponent in ends:
            near = (d > 0.0) & (d < known[0])
            found[near] = towards_end(d[near], known, values, exponent)
        for number, at in enumerate(self.kinks if self._cusp else ()):
            for side in (-1.0, 1.0):
                series, d = self._series(number, side), side * (r - at)
                near = (d >= 0.0) & (d < series.known.min())
                if near.any():
                    found[near] = series.through(self._piecewise(at + side * series.known))(d[near])
        return found

    def largest(self) -> tuple[float, float]:
        """Largest pressure over N/(2a), and its place over a: nearer and nearer to the best nodes."""
        nodes = self._start[:, None] + self._length[:, None] * self._nodes
        r = np.unique(np.concatenate([self._chart.surface_position(nodes.ravel()), self.kinks]))
        r = r[under_punch(r)]
        p = -self.σ_YY(r)
        tops = 1 + np.flatnonzero((p[1:-1] >= p[:-2]) & (p[1:-1] >= p[2:]))
        tops = tops[np.argsort(-p[tops], kind="stable")][:_TOPS]
        found = [self._nearer(*r[[i - 1, i + 1]]) for i in tops.tolist()]
        if self._cusp:
            found += [(-self.at_kink(i), float(kink)) for i, kink in enumerate(self.kinks)]
        return max(found)

    def _nearer(self, low: float, high: float) -> tuple[float, float]:
        step = 1.0
        while step > _STEP:
            # Next to a kink it may have a cusp, which is no place that a grid would meet.
            r = np.linspace(low, high, _LOOKED_AT)
            r = np.unique(np.append(r, self.kinks[(self.kinks > r[0]) & (self.kinks < r[-1])]))
            p = -self.σ_YY(r)
            i, step = int(p.argmax()), (high - low) / (_LOOKED_AT - 1)
            low, high = max(r[i] - 2.0 * step, low), min(r[i] + 2.0 * step, high)
        return float(p[i]), float(r[i])

    def at_kink(self, number: int) -> float:
        """σ_YY over N/(2a) at a kink."""
        return self.limit_at_kink(number, self._piecewise)

    def limit_at_kink(self, number: int, values: Callable[[NDArray], NDArray]) -> float:
        """A stress or strain at a kink, by the limit from both sides where it has a cusp there.

        Args:
            number: of the kink.
            values: at positions over a, (n,).
        """
        at = self.kinks[number]
        if not self._cusp:
            return float(values(np.array([at]))[0])
        both = [(side, self._series(number, side)) for side in (-1.0, 1.0)]
        limits = [series.through(values(at + side * series.known))(np.zeros(1)) for side, series in both]
        return float(np.mean(limits))

    def _series(self, number: int, side: float) -> Series:
        """Of the pressure on one side of a kink."""
        ends = np.concatenate([[-1.0], self.kinks, [1.0]])
        gap = side * (ends[number + (0 if side < 0.0 else 2)] - self.kinks[number])
        return towards_cusp(float(gap), self._cusp)

    def _piecewise(self, r: NDArray) -> NDArray[np.float64]:
        at = self._chart.surface_coordinate(r)
        facet = np.clip(np.searchsorted(self._start, at, side="right") - 1, 0, len(self._start) - 1)
        values = lagrange(self._nodes, (at - self._start[facet]) / self._length[facet])
        density = np.einsum("qi,qi->q", values, self._density[facet])
        return np.asarray(density / self._chart.surface_stretch(at))
