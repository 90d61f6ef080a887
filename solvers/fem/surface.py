"""Displacements along the surface Y = 0, as piecewise polynomials gathered from all ranks."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from petsc4py import PETSc

from galinx.solvers.fem.lagrange import lagrange
from galinx.solvers.fem.space import Space

#: Distance over a facet's length within which a point counts as between it and the one on the left.
_BETWEEN = 1e-9


@dataclass(frozen=True)
class SurfaceTrace:
    """Displacements of several fields along the surface, the same on every rank.

    Attributes:
        s: surface coordinates of the nodes of each facet in order of X, (F, p+1).
        u: displacements there, over Na/(2aμ), (F, p+1, 2, fields).
    """

    s: NDArray[np.float64]
    u: NDArray[np.float64]

    def derivative(self, s: ArrayLike) -> NDArray[np.float64]:
        """du/ds and dv/ds of every field at surface coordinates ``s``: (n, 2, fields).

        Between two facets these jump; there they are those of the right one.
        """
        by_node, u, length = self._around(s)
        return np.einsum("ni,ni...->n...", by_node, u) / length[:, None, None]

    def rounding(self, s: ArrayLike) -> NDArray[np.float64]:
        """What the last digits of the displacements can do to these: (n, 2, fields)."""
        by_node, u, length = self._around(s)
        worst = np.einsum("ni,ni...->n...", np.abs(by_node), np.abs(u)) / length[:, None, None]
        return np.finfo(float).eps * worst

    def _around(self, s: ArrayLike) -> tuple[NDArray, NDArray, NDArray]:
        """Derivatives by nodal values of the facets there, these values, and the facets' lengths."""
        s = np.asarray(s, dtype=float)
        first = self.s[:, 0] - _BETWEEN * (self.s[:, -1] - self.s[:, 0])
        facet = np.searchsorted(first, s, side="right") - 1
        facet = np.clip(facet, 0, len(self.s) - 1)
        start, length = self.s[facet, 0], self.s[facet, -1] - self.s[facet, 0]
        _, by_node = lagrange(self._reference_nodes, (s - start) / length)
        return by_node, self.u[facet], length

    @property
    def _reference_nodes(self) -> NDArray[np.float64]:
        """Node positions on the unit facet; the elements' are the same on all."""
        widest = np.argmax(self.s[:, -1] - self.s[:, 0])
        s = self.s[widest]
        return (s - s[0]) / (s[-1] - s[0])


class SurfaceSlopes:
    """Derivatives along X, on the surface, of combinations of displacement fields.

    Args:
        space: the finite element space.
        fields: displacements over N/(2μ).
        X: positions over a.
    """

    def __init__(self, space: Space, fields: Sequence[PETSc.Vec], X: NDArray) -> None:
        s = space.chart.surface_coordinate(X)
        stretch = space.chart.surface_stretch(s)[:, None, None]
        trace = gather(space, fields)
        self._basis, self._rounding = (
            trace.derivative(s) / stretch,
            trace.rounding(s)[:, 0] / stretch[:, 0],
        )

    def of(self, weights: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """μ u,X and μ v,X over N/(2a) of combinations with weights (states, fields): (states, n)."""
        u_X, v_X = (weights @ self._basis[:, i, : weights.shape[1]].T for i in (0, 1))
        return u_X, v_X

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        """What the last digits of the fields can do to μ u,X of combinations, (states, n)."""
        return np.abs(weights) @ self._rounding[:, : weights.shape[1]].T


def gather(space: Space, fields: Sequence[PETSc.Vec]) -> SurfaceTrace:
    """Trace of the given displacement fields on the whole surface."""
    facets = space.surface_facets(("contact", "free surface"))
    u = space.fetch(fields, space.numbers[facets.nodes])
    parts = space.comm.allgather((facets.s, u))
    s = np.concatenate([part[0] for part in parts])
    order = np.argsort(s[:, 0])
    return SurfaceTrace(s[order], np.concatenate([part[1] for part in parts])[order])
