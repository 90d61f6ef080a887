"""Every cell of a pattern cut into n x n, in pieces: ranks make theirs without asking one another.

Vertices are numbered those of the pattern first, then those along its edges, then those inside its
cells; so a number alone tells where a vertex is.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.rings import Pattern, QuadMesh


def cut(pattern: Pattern, n: int, part: int = 0, parts: int = 1) -> QuadMesh:
    """A piece of the pattern with every cell cut into n x n, its grading kept.

    Args:
        pattern: few quadrilaterals, the same for every part.
        n: cuts of every edge, at least 1.
        part, parts: which of how many pieces; pieces have about the same number of cells.

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
    return np.arange(count * part // parts, count * (part + 1) // parts)


def _graded(growth: NDArray[np.float64], part: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where a part of the cuts of an edge ends, over its length; the cuts grow by ``growth`` in all."""
    even = growth == 1.0
    q = np.where(even, 2.0, growth)
    return np.where(even, part, (q**part - 1.0) / (q - 1.0))


@dataclass(frozen=True)
class _Cut:
    """Numbers and places of the vertices of a cut pattern."""

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
        """Where the vertices with these numbers are, (len(numbers), 2); numbers are sorted."""
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
        """Cells that these of the pattern are cut into, counterclockwise, (n² coarse, 4)."""
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
        """Edges that these of the pattern (m, 2) are cut into, (n m, 2)."""
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
