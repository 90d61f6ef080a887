"""What a motion in time does to the surface: strains along it, and the pressure between its nodes."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve
from scipy.special import roots_jacobi

from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.lagrange import lagrange
from galinx.solvers.fem.surface import SurfaceTrace

#: Points of a facet's rule beyond those for products of shapes: the weight next door is no polynomial.
_MORE = 12
#: Distance over a from a place to either side of it: more than that within which facets are one.
_BESIDE = 1e-8


class SurfaceInTime:
    """The surface of a space at chosen places.

    Args:
        motion: the equations.
        X: places over a, not at the edges of the punch, (n,).
    """

    def __init__(self, motion: Motion, X: NDArray) -> None:
        self.X, self._motion = np.asarray(X, dtype=float), motion
        facets = motion.space.surface_facets(("contact", "free surface"))
        order = np.argsort(facets.s[:, 0])
        self._s, self._nodes = facets.s[order], facets.nodes[order]
        self._degree = motion.space.degree

    def strain(self, u: NDArray) -> NDArray[np.float64]:
        """μ u,X over N/(2a) of displacements (unknowns,): (n,); between two cells the mean of both."""
        trace = SurfaceTrace(self._s, u.reshape(-1, 2)[self._nodes][..., None])
        left, right = (trace.derivative(self.X + beside)[:, 0, 0] for beside in (-_BESIDE, _BESIDE))
        return np.asarray((left + right) / 2.0)

    def pressure(self, forces: NDArray, α: float, β: float) -> NDArray[np.float64]:
        """σ_YY over N/(2a), 0 beside the punch: the weight (1 - X)^α (1 + X)^β times what shapes tell.

        Its products with these, integrated, are the nodal forces.

        Args:
            forces: consistent ones over N/2 at the contact nodes, (nodes,).
            α, β: exponents at X = a and X = -a.
        """
        X, p = self._motion.X, self._degree
        mass, told = np.zeros((len(X), len(X))), np.zeros((len(self.X), len(X)))
        of_place = np.clip(np.searchsorted(X[::p], self.X, side="right") - 1, 0, len(X) // p - 1)
        for k, (left, right) in enumerate(pairwise(X[::p])):
            some = slice(k * p, k * p + p + 1)
            t, w = _rule(left, right, (α, β), (k == 0, right == X[-1]), p + 1 + _MORE)
            φ, _ = lagrange(self._reference, t)
            mass[some, some] += φ.T @ (w[:, None] * φ)
            here = of_place == k
            told[here, some] = lagrange(self._reference, (self.X[here] - left) / (right - left))[0]
        under = np.abs(self.X) < 1.0
        weight = np.zeros_like(self.X)
        weight[under] = (1.0 - self.X[under]) ** α * (1.0 + self.X[under]) ** β
        return np.asarray(weight * (told @ solve(mass, forces, assume_a="pos")))

    @property
    def _reference(self) -> NDArray[np.float64]:
        """Places of nodes on the unit facet, as the widest one tells them."""
        widest = self._s[np.argmax(self._s[:, -1] - self._s[:, 0])]
        return np.asarray((widest - widest[0]) / (widest[-1] - widest[0]))


def _rule(
    left: float, right: float, exponents: tuple[float, float], ends: tuple[bool, bool], points: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places in a facet and weights, with those of the pressure among them.

    Args:
        left, right: its ends over a.
        exponents: α and β.
        ends: is its left one X = -a, its right one X = a?
        points: how many.
    """
    (α, β), half = exponents, (right - left) / 2.0
    at_left, at_right = β * ends[0], α * ends[1]
    with np.errstate(invalid="ignore", divide="ignore"):  # SciPy replaces 0/0 where α + β = -1
        x, w = roots_jacobi(points, at_right, at_left)
    X, w = left + half * (1.0 + x), w * half ** (1.0 + at_left + at_right)
    w = w if ends[0] else w * (1.0 + X) ** β
    return (1.0 + x) / 2.0, w if ends[1] else w * (1.0 - X) ** α
