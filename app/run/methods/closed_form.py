"""The closed form of the singular integral equation."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.plan import Task
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solution import Surface


class ClosedForm:
    """Every task has its solution at once."""

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator["FlatPunchAtSpeed"]:
        yield FlatPunchAtSpeed(task)


@dataclass(frozen=True)
class FlatPunchAtSpeed:
    """Flat punches at one speed."""

    task: Task

    def states(self, g: NDArray) -> "FlatPunches":
        return FlatPunches(self.task, g)

    def record(self) -> dict[str, Any]:
        return {}


@dataclass(frozen=True)
class FlatPunches:
    """Flat punches with several frictions, exact.

    Attributes:
        task: their speed.
        g: σ_XY/σ_YY, (states,).
    """

    task: Task
    g: NDArray[np.float64]

    @cached_property
    def local(self) -> FlatPunch:
        """The punches; at an edge there is nothing else."""
        return FlatPunch(self.task.response, self.g)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """Stress intensity factor of both ends, (states,)."""
        return self.local.K_I

    @cached_property
    def _over_places(self) -> FlatPunch:
        return FlatPunch(self.task.response, self.g[:, None])

    @cached_property
    def surface(self) -> Surface:
        places = self.task.places
        σ_YY = np.where(places.under, self._over_places.σ_YY(places.X), np.nan)
        return Surface(places, σ_YY, self._over_places.σ_XX(places.X))

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self._over_places.inside(*self.task.places.points.T)
