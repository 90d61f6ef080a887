"""A pressure of the user's own at one speed, put in: finite elements, the degree found by measuring."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.meshes.kind import DEGREES
from galinx.postprocess.estimate import differences, remaining
from galinx.solvers.contact import from_edge
from galinx.solvers.fem.linear_loads import LinearLoads
from galinx.solvers.fem.pieces import Pieces
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.traction import LoadedHalfPlane
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.linear import LinearPressure
from galinx.solvers.solution import Surface

#: States, spread over all of a speed, whose measured error decides the degree.
PROBES = 9


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["OwnPressureAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    probes = g[np.unique(np.linspace(0, len(g) - 1, PROBES).astype(int))]
    first = work.plan.degrees[task.number]
    levels = [Level(work, task, degree) for degree in (first - 2, first - 1, first)]
    while True:
        error = MeasuredError(levels[-3:], probes)
        if error.of(probes) <= work.plan.tolerance or levels[-1].degree >= DEGREES[1]:
            break
        levels.append(Level(work, task, levels[-1].degree + 1))
    yield OwnPressureAtSpeed(task, levels, error)


@contextmanager
def one_state(
    work: Discretisation, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray]]:
    """Space, fields and weights of one state: the pressure as a whole, not piece by piece."""
    loaded, pressure = LoadedHalfPlane(work.space(degree), task.response), _put_in(task)
    try:
        loaded.load(
            lambda left, right: pressure(np.where(left < right, left - 1.0, 1.0 - right)),
            pressure.knots[1:-1],
        )
        yield loaded.space, loaded.fields, np.array([1.0, g])
    finally:
        loaded.destroy()


def _put_in(task: Task) -> LinearPressure:
    assert task.body.pressure
    return task.body.pressure


class Level:
    """What finite elements of one degree make of the pressure, for every σ_XY/σ_YY.

    Args:
        work: gives the space.
        task: the speed.
        degree: polynomial degree.

    Attributes:
        degree: the same.
        resultant: of the discrete loads, over N/2.
        looks_inside: are there places inside?
        record: numbers of the linear algebra, by the names of ``quantities.runs.RECORD``.
    """

    def __init__(self, work: Discretisation, task: Task, degree: int) -> None:
        self._task, self.degree = task, degree
        space, pressure, places = work.space(degree), _put_in(task), task.places
        loads, pieces = LinearLoads(space, task.response), Pieces(pressure.knots, pressure.values)
        self.record = {"cells": space.cells, "unknowns": space.size, "degree": degree} | loads.record
        self.resultant = pieces.resultant(loads)
        self.looks_inside = len(places.points) > 0
        self._σ_YY = np.where(places.under, pressure(places.X), np.nan)
        with work.clock("recovery"):
            on_surface = np.column_stack([places.X, np.zeros(len(places.X))])
            # Of σ_YY alone, and of σ_XY equal to it.
            self._on_surface = pieces.gradients(loads, on_surface)[:, :, 0]
            self._inside = pieces.gradients(loads, places.points)

    def surface(self, g: NDArray) -> Surface:
        """The surface of states with these values of σ_XY/σ_YY."""
        u_X, v_X = np.einsum("nid,ds->isn", self._on_surface, np.array([np.ones_like(g), g]))
        σ_YY = np.tile(self._σ_YY, (len(g), 1))
        σ = np.nan_to_num(σ_YY)
        σ_XX = self._task.response.σ_XX(u_X, σ, g[:, None] * σ)
        return Surface(self._task.places, σ_YY, σ_XX, None, v_X)

    def inside(self, g: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY inside of states with these values of σ_XY/σ_YY, (3, states, m)."""
        weights = np.array([np.ones_like(g), g])
        return self._task.response.stresses(np.einsum("nijd,ds->snij", self._inside, weights))


#: Values of a level's states that should not change any more, and their size, both (states, values).
_Measure = Callable[[Level, NDArray], tuple[NDArray, NDArray]]

_TINY = np.finfo(float).tiny


def _in_plane(level: Level, g: NDArray) -> tuple[NDArray, NDArray]:
    surface = level.surface(g)
    size = np.abs(surface.σ_XX)
    away = from_edge(surface.places.X) >= 1e-2
    return surface.σ_XX, np.maximum(size, size[:, away].max(axis=1, keepdims=True))


def _inside(level: Level, g: NDArray) -> tuple[NDArray, NDArray]:
    stresses = np.concatenate(level.inside(g), axis=1)
    return stresses, np.abs(stresses).max(axis=1, keepdims=True)


class MeasuredError:
    """How far the last of three levels is off, by what changed from level to level.

    Args:
        levels: of successive degrees.
        probes: values of σ_XY/σ_YY that stand for all of the speed.
    """

    def __init__(self, levels: list[Level], probes: NDArray) -> None:
        self._levels = levels
        self._in_plane = self._changes(_in_plane, probes)
        self._inside = self._changes(_inside, probes) if levels[-1].looks_inside else None

    def of(self, g: NDArray) -> float:
        """The largest of both."""
        return float(max(self.in_plane(g).max(), self.inside(g).max()))

    def in_plane(self, g: NDArray) -> NDArray[np.float64]:
        """Of σ_XX on the surface, over its size there or its largest away from the ends, (states,)."""
        return remaining(*self._changes(_in_plane, g), self._in_plane)

    def inside(self, g: NDArray) -> NDArray[np.float64]:
        """Of the stresses inside, over the largest of a state, (states,); 0 where none are asked for."""
        if self._inside is None:
            return np.zeros(len(g))
        return remaining(*self._changes(_inside, g), self._inside)

    def _changes(self, measure: _Measure, g: NDArray) -> tuple[NDArray, NDArray]:
        found = [measure(level, g) for level in self._levels]
        coarse, middle, fine = (values / np.maximum(found[-1][1], _TINY) for values, _ in found)
        return differences(coarse, middle), differences(middle, fine)


class OwnPressureAtSpeed:
    """A pressure put in at one speed.

    Args:
        task: the speed.
        levels: all that were solved.
        error: of the last.
    """

    def __init__(self, task: Task, levels: list[Level], error: MeasuredError) -> None:
        self.task, self.level, self.error = task, levels[-1], error
        self._levels = levels

    def states(self, g: NDArray) -> "OwnPressures":
        return OwnPressures(self, g)

    def record(self) -> dict[str, Any]:
        records = [level.record for level in self._levels]
        return (
            records[-1]
            | {name: max(record[name] for record in records) for name in _LARGEST}
            | {name: sum(record[name] for record in records) for name in _TOTAL}
        )


_LARGEST = ("iterations", "largest_residual", "largest_condition")
_TOTAL = ("factorisations", "back_substitutions")


@dataclass(frozen=True)
class OwnPressures:
    """States with a pressure of the user's own.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
    """

    at: OwnPressureAtSpeed
    g: NDArray[np.float64]

    @property
    def local(self) -> FlatPunch:
        return FlatPunch(self.at.task.response, self.g)

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.full(len(self.g), self.at.level.resultant)

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self.g * self.normal_force

    @property
    def estimate_in_plane(self) -> NDArray[np.float64]:
        """Of σ_XX on the surface, see :class:`MeasuredError`, (states,)."""
        return self.at.error.in_plane(self.g)

    @property
    def estimate_inside(self) -> NDArray[np.float64]:
        """Of the stresses inside, (states,)."""
        return self.at.error.inside(self.g)

    @cached_property
    def surface(self) -> Surface:
        return self.at.level.surface(self.g)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.level.inside(self.g)
