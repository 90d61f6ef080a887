"""Finite elements in time: a flat punch that slides on a half-plane.

In the frame of the punch M ü + (D - 2c B) u̇ + K u are the forces of the contact. Velocities w = u̇ are
stepped by a diagonally implicit Runge-Kutta scheme of order four whose stages are of second order
(ESDIRK4(3)6L[2]SA of Kennedy and Carpenter), stiffly accurate and L-stable: the last stage is the end of
the step, and the first one the end of the step before. With the matrix S = M + γh (D - 2c B) + (γh)² K
each stage is S w = b + γh·forces, under a punch that moves at v̇₀.

**A rigid flat punch on the contact nodes, with any friction** (:class:`PunchConstraint`). Sought are x
and the normal reactions r with A x = b + (g r along X, r along Y), x = -η along Y under the punch, x = 0
far away, and Σ r prescribed. With the normal reactions P of unit tangential forces ::

    (I - g P) r = ρ + η ρ_η

where ρ are those to b. The fields of these forces and of η are solved for once.

**A punch that is pressed on and slides** from rest or steady motion on (:class:`SlidingInTime`). Where
the punch turns round, what is carried along changes sign. The solid goes on as it did, so that the
velocities seen from the punch jump, M Δw = Δc B u.

On the surface, strains and the pressure between nodes follow from displacements and nodal forces
(:class:`SurfaceInTime`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve, solve
from scipy.sparse import csr_matrix, identity, kron

from galinx.clock import Clock

from ..approximation import gauss, lagrange
from ..transient.history import History, Way
from .dynamic import Motion, of_both
from .fields import SurfaceTrace, unit_facet
from .linear import LinearSolver, on_this_rank

#: On the diagonal, so that one matrix serves all stages.
γ = 0.25
#: Stages below the first.
A = (
    (1 / 4,),
    (8611 / 62500, -1743 / 31250),
    (5012029 / 34652500, -654441 / 2922500, 174375 / 388108),
    (15267082809 / 155376265600, -71443401 / 120774400, 730878875 / 902184768, 2285395 / 8070912),
    (82889 / 524892, 0.0, 15625 / 83664, 69875 / 102672, -2260 / 8211),
)
TIMES = (0.5, 83 / 250, 31 / 50, 17 / 20, 1.0)


#: Displacements, velocities and accelerations.
_Rates = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


def after_step(
    before: _Rates, h: float, t: float, stage: Callable[[NDArray, NDArray, float], NDArray]
) -> _Rates:
    """Displacements, velocities and accelerations after a step.

    Args:
        before: the same before it.
        h: length of the step over a/c_s.
        t: time at its beginning.
        stage: velocities w of a stage, S w = M w' + γh (forces - K u'), by u' and w', the displacements
            and velocities by earlier stages alone, and its time.
    """
    u, w, a = before
    velocities, accelerations = [w], [a]
    for weights, time in zip(A, TIMES):
        u_explicit = u + h * sum(weight * rate for weight, rate in zip(weights, velocities))
        w_explicit = w + h * sum(weight * rate for weight, rate in zip(weights, accelerations))
        now = stage(u_explicit, w_explicit, t + h * time)
        velocities.append(now)
        accelerations.append((now - w_explicit) / (γ * h))
    return u_explicit + γ * h * now, now, accelerations[-1]


#: One of so many loads of the contact shows what a factor leaves.
_CHECKED = 16


class PunchConstraint:
    """Linear systems of a space under a rigid flat punch with any friction.

    Args:
        A: the matrix.
        motion: the equations, with the nodes under the punch and those far away.
        clock: takes the time of what is done.

    Raises:
        SolveError: the matrix could not be factorised.
    """

    def __init__(self, A: csr_matrix, motion: Motion, clock: Clock) -> None:
        self._Y, X = 2 * motion.contact + 1, 2 * motion.contact
        held = np.zeros(motion.size, dtype=bool)
        held[self._Y] = True
        held[2 * motion.far] = held[2 * motion.far + 1] = True
        self._free = np.flatnonzero(~held)
        rows = A[self._free]
        self._factor = LinearSolver(on_this_rank(rows[:, self._free]), clock, "unsymmetric")
        self._rows = A[self._Y].tocsr()
        place = np.full(motion.size, -1)
        place[self._free] = np.arange(len(self._free))
        loads = np.zeros((len(self._free), len(X) + 1))
        loads[place[X], np.arange(len(X))] = 1.0
        # The contact moves by -1 along Y.
        loads[:, -1] = np.asarray(rows[:, self._Y].sum(axis=1)).ravel()
        self._fields = np.zeros((motion.size, len(X) + 1))
        solved = self._fields[self._free] = self._factor.solve(loads, checked=False)
        # What spoils a factor spoils all columns alike.
        few = slice(None, None, -_CHECKED)
        self._factor.check(loads[:, few], solved[:, few])
        self._fields[self._Y, -1] = -1.0
        self._reactions = self._rows @ self._fields

    def solve(
        self, b: NDArray, g: float, total: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """x and normal reactions r with Σ r = total, for forces b and friction g."""
        x = np.zeros(len(b))
        # The factor was checked with the loads of the contact.
        x[self._free] = self._factor.solve(b[self._free, None], checked=False)[:, 0]
        ρ = self._rows @ x - b[self._Y]
        P, ρ_η = self._reactions[:, :-1], self._reactions[:, -1]
        reactions = lu_solve(lu_factor(np.eye(len(P)) - g * P), np.column_stack([ρ, ρ_η]))
        parts = reactions.sum(axis=0)
        η = (total - parts[0]) / parts[1]
        r = reactions[:, 0] + η * reactions[:, 1]
        x += self._fields @ np.append(g * r, η)
        return x, r

    def destroy(self) -> None:
        """Free the factor."""
        self._factor.destroy()


#: Points of a facet's rule beyond those for products of shapes: the weight next door is no polynomial.
_MORE = 12
#: Distance over a from a place to either side of it: larger than the tolerance in telling facets apart.
_BESIDE = 1e-8


class SurfaceInTime:
    """The surface of a space at chosen places.

    Args:
        motion: the equations.
        X: places over a, not at the edges of the punch, (n,).
    """

    def __init__(self, motion: Motion, X: NDArray) -> None:
        self.X, self._motion = np.asarray(X, dtype=float), motion
        nodes, s = motion.space.surface_facets(("contact", "free surface"))
        order = np.argsort(s[:, 0])
        self._s, self._nodes = s[order], nodes[order]
        self._degree = motion.space.degree

    def strain(self, u: NDArray) -> NDArray[np.float64]:
        """μ u,X over N/(2a) of displacements (unknowns,): (n,); between two cells the mean of both."""
        trace = SurfaceTrace(self._s, u.reshape(-1, 2)[self._nodes][..., None])
        before, after = (trace.derivative(self.X + beside)[:, 0, 0] for beside in (-_BESIDE, _BESIDE))
        return np.asarray((before + after) / 2.0)

    def pressure(self, forces: NDArray, α: float, β: float) -> NDArray[np.float64]:
        """σ_YY over N/(2a) at ``X``, (n,), 0 beside the punch: (1 - X)^α (1 + X)^β times a sum of shapes.

        The integrals of its products with the shapes are the nodal forces.

        Args:
            forces: consistent nodal forces over N/2 at the contact nodes, (nodes,).
            α, β: exponents at X = a and X = -a.
        """
        X, p, reference = self._motion.X, self._degree, unit_facet(self._s)
        mass, shapes = np.zeros((len(X), len(X))), np.zeros((len(self.X), len(X)))
        of_place = np.clip(np.searchsorted(X[::p], self.X, side="right") - 1, 0, len(X) // p - 1)
        for k, (start, end) in enumerate(pairwise(X[::p])):
            nodes = slice(k * p, k * p + p + 1)
            t, w = _rule(start, end, (α, β), (k == 0, end == X[-1]), p + 1 + _MORE)
            φ, _ = lagrange(reference, t)
            mass[nodes, nodes] += φ.T @ (w[:, None] * φ)
            within = of_place == k
            shapes[within, nodes] = lagrange(reference, (self.X[within] - start) / (end - start))[0]
        under = np.abs(self.X) < 1.0
        weight = np.zeros_like(self.X)
        weight[under] = (1.0 - self.X[under]) ** α * (1.0 + self.X[under]) ** β
        return np.asarray(weight * (shapes @ solve(mass, forces, assume_a="pos")))


def _rule(
    left: float, right: float, exponents: tuple[float, float], ends: tuple[bool, bool], points: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places in a facet and weights of integrals with the pressure's weight (1 - X)^α (1 + X)^β.

    Args:
        left, right: ends of the facet over a.
        exponents: α and β.
        ends: True where its left end is X = -a, and where its right end is X = a.
        points: number of points.
    """
    (α, β), half = exponents, (right - left) / 2.0
    at_left, at_right = β * ends[0], α * ends[1]
    x, w = gauss(points, at_right, at_left)
    X, w = left + half * (1.0 + x), w * half ** (1.0 + at_left + at_right)
    w = w if ends[0] else w * (1.0 + X) ** β
    return (1.0 + x) / 2.0, w if ends[1] else w * (1.0 - X) ** α


#: Time over a/c_s after a turn at which friction is that of the way back.
_AFTER = 1e-7

#: Numbers to record, by displacements, velocities seen from the punch, and its direction, ±1.
Watch = Callable[[NDArray, NDArray, int], NDArray]


@dataclass(frozen=True)
class Steps:
    """Results after each step; lengths over a, stresses over N/(2a), so forces over N/2.

    Attributes:
        t: times over a/c_s, (steps,).
        v0: indentation over N/(2μ) since t = 0.
        forces: consistent nodal forces of σ_YY at the contact nodes from left to right, (steps, nodes).
        work_of_load, work_of_friction: of the contact's forces along Y and X by velocities seen from the
            punch, over N²/(4μ).
        energy: of the motion seen from the punch, (u̇M u̇ + u K u)/2 over N²/(4μ), less that at first: that
            work but for what is absorbed, for what is carried along is skew, and K has ρ(V u,X)²/2 taken
            away. Where the punch turns round it jumps.
        absorbed: energy of waves which cells far away are too large for, over N²/(4μ).
        watched: records of each ``Watch``, at first and after each step, (1 + steps, …).
    """

    t: NDArray[np.float64]
    v0: NDArray[np.float64]
    forces: NDArray[np.float64]
    work_of_load: NDArray[np.float64]
    work_of_friction: NDArray[np.float64]
    energy: NDArray[np.float64]
    absorbed: NDArray[np.float64]
    watched: tuple[NDArray[np.float64], ...] = ()

    @property
    def work(self) -> NDArray[np.float64]:
        """Work of load and friction together, over N²/(4μ), (steps,)."""
        return self.work_of_load + self.work_of_friction


@dataclass
class _State:
    """Displacements, velocities, accelerations, and powers of load, friction and damping."""

    u: NDArray
    w: NDArray
    a: NDArray
    powers: NDArray


class SlidingInTime:
    """Motions of a sliding punch at one speed.

    Args:
        motion: the equations.
        clock: takes the time of what is done.

    Raises:
        SolveError: the equations could not be solved.
    """

    def __init__(self, motion: Motion, clock: Clock | None = None) -> None:
        self._motion, self._clock = motion, clock or Clock()
        with self._clock("assembly"):
            self._K, self._M, self._D, self._B = motion.K, motion.M, motion.D, motion.B
        self._Y = 2 * motion.contact + 1
        self._punches: dict[tuple[float, int], PunchConstraint] = {}

    def run(
        self, ways: Sequence[Way], g: History, load: History, steady: bool = False,
        watching: Sequence[Watch] = (),
    ) -> Steps:  # fmt: skip
        """March through all ways.

        Args:
            ways: one after the other; in two directions only if the speed is not 0.
            g: σ_XY/σ_YY under the punch at a time; it may jump at a turn.
            load: share of N at a time; from rest load(0) = 0 with no slope there.
            steady: begin in the steady motion under load and friction at t = 0, not at rest.
            watching: functions that record the motion, at first and after each step.
        """
        u, w, a = np.zeros((3, self._motion.size))
        state = _State(u, w, a, np.zeros(3))
        if steady:
            punch = PunchConstraint(self._K, self._motion, self._clock)
            state.u, _ = punch.solve(state.u, g(0.0), -2.0 * load(0.0))
            punch.destroy()
        first_v0, first_energy = -state.u[self._Y[0]], self._energy(state)
        records, t, direction = [], 0.0, ways[0].direction
        watched = [[watch(state.u, state.w, direction) for watch in watching]]
        for way in ways:
            if way.direction != direction:
                self._turn(state, way.direction - direction, g(t + _AFTER), load(t))
                direction = way.direction
            stages = self._stages(way.h, direction)
            for _ in range(way.steps):
                r, done = self._step(state, stages, way.h, t, g, load)
                t += way.h
                records.append((t, -state.u[self._Y[0]] - first_v0, r, *done, self._energy(state)))
                watched.append([watch(state.u, state.w, direction) for watch in watching])
        times, v0, forces, by_load, by_friction, absorbed, energy = map(np.array, zip(*records))
        return Steps(
            times, v0, forces, np.cumsum(by_load), np.cumsum(by_friction), energy - first_energy,
            np.cumsum(absorbed), tuple(map(np.array, zip(*watched))),
        )  # fmt: skip

    def _turn(self, state: _State, change: int, g: float, load: float) -> None:
        """Turn the punch round: velocities seen from it jump, and accelerations change."""
        Δc, way = self._motion.response.c * change, np.sign(change)
        punch = PunchConstraint(kron(self._M, identity(2)).tocsr(), self._motion, self._clock)
        pushed = of_both(self._M, state.w) + Δc * of_both(self._B, state.u)
        state.w, _ = punch.solve(pushed, g, 0.0)
        force = -of_both(self._rates(way), state.w) - self._K @ state.u
        state.a, r = punch.solve(force, g, -2.0 * load)
        punch.destroy()
        state.powers = self._powers(r, state.w, g)

    def _rates(self, way: int) -> csr_matrix:
        return self._D - 2.0 * way * self._motion.response.c * self._B

    def _stages(self, h: float, way: int) -> PunchConstraint:
        """The matrix of all stages of step h, kept for the next motion."""
        key = (round(h, 12), way)
        if key not in self._punches:
            S = kron(self._M + γ * h * self._rates(way), identity(2)) + (γ * h) ** 2 * self._K
            self._punches[key] = PunchConstraint(S.tocsr(), self._motion, self._clock)
        return self._punches[key]

    def _step(
        self, state: _State, stages: PunchConstraint, h: float, t: float,
        g: History, load: History,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:  # fmt: skip
        """Take a step; returns normal reactions at its end, and both works and absorbed energy in it."""
        powers, reactions = [state.powers], []

        def stage(u: NDArray, w: NDArray, at: float) -> NDArray[np.float64]:
            b = self._motion.momentum(w) - γ * h * self._motion.stiffness(u)
            now, r = stages.solve(b, g(at), -2.0 * load(at) * γ * h)
            reactions.append(r / (γ * h))
            powers.append(self._powers(reactions[-1], now, g(at)))
            return now

        state.u, state.w, state.a = after_step((state.u, state.w, state.a), h, t, stage)
        state.powers = powers[-1]
        return reactions[-1], h * np.array([*A[-1], γ]) @ np.array(powers)

    def _powers(self, r: NDArray, w: NDArray, g: float) -> NDArray[np.float64]:
        return np.array([r @ w[self._Y], g * (r @ w[self._Y - 1]), self._motion.dissipation(w)])

    def _energy(self, state: _State) -> float:
        of_both = self._motion.momentum(state.w), self._motion.stiffness(state.u)
        return float(state.w @ of_both[0] + state.u @ of_both[1]) / 2.0

    def destroy(self) -> None:
        """Free the factors."""
        for punch in self._punches.values():
            punch.destroy()
