"""Free ends of a contact: its middle and half-width, for every method that solves contacts.

The ends meet two conditions, integrals of the slope P' of the punch over the contact [m - h, m + h]:

    ∫ ρ₁(s) P'(m + h s) ds = 0,        N/μ = h ∫ ρ₂(s) P'(m + h s) ds.

The first says that both ends are in balance, the second that the contact carries the load. A method gives
ρ₁ and ρ₂, which depend on the half-plane, the friction and at most the half-width (:data:`Rule`).

The imbalance grows with the middle, and the load of contacts in balance grows with their half-width, for
every convex punch, whether it is smooth, has kinks or cusps or a flat part. So one search is within the
other, each for the root of a growing function. In a flat part the balance is an interval, but there a
contact carries nothing, and is widened.

**Finite elements** give the conditions by solutions of a few polynomial shapes (:class:`EndConditions`).
With v = P - v₀ prescribed from m - h to m + h, the load and the intensities K at both ends are linear in
P, and v₀ follows from the load. A half-plane has no length, so the remaining intensities are

    B(P) = ∫ h P'(m + h s) b(s) ds - 2 K(1)/N(1),        s over h from m,

where b are two functions of s alone, one for each end. By the local analysis of the ends they are
(1 - s)^β (1 + s)^α times smooth functions, α and β the exponents of a flat punch. Shapes whose slopes are
Chebyshev polynomials give the moments of b, and thereby the smooth functions.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..errors import SolveError
from ..profiles import check_reach, kinks
from .panels import Panels
from .recovery import products

#: First step of the middle over the half-width, and that next to the middle of a similar contact.
_LEAN, _NEXT = 1.0, 1e-3
#: Growth of the load's logarithm with that of the half-width, as a parabola has it; step of the latter
#: where the former is infinite; how much farther than to the expected root it goes.
_GROWTH, _STEP, _BEYOND = 2.0, 1.0, 1.1
#: Farthest middle over the half-width, and change of the half-width's logarithm.
_FARTHEST, _WIDEST = 1e12, 100.0
#: Largest size of a function that is infinite; rounding of a root, and of a sum over its terms' sizes.
_SIZE, ROUNDING, _OF_SUMS = 200.0, 1e-16, 4e-16

#: Points s of a quadrature over the contact, (n,), and their weights times ρ₁ and ρ₂, dimensionless, (n,)
#: each, by the places over the half-width at which the slope or its derivative jumps.
Rule: TypeAlias = Callable[[tuple[float, ...]], tuple[NDArray, NDArray, NDArray]]


@dataclass(frozen=True)
class Punch:
    """A punch and its load; lengths over a unit shared by states.

    Attributes:
        profile: of the punch, in m.
        unit: the unit of length [m].
        compression: N/μ [m].
    """

    profile: Any
    unit: float
    compression: float

    def slope(self, m: float, h: float) -> Callable[[NDArray], NDArray]:
        """μ v,X over N/(2h) at places over the half-width h from the middle m."""

        def slope(r: NDArray) -> NDArray[np.float64]:
            slopes = np.asarray(self.profile.slope(self.unit * (m + h * r)), dtype=float)
            return 2.0 * h * self.unit / self.compression * slopes

        return slope

    def kinks(self, m: float, h: float) -> tuple[float, ...]:
        """Places inside the contact at which the slope or its derivative jumps."""
        at = (np.array(kinks(self.profile), dtype=float) / self.unit - m) / h
        return tuple(at[np.abs(at) < 1.0].tolist())


class NoRoot(ValueError):
    """A function has no root as far as steps went."""


def free_ends(
    punch: Punch,
    rules: Callable[[float], Rule],
    h: float,
    m: float | None = None,
    rounding: float = ROUNDING,
) -> tuple[float, float]:
    """Middle and half-width of a contact with two free ends, in the unit of the punch.

    Args:
        punch: the punch.
        rules: the quadrature of both conditions at a half-width.
        h: half-width to begin with.
        m: middle of a similar contact with that half-width; None without any.
        rounding: see :func:`half_width_of_load`.

    Raises:
        SolveError: no contact satisfies both conditions.
    """
    lean, step = (0.0, _LEAN) if m is None else (m / h, _NEXT)
    middles: dict[float, float] = {}

    def load(h: float) -> float:
        nonlocal lean, step
        rule, carried = cache(rules(h)), {}

        def imbalance(lean: float) -> float:
            s, lifting, carrying = rule(punch.kinks(lean * h, h))
            slope = punch.slope(lean * h, h)(s)
            carried[lean] = float(carrying @ slope) / 2.0
            value = float(lifting @ slope)
            return value if abs(value) > _OF_SUMS * float(np.abs(lifting) @ np.abs(slope)) else 0.0

        before, lean = lean, root(imbalance, lean, step, _FARTHEST)
        step = max(abs(lean - before), _NEXT)
        middles[h] = lean * h
        return logarithm_of_load(carried[lean])

    h = half_width_of_load(load, h, punch, rounding)
    return middles[h], h


def logarithm_of_load(carried: float) -> float:
    """Logarithm of a carried load over the punch's load.

    Minus infinity where a flat part carries none, infinity where tension would be carried.
    """
    if carried == 0.0:
        return -np.inf
    if not carried > 0.0:
        return np.inf
    return float(np.log(carried)) if abs(carried - 1.0) > _OF_SUMS else 0.0


def half_width_of_load(
    load: Callable[[float], float], h: float, punch: Punch, rounding: float = ROUNDING
) -> float:
    """Half-width at which a contact carries the load of its punch, one at which ``load`` was called.

    Args:
        load: logarithm of the load that is carried over the punch's load, by the half-width.
        h: half-width to begin with.
        punch: the punch.
        rounding: relative error of the half-width, which ends the search where each call is expensive. A
            logarithm that is smaller counts as 0: loads grow no slower than half-widths, or hardly so.

    Raises:
        SolveError: no half-width carries the load.
    """

    @cache
    def of_logarithm(x: float) -> float:
        value = load(h * float(np.exp(x)))
        return value if abs(value) > rounding else 0.0

    try:
        expected = abs(of_logarithm(0.0)) / _GROWTH
        step = _BEYOND * expected if 0.0 < expected < np.inf else _STEP
        return h * float(np.exp(root(of_logarithm, 0.0, step, _WIDEST, rounding)))
    except NoRoot:
        raise SolveError(
            f"no contact of a {punch.profile.words()} carries the load: half-widths from "
            f"{h * punch.unit:.3g} m on were tried; the profile has to be convex, and the speed below "
            "the limit of the half-plane"
        ) from None


def root(
    function: Callable[[float], float],
    x: float,
    step: float,
    farthest: float,
    rounding: float = ROUNDING,
) -> float:
    """Root of a growing function, which may be infinite away from it, at a place where it was called.

    Steps that double lead from the first place to beyond the root, and Brent's method from there to it.

    Args:
        function: the function.
        x: first place.
        step: length of the first step.
        farthest: longest step.
        rounding: error of the root; that of floating-point numbers is added.

    Raises:
        NoRoot: the function does not change its sign as far as the steps go.
    """
    from scipy.optimize import brentq  # a slow import

    @cache
    def finite(x: float) -> float:
        return float(np.clip(function(x), -_SIZE, _SIZE))

    direction = -float(np.sign(finite(x)))
    while step <= farthest:
        other = x + direction * step
        if finite(other) * direction >= 0.0:
            return float(brentq(finite, x, other, xtol=rounding, rtol=4.0 * np.finfo(float).eps))
        x, step = other, 2.0 * step
    raise NoRoot


#: Number of shapes: two determine the factors, the third measures their error.
SHAPES = 3
#: Longest panel of the quadrature of their conditions.
_FINEST = 0.7
#: First half-width tried [m].
_FIRST = 1e-3


def heights_of_shapes(s: NDArray, count: int = SHAPES) -> NDArray[np.float64]:
    """Heights of shapes at s, (count, n), whose slopes are T_0, T_1, …, and which are 0 at s = 0."""
    T = np.polynomial.chebyshev
    return np.array([T.chebval(s, T.chebint([0.0] * k + [1.0])) for k in range(count)])


def slopes_of_shapes(profile: Any, centre: float, half_width: float, count: int) -> NDArray[np.float64]:
    """Chebyshev coefficients of a profile's slope dP/ds [m] at X = centre + half_width·s, (count,).

    Args:
        profile: shape P of the punch.
        centre, half_width: of the contact [m].
        count: number of shapes.
    """

    def slope(s: NDArray) -> NDArray[np.float64]:
        return half_width * np.asarray(profile.slope(centre + half_width * s), dtype=float)

    return np.polynomial.chebyshev.chebinterpolate(slope, count - 1)  # type: ignore[arg-type]


def end_conditions(local: Any, K: NDArray[np.float64], N: NDArray[np.float64]) -> "list[EndConditions]":
    """Conditions on both free ends of a contact, for each state's friction.

    Args:
        local: exponents α and β of a flat punch, (states,) each.
        K: intensities at both ends under a flat punch at v = -1 and under ``SHAPES`` shapes,
            (states, 2, 1 + shapes).
        N: loads under the same punches, (states, 1 + shapes).
    """
    share = K[..., :1] / N[:, None, :1]
    moments, constants = (K - share * N[:, None])[..., 1:], 2.0 * share[..., 0]
    return [
        EndConditions(*condition)
        for condition in zip(local.α.tolist(), local.β.tolist(), moments, constants)
    ]


@dataclass(frozen=True)
class EndConditions:
    """Conditions on both free ends of a contact at one friction and one speed.

    Attributes:
        α, β: exponents of a flat punch at the right and at the left end.
        moments: B without its constant part, of every shape at both ends, (2, ``SHAPES``).
        constants: 2 K(1)/N(1) at both ends, (2,).
    """

    α: float
    β: float
    moments: NDArray[np.float64]
    constants: NDArray[np.float64]

    @cached_property
    def factors(self) -> NDArray[np.float64]:
        """Chebyshev coefficients of the smooth factors of two combinations of b, (2, ``SHAPES``).

        The first combination is that in which 2 K(1)/N(1) of both ends cancels; it vanishes where the
        ends are in balance. The second gives the load that a contact carries.
        """
        c = np.linalg.solve(products(self.β, self.α, SHAPES), self.moments.T).T
        r = self.constants / (self.constants @ self.constants)
        lean = np.array([-r[1], r[0]]) @ c
        return np.array([lean / lean[0], r @ c])

    @property
    def unseen(self) -> float:
        """Relative size of the coefficients beyond the first two, which are 0 for a half-plane."""
        return float((np.abs(self.factors[:, 2:]).sum(axis=1) / np.abs(self.factors).max(axis=1)).max())

    def solve(
        self, profile: Any, unit: float, start: tuple[float, float] | None = None
    ) -> tuple[float, float]:
        """Middle and half-width of the contact [m], at which both conditions are satisfied.

        Args:
            profile: shape of the punch.
            unit: N/(2μ) [m].
            start: middle and half-width [m] of a similar contact; None without any.

        Raises:
            SolveError: no contact satisfies the conditions, or it reaches beyond the given profile.
        """
        m, h = start or (None, _FIRST)
        m, h = free_ends(Punch(profile, 1.0, 2.0 * unit), lambda _: self._rule, h, m)
        check_reach(profile, m - h, m + h, "finite elements found a contact")
        return m, h

    def _rule(self, kinks: tuple[float, ...]) -> tuple[NDArray, NDArray, NDArray]:
        """Quadrature of both conditions, see :data:`Rule`."""
        panels = Panels(self.β, self.α, _FINEST, kinks)
        lifting, carrying = np.polynomial.chebyshev.chebval(panels.t, self.factors.T) * panels.weights
        return panels.t, lifting, 2.0 * carrying
