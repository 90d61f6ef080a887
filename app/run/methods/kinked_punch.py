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

from galinx.app.plan.task import OWN_MESHES_KEPT, Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.kinked_ends import EndsAtSpeed, alone, ends_at_speed
from galinx.app.run.methods.kinked_state import KinkedState, solved
from galinx.app.run.methods.ladder import WorkDone
from galinx.postprocess.yielding.strength import Strength
from galinx.solvers.profiles import jumps
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.found import Exponents
from galinx.solvers.solution import Body, Surface


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["KinkedAtSpeed"]:
    """States are solved when they are asked for, each on meshes of its own."""
    with ends_at_speed(work.for_ends, task, g) as ends:
        at = KinkedAtSpeed(work, task, ends)
        try:
            yield at
        finally:
            at.destroy()


class KinkedAtSpeed:
    """Contacts at one speed.

    Args:
        work: gives spaces.
        task: the speed.
        ends: of all its contacts.
    """

    def __init__(self, work: Discretisation, task: Task, ends: EndsAtSpeed) -> None:
        self.work, self.task, self._ends = work, task, ends
        self._record: dict[str, Any] = {"cells": 0, "unknowns": 0, "degree": 0}
        self._done = WorkDone()
        #: By σ_XY/σ_YY and load, those that were asked for last at last.
        self._known: dict[tuple[float, float], KinkedState] = {}

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

    def destroy(self) -> None:
        """Free what states hold."""
        for state in self._known.values():
            state.destroy()

    def _state(self, g: float, load: float) -> KinkedState:
        state = self._known.pop((g, load), None)
        if state is None:
            ends, task = self._ends.of(g, load), alone(self.task, load)
            state = solved(self.work, task, g, ends, self._done)
            self._told(state.record)
        self._known[g, load] = state
        while len(self._known) > OWN_MESHES_KEPT:
            self._known.pop(next(iter(self._known))).destroy()
        return state

    def _told(self, record: dict[str, Any]) -> None:
        """The largest of what states have."""
        for name, value in record.items():
            self._record[name] = max(self._record.get(name, value), value)


@dataclass(frozen=True)
class KinkedPunches:
    """Punches with several frictions and loads, each with its own half-width and middle.

    Attributes:
        task: their speed.
        g: σ_XY/σ_YY, (states,).
        found: of each; of some loads the same where contacts are alike.
        body: what slides over what, under the load of each.
        growth: half-width of each over that of what was found, (states,).
    """

    task: Task
    g: NDArray[np.float64]
    found: list[KinkedState]
    body: Body
    growth: NDArray[np.float64]

    @cached_property
    def local(self) -> Exponents:
        """Exponents at the ends."""
        flat = FlatPunch(self.task.response, self.g)
        return Exponents(flat.α + 1.0, flat.β + 1.0)

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
        return self.growth * [state.ends.half_width for state in self.found]

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self.growth * [state.ends.centre for state in self.found]

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At the left and the right end: none, by condition, (states, 2)."""
        return np.zeros((len(self.g), 2))

    @property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        if jumps(self.body.profile):
            return np.full(len(self.g), np.nan), np.full(len(self.g), np.nan)
        values, places = np.array([state.largest for state in self.found]).T
        return values, places

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.array([state.level.contact.normal.sum() for state in self.found])

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.array([state.level.contact.tangential.sum() for state in self.found])

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation of the punch's lowest point over N/(2μ), (states,)."""
        return np.array([state.level.contact.v0[0] for state in self.found])

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        words = self.found[0].estimates
        return {word: np.array([state.estimates[word] for state in self.found]) for word in words}

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface."""
        each = [state.surface for state in self.found]
        σ_YY, σ_XX, v_X = (np.array([getattr(one, name)[0] for one in each]) for name in _ON_SURFACE)
        return Surface(self.task.places, σ_YY, σ_XX, None, v_X)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return np.stack([state.inside for state in self.found], axis=1)

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        return Strength(
            self._stresses, self.body, self.task.response, self.g, self.local, self.half_width
        )

    def _stresses(self, points: NDArray) -> NDArray[np.float64]:
        """At points of all states, (1, n, 2), or of each, (states, n, 2): (3, states, n)."""
        each = np.broadcast_to(points, (len(self.g), *points.shape[1:]))
        found = [state.at(some) for state, some in zip(self.found, each)]
        return np.stack(found, axis=1)


#: What is known of every surface.
_ON_SURFACE = ("σ_YY", "σ_XX", "v_X")
