"""Mode ``traction`` at one speed: σ_YY put in, σ_XY = g σ_YY."""

from collections.abc import Callable, Iterator
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
    """Solve for every load; a pressure of the user's own is one load for every g."""
    # One degree above the rule: no measured error corrects it here.
    loaded = LoadedHalfPlane(work.space(work.plan.degrees[task.number] + 1), task.response)
    try:
        pressures = Pressures(task, work.plan.pressure)
        columns = {}
        for value in dict.fromkeys(map(pressures.key, g.tolist())):
            columns[value] = len(loaded.fields)
            loaded.load(pressures.at(value))
        yield LoadsAtSpeed(task, loaded, pressures, columns)
    finally:
        loaded.destroy()


@contextmanager
def one_state(
    work: Discretisation, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray]]:
    """Space, fields and weights of one state."""
    loaded = LoadedHalfPlane(work.space(degree), task.response)
    try:
        loaded.load(Pressures(task, work.plan.pressure).at(g))
        yield loaded.space, loaded.fields, np.array([1.0, g])
    finally:
        loaded.destroy()


@dataclass(frozen=True)
class Pressures:
    """What is put in at one speed.

    Attributes:
        task: the speed.
        given: ``"closed_form"``, or pairs [X/a, σ_YY/(N/2a)].
    """

    task: Task
    given: Any

    def key(self, g: float) -> float:
        """What tells loads apart: a pressure of the user's own is the same for every g."""
        return g if self.given == "closed_form" else 0.0

    def at(self, g: float) -> Callable[[NDArray, NDArray], NDArray]:
        """σ_YY by the distances from both edges."""
        if self.given == "closed_form":
            return FlatPunch(self.task.response, g).σ_YY_by_distance
        X, σ = np.array(self.given).T
        return lambda left, right: np.interp(np.where(left < right, left - 1.0, 1.0 - right), X, σ)


class LoadsAtSpeed:
    """Loads at one speed, solved.

    Args:
        task: the speed.
        loaded: the half-plane with all loads.
        pressures: what they are.
        columns: the first of a load's two fields, by the load's key.
    """

    def __init__(
        self, task: Task, loaded: LoadedHalfPlane, pressures: Pressures, columns: dict[float, int]
    ) -> None:
        self.task, self.loaded, self.pressures, self.columns = task, loaded, pressures, columns
        self.displacement = Displacement(task, loaded.space, loaded.fields)

    def states(self, g: NDArray) -> "GivenLoads":
        columns = np.array([self.columns[self.pressures.key(value)] for value in g.tolist()])
        return GivenLoads(self, g, columns)

    def record(self) -> dict[str, Any]:
        space, factor = self.loaded.space, self.loaded.factor
        return {
            "cells": space.cells,
            "unknowns": space.size,
            "degree": space.degree,
            "factorisations": 1,
            "back_substitutions": factor.solves,
            "iterations": factor.iterations,
            "largest_residual": factor.largest_residual,
            "largest_condition": factor.condition,
        }


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
        places, pressures = self.at.task.places, self.at.pressures
        r = places.X[places.under]
        σ_YY = np.full((len(self.g), len(places.X)), np.nan)
        keys = map(pressures.key, self.g.tolist())
        σ_YY[:, places.under] = [pressures.at(key)(1.0 + r, 1.0 - r) for key in keys]
        return self.at.displacement.surface(self.g, self._weights, σ_YY)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.displacement.inside(self._weights)
