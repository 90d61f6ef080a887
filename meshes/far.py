"""How far away a boundary is that follows the forces at the contact, and how many of their moments.

See :mod:`galinx.solvers.fem.far`; distances are over a, in the plane where the boundary is nearest.
"""

from math import ceil, log

#: Distance at least, and over that of the farthest place where stresses are wanted.
_LEAST, _BEYOND = 17.0, 1.7

#: How many moments there are: what their error is of, and the share of the tolerance that is left to it.
_LEFT_OUT, _SHARE = 0.02, 1e-4


def radius(farthest: float) -> float:
    """Of the boundary, by the distance of the farthest place where stresses are wanted."""
    return max(_LEAST, _BEYOND * farthest)


def moments(R: float, tolerance: float) -> int:
    """How many a boundary at a distance R follows."""
    return max(ceil(log(_LEFT_OUT / (_SHARE * tolerance)) / log(R)) - 1, 1)


def left(R: float, moments: int, margin: float) -> float:
    """Estimated relative error of K_I by a boundary at a distance R that follows so many.

    Over |σ_XY/σ_YY| and a tenth: every other moment needs no friction. Measured on 60 solids, frictions
    to 5, speeds to 0.99 of the limit and 1 to 6 moments; it is 1 to 5 times the largest of these.
    """
    return 2.0 ** (2 - moments) / (R ** (moments + 1) * margin)
