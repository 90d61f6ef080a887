"""One contact with kinks, found, and its degree raised until the measured error is within tolerance."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.error import reached
from galinx.app.run.methods.kinked_ends import Ends
from galinx.app.run.methods.kinked_level import (
    ONE,
    KinkedLevel,
    OwnMeshes,
    places_of_kinks,
)
from galinx.app.run.methods.ladder import WorkDone
from galinx.postprocess.near_ends import turns_at_ends
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.found import Exponents
from galinx.solvers.sie.residual import of_contact
from galinx.solvers.solution import Surface, Turns


@dataclass(frozen=True)
class KinkedState:
    """A solved contact; lengths over its half-width from its middle.

    Attributes:
        task: the speed, and the load.
        ends: of the contact.
        level: the last.
        estimates: relative errors by the word of output.quantities that asks for what they are of.
        record: numbers of the work, as they are archived.
    """

    task: Task
    ends: Ends
    level: KinkedLevel
    estimates: dict[str, float]
    record: dict[str, Any]

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface, of one state."""
        σ_YY = self.level.pressure.σ_YY(self.task.places.X)[None]
        found = self.level.displacement.surface(self.level.contact.g, ONE, σ_YY)
        return replace(found, turns=self._turns(found))

    def _turns(self, surface: Surface) -> Turns:
        """Stresses at both ends, and under kinks where they are finite."""
        level, local = self.level, FlatPunch(self.task.response, self.level.contact.g)
        ends = turns_at_ends(surface, Exponents(local.α + 1.0, local.β + 1.0))
        X, pressure = level.kinks, level.pressure
        σ_YY = np.array([pressure.at_kink(i) for i in range(len(X))])
        u_X = np.array([pressure.limit_at_kink(i, level.displacement.strain) for i in range(len(X))])
        σ_XY = float(level.contact.g[0]) * σ_YY
        under = np.array([self.task.response.σ_XX(u_X, σ_YY, σ_XY), σ_YY, σ_XY])
        return ends.joined(Turns(X[None], under[:, None]))

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, m)."""
        return self.level.displacement.inside(ONE)[:, 0]

    @cached_property
    def largest(self) -> tuple[float, float]:
        """Largest pressure over N/(2a), and its place over a."""
        return self.level.pressure.largest()

    @cached_property
    def residual(self) -> float:
        """What the pressure leaves of the integral equation, relative."""
        level, ends, one = self.level, self.ends, np.ones(1)
        local = FlatPunch(self.task.response, level.contact.g)
        left = of_contact(
            self.task.response, level.contact.g, Exponents(local.α + 1.0, local.β + 1.0), self.task.body,
            lambda r: level.pressure.σ_YY(r)[None], (ends.centre * one, ends.half_width * one),
            level.pressure.kinks, level.pressure.breaks,
        )  # fmt: skip
        return float(left[0])

    def at(self, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (..., 2) over a, (3, ...)."""
        found = self.level.displacement.at(points.reshape(1, -1, 2), ONE)
        return found.reshape(3, *points.shape[:-1])

    def destroy(self) -> None:
        self.level.destroy()


def solved(work: Discretisation, task: Task, g: float, ends: Ends, done: WorkDone) -> KinkedState:
    """The contact at a friction.

    Args:
        work: gives spaces.
        task: the speed, and the load.
        g: σ_XY/σ_YY.
        ends: of the contact.
        done: takes the numbers of the work.

    Raises:
        SolveError: cells cannot be graded towards its kinks, or the equations could not be solved.
    """
    places = places_of_kinks(task.body, ends)

    def level(space: Any, _: NDArray) -> KinkedLevel:
        found = KinkedLevel(work, task, space, places, ends, g)
        done.count(found)
        return found

    of_one = np.array([g])
    with reached(OwnMeshes(work, places, task.body), task, of_one, level) as (ladder, error):
        estimates = {word: float(values[0]) for word, values in error.of(of_one).items()}
        last: KinkedLevel = ladder.levels.pop()
    estimates[INTENSITIES] += ends.error
    size = {"cells": last.space.cells, "unknowns": last.space.size, "degree": last.space.degree}
    return KinkedState(task, ends, last, estimates, size | error.record())
