"""Free ends of contacts, and pressure and stresses next to ends and kinks, from finite elements.

**Ends.** A contact between two free ends follows from solutions of a few polynomial shapes. With
v = P - v₀ prescribed from m - h to m + h, the load and the intensities K at both ends are linear in P,
and v₀ follows from the load. A half-plane has no length, so the remaining intensities are

    B(P) = ∫ h P'(m + h s) b(s) ds - 2 K(1)/N(1),        s over h from m,

where b are two functions of s alone, one for each end. By the local analysis of the ends they are
(1 - s)^β (1 + s)^α times smooth functions, α and β the exponents of a flat punch. Shapes whose slopes are
Chebyshev polynomials give the moments of b, and thereby the smooth functions. B = 0 is solved for m and h
of any profile under any load, by quadrature.

**Next to ends and kinks.** Pressure and slopes are continued from a little farther away to free ends and
kinks, where finite elements have few digits. By the local analysis they are sums of two terms there: a
smooth function, and a smooth function times a power of the distance or its logarithm.

**Extremes.** The highest and the lowest in-plane stress on the surface include free ends and kinks. The
stress is computed at samples. Around its highest samples it is interpolated by a polynomial of the
confocal coordinate, in which it is smooth up to a free end; at the end itself, and at kinks, its limit is
taken. Places next to sharp edges and tips, where it is infinite, do not count.

**Pressure.** The pressure of a contact with free ends and kinks follows from its nodal forces alone. Its
moments converge slowly where it has a logarithm. But cells are small and many there, so that the
piecewise polynomial with these nodal forces is as accurate as the forces; towards the ends it falls as
the local analysis says.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..profiles import check_reach
from . import ends
from .edges import under_punch
from .estimate import SAFETY
from .panels import Panels
from .prescribed_pressure import LinearPressure
from .pressure import Pressure, largest
from .recovery import ContactFacets, jacobi_in_chebyshev, jacobi_norms
from .solution import Surface, Turns
from .stresses import NEAR, NEAR_TIP

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


def free_ends(local: Any, K: NDArray[np.float64], N: NDArray[np.float64]) -> "list[EndConditions]":
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
        block = np.s_[0, :SHAPES, :SHAPES]
        ends = np.array([self.β]), np.array([self.α])
        P, norms = jacobi_in_chebyshev(*ends)[block], jacobi_norms(*ends)[0, :SHAPES]
        c = (self.moments @ P.T / norms) @ P
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
        m, h = ends.free_ends(ends.Punch(profile, 1.0, 2.0 * unit), lambda _: self._rule, h, m)
        check_reach(profile, m - h, m + h, "finite elements found a contact")
        return m, h

    def _rule(self, kinks: tuple[float, ...]) -> tuple[NDArray, NDArray, NDArray]:
        """Quadrature of both conditions, see :data:`.ends.Rule`."""
        panels = Panels(self.β, self.α, _FINEST, kinks)
        lifting, carrying = np.polynomial.chebyshev.chebval(panels.t, self.factors.T) * panels.weights
        return panels.t, lifting, 2.0 * carrying


#: Distances from an end, over that of the nearest kink, between which the pressure is sampled; number of
#: samples, and degree of the polynomial fitted to them.
_SAMPLED_AT_END, _PLACES, _DEGREE = (0.02, 0.25), 12, 5


def places_at_end(gap: float) -> NDArray[np.float64]:
    """Distances over a from an end at which the pressure is sampled to continue it, growing, (n,).

    Args:
        gap: distance of the nearest kink, or of the other end.
    """
    near, far = (share * min(gap, 1.0) for share in _SAMPLED_AT_END)
    t = np.cos(np.pi * (2.0 * np.arange(_PLACES)[::-1] + 1.0) / (2.0 * _PLACES))
    return (near + far) / 2.0 + (far - near) / 2.0 * t


def towards_end(d: NDArray, samples: NDArray, σ_YY: NDArray, exponent: float) -> NDArray[np.float64]:
    """Pressure d^a times a smooth function, nearer to the end than its samples, (n,).

    Args:
        d: distances from the end over a, (n,).
        samples: distances of :func:`places_at_end`, (m,).
        σ_YY: contact stress at the samples, (m,), in the unit of the result.
        exponent: a, positive.
    """
    smooth = np.polynomial.Chebyshev.fit(samples, σ_YY / samples**exponent, _DEGREE)
    return d**exponent * smooth(d)


#: Distances from an end, over that of the nearest kink, between which a function A(d) + d^a B(d), A and B
#: smooth, is sampled on either side: slopes next to an end, the pressure next to a cusp. Number of
#: samples, Chebyshev's in the root of d; terms of each of the two series.
_RANGE_AT_END, _SAMPLES, _TERMS_OF_EACH = (2e-5, 5e-2), 24, 3
#: Next to a kink: the nearest sample's distance over the farthest's; the least and the largest distance
#: of the farthest sample; and the truncation error of the series over the cube of that distance, which
#: may be a tenth of the tolerance.
_NEAREST_AT_KINK, _FARTHEST_AT_KINK, _LEFT_OUT = 0.015, (5e-3, 2e-2), 7e-4
#: Least distance of the farthest sample over the length of the innermost cell.
_CELLS_SAMPLED = 2.0
#: Distance of the farthest sample over the usual one, to measure the truncation error of the series.
FARTHER = 2.0
#: Distance over a from an end within which stresses outside the contact give the limit at the end;
#: relative singular value below which terms count as dependent.
_BESIDE_END, _NO_DIGIT = 2e-4, 1e-12
#: Powers of the distance, over d^a, with which solids graded from the surface on add logarithms.
_LOGS = (1.0, 2.0)
#: Distance from an end, over that of the nearest kink, up to which a remaining intensity is subtracted.
_CLEARED = 0.1


@dataclass(frozen=True)
class Series:
    """Continuation of A(d) + d^a B(d), A and B smooth, from samples to other distances d.

    Attributes:
        samples: distances of the samples over a, (m,).
        terms: function that gives the terms of both series at any distances, (n,) to (n, terms).
        amplitudes: map from values at the samples to amplitudes of the terms, (terms, m).
    """

    samples: NDArray[np.float64]
    terms: Callable[[NDArray], NDArray]
    amplitudes: NDArray[np.float64]

    def by_samples(self, d: NDArray) -> NDArray[np.float64]:
        """Map from values at the samples to values at distances d, (n, m)."""
        return np.asarray(self.terms(d) @ self.amplitudes)

    def through(self, values: NDArray) -> Callable[[NDArray], NDArray]:
        """Function of the distance, (n,) to (n,), that continues values at the samples, (m,)."""
        return lambda d: self.by_samples(d) @ values


def _two_series(
    gap: float, span: tuple[float, float], exponent: float, at_end: bool = False, logs: bool = False
) -> Series:
    """Continuation of A(d) + d^a B(d) from samples.

    Args:
        gap: unit of the distances over a.
        span: distances of the nearest and the farthest sample, over the gap.
        exponent: a.
        at_end: add the terms of solids graded from the surface on, d^(a + 1) log d and d^(a + 2) log d,
            and that of a remaining intensity, d^(a - 1), the last of the terms.
        logs: multiply the terms of the second series by log d.
    """
    low, high = (np.sqrt(share * min(gap, 1.0)) for share in span)
    t = np.cos(np.pi * (np.arange(_SAMPLES) + 0.5) / _SAMPLES)
    samples = np.asarray(((low + high) / 2.0 + (high - low) / 2.0 * t) ** 2)
    powers = np.arange(_TERMS_OF_EACH)

    def terms(d: NDArray) -> NDArray[np.float64]:
        x = d / high**2
        powers_of_d = np.power.outer(x, np.concatenate([powers, exponent + powers]))
        if logs:
            powers_of_d[:, _TERMS_OF_EACH:] *= np.log(np.maximum(x, np.finfo(float).tiny))[:, None]
        if not at_end:
            return powers_of_d
        more = np.power.outer(x, exponent + np.append(_LOGS, -1.0))
        more[:, :-1] *= np.log(x)[:, None]
        return np.concatenate([powers_of_d, more], axis=1)

    return Series(samples, terms, np.asarray(np.linalg.pinv(terms(samples)), dtype=np.float64))


def towards_kink(gap: float, exponent: float, farthest: float, farther: float = 1.0) -> Series:
    """Continuation of pressure or slopes to a kink where they are finite.

    Args:
        gap: distance of the next kink or end, over a.
        exponent: power of the distance d from the kink, below 1 at a cusp; a whole number n for dⁿ log d.
        farthest: usual distance of the farthest sample over the gap, from :func:`farthest_at_kink`.
        farther: distance of the farthest sample over the usual distance.
    """
    span = _NEAREST_AT_KINK * farthest, farther * farthest
    return _two_series(gap, span, exponent, logs=exponent % 1.0 == 0.0)


def farthest_at_kink(tolerance: float) -> float:
    """Distance from a kink, over that of the next kink or end, of the farthest sample.

    Nearer to the kink finite elements have fewer digits, farther away the series converge less.
    """
    return float(np.clip((0.1 * tolerance / _LEFT_OUT) ** (1.0 / 3.0), *_FARTHEST_AT_KINK))


def error_at_kink(usual: NDArray, farther: NDArray, in_cells: float | None = None) -> float:
    """Error of the limits from the left and the right of a kink, in their unit.

    One part is the truncation error, which grows with the distance like the first term that the series
    lack. The other is half of the difference of both limits, which should be equal.

    Samples in the innermost cells have the error of these, which hardly falls with the degree. Changes to
    values that have more of it, or less, then show it whole.

    Args:
        usual: both limits, (2,), from series sampled up to the usual distance.
        farther: both limits, (2,), from series sampled up to ``FARTHER`` times that distance.
        in_cells: value of the innermost cells at the kink; None where all samples are beyond these cells.
    """
    left_out = np.abs(farther - usual).max() / (FARTHER**_TERMS_OF_EACH - 1.0)
    if in_cells is not None:
        left_out = np.abs([farther - usual, in_cells - usual]).max()
    return float(SAFETY * left_out + np.ptp(usual) / 2.0)


def in_plane_at_ends(X: NDArray, σ_XX: NDArray, exponents: NDArray) -> NDArray[np.float64]:
    """In-plane stress at the ends of contacts by the limit from outside, NaN at sharp edges, (states, 2).

    Args:
        X: positions over a, (n,).
        σ_XX: in-plane stress at these, (states, n), in the unit of the result.
        exponents: exponents of the pressure at the left and the right end, (states, 2).
    """
    limits = np.full(exponents.shape, np.nan)
    for i, side in enumerate((-1.0, 1.0)):
        d = side * X - 1.0
        beside = (d > 0.0) & (d < _BESIDE_END)
        for row in np.flatnonzero(exponents[:, i] > 0.0):
            a = exponents[row, i]
            x = d[beside] / _BESIDE_END
            terms = np.column_stack([np.ones_like(x), x, x**a, x ** (1.0 + a)])
            limits[row, i] = np.linalg.lstsq(terms, σ_XX[row, beside], rcond=_NO_DIGIT)[0][0]
    return limits


def turns_at_ends(surface: Surface, local: Any) -> Turns:
    """Limits of stresses at both ends of contacts, NaN at sharp edges.

    Args:
        surface: stresses of the states on the surface.
        local: exponents α at X = a and β at X = -a, (states,).
    """
    exponents = np.column_stack([local.β, local.α])
    σ_XX = in_plane_at_ends(surface.places.X, surface.σ_XX, exponents)
    none = np.where(np.isnan(σ_XX), np.nan, 0.0)
    return Turns(np.tile([-1.0, 1.0], (len(σ_XX), 1)), np.array([σ_XX, none, none]))


#: log(d/d') between two knots at the distances d and d': at a few places that show where the stress is
#: highest, and at the many between which it is interpolated.
_COARSE, GRADED = np.array([-2.0, 0.0, 2.0]), np.linspace(-14.0, 14.0, 85)
#: Number of the highest, and of the lowest, of the few places next to which the many are evaluated.
_TOPS = 4


def turns_at_knots(
    pressure: LinearPressure, g: NDArray, σ_XX: Callable[[NDArray], NDArray[np.float64]]
) -> Turns:
    """Limits of stresses at the knots of a prescribed pressure, NaN where it jumps, and between knots.

    Args:
        pressure: the prescribed pressure.
        g: σ_XY/σ_YY, (states,).
        σ_XX: function of positions on the surface over a, (n,), that gives the in-plane stress over
            N/(2a), (states, n).
    """
    jumps_at_ends = pressure.values[[0, -1]] != 0.0
    σ, between = at_and_between(pressure.knots, len(g), σ_XX, jumps_at_ends)
    σ_YY = np.where(np.isnan(σ), np.nan, pressure.values)
    knots = np.where(np.isnan(σ), np.nan, pressure.knots)
    return Turns(knots, np.array([σ, σ_YY, g[:, None] * σ_YY]), between)


def at_and_between(
    places: NDArray,
    states: int,
    σ_XX: Callable[[NDArray], NDArray[np.float64]],
    infinite: NDArray | tuple[bool, bool] = (False, False),
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """In-plane stress over N/(2a) at places where its slope is infinite, (states, places), and between.

    The second is as in :class:`galinx.solvers.contact.solution.Turns`.

    Args:
        places: rising positions over a from -1 to 1, (places,).
        states: number of the states.
        σ_XX: function of positions over a, (n,), that gives the stress, (states, n).
        infinite: True where the stress is infinite at the first and the last place, which gives NaN.
    """
    X = np.column_stack([places[:-1], _between(places, _COARSE)]).ravel()
    each = σ_XX(np.append(X, 1.0))
    each[:, [0, -1]] = np.where(infinite, np.nan, each[:, [0, -1]])
    per = 1 + len(_COARSE)
    tops = np.unique(np.concatenate([_tops(each), _tops(-each)]))
    # A place belongs to the intervals on both sides of it.
    intervals = np.unique(np.concatenate([tops // per, (tops - 1) // per]))
    intervals = intervals[(intervals >= 0) & (intervals < len(places) - 1)]
    graded = np.tile(_between(places, GRADED)[intervals], (states, 1, 1))
    return each[:, ::per], np.array([graded, σ_XX(graded[0].ravel()).reshape(graded.shape)])


def _between(places: NDArray, x: NDArray) -> NDArray[np.float64]:
    """Positions over a between neighbouring places from x = log(d/d'), (intervals, n)."""
    X_left, width = places[:-1, None], np.diff(places)[:, None]
    return np.asarray(X_left + width / (1.0 + np.exp(-x)))


def _tops(values: NDArray) -> NDArray[np.int64]:
    """Numbers of the highest places of any of the curves (states, n), (m,)."""
    padded = np.pad(np.nan_to_num(values, nan=-np.inf), ((0, 0), (1, 1)), constant_values=-np.inf)
    inner = padded[:, 1:-1]
    heights = np.where((inner >= padded[:, :-2]) & (inner >= padded[:, 2:]), inner, -np.inf)
    return np.unique(np.argsort(-heights, axis=1, kind="stable")[:, :_TOPS])


def slopes_towards_ends(
    X: NDArray, gaps: tuple[float, float], exponents: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Map from displacement gradients a little farther away to those next to free ends.

    Nearer than ``_RANGE_AT_END`` a derivative of finite elements has fewer digits than two series have.
    A remaining intensity, d^(a - 1), is subtracted up to ``_CLEARED``: a free end has none, and the few
    moments of the pressure do not contain it.

    Args:
        X: positions over a, (n,).
        gaps: distances of the left and the right end from the nearest kink, over a.
        exponents: exponents a at the left and at the right end.

    Returns:
        Positions over a of the gradients that are needed, (m,), and the map from these, (n, m).
    """
    places, rows = [X], [np.eye(len(X))]
    for end, gap, a in zip((-1.0, 1.0), gaps, exponents):
        for side in (-1.0, 1.0):
            d = side * (X - end)
            length = min(gap, 1.0)
            near, cleared = ((d > 0.0) & (d < share * length) for share in (_RANGE_AT_END[0], _CLEARED))
            if cleared.any():
                series = _two_series(gap, _RANGE_AT_END, a, at_end=True)
                rows[0][near] = 0.0
                more = np.zeros((len(X), len(series.samples)))
                more[cleared] = -series.terms(d[cleared])[:, -1:] * series.amplitudes[-1]
                more[near] = series.terms(d[near])[:, :-1] @ series.amplitudes[:-1]
                places.append(end + side * series.samples)
                rows.append(more)
    return np.concatenate(places), np.concatenate(rows, axis=1)


#: Most tops of the samples that are refined; samples that a polynomial goes through; places between the
#: neighbours of a top at which it is evaluated.
_TOPS_BETWEEN, _THROUGH, _BETWEEN = 3, 8, 65
#: Relative difference of heights, and distance over a of places, up to which they are the same.
_SAME_HEIGHT, _SAME_TOP = 1e-10, 0.05


def extreme_in_plane(
    solution: Any, body: Any, sign: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Highest (1) or lowest (-1) in-plane stress of states over N/(2a), and its place over a, (states,).

    At a free end the place is that end, exactly. Of places that are as high, as both ends are without
    friction, it is the left one.

    Args:
        solution: states solved by any method, see :class:`galinx.solvers.contact.solution.Solution`.
        body: punch and half-plane, see :class:`galinx.solvers.contact.solution.Contact`.
        sign: 1 for the highest, -1 for the lowest.
    """
    surface = solution.surface
    X, σ_XX = surface.places.X, surface.σ_XX
    at, limits = _limits(solution, body)
    infinite = _infinite(solution, body)
    values = np.where(_finite(X, infinite), sign * σ_XX, -np.inf)
    limits = np.where(np.isnan(limits) | ~_finite(at, infinite), -np.inf, sign * limits)
    pieces = (X[:, None] > np.nan_to_num(at, nan=np.inf)[:, None, :]).sum(axis=-1)
    i, j = (
        _as_high(curves, curves.max(axis=1)[:, None]).argmax(axis=1)[:, None]
        for curves in (values, limits)
    )
    tops = [
        (np.take_along_axis(values, i, 1)[:, 0], X[i[:, 0]]),
        (np.take_along_axis(limits, j, 1)[:, 0], np.take_along_axis(at, j, 1)[:, 0]),
    ]
    u = np.where(np.abs(X) > 1.0, np.sign(X) * np.arccosh(np.maximum(np.abs(X), 1.0)), 0.0)
    u = u + np.arcsin(np.clip(X, -1.0, 1.0))
    between = surface.turns.between if surface.turns else None
    if between is not None:
        graded = np.isfinite(between[0]).any(axis=(1, 2))[:, None]
        values = np.where(graded & (np.abs(X) < 1.0), -np.inf, values)
    for top, at_u in _tops_between(u, values, pieces):
        beyond = np.maximum(np.abs(at_u) - np.pi / 2.0, 0.0)
        tops.append((top, np.where(beyond > 0.0, np.sign(at_u) * np.cosh(beyond), np.sin(at_u))))
    for X, σ in () if between is None else np.moveaxis(between, 2, 0):
        values = np.where(np.isfinite(σ) & _finite(X, infinite), sign * σ, -np.inf)
        for top, at_x in _tops_between(GRADED, values, np.zeros(values.shape)):
            tops.append((top, np.array([np.interp(x, GRADED, row) for x, row in zip(at_x, X)])))
    heights, places = (np.array(column) for column in zip(*tops))
    left = np.where(_as_high(heights, heights.max(axis=0)), places, np.inf).min(axis=0)
    best = np.where(places <= left + _SAME_TOP, heights, -np.inf).argmax(axis=0)[None]
    value, place = (np.take_along_axis(of, best, 0)[0] for of in (heights, places))
    return sign * value, place


def _as_high(heights: NDArray, top: NDArray) -> NDArray[np.bool_]:
    """Mask of heights that are the highest one, ``top``, up to rounding."""
    return np.asarray(heights >= top - _SAME_HEIGHT * np.abs(top))


def _finite(X: NDArray, infinite: list[tuple[NDArray, float]]) -> NDArray[np.bool_]:
    """Mask of positions X, (n,) or (states, n), away from places of :func:`_infinite`, (states, n)."""
    each = [~(np.abs(X - place[:, None]) <= reach) for place, reach in infinite]
    return np.logical_and.reduce(each)


def _limits(solution: Any, body: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Positions of ends and kinks over a, and limits of σ_XX there, NaN for none, (states, k) each."""
    surface, ends = solution.surface, np.tile([-1.0, 1.0], (len(solution.g), 1))
    if surface.turns is not None:
        at = np.concatenate([ends, surface.turns.X], axis=1)
        return at, np.concatenate([np.full_like(ends, np.nan), surface.turns.σ[0]], axis=1)
    exponents = np.column_stack([solution.local.β, solution.local.α])
    return ends, in_plane_at_ends(surface.places.X, surface.σ_XX, exponents)


def _infinite(solution: Any, body: Any) -> list[tuple[NDArray[np.float64], float]]:
    """Positions of infinite stresses, (states,), NaN for none, and the excluded distance, all over a."""
    sharp = body.infinite_ends(solution.local)
    ends = [(np.where(sharp[:, i], side, np.nan), NEAR) for i, side in enumerate((-1.0, 1.0))]
    return ends + [((tip - solution.centre) / solution.half_width, NEAR_TIP) for tip in body.tips]


def _tops_between(
    u: NDArray, values: NDArray, pieces: NDArray
) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Highest tops of curves and their places, (states,) each, by polynomials through samples.

    Args:
        u: rising coordinate in which the curves are smooth, (n,).
        values: values of the curves, -inf where they do not count, (states, n).
        pieces: number of the smooth piece of its curve to which a sample belongs, (states, n).
    """
    rows = np.arange(len(values))[:, None]
    inner = values[:, 1:-1]
    top = (inner >= values[:, :-2]) & (inner >= values[:, 2:]) & np.isfinite(inner)
    order = np.argsort(np.where(top, -inner, np.inf), axis=1, kind="stable")[:, :_TOPS_BETWEEN]
    for column in order.T:
        i = column + 1
        window = np.clip(i - _THROUGH // 2, 0, len(u) - _THROUGH)[:, None] + np.arange(_THROUGH)
        # A window that reaches into the next piece is moved back.
        other = pieces[rows, window] != pieces[rows, i[:, None]]
        shift = (other & (window < i[:, None])).sum(axis=1) - (other & (window > i[:, None])).sum(axis=1)
        window = np.clip(window + shift[:, None], 0, len(u) - 1)
        same = (pieces[rows, window] == pieces[rows, i[:, None]]).all(axis=1)
        usable = same & np.isfinite(values[rows, window]).all(axis=1) & (np.diff(window) == 1).all(axis=1)
        usable &= top[rows[:, 0], column]
        if usable.any():
            height, place = np.full(len(values), -np.inf), np.full(len(values), np.nan)
            height[usable], place[usable] = _vertex(
                u, values[rows[usable], window[usable]], window[usable], i[usable]
            )
            yield height, place


def _vertex(
    u: NDArray, values: NDArray, window: NDArray, i: NDArray
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest value of polynomials between the neighbours of the samples ``i``, and its place, (m,)."""
    nodes = u[window]
    low, high = (np.clip(u[np.clip(i + k, 0, len(u) - 1)], nodes[:, 0], nodes[:, -1]) for k in (-1, 1))
    at = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _BETWEEN)
    curve = np.zeros_like(at)
    for k in range(nodes.shape[1]):
        others = np.delete(nodes, k, axis=1)
        factors = (at[:, :, None] - others[:, None]) / (nodes[:, k, None, None] - others[:, None])
        curve += values[:, k, None] * factors.prod(axis=-1)
    k = np.clip(curve.argmax(axis=1), 1, _BETWEEN - 2)[:, None]
    y_left, y, y_right = (np.take_along_axis(curve, k + step, 1)[:, 0] for step in (-1, 0, 1))
    bend = y_left - 2.0 * y + y_right
    with np.errstate(divide="ignore", invalid="ignore"):
        vertex = y - (y_right - y_left) ** 2 / (8.0 * bend)
        step = (y_left - y_right) / (2.0 * bend) * (at[:, 1] - at[:, 0])
    inside = (bend < 0.0) & (np.abs(y_right - y_left) <= -2.0 * bend)
    sampled = np.take_along_axis(at, curve.argmax(axis=1)[:, None], 1)[:, 0]
    place = np.where(inside, np.take_along_axis(at, k, 1)[:, 0] + step, sampled)
    return np.where(inside, vertex, curve.max(axis=1)), place


#: Distance over a within which two places are one.
_SAME = 1e-14


def gaps_of(kinks: NDArray) -> tuple[float, float]:
    """Distances over a of the left and the right end from the nearest kink, or 2 without kinks."""
    return 1.0 + float(kinks.min(initial=1.0)), 1.0 - float(kinks.max(initial=-1.0))


class KinkedPressure(Pressure):
    """Pressure σ_YY over N/(2a) of one state, with free ends and kinks.

    Args:
        s: surface coordinates of the contact nodes in order of X, (F p + 1,).
        degree: polynomial degree p.
        chart: chart of the mesh, see :class:`galinx.meshes.charts.Chart`.
        forces: consistent nodal forces over N/2, (F p + 1,).
        kinks: rising positions of the kinks over a, (k,).
        exponents: exponents of the pressure at the left and the right end, positive.
        exponent: power of the distance d with which the pressure departs from its value at a kink, see
            :func:`towards_kink`; 0 where it is infinite there.
        tolerance: relative error allowed for the limit at a kink.
        infinite: the pressure is infinite at its kinks.
    """

    kinks: NDArray[np.float64]

    #: Both ends are free.
    K_I = np.zeros((1, 2))  # type: ignore[assignment]

    def __init__(
        self, s: NDArray, degree: int, chart: Any, forces: NDArray, kinks: NDArray,
        exponents: tuple[float, float], exponent: float = 0.0, tolerance: float = 1e-6,
        infinite: bool = False,
    ) -> None:  # fmt: skip
        self._infinite = infinite
        self._chart, self.kinks, self._exponent = chart, kinks, exponent
        self.β, self.α = exponents
        self._farthest = farthest_at_kink(tolerance)
        self._facets = ContactFacets(s, degree, chart)
        self._density = self._facets.density(forces)
        self._samples = [places_at_end(gap) for gap in gaps_of(kinks)]
        self._at_samples = [
            self._piecewise(self._samples[0] - 1.0),
            self._piecewise(1.0 - self._samples[1]),
        ]

    @property
    def breaks(self) -> NDArray[np.float64]:  # type: ignore[override]
        """Positions over a between which pressure times the chart's stretch is a polynomial, (n,)."""
        return np.asarray(self._chart.surface_position(self._facets.start[1:]))

    def cells_beside(self, places: NDArray) -> NDArray[np.float64]:
        """Length over a of the longer of the two facets that meet at each end or kink, (n,)."""
        return np.asarray(self._facets_beside(places).max(axis=0))

    def _facets_beside(self, places: NDArray) -> NDArray[np.float64]:
        """Lengths over a of the facets to the left and to the right of each end or kink, (2, n)."""
        edges = np.concatenate([[-1.0], self.breaks, [1.0]])
        lengths = np.pad(np.diff(edges), 1)
        i = np.abs(edges[:, None] - places).argmin(axis=0)
        return lengths[[i, i + 1]]

    def series(self, r: NDArray) -> NDArray[np.float64]:
        σ, inside = np.full(len(r), np.nan), under_punch(r)
        σ[inside] = self._piecewise(r[inside])
        ends = zip((1.0 + r, 1.0 - r), self._samples, self._at_samples, (self.β, self.α))
        for d, samples, values, exponent in ends:
            near = (d > 0.0) & (d < samples[0])
            σ[near] = towards_end(d[near], samples, values, exponent)
        for number, at in enumerate(self.kinks if self._exponent else ()):
            for side in (-1.0, 1.0):
                series, d = self._series(number, side), side * (r - at)
                near = (d >= 0.0) & (d < series.samples.min())
                if near.any():
                    σ[near] = series.through(self._piecewise(at + side * series.samples))(d[near])
        return (σ / ((1.0 - r) ** self.α * (1.0 + r) ** self.β))[None]

    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (1,) each."""
        if self._infinite:
            return np.full(1, np.nan), np.full(1, np.nan)
        facets = self._facets
        nodes = facets.start[:, None] + facets.length[:, None] * facets.nodes
        r = np.unique(np.concatenate([self._chart.surface_position(nodes.ravel()), self.kinks]))
        # Facets have their common node a rounding apart: with both places no top would reach past it.
        r = r[under_punch(r) & (np.diff(r, prepend=-2.0) > _SAME)]
        top = largest(lambda r: -self.σ_YY(r)[0], self.kinks, places=r)
        if self._exponent:
            top = max(top, *((-self.at_kink(i), float(kink)) for i, kink in enumerate(self.kinks)))
        return np.array(top[:1]), np.array(top[1:])

    def at_kink(self, number: int) -> float:
        """Contact stress σ_YY over N/(2a) at a kink."""
        return self.limit_at_kink(number, self._piecewise)

    def limit_at_kink(self, number: int, values: Callable[[NDArray], NDArray]) -> float:
        """Stress or strain at a kink; where it has an ``exponent``, the mean of limits from both sides.

        A limit is taken because the innermost cells are so small that rounding of the nodal forces shows
        in their values.

        Args:
            number: number of the kink, from the left.
            values: function of positions over a, (n,), that gives the stress or strain, (n,).
        """
        if not self._exponent:
            return float(values(self.kinks[[number]])[0])
        return float(np.mean(self._limits(number, values)))

    @property
    def left_at_kinks(self) -> float:
        """Largest error over N/(2a) of the limits at kinks, measured on limits from both sides."""
        if not self._exponent:
            return 0.0
        return max(self._left_at(i) for i in range(len(self.kinks)))

    def _left_at(self, number: int) -> float:
        """Error over N/(2a) of the limits at a kink."""
        kink = self.kinks[[number]]
        nearest = [self._series(number, side).samples.min() for side in (-1.0, 1.0)]
        in_cells = bool((nearest < self._facets_beside(kink)[:, 0]).any())
        usual, farther = (self._limits(number, self._piecewise, by) for by in (1.0, FARTHER))
        return error_at_kink(usual, farther, self._piecewise(kink)[0] if in_cells else None)

    def _limits(
        self, number: int, values: Callable[[NDArray], NDArray], farther: float = 1.0
    ) -> NDArray[np.float64]:
        """Limits from the left and the right of a kink, (2,), see :func:`towards_kink`."""
        at, limits = self.kinks[number], np.empty(2)
        for i, side in enumerate((-1.0, 1.0)):
            series = self._series(number, side, farther)
            limits[i] = series.through(values(at + side * series.samples))(np.zeros(1))[0]
        return limits

    def _series(self, number: int, side: float, farther: float = 1.0) -> Series:
        """Continuation of the pressure to a kink from one side."""
        gaps = np.diff(np.concatenate([[-1.0], self.kinks, [1.0]]))[number : number + 2]
        right = int(side > 0.0)
        # Either side's series are smooth as far as the nearer neighbour, whichever side that is on; but
        # samples that all lie in the innermost cell would show nothing of its error.
        cell = float(self._facets_beside(self.kinks[[number]])[right, 0])
        gap = min(float(gaps[right]), max(float(gaps.min()), _CELLS_SAMPLED * cell / self._farthest))
        return towards_kink(gap, self._exponent, self._farthest, farther)

    def _piecewise(self, r: NDArray) -> NDArray[np.float64]:
        """Contact stress over N/(2a) of the piecewise polynomial at positions over a, (n,)."""
        return self._facets.stress(self._density, r)
