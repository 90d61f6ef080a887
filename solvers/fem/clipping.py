"""Polygons cut along the sides of a box; what lies outside is left out."""

import numpy as np
from numpy.typing import NDArray


def clipped(corners: NDArray, extent: float) -> NDArray[np.float64]:
    """The part of a convex polygon with |X| <= extent and Y >= -extent.

    Args:
        corners: in turn, over a, (k, 2).
        extent: over a.

    Returns:
        Its corners in turn, (n, 2); none where nothing is left.
    """
    polygon = corners
    for axis, bound, sign in ((0, extent, 1.0), (0, -extent, -1.0), (1, -extent, -1.0)):
        beyond, left = sign * (polygon[:, axis] - bound), []
        for i, here in enumerate(polygon):
            one, other = beyond[i - 1], beyond[i]
            if one * other < 0.0:
                crossing = polygon[i - 1] + one / (one - other) * (here - polygon[i - 1])
                crossing[axis] = bound
                left.append(crossing)
            if other <= 0.0:
                left.append(here)
        polygon = np.reshape(left, (-1, 2))
    return polygon


def in_quads(count: int) -> NDArray[np.int64]:
    """A convex polygon of so many corners, 3 at least, in quadrilaterals; a triangle doubles its last."""
    last = count - 1
    return np.array([(0, i, min(i + 1, last), min(i + 2, last)) for i in range(1, last, 2)])
