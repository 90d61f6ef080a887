"""Punches over layers whose contact ends where the pressure says, by finite elements.

Layers have a length, so each contact has a mesh drawn for its half-width. That is found by solving on a
few of them, at a lower degree at first, until the load that makes a contact of that size is the one
wanted; then the degree rises until the measured error is within tolerance.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.followed_state import FollowedState, solved
from galinx.app.run.methods.kinked_ends import alone
from galinx.app.run.methods.own_meshes import OnOwnMeshes, OwnMeshesAtSpeed
from galinx.postprocess.largest import largest
from galinx.solvers.solution import Places


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["FollowedAtSpeed"]:
    """States are solved when they are asked for, each on meshes of its own."""
    at = FollowedAtSpeed(work, task)
    try:
        yield at
    finally:
        at.destroy()


class FollowedAtSpeed(OwnMeshesAtSpeed):
    """Contacts at one speed, see :class:`OwnMeshesAtSpeed`."""

    def states(self, g: NDArray, load: Any = None) -> "FollowedPunches":
        body = self.task.body.loaded(load)
        loads = np.broadcast_to(body.load, g.shape).tolist()
        found = [self._state(*state) for state in zip(g.tolist(), loads)]
        return FollowedPunches(self.task, g, found, body)

    def _solve(self, g: float, load: float) -> FollowedState:
        task = alone(self.task, load)
        return solved(self.work, task, g, self._near(g, load, task), self._done)

    def _near(self, g: float, load: float, task: Task) -> float:
        """Half-width [m] to begin with: of the nearest state, or that at rest."""
        same = [
            (abs(other - g), state.half_width) for (other, N), state in self._known.items() if load == N
        ]
        return min(same)[1] if same else float(task.body.half_width)


class FollowedPunches(OnOwnMeshes):
    """Punches over layers with several frictions and loads."""

    @property
    def places(self) -> Places:
        """Where stresses are."""
        return self.task.places

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
        return np.array([state.half_width for state in self.found])

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return np.array([state.centre for state in self.found])

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, (states,)."""
        each = [state.level.pressure.σ_YY for state in self.found]
        return largest(lambda x: np.concatenate([-σ_YY(x) for σ_YY in each]), lambda i, x: -each[i](x)[0])

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return np.stack([state.interfaces for state in self.found], axis=1)

    @cached_property
    def σ_ZZ(self) -> NDArray[np.float64]:
        """Normal stress out of the plane at points inside, (states, m)."""
        Y = self.places.points[:, 1]
        return np.array(
            [state.task.body.σ_ZZ(self.inside[:, i], Y) for i, state in enumerate(self.found)]
        )
