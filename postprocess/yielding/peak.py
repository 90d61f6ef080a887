"""The largest stress below a pressure, and how deep a stress is reached.

Stresses vary over the distance to the pressure's knots, all of which lie on the surface. So the solid is
looked at in depths that double, at places along X half the depth apart: the finer the shallower,
and only where knots are as near to one another; and on the surface itself, between all knots. Where a
contact ends, or its punch has a kink, stresses rise like a power of the distance: there the solid is
looked at in circles whose radii grow, and the stress at the place itself is that of the limit.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.yielding.edges import vertex

#: Depth over a to which the solid is looked at.
_DEEPEST = 10.0

#: Places along X: their distance over the depth; how far from a knot, in these; and how much wider than
#: the depth a piece has to be for that depth to be left out: the surface stands for it.
_APART, _AROUND, _SHALLOW = 0.5, 4, 4.0

#: Places on the surface between two knots.
_BETWEEN = 4

#: Radii of circles around a place where stresses have a power of the distance, over that of the next
#: smaller one, and directions from there, along the surface and down.
_WIDER, _DIRECTIONS = 3.0, np.linspace(0.0, np.pi, 9)

#: Places from which the largest is looked for, and most rounds in which it is; by how much the step falls
#: where it is near, and below which share of the first a round that finds nothing better is the last.
_STARTS, _ROUNDS, _FINER, _SMALLEST = 8, 40, 2.0, 1e-3
#: Rounds after which the best starts alone go on, and how many these are.
_ALL_OF_THEM, _BEST = 3, 3
#: How far around a place none may be better, over its step; and the least stress of a start, over the
#: largest.
_OWN, _LEAST = 1.5, 0.7

#: Halvings in which a depth is found, and what the distance of places along X falls by in each: it has to
#: follow a largest stress that moves as the depth changes.
_HALVINGS, _NEARER = 30, 0.7

#: A stress at points (states or 1, n, 2) over a, of every state: (states, n).
Stress = Callable[[NDArray], NDArray]

_STENCIL = np.array([(u, w) for u in (-1.0, 0.0, 1.0) for w in (-1.0, 0.0, 1.0)])
#: From values on the stencil to 1, u, w, u², uw, w².
_FIT = np.linalg.pinv(
    np.stack(
        [np.ones(9), *_STENCIL.T, _STENCIL[:, 0] ** 2, _STENCIL.prod(axis=1), _STENCIL[:, 1] ** 2],
        axis=1,
    )
)


@dataclass(frozen=True)
class Peak:
    """The largest value, and where it is over a, (states,) each."""

    value: NDArray[np.float64]
    X: NDArray[np.float64]
    Y: NDArray[np.float64]


@dataclass(frozen=True)
class Levels:
    """Where the solid is looked at below a pressure.

    Attributes:
        knots: of the pressure over a, in their order.
    """

    knots: NDArray[np.float64]

    @cached_property
    def _by_level(self) -> list[tuple[NDArray, NDArray, NDArray]]:
        """X, Y, and a step from place to place, of every level."""
        width = np.diff(self.knots)
        narrow = np.minimum(np.append(width, np.inf), np.append(np.inf, width))
        found = [_on_surface(self.knots, width)]
        y = _DEEPEST
        while y > width.min() / _SHALLOW:
            apart = _APART * y
            near = self.knots[narrow < _SHALLOW * y][:, None] / apart
            X = apart * np.unique(np.round(near) + np.arange(-_AROUND, _AROUND + 1.0))
            found.insert(1, (X, np.full(len(X), -y), np.full(len(X), apart)))
            y /= 2.0
        return found

    @cached_property
    def places(self) -> NDArray[np.float64]:
        """All of them, level by level from the surface on, (n, 2)."""
        return np.concatenate([np.column_stack([X, Y]) for X, Y, _ in self._by_level])

    @cached_property
    def steps(self) -> NDArray[np.float64]:
        """From each to its neighbours, (n,)."""
        return np.concatenate([step for *_, step in self._by_level])

    def best(self, there: NDArray) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Number of the best place of each level, and the value there, (states, levels).

        Args:
            there: at :attr:`places`, (states, n).
        """
        first = np.cumsum([0, *(len(X) for X, *_ in self._by_level)])
        levels = [there[:, i:j].argmax(axis=1) + i for i, j in pairwise(first)]
        best = np.stack(levels, axis=1)
        return best, np.take_along_axis(there, best, 1)

    def depth(self, stress: Stress, there: NDArray, peak: Peak) -> NDArray[np.float64]:
        """Depth over a of the deepest place at which a stress is 1 or more, 0 where it is so nowhere.

        Args:
            stress, there, peak: as of :meth:`peak`.

        Returns:
            (states,); NaN where the zone goes on beyond all places.
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
        found = _deepest(stress, X, inner, outer)
        found = np.where(passed[:, -1], np.nan, found)
        return np.where(somewhere | (peak.value >= 1.0), found, 0.0)


def circles(centres: NDArray, nearest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places around others on the surface, and a step from each to its neighbours.

    Args:
        centres: X over a of those of every state, (states, k); NaN for none.
        nearest: radius over a of the smallest circle.

    Returns:
        Arrays (states, n, 2) and (n,).
    """
    radii = 1.0 / _WIDER ** np.arange(np.ceil(-np.log(nearest) / np.log(_WIDER)) + 1.0)
    r, φ = (grid.ravel() for grid in np.meshgrid(radii, _DIRECTIONS, indexing="ij"))
    along, down = r * np.cos(φ), np.where((φ > 0.0) & (φ < np.pi), -r * np.sin(φ), 0.0)
    X = centres[:, :, None] + along
    places = np.stack([X, np.broadcast_to(down, X.shape)], axis=-1)
    return places.reshape(len(centres), -1, 2), np.tile(_APART * r, centres.shape[1])


def peak(stress: Stress, places: NDArray, steps: NDArray, there: NDArray) -> Peak:
    """The largest of all.

    Args:
        stress: of which.
        places: where states were looked at, of all (1, n, 2) or of each (states, n, 2).
        steps: from each to its neighbours, (n,).
        there: the stress at these, (states, n).
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
    """Numbers of the best places without a better one around, (states, ``_STARTS``)."""
    found = np.empty((len(there), _STARTS), dtype=np.int64)
    for i, values in enumerate(there):
        if i < len(places):
            distance = np.abs(places[i][:, None] - places[i]).max(axis=-1)
            around = distance <= _OWN * steps[:, None]
        tops = np.flatnonzero(values >= np.where(around, values, -np.inf).max(axis=1))
        tops = tops[np.argsort(-values[tops], kind="stable")][:_STARTS]
        found[i] = np.resize(tops[values[tops] >= _LEAST * values[tops[0]]], _STARTS)
    return found


def _on_surface(knots: NDArray, width: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """The knots, places between them, and beside both ends."""
    share = np.arange(_BETWEEN) / _BETWEEN
    between = (knots[:-1, None] + width[:, None] * share).ravel()
    left, right = (np.geomspace(w / _BETWEEN, _DEEPEST, 40) for w in width[[0, -1]])
    X = np.concatenate([knots[0] - left[::-1], between, knots[-1:], knots[-1] + right])
    step = np.concatenate([left[::-1], np.repeat(width, _BETWEEN), width[-1:], right]) / (2 * _BETWEEN)
    return X, 0.0 * X, step


class _Climb:
    """The way from some places up to the largest value near each.

    A quadratic function is fitted to the values at nine places. Where these turn out to be no better
    than the best before, as at a kink, the next nine lie closer around that.

    Args:
        places: to begin with, (states, starts, 2).
        steps: from each to its neighbours, (states, starts).

    Attributes:
        top, value: the best place, and the value there.
        done: would more rounds find nothing better?
    """

    def __init__(self, places: NDArray, steps: NDArray) -> None:
        self.top, self.value = places.copy(), np.full(steps.shape, -np.inf)
        self._middle, self._h, self._least = places.copy(), steps.copy(), _SMALLEST * steps
        self.done = False

    def keep(self, count: int) -> None:
        """Go on from so many starts, those with the largest values."""
        some = np.argsort(-self.value, axis=1, kind="stable")[:, :count]
        self.value, self._h, self._least = (
            np.take_along_axis(x, some, 1) for x in (self.value, self._h, self._least)
        )
        self.top, self._middle = (
            np.take_along_axis(x, some[..., None], 1) for x in (self.top, self._middle)
        )

    def take(self, stress: Stress) -> None:
        """Look at nine places, and step."""
        h = self._h[..., None]
        middle = self._middle
        middle[..., 1] = np.minimum(middle[..., 1], -self._h)  # none lies above the surface
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
        known = np.isfinite(values).all(axis=-1, keepdims=True)
        step = np.where(known, _summit(values), _STENCIL[where])
        step[..., 1] = np.minimum(step[..., 1], -middle[..., 1] / self._h)
        self._middle = np.where(improved[..., None], middle + h * step, self.top)
        near = ~improved | (np.abs(step).max(axis=-1) < 1.0)
        self.done = bool((~improved & (self._h <= self._least)).all())
        self._h = np.maximum(np.where(near, self._h / _FINER, self._h), self._least)


def _summit(values: NDArray) -> NDArray[np.float64]:
    """Where the fitted quadratic function is largest, in steps; the best of the nine where nowhere."""
    with np.errstate(invalid="ignore", divide="ignore"):
        _, u, w, uu, uw, ww = np.moveaxis(values @ _FIT.T, -1, 0)
        determinant = 4.0 * uu * ww - uw**2
        summit = np.stack([uw * w - 2.0 * ww * u, uw * u - 2.0 * uu * w], axis=-1)
        summit /= determinant[..., None]
    round_ = (uu < 0.0) & (determinant > 0.0)
    best = _STENCIL[values.argmax(axis=-1)]
    return np.clip(np.where(round_[..., None], summit, best), -1.0, 1.0)


def _deepest(stress: Stress, X: NDArray, inner: NDArray, outer: NDArray) -> NDArray[np.float64]:
    """Between two depths, of which the inner passes 1 somewhere near X, the last that does: (states,)."""
    apart = (outer - inner) * _APART
    for _ in range(_HALVINGS):
        y = (inner + outer) / 2.0
        three = X[:, None] + apart[:, None] * np.array([-1.0, 0.0, 1.0])
        values = stress(np.stack([three, -y[:, None] + 0.0 * three], axis=-1))
        u = vertex(values)
        left, middle, right = values.T
        top = middle + (right - left) * u / 2.0 + (left - 2.0 * middle + right) * u**2 / 2.0
        passed = np.maximum(top, values.max(axis=1)) >= 1.0
        X = X + apart * u
        inner, outer = np.where(passed, y, inner), np.where(passed, outer, y)
        apart *= _NEARER
    return inner
