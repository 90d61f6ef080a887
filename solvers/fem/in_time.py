"""A flat punch that is pressed on and slides, from rest or steady motion on: finite elements in time.

In the frame of the punch M ü + (D - 2c B) u̇ + K u are the forces of the contact. Velocities w = u̇ are
stepped by a diagonally implicit Runge-Kutta scheme of order four whose stages are of second order
(ESDIRK4(3)6L[2]SA of Kennedy and Carpenter), stiffly accurate and L-stable: with the matrix
S = M + γh (D - 2c B) + (γh)² K each stage is S w = b + γh·forces, under a punch that moves at v̇₀.

Where the punch turns round, what is carried along changes sign. The solid goes on as it did, so that
the velocities seen from the punch jump, M Δw = Δc B u.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, identity, kron

from galinx.clock import Clock
from galinx.solvers.fem.dynamic import Motion, of_both
from galinx.solvers.fem.pressed import Pressed
from galinx.solvers.fem.scheme import TIMES, A, γ

#: Time over a/c_s after a turn at which friction is that of the way back.
_AFTER = 1e-7

#: What is told of displacements, velocities seen from the punch, and the way it goes, ±1.
Watch = Callable[[NDArray, NDArray, int], NDArray]


@dataclass(frozen=True)
class Steps:
    """What was found after each step; lengths over a, stresses over N/(2a), so forces over N/2.

    Attributes:
        t: times over a/c_s, (steps,).
        v0: indentation over N/(2μ) since the first of all times.
        forces: consistent nodal forces of σ_YY at the contact nodes from left to right, (steps, nodes).
        work_of_load, work_of_friction: of the contact's forces along Y and X by velocities seen from the
            punch, over N²/(4μ).
        energy: of the motion seen from the punch, (u̇M u̇ + u K u)/2 over N²/(4μ), less that at first: that
            work but for what is absorbed, for what is carried along is skew, and K has ρ(V u,X)²/2 taken
            away. Where the punch turns round it jumps.
        absorbed: that of waves which cells far away are too large for, over N²/(4μ).
        watched: what each of those that watched told, at first and after each step, (1 + steps, …).
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
        """Of both."""
        return self.work_of_load + self.work_of_friction


@dataclass(frozen=True)
class Phase:
    """So many equal steps one way.

    Attributes:
        direction: ±1, towards +X or back.
        duration: over a/c_s.
        steps: their number.
    """

    direction: int
    duration: float
    steps: int

    @property
    def h(self) -> float:
        """The step."""
        return self.duration / self.steps


@dataclass
class _State:
    """Displacements, velocities, accelerations, and powers of load, friction and what is absorbed."""

    u: NDArray
    w: NDArray
    a: NDArray
    powers: NDArray


class SlidingInTime:
    """All motions at one speed.

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
        self._pressed: dict[tuple[float, int], Pressed] = {}

    def run(
        self,
        phases: Sequence[Phase],
        g: Callable[[float], float],
        load: Callable[[float], float],
        steady: bool = False,
        watching: Sequence[Watch] = (),
    ) -> Steps:
        """March through all phases.

        Args:
            phases: one after the other; two ways only if the speed is not 0.
            g: σ_XY/σ_YY under the punch at a time; it may jump at a turn.
            load: share of N at a time; from rest load(0) = 0 with no slope there.
            steady: begin in the steady motion of what there is at t = 0, not at rest.
            watching: each is shown the motion at first and after each step.
        """
        state = self._steady(g(0.0), load(0.0)) if steady else self._rest()
        first_v0, first_energy = -state.u[self._Y[0]], self._energy(state)
        found, t, way = [], 0.0, phases[0].direction
        seen = [[watch(state.u, state.w, way) for watch in watching]]
        for phase in phases:
            if phase.direction != way:
                self._turn(state, phase.direction - way, g(t + _AFTER), load(t))
                way = phase.direction
            stages = self._stages(phase.h, way)
            for _ in range(phase.steps):
                r, done = self._step(state, stages, phase.h, t, g, load)
                t += phase.h
                found.append((t, -state.u[self._Y[0]] - first_v0, r, *done, self._energy(state)))
                seen.append([watch(state.u, state.w, way) for watch in watching])
        times, v0, forces, by_load, by_friction, absorbed, energy = map(np.array, zip(*found))
        return Steps(
            times, v0, forces, np.cumsum(by_load), np.cumsum(by_friction), energy - first_energy,
            np.cumsum(absorbed), tuple(map(np.array, zip(*seen))),
        )  # fmt: skip

    def _rest(self) -> _State:
        u, w, a = np.zeros((3, self._motion.size))
        return _State(u, w, a, np.zeros(3))

    def _steady(self, g: float, load: float) -> _State:
        state = self._rest()
        pressed = self._under(self._K)
        state.u, _ = pressed.solve(np.zeros(self._motion.size), g, -2.0 * load)
        pressed.destroy()
        return state

    def _turn(self, state: _State, change: int, g: float, load: float) -> None:
        """From one way to the other: velocities jump, and accelerations are others."""
        Δc, way = self._motion.response.c * change, np.sign(change)
        pressed = self._under(kron(self._M, identity(2)).tocsr())
        pushed = of_both(self._M, state.w) + Δc * of_both(self._B, state.u)
        state.w, _ = pressed.solve(pushed, g, 0.0)
        left = -of_both(self._rates(way), state.w) - self._K @ state.u
        state.a, r = pressed.solve(left, g, -2.0 * load)
        pressed.destroy()
        state.powers = self._powers(r, state.w, g)

    def _under(self, matrix: csr_matrix) -> Pressed:
        return Pressed(matrix, self._motion, self._clock)

    def _rates(self, way: int) -> csr_matrix:
        return self._D - 2.0 * way * self._motion.response.c * self._B

    def _stages(self, h: float, way: int) -> Pressed:
        """The matrix of all stages, kept for the next motion."""
        key = (round(h, 12), way)
        if key not in self._pressed:
            S = kron(self._M + γ * h * self._rates(way), identity(2)) + (γ * h) ** 2 * self._K
            self._pressed[key] = self._under(S.tocsr())
        return self._pressed[key]

    def _step(
        self, state: _State, stages: Pressed, h: float, t: float,
        g: Callable[[float], float], load: Callable[[float], float],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:  # fmt: skip
        """Take a step; normal reactions at its end, and both works and the energy absorbed in it."""
        velocities, accelerations, powers = [state.w], [state.a], [state.powers]
        for weights, time in zip(A, TIMES):
            before = state.u + h * sum(of * one for of, one in zip(weights, velocities))
            given = state.w + h * sum(of * one for of, one in zip(weights, accelerations))
            at = t + h * time
            b = of_both(self._M, given) - γ * h * (self._K @ before)
            now, r = stages.solve(b, g(at), -2.0 * load(at) * γ * h)
            velocities.append(now)
            accelerations.append((now - given) / (γ * h))
            powers.append(self._powers(r / (γ * h), now, g(at)))
        state.u, state.w, state.a = before + γ * h * now, now, accelerations[-1]
        state.powers = powers[-1]
        return r / (γ * h), h * np.array([*A[-1], γ]) @ np.array(powers)

    def _powers(self, r: NDArray, w: NDArray, g: float) -> NDArray[np.float64]:
        return np.array([r @ w[self._Y], g * (r @ w[self._Y - 1]), w @ of_both(self._D, w)])

    def _energy(self, state: _State) -> float:
        return float(state.w @ of_both(self._M, state.w) + state.u @ (self._K @ state.u)) / 2.0

    def destroy(self) -> None:
        """Free the factors."""
        for pressed in self._pressed.values():
            pressed.destroy()
