"""Points next to the knots of a pressure, whose stresses are continued along rays from farther out.

Beside a knot two pieces of the pressure have infinite stresses that cancel, and no difference of large
numbers is exact. But the form of the stresses is known: at the distance x along a ray from a knot they
are a sum of 1, x and x log x, and of log x besides where the pressure ends in a jump. A few values at a
small distance determine the coefficients.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

#: Distance from a knot within which stresses are continued, over the half-width of the narrower piece.
NEAR = 2e-6

#: Distances along a ray at which stresses are computed, over :data:`NEAR` times the half-width.
_STEPS = np.array([1.0, 4.0, 16.0, 64.0])

#: Distance over a below which log x grows no more.
_LEAST = 1e-300


@dataclass(frozen=True)
class Rays:
    """Places at which stresses are computed, and their weights in the stresses at some points.

    A point next to a knot has a few places farther out along its ray; every other point is its own place.

    Attributes:
        origins: positions X over a on the surface, on a ray that of its knot, (n,).
        offsets: distances of the places from their origin, over a, (n, 2): next to a knot the sum of
            both has not their digits.
        owner: number of the point that a place belongs to, (n,).
        weights: of the stresses at a place, (n,).
        points: number of points.
    """

    origins: NDArray[np.float64]
    offsets: NDArray[np.float64]
    owner: NDArray[np.int64]
    weights: NDArray[np.float64]
    points: int

    def continued(self, values: NDArray) -> NDArray[np.float64]:
        """Values at the points, (points, ...), from values at the places, (n, ...)."""
        result = np.zeros((self.points, *values.shape[1:]))
        weights = self.weights.reshape(-1, *[1] * (values.ndim - 1))
        np.add.at(result, self.owner, weights * values)
        return result


def rays(points: NDArray, knots: NDArray, near: NDArray, jumps: NDArray) -> Rays:
    """Rays to the points that are next to a knot.

    Args:
        points: positions X, Y over a, (n, 2), Y <= 0.
        knots: positions X over a in their order, (k,).
        near: distance within which a point is next to a knot, over a, (k,).
        jumps: True at knots where the pressure jumps, (k,).
    """
    between = np.searchsorted((knots[1:] + knots[:-1]) / 2.0, points[:, 0])
    away = points - np.column_stack([knots[between], np.zeros(len(points))])
    distance = np.hypot(*away.T)
    next_to = distance < near[between]
    own = np.flatnonzero(~next_to)
    parts = [(points[own, 0], points[own] * [0.0, 1.0], own, np.ones(len(own)))]
    for i in np.flatnonzero(next_to):
        knot, scale = knots[between[i]], near[between[i]]
        along = away[i] / distance[i] if distance[i] else np.array([1.0, 0.0])
        jump = bool(jumps[between[i]])
        x = _STEPS[: 3 + jump]
        weights = _terms(max(distance[i], _LEAST) / scale, jump) @ np.linalg.inv(_terms(x, jump))
        parts.append((np.full(len(x), knot), np.outer(scale * x, along), np.full(len(x), i), weights))
    origins, offsets, owner, weights = (np.concatenate(part) for part in zip(*parts))
    return Rays(origins, offsets, owner, weights, len(points))


def _terms(x: float | NDArray, jump: bool) -> NDArray[np.float64]:
    """Terms 1, x, x log x, and log x if the pressure jumps, at distances x > 0: (..., terms)."""
    x = np.asarray(x)
    terms = [np.ones_like(x), x, x * np.log(x), np.log(x)]
    return np.stack(terms[: 3 + jump], axis=-1)
