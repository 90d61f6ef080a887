"""Ends of contacts of any convex profile at one speed, by finite elements on the mesh of all speeds.

A few polynomial shapes tell where every friction and every load ends; no mesh knows of a kink there.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.error import MeasuredError, climbed
from galinx.app.run.methods.gauge import Gauge
from galinx.app.run.methods.ladder import Ladder, WorkDone
from galinx.app.run.methods.punch import PunchLevel
from galinx.postprocess.free_ends import FreeEnds, free_ends, heights_of_shapes
from galinx.postprocess.pressure import from_moments
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.solvers.fem.space import Space
from galinx.solvers.sie.closed_form import FlatPunch

#: σ_XY/σ_YY and load [N/m]; middle and half-width [m].
State: TypeAlias = tuple[float, float]
Lengths: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Ends:
    """Where a contact ends.

    Attributes:
        centre, half_width: [m].
        error: estimated, of both over the half-width.
    """

    centre: float
    half_width: float
    error: float


@contextmanager
def ends_at_speed(work: Discretisation, task: Task, g: NDArray) -> Iterator["EndsAtSpeed"]:
    """Raise the degree until the measured error of the ends of sample states is within tolerance."""
    near: dict[State, Lengths] = {}
    with climbed(work, task, g, lambda space, g: EndsLevel(work, task, space, g, near)) as (
        ladder, error,
    ):  # fmt: skip
        yield EndsAtSpeed(ladder, error)


class EndsLevel(PunchLevel):
    """Ends at one degree; see :class:`PunchLevel`.

    Args:
        work, task, space, g: of that.
        near: middles and half-widths [m] of states by σ_XY/σ_YY and load, as levels before knew them.
    """

    def __init__(
        self, work: Discretisation, task: Task, space: Space, g: NDArray, near: dict[State, Lengths]
    ) -> None:
        super().__init__(work, task, space, g)
        self._near = near
        self._conditions: dict[float, FreeEnds] = {}
        self._found: dict[State, Lengths] = {}

    def heights(self) -> NDArray[np.float64]:
        return heights_of_shapes(self.space.chart.surface_position(self.space.contact.s))

    def conditions(self, g: NDArray) -> list[FreeEnds]:
        """Of every friction."""
        missing = np.array([value for value in np.unique(g).tolist() if value not in self._conditions])
        if len(missing):
            self._conditions |= zip(missing.tolist(), self._solved(missing))
        return [self._conditions[value] for value in g.tolist()]

    def found(self, g: NDArray, load: Any = None) -> list[Lengths]:
        """Middle and half-width [m] of every state.

        Raises:
            SolveError: no contact carries the load.
        """
        body, last = self.task.body, None
        loads = np.broadcast_to(body.loaded(load).load, g.shape).tolist()
        states = list(zip(g.tolist(), loads))
        for state, known in zip(states, self.conditions(g)):
            if state not in self._found:
                unit = body.loaded(state[1]).displacement
                start = self._near.get(state, last)
                self._found[state] = self._near[state] = known.found(body.profile, unit, start)
            last = self._found[state]
        return [self._found[state] for state in states]

    def _solved(self, g: NDArray) -> list[FreeEnds]:
        parts, local = self.punch.parts(g), FlatPunch(self.task.response, g)
        K = np.stack(
            [from_moments(part.normal @ self.recovery.moments, local.α, local.β).K_I for part in parts],
            axis=-1,
        )
        return free_ends(local, K, np.stack([part.load for part in parts], axis=-1))

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        ends = np.array(self.found(g, load))
        h = ends[:, 1:]
        unseen = np.array([[known.unseen] for known in self.conditions(g)])
        # Half-widths of a level are told over those of none: their logarithms differ by relative changes.
        values = np.concatenate([np.log(h), ends[:, :1] / h, unseen], axis=1)
        return [Gauge(INTENSITIES, values, np.ones_like(values))]


class EndsAtSpeed:
    """Ends at one speed, found to the tolerance.

    Args:
        ladder: climbed.
        error: of its last level.
    """

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        self._ladder, self._error = ladder, error

    def of(self, g: float, load: float) -> Ends:
        """Of a state.

        Raises:
            SolveError: no contact carries the load.
        """
        state, level = (np.array([g]), np.array([load])), self._ladder.levels[-1]
        ((centre, half_width),) = level.found(*state)
        (error,) = self._error.of(*state)[INTENSITIES]
        (known,) = level.conditions(state[0])
        return Ends(centre, half_width, float(error) + known.unseen)

    @property
    def done(self) -> WorkDone:
        """Numbers of the work."""
        return self._ladder.done


def alone(task: Task, load: float) -> Task:
    """The task under one load [N/m]."""
    return replace(task, body=task.body.loaded(load), loads=(load,))
