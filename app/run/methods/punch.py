"""Mode ``contact`` at one speed: a rigid punch, the pressure unknown, the degree found by measuring."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.displacement import Displacement
from galinx.app.run.methods.error import MeasuredError, climb
from galinx.app.run.methods.ladder import Ladder, profile_on
from galinx.meshes.kind import DEGREES
from galinx.postprocess.pressure import JacobiPressure
from galinx.solvers.fem.punch import ContactStates, SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solution import Surface


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["PunchesAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    ladder = Ladder(work, task)
    try:
        error = climb(ladder, g)
        yield PunchesAtSpeed(ladder, error)
    finally:
        ladder.destroy()


@contextmanager
def one_state(
    work: Discretisation, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray]]:
    """Space, fields and weights of one state."""
    space = work.space(degree, work.plan.cuts)
    punch = SlidingPunch(space, task.response, work.plan.solver, height=profile_on(space, task.body))
    try:
        weights = punch.states(g).weights[0]  # the fields are complete after this
        yield space, punch.fields, weights
    finally:
        punch.destroy()


class PunchesAtSpeed:
    """Rigid punches at one speed, their pressure found to the tolerance.

    Args:
        ladder: climbed.
        error: of its last level.
    """

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        self.task, self.level, self.error = ladder.task, ladder.levels[-1], error
        self.displacement = Displacement(ladder.task, self.level.punch.space, self.level.punch.fields)
        self._ladder = ladder

    def states(self, g: NDArray) -> "Punches":
        return Punches(self, g, self.level.punch.states(g))

    def record(self) -> dict[str, Any]:
        changes = np.zeros(DEGREES[1] + 1)
        for degree, change in self.error.changes.items():
            changes[degree] = change
        told = changes.tolist() if changes.any() else []
        return self._ladder.record() | {"change_by_degree": told}


@dataclass(frozen=True)
class Punches:
    """Rigid punches with several frictions.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
        contact: nodal forces and weights.
    """

    at: PunchesAtSpeed
    g: NDArray[np.float64]
    contact: ContactStates

    @cached_property
    def local(self) -> FlatPunch:
        return FlatPunch(self.at.task.response, self.g)

    @cached_property
    def _pressure(self) -> JacobiPressure:
        return self.at.level.pressure(self.contact, self.local)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At X = -a and X = a, (states, 2)."""
        return self._pressure.K_I

    @cached_property
    def exponents(self) -> NDArray[np.float64]:
        """At X = a and X = -a, fitted from the raw pressure, (states, 2)."""
        return self.at.level.recovery.exponents(self.contact.normal)

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self.contact.normal.sum(axis=1)

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self.contact.tangential.sum(axis=1)

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation over N/(2μ), (states,)."""
        return self.contact.v0

    @cached_property
    def estimate(self) -> NDArray[np.float64]:
        """Relative error of K_I and moments, (states,)."""
        return self.at.error.of(self.g)

    @cached_property
    def surface(self) -> Surface:
        σ_YY = self._pressure.σ_YY(self.at.task.places.X)
        raw = self.contact.normal @ self.at.level.recovery.raw
        return self.at.displacement.surface(self.g, self.contact.weights, σ_YY, raw)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.displacement.inside(self.contact.weights)
