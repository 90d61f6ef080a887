"""What the stresses of some states mean for a solid that yields by von Mises."""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.stresses import maximum_shear, von_mises
from galinx.postprocess.yielding import edges
from galinx.postprocess.yielding.peak import Levels, Peak, circles, peak
from galinx.solvers.profiles import exponent
from galinx.solvers.solids.solid import Response
from galinx.solvers.solution import Body, Turns

#: σ_XX, σ_YY, σ_XY at points (states or 1, n, 2) over a with Y <= 0: (3, states, n).
Field = Callable[[NDArray], NDArray]


#: Of a pressure without a jump, which ends within: at its very ends finite elements have no gradients.
_SMOOTH = np.array([-0.99, -0.5, 0.0, 0.5, 0.99])


#: Rounding of a distance.
_HARDLY = 1.0 - 1e-9


def places(body: Body) -> NDArray[np.float64]:
    """Where the stresses of every state are looked at, over a, (n, 2)."""
    knots = _knots(body)
    return edges.places() if knots is None else Levels(knots).places


def _knots(body: Body) -> NDArray[np.float64] | None:
    """Where a pressure that is finite may change its course over a; None of a punch with edges."""
    if body.pressure:
        return body.pressure.knots
    return _SMOOTH if body.finite else None


class Strength:
    """Yield of some states at one speed.

    Args:
        field: their stresses, of one method.
        body: what slides over what; its yield strength is known.
        response: of the half-plane at that speed.
        g: σ_XY/σ_YY under the punch, (states,).
        local: exponents α at X = a and β at X = -a, (states,); of a punch.
        half_width: of each state [m], (states,), where ends are found.
        turns: stresses by the limit, where they have a power of the distance.
        nearest: distance over a from such places from which on the field is good.
    """

    def __init__(
        self,
        field: Field,
        body: Body,
        response: Response,
        g: NDArray,
        local: Any,
        half_width: NDArray | None = None,
        turns: Turns | None = None,
        nearest: float = 1.0,
    ) -> None:
        self._field, self._body, self._local = field, body, local
        self._turns, self._nearest = turns, nearest
        ends = body.pressure.values[[0, -1]] if body.pressure else np.zeros(2)
        #: Which states have an infinite stress where the pressure ends in a jump, (states,).
        self.infinite = (response.n12 + response.m * g != 0.0) & bool(ends.any())
        assert body.yield_strength
        unit = body.stress if half_width is None else body.load / (2.0 * half_width)
        #: Yield strength in the unit of stresses, (states,).
        self.strength = np.broadcast_to(body.yield_strength / unit, np.shape(g))

    @cached_property
    def von_mises(self) -> Peak:
        """Largest von Mises stress of a pressure."""
        return self._peak(self._von_mises, 0)

    @cached_property
    def shear(self) -> Peak:
        """Largest shear stress in the plane of a pressure."""
        return self._peak(lambda points: maximum_shear(*self._field(points)), 1)

    @property
    def first_load(self) -> NDArray[np.float64]:
        """Load N per depth at which a pressure makes the solid yield somewhere [N/m], (states,).

        Stresses grow like the load; under a punch of the height c|X|^k like its power 1 - 1/k, because
        the contact grows, too.
        """
        k = exponent(self._body.profile) if self._body.found else None
        power = k / (k - 1.0) if k else 1.0
        allowed = (self.strength / self.von_mises.value) ** power
        return np.where(self.infinite, 0.0, self._body.load * allowed)

    @cached_property
    def _zones(self) -> edges.Zones:
        exponents = np.column_stack([self._local.β, self._local.α])
        return edges.zones(self._over_strength, self._invariants[0] / self.strength[:, None], exponents)

    @property
    def reach(self) -> NDArray[np.float64]:
        """Distance over a from X = -a and from X = a within which yield is passed, (states, 2)."""
        return self._zones.reach

    @property
    def depth(self) -> NDArray[np.float64]:
        """Depth over a to which the solid yields at the load, (states,)."""
        if _knots(self._body) is None:
            return self._zones.depth
        there, peak = self._invariants[0] / self.strength[:, None], self.von_mises
        scaled = Peak(peak.value / self.strength, peak.X, peak.Y)
        return self._levels.depth(self._over_strength, there, scaled)

    @cached_property
    def _levels(self) -> Levels:
        knots = _knots(self._body)
        assert knots is not None
        return Levels(knots)

    @cached_property
    def _invariants(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Von Mises and largest shear stress at :func:`places`, (states, n)."""
        return self._both(self._field(places(self._body)[None]))

    def _both(self, σ: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Von Mises and largest shear stress, (states, n), of stresses (3, states, n)."""
        found = self._von_mises_of(σ), maximum_shear(*σ)
        # At a jump, where they are not known, there is nothing to climb to.
        of_mises, of_shear = (np.where(np.isnan(stress), 0.0, stress) for stress in found)
        return of_mises, of_shear

    def _von_mises_of(self, σ: NDArray) -> NDArray[np.float64]:
        XX, YY, XY = σ
        return von_mises(XX, YY, XY, self._body.solid.σ_ZZ(XX, YY, XY))

    def _von_mises(self, points: NDArray) -> NDArray[np.float64]:
        return self._von_mises_of(self._field(points))

    def _over_strength(self, points: NDArray) -> NDArray[np.float64]:
        return self._von_mises(points) / self.strength[:, None]

    @cached_property
    def _near_turns(self) -> tuple[NDArray, NDArray, tuple[NDArray, NDArray]] | None:
        """Places around where stresses turn, steps there, and both stresses; None without any."""
        if self._turns is None:
            return None
        centres = np.where(np.isnan(self._turns.X), self._turns.X[:, :1], self._turns.X)
        if np.array_equal(centres, np.broadcast_to(centres[:1], centres.shape)):
            centres = centres[:1]
        around, steps = circles(centres, self._nearest)
        return around, steps, self._both(self._field(around))

    def _off_turns(self, stress: Callable[[NDArray], NDArray]) -> Callable[[NDArray], NDArray]:
        """The stress, NaN nearer to where stresses turn than the field is good."""
        if self._turns is None:
            return stress
        X = self._turns.X

        def off(points: NDArray) -> NDArray[np.float64]:
            distance = np.hypot(points[..., None, 0] - X[:, None], points[..., None, 1])
            near = np.nan_to_num(distance, nan=np.inf).min(axis=-1) < self._nearest * _HARDLY
            return np.where(near, np.nan, stress(points))

        return off

    def _peak(self, stress: Callable[[NDArray], NDArray], which: int) -> Peak:
        """Of von Mises (0) or of the largest shear stress (1)."""
        at, steps, there = self._levels.places[None], self._levels.steps, self._invariants[which]
        if self._near_turns and self._turns:
            around, more, near = self._near_turns
            at = np.concatenate([np.broadcast_to(at, (len(around), *at.shape[1:])), around], axis=1)
            steps, there = np.append(steps, more), np.concatenate([there, near[which]], axis=1)
        found = peak(self._off_turns(stress), at, steps, there)
        if self._turns:
            limit = self._both(self._turns.σ)[which]
            best, rows = limit.argmax(axis=1), np.arange(len(limit))
            higher = limit[rows, best] > found.value
            found = Peak(
                np.where(higher, limit[rows, best], found.value),
                np.where(higher, self._turns.X[rows, best], found.X),
                np.where(higher, 0.0, found.Y),
            )
        return Peak(*(np.where(self.infinite, np.nan, x) for x in (found.value, found.X, found.Y)))
