"""Prescribed pressures by finite elements at one speed, the degree raised by the measured error.

The pressure is the user's own, σ_XY = g σ_YY: over a uniform half-plane piece by piece between its knots
(:class:`PiecesLevel`), over layers as a whole on cells graded towards its knots (:class:`LoadsLevel`). In
mode ``traction`` it is that of a flat punch by its closed form (:class:`LoadsAtDegree`).
"""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..contact import BELOW, ON_SURFACE, YIELD
from ..contact.closed_form import FlatPunch
from ..contact.free_ends import turns_at_knots
from ..contact.method import Pressure
from ..contact.prescribed_pressure import LinearPressure
from ..contact.solution import Body, Places, Surface, Task
from ..contact.yielding import Strength
from ..rays import NEAR, rays
from .discretisation import Discretisation
from .displacement import Displacement
from .fields import TOGETHER, SurfaceSlopes
from .ladder import (
    Gauge,
    Ladder,
    MeasuredError,
    StressGauges,
    gauged,
    of_in_plane,
    of_inside,
    solved_to_tolerance,
)
from .space import Space
from .traction import LinearLoads, LoadedHalfPlane, Pieces


class PrescribedAtSpeed:
    """Prescribed pressure at one speed, solved to the tolerance.

    Args:
        ladder: ladder at its last level.
        error: error of that level.
    """

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        self.task, self.level, self.error = ladder.task, ladder.levels[-1], error
        self._ladder = ladder

    def record(self) -> dict[str, Any]:
        return self._ladder.record() | self.error.record()


@dataclass(frozen=True)
class PrescribedStates:
    """States under a prescribed pressure.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
        body: the sliding contact, under the load of each state.
    """

    at: Any
    g: NDArray[np.float64]
    body: Body

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Normal force over N/2, (states,)."""
        return np.full(len(self.g), self.at.level.resultant)

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Tangential force over N/2, (states,)."""
        return self.g * self.normal_force

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by word of output.quantities."""
        errors: dict[str, NDArray[np.float64]] = self.at.error.of(self.g)
        return errors


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["PiecesAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with solved_to_tolerance(work, task, g, lambda space, _: PiecesLevel(work, task, space)) as (
        ladder,
        error,
    ):
        yield PiecesAtSpeed(ladder, error)


@contextmanager
def one_state(
    work: Discretisation, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray, Pressure]]:
    """Space, fields, weights and pressure of one state: the pressure as a whole, not piece by piece."""
    # A kink inside a cell spoils that and its neighbours: halved, they reach less far.
    loaded, pressure = LoadedHalfPlane(work.space(degree, cuts=2), task.response), _pressure_of(task)
    try:
        loaded.load(
            lambda left, right: pressure(np.where(left < right, left - 1.0, 1.0 - right)),
            pressure.knots[1:-1],
        )
        yield loaded.space, loaded.fields, np.array([1.0, g]), pressure
    finally:
        loaded.destroy()


def _pressure_of(task: Task) -> LinearPressure:
    assert task.body.pressure
    return task.body.pressure


class PieceGradients:
    """Displacement gradients at places, under the pressure alone and under an equal σ_XY.

    Args:
        task: the speed, and the places.
        pieces: pieces of the pressure.
        loads: linear loads that make up the pieces.
        words: words of output.quantities that request stresses.
    """

    def __init__(self, task: Task, pieces: Pieces, loads: LinearLoads, words: Collection[str]) -> None:
        self._task, places = task, task.places
        on_surface = np.column_stack([places.X, np.zeros(len(places.X))])
        self._on_surface = pieces.gradients(loads, on_surface[: len(on_surface) * (ON_SURFACE in words)])
        below = places.points[: len(places.points) * (BELOW in words)]
        self._inside = np.concatenate(
            [
                pieces.gradients(loads, below[first : first + TOGETHER])
                for first in range(0, max(len(below), 1), TOGETHER)
            ]
        )
        self._around = pieces.gradients(loads, places.around[: len(places.around) * (YIELD in words)])

    def surface(self, g: NDArray) -> Surface:
        """Stresses on the surface of states with values g of σ_XY/σ_YY, (states,)."""
        places = self._task.places
        u_X, v_X = np.moveaxis(self._on_surface[:, :, 0], 1, 0)
        σ_YY = np.tile(np.where(places.under, _pressure_of(self._task)(places.X), np.nan), (len(g), 1))
        return Surface(places, σ_YY, _in_plane(self._task, u_X, places.X, g), None, (v_X @ _weights(g)).T)

    def inside(self, g: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside of states with values g of σ_XY/σ_YY, (3, states, m)."""
        return self._task.response.stresses(np.einsum("nijd,ds->snij", self._inside, _weights(g)))

    def around(self, g: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at the points checked for yield, (3, states, k)."""
        return self._task.response.stresses(np.einsum("nijd,ds->snij", self._around, _weights(g)))


def _in_plane(task: Task, u_X: NDArray, X: NDArray, g: NDArray) -> NDArray[np.float64]:
    """σ_XX of states on the surface, (states, n), by strains (n, 2) under σ_YY and an equal σ_XY."""
    σ = _pressure_of(task)(X)
    return task.response.σ_XX((u_X @ _weights(g)).T, σ, g[:, None] * σ)


def _weights(g: NDArray) -> NDArray[np.float64]:
    return np.array([np.ones_like(g), g])


class PiecesLevel:
    """Solution of one degree under the pressure, piece by piece, for every σ_XY/σ_YY.

    Args:
        work: has the words of the requested stresses.
        task: the speed.
        space: space of the degree.

    Attributes:
        factor: factor of the linear system, with numbers of its work.
        resultant: resultant of the discrete loads, over N/2.
    """

    def __init__(self, work: Discretisation, task: Task, space: Space) -> None:
        self._work, self._task, self.space = work, task, space
        pressure = _pressure_of(task)
        self._pieces = Pieces(pressure.knots, pressure.values)
        self._loads: LinearLoads | None = LinearLoads(space, task.response)
        self.factor: Any = self._loads.factor
        self.resultant = self._pieces.resultant(self._loads)
        self._gauged = self._gradients_at(gauged(task))

    @cached_property
    def everywhere(self) -> PieceGradients:
        """Gradients at all places; unavailable after the level's release."""
        everywhere = gauged(self._task) is self._task
        return self._gauged if everywhere else self._gradients_at(self._task)

    def _gradients_at(self, task: Task) -> PieceGradients:
        assert self._loads
        with self._work.clock("recovery"):
            return PieceGradients(task, self._pieces, self._loads, self._work.stresses)

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        gauges, words, places = [], self._work.stresses, gauged(self._task).places
        if ON_SURFACE in words:
            gauges.append(of_in_plane(self._gauged.surface(g).σ_XX, places.X))
        if BELOW in words:
            gauges.append(of_inside(self._gauged.inside(g), places.points))
        if YIELD in words:
            gauges.append(of_inside(self._gauged.around(g), places.around, YIELD))
        return gauges

    def at(self, points: NDArray, g: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, states, n), at points (1, n, 2) of all states or (states, n, 2)."""
        assert self._loads
        G = self._pieces.gradients(self._loads, points.reshape(-1, 2))
        G = G.reshape(*points.shape[:2], 2, 2, -1)
        return self._task.response.stresses(G[..., 0] + g[:, None, None, None] * G[..., 1])

    def in_plane(self, X: NDArray, g: NDArray) -> NDArray[np.float64]:
        """σ_XX of all states at positions on the surface, (states, n)."""
        assert self._loads
        G = self._pieces.gradients(self._loads, np.column_stack([X, np.zeros(len(X))]))
        return _in_plane(self._task, G[:, 0, 0], X, g)

    @property
    def mirrored(self) -> bool:
        return True

    def rounding(self, g: NDArray) -> list[float]:
        """Zeros: the mirror image of a load is no load, so rounding is not measured."""
        return [0.0] * len(self.measured(g[:1]))

    def release(self) -> None:
        self._loads = None

    def destroy(self) -> None:
        self._loads = None


class PiecesAtSpeed(PrescribedAtSpeed):
    """Prescribed pressure over a uniform half-plane at one speed."""

    def states(self, g: NDArray, load: Any = None) -> "PiecesStates":
        return PiecesStates(self, g, self.task.body.loaded(load))


class PiecesStates(PrescribedStates):
    """States under a prescribed pressure over a uniform half-plane."""

    @cached_property
    def surface(self) -> Surface:
        level, g = self.at.level, self.g
        turns = turns_at_knots(_pressure_of(self.at.task), g, lambda X: level.in_plane(X, g))
        return replace(level.everywhere.surface(g), turns=turns)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.level.everywhere.inside(self.g)

    @cached_property
    def strength(self) -> Strength:
        """Yield of the states."""
        level, response = self.at.level, self.at.task.response
        return Strength(lambda points: level.at(points, self.g), self.body, response, self.g, None)


@contextmanager
def formula_solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["FormulaAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with solved_to_tolerance(work, task, g, lambda space, g: LoadsAtDegree(work, task, space, g)) as (
        ladder,
        error,
    ):
        yield FormulaAtSpeed(ladder, error)


@contextmanager
def formula_state(
    work: Discretisation, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray, Pressure]]:
    """Space, fields, weights and pressure of one state."""
    loaded = LoadedHalfPlane(work.space(degree), task.response)
    try:
        punch = FlatPunch(task.response, g)
        loaded.load(punch.traction)
        yield loaded.space, loaded.fields, np.array([1.0, g]), punch.σ_YY
    finally:
        loaded.destroy()


class LoadsAtDegree:
    """Solution of one degree under the flat punch's closed-form pressures of all states at a speed.

    Args:
        work: has the words of the requested stresses.
        task: the speed.
        space: space of the degree.
        g: all values of σ_XY/σ_YY that will be solved.
    """

    def __init__(self, work: Discretisation, task: Task, space: Space, g: NDArray) -> None:
        self.task, self.space = task, space
        self.loaded = LoadedHalfPlane(space, task.response)
        #: Index of the first of a load's two fields, by σ_XY/σ_YY.
        self._columns: dict[float, int] = {}
        for value in dict.fromkeys(g.tolist()):
            self._columns[value] = len(self.loaded.fields)
            self.loaded.load(FlatPunch(task.response, value).traction)
        self._gauges = StressGauges(work, task, lambda at: Displacement(at, space, self.loaded.fields))

    @property
    def factor(self) -> Any:
        return self.loaded.factor

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        return self._gauges.of(g, self.weights(g), self.σ_YY(g))

    @property
    def mirrored(self) -> bool:
        return True

    def rounding(self, g: NDArray) -> list[float]:
        """Zeros: the mirror image of a load is no load, so rounding is not measured."""
        return [0.0] * len(self.measured(g[:1]))

    def columns(self, g: NDArray) -> NDArray[np.int64]:
        """Index of the first of each state's two fields, (states,)."""
        return np.array([self._columns[value] for value in g.tolist()])

    def weights(self, g: NDArray) -> NDArray[np.float64]:
        """Weights of the fields, (states, fields)."""
        weights, columns = np.zeros((len(g), len(self.loaded.fields))), self.columns(g)
        rows = np.arange(len(g))
        weights[rows, columns], weights[rows, columns + 1] = 1.0, g
        return weights

    def σ_YY(self, g: NDArray) -> NDArray[np.float64]:
        """Prescribed σ_YY over N/(2a) at the places on the surface, NaN beside the punch, (states, n)."""
        places = self.task.places
        r = places.X[places.under]
        σ_YY = np.full((len(g), len(places.X)), np.nan)
        local = FlatPunch(self.task.response, g[:, None])
        σ_YY[:, places.under] = local.σ_YY_by_distance(1.0 + r, 1.0 - r)
        return σ_YY

    def release(self) -> None:
        self.loaded.destroy()

    def destroy(self) -> None:
        self.loaded.destroy()


class FormulaAtSpeed(PrescribedAtSpeed):
    """Closed-form pressures at one speed, solved to the tolerance."""

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        super().__init__(ladder, error)
        self.displacement = Displacement(ladder.task, self.level.space, self.level.loaded.fields)

    def states(self, g: NDArray, load: Any = None) -> "FormulaStates":
        return FormulaStates(self, g, self.task.body.loaded(load))


class FormulaStates(PrescribedStates):
    """States under the closed-form pressure of a flat punch."""

    @property
    def local(self) -> FlatPunch:
        return FlatPunch(self.at.task.response, self.g)

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Normal force over N/2, (states,)."""
        level = self.at.level
        return np.array(level.loaded.resultants)[level.columns(self.g) // 2]

    @cached_property
    def surface(self) -> Surface:
        level = self.at.level
        return self.at.displacement.surface(self.g, level.weights(self.g), level.σ_YY(self.g))

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.displacement.inside(self.at.level.weights(self.g))

    @property
    def places(self) -> Places:
        """Places at which stresses are evaluated."""
        return self.at.task.places

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return self.at.displacement.interfaces(self.at.level.weights(self.g))

    @cached_property
    def strength(self) -> Strength:
        """Yield of the states."""
        at, weights = self.at, self.at.level.weights(self.g)
        field = at.displacement.at
        return Strength(
            lambda points: field(points, weights), self.body, at.task.response, self.g, self.local
        )


@contextmanager
def layered_solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["LayeredAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with solved_to_tolerance(work, task, g, lambda space, _: LoadsLevel(work, task, space)) as (
        ladder,
        error,
    ):
        yield LayeredAtSpeed(ladder, error)


class _Displacement(Displacement):
    """Displacement with slopes next to knots continued from farther away."""

    @cached_property
    def _slopes(self) -> Any:
        pressure, X = _pressure_of(self._task), self._task.places.X
        jumps = np.zeros(len(pressure.knots), dtype=bool)
        jumps[[0, -1]] = pressure.values[[0, -1]] != 0.0
        near = np.full(len(pressure.knots), NEAR)
        continuation = rays(np.column_stack([X, np.zeros_like(X)]), pressure.knots, near, jumps)
        of_places = continuation.continued(np.eye(len(continuation.owner)))
        slopes = SurfaceSlopes(
            self._space, self._fields, continuation.origins + continuation.offsets[:, 0]
        )
        return _Slopes(slopes, of_places)


@dataclass(frozen=True)
class _Slopes:
    """Slopes continued from sampled places; see :class:`SurfaceSlopes`.

    Attributes:
        slopes: slopes of the fields at sampled places.
        of_places: matrix from slopes there to slopes at the requested places, (requested, places).
    """

    slopes: SurfaceSlopes
    of_places: NDArray[np.float64]

    def of(self, weights: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        u_X, v_X = self.slopes.of(weights)
        return u_X @ self.of_places.T, v_X @ self.of_places.T

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        return self.slopes.rounding(weights) @ np.abs(self.of_places).T


class LoadsLevel:
    """Solution of one degree under the pressure over layers, for every σ_XY/σ_YY.

    Args:
        work: has the words of the requested stresses.
        task: the speed.
        space: space of the degree.
    """

    def __init__(self, work: Discretisation, task: Task, space: Space) -> None:
        self.task, self.space, pressure = task, space, _pressure_of(task)
        self.loaded = LoadedHalfPlane(space, task.response)
        self.loaded.load(
            lambda left, right: pressure(np.where(left < right, left - 1.0, 1.0 - right)),
            pressure.knots[1:-1],
        )
        self._gauges = StressGauges(work, task, self.displaced)

    def displaced(self, task: Task) -> Displacement:
        """Displacement, for stresses at the places of a task."""
        return _Displacement(task, self.space, self.loaded.fields)

    @property
    def factor(self) -> Any:
        return self.loaded.factor

    @property
    def resultant(self) -> float:
        """Resultant of the discrete loads, over N/2."""
        return self.loaded.resultants[0]

    def σ_YY(self, g: NDArray) -> NDArray[np.float64]:
        """Prescribed σ_YY over N/(2a) at the places on the surface, NaN beside it, (states, n)."""
        places = self.task.places
        return np.tile(np.where(places.under, _pressure_of(self.task)(places.X), np.nan), (len(g), 1))

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        return self._gauges.of(g, weights(g), self.σ_YY(g))

    @property
    def mirrored(self) -> bool:
        """False: the mirror image of the knots has another mesh."""
        return False

    def rounding(self, g: NDArray) -> list[float]:
        """Effect of rounding of the fields on each gauge of stresses, relative."""
        return self._gauges.rounding(g, weights(g), self.σ_YY(g))

    def release(self) -> None:
        self.loaded.destroy()

    def destroy(self) -> None:
        self.loaded.destroy()


def weights(g: NDArray) -> NDArray[np.float64]:
    """Weights of both fields, (states, 2)."""
    return np.column_stack([np.ones_like(g), g])


class LayeredAtSpeed(PrescribedAtSpeed):
    """Prescribed pressure over layers at one speed."""

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        super().__init__(ladder, error)
        self.displacement = self.level.displaced(ladder.task)

    def states(self, g: NDArray, load: Any = None) -> "LoadsOnLayers":
        return LoadsOnLayers(self, g, self.task.body.loaded(load))


class LoadsOnLayers(PrescribedStates):
    """States under a prescribed pressure over layers."""

    @property
    def places(self) -> Places:
        """Places at which stresses are evaluated."""
        return self.at.task.places

    @cached_property
    def surface(self) -> Surface:
        g, pressure = self.g, _pressure_of(self.at.task)

        def σ_XX(X: NDArray) -> NDArray[np.float64]:
            there = self.at.level.displaced(replace(self.at.task, places=Places(X, np.empty((0, 2)))))
            return there.surface(g, weights(g), np.tile(pressure(X), (len(g), 1))).σ_XX

        found = self.at.displacement.surface(g, weights(g), self.at.level.σ_YY(g))
        return replace(found, turns=turns_at_knots(pressure, g, σ_XX))

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.displacement.inside(weights(self.g))

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return self.at.displacement.interfaces(weights(self.g))

    @property
    def σ_ZZ(self) -> NDArray[np.float64]:
        """Normal stress out of the plane at points inside, (states, m)."""
        return self.body.σ_ZZ(self.inside, self.places.points[:, 1])
