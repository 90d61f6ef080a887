"""Punches of any convex profile whose contact ends where the pressure says, by finite elements.

The slope of such a punch, or its derivative, jumps at places that depend on the state, and cells are
graded towards these: every state has a mesh of its own, once its ends are nearly known. On that the
degree rises until the measured error is within tolerance. Where contacts of all loads are alike, one
state of a friction is all of them.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.kinked_ends import EndsAtSpeed, alone, ends_at_speed
from galinx.app.run.methods.kinked_state import KinkedState, solved
from galinx.app.run.methods.ladder import WorkDone
from galinx.app.run.methods.own_meshes import OnOwnMeshes, OwnMeshesAtSpeed
from galinx.postprocess.yielding.strength import Strength
from galinx.solvers.profiles import jumps

#: Distance over a from an end or a kink from which on stresses are looked at, the place itself besides.
_NEAREST = 1e-2


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["KinkedAtSpeed"]:
    """States are solved when they are asked for, each on meshes of its own."""
    with ends_at_speed(work.for_ends, task, g) as ends:
        at = KinkedAtSpeed(work, task, ends)
        try:
            yield at
        finally:
            at.destroy()


class KinkedAtSpeed(OwnMeshesAtSpeed):
    """Contacts at one speed, see :class:`OwnMeshesAtSpeed`.

    Args:
        work, task: the same.
        ends: of all its contacts.
    """

    def __init__(self, work: Discretisation, task: Task, ends: EndsAtSpeed) -> None:
        super().__init__(work, task)
        self._ends = ends

    def states(self, g: NDArray, load: Any = None) -> "KinkedPunches":
        body = self.task.body.loaded(load)
        of_each = np.broadcast_to(body.load, g.shape)
        solved_at = np.full(g.shape, self.task.body.load) if body.alike else of_each
        found = [self._state(*state) for state in zip(g.tolist(), solved_at.tolist())]
        growth = self.task.body.growth(of_each) if body.alike else np.ones(g.shape)
        return KinkedPunches(self.task, g, found, body, growth)

    def record(self) -> dict[str, Any]:
        done = WorkDone(**vars(self._done))
        done.add(self._ends.done)
        return self._record | vars(done)

    def _solve(self, g: float, load: float) -> KinkedState:
        task = alone(self.task, load)
        return solved(self.work, task, g, self._ends.of(g, load), self._done)


@dataclass(frozen=True)
class KinkedPunches(OnOwnMeshes):
    """Punches of any convex profile with several frictions and loads.

    Attributes:
        growth: half-width of each over that of what was found, (states,).
    """

    growth: NDArray[np.float64]

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
        return self.growth * [state.ends.half_width for state in self.found]

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self.growth * [state.ends.centre for state in self.found]

    @property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        if jumps(self.body.profile):
            return np.full(len(self.g), np.nan), np.full(len(self.g), np.nan)
        values, places = np.array([state.largest for state in self.found]).T
        return values, places

    @property
    def residual(self) -> NDArray[np.float64]:
        """What the pressure leaves of the integral equation, relative, (states,)."""
        return np.array([state.residual for state in self.found])

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation of the punch's lowest point over N/(2μ), (states,)."""
        return np.array([state.level.contact.v0[0] for state in self.found])

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        return Strength(
            self._stresses, self.body, self.task.response, self.g, self.local, self.half_width,
            self.surface.turns, _NEAREST,
        )  # fmt: skip

    def _stresses(self, points: NDArray) -> NDArray[np.float64]:
        """At points of all states, (1, n, 2), or of each, (states, n, 2): (3, states, n)."""
        each = np.broadcast_to(points, (len(self.g), *points.shape[1:]))
        found = [state.at(some) for state, some in zip(self.found, each)]
        return np.stack(found, axis=1)
