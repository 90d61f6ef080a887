"""Meshes whose lines follow the interfaces of layers: straight cells in the physical half-plane.

Columns grow outwards from both edges of the punch, rows with depth, and an interface is always between
two rows. Only inside a square around each edge, of at most half the uppermost layer's thickness, L-shaped
rings go on towards it: their lines do not run through the whole mesh.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import asinh, ceil, log

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.charts import Physical
from galinx.meshes.kind import DEGREES, MeshKind, Wanted
from galinx.meshes.rings import CONTACT, FAR, FREE, QuadMesh, joined

#: Distance of a line over that of the one before, from an edge and from the surface.
_GROWTH = 4.0
#: The same where stresses are wanted, whose derivatives ask for more.
_GENTLE_GROWTH = 2.5
#: Size of a ring over that of the one outside it, and where stresses are wanted beside it.
_RATIO, _NEAR_RATIO = 0.45, 0.5
#: Moments of the pressure over the logarithm of the tolerance: of any, and of how thin the layer is.
_MOMENTS = 0.27, 0.54
#: Fewest, two degrees below the first.
_FEWEST = 12
#: Largest square around an edge, over a, and its size over the uppermost layer's thickness.
_SQUARE, _SHARE = 0.5, 0.5
#: Relative error of K_I by that boundary over such a length over its squared distance, measured.
_MOVED = 6.0
#: Distance of the far boundary over the root of a length of the layers over the tolerance, at least
#: (stiff layers and speeds near the limit need it), and at most: longer cells lose digits.
_FAR, _NEAREST_FAR, _FARTHEST = 20.0, 300.0, 2e5


@dataclass(frozen=True)
class OnLayers(MeshKind):
    """A mesh for layers.

    Attributes:
        depths: of the interfaces over a.
        drawn_together: smallest Im p of the uppermost solid: its fields see depths so much smaller.
    """

    depths: tuple[float, ...] = ()
    drawn_together: float = 1.0

    def radius(self, wanted: Wanted) -> float:
        """Half the width of the mesh, and its depth, over a."""
        length = max(1.0, self.depths[-1])
        far = min(_FAR * (length / wanted.tolerance) ** 0.5, _FARTHEST)
        return max(far, _NEAREST_FAR, 30.0 * length, 10.0 * wanted.farthest)

    def reach(self, wanted: Wanted) -> float:
        return self.radius(wanted)

    def truncation(self, wanted: Wanted, margin: float = 1.0) -> float:
        """Relative error of K_I by the far boundary, which moves as under a line load: second order."""
        length = max(1.0, self.depths[-1])
        return _MOVED * length / self.radius(wanted) ** 2 / margin ** (1.0 / 3.0)

    @property
    def length(self) -> float:
        """Over which the pressure changes next to the edges: their mirror image in the interface."""
        return 2.0 * self.depths[0] * self.drawn_together

    def moments(self, wanted: Wanted) -> int:
        """Of the pressure, that tell it to a tenth of the tolerance; measured on thirty stacks."""
        share, of_length = _MOMENTS
        count = (share + of_length * asinh(2.0 / self.length)) * log(30.0 / wanted.tolerance)
        return max(ceil(count), _FEWEST)

    def innermost_size(self, wanted: Wanted) -> float:
        """Of the cells at the edges, over a."""
        return max(self._innermost(wanted) ** 2, 1e-11)

    def unseen(self, wanted: Wanted, degree: int, cuts: int, margin: float) -> float:
        return 0.3 * self.innermost_size(wanted) / margin**0.4

    def degree(self, wanted: Wanted, margin: float) -> int:
        """One less than usual for K_I alone: the measured error asks for more where it is needed."""
        return max(super().degree(wanted, margin) - (wanted.nearest is None), DEGREES[0] + 1)

    def drawn(self, wanted: Wanted) -> QuadMesh:
        """The mesh."""
        b, R = min(_SHARE * self.depths[0], _SQUARE), self.radius(wanted)
        near = wanted.nearest is not None and wanted.nearest < b
        legs, ratio = (2, _NEAR_RATIO) if near else (1, _RATIO)
        growth = _GROWTH if wanted.nearest is None else _GENTLE_GROWTH
        in_square = b * np.arange(1, legs) / legs
        outer = np.concatenate([in_square, _outwards(b, R, growth)])
        inner = np.concatenate([in_square, _outwards(b, 1.0, growth)])
        right = np.concatenate([1.0 - inner, [1.0], 1.0 + outer])
        X = np.unique(np.concatenate([-right, right]))
        fixed = [b, *(d for d in self.depths if d > b * (1.0 + 1e-9)), R]
        below = np.concatenate([_between(low, high, growth) for low, high in pairwise(fixed)])
        rows = -np.concatenate([[0.0], in_square, below, [R]])
        cells = [
            [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
            for x0, x1 in pairwise(X.tolist())
            for y1, y0 in pairwise(rows.tolist())
            if y0 < -b or abs(abs((x0 + x1) / 2.0) - 1.0) > b
        ]
        squares = [
            _rings(edge, side * b, legs, ratio, self.innermost_size(wanted))
            for edge in (-1.0, 1.0)
            for side in (-1.0, 1.0)
        ]
        return _tagged(np.concatenate([np.array(cells), *squares]), R)


def _outwards(first: float, last: float, growth: float) -> NDArray[np.float64]:
    """Distances from an edge, from the first to the last, which grow by a factor."""
    return np.append(_between(first, last, growth), last)


def _between(low: float, high: float, growth: float) -> NDArray[np.float64]:
    """From low to below high."""
    count = max(ceil(log(high / low) / log(growth) - 1e-9), 1) if high > low else 0
    return low * (high / low) ** (np.arange(count) / max(count, 1))


def _rings(edge: float, towards: float, legs: int, ratio: float, innermost: float) -> NDArray[np.float64]:
    """L-shaped rings in a square beside an edge, and what fills the square that is left, (cells, 4, 2).

    Args:
        edge: X of the edge.
        towards: ±b, on which side, with b the size of the square.
        legs: cells along each leg of an L.
        ratio: of the sizes of rings.
        innermost: size of the last square.
    """
    b = abs(towards)
    count = max(ceil(log(b / innermost) / -log(ratio)), 1)
    sizes = b * ratio ** np.arange(count + 1)
    t = np.arange(legs + 1) / legs
    # Along the L from the surface down, and back to below the edge.
    leg = np.concatenate([np.column_stack([np.ones(legs + 1), -t]),
                          np.column_stack([1.0 - t, -np.ones(legs + 1)])[1:]])  # fmt: skip
    cells = [
        [near * leg[i], far * leg[i], far * leg[i + 1], near * leg[i + 1]]
        for far, near in pairwise(sizes.tolist())
        for i in range(2 * legs)
    ]
    last = float(sizes[-1])
    for x0, x1 in pairwise(last * t):
        cells += [[(x0, -y0), (x1, -y0), (x1, -y1), (x0, -y1)] for y0, y1 in pairwise(last * t)]
    # Clockwise as they are.
    found = np.array(cells) * [np.sign(towards), 1.0] + [edge, 0.0]
    return found[:, ::-1] if towards > 0.0 else found


def _tagged(quads: NDArray[np.float64], R: float) -> QuadMesh:
    mesh = joined(quads.reshape(-1, 2), 1.0 + R)
    sides = np.stack([mesh.cells, np.roll(mesh.cells, -1, axis=1)], axis=-1).reshape(-1, 2)
    _, index, count = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
    boundary = sides[index[count == 1]]
    X, Y = mesh.points[boundary].mean(axis=1).T
    top = Y == 0.0
    edges = {CONTACT: boundary[top & (np.abs(X) < 1.0)], FREE: boundary[top & (np.abs(X) > 1.0)],
             FAR: boundary[~top]}  # fmt: skip
    return QuadMesh(mesh.points, mesh.cells, edges)


def on_layers(depths: Sequence[float], drawn_together: float = 1.0) -> OnLayers:
    """The kind of mesh for layers with interfaces at these depths over a, see :class:`OnLayers`."""
    return OnLayers(
        "straight-sided, along the interfaces", Physical(), ratio=0.5, column=1.0, fan=True,
        innermost=1.0 / 150.0, beside=6.0, gentle=1.0, smallest=1e-5, depths=tuple(depths),
        drawn_together=drawn_together,
    )  # fmt: skip
