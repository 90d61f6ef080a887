"""Mode ``contact`` at one speed: a rigid punch, the pressure unknown, the degree found by measuring."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.fem import FemPlan
from galinx.app.plan.task import Task
from galinx.app.run.methods import gauge
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.displacement import Displacement
from galinx.app.run.methods.error import reached
from galinx.app.run.methods.gauge import Gauge, StressGauges
from galinx.app.run.methods.method import Pressure
from galinx.postprocess.pressure import (
    ContactRecovery,
    JacobiPressure,
    chebyshev,
    contact_recovery,
    from_moments,
)
from galinx.postprocess.stretched import from_moments as from_stretched
from galinx.postprocess.yielding.strength import Strength
from galinx.solvers.fem.fitted import FittedPunch
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.states import ContactStates, Punch
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.residual import of_contact
from galinx.solvers.solution import Body, Places, Surface

#: Change of the contact forces over the tolerance, and at most, for which no solution is refined and
#: nothing more is added for friction. The most keeps results on any number of ranks equal to 1e-9.
_NEGLIGIBLE, _NEGLIGIBLE_MOST = 1e-4, 1e-10

#: Share of it where stresses are wanted: next to an edge a force counts by the little load there is.
_BESIDE_EDGES = 0.1


def negligible(work: Any) -> float:
    """Relative change of the contact forces that no result shows."""
    least = min(_NEGLIGIBLE * work.plan.tolerance, _NEGLIGIBLE_MOST)
    return _BESIDE_EDGES * least if work.stresses else least


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["PunchesAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with reached(work, task, g, lambda space, g: PunchLevel(work, task, space, g)) as (ladder, error):
        yield PunchesAtSpeed(ladder, error)


@contextmanager
def one_state(
    work: Discretisation, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray, Pressure]]:
    """Space, fields, weights and pressure of one state."""
    space = work.space(degree, work.plan.cuts)
    punch = SlidingPunch(space, task.response, work.plan.solver, heights=profile_on(space, task.body))
    try:
        states = punch.states(g)  # the fields are complete after this
        recovery = contact_recovery(space.contact.s, space.degree, space.chart, np.empty(0))
        local = FlatPunch(task.response, states.g)
        pressure = from_moments(states.tested(recovery.moments), local.α, local.β)
        yield space, punch.fields, states.weights[0], lambda X: pressure.σ_YY(X)[0]
    finally:
        punch.destroy()


class PunchLevel:
    """A punch at one degree, and the maps that read its contact forces.

    Args:
        work: gives spaces.
        task: the speed.
        space: of the degree.
        g: all values of σ_XY/σ_YY that will be asked for.
        fitted: a punch that other speeds tell of; it is solved if not given.
        recovery: the maps, where they are known for the space.
    """

    def __init__(
        self, work: Discretisation, task: Task, space: Space, g: NDArray,
        fitted: FittedPunch | None = None, recovery: ContactRecovery | None = None,
    ) -> None:  # fmt: skip
        plan, self.task, self.space, self._work = work.plan, task, space, work
        self._tests, self._fitted = plan.tests, fitted
        if fitted is not None and recovery is not None:
            self.punch: Punch = fitted
            self.recovery = recovery
            return
        least = negligible(work)
        # What friction leaves is alike from degree to degree: in stresses no estimate sees it.
        left = 0.0 if work.stresses else least
        solved = SlidingPunch(space, task.response, plan.solver, least, self.heights(), left)
        self.punch, self.factor = solved, solved.factor
        more = space.degree - plan.degrees[task.number]
        self.recovery = contact_recovery(
            space.contact.s, space.degree, space.chart, task.places.X, tests=tests_of(plan, more)
        )
        # The basis is complete before traces are taken, and the same whatever states are still to do.
        solved.prepare(g)
        self._gauges  # noqa: B018 - cached

    @cached_property
    def _gauges(self) -> StressGauges:
        return StressGauges(self._work, self.task, self.displacement)

    @property
    def slopes(self) -> Any:
        """Slopes of the fields on the surface, None where no stress is asked for."""
        return self._gauges.slopes

    def displacement(self, at: Task | None = None) -> Displacement:
        """What is read off the fields, at the places of the task or of another."""
        slopes = self._fitted.slopes if self._fitted else None
        return Displacement(at or self.task, self.space, self.punch.fields, slopes)

    def heights(self) -> NDArray[np.float64] | None:
        """The punch's over N/(2μ) at the contact nodes, or of shapes; None for a flat punch."""
        return profile_on(self.space, self.task.body)

    @property
    def mirrored(self) -> bool:
        return self.task.response.mirrored

    def pressure(self, states: ContactStates) -> JacobiPressure:
        """Pressure from its Jacobi moments, whose weight has the exponents of the local analysis."""
        local = FlatPunch(self.task.response, states.g)
        moments, tests = states.tested(self.recovery.moments), self._tests
        if tests:
            return from_stretched(moments, local.α, local.β, tests.stretch)
        return from_moments(moments, local.α, local.β)

    def contact(self, g: NDArray, load: Any = None) -> ContactStates:
        """States with these values of σ_XY/σ_YY, under the task's load or others [N/m]."""
        return self.punch.states(g, share=1.0 if load is None else self.task.body.load / load)

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        states = self.contact(g, load)
        return self.gauges(states, self.pressure(states))

    def gauges(self, states: ContactStates, pressure: JacobiPressure) -> list[Gauge]:
        """What the error is measured on of states and their pressure."""
        moments = states.tested(self.recovery.moments)
        found = [gauge.of_pressure(pressure, moments)]
        if self._gauges.wanted:
            found += self._gauges.of(states.g, states.weights, pressure.σ_YY(self.task.places.X))
        return found

    def rounding(self, g: NDArray) -> list[float]:
        """What is not the mirror image of itself at -g, of a flat punch: a profile need not be one.

        In a solid that is none itself K_I is the same at both ends of a flat punch for all that.
        """
        if not self.task.response.mirrored:
            states = self.punch.states(g, flat=True)
            pressure = self.pressure(states)
            left, right = pressure.K_I.T
            # Over layers they differ, and what a solve leaves of its forces stands for rounding.
            layered = self.task.body.layered
            of_edges = self.factor.largest_residual if layered else np.abs(left / right - 1.0).max()
            stresses = self._gauges.rounding(g, states.weights, pressure.σ_YY(self.task.places.X))
            return [float(of_edges), *stresses]
        found = []
        for sign in (1.0, -1.0):
            states = self.punch.states(sign * g, flat=True)
            pressure = self.pressure(states)
            σ_YY = pressure.σ_YY(self.task.places.X)
            gauges = self._gauges.mirrored(sign, sign * g, states.weights, σ_YY)
            found.append([gauge.of_intensities(pressure.K_I[:, :: int(sign)]), *gauges])
        return [float(one.change(other).max()) for one, other in zip(*found)]

    def release(self) -> None:
        self.punch.release()

    def destroy(self) -> None:
        self.punch.destroy()


def tests_of(plan: FemPlan, more: int) -> Callable[[NDArray], NDArray]:
    """Functions of r with which nodal forces are tested; over layers at so many degrees more."""
    tests = plan.tests
    if tests is None:
        return chebyshev
    return lambda r: tests.stretch.functions(r, tests.count + more * tests.a_degree)


def profile_on(space: Space, body: Body) -> NDArray[np.float64] | None:
    """The punch's height over N/(2μ) at the contact nodes; None for a flat punch, which needs none."""
    return None if body.flat else body.height(space.chart.surface_position(space.contact.s))


class PunchesAtSpeed:
    """Rigid punches at one speed, their pressure found to the tolerance.

    Args:
        ladder: climbed.
        error: of its last level.
        fitted: did other speeds tell of this one?
    """

    def __init__(self, ladder: Any, error: Any, fitted: bool = False) -> None:
        self.task, self.level, self.error = ladder.task, ladder.levels[-1], error
        self.displacement, self.fitted = self.level.displacement(), fitted
        self._ladder = ladder

    def states(self, g: NDArray, load: Any = None) -> "Punches":
        body = self.task.body.loaded(load)
        return Punches(self, g, self.level.contact(g, load), body)

    def record(self) -> dict[str, Any]:
        return self._ladder.record() | self.error.record()


@dataclass(frozen=True)
class Punches:
    """Rigid punches with several frictions.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
        contact: nodal forces and weights.
        body: what slides over what, under the load of each.
    """

    at: PunchesAtSpeed
    g: NDArray[np.float64]
    contact: ContactStates
    body: Body

    @cached_property
    def local(self) -> FlatPunch:
        return FlatPunch(self.at.task.response, self.g)

    @cached_property
    def _pressure(self) -> JacobiPressure:
        return self.at.level.pressure(self.contact)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At X = -a and X = a, (states, 2)."""
        return self._pressure.K_I

    @cached_property
    def exponents(self) -> NDArray[np.float64]:
        """At X = a and X = -a, fitted from the raw pressure, (states, 2)."""
        return self.at.level.recovery.exponents(self.contact.normal)

    @property
    def residual(self) -> NDArray[np.float64]:
        """What the pressure leaves of the integral equation, relative, (states,)."""
        return of_contact(self.at.task.response, self.g, self.local, self.body, self._pressure.σ_YY)

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self.contact.load

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self.contact.tangential.sum(axis=1)

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation over N/(2μ), (states,)."""
        return self.contact.v0

    @property
    def fitted(self) -> NDArray[np.float64]:
        """1 where other speeds told of the state, 0 where it was solved, (states,)."""
        return np.full(len(self.g), float(self.at.fitted))

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        level = self.at.level
        return self.at.error.of(
            self.g, self.body.load, lambda: level.gauges(self.contact, self._pressure)
        )

    @cached_property
    def surface(self) -> Surface:
        σ_YY = self._pressure.σ_YY(self.at.task.places.X)
        raw = self.contact.tested(self.at.level.recovery.raw)
        return self.at.displacement.surface(self.g, self.contact.weights, σ_YY, raw)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.displacement.inside(self.contact.weights)

    @property
    def places(self) -> Places:
        """Where stresses are."""
        return self.at.task.places

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return self.at.displacement.interfaces(self.contact.weights)

    @property
    def σ_ZZ(self) -> NDArray[np.float64]:
        """Normal stress out of the plane at points inside, (states, m)."""
        return self.body.σ_ZZ(self.inside, self.at.task.places.points[:, 1])

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        at, weights = self.at, self.contact.weights
        field = at.displacement.at
        return Strength(
            lambda points: field(points, weights), self.body, at.task.response, self.g, self.local
        )


#: What a fit through speeds puts together: a level, and the punches that it tells of.
Level, AtSpeed = PunchLevel, PunchesAtSpeed
