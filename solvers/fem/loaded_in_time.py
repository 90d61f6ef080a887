"""A half-plane at rest that is loaded by given tractions, suddenly or not: finite elements in time.

Seen from the load M ü - 2c B u̇ + K u = (share of the load) f, by the steps of
:mod:`galinx.solvers.fem.scheme`; the pressure is known, so that nothing is asked of the contact.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import identity, kron

from galinx.clock import Clock
from galinx.solvers.fem.dynamic import Motion, of_both
from galinx.solvers.fem.nodes import Traction, consistent_forces
from galinx.solvers.fem.scheme import TIMES, A, γ
from galinx.solvers.fem.unsymmetric import UnsymmetricFactor


@dataclass(frozen=True)
class SurfaceMotion:
    """What the surface does; lengths over a, displacements over N/(2μ).

    Attributes:
        t: times over a/c_s, (steps,).
        X: where its nodes are, from left to right, (nodes,).
        u: their displacements, (steps, nodes, 2).
    """

    t: NDArray[np.float64]
    X: NDArray[np.float64]
    u: NDArray[np.float64]


class LoadedInTime:
    """All loads at one speed with one step size.

    Args:
        motion: the equations.
        h: the step over a/c_s.
        clock: takes the time of what is done.

    Raises:
        SolveError: the equations could not be solved.
    """

    def __init__(self, motion: Motion, h: float, clock: Clock | None = None) -> None:
        self._motion, self._h = motion, h
        with (clock := clock or Clock())("assembly"):
            carried = motion.M - 2.0 * motion.response.c * γ * h * motion.B
            S = kron(carried, identity(2)) + (γ * h) ** 2 * motion.K
        held = np.zeros(motion.size, dtype=bool)
        held[2 * motion.far] = held[2 * motion.far + 1] = True
        self._free = np.flatnonzero(~held)
        self.factor = UnsymmetricFactor(S.tocsr()[self._free][:, self._free].tocsr(), clock)
        space = motion.space
        nodes = np.unique(np.concatenate([space.nodes_on(part) for part in ("contact", "free surface")]))
        self._surface = nodes[np.argsort(space.coordinates[nodes, 0])]

    def run(
        self,
        steps: int,
        σ_YY: Traction,
        g: float,
        load: Callable[[float], float],
        knots: tuple[float, ...] = (),
    ) -> SurfaceMotion:
        """March from rest.

        Args:
            steps: how many.
            σ_YY: pressure under the punch over N/(2a), where all of it is there.
            g: σ_XY/σ_YY.
            load: its share at a time; at 0, too, from which on it is smooth.
            knots: positions X over a between which the pressure is smooth.
        """
        h, M, K, free = self._h, self._motion.M, self._motion.K, self._free
        f = self._forces(σ_YY, g, knots)
        u, w = np.zeros(len(f)), np.zeros(len(f))
        a = self._at_once(f * load(0.0))
        found = np.zeros((steps, len(self._surface), 2))
        for n in range(steps):
            velocities, accelerations = [w], [a]
            for weights, time in zip(A, TIMES):
                before = u + h * sum(of * one for of, one in zip(weights, velocities))
                given = w + h * sum(of * one for of, one in zip(weights, accelerations))
                b = of_both(M, given) + γ * h * (load(h * (n + time)) * f - K @ before)
                now = np.zeros(len(f))
                now[free] = self.factor.solve(b[free])
                velocities.append(now)
                accelerations.append((now - given) / (γ * h))
            u, w, a = before + γ * h * now, now, accelerations[-1]
            found[n] = u.reshape(-1, 2)[self._surface]
        X = self._motion.space.coordinates[self._surface, 0]
        return SurfaceMotion(np.arange(1.0, steps + 1.0) * h, X, found)

    def _at_once(self, f: NDArray) -> NDArray[np.float64]:
        """Accelerations at rest by forces that are there at once."""
        a = np.zeros(len(f))
        if f.any():
            M = kron(self._motion.M, identity(2)).tocsr()
            factor = UnsymmetricFactor(M[self._free][:, self._free].tocsr(), Clock())
            a[self._free] = factor.solve(f[self._free])
            factor.destroy()
        return a

    def _forces(self, σ_YY: Traction, g: float, knots: tuple[float, ...]) -> NDArray[np.float64]:
        space = self._motion.space
        facets, ends = space.surface_facets(("contact",)), space.contact.s[[0, -1]]
        by_node = consistent_forces(facets.s, space.chart, ends, σ_YY, knots).ravel()
        f = np.zeros((self._motion.size // 2, 2))
        np.add.at(f, facets.nodes.ravel(), np.column_stack([g * by_node, by_node]))
        return f.ravel()

    def destroy(self) -> None:
        """Free the factor."""
        self.factor.destroy()
