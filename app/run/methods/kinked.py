"""Punches of any convex profile whose contact ends where the pressure says, by finite elements.

The slope of such a punch, or its derivative, jumps at places that depend on the state, and cells are
graded towards these: every state has a mesh of its own, once its ends are nearly known. On that the
degree rises until the measured error is within tolerance. Where contacts of all loads are alike, one
state of a friction is all of them.

One contact with kinks, found, and its degree raised until the measured error is within tolerance.

A contact with kinks at one degree, and what its error is measured on.

Ends of contacts of any convex profile at one speed, by finite elements on the mesh of all speeds.

A few polynomial shapes tell where every friction and every load ends; no mesh knows of a kink there.

What punches share whose contacts have a mesh of their own for every state.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, log
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.kind import with_kinks
from galinx.meshes.rings import Refinement
from galinx.postprocess.free_ends import (
    FreeEnds,
    KinkedPressure,
    free_ends,
    gaps_of,
    heights_of_shapes,
    turns_at_ends,
)
from galinx.postprocess.pressure import chebyshev, from_moments
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.postprocess.stresses import NEAR_TIP, off_tips
from galinx.postprocess.yielding import Strength
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.profiles import cusp, exponent, jumps, kinks, leaving
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.free_contact import Exponents
from galinx.solvers.sie.residual import of_contact
from galinx.solvers.solution import Body, Surface, Turns, together

from ...plan.fem import FemPlan
from ...plan.task import OWN_MESHES_KEPT, Task
from .discretisation import Discretisation
from .displacement import KinkedDisplacement
from .error import (
    Gauge,
    Ladder,
    MeasuredError,
    StressGauges,
    WorkDone,
    climbed,
    reached,
)
from .punch import PunchLevel, negligible

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


#: What is known of every surface.
_ON_SURFACE = ("σ_YY", "σ_XX", "v_X")


class OwnMeshesAtSpeed:
    """Contacts at one speed, each solved when it is asked for; the last few are kept.

    Args:
        work: gives spaces.
        task: the speed.
    """

    def __init__(self, work: Discretisation, task: Task) -> None:
        self.work, self.task = work, task
        self._record: dict[str, Any] = {"cells": 0, "unknowns": 0, "degree": 0}
        self._done = WorkDone()
        #: By σ_XY/σ_YY and load, those that were asked for last at last.
        self._known: dict[tuple[float, float], Any] = {}

    def record(self) -> dict[str, Any]:
        return self._record | vars(self._done)

    def destroy(self) -> None:
        """Free what states hold."""
        for state in self._known.values():
            state.destroy()

    def _solve(self, g: float, load: float) -> Any:
        """A contact, with numbers of its work in ``record``, at σ_XY/σ_YY under a load [N/m]."""
        raise NotImplementedError

    def _state(self, g: float, load: float) -> Any:
        state = self._known.pop((g, load), None)
        if state is None:
            state = self._solve(g, load)
            for name, value in state.record.items():
                self._record[name] = max(self._record.get(name, value), value)
        self._known[g, load] = state
        while len(self._known) > OWN_MESHES_KEPT:
            self._known.pop(next(iter(self._known))).destroy()
        return state


@dataclass(frozen=True)
class OnOwnMeshes:
    """Punches with several frictions and loads, each with its own half-width and middle.

    Attributes:
        task: their speed.
        g: σ_XY/σ_YY, (states,).
        found: of each; of some loads the same where contacts are alike.
        body: what slides over what, under the load of each.
    """

    task: Task
    g: NDArray[np.float64]
    found: list[Any]
    body: Body

    @cached_property
    def local(self) -> Exponents:
        """Exponents at the ends."""
        flat = FlatPunch(self.task.response, self.g)
        return Exponents(flat.α + 1.0, flat.β + 1.0)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At the left and the right end: none, by condition, (states, 2)."""
        return np.zeros((len(self.g), 2))

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.array([state.level.contact.normal.sum() for state in self.found])

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.array([state.level.contact.tangential.sum() for state in self.found])

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        words = self.found[0].estimates
        return {word: np.array([state.estimates[word] for state in self.found]) for word in words}

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface."""
        each = [state.surface for state in self.found]
        σ_YY, σ_XX, v_X = (np.array([getattr(one, name)[0] for one in each]) for name in _ON_SURFACE)
        turns = together([one.turns for one in each if one.turns is not None])
        return Surface(self.task.places, σ_YY, σ_XX, None, v_X, turns)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return np.stack([state.inside for state in self.found], axis=1)


#: Most kinks in a contact, and how near to its end one may be.
_MOST, _NEXT_TO_END = 12, 0.98

#: Places under the punch at which the pressure is measured.
_ACROSS = np.cos(np.pi * (np.arange(24) + 0.5) / 24.0)

#: Rings more around a cusp of the pressure; size of the innermost cells at a kink, over the tolerance.
_AROUND_CUSP, _INNERMOST = 4, 30.0

#: Size of the innermost cells at a tip over the distance from where stresses are looked at.
_OF_TIP = 0.25

#: Weights of a single field.
ONE = np.ones((1, 1))


def places_of_kinks(body: Body, ends: Ends) -> NDArray[np.float64]:
    """Of those under the contact, over the half-width from its middle.

    Raises:
        SolveError: cells cannot be graded towards them.
    """
    at = (np.array(kinks(body.profile), dtype=float) - ends.centre) / ends.half_width
    inside = at[np.abs(at) < 1.0]
    if len(inside) > _MOST or np.abs(inside).max(initial=0.0) > _NEXT_TO_END:
        raise SolveError(
            f"the punch has {len(inside)} kinks under the contact, at {inside.round(4).tolist()} "
            f"(over the half-width); finite elements want at most {_MOST}, none within "
            f'{1.0 - _NEXT_TO_END:.2g} of an end; take methods = ["closed_form"]'
        )
    return inside


def _gentle(plan: FemPlan) -> Refinement:
    """The plan's refinement with rings no steeper than its mesh has them as a rule.

    They are steeper where cells are finer in angle, which does at ends that are free: the pressure at a
    kink is no power of the distance, and a ring that spans a fifth of it is slow to follow that.
    """
    rings, ratio = plan.refinement, plan.kind.ratio
    if rings.ratio >= ratio:
        return rings
    return replace(rings, levels=ceil(rings.levels * log(rings.ratio) / log(ratio)), ratio=ratio)


def rings_around_kinks(rings: Refinement, tolerance: float, body: Body) -> int:
    """How many more than around the ends.

    Next to a kink of the slope's derivative the pressure is d log d, and what the innermost cells make of
    it is of their size whatever the degree is. At a tip it is infinite, and looked at farther away: where
    an innermost cell reached there, no degree would resolve it, however loose the tolerance is.
    """
    if cusp(body.profile):
        return _AROUND_CUSP
    if jumps(body.profile):
        size = _OF_TIP * NEAR_TIP
    else:
        order = max((exponent(body.profile) or 2.0) - 1.0, 1.0)
        size = (_INNERMOST * tolerance) ** (1.0 / order)
    return max(0, ceil(log(size) / log(rings.ratio)) - rings.levels)


class OwnMeshes:
    """Spaces on the mesh of one state, see :class:`Discretisation`.

    Args:
        work: of all states.
        places: of the kinks over the half-width.
        body: what slides over what.

    Attributes:
        plan: of all states.
    """

    def __init__(self, work: Discretisation, places: NDArray, body: Body) -> None:
        self._work, self._places, self._body, self.plan = work, places, body, work.plan
        rings = _gentle(work.plan)
        more = rings_around_kinks(rings, work.plan.tolerance, body)
        self._mesh = work.own_mesh(with_kinks(rings, places, more))

    @cached_property
    def finer(self) -> "OwnMeshes":
        """With cells for a tighter tolerance."""
        return OwnMeshes(self._work.finer, self._places, self._body)

    def warn(self, text: str) -> None:
        """What the user should know."""
        self._work.warn(text)

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree."""
        return self._work.space_of(self._mesh, degree)


class KinkedLevel:
    """A contact at one degree; see :class:`galinx.app.run.methods.error.Level`.

    Args:
        work: knows what is asked for.
        task: the speed, and the load.
        space: of the degree, on cells graded towards the kinks.
        places: of these over the half-width.
        ends: of the contact.
        g: σ_XY/σ_YY.

    Attributes:
        contact: nodal forces of the state.
        field: its displacement over N/(2μ), condensed.
        displacement: what is read off that.
        pressure: the contact's.
        kinks: places at which it is finite for all that.
        factor: of the linear system, freed, with numbers of its work.
    """

    def __init__(
        self, work: Discretisation, task: Task, space: Space, places: NDArray, ends: Ends, g: float
    ) -> None:
        self.space, self._g = space, np.array([g])
        r = space.chart.surface_position(space.contact.s)
        body = task.body
        height = body.profile.height(ends.centre + ends.half_width * r) / body.displacement
        least = negligible(work)
        punch = SlidingPunch(space, task.response, work.plan.solver, least, height)
        try:
            self.factor, self.contact = punch.factor, punch.states(self._g)
            self.field = punch.fields[0].duplicate()
            self.field.zeroEntries()
            self.field.maxpy(self.contact.weights[0].tolist(), punch.fields)
        finally:
            punch.destroy()
        self._moments = self.contact.normal @ chebyshev(r)[:, 1:6]
        local = FlatPunch(task.response, self._g)
        exponents = float(local.β[0]) + 1.0, float(local.α[0]) + 1.0
        self.pressure = KinkedPressure(
            space.contact.s, space.degree, space.chart, self.contact.normal[0], places, exponents,
            leaving(body.profile), work.plan.tolerance,
        )  # fmt: skip
        tips = places if jumps(body.profile) else np.empty(0)
        self.kinks = places if not len(tips) else np.empty(0)
        self._task, self._across = _off(task, tips), _ACROSS[off_tips(_ACROSS, tips)]
        self.displacement = KinkedDisplacement(task, space, self.field, gaps_of(places), exponents)
        self._gauges = StressGauges(work, self._task, self.displacement.at_places_of)

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        """Of the one state there is."""
        return [self._of_forces(), *self._gauges.of(self._g, ONE, self._on_surface())]

    @property
    def mirrored(self) -> bool:
        """The image of the kinks has another mesh."""
        return False

    def rounding(self, g: NDArray) -> list[float]:
        """What a solve leaves of its forces stands for the rounding of these."""
        return [
            self.factor.largest_residual,
            *self._gauges.rounding(self._g, ONE, self._on_surface()),
        ]

    def release(self) -> None:
        """There is one vector only."""

    def destroy(self) -> None:
        self.field.destroy()

    def _on_surface(self) -> NDArray[np.float64]:
        return self.pressure.σ_YY(self._task.places.X)[None]

    def _of_forces(self) -> Gauge:
        """Moments of the pressure over the load, and the pressure over its largest, kinks among the
        places: there it is a limit, which has less digits than what it is taken from."""
        at_kinks = [self.pressure.at_kink(i) for i in range(len(self.kinks))]
        σ = np.append(self.pressure.σ_YY(self._across), at_kinks)[None]
        values, size = np.concatenate([self._moments, σ], axis=1), float(np.abs(σ).max())
        scale = np.concatenate([2.0 + 0.0 * self._moments, size + 0.0 * σ], axis=1)
        left = self.pressure.left_at_kinks / size if at_kinks else 0.0
        return Gauge(INTENSITIES, values, scale, left)


def _off(task: Task, tips: NDArray) -> Task:
    """The task without places next to tips, where stresses are infinite."""
    places = task.places
    X, points, around = places.X, places.points, places.around
    return replace(
        task,
        places=replace(
            places,
            X=X[off_tips(X, tips)],
            points=points[off_tips(points[:, 0], tips, points[:, 1])],
            around=around[off_tips(around[:, 0], tips, around[:, 1])],
        ),
    )


@dataclass(frozen=True)
class KinkedState:
    """A solved contact; lengths over its half-width from its middle.

    Attributes:
        task: the speed, and the load.
        ends: of the contact.
        level: the last.
        estimates: relative errors by the word of output.quantities that asks for what they are of.
        record: numbers of the work, as they are archived.
    """

    task: Task
    ends: Ends
    level: KinkedLevel
    estimates: dict[str, float]
    record: dict[str, Any]

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface, of one state."""
        σ_YY = self.level.pressure.σ_YY(self.task.places.X)[None]
        found = self.level.displacement.surface(self.level.contact.g, ONE, σ_YY)
        return replace(found, turns=self._turns(found))

    def _turns(self, surface: Surface) -> Turns:
        """Stresses at both ends, and under kinks where they are finite."""
        level, local = self.level, FlatPunch(self.task.response, self.level.contact.g)
        ends = turns_at_ends(surface, Exponents(local.α + 1.0, local.β + 1.0))
        X, pressure = level.kinks, level.pressure
        σ_YY = np.array([pressure.at_kink(i) for i in range(len(X))])
        u_X = np.array([pressure.limit_at_kink(i, level.displacement.strain) for i in range(len(X))])
        σ_XY = float(level.contact.g[0]) * σ_YY
        under = np.array([self.task.response.σ_XX(u_X, σ_YY, σ_XY), σ_YY, σ_XY])
        return ends.joined(Turns(X[None], under[:, None]))

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, m)."""
        return self.level.displacement.inside(ONE)[:, 0]

    @cached_property
    def largest(self) -> tuple[float, float]:
        """Largest pressure over N/(2a), and its place over a."""
        return self.level.pressure.largest()

    @cached_property
    def residual(self) -> float:
        """What the pressure leaves of the integral equation, relative."""
        level, ends, one = self.level, self.ends, np.ones(1)
        local = FlatPunch(self.task.response, level.contact.g)
        left = of_contact(
            self.task.response, level.contact.g, Exponents(local.α + 1.0, local.β + 1.0), self.task.body,
            lambda r: level.pressure.σ_YY(r)[None], (ends.centre * one, ends.half_width * one),
            level.pressure.kinks, level.pressure.breaks,
        )  # fmt: skip
        return float(left[0])

    def at(self, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (..., 2) over a, (3, ...)."""
        found = self.level.displacement.at(points.reshape(1, -1, 2), ONE)
        return found.reshape(3, *points.shape[:-1])

    def destroy(self) -> None:
        self.level.destroy()


def solved(work: Discretisation, task: Task, g: float, ends: Ends, done: WorkDone) -> KinkedState:
    """The contact at a friction.

    Args:
        work: gives spaces.
        task: the speed, and the load.
        g: σ_XY/σ_YY.
        ends: of the contact.
        done: takes the numbers of the work.

    Raises:
        SolveError: cells cannot be graded towards its kinks, or the equations could not be solved.
    """
    places = places_of_kinks(task.body, ends)

    def level(space: Any, _: NDArray) -> KinkedLevel:
        found = KinkedLevel(work, task, space, places, ends, g)
        done.count(found)
        return found

    of_one = np.array([g])
    with reached(OwnMeshes(work, places, task.body), task, of_one, level) as (ladder, error):
        estimates = {word: float(values[0]) for word, values in error.of(of_one).items()}
        last: KinkedLevel = ladder.levels.pop()
    estimates[INTENSITIES] += ends.error
    size = {"cells": last.space.cells, "unknowns": last.space.size, "degree": last.space.degree}
    return KinkedState(task, ends, last, estimates, size | error.record())


#: Distance over a from an end or a kink from which on stresses are looked at, the place itself besides.
_NEAREST = 1e-2


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["KinkedAtSpeed"]:
    """States are solved when they are asked for, each on meshes of its own."""
    with ends_at_speed(work.for_ends, task, g) as ends:
        at = KinkedAtSpeed(work, task, ends)
        try:
            yield at
        finally:
            at.destroy()


class KinkedAtSpeed(OwnMeshesAtSpeed):
    """Contacts at one speed, see :class:`OwnMeshesAtSpeed`.

    Args:
        work, task: the same.
        ends: of all its contacts.
    """

    def __init__(self, work: Discretisation, task: Task, ends: EndsAtSpeed) -> None:
        super().__init__(work, task)
        self._ends = ends

    def states(self, g: NDArray, load: Any = None) -> "KinkedPunches":
        body = self.task.body.loaded(load)
        of_each = np.broadcast_to(body.load, g.shape)
        solved_at = np.full(g.shape, self.task.body.load) if body.alike else of_each
        found = [self._state(*state) for state in zip(g.tolist(), solved_at.tolist())]
        growth = self.task.body.growth(of_each) if body.alike else np.ones(g.shape)
        return KinkedPunches(self.task, g, found, body, growth)

    def record(self) -> dict[str, Any]:
        done = WorkDone(**vars(self._done))
        done.add(self._ends.done)
        return self._record | vars(done)

    def _solve(self, g: float, load: float) -> KinkedState:
        task = alone(self.task, load)
        return solved(self.work, task, g, self._ends.of(g, load), self._done)


@dataclass(frozen=True)
class KinkedPunches(OnOwnMeshes):
    """Punches of any convex profile with several frictions and loads.

    Attributes:
        growth: half-width of each over that of what was found, (states,).
    """

    growth: NDArray[np.float64]

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
        return self.growth * [state.ends.half_width for state in self.found]

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self.growth * [state.ends.centre for state in self.found]

    @property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        if jumps(self.body.profile):
            return np.full(len(self.g), np.nan), np.full(len(self.g), np.nan)
        values, places = np.array([state.largest for state in self.found]).T
        return values, places

    @property
    def residual(self) -> NDArray[np.float64]:
        """What the pressure leaves of the integral equation, relative, (states,)."""
        return np.array([state.residual for state in self.found])

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation of the punch's lowest point over N/(2μ), (states,)."""
        return np.array([state.level.contact.v0[0] for state in self.found])

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        return Strength(
            self._stresses, self.body, self.task.response, self.g, self.local, self.half_width,
            self.surface.turns, _NEAREST,
        )  # fmt: skip

    def _stresses(self, points: NDArray) -> NDArray[np.float64]:
        """At points of all states, (1, n, 2), or of each, (states, n, 2): (3, states, n)."""
        each = np.broadcast_to(points, (len(self.g), *points.shape[1:]))
        found = [state.at(some) for state, some in zip(self.found, each)]
        return np.stack(found, axis=1)
