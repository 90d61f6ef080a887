"""Points next to the knots of a pressure, whose stresses are continued along rays from farther out.

Beside a knot two pieces of the pressure have infinite stresses that cancel, and no difference of large
numbers is exact. But how stresses go there is known: at the distance x along a ray from a knot like
1, x and x log x, and log x besides where the pressure ends in a jump. A few values at a small distance
tell how much there is of each.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

#: Distance from a knot within which stresses are continued, over the half-width of the narrower piece.
NEAR = 2e-6

#: Distances along a ray that tell the rest, over that distance.
_STEPS = np.array([1.0, 4.0, 16.0, 64.0])

#: Distance over a below which log x grows no more.
_LEAST = 1e-300


@dataclass(frozen=True)
class Rays:
    """Where to look instead of some points, and how what is found there is continued to them.

    Attributes:
        origins: a position X over a on the surface, that of the knot on a ray, (n,).
        offsets: how far from it, over a, (n, 2): next to a knot the sum has not their digits.
        owner: number of the point that each belongs to, (n,).
        weights: of what is found there, (n,).
        points: number of points.
    """

    origins: NDArray[np.float64]
    offsets: NDArray[np.float64]
    owner: NDArray[np.int64]
    weights: NDArray[np.float64]
    points: int

    def continued(self, values: NDArray) -> NDArray[np.float64]:
        """Values at the points from those found, (n, ...)."""
        result = np.zeros((self.points, *values.shape[1:]))
        weights = self.weights.reshape(-1, *[1] * (values.ndim - 1))
        np.add.at(result, self.owner, weights * values)
        return result


def rays(points: NDArray, knots: NDArray, near: NDArray, jumps: NDArray) -> Rays:
    """Rays to points that are next to a knot; every other point stands for itself.

    Args:
        points: positions X, Y over a, (n, 2), Y <= 0.
        knots: positions X over a in their order, (k,).
        near: distance within which a point is next to a knot, over a, (k,).
        jumps: where the pressure does, (k,).
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
    """1, x, x log x, and log x where there is a jump, at distances x > 0: (..., terms)."""
    x = np.asarray(x)
    terms = [np.ones_like(x), x, x * np.log(x), np.log(x)]
    return np.stack(terms[: 3 + jump], axis=-1)
