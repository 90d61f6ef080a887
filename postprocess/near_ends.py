"""Pressure and slopes next to the free ends and the cusps of a contact, from a little farther away.

By the local analysis they are smooth functions there, one of them times a power of the distance.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.sie.linear import LinearPressure
from galinx.solvers.solution import Between, Surface, Turns

#: Distances from an end, over that of the nearest kink, between which its pressure is looked at; places
#: there, and the degree of the polynomial through them.
_LOOKED_AT, _PLACES, _DEGREE = (0.02, 0.25), 12, 5


def places_at_end(gap: float) -> NDArray[np.float64]:
    """Distances over a from an end at which the pressure tells how it falls to it, growing.

    Args:
        gap: distance of the nearest kink, or of the other end.
    """
    near, far = (share * min(gap, 1.0) for share in _LOOKED_AT)
    t = np.cos(np.pi * (2.0 * np.arange(_PLACES)[::-1] + 1.0) / (2.0 * _PLACES))
    return (near + far) / 2.0 + (far - near) / 2.0 * t


def towards_end(d: NDArray, known: NDArray, σ_YY: NDArray, exponent: float) -> NDArray[np.float64]:
    """A pressure d^a times a smooth function, nearer to the end than where it is known.

    Args:
        d: distances that are wanted, over a.
        known: those of :func:`places_at_end`.
        σ_YY: at these.
        exponent: a, at the free end.
    """
    smooth = np.polynomial.Chebyshev.fit(known, σ_YY / known**exponent, _DEGREE)
    return d**exponent * smooth(d)


#: Distances from an end, over that of the nearest kink, between which what is known to be A(d) + d^a B(d)
#: on one side, A and B smooth, is looked at: slopes next to an end, the pressure next to a cusp. Places
#: there, even in the root of d; terms of each of the two series.
_SEEN, _SEEN_AT_CUSP, _SEEN_AT, _TERMS_OF_EACH = (2e-5, 5e-2), (3e-4, 2e-2), 24, 3
#: Distance over a from an end within which stresses beside it tell what they are at it; singular values
#: below which terms are one.
_BESIDE_END, _NO_DIGIT = 2e-4, 1e-12
#: Powers of the distance, over d^a, with which solids graded from the surface on add logarithms.
_LOGS = (1.0, 2.0)
#: Distance from an end, over that of the nearest kink, up to which what is left of an intensity is more
#: than it is elsewhere.
_CLEARED = 0.1


def _two_series(
    gap: float, seen: tuple[float, float], exponent: float, at_end: bool = False
) -> tuple[NDArray[np.float64], Callable[[NDArray], NDArray], NDArray[np.float64]]:
    """Where A(d) + d^a B(d) is to be known, and what it is by what it is there.

    Args:
        gap: that distances are over.
        seen: the nearest and the farthest.
        exponent: a.
        at_end: are there what solids graded from the surface on add, d^(a + 1) log d and d^(a + 2) log d,
            and what is left of an intensity, d^(a - 1), the last of the terms?

    Returns:
        Distances (m,), the terms at other distances, of (n,) (n, terms), and what gives their amplitudes,
        (terms, m).
    """
    low, high = (np.sqrt(share * min(gap, 1.0)) for share in seen)
    t = np.cos(np.pi * (np.arange(_SEEN_AT) + 0.5) / _SEEN_AT)
    known = np.asarray(((low + high) / 2.0 + (high - low) / 2.0 * t) ** 2)
    powers = np.arange(_TERMS_OF_EACH)

    def terms(d: NDArray) -> NDArray[np.float64]:
        x = d / high**2
        found = np.power.outer(x, np.concatenate([powers, exponent + powers]))
        if not at_end:
            return found
        more = np.power.outer(x, exponent + np.append(_LOGS, -1.0))
        more[:, :-1] *= np.log(x)[:, None]
        return np.concatenate([found, more], axis=1)

    return known, terms, np.asarray(np.linalg.pinv(terms(known)), dtype=np.float64)


@dataclass(frozen=True)
class Series:
    """A(d) + d^a B(d), A and B smooth, from what it is at some distances d.

    Attributes:
        known: these distances over a, (m,).
        terms: the two series' terms at other distances, of (n,) (n, terms).
        amplitudes: what gives the terms' amplitudes by values at these, (terms, m).
    """

    known: NDArray[np.float64]
    terms: Callable[[NDArray], NDArray]
    amplitudes: NDArray[np.float64]

    def by_known(self, d: NDArray) -> NDArray[np.float64]:
        """What multiplies values at the known distances to give those at others, (n, m)."""
        return np.asarray(self.terms(d) @ self.amplitudes)

    def through(self, values: NDArray) -> Callable[[NDArray], NDArray]:
        """The sum by distance, from its values at the known ones, (m,)."""
        return lambda d: self.by_known(d) @ values


def towards_cusp(gap: float, exponent: float) -> Series:
    """Pressure or slopes next to a kink under which they have a cusp.

    Args:
        gap: distance of the next kink or end, over a.
        exponent: of the distance from the kink, in (0, 1).
    """
    return Series(*_two_series(gap, _SEEN_AT_CUSP, exponent))


def in_plane_at_ends(X: NDArray, σ_XX: NDArray, exponents: NDArray) -> NDArray[np.float64]:
    """σ_XX at the ends of contacts by the limit from beside them, NaN at sharp ones, (states, 2).

    Args:
        X: positions over a, (n,).
        σ_XX: there, (states, n).
        exponents: of the pressure at the left and the right end, (states, 2).
    """
    found = np.full(exponents.shape, np.nan)
    for i, side in enumerate((-1.0, 1.0)):
        d = side * X - 1.0
        beside = (d > 0.0) & (d < _BESIDE_END)
        for row in np.flatnonzero(exponents[:, i] > 0.0):
            a = exponents[row, i]
            x = d[beside] / _BESIDE_END
            terms = np.column_stack([np.ones_like(x), x, x**a, x ** (1.0 + a)])
            found[row, i] = np.linalg.lstsq(terms, σ_XX[row, beside], rcond=_NO_DIGIT)[0][0]
    return found


def turns_at_ends(surface: Surface, local: Any) -> Turns:
    """Stresses of states at both ends, NaN at sharp ones.

    Args:
        surface: of the states.
        local: exponents α at X = a and β at X = -a, (states,).
    """
    exponents = np.column_stack([local.β, local.α])
    σ_XX = in_plane_at_ends(surface.places.X, surface.σ_XX, exponents)
    none = np.where(np.isnan(σ_XX), np.nan, 0.0)
    return Turns(np.tile([-1.0, 1.0], (len(σ_XX), 1)), np.array([σ_XX, none, none]))


#: log(d/d') between two knots, distances d and d' from them: a few places, and the many between which a
#: stress is interpolated.
_COARSE, _GRADED = np.array([-2.0, 0.0, 2.0]), np.linspace(-14.0, 14.0, 85)
#: Highest and lowest places among the few next to which the many are looked at.
_TOPS = 4


def turns_at_knots(
    pressure: LinearPressure, g: NDArray, σ_XX: Callable[[NDArray], NDArray[np.float64]]
) -> Turns:
    """Stresses at the knots of a prescribed pressure, NaN where it jumps, and between them.

    Args:
        pressure: prescribed.
        g: σ_XY/σ_YY, (states,).
        σ_XX: in-plane stress over N/(2a) at positions on the surface, (states, n).
    """
    X = np.column_stack([pressure.knots[:-1], _between(pressure, _COARSE)]).ravel()
    each = σ_XX(np.append(X, 1.0))
    each[:, [0, -1]] = np.where(pressure.values[[0, -1]] != 0.0, np.nan, each[:, [0, -1]])
    per = 1 + len(_COARSE)
    σ = each[:, ::per]
    σ_YY = np.where(np.isnan(σ), np.nan, pressure.values)
    knots = np.where(np.isnan(σ), np.nan, pressure.knots)
    tops = np.unique(np.concatenate([_tops(each), _tops(-each)]))
    # A knot belongs to the intervals on both sides of it.
    intervals = np.unique(np.concatenate([tops // per, (tops - 1) // per]))
    intervals = intervals[(intervals >= 0) & (intervals < len(pressure.knots) - 1)]
    graded = _between(pressure, _GRADED)[intervals]
    between = Between(graded, _GRADED, σ_XX(graded.ravel()).reshape(len(g), *graded.shape))
    return Turns(knots, np.array([σ, σ_YY, g[:, None] * σ_YY]), between)


def _between(pressure: LinearPressure, x: NDArray) -> NDArray[np.float64]:
    """Positions over a between neighbouring knots by log(d/d'), see ``_COARSE``, (intervals, n)."""
    left, width = pressure.knots[:-1, None], np.diff(pressure.knots)[:, None]
    return np.asarray(left + width / (1.0 + np.exp(-x)))


def _tops(values: NDArray) -> NDArray[np.int64]:
    """Numbers of the highest places (n,) of curves, (states, n)."""
    padded = np.pad(np.nan_to_num(values, nan=-np.inf), ((0, 0), (1, 1)), constant_values=-np.inf)
    inner = padded[:, 1:-1]
    heights = np.where((inner >= padded[:, :-2]) & (inner >= padded[:, 2:]), inner, -np.inf)
    return np.unique(np.argsort(-heights, axis=1, kind="stable")[:, :_TOPS])


def slopes_towards_ends(
    X: NDArray, gaps: tuple[float, float], exponents: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How displacement gradients next to free ends follow from those a little farther away.

    Nearer than ``_SEEN`` a derivative of finite elements has less digits left than these two series have.
    What is left of an intensity, d^(a - 1), which the pressure's few moments do not see and a free end
    does not have, is taken away up to ``_CLEARED``.

    Args:
        X: positions that are wanted, over a, (n,).
        gaps: distances of the left and the right end from the nearest kink, over a.
        exponents: a, at the left and at the right end.

    Returns:
        Positions (m,) at which gradients are to be known, and what multiplies these, (n, m).
    """
    places, rows = [X], [np.eye(len(X))]
    for end, gap, a in zip((-1.0, 1.0), gaps, exponents):
        for side in (-1.0, 1.0):
            d = side * (X - end)
            length = min(gap, 1.0)
            near, cleared = ((d > 0.0) & (d < share * length) for share in (_SEEN[0], _CLEARED))
            if cleared.any():
                known, terms, amplitudes = _two_series(gap, _SEEN, a, at_end=True)
                rows[0][near] = 0.0
                more = np.zeros((len(X), len(known)))
                more[cleared] = -terms(d[cleared])[:, -1:] * amplitudes[-1]
                more[near] = terms(d[near])[:, :-1] @ amplitudes[:-1]
                places.append(end + side * known)
                rows.append(more)
    return np.concatenate(places), np.concatenate(rows, axis=1)
