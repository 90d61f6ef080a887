"""Energies of a motion in time, of the whole solid and of a box round the punch that goes with it.

With u̇ as seen from the punch, whose velocity is C, the solid moves at u̇ - C u,X (lengths over a, times
over a/c_s). Its kinetic energy is half of ∫(u̇ - C u,X)², its strain energy half of ∫(K's density +
C² u,X²), and its momentum in the field Π = -∫(u̇ - C u,X)·u,X, by which energies seen from both differ::

    strain + kinetic = (energy of the motion seen from the punch) + C Π
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.fem import adapter, cells
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.lagrange import lagrange
from galinx.solvers.fem.shapes import Shapes

#: Half-width and depth over a of the box.
BOX = 3.0, 2.0
#: Cells that are treated together, so that they stay near the processor.
_TOGETHER = 64


@dataclass(frozen=True)
class _Cells:
    """Some cells at the points of their rule.

    Attributes:
        weights: (cells, points).
        inverse: (cells, points, direction, axis).
    """

    weights: NDArray[np.float64]
    inverse: NDArray[np.float64]

    @classmethod
    def of(cls, shapes: Shapes, vertices: NDArray) -> "_Cells":
        """Of cells with these vertices, (cells, 4, 2)."""
        found = [shapes.on(corners) for corners in vertices]
        return cls(np.array([one for one, _ in found]), np.array([one for _, one in found]))


class Energies:
    """Energies and momentum of displacements and velocities.

    Args:
        motion: the equations.
    """

    def __init__(self, motion: Motion) -> None:
        space, self._c = motion.space, motion.response.c
        self._H, self._ρ = space.densities(motion.response, space.vertices), motion.ρ[:, None]
        self._nodes = adapter.cell_nodes(space.V)
        self._shapes = Shapes.of(space.reference_nodes)
        vertices = space.vertices[:, :, :2]
        self._all = _Cells.of(self._shapes, vertices)
        low, high = vertices.min(axis=1), vertices.max(axis=1)
        left, bottom = np.array([-BOX[0], -BOX[1]]), np.array([BOX[0], 0.0])
        inside = np.all((low >= left - 1e-12) & (high <= bottom + 1e-12), axis=1)
        touched = np.all((np.minimum(high, bottom) - np.maximum(low, left)) > 1e-12, axis=1)
        self._inside, self._cut = np.flatnonzero(inside), np.flatnonzero(touched & ~inside)
        parts = [np.array([np.maximum(low[i], left), np.minimum(high[i], bottom)]) for i in self._cut]
        self._parts = _Cells.of(self._shapes, _rectangles(parts))
        self._onto = np.array([
            self._restricted(space.reference_nodes, vertices[i], part)
            for i, part in zip(self._cut, parts)
        ]).reshape(len(parts), *2 * (len(space.reference_nodes),))  # fmt: skip

    def __call__(self, u: NDArray, w: NDArray, way: int) -> NDArray[np.float64]:
        """Strain and kinetic energy in the box, the same of all, over N²/(4μ), and Π, over N²/(4μ c_s).

        Args:
            u: displacements, (unknowns,).
            w: velocities seen from the punch.
            way: ±1, in which it goes.
        """
        fields = np.stack([u.reshape(-1, 2), w.reshape(-1, 2)], axis=-1)[self._nodes]
        whole = self._of(self._all, fields, way, np.arange(len(fields)))
        cut = np.einsum("mkn,mncf->mkcf", self._onto, fields[self._cut])
        near = whole[self._inside].sum(axis=0) + self._of(self._parts, cut, way, self._cut).sum(axis=0)
        total = whole.sum(axis=0)
        return np.array([near[0], near[1], total[0], total[1], total[2]])

    def _of(self, of: _Cells, fields: NDArray, way: int, which: NDArray) -> NDArray[np.float64]:
        """Strain and kinetic energy and momentum of each cell, (cells, 3).

        Args:
            of: the cells.
            fields: displacements and velocities at their nodes, (cells, nodes, component, 2).
            way: ±1.
            which: cells of the mesh they are, or are parts of.
        """
        found = np.empty((len(fields), 3))
        for start in range(0, len(fields), _TOGETHER):
            some = slice(start, start + _TOGETHER)
            u, w = fields[some, ..., 0], fields[some, ..., 1]
            by_cell = np.einsum("dqn,mnc->mqcd", self._shapes.slopes, u, optimize=True)
            slopes = np.einsum("mqcd,mqdx->mqcx", by_cell, of.inverse[some])
            u_X = slopes[..., 0]
            moving = self._shapes.values @ w - way * self._c * u_X
            gradients = slopes.reshape(*slopes.shape[:2], 4)
            H, ρ = self._H if self._H.ndim == 2 else self._H[which[some]], self._ρ[which[some]]
            strain = ((gradients @ H) * gradients).sum(axis=-1) + ρ * self._c**2 * (u_X**2).sum(axis=-1)
            momentum, kinetic = -ρ * (moving * u_X).sum(axis=-1), ρ * (moving**2).sum(axis=-1)
            densities = strain / 2.0, kinetic / 2.0, momentum
            found[some] = np.stack([(one * of.weights[some]).sum(axis=1) for one in densities], axis=-1)
        return found

    def _restricted(self, reference: NDArray, corners: NDArray, part: NDArray) -> NDArray[np.float64]:
        """Values at the nodes of a part of a cell from those at its own, (nodes, nodes).

        Args:
            reference: places of nodes in the unit square.
            corners: of the cell, a rectangle along the axes.
            part: lowest and highest corner of the part.
        """
        grid, nodes = cells.tensor_order(reference)
        places = cells.pull_back(
            np.broadcast_to(corners, (len(reference), 4, 2)), part[0] + reference * (part[1] - part[0])
        )
        one, other = (lagrange(nodes, places[:, axis])[0] for axis in (0, 1))
        product = (one[:, :, None] * other[:, None, :]).reshape(len(reference), -1)
        return np.asarray(product[:, np.argsort(grid.ravel())])


def _rectangles(parts: list[NDArray]) -> NDArray[np.float64]:
    """Vertices of rectangles from their lowest and highest corners, in dolfinx's order, (n, 4, 2)."""
    return np.array([
        [low, [high[0], low[1]], [low[0], high[1]], high] for low, high in parts
    ]).reshape(-1, 4, 2)  # fmt: skip
