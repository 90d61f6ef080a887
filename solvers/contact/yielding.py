"""Yield by von Mises under a punch or a pressure: largest stresses, zones, and the load at first yield.

**Largest stresses** of a uniform solid. Stresses vary over the distance to the pressure's knots, all of
which lie on the surface. So the solid is sampled at depths that double, at places along X half the depth
apart. Shallow places are sampled only where knots are close enough to one another. The surface itself is
sampled between all knots. Where a contact ends, or its punch has a kink, stresses vary like a power of
the distance: there the solid is sampled on circles of growing radii, and the limit gives the stress at
the place itself. From the highest samples a search climbs to the largest stress.

**Layers.** A stress is largest on the surface, on either side of an interface, or inside a layer. Along
the surface and the interfaces stresses are known at many positions. Inside, a layer is sampled at a few
depths; where one of these has more than the faces beside it, the depth of the largest stress is searched
for between its neighbours. So both methods need stresses at few points, one state at a time.

**Zones** in which the yield strength is reached. How far one reaches is a search for the largest t, a
depth or the distance from a sharp edge, at which the largest stress along another coordinate is the
strength.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..profiles import exponent
from ..solids.half_plane import HalfPlane
from .extremes import NODES, largest, summit
from .stresses import Turns, at_and_between, maximum_shear, on_surface, turns_at_ends, von_mises

#: Function that gives the stress of every state, (states, n), at points over a, (states or 1, n, 2).
Stress = Callable[[NDArray], NDArray]


@dataclass(frozen=True)
class Peak:
    """Largest value of a stress, and its place over a, (states,) each."""

    value: NDArray[np.float64]
    X: NDArray[np.float64]
    Y: NDArray[np.float64]


def places_in_layers(interfaces: NDArray) -> NDArray[np.float64]:
    """Places X, Y over a at which stresses in layers are sampled, (n, 2).

    Args:
        interfaces: depths of the interfaces over a, (layers,).
    """
    depths = np.concatenate(sampled_depths(interfaces))
    X, Y = np.meshgrid(np.linspace(-1.5, 1.5, 7), -depths[depths >= _SHALLOWEST])
    return np.column_stack([X.ravel(), Y.ravel()])


#: Knots over a that stand for a smooth pressure; at the ends finite elements have no gradients.
SMOOTH = np.array([-0.99, -0.5, 0.0, 0.5, 0.99])

#: Depth over a to which the solid is sampled.
_DEEPEST = 10.0
#: Places along X: their distance over the depth; number of them on either side of a knot; and width of a
#: piece over the depth above which this depth is left out, since the surface represents it.
_APART, _AROUND, _SHALLOW = 0.5, 4, 4.0
#: Places on the surface between two knots, and beside all of them on either side.
_BETWEEN, _BESIDE = 4, 40


class Levels:
    """Levels of depth below a pressure at which the solid is sampled, the surface first.

    Args:
        knots: rising positions over a of the pressure's knots, (k,).

    Attributes:
        places: X and Y over a, (n, 2).
        steps: distances over a from each place to its neighbours, (n,).
    """

    def __init__(self, knots: NDArray) -> None:
        width = np.diff(knots)
        narrow = np.minimum(np.append(width, np.inf), np.append(np.inf, width))
        between = (knots[:-1, None] + width[:, None] * np.arange(_BETWEEN) / _BETWEEN).ravel()
        left, right = (np.geomspace(w / _BETWEEN, _DEEPEST, _BESIDE) for w in width[[0, -1]])
        X = [np.concatenate([knots[0] - left[::-1], between, knots[-1:], knots[-1] + right])]
        own = np.concatenate([left[::-1], np.repeat(width, _BETWEEN), width[-1:], right])
        steps, depths, y = [own / (2 * _BETWEEN)], [0.0], _DEEPEST
        while y > width.min() / _SHALLOW:
            apart = _APART * y
            near = knots[narrow < _SHALLOW * y][:, None] / apart
            X.insert(1, apart * np.unique(np.round(near) + np.arange(-_AROUND, _AROUND + 1.0)))
            steps.insert(1, np.full(len(X[1]), apart))
            depths.insert(1, y)
            y /= 2.0
        self.steps, depth = np.concatenate(steps), np.repeat(depths, [len(x) for x in X])
        self.places = np.column_stack([np.concatenate(X), 0.0 - depth])


#: Depths over a at which the largest stress is compared with the strength, from below upwards: the least,
#: each over the one below it, and factor by which a largest one between two of them may be higher.
_THINNEST, _NEXT_ABOVE, _BETWEEN_LEVELS = 1e-4, 0.5**0.25, 1.01
#: Places along X at a depth: distance of the nearest from a turn over the depth, of the farthest over a
#: or the depth, and their number on either side; places all along; and how many of the largest stresses
#: between two places are refined.
_CLOSE, _REACH, _BESIDE_TURN, _ALL_ALONG, _REFINED = 0.3, 3.0, 18, np.linspace(-1.5, 1.5, 31), 3
#: Least distance of two places along X over a or the depth.
_NARROWEST = 1e-6
#: Trials of a depth between two others.
_TRIALS = 8


def depth_of_yield(stress: Stress, peak: Peak, turns: NDArray) -> NDArray[np.float64]:
    """Largest depth over a at which a stress is 1 or more, (states,): 0 without any, NaN beyond 10 a.

    At each depth the stress is largest at some X; that is compared with 1 from below upwards.

    Args:
        stress: function that gives the stress at points, NaN where it is not known.
        peak: largest stress.
        turns: places X over a on the surface near which stresses vary fast, (states, k).
    """
    inner, outer = np.zeros(len(turns)), np.full(len(turns), np.nan)
    levels = _DEEPEST * _NEXT_ABOVE ** np.arange(np.log(_THINNEST / _DEEPEST) / np.log(_NEXT_ABOVE) + 1.0)
    tops: list[NDArray] = []
    open_ = peak.value >= 1.0
    for i, level in enumerate(levels):
        if not open_.any():
            break
        tops.append(_largest_at(stress, np.full(len(turns), level), turns))
        if i > 1:
            # A zone may lie between two depths.
            below, middle, above = tops[-3:]
            bend = below - 2.0 * middle + above
            between = open_ & (middle >= np.maximum(below, above)) & (middle * _BETWEEN_LEVELS >= 1.0)
            if between.any():
                u = np.where(
                    between & (bend < 0.0), (below - above) / 2.0 / np.where(bend, bend, 1.0), 0.0
                )
                y = levels[i - 1] * _NEXT_ABOVE**u
                between &= _largest_at(stress, y, turns) >= 1.0
                inner, outer = np.where(between, y, inner), np.where(between, levels[i - 2], outer)
                open_ = open_ & ~between
        passed = open_ & (tops[-1] >= 1.0)
        inner = np.where(passed, level, inner)
        outer = np.where(passed, levels[i - 1] if i else np.nan, outer)
        open_ = open_ & ~passed
    outer = np.where(open_, levels[-1], outer)
    deeper = (peak.value >= 1.0) & (inner < -peak.Y)
    next_below = levels[np.maximum(np.searchsorted(-levels, peak.Y, side="left") - 1, 0)]
    inner, outer = np.where(deeper, -peak.Y, inner), np.where(deeper, next_below, outer)
    return np.where(peak.value >= 1.0, _crossing(stress, inner, outer, turns), 0.0)


def _crossing(stress: Stress, inner: NDArray, outer: NDArray, turns: NDArray) -> NDArray[np.float64]:
    """Depth between one with a stress of 1 or more and a deeper one without, (states,)."""
    of_inner, of_outer = (_log(_largest_at(stress, y, turns)) for y in (inner, outer))
    for trial in range(_TRIALS):
        share = of_inner / np.where(of_inner > of_outer, of_inner - of_outer, np.inf)
        # Every third halves the interval, whatever the curve is like.
        share = np.clip(share, 0.02, 0.98) if trial % 3 else 0.5
        t = inner + (outer - inner) * share
        top = _log(_largest_at(stress, t, turns))
        passed = top >= 0.0
        inner, of_inner = np.where(passed, t, inner), np.where(passed, top, of_inner)
        outer, of_outer = np.where(passed, outer, t), np.where(passed, of_outer, top)
    share = of_inner / np.where(of_inner > of_outer, of_inner - of_outer, np.inf)
    return np.asarray(inner + (outer - inner) * np.clip(share, 0.0, 1.0))


def _largest_at(stress: Stress, y: NDArray, turns: NDArray) -> NDArray[np.float64]:
    """Largest stress at depths y over a, (states,)."""
    y = np.nan_to_num(y, nan=_DEEPEST)[:, None]
    wide = np.maximum(y, 1.0)
    near, far = _CLOSE * np.maximum(y, _THINNEST), _REACH * wide
    beside = near * (far / near) ** np.linspace(0.0, 1.0, _BESIDE_TURN)
    offsets = np.concatenate([-beside, np.zeros_like(y), beside], axis=1)
    around = (turns[..., None] + offsets[:, None]).reshape(len(y), -1)
    X = np.sort(np.concatenate([around, wide * _ALL_ALONG], axis=1))
    # A place named again would take the place of another top, and has no width: it goes to the end.
    again = np.diff(X, axis=1, prepend=-np.inf) <= _NARROWEST * wide
    X = np.sort(np.where(again, X[:, -1:], X))

    def at(X: NDArray) -> NDArray[np.float64]:
        return _known(stress(np.stack([X, np.broadcast_to(-y, X.shape)], axis=-1)))

    values = at(X)
    padded = np.pad(values, ((0, 0), (1, 1)))
    tops = np.where((values >= padded[:, :-2]) & (values >= padded[:, 2:]), values, -1.0)
    i = np.argsort(-tops, axis=1, kind="stable")[:, :_REFINED]
    low, high = (np.take_along_axis(X, np.clip(i + side, 0, X.shape[1] - 1), 1) for side in (-1, 1))
    middle, half = (low + high) / 2.0, np.maximum(high - low, _NARROWEST * wide) / 2.0
    u = middle[..., None] + half[..., None] * NODES
    of_nodes = at(u.reshape(len(u), -1)).reshape(u.shape)
    bounds = (middle - half).ravel(), (middle + half).ravel()
    refined, _ = summit(u.reshape(-1, len(NODES)), of_nodes.reshape(-1, len(NODES)), *bounds)
    return np.asarray(np.maximum(values.max(axis=1), refined.reshape(i.shape).max(axis=1)))


#: Circles around a place where stresses vary like a power of the distance: radius over that of the next
#: smaller circle, and directions from there, along the surface and down.
_WIDER, _DIRECTIONS = 3.0, np.linspace(0.0, np.pi, 9)


def circles(centres: NDArray, nearest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places on circles around centres on the surface, and distances between neighbours.

    Args:
        centres: X over a of every state's centres, (states, k).
        nearest: radius over a of the smallest circle.

    Returns:
        Places X, Y over a, (states, n, 2), and distances over a from each to its neighbours, (n,).
    """
    radii = 1.0 / _WIDER ** np.arange(np.ceil(-np.log(nearest) / np.log(_WIDER)) + 1.0)
    r, φ = (grid.ravel() for grid in np.meshgrid(radii, _DIRECTIONS, indexing="ij"))
    along, down = r * np.cos(φ), np.where((φ > 0.0) & (φ < np.pi), -r * np.sin(φ), 0.0)
    X = centres[:, :, None] + along
    at = np.stack([X, np.broadcast_to(down, X.shape)], axis=-1)
    return at.reshape(len(centres), -1, 2), np.tile(_APART * r, centres.shape[1])


#: Places from which the search for the largest value starts, and most rounds of it; factor by which the
#: step falls near the largest; and least step over the first one, at which a round without a better value
#: is the last.
_STARTS, _ROUNDS, _FINER, _SMALLEST = 8, 40, 2.0, 1e-3
#: Number of rounds after which only the best starts go on, and number of these.
_ALL_OF_THEM, _BEST = 4, 3
#: Distance from a start, over its step, within which no place may have a larger value; and least stress
#: of a start over the largest.
_OWN, _LEAST = 1.5, 0.7
#: Nine places around a middle, in steps; map from values there to coefficients of 1, u, w, u², uw, w².
_STENCIL = np.array([(u, w) for u in (-1.0, 0.0, 1.0) for w in (-1.0, 0.0, 1.0)])
_FIT = np.linalg.pinv(
    np.stack(
        [np.ones(9), *_STENCIL.T, _STENCIL[:, 0] ** 2, _STENCIL.prod(axis=1), _STENCIL[:, 1] ** 2], axis=1
    )
)


def peak(stress: Stress, places: NDArray, steps: NDArray, there: NDArray) -> Peak:
    """Largest stress in the solid, and its place, by a search around the largest samples.

    A quadratic function is fitted to the values at nine places. Where none of these exceeds the largest
    value so far, as at a kink, the next nine lie closer around its place.

    Args:
        stress: function that gives the stress at points, NaN where it is not known.
        places: sampled places X, Y over a, for all states (1, n, 2) or for each (states, n, 2).
        steps: distances over a from each place to its neighbours, (n,).
        there: stress at the places, (states, n).
    """
    starts = _starts(places, steps, there)
    middle, h = np.take_along_axis(places, starts[..., None], 1), steps[starts]
    top, value, least = middle.copy(), np.full(h.shape, -np.inf), _SMALLEST * h
    for rounds in range(_ROUNDS):
        if rounds == _ALL_OF_THEM:
            best = np.argsort(-value, axis=1, kind="stable")[:, :_BEST]
            value, h, least = (np.take_along_axis(x, best, 1) for x in (value, h, least))
            top, middle = (np.take_along_axis(x, best[..., None], 1) for x in (top, middle))
        middle[..., 1] = np.minimum(middle[..., 1], -h)  # no place lies above the surface
        nine = middle[..., None, :] + h[..., None, None] * _STENCIL
        nine[..., 1] = np.minimum(nine[..., 1], 0.0)
        values = stress(nine.reshape(len(nine), -1, 2)).reshape(nine.shape[:-1])
        values = np.where(np.isnan(values), -np.inf, values)
        highest, where = values.max(axis=-1), np.asarray(values.argmax(axis=-1))
        improved = highest > value
        at = np.take_along_axis(nine, where[..., None, None], 2)[:, :, 0]
        top, value = np.where(improved[..., None], at, top), np.where(improved, highest, value)
        step = np.where(np.isfinite(values).all(axis=-1)[..., None], _summit(values), _STENCIL[where])
        step[..., 1] = np.minimum(step[..., 1], -middle[..., 1] / h)
        middle = np.where(improved[..., None], middle + h[..., None] * step, top)
        if (~improved & (h <= least)).all():
            break
        near = ~improved | (np.abs(step).max(axis=-1) < 1.0)
        h = np.maximum(np.where(near, h / _FINER, h), least)
    winner, rows = value.argmax(axis=1), np.arange(len(there))
    return Peak(value[rows, winner], *top[rows, winner].T)


def _starts(places: NDArray, steps: NDArray, there: NDArray) -> NDArray[np.int64]:
    """Numbers of the places with the largest values among neighbours, (states, ``_STARTS``)."""
    numbers = np.empty((len(there), _STARTS), dtype=np.int64)
    for i, values in enumerate(there):
        if i < len(places):
            distance = np.abs(places[i][:, None] - places[i]).max(axis=-1)
            around = distance <= _OWN * steps[:, None]
        tops = np.flatnonzero(values >= np.where(around, values, -np.inf).max(axis=1))
        # States with fewer turns than others name one of theirs several times.
        once = np.unique(places[i % len(places)][tops], axis=0, return_index=True)[1]
        tops = tops[np.sort(once)]
        tops = tops[np.argsort(-values[tops], kind="stable")][:_STARTS]
        numbers[i] = np.resize(tops[values[tops] >= _LEAST * values[tops[0]]], _STARTS)
    return numbers


def _summit(values: NDArray) -> NDArray[np.float64]:
    """Place of the fitted quadratic's largest value, in steps, (..., 2); without any the best of nine."""
    with np.errstate(invalid="ignore", divide="ignore"):
        _, u, w, uu, uw, ww = np.moveaxis(values @ _FIT.T, -1, 0)
        determinant = 4.0 * uu * ww - uw**2
        summit = np.stack([uw * w - 2.0 * ww * u, uw * u - 2.0 * uu * w], axis=-1)
        summit /= determinant[..., None]
    round_ = (uu < 0.0) & (determinant > 0.0)
    best = _STENCIL[values.argmax(axis=-1)]
    return np.clip(np.where(round_[..., None], summit, best), -1.0, 1.0)


#: Halvings towards the end of a zone, and factor of the distance between places along the other
#: coordinate in each: these have to follow a largest stress that moves.
_HALVINGS, _NEARER = 20, 0.7


def _farthest(
    log_stress: Callable[[NDArray, NDArray], NDArray],
    inner: NDArray, outer: NDArray, s: NDArray, apart: NDArray,
    bounds: Callable[[NDArray], Any],
) -> NDArray[np.float64]:  # fmt: skip
    """Largest t at which the largest stress along s reaches 1, by bisection, (states, k).

    Args:
        log_stress: logarithm of the stress at t, (states, k, 1), and s, (states, k, 3): (states, k, 3).
        inner, outer: t at which it reaches 1, and at which it does not, (states, k).
        s: coordinate near which the stress is largest, (states, k).
        apart: distance of places along s about the largest, (states, k).
        bounds: least and largest s at t.
    """
    of_inner, of_outer = np.zeros_like(inner), np.full_like(inner, np.nan)
    for _ in range(_HALVINGS):
        t = (inner + outer) / 2.0
        low, high = bounds(t)
        s = np.clip(s, low + apart, high - apart)
        values = log_stress(t[..., None], s[..., None] + apart[..., None] * np.array([-1.0, 0.0, 1.0]))
        left, middle, right = np.moveaxis(values, -1, 0)
        slope, bend = (right - left) / 2.0, left - 2.0 * middle + right
        u = np.where(bend < 0.0, np.clip(-slope / np.where(bend < 0.0, bend, 1.0), -1.0, 1.0), 0.0)
        u = np.where(bend < 0.0, u, values.argmax(axis=-1) - 1.0)
        top = np.maximum(middle + slope * u + bend * u**2 / 2.0, values.max(axis=-1))
        s, apart = s + apart * u, _NEARER * apart
        passed = top >= 0.0
        inner, of_inner = np.where(passed, t, inner), np.where(passed, top, of_inner)
        outer, of_outer = np.where(passed, outer, t), np.where(passed, of_outer, top)
    share = np.nan_to_num(of_inner / (of_inner - of_outer))
    return np.asarray(inner + (outer - inner) * share)


def _log(stress: NDArray) -> NDArray[np.float64]:
    return np.log(np.maximum(stress, np.finfo(float).tiny))  # 0 on the free surface without friction


#: Distances over a between which rays are sampled. Nearer, stresses are extrapolated; no zone reaches
#: farther under a load that a punch can carry.
NEAREST, FARTHEST = 1e-4, 10.0
#: Angles from the free surface to the punch, and places along a ray.
_ANGLES, _PLACES = np.linspace(0.0, np.pi, 33), 43
#: Logarithms of a zone's size between which it is searched for, from that by the samples.
_LESS, _MORE = -0.1, 0.1
#: Both edges.
_SIDE = np.array([-1.0, 1.0])


def _grid() -> NDArray[np.float64]:
    """Logarithms of the distances over a at which every ray is sampled, (angles, places).

    A ray ends at X = 0 or at ``FARTHEST``.
    """
    end = -np.log(np.maximum(-np.cos(_ANGLES), 1.0 / FARTHEST))
    return np.linspace(np.log(NEAREST), end, _PLACES, axis=-1)


def _points(side: Any, φ: NDArray, r: NDArray) -> NDArray[np.float64]:
    """Points X, Y over a from polar coordinates at an edge, (..., 2).

    Args:
        side: the edge's X over a.
        φ: angles from the free surface.
        r: distances over a.
    """
    along = (φ <= 0.0) | (φ >= np.pi)  # the surface, to the last digit
    return np.stack([side * (1.0 + r * np.cos(φ)), np.where(along, 0.0, -r * np.sin(φ))], axis=-1)


def places_on_rays() -> NDArray[np.float64]:
    """Places X, Y over a on rays from X = -a, then from X = a, at which stresses are sampled, (n, 2)."""
    rays = (_points(side, _ANGLES[:, None], np.exp(_grid())).reshape(-1, 2) for side in _SIDE)
    return np.concatenate([*rays])


#: Factor that covers rounding of a distance.
_HARDLY = 1.0 - 1e-9


def zones(
    stress: Stress, there: NDArray, exponents: NDArray
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Reach and depth over a of the zones at sharp edges in which the yield strength is exceeded.

    Args:
        stress: von Mises stress over the yield strength.
        there: von Mises stress over the yield strength at places on rays, (states, n).
        exponents: powers of the distance of stresses next to X = -a and to X = a, (states, 2).

    Returns:
        Largest distance from X = -a and from X = a, each on its side of the middle, (states, 2), and
        largest depth, (states,); NaN where a zone extends beyond ``FARTHEST``.
    """
    t, first, power = _grid(), np.log(NEAREST), -exponents[..., None]
    L = _log(there).reshape(len(there), 2, *t.shape)
    passed = L >= 0.0
    endless = (passed[..., -1] & (np.exp(t[:, -1]) >= _HARDLY * FARTHEST)).any(axis=(1, 2))
    with np.errstate(divide="ignore"):
        flat = np.log(np.sin(_ANGLES))  # of the depth over the distance
    # The last sample in the zone, and linear interpolation to the next one.
    last = np.where(passed, np.arange(_PLACES), -1).max(axis=-1)
    k, j = np.clip(last, 0, _PLACES - 2), np.arange(len(t))
    L_in, L_out = (np.take_along_axis(L, i[..., None], -1)[..., 0] for i in (k, k + 1))
    share = L_in / np.where(L_in > L_out, L_in - L_out, np.inf)
    of_rays = np.where(last < _PLACES - 1, t[j, k] + (t[j, k + 1] - t[j, k]) * share, t[:, -1])
    of_rays = np.where(last < 0, first + L[..., 0] / power, of_rays)

    def logarithm(log_r: NDArray, φ: NDArray) -> NDArray[np.float64]:
        """Logarithm of the stress; nearer than ``NEAREST`` that is a power of r, times 1 + B r."""
        r = np.exp(np.clip(log_r, first, np.log(FARTHEST)))
        both = np.concatenate([r, np.full_like(r, 2.0 * NEAREST)], axis=-1)
        points = _points(_SIDE[:, None], np.concatenate([φ, φ], axis=-1), both)
        L, second = np.split(_log(stress(points.reshape(len(φ), -1, 2))).reshape(both.shape), 2, axis=-1)
        nearer = np.maximum(first - log_r, 0.0)
        B = (second - L + power * np.log(2.0)) / NEAREST
        return np.where(nearer > 0.0, L + power * nearer - B * NEAREST * -np.expm1(-nearer), L)

    sizes = []
    for deep in (False, True):
        size = of_rays + flat * deep if deep else of_rays
        guess, φ = size.max(axis=-1), _ANGLES[size.argmax(axis=-1)]

        def at(t: NDArray, φ: NDArray) -> NDArray[np.float64]:
            return logarithm(t - np.log(np.sin(φ)) if deep else t + 0.0 * φ, φ)  # noqa: B023

        def bounds(t: NDArray) -> tuple[Any, NDArray]:
            if deep:  # noqa: B023
                r = np.exp(t)
                return np.arcsin(np.minimum(r / FARTHEST, 1.0)), np.pi - np.arctan(r)
            return 0.0, np.arccos(-np.exp(-np.maximum(t, 0.0)))

        apart = np.full(guess.shape, _ANGLES[1])
        sizes.append(np.exp(_farthest(at, guess + _LESS, guess + _MORE, φ, apart, bounds)))
    reach, depth = sizes[0], sizes[1].max(axis=1)
    return np.where(endless[:, None], np.nan, reach), np.where(endless, np.nan, depth)


@dataclass(frozen=True)
class InSolid:
    """Stresses of states in one uniform solid: all of a solution that its yield asks for.

    Attributes:
        response: half-plane of the solid.
        g: σ_XY/σ_YY on it, (states,).
        local: exponents α at X = a and β at X = -a of a punch, (states,) each.
        half_width: of each state's contact [m], (states,).
        stresses, yield_turns, nearest, kinks_of_friction: see
            :class:`galinx.solvers.contact.solution.Solution`.
    """

    response: HalfPlane
    g: NDArray[np.float64]
    local: Any
    half_width: Any
    stresses: Callable[[NDArray], NDArray]
    yield_turns: Turns | None = None
    nearest: float = 1.0
    kinks_of_friction: Sequence[Sequence[float]] = ()


@dataclass(frozen=True)
class Strength:
    """Yield of states at one speed on a uniform solid.

    Attributes:
        solution: the states, by any method, see :class:`galinx.solvers.contact.solution.Solution`.
        body: :class:`galinx.solvers.contact.solution.Contact`; all but stresses need its yield strength.
    """

    solution: Any
    body: Any

    @property
    def infinite(self) -> NDArray[np.bool_]:
        """True for states whose stress is infinite where the pressure ends in a jump, (states,)."""
        jump = self.body.pressure is not None and bool(self.body.pressure.values[[0, -1]].any())
        strain = self.solution.response.strain(self.solution.g, 0.0, 1.0)
        return (strain != 0.0) & jump

    @property
    def strength(self) -> NDArray[np.float64]:
        """Yield strength over N/(2a), (states,); infinite where it is not given."""
        body, unit = self.body, self.body.load / (2.0 * self.solution.half_width)
        return np.broadcast_to((body.yield_strength or np.inf) / unit, np.shape(self.solution.g))

    @cached_property
    def von_mises(self) -> Peak:
        """Largest von Mises stress over N/(2a) below a finite pressure, NaN where it is infinite."""
        return self._peak(self._von_mises_of)

    @cached_property
    def shear(self) -> Peak:
        """Largest shear stress in the plane over N/(2a) below a finite pressure, NaN where infinite."""
        return self._peak(lambda σ: maximum_shear(*σ))

    @property
    def first_load(self) -> NDArray[np.float64]:
        """Load N per depth at which the solid begins to yield under a finite pressure [N/m], (states,).

        Stresses are proportional to the load; under a punch of the height c|X|^k to its power 1 - 1/k,
        because the contact grows, too.
        """
        k = exponent(self.body.profile) if self.body.found else None
        power = k / (k - 1.0) if k else 1.0
        allowed = (self.strength / self.von_mises.value) ** power
        return np.where(self.infinite, 0.0, self.body.load * allowed)

    @property
    def reach(self) -> NDArray[np.float64]:
        """Reach over a of the yielded zones from X = -a and from X = a, (states, 2)."""
        return self._zones[0]

    @property
    def depth(self) -> NDArray[np.float64]:
        """Largest depth over a at which the solid yields under the load, (states,)."""
        if self._levels is None:
            return self._zones[1]
        peak, turns = self.von_mises, self.solution.yield_turns
        if turns is None:
            X, stress = np.tile(self.body.yield_knots, (len(peak.X), 1)), self._over_strength
        else:
            X = turns.named
            stress = self._away_from_turns(self._over_strength)
        # An infinite stress reaches any strength.
        value = np.where(self.infinite, np.inf, peak.value / self.strength)
        return depth_of_yield(stress, Peak(value, peak.X, np.nan_to_num(peak.Y)), X)

    @cached_property
    def _zones(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        local, there = self.solution.local, _known(self._von_mises_of(self._sampled))
        there = there / self.strength[:, None]
        return zones(self._over_strength, there, np.column_stack([local.β, local.α]))

    @cached_property
    def _levels(self) -> Levels | None:
        knots = self.body.yield_knots
        return Levels(knots) if len(knots) else None

    @cached_property
    def _sampled(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY over N/(2a) at the places where stresses are sampled, (3, states, n)."""
        return self.solution.stresses(self.body.yield_places[None])

    def _von_mises_of(self, σ: NDArray) -> NDArray[np.float64]:
        XX, YY, XY = σ
        return von_mises(XX, YY, XY, self.body.solid.σ_ZZ(XX, YY, XY))

    def _over_strength(self, points: NDArray) -> NDArray[np.float64]:
        return self._von_mises_of(self.solution.stresses(points)) / self.strength[:, None]

    @cached_property
    def _around_turns(self) -> tuple[NDArray, NDArray, NDArray] | None:
        """Places around turns of the stresses, steps between them, and stresses; None without turns."""
        turns = self.solution.yield_turns
        if turns is None:
            return None
        centres = turns.named
        if np.array_equal(centres, np.broadcast_to(centres[:1], centres.shape)):
            centres = centres[:1]
        at, steps = circles(centres, self.solution.nearest)
        return at, steps, self.solution.stresses(at)

    def _away_from_turns(self, stress: Stress) -> Stress:
        """Stress, NaN nearer to turns than the field is accurate."""

        def away(points: NDArray) -> NDArray[np.float64]:
            turns = self.solution.yield_turns.X[:, None]  # type: ignore[union-attr]
            distance = np.hypot(points[..., None, 0] - turns, points[..., None, 1])
            near = np.nan_to_num(distance, nan=np.inf).min(axis=-1) < self.solution.nearest * _HARDLY
            return np.where(near, np.nan, stress(points))

        return away

    def _between_kinks_of_friction(
        self, measure: Callable[[NDArray], NDArray]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest measure on the surface between kinks of friction, -∞ without any, and X, (states, 1).

        Next to a kink stresses are a d log d: the largest may lie closer to it than circles show.
        """
        solution = self.solution
        states_by_kinks: dict[tuple[float, ...], list[int]] = {}
        for state, kinks in enumerate(solution.kinks_of_friction):
            states_by_kinks.setdefault(tuple(kinks), []).append(state)
        states_by_kinks.pop((), None)
        values, places = np.full((2, len(solution.g), 1), -np.inf)
        for kinks, states in states_by_kinks.items():

            def along(X: NDArray) -> NDArray[np.float64]:
                points = np.column_stack([X, np.zeros_like(X)])[None]
                return _known(measure(solution.stresses(points)))[states]  # noqa: B023

            turns = np.unique([-1.0, *kinks, 1.0])
            places[states], values[states] = at_and_between(turns, along, nearest=solution.nearest)[1][
                :, 0, :, None
            ]
        return values, places

    def _peak(self, measure: Callable[[NDArray], NDArray]) -> Peak:
        """Peak of a measure of the stresses (3, states, n)."""
        assert self._levels
        at, steps, there = self._levels.places[None], self._levels.steps, _known(measure(self._sampled))
        turns, around = self.solution.yield_turns, self._around_turns
        if turns is None or around is None:
            best = peak(lambda points: measure(self.solution.stresses(points)), at, steps, there)
        else:
            more, more_steps, σ = around
            stress = self._away_from_turns(lambda points: measure(self.solution.stresses(points)))
            at = np.concatenate([np.broadcast_to(at, (len(more), *at.shape[1:])), more], axis=1)
            there = np.concatenate([there, _known(measure(σ))], axis=1)
            inside = peak(stress, at, np.append(steps, more_steps), there)
            best = _higher(inside, _known(measure(turns.σ)), turns.X)
        if any(map(len, self.solution.kinks_of_friction)):
            best = _higher(best, *self._between_kinks_of_friction(measure))
        return Peak(*(np.where(self.infinite, np.nan, x) for x in (best.value, best.X, best.Y)))


def _known(stress: NDArray) -> NDArray[np.float64]:
    """Stress, 0 where it is NaN, as at a jump of the pressure, which keeps the search away."""
    return np.where(np.isnan(stress), 0.0, stress)


def _higher(peak: Peak, values: NDArray, X: NDArray, Y: Any = 0.0) -> Peak:
    """Highest of a peak and of values at places X and Y over a, (states, n)."""
    rows, i = np.arange(len(values)), values.argmax(axis=1)
    value, place, higher = values[rows, i], X[rows, i], values[rows, i] > peak.value
    return Peak(
        np.where(higher, value, peak.value), np.where(higher, place, peak.X), np.where(higher, Y, peak.Y)
    )


#: Depths below the surface, or below the lowest interface, over a, at which the solid is sampled.
_DEPTHS = np.array([0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 1.5, 2.5, 4.0])
#: Relative depths within a layer.
_WITHIN = np.array([0.2, 0.5, 0.8])
#: Positions X/a at each depth, and places around both ends of the contact over the depth.
_ALONG, _NEAR = np.linspace(-2.5, 2.5, 41), np.linspace(-3.0, 3.0, 13)
#: Accuracy of the depth over the distance of depths.
_ACCURACY = 1e-4
#: Share of the largest stress on a layer's faces from which on a stress inside is searched for.
_NEARLY = 0.98
#: Least depth over a of places at which errors are estimated: nearer to ends one place would be all.
_SHALLOWEST = 0.05
#: Least distance from the surface, and from an interface, over that of the next depth of sampling, at
#: which stresses inside are evaluated.
_LEAST_DEPTH, _NEXT_TO_FACE = 0.3, 1e-6
#: Share of the way from a face to the nearest sample at which a further one shows whether stresses fall.
_FROM_FACE = 0.1


def sampled_depths(interfaces: NDArray) -> list[NDArray[np.float64]]:
    """Depths over a inside each layer and the solid below at which stresses are sampled.

    Args:
        interfaces: depths of the interfaces over a, (layers,).
    """
    tops = np.concatenate([[0.0], interfaces])
    each = [np.union1d(_DEPTHS[_DEPTHS < 0.9 * H], _WITHIN * H) for H in np.diff(tops).tolist()]
    return [top + depths for top, depths in zip(tops.tolist(), [*each, _DEPTHS])]


@dataclass(frozen=True)
class StrengthOfLayers:
    """Largest von Mises stresses in layers, and in the solid below, of states at one speed.

    Attributes:
        solution: the states, by any method, see :class:`galinx.solvers.contact.solution.Solution`.
        body: :class:`galinx.solvers.contact.solution.Contact`, under the load of each state.
    """

    solution: Any
    body: Any

    @cached_property
    def peaks(self) -> Peak:
        """Largest von Mises stress over N/(2a) of every layer and the solid below, (states, parts)."""
        depths, solid = self.body.solid.depths, self.body.solid
        half_width = self.solution.half_width
        of_layers = [self._on_surface()] + [
            Peak(*np.full((3, len(self.solution.g)), -np.inf)) for _ in depths
        ]
        for i, depth in enumerate(depths.tolist()):
            beside = solid.beside(i)  # type: ignore[attr-defined]

            def on_both_sides(σ: NDArray) -> NDArray[np.float64]:
                each = ((σ[2 + side], σ[0], σ[1]) for side in (0, 1))
                return np.array([von_mises(*of, own.σ_ZZ(*of)) for own, of in zip(beside, each)])  # noqa: B023

            ((value, X),) = self.solution.extremes_along(i, on_both_sides, (1.0,))
            for side in (0, 1):
                at = value[side, :, None], X[side, :, None]
                of_layers[i + side] = _higher(of_layers[i + side], *at, -depth / half_width)
        for layer, faces in enumerate(of_layers):
            searched = [self._searched(i, layer, float(value)) for i, value in enumerate(faces.value)]
            value, X, Y = np.array(searched).T
            of_layers[layer] = _higher(faces, value[:, None], X[:, None], Y)
        return Peak(*(np.stack(of, axis=1) for of in zip(*((p.value, p.X, p.Y) for p in of_layers))))

    @property
    def von_mises(self) -> Peak:
        """Largest von Mises stress over N/(2a) of all layers and the solid below, (states,)."""
        layer = self.peaks.value.argmax(axis=1)[:, None]
        of_layers = self.peaks.value, self.peaks.X, self.peaks.Y
        return Peak(*(np.take_along_axis(x, layer, 1)[:, 0] for x in of_layers))

    @property
    def over_strength(self) -> NDArray[np.float64]:
        """Largest stress of every layer over its strength, NaN if not given, (states, parts)."""
        strengths = np.array([np.nan if y is None else y for y in self.body.strengths])
        unit = self.body.load / (2.0 * self.solution.half_width)
        return self.peaks.value * np.reshape(unit, (-1, 1)) / strengths

    def _on_surface(self) -> Peak:
        """Largest von Mises stress on the surface."""
        solution, surface = self.solution, self.solution.surface
        solid = self.body.solid.at(0.0)  # type: ignore[attr-defined]
        X, σ_YY = surface.places.X, np.nan_to_num(surface.σ_YY)

        def stress(XX: NDArray, YY: NDArray, XY: NDArray) -> NDArray[np.float64]:
            return von_mises(XX, YY, XY, solid.σ_ZZ(XX, YY, XY))

        turns = turns_at_ends(surface, solution.local)
        if surface.turns:
            turns = turns.joined(surface.turns)
        σ_XY = self.body.ratio(solution.g, X, solution.half_width) * σ_YY
        curves = stress(surface.σ_XX, σ_YY, σ_XY)
        samples = Peak(curves.max(axis=1), X[curves.argmax(axis=1)], np.zeros(len(curves)))
        at_turns = np.nan_to_num(stress(*turns.σ), nan=-np.inf), turns.X
        places, values = np.full((2, len(curves), 1), -np.inf)
        for state, kinks in enumerate(solution.kinks):
            if len(kinks):
                places[state], values[state] = solution.between_kinks(state, stress)[:, 0]
        smooth = _higher(_higher(samples, *on_surface(X, curves, turns)), *at_turns)
        return _higher(smooth, np.nan_to_num(values, nan=-np.inf), places)

    def _searched(self, state: int, layer: int, faces: float) -> tuple[float, float, float]:
        """Largest von Mises stress inside a layer, X and Y over a; -inf where its faces have more.

        Args:
            state, layer: their numbers.
            faces: largest stress on the layer's faces.
        """
        from scipy.optimize import minimize_scalar  # a slow import

        interfaces = self.body.solid.depths / self.solution.half_width[state]
        sampled = sampled_depths(interfaces)[layer].tolist()
        top = 0.0 if layer == 0 else float(interfaces[layer - 1])
        # Between the first depth and the surface stresses vary ever faster.
        above = top + (_NEXT_TO_FACE if layer else _LEAST_DEPTH) * (sampled[0] - top)
        bottom = float(interfaces[layer]) if layer < len(interfaces) else sampled[-1]
        below = bottom - _NEXT_TO_FACE * (bottom - sampled[-1])
        # Between a face and the nearest sample stresses may rise before they fall.
        first, last = (face + _FROM_FACE * (sampled[n] - face) for face, n in ((above, 0), (below, -1)))
        depths = [first, *sampled, *[last] * (bottom > sampled[-1])]
        values = [self._at_depth(state, depth)[0] for depth in depths]
        best = int(np.argmax(values))
        if values[best] <= faces and max(values[1 : len(sampled) + 1]) < _NEARLY * faces:
            return -np.inf, 0.0, 0.0
        upper = depths[best - 1] if best else above
        lower = depths[best + 1] if best + 1 < len(depths) else below
        # Stresses that fall from a face on, to all samples, have their largest value there.
        for at_face, face in ((best == 0, upper), (best + 1 == len(depths), lower)):
            if at_face and (there := self._at_depth(state, face))[0] >= values[best]:
                return *there, -face
        result = minimize_scalar(
            lambda depth: -self._at_depth(state, depth)[0], bounds=(upper, lower), method="bounded",
            options={"xatol": _ACCURACY * (lower - upper), "maxiter": 25},
        )  # fmt: skip
        depth = float(result.x) if -result.fun >= values[best] else depths[best]
        return *self._at_depth(state, depth), -depth

    def _at_depth(self, state: int, depth: float) -> tuple[float, float]:
        """Largest von Mises stress at a depth over a, and its X over a."""
        near = min(depth, 0.5) * _NEAR
        X = np.unique(np.concatenate([_ALONG, near - 1.0, near + 1.0]))
        return largest(lambda X: self._stress(state, X, depth), [X], refined=1)

    def _stress(self, state: int, X: NDArray, depth: float) -> NDArray[np.float64]:
        """Von Mises stress over N/(2a) at positions over a, (n,), and a depth over a, (n,)."""
        σ_XX, σ_YY, σ_XY = self.solution.inside_of(state, np.column_stack([X, np.full_like(X, -depth)]))
        solid = self.body.solid.at(depth * self.solution.half_width[state])  # type: ignore[attr-defined]
        return von_mises(σ_XX, σ_YY, σ_XY, solid.σ_ZZ(σ_XX, σ_YY, σ_XY))
