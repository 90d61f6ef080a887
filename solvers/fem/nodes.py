"""Nodes and facets of parts of the surface, and the nodal forces of tractions on them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.fem.chart import Chart
from galinx.solvers.fem.lagrange import lagrange

#: σ over N/(2a) at the distances from the left and the right punch edge over a; both are given,
#: because next to an edge X/a itself no longer tells the distance.
Traction = Callable[[NDArray, NDArray], NDArray]

#: Facets at an edge are integrated in τ with distance ~ τ^8: traction grows like a root there.
_EDGE_POWER = 8
_POINTS = 48


@dataclass(frozen=True)
class SurfaceNodes:
    """Nodes of a part of the surface, in order of X, the same on every rank.

    Attributes:
        s: surface coordinates in the mesh's chart, (n,).
        owned: positions in ``s`` of the nodes this rank owns.
        numbers: global numbers of their first unknowns, those along X; the second ones follow.
    """

    s: NDArray[np.float64]
    owned: NDArray[np.int64]
    numbers: NDArray[np.int32]

    def dofs(self, component: int) -> NDArray[np.int32]:
        """Global numbers of the owned unknowns, component 0 for u and 1 for v."""
        return self._dofs[component]

    @cached_property
    def _dofs(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        return self.numbers, self.numbers + 1


@dataclass(frozen=True)
class SurfaceFacets:
    """This rank's facets of the surface.

    Attributes:
        nodes: local node numbers of each facet in order of X, (F, p+1).
        s: their surface coordinates, (F, p+1).
    """

    nodes: NDArray[np.int32]
    s: NDArray[np.float64]


@dataclass(frozen=True)
class NodalForces:
    """∫ σ φ d(X/a) over N/(2a) of a traction on the contact; a node stands once for each of its facets.

    Attributes:
        numbers: global numbers of the nodes' first unknowns, (n,).
        s: their surface coordinates, (n,).
        forces: this rank's part, (n,).
    """

    numbers: NDArray[np.int32]
    s: NDArray[np.float64]
    forces: NDArray[np.float64]


def consistent_forces(
    s: NDArray, chart: Chart, ends: NDArray, σ_YY: Traction, knots: NDArray | tuple[float, ...] = ()
) -> NDArray[np.float64]:
    """∫ σ_YY φ d(X/a) on facets under the punch, (F, p+1).

    Args:
        s: surface coordinates of the facets' nodes, (F, p+1).
        chart: of the mesh.
        ends: surface coordinates of both ends of the contact.
        σ_YY: the load.
        knots: positions X over a, under the punch, between which it is smooth.
    """
    knots = chart.surface_coordinate(np.asarray(knots))
    forces = np.zeros_like(s)
    left, right = ends
    for i, nodes in enumerate(s):
        length = nodes[-1] - nodes[0]
        within = (knots[(nodes[0] < knots) & (knots < nodes[-1])] - nodes[0]) / length
        for a, b in pairwise([0.0, *within, 1.0]):
            from_a, from_b, w = _rule(nodes[0] == left and a == 0.0, nodes[-1] == right and b == 1.0)
            # How far from the facet's two ends, over its length; each is exact at its own end.
            start, end = a + (b - a) * from_a, (1.0 - b) + (b - a) * from_b
            basis, _ = lagrange((nodes - nodes[0]) / length, start)
            d_left, d_right, stretch = chart.under_punch(
                nodes[0] - left + length * start, right - nodes[-1] + length * end
            )
            forces[i] += (w * (b - a) * length * stretch * σ_YY(d_left, d_right)) @ basis
    return forces


def _rule(at_left: bool, at_right: bool) -> tuple[NDArray, NDArray, NDArray]:
    """Distances of the points from both ends of an interval of length 1, and weights."""
    τ, weight = np.polynomial.legendre.leggauss(_POINTS)
    τ, weight = (τ + 1.0) / 2.0, weight / 2.0
    if not (at_left or at_right):
        return τ, 1.0 - τ, weight
    τ, weight = τ**_EDGE_POWER, weight * _EDGE_POWER * τ ** (_EDGE_POWER - 1)
    return (1.0 - τ, τ, weight) if at_right else (τ, 1.0 - τ, weight)
