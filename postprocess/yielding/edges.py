"""The yielded zones at the two sharp edges of a punch, where stresses are infinite: reach and depth.

Seen from an edge, every ray leaves the zone for good at one place. The farthest and the deepest of these
are those of the zone, whatever its shape.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

#: Distances over a between which rays are looked along. Nearer, stresses are continued; farther, a punch
#: no longer carries such a load.
NEAREST, FARTHEST = 1e-4, 10.0

#: Angles from the free surface to the punch, and places along a ray.
_ANGLES, _PLACES = np.linspace(0.0, np.pi, 33), 43

#: Rounds in which the best angle is found, and by how much the step between angles falls in each.
_ROUNDS, _FINER = 3, 8.0

#: Steps to the place on a ray where yield is reached, and how far its logarithm may be off.
_STEPS, _OFF = 5, 1e-8

#: Both edges, each for reach and for depth: the side of the punch, and which of the two.
_SIDE, _DEEP = np.array([-1.0, 1.0, -1.0, 1.0]), np.array([False, False, True, True])

#: Stress over the yield strength at points (states or 1, n, 2) over a, of every state: (states, n).
Stress = Callable[[NDArray], NDArray]


def places() -> NDArray[np.float64]:
    """Where every state is looked at, ray by ray, over a: from X = -a, then from X = a, (n, 2)."""
    rays = (_points(side, _ANGLES[:, None], np.exp(_grid())).reshape(-1, 2) for side in (-1.0, 1.0))
    return np.concatenate([*rays])


@dataclass(frozen=True)
class Zones:
    """Where yield is passed, over a.

    Attributes:
        reach: largest distance from X = -a and from X = a, each on its side of the middle, (states, 2).
        depth: (states,). NaN, in both, where a zone goes on beyond ``FARTHEST``.
    """

    reach: NDArray[np.float64]
    depth: NDArray[np.float64]


def zones(stress: Stress, there: NDArray, exponents: NDArray) -> Zones:
    """Zones in which yield is passed.

    Args:
        stress: von Mises.
        there: the same at :func:`places`, (states, n).
        exponents: of the distance, of stresses next to X = -a and to X = a, (states, 2).
    """
    rays = _Rays(stress, -np.tile(exponents, 2))
    at_edges = _log(there).reshape(len(there), 2, *_grid().shape)
    t, slope, beyond = (np.tile(found, (1, 2, 1)) for found in rays.on_grid(at_edges))
    endless = np.asarray(beyond.any(axis=(1, 2)))
    size = np.where(endless[:, None], np.nan, _largest(rays, t, slope))
    return Zones(size[:, ~_DEEP], size[:, _DEEP].max(axis=1))


def _points(side: float | NDArray, φ: NDArray, r: NDArray) -> NDArray[np.float64]:
    """Points at a distance from an edge over a and an angle from the free surface, (..., 2)."""
    along = (φ <= 0.0) | (φ >= np.pi)  # the surface, to the last digit
    return np.stack([side * (1.0 + r * np.cos(φ)), np.where(along, 0.0, -r * np.sin(φ))], axis=-1)


def _end(φ: NDArray) -> NDArray[np.float64]:
    """Logarithm of the distance at which a ray meets the middle of the punch, or that of the farthest."""
    return -np.log(np.maximum(-np.cos(φ), 1.0 / FARTHEST))


def _grid() -> NDArray[np.float64]:
    """Logarithms of the distances at which every ray is looked at, (angles, places)."""
    return np.linspace(np.log(NEAREST), _end(_ANGLES), _PLACES, axis=-1)


def _log(stress: NDArray) -> NDArray[np.float64]:
    return np.log(np.maximum(stress, np.finfo(float).tiny))  # without friction the free surface has none


def _height(φ: NDArray) -> NDArray[np.float64]:
    """What a distance is multiplied by, (states, 4, n): 1 for reach."""
    return np.where(_DEEP[:, None], np.sin(φ), 1.0)


@dataclass(frozen=True)
class _Rays:
    """Rays from the edges; t is the logarithm of a distance.

    Attributes:
        stress: von Mises over the yield strength.
        power: with which stresses fall next to the edges, (states, 4).
    """

    stress: Stress
    power: NDArray[np.float64]

    def on_grid(self, L: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """Where rays leave the zone, about, and how fast stresses fall there.

        Args:
            L: logarithm of the stress along the rays of the grid, (states, 2, angles, places).

        Returns:
            t, dL/dt, and whether the zone goes on beyond ``FARTHEST``, (states, 2, angles) each.
        """
        t, j, end = _grid(), np.arange(len(_ANGLES)), L.shape[-1] - 1
        passed = L >= 0.0
        last = np.where(passed.any(axis=-1), end - passed[..., ::-1].argmax(axis=-1), -1)
        k = np.clip(last, 0, end - 1)
        here, next_ = (np.take_along_axis(L, i[..., None], -1)[..., 0] for i in (k, k + 1))
        slope = np.minimum((next_ - here) / (t[j, k + 1] - t[j, k]), -1e-3)
        slope = np.where(last < 0, -self.power[:, :2, None], slope)
        out = np.where(last == end, t[:, -1], t[j, k] - here / slope)
        return out, slope, (last == end) & (t[:, -1] >= np.log(FARTHEST))

    def outermost(self, φ: NDArray, t: NDArray, slope: NDArray) -> NDArray[np.float64]:
        """Where rays leave the zone: t at angles (states, 4, n), -inf where it is not found.

        Args:
            φ: angles.
            t, slope: guesses of the place, and of dL/dt there, (states, 4).
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
        """Of the stress; beyond a ray's end it falls on.

        Nearer than ``NEAREST`` it is a power of the distance r, times 1 + B r.
        """
        first, end = np.log(NEAREST), _end(φ)
        r = np.exp(np.clip(t, first, end))
        both = np.concatenate([r, np.full_like(r, 2.0 * NEAREST)], axis=-1)
        points = _points(_SIDE[:, None], np.concatenate([φ, φ], axis=-1), both)
        found = _log(self.stress(points.reshape(len(φ), -1, 2))).reshape(both.shape)
        L, second = np.split(found, 2, axis=-1)
        p, nearer = self.power[..., None], np.maximum(first - t, 0.0)
        B = (second - L + p * np.log(2.0)) / NEAREST
        near = L + p * nearer - B * NEAREST * -np.expm1(-nearer)
        return np.where(nearer > 0.0, near, L - np.maximum(t - end, 0.0))


def _largest(rays: _Rays, t: NDArray, slope: NDArray) -> NDArray[np.float64]:
    """Largest distance at which a ray leaves the zone, or depth, (states, 4).

    Args:
        rays: the rays.
        t, slope: on the grid, (states, 4, angles).
    """
    unit = t.max(axis=-1)  # distances themselves may be too small for squares
    best = np.argmax(np.exp(t - unit[..., None]) * _height(_ANGLES), axis=-1)[..., None]
    guess, slope = (np.take_along_axis(x, best, -1)[..., 0] for x in (t, slope))
    φ, h = _ANGLES[best], _ANGLES[1]
    size, known = (np.exp(guess - unit)[..., None] * _height(φ))[..., 0], np.zeros(guess.shape, bool)
    for _ in range(_ROUNDS):
        three = np.clip(φ, h, np.pi - h) + h * np.array([-1.0, 0.0, 1.0])
        three = np.clip(three, 0.0, np.pi)
        at = rays.outermost(three, guess, slope)
        sizes = np.where(np.isfinite(at), np.exp(at - unit[..., None]) * _height(three), -np.inf)
        top = sizes.max(axis=-1)
        better = np.isfinite(top) & (~known | (top > size))  # than interpolated, or than before
        size, known = np.where(better, top, size), known | np.isfinite(top)
        where = sizes.argmax(axis=-1)[..., None]
        guess = np.where(better, np.take_along_axis(at, where, -1)[..., 0], guess)
        φ = three[..., 1:2] + h * vertex(sizes)[..., None]
        h /= _FINER
    return size * np.exp(unit)


def vertex(values: NDArray) -> NDArray[np.float64]:
    """Place in [-1, 1] of the largest value of the parabola through values at -1, 0, 1, (..., 3)."""
    left, middle, right = np.moveaxis(values, -1, 0)
    with np.errstate(invalid="ignore", divide="ignore"):
        bend = left - 2.0 * middle + right
        top = np.clip((left - right) / (2.0 * bend), -1.0, 1.0)
    return np.where(np.isfinite(top) & (bend < 0.0), top, values.argmax(axis=-1) - 1.0)
