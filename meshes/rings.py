"""Patterns of quadrilaterals that are graded towards places of the contact, and the meshes made of them.

In elliptic coordinates X + iY = a cosh(ξ + iη) the half-plane Y < 0 is the rectangle 0 <= ξ <= Ξ,
-π <= η <= 0. Its side ξ = 0 is the contact, η = 0 and η = -π are the free surface right and left of
the punch, ξ = Ξ is far away. :func:`rectangle` has L-shaped rings around the punch edges (0, 0) and
(0, -π), and columns outwards; each of its cells may be cut into n x n.

:func:`with_kinks` is that rectangle for a punch whose slope has kinks, graded towards these, too. Between
neighbouring places, both ends of the contact among them, the strip along the contact is cut in the
middle; each half is a corner, stretched. Where two places are near each other the strip is as narrow as
they are near, and blocks without rings grow from there to the middle of the longer neighbour. Columns go
on outwards.

:func:`lines_and_corners` is the pattern in the physical plane: columns and rows of cells, with rings in
rectangles beside places of the surface.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, log, log2

import numpy as np
from numpy.typing import NDArray

CONTACT, FREE, FAR = 1, 2, 3
#: Coordinates that differ by less are equal; the smallest cells are far above.
_ROUNDING = 1e-12
#: Tags of the parts of the boundary by name.
TAGS = {"contact": CONTACT, "free surface": FREE, "far": FAR}


@dataclass(frozen=True)
class Refinement:
    """Refinement of the pattern.

    Attributes:
        levels: L-shaped rings around each punch edge.
        ratio: size of a ring over that of the ring outside it, in (0, 1).
        sectors: cells along each of the two legs of an L, so 2·sectors columns of cells in angle.
        columns: widths in ξ of the columns outside the rings.
        pieces: number of parts of equal width into which the outermost ring is cut.
        crowding: of the sectors towards both ends of a leg: 0 for equal ones, 1 as Chebyshev's points.
    """

    levels: int
    ratio: float
    sectors: int
    columns: tuple[float, ...] = ()
    pieces: int = 1
    crowding: float = 0.0

    @property
    def legs(self) -> NDArray[np.float64]:
        """Ends of sectors along a leg, from 0 to 1, (sectors + 1,)."""
        even = np.linspace(0.0, 1.0, self.sectors + 1)
        return even + self.crowding * ((1.0 - np.cos(np.pi * even)) / 2.0 - even)

    @property
    def sizes(self) -> NDArray[np.float64]:
        """Sizes of the rings over that of the outermost, from it inwards to the innermost square."""
        rings = self.ratio ** np.arange(self.levels + 1)
        outermost = np.linspace(1.0, rings[min(1, self.levels)], self.pieces + 1)
        return np.concatenate([outermost[: -1 if self.levels else 1], rings[1:]])


@dataclass(frozen=True)
class QuadMesh:
    """Quadrilaterals with tagged boundary edges.

    Attributes:
        points: vertex coordinates, (n, 2).
        cells: vertices of each cell counterclockwise, (m, 4).
        edges: vertices of the boundary edges by tag, each (k, 2).
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    edges: dict[int, NDArray[np.int64]]


def rectangle(refinement: Refinement, fan: bool = False, cuts: int = 1) -> QuadMesh:
    """The graded rectangle in the (ξ, η) plane.

    Args:
        refinement: of the pattern.
        fan: filling of the innermost squares, see :func:`corner`.
        cuts: number of cells along each side of a cell of the pattern, whose grading they keep.
    """
    half = np.pi / 2.0
    right, growth = corner(half, refinement, fan)
    left = right[:, ::-1] * [1.0, -1.0] - [0.0, np.pi]  # the mirror image, counterclockwise again
    ξ = half + np.concatenate([[0.0], np.cumsum(refinement.columns)])
    upwards = half * refinement.legs
    columns = grid(ξ, np.concatenate([upwards - np.pi, upwards[1:] - half]))
    quads = np.concatenate([right, left, columns])
    # The mirrored cells' second and third vertices have changed places.
    growth = np.concatenate([growth, growth ** [1.0, -1.0], np.ones((len(columns), 2))])
    return _of_rectangle(cut(quads, growth, cuts) if cuts > 1 else quads, ξ[-1])


def corner(
    size: float, refinement: Refinement, fan: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Quadrilaterals of the square [0, size] x [-size, 0], graded towards (0, 0).

    Args:
        size: of the square.
        refinement: of the rings; its columns are not used.
        fan: False fills the innermost square with a grid, True with a fan. A grid suits the rectangle; a
            fan of quadrilaterals that meet in the corner suits its image in the physical plane, where the
            corner's right angle opens to a straight line.

    Returns:
        Corners of cells, (m, 4, 2), and the size at the far side of each over that at the near side,
        from its first vertex to the second and from the second to the third, (m, 2).
    """
    sectors, t = refinement.sectors, refinement.legs
    leg = np.concatenate(
        [np.column_stack([np.ones_like(t), -t]), np.column_stack([t[-2::-1], -np.ones(sectors)])]
    )
    sizes = size * refinement.sizes
    along = np.stack([leg[:-1], leg[1:], leg[1:], leg[:-1]], axis=1)
    outer, inner = sizes[:-1, None, None, None], sizes[1:, None, None, None]
    near = np.array([True, True, False, False])[:, None]
    rings = (np.where(near, inner, outer) * along).reshape(-1, 4, 2)
    if fan:
        rim = sizes[-1] * leg
        centre = np.zeros((sectors, 2))
        filling = np.stack([centre, rim[2::2], rim[1::2], rim[:-1:2]], axis=1)
    else:
        filling = grid(sizes[-1] * t, -sizes[-1] * t)
    growth = np.ones((len(rings) + len(filling), 2))
    growth[: len(rings), 1] = np.repeat(sizes[:-1] / sizes[1:], 2 * sectors)
    return np.concatenate([rings, filling]), growth


def grid(x: NDArray, y: NDArray) -> NDArray[np.float64]:
    """Quadrilaterals between coordinates x, which rise, and y, counterclockwise, (cells, 4, 2)."""
    corners = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    around = [corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]]
    return np.stack(around if y[-1] > y[0] else around[::-1], axis=2).reshape(-1, 4, 2)


def cut(quads: NDArray, growth: NDArray, n: int) -> NDArray[np.float64]:
    """Every quadrilateral cut into n x n whose sizes grow as those of the pattern, (n² m, 4, 2).

    Args:
        quads, growth: of the pattern, see :func:`corner`.
        n: cuts of every side.
    """
    part = np.arange(n + 1) / n
    with np.errstate(invalid="ignore"):
        graded = (growth[..., None] ** part - 1.0) / (growth[..., None] - 1.0)
    s, t = np.moveaxis(np.where(growth[..., None] == 1.0, part, graded), 1, 0)[..., None]

    def between(first: NDArray, last: NDArray, share: NDArray) -> NDArray[np.float64]:
        """Points of a side; exact at both its ends, and where these have a coordinate in common."""
        return np.where(share == 1.0, last, first + share * (last - first))

    A, B, C, D = np.moveaxis(quads, 1, 0)[:, :, None]
    lattice = between(between(A, B, s)[:, :, None], between(D, C, s)[:, :, None], t[:, None])
    around = (lattice[:, :-1, :-1], lattice[:, 1:, :-1], lattice[:, 1:, 1:], lattice[:, :-1, 1:])
    return np.stack(around, axis=3).reshape(-1, 4, 2)


#: Width of the strip over the mean height of its halves, and factor by which columns grow outwards.
_WIDE, _GROWTH = 1.3, 1.6
#: Most width of the strip, over that times the height where places are near each other; factor up to
#: which halves next to a place are alike, and by which blocks between such a place and the middle grow.
_SLENDER, _ALIKE = 2.0, 3.0
#: Elliptic coordinate, some 4 000 a, beyond which a field is that of a line load to all digits of the
#: results, linear in this coordinate, and columns need no largest width.
_FAR = 9.0


def rings_at_kinks(refinement: Refinement, size: float) -> int:
    """Number of rings around kinks beyond those around ends, by the size of innermost cells."""
    return ceil(log(size) / log(refinement.ratio)) - refinement.levels


def with_kinks(refinement: Refinement, places: NDArray, more: int = 0) -> QuadMesh:
    """The rectangle in the (ξ, η) plane of a confocal mesh, graded towards kinks of the punch.

    Args:
        refinement: of the mesh without kinks.
        places: X over a of the kinks, in (-1, 1).
        more: number of additional rings around the kinks.
    """
    η = np.concatenate([[-np.pi], np.sort(-np.arccos(places)), [0.0]])
    half, legs = np.diff(η) / 2.0, refinement.legs
    least = np.minimum(np.append(half, np.inf), np.append(np.inf, half))
    widest = min(_WIDE * np.pi / (2.0 * len(half)), np.pi / 2.0)
    of_end, of_kink = (
        corner(1.0, replace(refinement, levels=refinement.levels + levels), False)[0]
        for levels in (0, more)
    )
    blocks, of_ends, of_widths = [], list[float](), list[float]()
    for i, h in enumerate(half):
        for node, side in ((i, 1), (i + 1, -1)):
            steps = ceil(log(h / least[node]) / log(_ALIKE))
            sizes = h * (least[node] / h) ** (
                np.arange(steps, -1, -1) / steps if steps > 1 else np.zeros(1)
            )
            corners = of_end if node in (0, len(half)) else of_kink
            blocks.append((corners * [1.0, -side * sizes[0]] + [0.0, η[node]])[:, ::-side])
            for low, high in pairwise(sizes):
                blocks.append(grid(legs, η[node] + side * (low + (high - low) * legs)))
            of_ends += [η[node], *(η[node] + side * sizes[:-1]), η[i] + h]
            of_widths += [least[node], *sizes]
    order = np.argsort(of_ends, kind="stable")
    ends = np.array(of_ends)[order]
    widths = np.minimum(_SLENDER * _WIDE * np.array(of_widths)[order], widest)
    for block in blocks:
        block[..., 0] *= np.interp(block[..., 1], ends, widths)
    each = np.unique(ends)
    # Each end once: as the sum of the one before and the distance it may differ in its last digit.
    inner = [low + (high - low) * legs[:-1] for low, high in pairwise(each)]
    rows = np.append(np.concatenate(inner), each[-1])
    ξ = np.array(_columns(widest, np.pi / 2.0 + sum(refinement.columns), max(refinement.columns)))
    count = 1 + round(log2(widest / widths.min()))
    beside = grid(np.arange(count + 1) / count, rows)
    share, width = beside[..., 0], np.interp(beside[..., 1], ends, widths)
    beside[..., 0] = width ** (1.0 - share) * ξ[1] ** share
    return _of_rectangle(np.concatenate([*blocks, beside, grid(ξ[1:], rows)]), ξ[-1])


def _columns(first: float, last: float, widest: float) -> list[float]:
    """Ends of columns in ξ from the strip to the far boundary; near the punch at most ``widest`` wide."""
    ends, step = [first], first
    while last - ends[-1] > 1.5 * step:
        ends.append(ends[-1] + step)
        step = min(_GROWTH * step, widest if ends[-1] < _FAR else np.inf)
    return [*ends, last]


def lines_and_corners(
    X: NDArray, depths: NDArray, places: Sequence[float], size: tuple[float, float], cells: NDArray
) -> QuadMesh:
    """Columns and rows below the surface, with cells of their own in rectangles beside places on it.

    Args:
        X: of the columns' lines, rising from -R to R; lines run along the sides of all rectangles.
        depths: of the rows' lines, rising from 0.
        places: X of the places.
        size: width and depth of the rectangles.
        cells: of the rectangle to the right of a place, in units of its size, see :func:`corner`.
    """
    boxes = grid(X, -depths)
    x, y = boxes.mean(axis=1).T
    beside = np.abs(x[:, None] - places).min(axis=1) < size[0]
    right = cells * size
    left = right[:, ::-1] * [-1.0, 1.0]
    corners = [part + np.array([X_0, 0.0]) for X_0 in places for part in (left, right)]
    return tagged(np.concatenate([boxes[(y < -size[1]) | ~beside], *corners]))


def tagged(quads: NDArray[np.float64]) -> QuadMesh:
    """A mesh of quadrilaterals (n, 4, 2) that fill a rectangle below the surface, contact |X| < 1."""
    X, Y = np.abs(quads[..., 0]).max(), quads[..., 1].min()
    return _mesh(quads, lambda x, y: (
        (y == 0.0) & (np.abs(x) < 1.0), (y == 0.0) & (np.abs(x) > 1.0), (np.abs(x) == X) | (y == Y)
    ))  # fmt: skip


def _of_rectangle(quads: NDArray[np.float64], Ξ: float) -> QuadMesh:
    """The mesh of quadrilaterals (m, 4, 2) that fill the rectangle up to ξ = Ξ."""
    return _mesh(quads, lambda ξ, η: (ξ == 0.0, (η == 0.0) | (η == -np.pi), ξ == Ξ))


def _mesh(quads: NDArray, parts: Callable[[NDArray, NDArray], tuple[NDArray, ...]]) -> QuadMesh:
    """The mesh of quadrilaterals (m, 4, 2), of which sides are contact, free and far by their middles."""
    points, cells = _joined(quads)
    sides = sides_of(cells)
    each = parts(*points[sides].mean(axis=1).T)
    return QuadMesh(points, cells, {tag: sides[part] for tag, part in zip(TAGS.values(), each)})


def sides_of(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Both vertices of every side of every cell, (4 m, 2)."""
    return np.stack([cells, np.roll(cells, -1, axis=1)], axis=-1).reshape(-1, 2)


def _joined(quads: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices of quadrilaterals (m, 4, 2), each once, (n, 2), and their numbers in cells, (m, 4)."""
    corners = quads.reshape(-1, 2)
    x, y = (_labels(values) for values in corners.T)
    _, first, inverse = np.unique(x * (y.max() + 1) + y, return_index=True, return_inverse=True)
    return corners[first], inverse.reshape(-1, 4)


def _labels(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Whole numbers that are equal where values are, but for rounding.

    Rounded values would not do: two that differ in the last digit can lie on the two sides of a step.
    """
    order = np.argsort(values)
    labels = np.empty(len(values), dtype=np.int64)
    labels[order] = np.concatenate([[0], np.cumsum(np.diff(values[order]) > _ROUNDING)])
    return labels
