"""A pressure of the user's own at one speed, put in: finite elements, the degree found by measuring."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.error import reached
from galinx.app.run.methods.gauge import Gauge, gauged, of_in_plane, of_inside
from galinx.app.run.methods.method import Pressure
from galinx.app.run.methods.put_in import PutIn, PutInAtSpeed
from galinx.postprocess.near_ends import turns_at_knots
from galinx.postprocess.quantities.stresses import BELOW, ON_SURFACE, YIELD
from galinx.postprocess.yielding.strength import Strength
from galinx.solvers.fem.interior import TOGETHER
from galinx.solvers.fem.linear_loads import LinearLoads
from galinx.solvers.fem.pieces import Pieces
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.traction import LoadedHalfPlane
from galinx.solvers.sie.linear import LinearPressure
from galinx.solvers.solution import Surface


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
