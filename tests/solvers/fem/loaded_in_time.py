"""Prescribed tractions in time on a half-plane at rest, by the steps and matrices of sliding punches.

Seen from the load M ü - 2c B u̇ + K u = (share of the load) f, without a contact problem.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import identity, kron

from galinx.clock import Clock
from galinx.meshes.rings import QuadMesh, tagged
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.in_time import after_step, γ
from galinx.solvers.fem.linear import ArraySolver
from galinx.solvers.fem.space import Traction, consistent_forces


@dataclass(frozen=True)
class Even:
    """A rectangle below the surface, of cells that do not cross X = -a and X = a.

    Attributes:
        half_width, depth: over a, more than 1 and 0.
        size: largest side of a cell over a.
    """

    half_width: float
    depth: float
    size: float

    def drawn(self) -> QuadMesh:
        """The mesh."""
        under = np.linspace(-1.0, 1.0, ceil(2.0 / self.size) + 1)
        beside = _even(1.0, self.half_width, self.size)
        X = np.concatenate([-beside[:0:-1], under, beside[1:]])
        Y = _even(-self.depth, 0.0, self.size)
        X0, Y0 = (grid.ravel() for grid in np.meshgrid(X[:-1], Y[:-1]))
        X1, Y1 = (grid.ravel() for grid in np.meshgrid(X[1:], Y[1:]))
        quads = np.array([[X0, Y0], [X1, Y0], [X1, Y1], [X0, Y1]])
        return tagged(np.moveaxis(quads, 2, 0))


def _even(first: float, last: float, size: float) -> NDArray[np.float64]:
    return np.linspace(first, last, max(ceil((last - first) / size), 1) + 1)


@dataclass(frozen=True)
class SurfaceMotion:
    """Motion of the surface; lengths over a, displacements over N/(2μ).

    Attributes:
        t: times over a/c_s, (steps,).
        X: positions of its nodes from left to right, (nodes,).
        u: displacements of the nodes, (steps, nodes, 2).
    """

    t: NDArray[np.float64]
    X: NDArray[np.float64]
    u: NDArray[np.float64]


class LoadedInTime:
    """Motions under prescribed tractions at one speed with one step size.

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
        self.factor = ArraySolver(S.tocsr()[self._free][:, self._free].tocsr(), clock)
        space = motion.space
        nodes = np.unique(np.concatenate([space.nodes_on(part) for part in ("contact", "free surface")]))
        self._surface = nodes[np.argsort(space.coordinates[nodes, 0])]

    def run(
        self,
        steps: int,
        σ_YY: Traction,
        load: Callable[[float], float],
        knots: tuple[float, ...] = (),
    ) -> SurfaceMotion:
        """March from rest.

        Args:
            steps: number of steps.
            σ_YY: full pressure on the contact over N/(2a).
            load: share of the pressure at a time, smooth from t = 0 on, where it may jump.
            knots: positions X over a between which the pressure is smooth.
        """
        h, f, motion = self._h, self._forces(σ_YY, knots), self._motion

        def stage(u: NDArray, w: NDArray, at: float) -> NDArray[np.float64]:
            b = motion.momentum(w) + γ * h * (load(at) * f - motion.stiffness(u))
            return self._solved(self.factor, b)

        state = np.zeros(len(f)), np.zeros(len(f)), self._at_once(f * load(0.0))
        displacements = np.zeros((steps, len(self._surface), 2))
        for n in range(steps):
            state = after_step(state, h, n * h, stage)
            displacements[n] = state[0].reshape(-1, 2)[self._surface]
        X = self._motion.space.coordinates[self._surface, 0]
        return SurfaceMotion(np.arange(1.0, steps + 1.0) * h, X, displacements)

    def _at_once(self, f: NDArray) -> NDArray[np.float64]:
        """Accelerations at rest under forces that are applied suddenly."""
        if not f.any():
            return np.zeros(len(f))
        M = kron(self._motion.M, identity(2)).tocsr()
        factor = ArraySolver(M[self._free][:, self._free].tocsr(), Clock())
        a = self._solved(factor, f)
        factor.destroy()
        return a

    def _solved(self, factor: ArraySolver, b: NDArray) -> NDArray[np.float64]:
        """Solution for forces b, 0 far away."""
        x = np.zeros(len(b))
        x[self._free] = factor.solve(b[self._free])
        return x

    def _forces(self, σ_YY: Traction, knots: tuple[float, ...]) -> NDArray[np.float64]:
        space = self._motion.space
        facets, ends = space.surface_facets(("contact",)), space.contact.s[[0, -1]]
        by_node = consistent_forces(facets.s, space.chart, ends, σ_YY, knots).ravel()
        f = np.zeros((self._motion.size // 2, 2))
        np.add.at(f[:, 1], facets.nodes.ravel(), by_node)
        return f.ravel()

    def destroy(self) -> None:
        """Free the factor."""
        self.factor.destroy()
