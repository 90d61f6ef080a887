"""Cells graded towards places inside the contact, too, where the slope of a punch has a kink.

Between neighbouring places, both ends of the contact among them, the strip along the contact is cut in
the middle; each half is a corner of :mod:`galinx.meshes.rings`, stretched. Columns go on outwards.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.rings import QuadMesh, Refinement, corner, joined

#: Width of the strip over the mean height of its halves, and what a column grows by outwards.
_WIDE, _GROWTH = 1.3, 1.6
#: Elliptic coordinate, some 4 000 a, beyond which a field is that of a line load to all digits that are
#: told, linear in this coordinate, and columns need no largest width.
_FAR = 9.0


def with_kinks(refinement: Refinement, places: NDArray, more: int = 0) -> QuadMesh:
    """The rectangle in the (ξ, η) plane of a confocal mesh.

    Args:
        refinement: of the mesh without kinks.
        places: X over a of the kinks, in (-1, 1).
        more: rings around these than around the ends.
    """
    η = np.concatenate([[-np.pi], np.sort(-np.arccos(places)), [0.0]])
    width = min(_WIDE * np.pi / (2.0 * (len(η) - 1)), np.pi / 2.0)
    of_end, of_kink = (
        corner(1.0, replace(refinement, levels=refinement.levels + levels), False)[0]
        for levels in (0, more)
    )
    quads, rows = [], [-np.pi]
    for low, high in pairwise(η):
        half = (high - low) / 2.0
        below = (of_end if high == η[-1] else of_kink) * [width, half] + [0.0, high]
        above = ((of_end if low == η[0] else of_kink) * [width, -half] + [0.0, low])[:, ::-1]
        quads += [above, below]
        for start in (low, low + half):
            rows += (start + half * refinement.legs[1:]).tolist()
    ξ = _columns(width, np.pi / 2.0 + sum(refinement.columns), max(refinement.columns))
    quads.append(
        np.reshape(
            [
                [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
                for x0, x1 in pairwise(ξ)
                for y0, y1 in pairwise(rows)
            ],
            (-1, 4, 2),
        )
    )
    return joined(np.concatenate(quads).reshape(-1, 2), ξ[-1])


def _columns(first: float, last: float, widest: float) -> list[float]:
    """Where columns end in ξ, from the strip's width to the far boundary; near by at most ``widest``."""
    found, step = [first], first
    while last - found[-1] > 1.5 * step:
        found.append(found[-1] + step)
        step = min(_GROWTH * step, widest if found[-1] < _FAR else np.inf)
    return [*found, last]
