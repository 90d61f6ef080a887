"""Yield by von Mises under a punch or a pressure: largest stresses, zones, and the load at first yield.

**Finite stresses.** Computed are the largest stress below a pressure, and the largest depth at which the
yield strength is reached. Stresses vary over the distance to the pressure's knots, all of which lie on
the surface. So the solid is sampled at depths that double, at places along X half the depth apart.
Shallow places are sampled only where knots are close enough to one another. The surface itself is sampled
between all knots. Where a contact ends, or its punch has a kink, stresses vary like a power of the
distance: there the solid is sampled on circles of growing radii, and the limit gives the stress at the
place itself.

**Sharp edges.** At the two edges of a punch stresses are infinite, and yielded zones have a reach and a
depth. Every ray from an edge has a last point in the zone. The farthest and the deepest of these points
give the reach and the depth of a zone of any shape.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..profiles import exponent
from ..solids.half_plane import HalfPlane
from .solution import Contact
from .stresses import Turns, maximum_shear, von_mises

#: Distances over a between which rays are sampled. Nearer, stresses are extrapolated; no zone reaches
#: farther under a load that a punch can carry.
NEAREST, FARTHEST = 1e-4, 10.0

#: Angles from the free surface to the punch, and places along a ray.
_ANGLES, _PLACES = np.linspace(0.0, np.pi, 33), 43

#: Rounds of the search for the best angle, and factor by which the step between angles falls in each.
_EDGE_ROUNDS, _EDGE_FINER = 3, 8.0

#: Steps to the place on a ray where yield is reached, and allowed residual of the stress's logarithm.
_STEPS, _OFF = 5, 1e-8

#: Both edges, for reach and then for depth: the side of the punch, and whether it is a depth.
_SIDE, _DEEP = np.array([-1.0, 1.0, -1.0, 1.0]), np.array([False, False, True, True])

#: Function that gives the stress of every state over the yield strength, (states, n), at points over a,
#: (states or 1, n, 2).
Stress = Callable[[NDArray], NDArray]


def edge_places() -> NDArray[np.float64]:
    """Places X, Y over a on rays from X = -a, then from X = a, at which stresses are sampled, (n, 2)."""
    rays = (_points(side, _ANGLES[:, None], np.exp(_grid())).reshape(-1, 2) for side in (-1.0, 1.0))
    return np.concatenate([*rays])


@dataclass(frozen=True)
class Zones:
    """Reach and depth over a of the zones at sharp edges in which the yield strength is exceeded.

    Both are NaN where a zone extends beyond ``FARTHEST``.

    Attributes:
        reach: largest distance from X = -a and from X = a, each on its side of the middle, (states, 2).
        depth: largest depth, (states,).
    """

    reach: NDArray[np.float64]
    depth: NDArray[np.float64]


def zones(stress: Stress, stresses: NDArray, exponents: NDArray) -> Zones:
    """Reach and depth over a of the zones in which the yield strength is exceeded, from sharp edges.

    Args:
        stress: von Mises stress over the yield strength.
        stresses: von Mises stress over the yield strength at :func:`edge_places`, (states, n).
        exponents: powers of the distance of stresses next to X = -a and to X = a, (states, 2).
    """
    rays = _Rays(stress, -np.tile(exponents, 2))
    at_edges = _log(stresses).reshape(len(stresses), 2, *_grid().shape)
    t, slope, beyond = (np.tile(values, (1, 2, 1)) for values in rays.on_grid(at_edges))
    endless = np.asarray(beyond.any(axis=(1, 2)))
    size = np.where(endless[:, None], np.nan, _largest(rays, t, slope))
    return Zones(size[:, ~_DEEP], size[:, _DEEP].max(axis=1))


def _points(side: float | NDArray, φ: NDArray, r: NDArray) -> NDArray[np.float64]:
    """Points X, Y over a from polar coordinates at an edge, (..., 2).

    Args:
        side: the edge's X over a.
        φ: angles from the free surface.
        r: distances over a.
    """
    along = (φ <= 0.0) | (φ >= np.pi)  # the surface, to the last digit
    return np.stack([side * (1.0 + r * np.cos(φ)), np.where(along, 0.0, -r * np.sin(φ))], axis=-1)


def _end(φ: NDArray) -> NDArray[np.float64]:
    """Logarithm of a ray's length over a, in the shape of φ: up to X = 0, or up to ``FARTHEST``."""
    return -np.log(np.maximum(-np.cos(φ), 1.0 / FARTHEST))


def _grid() -> NDArray[np.float64]:
    """Logarithms of the distances over a at which every ray is sampled, (angles, places)."""
    return np.linspace(np.log(NEAREST), _end(_ANGLES), _PLACES, axis=-1)


def _log(stress: NDArray) -> NDArray[np.float64]:
    return np.log(np.maximum(stress, np.finfo(float).tiny))  # 0 on the free surface without friction


def _height(φ: NDArray) -> NDArray[np.float64]:
    """Factor of a distance, (states, 4, n): 1 for reach, the sine of the angle for depth."""
    return np.where(_DEEP[:, None], np.sin(φ), 1.0)


@dataclass(frozen=True)
class _Rays:
    """Rays from the edges, on which t is the logarithm of the distance over a.

    Attributes:
        stress: von Mises stress over the yield strength.
        power: power of the distance with which stresses fall next to the edges, (states, 4).
    """

    stress: Stress
    power: NDArray[np.float64]

    def on_grid(self, L: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """Approximate places where rays leave the zone, and slopes of the stress there.

        Args:
            L: logarithm of the stress along the rays of the grid, (states, 2, angles, places).

        Returns:
            t, dL/dt, and True where the zone extends beyond ``FARTHEST``, (states, 2, angles) each.
        """
        t, j, end = _grid(), np.arange(len(_ANGLES)), L.shape[-1] - 1
        passed = L >= 0.0
        last = np.where(passed.any(axis=-1), end - passed[..., ::-1].argmax(axis=-1), -1)
        k = np.clip(last, 0, end - 1)
        L_in, L_out = (np.take_along_axis(L, i[..., None], -1)[..., 0] for i in (k, k + 1))
        slope = np.minimum((L_out - L_in) / (t[j, k + 1] - t[j, k]), -1e-3)
        slope = np.where(last < 0, -self.power[:, :2, None], slope)
        out = np.where(last == end, t[:, -1], t[j, k] - L_in / slope)
        return out, slope, (last == end) & (t[:, -1] >= np.log(FARTHEST))

    def outermost(self, φ: NDArray, t: NDArray, slope: NDArray) -> NDArray[np.float64]:
        """Logarithms t of the distances at which rays leave the zone, (states, 4, n); -inf for none.

        Args:
            φ: angles of the rays, (states, 4, n).
            t, slope: guesses of t and of dL/dt at these places, (states, 4).
        """
        t, slope = t[..., None] + 0.0 * φ, slope[..., None] + 0.0 * φ
        L = self._logarithm(φ, t)
        for _ in range(_STEPS):
            step = np.clip(-L / slope, -1.0, 1.0)
            before, t = L, t + step
            L = self._logarithm(φ, t)
            with np.errstate(divide="ignore", invalid="ignore"):
                secant = (L - before) / step
            slope = np.where(np.isfinite(secant) & (secant < 0.0), secant, slope)
        return np.where(np.abs(L) <= _OFF, np.minimum(t - L / slope, _end(φ)), -np.inf)

    def _logarithm(self, φ: NDArray, t: NDArray) -> NDArray[np.float64]:
        """Logarithm of the stress at angles φ and t, (states, 4, n); it falls further beyond a ray's end.

        Nearer than ``NEAREST`` the stress is a power of the distance r, times 1 + B r.
        """
        first, end = np.log(NEAREST), _end(φ)
        r = np.exp(np.clip(t, first, end))
        both = np.concatenate([r, np.full_like(r, 2.0 * NEAREST)], axis=-1)
        points = _points(_SIDE[:, None], np.concatenate([φ, φ], axis=-1), both)
        both_logs = _log(self.stress(points.reshape(len(φ), -1, 2))).reshape(both.shape)
        L, second = np.split(both_logs, 2, axis=-1)
        p, nearer = self.power[..., None], np.maximum(first - t, 0.0)
        B = (second - L + p * np.log(2.0)) / NEAREST
        near = L + p * nearer - B * NEAREST * -np.expm1(-nearer)
        return np.where(nearer > 0.0, near, L - np.maximum(t - end, 0.0))


def _largest(rays: _Rays, t: NDArray, slope: NDArray) -> NDArray[np.float64]:
    """Largest distance over a at which a ray leaves the zone, then largest depth, (states, 4).

    Args:
        rays: rays from both edges.
        t, slope: approximate t and dL/dt of rays of the grid, (states, 4, angles).
    """
    unit = t.max(axis=-1)  # distances themselves may be too small for squares
    best = np.argmax(np.exp(t - unit[..., None]) * _height(_ANGLES), axis=-1)[..., None]
    guess, slope = (np.take_along_axis(x, best, -1)[..., 0] for x in (t, slope))
    φ, h = _ANGLES[best], _ANGLES[1]
    size, solved = (np.exp(guess - unit)[..., None] * _height(φ))[..., 0], np.zeros(guess.shape, bool)
    for _ in range(_EDGE_ROUNDS):
        three = np.clip(φ, h, np.pi - h) + h * np.array([-1.0, 0.0, 1.0])
        three = np.clip(three, 0.0, np.pi)
        at = rays.outermost(three, guess, slope)
        sizes = np.where(np.isfinite(at), np.exp(at - unit[..., None]) * _height(three), -np.inf)
        top = sizes.max(axis=-1)
        better = np.isfinite(top) & (~solved | (top > size))  # than interpolated, or than before
        size, solved = np.where(better, top, size), solved | np.isfinite(top)
        where = sizes.argmax(axis=-1)[..., None]
        guess = np.where(better, np.take_along_axis(at, where, -1)[..., 0], guess)
        φ = three[..., 1:2] + h * vertex(sizes)[..., None]
        h /= _EDGE_FINER
    return size * np.exp(unit)


def vertex(values: NDArray) -> NDArray[np.float64]:
    """Place in [-1, 1] of the largest value of the parabola through values at -1, 0, 1, (..., 3)."""
    y_left, y, y_right = np.moveaxis(values, -1, 0)
    with np.errstate(invalid="ignore", divide="ignore"):
        bend = y_left - 2.0 * y + y_right
        top = np.clip((y_left - y_right) / (2.0 * bend), -1.0, 1.0)
    return np.where(np.isfinite(top) & (bend < 0.0), top, values.argmax(axis=-1) - 1.0)


#: Depth over a to which the solid is sampled.
_DEEPEST = 10.0

#: Places along X: their distance over the depth; number of them on either side of a knot; and width of a
#: piece over the depth above which this depth is left out, since the surface represents it.
_APART, _AROUND, _SHALLOW = 0.5, 4, 4.0

#: Places on the surface between two knots.
_BETWEEN = 4

#: Circles around a place where stresses vary like a power of the distance: radius over that of the next
#: smaller circle, and directions from there, along the surface and down.
_WIDER, _DIRECTIONS = 3.0, np.linspace(0.0, np.pi, 9)

#: Places from which the search for the largest value starts, and most rounds of it; factor by which the
#: step falls near the largest; and least step over the first one, at which a round without a better value
#: is the last.
_STARTS, _ROUNDS, _FINER, _SMALLEST = 8, 40, 2.0, 1e-3
#: Number of rounds after which only the best starts go on, and number of these.
_ALL_OF_THEM, _BEST = 3, 3
#: Distance from a start, over its step, within which no place may have a larger value; and least stress
#: of a start over the largest.
_OWN, _LEAST = 1.5, 0.7

#: Halvings towards a depth, and factor of the distance between places along X in each: places have to
#: follow a largest stress that moves as the depth changes.
_HALVINGS, _NEARER = 30, 0.7

_STENCIL = np.array([(u, w) for u in (-1.0, 0.0, 1.0) for w in (-1.0, 0.0, 1.0)])
#: Map from values on the stencil to coefficients of 1, u, w, u², uw, w².
_FIT = np.linalg.pinv(
    np.stack(
        [np.ones(9), *_STENCIL.T, _STENCIL[:, 0] ** 2, _STENCIL.prod(axis=1), _STENCIL[:, 1] ** 2],
        axis=1,
    )
)


@dataclass(frozen=True)
class Peak:
    """Largest value of a stress, and its place over a, (states,) each."""

    value: NDArray[np.float64]
    X: NDArray[np.float64]
    Y: NDArray[np.float64]


@dataclass(frozen=True)
class Levels:
    """Levels of depth below a pressure at which the solid is sampled.

    Attributes:
        knots: rising positions over a of the pressure's knots, (k,).
    """

    knots: NDArray[np.float64]

    @cached_property
    def _by_level(self) -> list[tuple[NDArray, NDArray, NDArray]]:
        """X and Y over a of the places of every level, and steps over a between them, (n,) each."""
        width = np.diff(self.knots)
        narrow = np.minimum(np.append(width, np.inf), np.append(np.inf, width))
        levels = [_on_surface(self.knots, width)]
        y = _DEEPEST
        while y > width.min() / _SHALLOW:
            apart = _APART * y
            near = self.knots[narrow < _SHALLOW * y][:, None] / apart
            X = apart * np.unique(np.round(near) + np.arange(-_AROUND, _AROUND + 1.0))
            levels.insert(1, (X, np.full(len(X), -y), np.full(len(X), apart)))
            y /= 2.0
        return levels

    @cached_property
    def places(self) -> NDArray[np.float64]:
        """Places over a of all levels, from the surface on, (n, 2)."""
        return np.concatenate([np.column_stack([X, Y]) for X, Y, _ in self._by_level])

    @cached_property
    def steps(self) -> NDArray[np.float64]:
        """Distances over a from each place to its neighbours, (n,)."""
        return np.concatenate([step for *_, step in self._by_level])

    def best(self, values: NDArray) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Number of the place with the largest value on each level, and the value, (states, levels) each.

        Args:
            values: stress at :attr:`places`, (states, n).
        """
        first = np.cumsum([0, *(len(X) for X, *_ in self._by_level)])
        levels = [values[:, i:j].argmax(axis=1) + i for i, j in pairwise(first)]
        best = np.stack(levels, axis=1)
        return best, np.take_along_axis(values, best, 1)

    def depth(self, stress: Stress, there: NDArray, peak: Peak) -> NDArray[np.float64]:
        """Depth over a of the deepest place at which a stress is 1 or more, (states,); 0 without any.

        Args:
            stress: function that gives the stress at points.
            there: stress at :attr:`places`, (states, n).
            peak: largest stress, see :func:`peak`.

        Returns:
            Depths, NaN where the zone extends below all places.
        """
        best, values = self.best(there)
        passed, rows = values >= 1.0, np.arange(len(there))
        deepest = np.where(passed.any(axis=1), passed.shape[1] - 1 - passed[:, ::-1].argmax(axis=1), 0)
        X, Y = self.places[best[rows, deepest]].T
        inner = np.where(passed[rows, deepest], 0.0 - Y, 0.0)
        somewhere = passed.any(axis=1)
        of_peak = (peak.value >= 1.0) & (~somewhere | (inner < -peak.Y))
        inner, X = np.where(of_peak, -peak.Y, inner), np.where(of_peak, peak.X, X)
        depths = np.array([-level[0] for _, level, _ in self._by_level])
        outer = depths[np.minimum(np.searchsorted(depths, inner, side="right"), len(depths) - 1)]
        depth = _deepest(stress, X, inner, outer)
        depth = np.where(passed[:, -1], np.nan, depth)
        return np.where(somewhere | (peak.value >= 1.0), depth, 0.0)


def circles(centres: NDArray, nearest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places on circles around centres on the surface, and distances between neighbours.

    Args:
        centres: X over a of every state's centres, (states, k); NaN for none.
        nearest: radius over a of the smallest circle.

    Returns:
        Places X, Y over a, (states, n, 2), and distances over a from each to its neighbours, (n,).
    """
    radii = 1.0 / _WIDER ** np.arange(np.ceil(-np.log(nearest) / np.log(_WIDER)) + 1.0)
    r, φ = (grid.ravel() for grid in np.meshgrid(radii, _DIRECTIONS, indexing="ij"))
    along, down = r * np.cos(φ), np.where((φ > 0.0) & (φ < np.pi), -r * np.sin(φ), 0.0)
    X = centres[:, :, None] + along
    places = np.stack([X, np.broadcast_to(down, X.shape)], axis=-1)
    return places.reshape(len(centres), -1, 2), np.tile(_APART * r, centres.shape[1])


def peak(stress: Stress, places: NDArray, steps: NDArray, there: NDArray) -> Peak:
    """Largest stress in the solid, and its place, from samples and a search around the largest of them.

    Args:
        stress: function that gives the stress at points.
        places: sampled places X, Y over a, for all states (1, n, 2) or for each (states, n, 2).
        steps: distances over a from each place to its neighbours, (n,).
        there: stress at the places, (states, n).
    """
    starts = _starts(places, steps, there)
    climb = _Climb(np.take_along_axis(places, starts[..., None], 1), steps[starts])
    for rounds in range(_ROUNDS):
        climb.take(stress)
        if climb.done:
            break
        if rounds == _ALL_OF_THEM:
            climb.keep(_BEST)
    winner, rows = climb.value.argmax(axis=1), np.arange(len(there))
    return Peak(climb.value[rows, winner], *climb.top[rows, winner].T)


def _starts(places: NDArray, steps: NDArray, there: NDArray) -> NDArray[np.int64]:
    """Numbers of the places with the largest values among neighbours, (states, ``_STARTS``)."""
    numbers = np.empty((len(there), _STARTS), dtype=np.int64)
    for i, values in enumerate(there):
        if i < len(places):
            distance = np.abs(places[i][:, None] - places[i]).max(axis=-1)
            around = distance <= _OWN * steps[:, None]
        tops = np.flatnonzero(values >= np.where(around, values, -np.inf).max(axis=1))
        tops = tops[np.argsort(-values[tops], kind="stable")][:_STARTS]
        numbers[i] = np.resize(tops[values[tops] >= _LEAST * values[tops[0]]], _STARTS)
    return numbers


def _on_surface(knots: NDArray, width: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Places on the surface at, between and beside the knots: X, Y and steps over a, (n,) each."""
    share = np.arange(_BETWEEN) / _BETWEEN
    between = (knots[:-1, None] + width[:, None] * share).ravel()
    r_left, r_right = (np.geomspace(w / _BETWEEN, _DEEPEST, 40) for w in width[[0, -1]])
    X = np.concatenate([knots[0] - r_left[::-1], between, knots[-1:], knots[-1] + r_right])
    step = np.concatenate([r_left[::-1], np.repeat(width, _BETWEEN), width[-1:], r_right]) / (
        2 * _BETWEEN
    )
    return X, 0.0 * X, step


class _Climb:
    """Search for the largest value near each of several places.

    A quadratic function is fitted to the values at nine places. Where none of these exceeds the largest
    value so far, as at a kink, the next nine lie closer around its place.

    Args:
        places: places over a at which the search starts, (states, starts, 2).
        steps: distances over a from each to its neighbours, (states, starts).

    Attributes:
        top, value: place of the largest value, (states, starts, 2), and the value, (states, starts).
        done: True where further rounds would give no larger value.
    """

    def __init__(self, places: NDArray, steps: NDArray) -> None:
        self.top, self.value = places.copy(), np.full(steps.shape, -np.inf)
        self._middle, self._h, self._least = places.copy(), steps.copy(), _SMALLEST * steps
        self.done = False

    def keep(self, count: int) -> None:
        """Restrict the search to the ``count`` starts with the largest values."""
        starts = np.argsort(-self.value, axis=1, kind="stable")[:, :count]
        self.value, self._h, self._least = (
            np.take_along_axis(x, starts, 1) for x in (self.value, self._h, self._least)
        )
        self.top, self._middle = (
            np.take_along_axis(x, starts[..., None], 1) for x in (self.top, self._middle)
        )

    def take(self, stress: Stress) -> None:
        """Evaluate the stress at nine places around each middle, and move the middles."""
        h = self._h[..., None]
        middle = self._middle
        middle[..., 1] = np.minimum(middle[..., 1], -self._h)  # no place lies above the surface
        nine = middle[..., None, :] + h[..., None] * _STENCIL
        nine[..., 1] = np.minimum(nine[..., 1], 0.0)
        shape = nine.shape[:-1]
        values = stress(nine.reshape(shape[0], -1, 2)).reshape(shape)
        values = np.where(np.isnan(values), -np.inf, values)
        largest, where = values.max(axis=-1), np.asarray(values.argmax(axis=-1))
        improved = largest > self.value
        at = np.take_along_axis(nine, where[..., None, None], 2)[:, :, 0]
        self.top = np.where(improved[..., None], at, self.top)
        self.value = np.where(improved, largest, self.value)
        fitted = np.isfinite(values).all(axis=-1, keepdims=True)
        step = np.where(fitted, _summit(values), _STENCIL[where])
        step[..., 1] = np.minimum(step[..., 1], -middle[..., 1] / self._h)
        self._middle = np.where(improved[..., None], middle + h * step, self.top)
        near = ~improved | (np.abs(step).max(axis=-1) < 1.0)
        self.done = bool((~improved & (self._h <= self._least)).all())
        self._h = np.maximum(np.where(near, self._h / _FINER, self._h), self._least)


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


def _deepest(stress: Stress, X: NDArray, inner: NDArray, outer: NDArray) -> NDArray[np.float64]:
    """Largest depth at which the stress reaches 1, by bisection, (states,).

    Args:
        stress: function that gives the stress at points.
        X: positions over a near which the stress is largest, (states,).
        inner, outer: depths over a at which it reaches 1, and at which it does not, (states,).
    """
    apart = (outer - inner) * _APART
    for _ in range(_HALVINGS):
        y = (inner + outer) / 2.0
        three = X[:, None] + apart[:, None] * np.array([-1.0, 0.0, 1.0])
        values = stress(np.stack([three, -y[:, None] + 0.0 * three], axis=-1))
        u = vertex(values)
        y_left, y_middle, y_right = values.T
        top = y_middle + (y_right - y_left) * u / 2.0 + (y_left - 2.0 * y_middle + y_right) * u**2 / 2.0
        passed = np.maximum(top, values.max(axis=1)) >= 1.0
        X = X + apart * u
        inner, outer = np.where(passed, y, inner), np.where(passed, outer, y)
        apart *= _NEARER
    return inner


#: Function that gives σ_XX, σ_YY, σ_XY over N/(2a), (3, states, n), at points over a with Y <= 0,
#: (states or 1, n, 2).
Field = Callable[[NDArray], NDArray]


#: Knots over a that stand for a smooth pressure; at the ends finite elements have no gradients.
_SMOOTH = np.array([-0.99, -0.5, 0.0, 0.5, 0.99])


#: Factor that covers rounding of a distance.
_HARDLY = 1.0 - 1e-9


def places(body: Contact) -> NDArray[np.float64]:
    """Places X, Y over a at which the stresses of every state are sampled, (n, 2)."""
    knots = _knots(body)
    return edge_places() if knots is None else Levels(knots).places


def _knots(body: Contact) -> NDArray[np.float64] | None:
    """Knots over a of a finite pressure, (k,); None under a punch with infinite stresses."""
    if body.pressure:
        return body.pressure.knots
    return _SMOOTH if body.finite else None


class Strength:
    """Yield of states at one speed.

    Args:
        field: function that gives the stresses of the states by any method.
        body: punch or prescribed pressure, and solid, with a yield strength for all but stresses.
        response: response of the half-plane at this speed.
        g: σ_XY/σ_YY under the punch, (states,).
        local: exponents α at X = a and β at X = -a of a punch, (states,) each.
        half_width: half-width of each state's contact [m], (states,); None without free ends.
        turns: limits of stresses at places where they vary like a power of the distance.
        nearest: least distance over a from such places at which the field is accurate.
    """

    def __init__(
        self,
        field: Field,
        body: Contact,
        response: HalfPlane,
        g: NDArray,
        local: Any,
        half_width: NDArray | None = None,
        turns: Turns | None = None,
        nearest: float = 1.0,
    ) -> None:
        self._field, self._body, self._local = field, body, local
        self._turns, self._nearest = turns, nearest
        ends = body.pressure.values[[0, -1]] if body.pressure else np.zeros(2)
        #: True for states whose stress is infinite where the pressure ends in a jump, (states,).
        self.infinite = (response.strain(g, 0.0, 1.0) != 0.0) & bool(ends.any())
        unit = body.stress if half_width is None else body.load / (2.0 * half_width)
        #: Yield strength over N/(2a), (states,); infinite where it is not given.
        self.strength = np.broadcast_to((body.yield_strength or np.inf) / unit, np.shape(g))

    @cached_property
    def von_mises(self) -> Peak:
        """Largest von Mises stress over N/(2a) below a finite pressure, NaN where it is infinite."""
        return self._peak(self._von_mises, 0)

    @cached_property
    def shear(self) -> Peak:
        """Largest shear stress in the plane over N/(2a) below a finite pressure, NaN where infinite."""
        return self._peak(lambda points: maximum_shear(*self._field(points)), 1)

    @property
    def first_load(self) -> NDArray[np.float64]:
        """Load N per depth at which the solid begins to yield under a finite pressure [N/m], (states,).

        Stresses are proportional to the load; under a punch of the height c|X|^k to its power 1 - 1/k,
        because the contact grows, too.
        """
        k = exponent(self._body.profile) if self._body.found else None
        power = k / (k - 1.0) if k else 1.0
        allowed = (self.strength / self.von_mises.value) ** power
        return np.where(self.infinite, 0.0, self._body.load * allowed)

    @cached_property
    def _zones(self) -> Zones:
        exponents = np.column_stack([self._local.β, self._local.α])
        return zones(self._over_strength, self._invariants[0] / self.strength[:, None], exponents)

    @property
    def reach(self) -> NDArray[np.float64]:
        """Reach over a of the yielded zones from X = -a and from X = a, (states, 2)."""
        return self._zones.reach

    @property
    def depth(self) -> NDArray[np.float64]:
        """Largest depth over a at which the solid yields under the load, (states,)."""
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
        """Von Mises and largest shear stress over N/(2a) at :func:`places`, (states, n) each."""
        return self._both(self._field(places(self._body)[None]))

    def _both(self, σ: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Von Mises and largest shear stress, (states, n) each, from stresses (3, states, n)."""
        invariants = self._von_mises_of(σ), maximum_shear(*σ)
        # At a jump of the pressure they are NaN; 0 keeps the search away.
        of_mises, of_shear = (np.where(np.isnan(stress), 0.0, stress) for stress in invariants)
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
        """Places around turns of the stresses, steps between them, both stresses; None without turns."""
        if self._turns is None:
            return None
        centres = np.where(np.isnan(self._turns.X), self._turns.X[:, :1], self._turns.X)
        if np.array_equal(centres, np.broadcast_to(centres[:1], centres.shape)):
            centres = centres[:1]
        around, steps = circles(centres, self._nearest)
        return around, steps, self._both(self._field(around))

    def _off_turns(self, stress: Callable[[NDArray], NDArray]) -> Callable[[NDArray], NDArray]:
        """Function of points that is NaN nearer to turns than the field is accurate, else the stress."""
        if self._turns is None:
            return stress
        X = self._turns.X

        def off(points: NDArray) -> NDArray[np.float64]:
            distance = np.hypot(points[..., None, 0] - X[:, None], points[..., None, 1])
            near = np.nan_to_num(distance, nan=np.inf).min(axis=-1) < self._nearest * _HARDLY
            return np.where(near, np.nan, stress(points))

        return off

    def _peak(self, stress: Callable[[NDArray], NDArray], which: int) -> Peak:
        """Peak of the von Mises stress (0) or of the largest shear stress (1)."""
        at, steps, there = self._levels.places[None], self._levels.steps, self._invariants[which]
        if self._near_turns and self._turns:
            around, more, near = self._near_turns
            at = np.concatenate([np.broadcast_to(at, (len(around), *at.shape[1:])), around], axis=1)
            steps, there = np.append(steps, more), np.concatenate([there, near[which]], axis=1)
        highest = peak(self._off_turns(stress), at, steps, there)
        if self._turns:
            limit = self._both(self._turns.σ)[which]
            best, rows = limit.argmax(axis=1), np.arange(len(limit))
            higher = limit[rows, best] > highest.value
            highest = Peak(
                np.where(higher, limit[rows, best], highest.value),
                np.where(higher, self._turns.X[rows, best], highest.X),
                np.where(higher, 0.0, highest.Y),
            )
        return Peak(*(np.where(self.infinite, np.nan, x) for x in (highest.value, highest.X, highest.Y)))
