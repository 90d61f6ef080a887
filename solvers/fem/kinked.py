"""Contacts with free ends under punches of any convex profile, by finite elements.

The slope of such a punch, or its derivative, jumps at places that depend on the state. So the ends are
solved for first, on the mesh of all speeds, where a few polynomial shapes give the ends of every friction
and every load, and cells need not resolve a kink (:class:`EndsLevel`). Then every state has a mesh of its
own, with cells graded towards its kinks, on which the degree rises until the measured error is within
tolerance (:class:`KinkedState`). Where contacts of all loads differ in size alone, a single state of a
friction stands for all of them.

All contacts with a mesh for every state, those over layers included, share :class:`OwnMeshesAtSpeed` and
:class:`OnOwnMeshes`.
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

from ..contact import INTENSITIES
from ..contact.edges import EdgeExponents, Exponents
from ..contact.fem_plan import OWN_MESHES_KEPT, FemPlan
from ..contact.free_ends import (
    FreeEnds,
    KinkedPressure,
    free_ends,
    gaps_of,
    heights_of_shapes,
    turns_at_ends,
)
from ..contact.recovery import chebyshev, from_moments
from ..contact.residual import of_contact
from ..contact.solution import Body, Surface, Task, Turns, together
from ..contact.stresses import NEAR_TIP, off_tips
from ..contact.yielding import Strength
from ..errors import SolveError
from ..profiles import cusp, exponent, jumps, kinks, leaving
from .contact import PunchLevel, negligible
from .discretisation import Discretisation
from .displacement import KinkedDisplacement
from .ladder import Gauge, Ladder, MeasuredError, StressGauges, WorkDone, climbed, solved_to_tolerance
from .punch import SlidingPunch
from .space import Space

#: A state by σ_XY/σ_YY and load [N/m]; a contact by middle and half-width [m].
State: TypeAlias = tuple[float, float]
Lengths: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Ends:
    """Ends of a contact.

    Attributes:
        centre, half_width: middle and half-width of the contact [m].
        error: estimated error of both over the half-width.
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
        work, task, space, g: as of :class:`PunchLevel`.
        near: middles and half-widths [m] of states by σ_XY/σ_YY and load, from previous levels.
    """

    def __init__(
        self, work: Discretisation, task: Task, space: Space, g: NDArray, near: dict[State, Lengths]
    ) -> None:
        super().__init__(work, task, space, g)
        self._near = near
        self._conditions: dict[float, FreeEnds] = {}
        self._lengths: dict[State, Lengths] = {}

    def heights(self) -> NDArray[np.float64]:
        return heights_of_shapes(self.space.chart.surface_position(self.space.contact.s))

    def conditions(self, g: NDArray) -> list[FreeEnds]:
        """Conditions at free ends of every friction."""
        missing = np.array([value for value in np.unique(g).tolist() if value not in self._conditions])
        if len(missing):
            self._conditions |= zip(missing.tolist(), self._solved(missing))
        return [self._conditions[value] for value in g.tolist()]

    def lengths(self, g: NDArray, load: Any = None) -> list[Lengths]:
        """Middle and half-width [m] of every state.

        Raises:
            SolveError: no contact carries the load.
        """
        body, last = self.task.body, None
        loads = np.broadcast_to(body.loaded(load).load, g.shape).tolist()
        states = list(zip(g.tolist(), loads))
        for state, condition in zip(states, self.conditions(g)):
            if state not in self._lengths:
                unit = body.loaded(state[1]).displacement
                start = self._near.get(state, last)
                self._lengths[state] = self._near[state] = condition.found(body.profile, unit, start)
            last = self._lengths[state]
        return [self._lengths[state] for state in states]

    def _solved(self, g: NDArray) -> list[FreeEnds]:
        parts, local = self.punch.parts(g), EdgeExponents(self.task.response, g)
        K = np.stack(
            [from_moments(part.normal @ self.recovery.moments, local.α, local.β).K_I for part in parts],
            axis=-1,
        )
        return free_ends(local, K, np.stack([part.load for part in parts], axis=-1))

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        ends = np.array(self.lengths(g, load))
        h = ends[:, 1:]
        unseen = np.array([[condition.unseen] for condition in self.conditions(g)])
        # Differences of the half-widths' logarithms are relative changes.
        values = np.concatenate([np.log(h), ends[:, :1] / h, unseen], axis=1)
        return [Gauge(INTENSITIES, values, np.ones_like(values))]


class EndsAtSpeed:
    """Ends at one speed, solved to the tolerance.

    Args:
        ladder: ladder at its last level.
        error: error of that level.
    """

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        self._ladder, self._error = ladder, error

    def of(self, g: float, load: float) -> Ends:
        """Ends of a state.

        Raises:
            SolveError: no contact carries the load.
        """
        state, level = (np.array([g]), np.array([load])), self._ladder.levels[-1]
        ((centre, half_width),) = level.lengths(*state)
        (error,) = self._error.of(*state)[INTENSITIES]
        (condition,) = level.conditions(state[0])
        return Ends(centre, half_width, float(error) + condition.unseen)

    @property
    def done(self) -> WorkDone:
        """Numbers of the work."""
        return self._ladder.done


def alone(task: Task, load: float) -> Task:
    """The task under one load [N/m]."""
    return replace(task, body=task.body.loaded(load), loads=(load,))


#: Stresses and slope of every surface.
_ON_SURFACE = ("σ_YY", "σ_XX", "v_X")


class OwnMeshesAtSpeed:
    """Contacts at one speed, each solved when first needed; the last few are kept.

    Args:
        work: gives spaces.
        task: the speed.
    """

    def __init__(self, work: Discretisation, task: Task) -> None:
        self.work, self.task = work, task
        self._record: dict[str, Any] = {"cells": 0, "unknowns": 0, "degree": 0}
        self._done = WorkDone()
        #: States by σ_XY/σ_YY and load, in the order of their last use.
        self._kept: dict[tuple[float, float], Any] = {}

    def record(self) -> dict[str, Any]:
        return self._record | vars(self._done)

    def destroy(self) -> None:
        """Free the kept states."""
        for state in self._kept.values():
            state.destroy()

    def _solve(self, g: float, load: float) -> Any:
        """Solve a contact at σ_XY/σ_YY under a load [N/m]; its ``record`` has numbers of the work."""
        raise NotImplementedError

    def _state(self, g: float, load: float) -> Any:
        state = self._kept.pop((g, load), None)
        if state is None:
            state = self._solve(g, load)
            for name, value in state.record.items():
                self._record[name] = max(self._record.get(name, value), value)
        self._kept[g, load] = state
        while len(self._kept) > OWN_MESHES_KEPT:
            self._kept.pop(next(iter(self._kept))).destroy()
        return state


@dataclass(frozen=True)
class OnOwnMeshes:
    """Punches with several frictions and loads, each with its own half-width and middle.

    Attributes:
        task: their speed.
        g: σ_XY/σ_YY, (states,).
        contacts: solved contact of each state; shared by loads under which contacts differ in size alone.
        body: what slides over what, under the load of each.
    """

    task: Task
    g: NDArray[np.float64]
    contacts: list[Any]
    body: Body

    @cached_property
    def local(self) -> Exponents:
        """Exponents at the ends."""
        flat = EdgeExponents(self.task.response, self.g)
        return Exponents(flat.α + 1.0, flat.β + 1.0)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """K_I at the left and the right end: 0, as both are free, (states, 2)."""
        return np.zeros((len(self.g), 2))

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Normal force over N/2, (states,)."""
        return np.array([state.level.contact.normal.sum() for state in self.contacts])

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Tangential force over N/2, (states,)."""
        return np.array([state.level.contact.tangential.sum() for state in self.contacts])

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by word of output.quantities."""
        words = self.contacts[0].estimates
        return {word: np.array([state.estimates[word] for state in self.contacts]) for word in words}

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface."""
        each = [state.surface for state in self.contacts]
        σ_YY, σ_XX, v_X = (np.array([getattr(own, name)[0] for own in each]) for name in _ON_SURFACE)
        turns = together([own.turns for own in each if own.turns is not None])
        return Surface(self.task.places, σ_YY, σ_XX, None, v_X, turns)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return np.stack([state.inside for state in self.contacts], axis=1)


#: Most kinks in a contact, and their largest distance from its middle over the half-width.
_MOST, _NEXT_TO_END = 12, 0.98

#: Distance over a from an end or a kink from which on stresses are looked at, the place itself besides:
#: in innermost cells, nearer than which these follow no logarithm; and where derivatives lose digits.
_CELLS, _DIGITS = 3.0, 1e-5

#: Places under the punch at which the pressure is measured.
_ACROSS = np.cos(np.pi * (np.arange(24) + 0.5) / 24.0)

#: Rings more around a cusp of the pressure; size of the innermost cells at a kink, over the tolerance.
_AROUND_CUSP, _INNERMOST = 4, 30.0

#: Size of the innermost cells at a tip, over the least distance from it at which stresses are evaluated.
_OF_TIP = 0.25

#: Weights of a single field.
ONE = np.ones((1, 1))


def places_of_kinks(body: Body, ends: Ends) -> NDArray[np.float64]:
    """Positions of the kinks under the contact, over the half-width from its middle, (k,).

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
    """Plan's refinement with rings no steeper than the usual ones of its mesh.

    They are steeper where cells are finer in angle, which does at ends that are free: the pressure at a
    kink is no power of the distance, and a ring that spans a fifth of it is slow to follow that.
    """
    rings, ratio = plan.refinement, plan.kind.ratio
    if rings.ratio >= ratio:
        return rings
    return replace(rings, levels=ceil(rings.levels * log(rings.ratio) / log(ratio)), ratio=ratio)


def rings_around_kinks(rings: Refinement, tolerance: float, body: Body) -> int:
    """Number of rings around kinks beyond those around the ends.

    Next to a kink of the slope's derivative the pressure is d log d, and its error in the innermost cells
    is of their size at any degree. At a tip the pressure is infinite, and stresses are evaluated farther
    away: if an innermost cell reached that far, no degree would resolve them at any tolerance.
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
        work: discretisation of all states.
        places: positions of the kinks over the half-width, (k,).
        body: the sliding contact.

    Attributes:
        plan: plan of all states.
    """

    def __init__(self, work: Discretisation, places: NDArray, body: Body) -> None:
        self._work, self._places, self._body, self.plan = work, places, body, work.plan
        rings = _gentle(work.plan)
        more = rings_around_kinks(rings, work.plan.tolerance, body)
        self._mesh = work.own_mesh(with_kinks(rings, places, more))

    @cached_property
    def finer(self) -> "OwnMeshes":
        """Spaces on a mesh with cells for a tighter tolerance."""
        return OwnMeshes(self._work.finer, self._places, self._body)

    def warn(self, text: str) -> None:
        """Warn the user."""
        self._work.warn(text)

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree."""
        return self._work.space_of(self._mesh, degree)


class KinkedLevel:
    """A contact at one degree; see :class:`galinx.solvers.fem.ladder.Level`.

    Args:
        work: has the words of the requested stresses.
        task: the speed, and the load.
        space: space of the degree, on cells graded towards the kinks.
        places: positions of the kinks over the half-width, (k,).
        ends: ends of the contact.
        g: σ_XY/σ_YY.

    Attributes:
        contact: nodal forces of the state.
        field: displacement over N/(2μ), condensed.
        displacement: stresses by that field.
        pressure: pressure of the contact.
        kinks: positions of the kinks at which the pressure is finite.
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
        local = EdgeExponents(task.response, self._g)
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
        """Gauges of the level's only state."""
        return [self._of_forces(), *self._gauges.of(self._g, ONE, self._on_surface())]

    @property
    def mirrored(self) -> bool:
        """False: the mirror image of the kinks has another mesh."""
        return False

    def rounding(self, g: NDArray) -> list[float]:
        """Effect of rounding on each gauge, relative; on the pressure by the solve's residual."""
        return [
            self.factor.largest_residual,
            *self._gauges.rounding(self._g, ONE, self._on_surface()),
        ]

    def release(self) -> None:
        """Keep all: a level holds a single vector."""

    def destroy(self) -> None:
        self.field.destroy()

    @property
    def nearest(self) -> float:
        """Distance over a from an end or a kink from which on stresses are good."""
        at = np.concatenate([[-1.0], self.kinks, [1.0]])
        return max(_CELLS * float(self.pressure.cells_beside(at).max()), _DIGITS)

    def _on_surface(self) -> NDArray[np.float64]:
        return self.pressure.σ_YY(self._task.places.X)[None]

    def _of_forces(self) -> Gauge:
        """Gauge of the pressure's moments over the load, and of the pressure over its largest.

        Kinks are among the places: there it is a limit, which has less digits than what it is taken from.
        """
        at_kinks = [self.pressure.at_kink(i) for i in range(len(self.kinks))]
        σ = np.append(self.pressure.σ_YY(self._across), at_kinks)[None]
        values, size = np.concatenate([self._moments, σ], axis=1), float(np.abs(σ).max())
        scale = np.concatenate([2.0 + 0.0 * self._moments, size + 0.0 * σ], axis=1)
        unresolved = self.pressure.left_at_kinks / size if at_kinks else 0.0
        return Gauge(INTENSITIES, values, scale, unresolved)


def _off(task: Task, tips: NDArray) -> Task:
    """Task without places next to tips, where stresses are infinite."""
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
        ends: ends of the contact.
        level: the last level.
        estimates: estimated relative errors by word of output.quantities.
        record: numbers of the work, as they are archived.
    """

    task: Task
    ends: Ends
    level: KinkedLevel
    estimates: dict[str, float]
    record: dict[str, Any]

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface, of a single state."""
        σ_YY = self.level.pressure.σ_YY(self.task.places.X)[None]
        surface = self.level.displacement.surface(self.level.contact.g, ONE, σ_YY)
        return replace(surface, turns=self._turns(surface))

    def _turns(self, surface: Surface) -> Turns:
        """Stresses at both ends, and under kinks where they are finite."""
        level, local = self.level, EdgeExponents(self.task.response, self.level.contact.g)
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
        """Residual of the integral equation under the pressure, relative."""
        level, ends, unit = self.level, self.ends, np.ones(1)
        local = EdgeExponents(self.task.response, level.contact.g)
        residuals = of_contact(
            self.task.response, level.contact.g, Exponents(local.α + 1.0, local.β + 1.0), self.task.body,
            lambda r: level.pressure.σ_YY(r)[None], (ends.centre * unit, ends.half_width * unit),
            level.pressure.kinks, level.pressure.breaks,
        )  # fmt: skip
        return float(residuals[0])

    def at(self, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (..., 2) over a, (3, ...)."""
        σ = self.level.displacement.at(points.reshape(1, -1, 2), ONE)
        return σ.reshape(3, *points.shape[:-1])

    def destroy(self) -> None:
        self.level.destroy()


def solved(work: Discretisation, task: Task, g: float, ends: Ends, done: WorkDone) -> KinkedState:
    """Solve the contact at a friction.

    Args:
        work: gives spaces.
        task: the speed, and the load.
        g: σ_XY/σ_YY.
        ends: ends of the contact.
        done: takes the numbers of the work.

    Raises:
        SolveError: cells cannot be graded towards its kinks, or the equations could not be solved.
    """
    places = places_of_kinks(task.body, ends)

    def level(space: Any, _: NDArray) -> KinkedLevel:
        contact = KinkedLevel(work, task, space, places, ends, g)
        done.count(contact)
        return contact

    of_one = np.array([g])
    with solved_to_tolerance(OwnMeshes(work, places, task.body), task, of_one, level) as (ladder, error):
        estimates = {word: float(values[0]) for word, values in error.of(of_one).items()}
        last: KinkedLevel = ladder.levels.pop()
    estimates[INTENSITIES] += ends.error
    size = {"cells": last.space.cells, "unknowns": last.space.size, "degree": last.space.degree}
    return KinkedState(task, ends, last, estimates, size | error.record())


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["KinkedAtSpeed"]:
    """Solver whose states are solved when first needed, each on meshes of its own."""
    with ends_at_speed(work.for_ends, task, g) as ends:
        at = KinkedAtSpeed(work, task, ends)
        try:
            yield at
        finally:
            at.destroy()


class KinkedAtSpeed(OwnMeshesAtSpeed):
    """Contacts at one speed, see :class:`OwnMeshesAtSpeed`.

    Args:
        work, task: as of :class:`OwnMeshesAtSpeed`.
        ends: ends of all its contacts.
    """

    def __init__(self, work: Discretisation, task: Task, ends: EndsAtSpeed) -> None:
        super().__init__(work, task)
        self._ends = ends

    def states(self, g: NDArray, load: Any = None) -> "KinkedPunches":
        body = self.task.body.loaded(load)
        of_each = np.broadcast_to(body.load, g.shape)
        solved_at = np.full(g.shape, self.task.body.load) if body.alike else of_each
        contacts = [self._state(*state) for state in zip(g.tolist(), solved_at.tolist())]
        growth = self.task.body.growth(of_each) if body.alike else np.ones(g.shape)
        return KinkedPunches(self.task, g, contacts, body, growth)

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
        growth: half-width of each state over that of its solved contact, (states,).
    """

    growth: NDArray[np.float64]

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of the contact [m], (states,)."""
        return self.growth * [state.ends.half_width for state in self.contacts]

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self.growth * [state.ends.centre for state in self.contacts]

    @property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        if jumps(self.body.profile):
            return np.full(len(self.g), np.nan), np.full(len(self.g), np.nan)
        values, places = np.array([state.largest for state in self.contacts]).T
        return values, places

    @property
    def residual(self) -> NDArray[np.float64]:
        """Residual of the integral equation under the pressure, relative, (states,)."""
        return np.array([state.residual for state in self.contacts])

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation of the punch's lowest point over N/(2μ), (states,)."""
        return np.array([state.level.contact.v0[0] for state in self.contacts])

    @cached_property
    def strength(self) -> Strength:
        """Yield of the states."""
        return Strength(
            self._stresses, self.body, self.task.response, self.g, self.local, self.half_width,
            self.surface.turns, max(state.level.nearest for state in self.contacts),
        )  # fmt: skip

    def _stresses(self, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, states, n), at points (1, n, 2) of all states or (states, n, 2)."""
        each = np.broadcast_to(points, (len(self.g), *points.shape[1:]))
        σ = [state.at(own) for state, own in zip(self.contacts, each)]
        return np.stack(σ, axis=1)
