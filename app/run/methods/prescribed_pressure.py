"""A pressure of the user's own at one speed, put in: finite elements, the degree found by measuring.

Mode ``traction`` at one speed: σ_YY put in, σ_XY = g σ_YY.

A pressure of the user's own over layers at one speed, put in on cells graded towards its knots.

What states share whose pressure is put in: by formula, or the user's own.
"""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.free_ends import turns_at_knots
from galinx.postprocess.quantities.stresses import BELOW, ON_SURFACE, YIELD
from galinx.postprocess.yielding import Strength
from galinx.solvers.fem.fields import TOGETHER, SurfaceSlopes
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.traction import LinearLoads, LoadedHalfPlane, Pieces
from galinx.solvers.rays import NEAR, rays
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.prescribed_pressure import LinearPressure
from galinx.solvers.solution import Body, Places, Surface

from ...plan.task import Task
from .discretisation import Discretisation
from .displacement import Displacement
from .error import (
    Gauge,
    Ladder,
    MeasuredError,
    StressGauges,
    gauged,
    of_in_plane,
    of_inside,
    reached,
)
from .method import Pressure


class PutInAtSpeed:
    """A pressure put in at one speed, solved to the tolerance.

    Args:
        ladder: climbed.
        error: of its last level.
    """

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        self.task, self.level, self.error = ladder.task, ladder.levels[-1], error
        self._ladder = ladder

    def record(self) -> dict[str, Any]:
        return self._ladder.record() | self.error.record()


@dataclass(frozen=True)
class PutIn:
    """States with a pressure that is put in.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
        body: what slides over what, under the load of each.
    """

    at: Any
    g: NDArray[np.float64]
    body: Body

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.full(len(self.g), self.at.level.resultant)

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self.g * self.normal_force

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        found: dict[str, NDArray[np.float64]] = self.at.error.of(self.g)
        return found


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["OwnPressureAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with reached(work, task, g, lambda space, _: PiecesLevel(work, task, space)) as (ladder, error):
        yield OwnPressureAtSpeed(ladder, error)


@contextmanager
def one_state(
    work: Discretisation, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray, Pressure]]:
    """Space, fields, weights and pressure of one state: the pressure as a whole, not piece by piece."""
    # A kink inside a cell spoils that and its neighbours: halved, they reach less far.
    loaded, pressure = LoadedHalfPlane(work.space(degree, cuts=2), task.response), _put_in(task)
    try:
        loaded.load(
            lambda left, right: pressure(np.where(left < right, left - 1.0, 1.0 - right)),
            pressure.knots[1:-1],
        )
        yield loaded.space, loaded.fields, np.array([1.0, g]), pressure
    finally:
        loaded.destroy()


def _put_in(task: Task) -> LinearPressure:
    assert task.body.pressure
    return task.body.pressure


class PiecesSeen:
    """Displacement gradients of the pressure at places, of σ_YY alone and of σ_XY equal to it.

    Args:
        task: the speed, and the places.
        pieces: of the pressure.
        loads: with which these are made.
        words: of output.quantities, that ask for stresses.
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
        """The surface of states with these values of σ_XY/σ_YY."""
        places = self._task.places
        u_X, v_X = np.moveaxis(self._on_surface[:, :, 0], 1, 0)
        σ_YY = np.tile(np.where(places.under, _put_in(self._task)(places.X), np.nan), (len(g), 1))
        return Surface(places, σ_YY, _in_plane(self._task, u_X, places.X, g), None, (v_X @ _weights(g)).T)

    def inside(self, g: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY inside of states with these values of σ_XY/σ_YY, (3, states, m)."""
        return self._task.response.stresses(np.einsum("nijd,ds->snij", self._inside, _weights(g)))

    def around(self, g: NDArray) -> NDArray[np.float64]:
        """The same where stresses are looked at for yield, (3, states, k)."""
        return self._task.response.stresses(np.einsum("nijd,ds->snij", self._around, _weights(g)))


def _in_plane(task: Task, u_X: NDArray, X: NDArray, g: NDArray) -> NDArray[np.float64]:
    """σ_XX of states on the surface, (states, n), by strains (n, 2) under σ_YY and an equal σ_XY."""
    σ = _put_in(task)(X)
    return task.response.σ_XX((u_X @ _weights(g)).T, σ, g[:, None] * σ)


def _weights(g: NDArray) -> NDArray[np.float64]:
    return np.array([np.ones_like(g), g])


class PiecesLevel:
    """What finite elements of one degree make of the pressure, for every σ_XY/σ_YY.

    Args:
        work: knows what is asked for.
        task: the speed.
        space: of the degree.

    Attributes:
        factor: of the linear system, with numbers of its work.
        resultant: of the discrete loads, over N/2.
    """

    def __init__(self, work: Discretisation, task: Task, space: Space) -> None:
        self._work, self._task, self.space = work, task, space
        pressure = _put_in(task)
        self._pieces = Pieces(pressure.knots, pressure.values)
        self._loads: LinearLoads | None = LinearLoads(space, task.response)
        self.factor: Any = self._loads.factor
        self.resultant = self._pieces.resultant(self._loads)
        self._gauged = self._seen(gauged(task))

    @cached_property
    def everywhere(self) -> PiecesSeen:
        """At all places; not after the level's release."""
        everywhere = gauged(self._task) is self._task
        return self._gauged if everywhere else self._seen(self._task)

    def _seen(self, task: Task) -> PiecesSeen:
        assert self._loads
        with self._work.clock("recovery"):
            return PiecesSeen(task, self._pieces, self._loads, self._work.stresses)

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        found, words, places = [], self._work.stresses, gauged(self._task).places
        if ON_SURFACE in words:
            found.append(of_in_plane(self._gauged.surface(g).σ_XX, places.X))
        if BELOW in words:
            found.append(of_inside(self._gauged.inside(g), places.points))
        if YIELD in words:
            found.append(of_inside(self._gauged.around(g), places.around, YIELD))
        return found

    def at(self, points: NDArray, g: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points of all states, (1, n, 2), or of each, (states, n, 2)."""
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
        """Not seen here: the mirror images of loads are no loads."""
        return [0.0] * len(self.measured(g[:1]))

    def release(self) -> None:
        self._loads = None

    def destroy(self) -> None:
        self._loads = None


class OwnPressureAtSpeed(PutInAtSpeed):
    """A pressure of the user's own at one speed."""

    def states(self, g: NDArray, load: Any = None) -> "OwnPressures":
        return OwnPressures(self, g, self.task.body.loaded(load))


class OwnPressures(PutIn):
    """States with a pressure of the user's own."""

    @cached_property
    def surface(self) -> Surface:
        level, g = self.at.level, self.g
        turns = turns_at_knots(_put_in(self.at.task), g, lambda X: level.in_plane(X, g))
        return replace(level.everywhere.surface(g), turns=turns)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.level.everywhere.inside(self.g)

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        level, response = self.at.level, self.at.task.response
        return Strength(lambda points: level.at(points, self.g), self.body, response, self.g, None)


@contextmanager
def formula_solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["FormulaAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with reached(work, task, g, lambda space, g: LoadsAtDegree(work, task, space, g)) as (ladder, error):
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
    """The pressures of all states at one speed and degree.

    Args:
        work: gives spaces.
        task: the speed.
        space: of the degree.
        g: all values of σ_XY/σ_YY that will be asked for.
    """

    def __init__(self, work: Discretisation, task: Task, space: Space, g: NDArray) -> None:
        self.task, self.space = task, space
        self.loaded = LoadedHalfPlane(space, task.response)
        #: The first of a load's two fields, by σ_XY/σ_YY.
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
        """Not seen here: the mirror images of loads are no loads."""
        return [0.0] * len(self.measured(g[:1]))

    def columns(self, g: NDArray) -> NDArray[np.int64]:
        """The first of each state's two fields, (states,)."""
        return np.array([self._columns[value] for value in g.tolist()])

    def weights(self, g: NDArray) -> NDArray[np.float64]:
        """Of the fields, (states, fields)."""
        weights, columns = np.zeros((len(g), len(self.loaded.fields))), self.columns(g)
        rows = np.arange(len(g))
        weights[rows, columns], weights[rows, columns + 1] = 1.0, g
        return weights

    def σ_YY(self, g: NDArray) -> NDArray[np.float64]:
        """What is put in at the places on the surface, NaN beside the punch, (states, n)."""
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


class FormulaAtSpeed(PutInAtSpeed):
    """Loads at one speed, solved to the tolerance."""

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        super().__init__(ladder, error)
        self.displacement = Displacement(ladder.task, self.level.space, self.level.loaded.fields)

    def states(self, g: NDArray, load: Any = None) -> "GivenLoads":
        return GivenLoads(self, g, self.task.body.loaded(load))


class GivenLoads(PutIn):
    """States with given pressure."""

    @property
    def local(self) -> FlatPunch:
        return FlatPunch(self.at.task.response, self.g)

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
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
        """Where stresses are."""
        return self.at.task.places

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return self.at.displacement.interfaces(self.at.level.weights(self.g))

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        at, weights = self.at, self.at.level.weights(self.g)
        field = at.displacement.at
        return Strength(
            lambda points: field(points, weights), self.body, at.task.response, self.g, self.local
        )


@contextmanager
def layered_solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["LayeredAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with reached(work, task, g, lambda space, _: LoadsLevel(work, task, space)) as (ladder, error):
        yield LayeredAtSpeed(ladder, error)


class _Displacement(Displacement):
    """See :class:`Displacement`; slopes next to knots are continued from farther away."""

    @cached_property
    def _slopes(self) -> Any:
        pressure, X = _put_in(self._task), self._task.places.X
        jumps = np.zeros(len(pressure.knots), dtype=bool)
        jumps[[0, -1]] = pressure.values[[0, -1]] != 0.0
        near = np.full(len(pressure.knots), NEAR)
        seen = rays(np.column_stack([X, np.zeros_like(X)]), pressure.knots, near, jumps)
        of_places = seen.continued(np.eye(len(seen.owner)))
        slopes = SurfaceSlopes(self._space, self._fields, seen.origins + seen.offsets[:, 0])
        return _Slopes(slopes, of_places)


@dataclass(frozen=True)
class _Slopes:
    """Combinations of slopes at some places; see :class:`SurfaceSlopes`.

    Attributes:
        slopes: at some places.
        of_places: what multiplies these, (wanted, places).
    """

    slopes: SurfaceSlopes
    of_places: NDArray[np.float64]

    def of(self, weights: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        u_X, v_X = self.slopes.of(weights)
        return u_X @ self.of_places.T, v_X @ self.of_places.T

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        return self.slopes.rounding(weights) @ np.abs(self.of_places).T


class LoadsLevel:
    """The pressure at one degree, for every σ_XY/σ_YY.

    Args:
        work: knows what is asked for.
        task: the speed.
        space: of the degree.
    """

    def __init__(self, work: Discretisation, task: Task, space: Space) -> None:
        self.task, self.space, pressure = task, space, _put_in(task)
        self.loaded = LoadedHalfPlane(space, task.response)
        self.loaded.load(
            lambda left, right: pressure(np.where(left < right, left - 1.0, 1.0 - right)),
            pressure.knots[1:-1],
        )
        self._gauges = StressGauges(work, task, self.displaced)

    def displaced(self, task: Task) -> Displacement:
        """What is read off the displacement at the places of a task."""
        return _Displacement(task, self.space, self.loaded.fields)

    @property
    def factor(self) -> Any:
        return self.loaded.factor

    @property
    def resultant(self) -> float:
        """Of the discrete loads, over N/2."""
        return self.loaded.resultants[0]

    def σ_YY(self, g: NDArray) -> NDArray[np.float64]:
        """What is put in at the places on the surface, NaN beside it, (states, n)."""
        places = self.task.places
        return np.tile(np.where(places.under, _put_in(self.task)(places.X), np.nan), (len(g), 1))

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        return self._gauges.of(g, weights(g), self.σ_YY(g))

    @property
    def mirrored(self) -> bool:
        """The image of the knots has another mesh."""
        return False

    def rounding(self, g: NDArray) -> list[float]:
        """What the fields' last digits can do to stresses."""
        return self._gauges.rounding(g, weights(g), self.σ_YY(g))

    def release(self) -> None:
        self.loaded.destroy()

    def destroy(self) -> None:
        self.loaded.destroy()


def weights(g: NDArray) -> NDArray[np.float64]:
    """Of both fields, (states, 2)."""
    return np.column_stack([np.ones_like(g), g])


class LayeredAtSpeed(PutInAtSpeed):
    """A pressure of the user's own over layers at one speed."""

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        super().__init__(ladder, error)
        self.displacement = self.level.displaced(ladder.task)

    def states(self, g: NDArray, load: Any = None) -> "LoadsOnLayers":
        return LoadsOnLayers(self, g, self.task.body.loaded(load))


class LoadsOnLayers(PutIn):
    """States with a pressure of the user's own."""

    @property
    def places(self) -> Places:
        """Where stresses are."""
        return self.at.task.places

    @cached_property
    def surface(self) -> Surface:
        g, pressure = self.g, _put_in(self.at.task)

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
