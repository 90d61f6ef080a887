"""The one cell pattern of all meshes: a rectangle, graded towards the two corners of the contact.

In elliptic coordinates X + iY = a cosh(ξ + iη) the half-plane Y < 0 is the rectangle 0 <= ξ <= Ξ,
-π <= η <= 0. Its side ξ = 0 is the contact, η = 0 and η = -π are the free surface right and left of
the punch, ξ = Ξ is far away. Quadrilaterals lie in L-shaped rings around the punch edges (0, 0) and
(0, -π), and in columns outwards.

Every cell of the pattern may be cut into n x n. The cut mesh is made in pieces, so that each rank makes
its own without communication. Vertices of the pattern are numbered first, then those along its edges,
then those inside its cells; so a number alone gives the position of a vertex.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

CONTACT, FREE, FAR = 1, 2, 3
#: Coordinates that differ by less are equal; the smallest cells are far above.
_ROUNDING = 1e-12
#: Boundary parts by name, as gmsh's physical groups carry them.
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
    columns: tuple[float, ...]
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

    A piece of a larger mesh has the whole's numbers in ``cells`` and ``edges``, its share in ``points``.
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    edges: dict[int, NDArray[np.int64]]


@dataclass(frozen=True)
class Pattern:
    """Quadrilaterals with the grading of their cuts.

    Attributes:
        mesh: the quadrilaterals.
        growth: size at the far side of a cell over that at the near side, from its first vertex to the
            second and from the second to the third, (cells, 2).
    """

    mesh: QuadMesh
    growth: NDArray[np.float64]


def rectangle(refinement: Refinement, fan: bool = False) -> Pattern:
    """The graded rectangle in the (ξ, η) plane.

    Args:
        refinement: of the pattern.
        fan: False fills the innermost square of a corner with a grid, True with a fan. A grid suits the
            rectangle; a fan of quadrilaterals that meet in the corner suits its image in the physical
            plane, where the corner's right angle opens to a straight line.
    """
    half = np.pi / 2.0
    right, growth = corner(half, refinement, fan)
    ξ = half + np.concatenate([[0.0], np.cumsum(refinement.columns)])
    upwards = half * refinement.legs
    η = np.concatenate([upwards - np.pi, upwards[1:] - half])
    columns = [
        [(ξ0, η0), (ξ1, η0), (ξ1, η1), (ξ0, η1)] for ξ0, ξ1 in pairwise(ξ) for η0, η1 in pairwise(η)
    ]
    quads = np.concatenate([right, _mirrored(right), np.reshape(columns, (-1, 4, 2))])
    # The mirrored cells' second and third vertices have changed places.
    growth = np.concatenate([growth, growth ** [1.0, -1.0], np.ones((len(columns), 2))])
    corners_of_all = quads.reshape(-1, 2)
    return Pattern(joined(corners_of_all, ξ[-1]), growth)


def joined(corners: NDArray[np.float64], Ξ: float) -> QuadMesh:
    """The mesh of quadrilaterals by their corners, (4·cells, 2), in the rectangle up to ξ = Ξ."""
    ξ_label, η_label = (labels(values) for values in corners.T)
    keys = ξ_label * (η_label.max() + 1) + η_label
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    points, cells = corners[first], inverse.reshape(-1, 4)
    return QuadMesh(points, cells, tagged_edges(points, cells, Ξ))


def tagged(quads: NDArray[np.float64], last: float) -> QuadMesh:
    """A mesh of quadrilaterals (n, 4, 2) below the surface whose far corners are at X = ±last."""
    mesh = joined(quads.reshape(-1, 2), last)
    sides = np.stack([mesh.cells, np.roll(mesh.cells, -1, axis=1)], axis=-1).reshape(-1, 2)
    _, index, count = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
    boundary = sides[index[count == 1]]
    X, Y = mesh.points[boundary].mean(axis=1).T
    top = Y == 0.0
    edges = {CONTACT: boundary[top & (np.abs(X) < 1.0)], FREE: boundary[top & (np.abs(X) > 1.0)],
             FAR: boundary[~top]}  # fmt: skip
    return QuadMesh(mesh.points, mesh.cells, edges)


def labels(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Whole numbers that are equal where values are, but for rounding.

    Rounded values would not do: two that differ in the last digit can lie on the two sides of a step.
    """
    order = np.argsort(values)
    steps = np.diff(values[order]) > _ROUNDING
    labels = np.empty(len(values), dtype=np.int64)
    labels[order] = np.concatenate([[0], np.cumsum(steps)])
    return labels


def corner(
    size: float, refinement: Refinement, fan: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Quadrilaterals of the square [0, size] x [-size, 0], graded towards (0, 0): (m, 4, 2), (m, 2)."""
    sectors, t = refinement.sectors, refinement.legs
    leg = np.concatenate(
        [np.column_stack([np.ones_like(t), -t]), np.column_stack([t[-2::-1], -np.ones(sectors)])]
    )
    sizes = size * refinement.sizes
    quads = [
        [inner * leg[i], inner * leg[i + 1], outer * leg[i + 1], outer * leg[i]]
        for outer, inner in pairwise(sizes)
        for i in range(2 * sectors)
    ]
    rings = len(quads)
    if fan:
        rim = sizes[-1] * leg
        quads += [[0.0 * rim[0], *rim[2 * i : 2 * i + 3][::-1]] for i in range(sectors)]
    else:
        grid = sizes[-1] * t
        quads += [
            [(x0, -y0), (x0, -y1), (x1, -y1), (x1, -y0)]
            for x0, x1 in pairwise(grid)
            for y0, y1 in pairwise(grid)
        ]
    growth = np.ones((len(quads), 2))
    growth[:rings, 1] = np.repeat(sizes[:-1] / sizes[1:], 2 * sectors)
    return np.array(quads), growth


def _mirrored(quads: NDArray[np.float64]) -> NDArray[np.float64]:
    """The mirror image in η = -π/2, counterclockwise again."""
    flipped = quads[:, ::-1].copy()
    flipped[..., 1] = -np.pi - flipped[..., 1]
    return flipped


def tagged_edges(
    points: NDArray[np.float64], cells: NDArray[np.int64], Ξ: float
) -> dict[int, NDArray[np.int64]]:
    """Boundary edges of a mesh of the rectangle up to ξ = Ξ by tag, each (k, 2)."""
    edges = np.stack([cells, np.roll(cells, -1, axis=1)], axis=-1).reshape(-1, 2)
    middle_ξ, middle_η = points[edges].mean(axis=1).T
    return {
        CONTACT: edges[middle_ξ == 0.0],
        FREE: edges[(middle_η == 0.0) | (middle_η == -np.pi)],
        FAR: edges[middle_ξ == Ξ],
    }


def cut(pattern: Pattern, n: int, part: int = 0, parts: int = 1) -> QuadMesh:
    """A piece of the pattern with every cell cut into n x n, its grading kept.

    Args:
        pattern: few quadrilaterals, the same for every part.
        n: cuts of every edge, at least 1.
        part, parts: number of the piece, from 0, and of all pieces, each with about as many cells.

    Returns:
        Cells and tagged edges of the piece, with the vertices' numbers in the whole; and of the whole's
        points those of the next numbers after the pieces before.
    """
    fine = _Cut(pattern, n)
    points = fine.positions(_share(fine.size, part, parts))
    cells = fine.cells(_share(len(pattern.mesh.cells), part, parts))
    edges = {
        tag: fine.along(ends[_share(len(ends), part, parts)]) for tag, ends in pattern.mesh.edges.items()
    }
    return QuadMesh(points, cells, edges)


def _share(count: int, part: int, parts: int) -> NDArray[np.int64]:
    """Numbers below ``count`` that belong to a part."""
    return np.arange(count * part // parts, count * (part + 1) // parts)


def _graded(growth: NDArray[np.float64], part: NDArray[np.float64]) -> NDArray[np.float64]:
    """End of a part of an edge's cuts, over its length; the cuts grow by ``growth`` in all."""
    even = growth == 1.0
    q = np.where(even, 2.0, growth)
    return np.where(even, part, (q**part - 1.0) / (q - 1.0))


@dataclass(frozen=True)
class _Cut:
    """Numbers and positions of the vertices of a cut pattern."""

    pattern: Pattern
    n: int

    @property
    def _mesh(self) -> QuadMesh:
        return self.pattern.mesh

    @cached_property
    def _sides(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Ends of the pattern's edges, the lower number first, in order, (edges, 2); and their growth."""
        cells, (along, across) = self._mesh.cells, self.pattern.growth.T
        ends = np.stack([cells, np.roll(cells, -1, axis=1)], axis=-1).reshape(-1, 2)
        growth = np.stack([along, across, 1.0 / along, 1.0 / across], axis=-1).ravel()
        growth = np.where(ends[:, 0] < ends[:, 1], growth, 1.0 / growth)
        edges, first = np.unique(np.sort(ends, axis=1), axis=0, return_index=True)
        return edges, growth[first]

    @property
    def _first(self) -> tuple[int, int]:
        """The first number along an edge, and inside a cell."""
        vertices = len(self._mesh.points)
        return vertices, vertices + len(self._sides[0]) * (self.n - 1)

    @property
    def size(self) -> int:
        """Vertices of the whole."""
        return self._first[1] + len(self._mesh.cells) * (self.n - 1) ** 2

    def positions(self, numbers: NDArray[np.int64]) -> NDArray[np.float64]:
        """Positions of the vertices with these numbers, (len(numbers), 2); numbers are sorted."""
        points, inner = self._mesh.points, self.n - 1
        old, beside, inside = np.split(numbers, np.searchsorted(numbers, self._first))
        edge, step = np.divmod(beside - self._first[0], max(inner, 1))
        edges, growth = self._sides
        # Exactly on the boundary: between equal coordinates nothing is rounded.
        A, B = np.moveaxis(points[edges[edge]], 1, 0)
        on_edges = A + _graded(growth[edge], (step + 1) / self.n)[:, None] * (B - A)
        cell, place = np.divmod(inside - self._first[1], max(inner**2, 1))
        steps = np.stack(np.divmod(place, max(inner, 1)), axis=-1)
        a, b = _graded(self.pattern.growth[cell], (steps + 1) / self.n).T[..., None]
        A, B, C, D = np.moveaxis(points[self._mesh.cells[cell]], 1, 0)
        in_cells = (1 - a) * (1 - b) * A + a * (1 - b) * B + a * b * C + (1 - a) * b * D
        return np.concatenate([points[old], on_edges, in_cells])

    def cells(self, coarse: NDArray[np.int64]) -> NDArray[np.int64]:
        """Cells into which some cells of the pattern are cut, counterclockwise, (n² coarse, 4)."""
        n, corners = self.n, self._mesh.cells[coarse]
        lattice = np.empty((len(coarse), n + 1, n + 1), dtype=np.int64)
        sides = (lattice[:, :, 0], lattice[:, n, :], lattice[:, ::-1, n], lattice[:, 0, ::-1])
        for i, side in enumerate(sides):
            side[:] = self._numbers(corners[:, [i, (i + 1) % 4]])
        inside = self._first[1] + np.arange((n - 1) ** 2).reshape(n - 1, n - 1)
        lattice[:, 1:n, 1:n] = inside + (n - 1) ** 2 * coarse[:, None, None]
        around = (lattice[:, :-1, :-1], lattice[:, 1:, :-1], lattice[:, 1:, 1:], lattice[:, :-1, 1:])
        return np.stack(around, axis=-1).reshape(-1, 4)

    def along(self, ends: NDArray[np.int64]) -> NDArray[np.int64]:
        """Edges into which some edges of the pattern, (m, 2), are cut, (n m, 2)."""
        numbers = self._numbers(ends)
        return np.stack([numbers[:, :-1], numbers[:, 1:]], axis=-1).reshape(-1, 2)

    def _numbers(self, ends: NDArray[np.int64]) -> NDArray[np.int64]:
        """Numbers of the vertices from one end of an edge to the other, (m, n + 1)."""
        place = [len(self._mesh.points), 1]
        edge = np.searchsorted(self._sides[0] @ place, np.sort(ends, axis=1) @ place)
        step = np.arange(self.n - 1)
        forward = (ends[:, 0] < ends[:, 1])[:, None]
        between = self._first[0] + (self.n - 1) * edge[:, None] + np.where(forward, step, step[::-1])
        return np.column_stack([ends[:, 0], between, ends[:, 1]])
