"""Punches of rising degree at one speed: what the error is measured on."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.postprocess.pressure import (
    ContactRecovery,
    JacobiPressure,
    contact_recovery,
    from_moments,
)
from galinx.solvers.fem.punch import ContactStates, SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solution import Body

#: Change of the contact forces over the tolerance, and at most, for which no solution is refined. The
#: most keeps results on any number of ranks equal to 1e-9.
NEGLIGIBLE, NEGLIGIBLE_MOST = 1e-4, 1e-10

#: Levels that are held at once: two differences measure the error.
_HELD = 3


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

    def __init__(self, work: Discretisation, task: Task) -> None:
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
