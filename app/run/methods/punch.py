"""Mode ``contact`` at one speed: a rigid punch, the pressure unknown, the degree found by measuring."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.displacement import Displacement
from galinx.app.run.methods.fem import FiniteElements
from galinx.meshes.kind import DEGREES
from galinx.postprocess.estimate import differences, remaining
from galinx.postprocess.pressure import (
    ContactRecovery,
    JacobiPressure,
    contact_recovery,
    from_moments,
)
from galinx.solvers.fem.punch import ContactStates, SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solution import Body, Surface

#: Change of the contact forces over the tolerance, and at most, for which no solution is refined. The
#: most keeps results on any number of ranks equal to 1e-9.
NEGLIGIBLE, NEGLIGIBLE_MOST = 1e-4, 1e-10

#: States, spread over all of a speed, whose measured error decides the degree.
PROBES = 9

#: Levels that are held at once: two differences measure the error.
_HELD = 3


@contextmanager
def solver(work: FiniteElements, task: Task, g: NDArray) -> Iterator["PunchesAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    ladder = Ladder(work, task)
    try:
        error = climb(ladder, g)
        yield PunchesAtSpeed(ladder, error)
    finally:
        ladder.destroy()


@contextmanager
def one_state(
    work: FiniteElements, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray]]:
    """Space, fields and weights of one state."""
    space = work.space(degree, work.plan.cuts)
    punch = SlidingPunch(space, task.response, work.plan.solver, height=profile_on(space, task.body))
    try:
        weights = punch.states(g).weights[0]  # the fields are complete after this
        yield space, punch.fields, weights
    finally:
        punch.destroy()


def profile_on(space: Space, body: Body) -> NDArray[np.float64] | None:
    """The punch's height over N/(2μ) at the contact nodes; None for a flat punch, which needs none."""
    return None if body.flat else body.height(space.chart.surface_position(space.contact.s))


@dataclass(frozen=True)
class Level:
    """A punch at one degree, and the maps that read its contact forces."""

    punch: SlidingPunch
    recovery: ContactRecovery

    def pressure(self, states: ContactStates, local: FlatPunch) -> JacobiPressure:
        """Pressure from its Jacobi moments, whose weight has the exponents of the local analysis."""
        return from_moments(states.normal @ self.recovery.moments, local.α, local.β)


class Ladder:
    """Punches of rising degree, or on meshes cut more and more finely, at one speed.

    Args:
        work: gives spaces.
        task: the speed.

    Attributes:
        degree: of the last level.
        levels: the last ones.
    """

    def __init__(self, work: FiniteElements, task: Task) -> None:
        self.work, self.task, self.degree = work, task, work.plan.degrees[task.number]
        self.levels: list[Level] = []
        self._work = _Work()

    def add(self, g: NDArray, degree: int, cuts: int = 1) -> None:
        """Solve at a degree for all values of g; the factor before makes room."""
        for level in self.levels[-1:]:
            level.punch.release()
        plan, response = self.work.plan, self.task.response
        space = self.work.space(degree, cuts)
        negligible = min(NEGLIGIBLE * plan.tolerance, NEGLIGIBLE_MOST)
        height = profile_on(space, self.task.body)
        punch = SlidingPunch(space, response, plan.solver, negligible, height)
        recovery = contact_recovery(space.contact.s, degree, space.chart, self.task.places.X)
        # The basis is complete before traces are taken, and the same whatever states are still to do.
        for first in range(0, len(g), self.work.chunk):
            punch.states(g[first : first + self.work.chunk])
        self.levels.append(Level(punch, recovery))
        self.degree = degree
        if len(self.levels) > _HELD:
            old = self.levels.pop(0).punch
            self._work.count(old)
            old.destroy()

    def record(self) -> dict[str, Any]:
        """Numbers of the work on all levels, and the size of the last."""
        total = _Work(**vars(self._work))
        for level in self.levels:
            total.count(level.punch)
        space = self.levels[-1].punch.space
        return {"cells": space.cells, "unknowns": space.size, "degree": space.degree} | vars(total)

    def destroy(self) -> None:
        for level in self.levels:
            level.punch.destroy()


@dataclass
class _Work:
    """Numbers of linear algebra, as they are archived."""

    factorisations: int = 0
    back_substitutions: int = 0
    iterations: int = 0
    largest_residual: float = 0.0
    largest_condition: float = 0.0

    def count(self, punch: SlidingPunch) -> None:
        factor = punch.factor
        self.factorisations += 1
        self.back_substitutions += factor.solves
        self.iterations = max(self.iterations, factor.iterations)
        self.largest_residual = max(self.largest_residual, factor.largest_residual)
        self.largest_condition = max(self.largest_condition, factor.condition)


def climb(ladder: Ladder, g: NDArray) -> "MeasuredError":
    """Raise the degree until the measured error of sample states is within tolerance.

    Args:
        ladder: without a level.
        g: the speed's values of σ_XY/σ_YY, sorted.
    """
    plan, top = ladder.work.plan, ladder.degree
    for step in (2, 1, 0):
        if plan.fixed:
            ladder.add(g, top, plan.cuts >> step)
        else:
            ladder.add(g, top - step)
    probes = g[np.unique(np.linspace(0, len(g) - 1, PROBES).astype(int))]
    error = MeasuredError(ladder, probes)
    changes = dict(error.changes)
    # Where the outer radius alone spoils the tolerance, the cells need not do better than it.
    enough = max(plan.tolerance, 1.1 * error.truncation(probes).max())
    while not plan.fixed and ladder.degree < DEGREES[1] and error.of(probes).max() > enough:
        ladder.add(g, ladder.degree + 1)
        error = MeasuredError(ladder, probes)
        changes |= error.changes
    error.changes = changes
    return error


class MeasuredError:
    """How far the last of three levels is off, by what changed from level to level.

    Args:
        ladder: with three levels.
        probes: values of σ_XY/σ_YY that stand for all of the speed.

    Attributes:
        changes: largest change of the probes from the degree before, by degree; none at a fixed degree.
    """

    def __init__(self, ladder: Ladder, probes: NDArray) -> None:
        self._ladder = ladder
        self._sample = self._differences(probes)
        self._rounding = self._asymmetry(probes)
        self.changes: dict[int, float] = {}
        if not ladder.work.plan.fixed:
            degrees = (ladder.degree - 1, ladder.degree)
            self.changes = {p: float(found.max()) for p, found in zip(degrees, self._sample)}

    def of(self, g: NDArray) -> NDArray[np.float64]:
        """Estimated relative error of K_I and of the pressure's moments, (states,)."""
        left = remaining(*self._differences(g), self._sample)
        return left + self.truncation(g) + self._rounding

    def truncation(self, g: NDArray) -> NDArray[np.float64]:
        """Estimated relative error from the finite outer radius, (states,)."""
        plan, response = self._ladder.work.plan, self._ladder.task.response
        return plan.kind.truncation(plan.tolerance, response.margin) * np.abs(g)

    def _differences(self, g: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        coarse, middle, fine = (self._measured(level, g) for level in self._ladder.levels)
        return differences(coarse, middle), differences(middle, fine)

    def _measured(self, level: Level, g: NDArray) -> NDArray[np.float64]:
        """What the error is measured on, each about 1: (states, several)."""
        states = level.punch.states(g)
        K_I = level.pressure(states, FlatPunch(self._ladder.task.response, g)).K_I
        moments = states.normal @ level.recovery.moments[:, 1:6]
        return np.column_stack([K_I * np.pi, moments / 2.0])

    def _asymmetry(self, g: NDArray) -> float:
        """Largest relative difference of K_I left at g and right at -g, which only rounding makes.

        Of a flat punch, since a profile need not be its own mirror image.
        """
        level, response = self._ladder.levels[-1], self._ladder.task.response
        K_I, mirrored = (
            level.pressure(level.punch.states(sign * g, flat=True), FlatPunch(response, sign * g)).K_I
            for sign in (1.0, -1.0)
        )
        return float(np.abs(K_I - mirrored[:, ::-1]).max() * np.pi)


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
