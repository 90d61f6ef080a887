"""How far away a boundary is that follows the forces at the contact, and how many of their moments.

See :mod:`galinx.solvers.fem.far`; distances are over a, in the plane where the boundary is nearest.
"""

from math import ceil, log

#: Distance at least, and over that of the farthest place where stresses are wanted.
_LEAST, _BEYOND = 17.0, 1.7

#: Relative error of K_I over the inverse distance to the power of one more than the moments, times the
#: margin of the response: of none, halved by each moment, and of many. The largest of 44 solids with
#: frictions to 1.2, with a factor of 1 to 2. And the share of the tolerance that is left to it at rest.
_OF_NONE, _OF_MANY, _SHARE = 1.05, 0.02, 1e-4


def radius(farthest: float) -> float:
    """Of the boundary, by the distance of the farthest place where stresses are wanted."""
    return max(_LEAST, _BEYOND * farthest)


def moments(R: float, tolerance: float) -> int:
    """How many a boundary at a distance R follows."""
    return max(ceil(log(_OF_MANY / (_SHARE * tolerance)) / log(R)) - 1, 1)


def left(R: float, moments: int, margin: float) -> float:
    """Estimated relative error of K_I by a boundary at a distance R that follows so many."""
    return max(_OF_NONE / 2.0**moments, _OF_MANY) / (R ** (moments + 1) * margin)
