"""The pressure of a contact with free ends and kinks, from its nodal forces alone.

Its moments converge slowly where it has a logarithm. Cells are small and many there instead, so that the
piecewise polynomial that has the nodal forces is as good as they are; towards the ends it falls as the
local analysis says.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.near_ends import places_at_end, towards_cusp, towards_end
from galinx.postprocess.pressure import density_of_forces, facets_of, lagrange, reference_nodes
from galinx.solvers.contact import under_punch

#: Places at which a largest pressure is looked for at a time; steps between them that are small enough.
_LOOKED_AT, _STEP = 81, 2e-5


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
        self._chart, self._kinks, self._exponents, self._cusp = chart, kinks, exponents, cusp
        self._start, self._length = s[facets[:, 0]], s[facets[:, -1]] - s[facets[:, 0]]
        self._nodes = reference_nodes(s, facets)
        self._density = density_of_forces(s, facets, forces)[facets]
        self._known = [places_at_end(gap) for gap in gaps_of(kinks)]
        self._there = [self._piecewise(self._known[0] - 1.0), self._piecewise(1.0 - self._known[1])]

    def σ_YY(self, r: NDArray) -> NDArray[np.float64]:
        """At positions over a, (n,); NaN beside the contact."""
        found, inside = np.full(len(r), np.nan), under_punch(r)
        found[inside] = self._piecewise(r[inside])
        ends = zip((1.0 + r, 1.0 - r), self._known, self._there, self._exponents)
        for d, known, values, exponent in ends:
            near = (d > 0.0) & (d < known[0])
            found[near] = towards_end(d[near], known, values, exponent)
        return found

    def largest(self) -> tuple[float, float]:
        """Largest pressure over N/(2a), and its place over a, by looking nearer and nearer."""
        low, high, step = -1.0, 1.0, 1.0
        while step > _STEP:
            # Next to a kink it may have a cusp, which is no place that a grid would meet.
            r = np.linspace(low, high, _LOOKED_AT)[1:-1]
            r = np.unique(np.append(r, self._kinks[(self._kinks > r[0]) & (self._kinks < r[-1])]))
            p = -self.σ_YY(r)
            i, step = int(p.argmax()), (high - low) / (_LOOKED_AT - 1)
            low, high = max(r[i] - 2.0 * step, -1.0), min(r[i] + 2.0 * step, 1.0)
        found = [(float(p[i]), float(r[i]))]
        if self._cusp:
            found += [(self._at_cusp(i), float(kink)) for i, kink in enumerate(self._kinks)]
        return max(found)

    def _at_cusp(self, number: int) -> float:
        """The pressure at a kink, from both sides: no polynomial has a cusp."""
        at, ends = self._kinks[number], np.concatenate([[-1.0], self._kinks, [1.0]])
        found = []
        for side, other in ((-1.0, ends[number]), (1.0, ends[number + 2])):
            known, weights = towards_cusp(abs(other - at), self._cusp)
            found.append(-float(weights @ self._piecewise(at + side * known)))
        return float(np.mean(found))

    def _piecewise(self, r: NDArray) -> NDArray[np.float64]:
        at = self._chart.surface_coordinate(r)
        facet = np.clip(np.searchsorted(self._start, at, side="right") - 1, 0, len(self._start) - 1)
        values = lagrange(self._nodes, (at - self._start[facet]) / self._length[facet])
        density = np.einsum("qi,qi->q", values, self._density[facet])
        return np.asarray(density / self._chart.surface_stretch(at))
