"""A flat punch that is pressed on and slides from rest: finite elements in time.

In the frame of the punch M ü + (D - 2c B) u̇ + K u are the forces of the contact. Velocities w = u̇ are
stepped by a diagonally implicit Runge-Kutta scheme of order four whose stages are of second order
(ESDIRK4(3)6L[2]SA of Kennedy and Carpenter), stiffly accurate and L-stable: with the matrix
S = M + γh (D - 2c B) + (γh)² K each stage is S w = b + γh·forces.
Under the punch w = -v̇₀ along Y and the tangential forces are g times the normal ones, r, so that with the
normal reactions P of unit tangential forces ::

    (I - g P) γh r = ρ + v̇₀ ρ_v,      Σ r = -2 (share of the load)

The fields of these forces and of v̇₀ are solved for once a step size, so that g may change in time.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve
from scipy.sparse import identity, kron

from galinx.clock import Clock
from galinx.solvers.fem.dynamic import Motion, of_both
from galinx.solvers.fem.unsymmetric import UnsymmetricFactor

_γ = 0.25
#: The scheme: stages below the first, which is the end of the step before.
_A = (
    (1 / 4,),
    (8611 / 62500, -1743 / 31250),
    (5012029 / 34652500, -654441 / 2922500, 174375 / 388108),
    (15267082809 / 155376265600, -71443401 / 120774400, 730878875 / 902184768, 2285395 / 8070912),
    (82889 / 524892, 0.0, 15625 / 83664, 69875 / 102672, -2260 / 8211),
)
_TIMES = (0.5, 83 / 250, 31 / 50, 17 / 20, 1.0)


@dataclass(frozen=True)
class Steps:
    """What was found after each step; lengths over a, stresses over N/(2a), so forces over N/2.

    Attributes:
        t: times over a/c_s, (steps,).
        v0: indentation over N/(2μ).
        forces: consistent nodal forces of σ_YY at the contact nodes from left to right, (steps, nodes).
        work: of the contact's forces by velocities seen from the punch, over N²/(4μ).
        energy: of the motion seen from the punch, (u̇M u̇ + u K u)/2 over N²/(4μ), which is that work but
            for what is absorbed: what is carried along is skew, and K has ρ(V u,X)²/2 taken away.
        absorbed: that of waves which cells far away are too large for, over N²/(4μ).
    """

    t: NDArray[np.float64]
    v0: NDArray[np.float64]
    forces: NDArray[np.float64]
    work: NDArray[np.float64]
    energy: NDArray[np.float64]
    absorbed: NDArray[np.float64]


class StartFromRest:
    """All starts at one speed with one step size.

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
            self._K, self._M, self._D = motion.K, motion.M, motion.D
            rates = self._D - 2.0 * motion.response.c * motion.B
            S = (kron(self._M + _γ * h * rates, identity(2)) + (_γ * h) ** 2 * self._K).tocsr()
        self._Y, X = 2 * motion.contact + 1, 2 * motion.contact
        held = np.zeros(motion.size, dtype=bool)
        held[self._Y] = True
        held[2 * motion.far] = held[2 * motion.far + 1] = True
        self._free = np.flatnonzero(~held)
        self.factor = UnsymmetricFactor(S[self._free][:, self._free].tocsr(), clock)
        self._rows = S[self._Y].tocsr()
        place = np.full(motion.size, -1)
        place[self._free] = np.arange(len(self._free))
        loads = np.zeros((len(self._free), len(X) + 1))
        loads[place[X], np.arange(len(X))] = 1.0
        # The contact moves by -1 along Y.
        loads[:, -1] = np.asarray(S[self._free][:, self._Y].sum(axis=1)).ravel()
        self._fields = np.zeros((motion.size, len(X) + 1))
        self._fields[self._free] = self.factor.solve(loads)
        self._fields[self._Y, -1] = -1.0
        self._reactions = self._rows @ self._fields

    def run(self, steps: int, g: Callable[[float], float], load: Callable[[float], float]) -> Steps:
        """March from rest.

        Args:
            steps: how many.
            g: σ_XY/σ_YY under the punch at a time.
            load: share of N at a time, with load(0) = 0 and no slope there.
        """
        h, size = self._h, self._motion.size
        u, w, a = (np.zeros(size) for _ in range(3))
        forces = np.zeros((steps, len(self._Y)))
        v0, energy = np.zeros(steps), np.zeros(steps)
        done, power = np.zeros((steps, 2)), np.zeros(2)
        for n in range(steps):
            velocities, accelerations, powers = [w], [a], [power]
            for weights, time in zip(_A, _TIMES):
                before = u + h * sum(of * one for of, one in zip(weights, velocities))
                given = w + h * sum(of * one for of, one in zip(weights, accelerations))
                at = h * (n + time)
                now, r = self._stage(before, given, g(at), load(at))
                velocities.append(now)
                accelerations.append((now - given) / (_γ * h))
                pushed = r @ (now[self._Y] + g(at) * now[self._Y - 1])
                powers.append(np.array([pushed, now @ of_both(self._D, now)]))
            u = before + _γ * h * now
            w, a, forces[n] = now, accelerations[-1], r
            v0[n], power = -u[self._Y[0]], powers[-1]
            done[n] = h * np.array([*_A[-1], _γ]) @ np.array(powers)
            energy[n] = (w @ of_both(self._M, w) + u @ (self._K @ u)) / 2.0
        return Steps(np.arange(1.0, steps + 1.0) * h, v0, forces, np.cumsum(done[:, 0]), energy, np.cumsum(done[:, 1]))

    def _stage(
        self, before: NDArray, given: NDArray, g: float, load: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Velocities and normal reactions from what earlier stages give."""
        b = of_both(self._M, given) - _γ * self._h * (self._K @ before)
        w = np.zeros(self._motion.size)
        w[self._free] = self.factor.solve(b[self._free])
        ρ = self._rows @ w - b[self._Y]
        P, ρ_v = self._reactions[:, :-1], self._reactions[:, -1]
        factors = lu_factor(np.eye(len(P)) - g * P)
        found = lu_solve(factors, np.column_stack([ρ, ρ_v]))
        total = found.sum(axis=0)
        rate = (-2.0 * load * _γ * self._h - total[0]) / total[1]
        r = found[:, 0] + rate * found[:, 1]
        w += self._fields @ np.append(g * r, rate)
        return w, r / (_γ * self._h)

    def destroy(self) -> None:
        """Free the factor."""
        self.factor.destroy()
