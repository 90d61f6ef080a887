"""Meshes whose lines follow the interfaces of layers: straight cells in the physical half-plane.

Columns grow outwards from both edges of the punch, rows with depth, and an interface is always between two
rows. Only inside a square around each edge, of at most half the uppermost layer's thickness, L-shaped rings
go on towards it: their lines do not run through the whole mesh.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, log

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.charts import Physical
from galinx.meshes.kind import MeshKind, Wanted
from galinx.meshes.rings import CONTACT, FAR, FREE, QuadMesh, joined

#: Distance of a line over that of the one before, from an edge and from the surface.
_GROWTH = 2.5
#: Size of a ring over that of the one outside it.
_RATIO = 0.25
#: Largest square around an edge, over a, and its size over the uppermost layer's thickness.
_SQUARE, _SHARE = 0.5, 0.5
#: Distance of the far boundary over the root of a length of the layers over the tolerance; at least.
_FAR, _NEAREST_FAR = 4.0, 300.0


@dataclass(frozen=True)
class OnLayers(MeshKind):
    """A mesh for layers.

    Attributes:
        depths: of the interfaces over a.
    """

    depths: tuple[float, ...] = ()

    def radius(self, wanted: Wanted) -> float:
        """Half the width of the mesh, and its depth, over a."""
        length = max(1.0, self.depths[-1])
        far = _FAR * (length / wanted.tolerance) ** 0.5
        return max(far, _NEAREST_FAR, 30.0 * length, 10.0 * wanted.farthest)

    def reach(self, wanted: Wanted) -> float:
        return self.radius(wanted)

    def truncation(self, wanted: Wanted, margin: float = 1.0) -> float:
        """Relative error of K_I by the far boundary, which moves as under a line load: of second order."""
        length = max(1.0, self.depths[-1])
        return length / self.radius(wanted) ** 2 / margin

    def innermost_size(self, wanted: Wanted) -> float:
        """Of the cells at the edges, over a."""
        return max(self._innermost(wanted) ** 2, 1e-11)

    def unseen(self, wanted: Wanted, degree: int, cuts: int, margin: float) -> float:
        return 0.3 * self.innermost_size(wanted) / margin**0.4

    def drawn(self, wanted: Wanted) -> QuadMesh:
        """The mesh."""
        b = min(_SHARE * self.depths[0], _SQUARE)
        R = self.radius(wanted)
        inner = 1.0 - np.append(_outwards(b, 1.0), [])[::-1]
        outer = 1.0 + _outwards(b, R)
        right = np.concatenate([inner, [1.0], outer])
        X = np.unique(np.concatenate([-right, right]))
        fixed = [b, *(d for d in self.depths if d > b * (1.0 + 1e-9)), R]
        Y = [0.0]
        for low, high in pairwise(fixed):
            Y += list(_between(low, high))
        rows = -np.array([*Y, R])
        quads: list[NDArray] = []
        for x0, x1 in pairwise(X.tolist()):
            for y1, y0 in pairwise(rows.tolist()):
                edge = next((e for e in (-1.0, 1.0) if e in (x0, x1)), 0.0)
                if y1 == 0.0 and edge:
                    far = x1 if x0 == edge else x0
                    quads.append(_rings(edge, far - edge, b, self.innermost_size(wanted)))
                else:
                    quads.append(np.array([[(x0, y0), (x1, y0), (x1, y1), (x0, y1)]]))
        return _tagged(np.concatenate(quads), R)


def _outwards(first: float, last: float) -> NDArray[np.float64]:
    """Distances from an edge, from the first to the last, none more than so much farther than the next."""
    return np.append(_between(first, last), last)


def _between(low: float, high: float) -> NDArray[np.float64]:
    """From low to below high."""
    count = max(ceil(log(high / low) / log(_GROWTH) - 1e-9), 1) if high > low else 0
    return low * (high / low) ** (np.arange(count) / max(count, 1))


def _rings(edge: float, towards: float, b: float, innermost: float) -> NDArray[np.float64]:
    """L-shaped rings in a square beside an edge, and the square that is left, (cells, 4, 2).

    Args:
        edge: X of the edge.
        towards: ±b: on which side.
        b: size of the square.
        innermost: size of the last one.
    """
    count = max(ceil(log(b / innermost) / -log(_RATIO)), 1)
    sizes = b * _RATIO ** np.arange(count + 1)
    sign = np.sign(towards)
    cells = []
    for far, near in pairwise(sizes.tolist()):
        cells.append([(near, 0.0), (far, 0.0), (far, -far), (near, -near)])
        cells.append([(near, -near), (far, -far), (0.0, -far), (0.0, -near)])
    last = float(sizes[-1])
    cells.append([(0.0, 0.0), (last, 0.0), (last, -last), (0.0, -last)])
    found = np.array(cells) * [sign, 1.0] + [edge, 0.0]
    return found[:, ::-1] if sign > 0.0 else found


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


def on_layers(depths: Sequence[float]) -> OnLayers:
    """The kind of mesh for layers with interfaces at these depths over a."""
    return OnLayers(
        "straight-sided, along the interfaces", Physical(), ratio=0.5, column=1.0, fan=True,
        innermost=1.0 / 150.0, beside=6.0, gentle=1.0, smallest=1e-5, depths=tuple(depths),
    )  # fmt: skip
