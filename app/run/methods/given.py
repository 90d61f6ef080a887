"""Mode ``traction`` at one speed: the closed form's σ_YY put in, σ_XY = g σ_YY."""

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
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.traction import LoadedHalfPlane
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solution import Surface


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["LoadsAtSpeed"]:
    """Solve for every load."""
    # One degree above the rule: no measured error corrects it here.
    loaded = LoadedHalfPlane(work.space(work.plan.degrees[task.number] + 1), task.response)
    try:
        columns = {}
        for value in g.tolist():
            columns[value] = len(loaded.fields)
            loaded.load(FlatPunch(task.response, value).σ_YY_by_distance)
        yield LoadsAtSpeed(task, loaded, columns)
    finally:
        loaded.destroy()


@contextmanager
def one_state(
    work: Discretisation, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray]]:
    """Space, fields and weights of one state."""
    loaded = LoadedHalfPlane(work.space(degree), task.response)
    try:
        loaded.load(FlatPunch(task.response, g).σ_YY_by_distance)
        yield loaded.space, loaded.fields, np.array([1.0, g])
    finally:
        loaded.destroy()


class LoadsAtSpeed:
    """Loads at one speed, solved.

    Args:
        task: the speed.
        loaded: the half-plane with all loads.
        columns: the first of a load's two fields, by σ_XY/σ_YY.
    """

    def __init__(self, task: Task, loaded: LoadedHalfPlane, columns: dict[float, int]) -> None:
        self.task, self.loaded, self.columns = task, loaded, columns
        self.displacement = Displacement(task, loaded.space, loaded.fields)

    def states(self, g: NDArray) -> "GivenLoads":
        columns = np.array([self.columns[value] for value in g.tolist()])
        return GivenLoads(self, g, columns)

    def record(self) -> dict[str, Any]:
        space = self.loaded.space
        size = {"cells": space.cells, "unknowns": space.size, "degree": space.degree}
        return size | self.loaded.record


@dataclass(frozen=True)
class GivenLoads:
    """States with given pressure.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
        columns: the first of each state's two fields, (states,).
    """

    at: LoadsAtSpeed
    g: NDArray[np.float64]
    columns: NDArray[np.int64]

    @property
    def local(self) -> FlatPunch:
        return FlatPunch(self.at.task.response, self.g)

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.array(self.at.loaded.resultants)[self.columns // 2]

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self.g * self.normal_force

    @cached_property
    def _weights(self) -> NDArray[np.float64]:
        weights = np.zeros((len(self.g), len(self.at.loaded.fields)))
        rows = np.arange(len(self.g))
        weights[rows, self.columns], weights[rows, self.columns + 1] = 1.0, self.g
        return weights

    @cached_property
    def surface(self) -> Surface:
        places = self.at.task.places
        r = places.X[places.under]
        σ_YY = np.full((len(self.g), len(places.X)), np.nan)
        response = self.at.task.response
        σ_YY[:, places.under] = FlatPunch(response, self.g[:, None]).σ_YY_by_distance(1.0 + r, 1.0 - r)
        return self.at.displacement.surface(self.g, self._weights, σ_YY)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.displacement.inside(self._weights)
