"""A pressure of the user's own over layers at one speed, put in on cells graded towards its knots."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.displacement import Displacement
from galinx.app.run.methods.error import MeasuredError, reached
from galinx.app.run.methods.gauge import Gauge, StressGauges
from galinx.app.run.methods.ladder import Ladder
from galinx.app.run.methods.put_in import PutIn, PutInAtSpeed
from galinx.postprocess.near_ends import turns_at_knots
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.surface import SurfaceSlopes
from galinx.solvers.fem.traction import LoadedHalfPlane
from galinx.solvers.rays import NEAR, rays
from galinx.solvers.sie.linear import LinearPressure
from galinx.solvers.solution import Places, Surface


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["LoadsAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with reached(work, task, g, lambda space, _: LoadsLevel(work, task, space)) as (ladder, error):
        yield LoadsAtSpeed(ladder, error)


def _put_in(task: Task) -> LinearPressure:
    assert task.body.pressure
    return task.body.pressure


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


class LoadsAtSpeed(PutInAtSpeed):
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
