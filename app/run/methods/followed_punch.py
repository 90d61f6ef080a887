"""Punches over layers whose contact ends where the pressure says, by finite elements.

Layers have a length, so each contact has a mesh drawn for its half-width. That is found by solving on a
few of them, at a lower degree at first, until the load that makes a contact of that size is the one
wanted; then the degree rises until the measured error is within tolerance.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import OWN_MESHES_KEPT, Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.followed_state import FollowedState, solved
from galinx.app.run.methods.kinked_ends import alone
from galinx.app.run.methods.ladder import WorkDone
from galinx.postprocess.largest import largest
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.found import Exponents
from galinx.solvers.solution import Body, Places, Surface


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["FollowedAtSpeed"]:
    """States are solved when they are asked for, each on meshes of its own."""
    at = FollowedAtSpeed(work, task)
    try:
        yield at
    finally:
        at.destroy()


class FollowedAtSpeed:
    """Contacts at one speed.

    Args:
        work: gives spaces.
        task: the speed.
    """

    def __init__(self, work: Discretisation, task: Task) -> None:
        self.work, self.task = work, task
        self._record: dict[str, Any] = {"cells": 0, "unknowns": 0, "degree": 0}
        self._done = WorkDone()
        #: By σ_XY/σ_YY and load, those that were asked for last at last.
        self._known: dict[tuple[float, float], FollowedState] = {}

    def states(self, g: NDArray, load: Any = None) -> "FollowedPunches":
        body = self.task.body.loaded(load)
        loads = np.broadcast_to(body.load, g.shape).tolist()
        found = [self._state(*state) for state in zip(g.tolist(), loads)]
        return FollowedPunches(self.task, g, found, body)

    def record(self) -> dict[str, Any]:
        return self._record | vars(self._done)

    def destroy(self) -> None:
        """Free what states hold."""
        for state in self._known.values():
            state.destroy()

    def _state(self, g: float, load: float) -> FollowedState:
        state = self._known.pop((g, load), None)
        if state is None:
            task = alone(self.task, load)
            state = solved(self.work, task, g, self._near(g, load, task), self._done)
            for name, value in state.record.items():
                self._record[name] = max(self._record.get(name, value), value)
        self._known[g, load] = state
        while len(self._known) > OWN_MESHES_KEPT:
            self._known.pop(next(iter(self._known))).destroy()
        return state

    def _near(self, g: float, load: float, task: Task) -> float:
        """Half-width [m] to begin with: of the nearest state, or that at rest."""
        same = [
            (abs(other - g), state.half_width) for (other, N), state in self._known.items() if load == N
        ]
        return min(same)[1] if same else float(task.body.half_width)


@dataclass(frozen=True)
class FollowedPunches:
    """Punches with several frictions and loads, each with its own half-width and middle.

    Attributes:
        task: their speed.
        g: σ_XY/σ_YY, (states,).
        found: of each.
        body: what slides over what, under the load of each.
    """

    task: Task
    g: NDArray[np.float64]
    found: list[FollowedState]
    body: Body

    @cached_property
    def local(self) -> Exponents:
        """Exponents at the ends."""
        flat = FlatPunch(self.task.response, self.g)
        return Exponents(flat.α + 1.0, flat.β + 1.0)

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

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At the left and the right end: none, by condition, (states, 2)."""
        return np.zeros((len(self.g), 2))

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, (states,)."""
        each = [state.level.pressure.σ_YY for state in self.found]
        return largest(lambda x: np.concatenate([-σ_YY(x) for σ_YY in each]), lambda i, x: -each[i](x)[0])

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.array([state.level.contact.normal.sum() for state in self.found])

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.array([state.level.contact.tangential.sum() for state in self.found])

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        words = self.found[0].estimates
        return {word: np.array([state.estimates[word] for state in self.found]) for word in words}

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface."""
        each = [state.surface for state in self.found]
        σ_YY, σ_XX, v_X = (
            np.array([getattr(one, name)[0] for one in each]) for name in ("σ_YY", "σ_XX", "v_X")
        )
        return Surface(self.task.places, σ_YY, σ_XX, None, v_X)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return np.stack([state.inside for state in self.found], axis=1)

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
