"""Mode ``traction`` at one speed: σ_YY put in, σ_XY = g σ_YY."""

from collections.abc import Iterator
from contextlib import contextmanager
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
from galinx.app.run.methods.method import Pressure
from galinx.app.run.methods.put_in import PutIn, PutInAtSpeed
from galinx.postprocess.yielding.strength import Strength
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.traction import LoadedHalfPlane
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solution import Places, Surface


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["LoadsAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with reached(work, task, g, lambda space, g: LoadsAtDegree(work, task, space, g)) as (ladder, error):
        yield LoadsAtSpeed(ladder, error)


@contextmanager
def one_state(
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


class LoadsAtSpeed(PutInAtSpeed):
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
