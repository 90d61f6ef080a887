"""Panels of distances that hold waves: of many steps within a short time, they are short."""

from itertools import pairwise
from math import ceil

import numpy as np
from numpy.typing import NDArray

#: Radians of the shortest wave in a panel, and decay after which nothing is left of it.
_TURN, _GONE = 10.0, 20.0


def divided(edges: NDArray, s: NDArray, slowest: float) -> NDArray[np.float64]:
    """Edges of panels, those cut that are longer than waves let them be.

    A wave e^(-sζx) turns by Im s ζ where Re s ζ x leaves something of it.

    Args:
        edges: distances over a, rising from 0.
        s: over c_s/a, Re s >= 0, (n,).
        slowest: slowness ζ of the slowest wave, seen from the load.
    """
    found = [edges[:1]]
    for near, far in pairwise(edges.tolist()):
        felt = _GONE / np.maximum(s.real * max(near, float(edges[1])), 1e-300)
        turn = float((np.abs(s.imag) * np.minimum(slowest, felt)).max())
        count = max(ceil((far - near) * turn / _TURN), 1)
        found.append(np.linspace(near, far, count + 1)[1:])
    return np.concatenate(found)
