"""Contacts with free ends by finite elements, each on a mesh drawn for it.

**Kinks.** The slope of a convex punch, or its derivative, may jump at places that depend on the state. So
the ends are solved for first, on the mesh of all speeds, where a few polynomial shapes give the ends of
every friction and every load, and cells need not resolve a kink (:class:`EndsLevel`). Then every state
has a mesh with cells graded towards its kinks (:class:`EndsBetweenKinks`).

**Layers** have a length, so each contact has a mesh drawn for its half-width. That is searched for by
:mod:`galinx.solvers.contact.ends`, at a lower degree first: the load that makes a contact of the mesh's
half-width is to be the load of the task (:class:`_Search`). Three displacements are prescribed under the
punch: its height around a nearby middle, the change of that height where the middle moves, and a
constant. Their loads and the intensities at both ends are linear in their amplitudes. So the half-width
of a mesh has a load of its own, at which both intensities vanish, and a middle: of a parabola at once, of
other profiles once the middle hardly moves (:class:`BalancedEnds`).

On the mesh of a contact the degree rises until the measured error is within tolerance. Where contacts of
all loads differ in size alone, a single state of a friction stands for all of them.
"""

from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from math import ceil, log
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.kind import DEGREES
from galinx.meshes.rings import Refinement, rings_at_kinks, with_kinks

from ..contact import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE, stresses
from ..contact.edges import EdgeExponents
from ..contact.ends import Punch, half_width_of_load
from ..contact.fem_plan import (
    NEAR_FREE_END,
    OWN_MESHES_KEPT,
    FemPlan,
    crowded_kinks,
    kind_of,
    no_nearer,
    pressure_moments,
    requirements,
)
from ..contact.free_ends import SHAPES, free_ends
from ..contact.pressure import ENDS, Expansion
from ..contact.recovery import KinkedPressure, gaps_of, slopes_towards_ends
from ..contact.solution import Contact, Task
from ..contact.stresses import NEAR_TIP, Places, Surface, Turns, at_and_between, off_tips
from ..errors import SolveError
from ..profiles import check_reach, cusp, exponent, jumps, kinks, leaving
from ..profiles.punches import Flat
from .contact import Ends, FreeEnds, PunchLevel, without_intensity
from .discretisation import Discretisation, on_finer_cells
from .ladder import Gauge, Solved, WorkDone, climb, joined, to_tolerance
from .solution import Solution, SolvedEnds, SolvedStates, solution_of
from .space import Space

#: A state by σ_XY/σ_YY and load [N/m]; a contact by middle and half-width [m].
State: TypeAlias = tuple[float, float]
Lengths: TypeAlias = tuple[float, float]

#: Both ends free, of a single state.
_FREE = np.ones((1, 2), dtype=bool)

#: Places under the punch at which the pressure is measured.
_ACROSS = np.cos(np.pi * (np.arange(24) + 0.5) / 24.0)


class EndsLevel(PunchLevel):
    """Ends of contacts under any convex punch at one degree; see :class:`PunchLevel`.

    Args:
        work, task, space, g: as of :class:`PunchLevel`.
        near: middles and half-widths [m] of states by σ_XY/σ_YY and load, from previous levels.
    """

    def __init__(
        self, work: Discretisation, task: Task, space: Space, g: NDArray, near: dict[State, Lengths]
    ) -> None:
        super().__init__(work, task, space, g, FreeEnds(SHAPES))
        self._near = near

    def lengths(self, g: NDArray, load: Any = None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Middle and half-width [m] of every state, (states, 2), and what shapes leave out, (states,).

        Raises:
            SolveError: no contact carries the load.
        """
        body, last, each = self.task.body, None, []
        _, N, K = self.parts(g)
        conditions = free_ends(EdgeExponents(self.task.response, g), K, N)
        loads = np.broadcast_to(body.loaded(load).load, g.shape).tolist()
        for state, condition in zip(zip(g.tolist(), loads), conditions):
            start = self._near.get(state, last)
            last = condition.solve(body.profile, body.loaded(state[1]).displacement, start)
            self._near[state] = last
            each.append(last)
        return np.array(each), np.array([condition.unseen for condition in conditions])

    def gauges(self, g: NDArray, load: Any = None) -> list[Gauge]:
        ends, unseen = self.lengths(g, load)
        h = ends[:, 1:]
        # Differences of the half-widths' logarithms are relative changes.
        groups = (np.log(h), 1.0), (ends[:, :1] / h, 1.0), (unseen[:, None], 1.0)
        return [joined(INTENSITIES, groups)]


#: Distance over a from an end or a kink from which on stresses are looked at, the place itself besides:
#: in innermost cells, nearer than which these follow no logarithm; and where derivatives lose digits.
_CELLS, _DIGITS = 3.0, 1e-5

#: Rings more around a cusp of the pressure; size of the innermost cells at a kink, over the tolerance.
_AROUND_CUSP, _INNERMOST = 4, 30.0

#: Size of the innermost cells at a tip, over the least distance from it at which stresses are evaluated.
_OF_TIP = 0.25


class EndsBetweenKinks(Ends):
    """Ends of one contact, solved for before, and kinks of the punch between them.

    Args:
        body: the sliding contact, under its load.
        lengths: middle and half-width [m].
        tolerance: of the scene.

    Raises:
        SolveError: cells cannot be graded towards the kinks.
    """

    single, mirrored = True, False

    def __init__(self, body: Contact, lengths: Lengths, tolerance: float) -> None:
        self._body, self._tolerance = body, tolerance
        self._centre, self._half_width = lengths
        at = (np.array(kinks(body.profile), dtype=float) - self._centre) / self._half_width
        #: Positions of the kinks over the half-width; of those at which stresses are infinite; of others.
        self._places = at[np.abs(at) < 1.0]
        if crowded := crowded_kinks(self._places):
            raise SolveError(f'the punch has {crowded}; take methods = ["closed_form"]')
        tip = bool(jumps(body.profile))
        self._tips: NDArray[np.float64] = self._places if tip else np.empty(0)
        self._kinks: NDArray[np.float64] = np.empty(0) if tip else self._places

    def drawn(self, plan: FemPlan) -> FemPlan:
        """Plan with a mesh whose cells are graded towards the kinks."""
        rings = _gentle(plan)
        return replace(plan, drawn=with_kinks(rings, self._places, self._more_rings(rings, plan)))

    def _more_rings(self, rings: Refinement, plan: FemPlan) -> int:
        """Number of rings around kinks beyond those around the ends.

        Next to a kink of the slope's derivative the pressure is d log d, and its error in the innermost
        cells is of their size at any degree. At a tip the pressure is infinite, and stresses are
        evaluated farther away: if an innermost cell reached that far, no degree would resolve them at
        any tolerance.
        """
        if cusp(self._body.profile):
            return _AROUND_CUSP
        if len(self._tips):
            size = _OF_TIP * NEAR_TIP
        else:
            order = max((exponent(self._body.profile) or 2.0) - 1.0, 1.0)
            size = (_INNERMOST * plan.tolerance) ** (1.0 / order)
        return max(0, rings_at_kinks(rings, size))

    def heights(self, level: PunchLevel) -> NDArray[np.float64]:
        X = self._centre + self._half_width * level.r
        return np.asarray(self._body.profile.height(X) / self._body.displacement)

    def solved(self, level: PunchLevel, g: NDArray, body: Contact) -> SolvedEnds:
        half_width, centre = np.full(1, self._half_width), np.full(1, self._centre)
        return SolvedEnds(level.punch.states(g), half_width, centre, _FREE)

    def pressure(self, level: PunchLevel, ends: SolvedEnds) -> KinkedPressure:
        space, contact, profile = level.space, ends.contact, self._body.profile
        return KinkedPressure(
            space.contact.s, space.degree, space.chart, contact.normal[0], self._places,
            _exponents(level.task, contact.g), leaving(profile), self._tolerance, bool(jumps(profile)),
        )  # fmt: skip

    def continuation(self, level: PunchLevel) -> Callable[[NDArray], Any]:
        exponents, gaps = _exponents(level.task, level.g), gaps_of(self._places)
        return lambda X: slopes_towards_ends(X, gaps, exponents)

    def nearest(self, pressure: KinkedPressure) -> float:
        at = np.concatenate([[-1.0], self._kinks, [1.0]])
        return max(_CELLS * float(pressure.cells_beside(at).max()), _DIGITS)

    def task(self, task: Task) -> Task:
        """Task without places next to tips, where stresses are infinite."""
        places, tips = task.places, self._tips
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

    def gauge(self, level: PunchLevel, states: SolvedStates) -> Gauge:
        """Gauge of the pressure's moments over the load, and of the pressure over its largest.

        Kinks are among the places: there it is a limit, which has less digits than what it is taken from.
        """
        pressure, moments = states.pressure, states.contact.tested(level.moments[:, 1:6])
        at_kinks = [pressure.at_kink(i) for i in range(len(self._kinks))]
        σ = np.append(pressure.σ_YY(_ACROSS[off_tips(_ACROSS, self._tips)]), at_kinks)[None]
        size = float(np.abs(σ).max())
        unresolved = pressure.left_at_kinks / size if at_kinks else 0.0
        return joined(INTENSITIES, ((moments, 2.0), (σ, size)), unresolved)

    def turns(self, states: SolvedStates, surface: Surface) -> Turns:
        """Limits of stresses at both ends, and under kinks where they are finite."""
        X, pressure, strain = self._kinks, states.pressure, states.displacement.strain
        σ_YY = np.array([pressure.at_kink(i) for i in range(len(X))])
        u_X = np.array([pressure.limit_at_kink(i, strain) for i in range(len(X))])
        g, response = float(states.contact.g[0]), states.task.response
        under = np.array([response.σ_XX(u_X, σ_YY, g * σ_YY), σ_YY, g * σ_YY])

        def in_plane(r: NDArray) -> NDArray[np.float64]:
            r = np.clip(r, _DIGITS - 1.0, 1.0 - _DIGITS)  # at an end itself a slope has no digits
            σ = pressure.σ_YY(r)
            return np.atleast_2d(response.σ_XX(strain(r), σ, g * σ))

        between = None
        if len(X):
            places = np.array([-1.0, *X, 1.0])
            # Nearer to ends and kinks the limits there stand for the stress.
            _, between = at_and_between(places, in_plane, nearest=self.nearest(pressure))
        return super().turns(states, surface).joined(Turns(X[None], under[:, None], between))


def _gentle(plan: FemPlan) -> Refinement:
    """Plan's refinement with rings no steeper than the usual ones of its mesh.

    They are steeper where cells are finer in angle, which does at ends that are free: the pressure at a
    kink is no power of the distance, and a ring that spans a fifth of it is slow to follow that.
    """
    rings, ratio = plan.refinement, plan.kind.ratio
    if rings.ratio >= ratio:
        return rings
    return replace(rings, levels=ceil(rings.levels * log(rings.ratio) / log(ratio)), ratio=ratio)


def _exponents(task: Task, g: NDArray) -> tuple[float, float]:
    """Exponents of a single state's pressure at its left and its right free end."""
    local = EdgeExponents(task.response, g)
    return float(local.β[0]) + 1.0, float(local.α[0]) + 1.0


#: Growth of the load's logarithm with that of the half-width, as on a half-plane under a parabola.
GROWTH = 2.0


class BalancedEnds(Ends):
    """Ends of one contact over layers, without intensities, on a mesh drawn for its half-width.

    The contact has that half-width under a load of its own. Its half-width under the task's load is
    estimated by the growth of loads on a half-plane.

    Args:
        profile: profile of the punch.
        half_width: half-width of the mesh [m].
        near: middle of a contact near by [m].
    """

    single, mirrored = True, False

    def __init__(self, profile: Any, half_width: float, near: float) -> None:
        self._profile, self._half_width, self._near = profile, half_width, near

    def heights(self, level: PunchLevel) -> NDArray[np.float64]:
        h, unit = self._half_width, level.task.body.displacement
        X = self._near + h * level.r
        return np.stack([self._profile.height(X) / unit, h * self._profile.slope(X) / unit])

    def solved(self, level: PunchLevel, g: NDArray, body: Contact) -> SolvedEnds:
        """Contact without intensities.

        Raises:
            SolveError: no load makes such a contact.
        """
        (parts, loads, K), h = level.parts(g), self._half_width
        amplitudes = without_intensity(loads, K)
        # Over its own load the punch's height is that over the task's load times their quotient.
        _, share, slope = amplitudes[0].tolist()
        if not share > 0.0:
            raise SolveError(f"finite elements found no load for a contact of the half-width {h:g} m")
        half_width, centre = h * share ** (1.0 / GROWTH), self._near + h * slope / share
        contact = level.punch.summed(g, parts, amplitudes)
        return SolvedEnds(contact, np.full(1, half_width), np.full(1, centre), _FREE)

    def pressure(self, level: PunchLevel, ends: SolvedEnds) -> Expansion:
        return level.over_flat(ends.contact.tested(level.moments), ends.contact.g, 1.0)

    def continuation(self, level: PunchLevel) -> Callable[[NDArray], Any]:
        assert level.plan.tests
        gap, exponents = min(1.0, level.plan.tests.stretch.h), _exponents(level.task, level.g)
        return lambda X: slopes_towards_ends(X, (gap, gap), exponents)

    def gauge(self, level: PunchLevel, states: SolvedStates) -> Gauge:
        """Gauge of the pressure, its moments over the load, and half-width and middle of the contact."""
        pressure, moments = states.pressure, states.contact.tested(level.moments[:, 1:6])
        h, σ = self._half_width, pressure.σ_YY(_ACROSS)
        # Differences of the half-widths' logarithms are relative changes.
        lengths = np.column_stack([np.log(states.ends.half_width / h), states.ends.centre / h])
        # What the last functions add is largest where they are multiplied by most.
        factor = np.abs(pressure.series(_ACROSS)).max(axis=1)
        ends = np.abs(pressure.series(ENDS)).max(axis=1)
        groups = (σ, stresses.of_factor(σ)), (moments, 2.0), (lengths, 1.0)
        return joined(INTENSITIES, groups, pressure.unresolved * ends / factor)


def scaled(task: Task, half_width: float) -> Task:
    """Task under one load whose lengths are over the half-width [m] of a contact."""
    depths = task.body.solid.depths / half_width  # type: ignore[attr-defined]
    return replace(
        task,
        body=replace(task.body, profile=Flat(half_width)),
        response=replace(task.response, a=half_width),  # type: ignore[type-var]
        places=replace(task.places, interfaces=depths),
    )


def drawn_for(task: Task, plan: FemPlan, words: frozenset[str]) -> FemPlan:
    """Plan of a mesh drawn for a contact over layers.

    Args:
        task: the task of :func:`scaled`.
        plan: plan of all contacts.
        words: words of output.quantities that request stresses.
    """
    places, interfaces = task.places, task.places.interfaces
    kind = kind_of(interfaces, [task.response])
    below = places.points if BELOW in words else np.empty((0, 2))
    if AT_INTERFACES in words:
        X, depth = np.meshgrid(places.along, interfaces)
        below = np.concatenate([below, np.column_stack([X.ravel(), -depth.ravel()])])
    X = places.X if ON_SURFACE in words else np.empty(0)
    requested = Places(X, below, places.around)
    target = requirements(plan.tolerance, requested, plan.sharp, task.response.spread)
    # Stresses are finite at the ends, but the fields whose sum has no intensity have one each.
    target = no_nearer(target, NEAR_FREE_END)
    degree = kind.degree(target, task.response.margin)
    return replace(
        plan, kind=kind, wanted=target, drawn=kind.drawn(target), degrees=(degree,) * len(plan.degrees),
        tests=pressure_moments(task.body.solid, kind, target),
    )  # fmt: skip


#: Error of the half-width at a lower degree, and by how much that is lower; the error over the tolerance
#: at the usual degree.
_ROUGH, _LOWER, _SETTLED = 3e-2, 3, 0.5
#: Least difference of the half-width's logarithm from which the growth of the load is computed.
_APART = 1e-5
#: Largest error of the half-width over the tolerance once all is solved; else another mesh is drawn.
_ERROR = 0.3


class _Search:
    """Search for the half-width and the middle of a contact over layers.

    Args:
        work: gives meshes.
        task: the speed, and the load.
        g: σ_XY/σ_YY.
        done: takes the numbers of the work.
    """

    def __init__(self, work: Discretisation, task: Task, g: float, done: WorkDone) -> None:
        self._work, self._task, self._g, self._done = work, task, np.array([g]), done
        #: Middle over the half-width; logarithms of loads, by the half-width, at the last degree.
        self._lean = 0.0
        self._tried: dict[float, float] = {}

    def solved(self, near: float) -> "OwnState":
        """Contact solved to the tolerance.

        Args:
            near: half-width of a contact near by [m].

        Raises:
            SolveError: no contact was found, or the equations could not be solved.
        """
        drawn, profile = self._half_width(near), self._task.body.profile
        state, lean, h = self._solved_on(drawn)
        if abs(h / drawn - 1.0) > _ERROR * self._work.plan.tolerance:
            state.solved.close()
            drawn = h
            state, lean, h = self._solved_on(drawn)
        check_reach(profile, h * (lean - 1.0), h * (lean + 1.0))
        ends = replace(state.states.ends, half_width=np.array([h]), centre=np.array([h * lean]))
        errors = {word: value + abs(h / drawn - 1.0) for word, value in state.states.errors.items()}
        return replace(
            state, states=replace(state.states, body=self._task.body, ends=ends, errors=errors)
        )

    def _solved_on(self, h: float) -> tuple["OwnState", float, float]:
        """Contact on a mesh drawn for a half-width [m]; its middle over its half-width, and this [m]."""
        mesh, task = self._on(h, self._work.stresses)
        state = own_state(mesh, task, self._g, self._ends(h), self._done)
        off, lean = _balanced(state.solved.level, h)
        return state, lean, self._moved(h, off)

    def _half_width(self, h: float) -> float:
        """Half-width [m] of the contact that carries the load, from a half-width near by."""
        body, settled = self._task.body, _SETTLED * self._work.plan.tolerance
        punch = Punch(body.profile, 1.0, float(body.compression))
        for lower, error in ((_LOWER, max(_ROUGH, settled)), (0, settled)):
            # Loads of a low degree do not compare with those of a high one.
            self._tried = {}
            h = half_width_of_load(lambda h: self._off(h, lower, error), h, punch, error)  # noqa: B023
            h = self._moved(h, self._tried[h])
        return h

    def _moved(self, h: float, off: float) -> float:
        """Half-width under the task's load, by that under a load near by; its logarithm is off."""
        (first, of_first), *_, (last, of_last) = 2 * [*self._tried.items()]
        apart = float(np.log(last / first))
        growth = (of_last - of_first) / apart if abs(apart) > _APART else GROWTH
        return h * float(np.exp(-off / growth))

    def _off(self, h: float, lower: int, error: float) -> float:
        """Logarithm of the load that makes a contact of half-width h [m], over the task's.

        Args:
            h: half-width [m].
            lower: difference of the degree from the usual one.
            error: relative error that is allowed.
        """
        mesh, task = self._on(h, frozenset())
        degree = max(mesh.plan.degrees[task.number] - lower, DEGREES[0])
        moved = np.inf
        while moved**2 > error:  # the shift of the middle is accurate to its square
            with closing(PunchLevel(mesh, task, mesh.space(degree), self._g, self._ends(h))) as level:
                self._done.count(level.factor)
                off, lean = _balanced(level, h)
            moved, self._lean = lean - self._lean, lean
        self._tried[h] = off
        return off

    def _on(self, h: float, words: frozenset[str]) -> tuple[Discretisation, Task]:
        """Mesh drawn for a half-width [m], and the task with lengths over it."""
        task = scaled(self._task, h)
        return self._work.on(drawn_for(task, self._work.plan, words), words), task

    def _ends(self, h: float) -> BalancedEnds:
        return BalancedEnds(self._task.body.profile, h, h * self._lean)


def _balanced(level: PunchLevel, h: float) -> tuple[float, float]:
    """Logarithm of the load of a contact of half-width h [m], over the task's, and its middle over h."""
    ends = level.only
    assert ends
    return -GROWTH * float(np.log(ends.half_width[0] / h)), float(ends.centre[0] / h)


@dataclass(frozen=True)
class OwnState:
    """State solved on a mesh of its own: the state, and how it was solved."""

    states: SolvedStates
    solved: Solved


def own_state(mesh: Discretisation, task: Task, g: NDArray, ends: Ends, done: WorkDone) -> OwnState:
    """Solve a contact on its mesh, the degree raised to the tolerance.

    Args:
        mesh: mesh of the contact.
        task: the speed, and the load.
        g: σ_XY/σ_YY, (1,).
        ends: ends of the contact.
        done: takes the numbers of the work.
    """
    solved = to_tolerance(mesh, task, g, lambda space, g: PunchLevel(mesh, task, space, g, ends), done)
    (states,) = solved.on_mesh(g)
    return OwnState(states, solved)


class OwnMeshesAtSpeed:
    """Contacts at one speed, each solved on its mesh when first needed; the last few are kept.

    Args:
        task: the speed.
        solve: solves a contact of σ_XY/σ_YY for the task under one load, given the kept states by both.
        done: has the numbers of the work.
    """

    def __init__(
        self, task: Task, solve: Callable[[float, Task, dict[State, OwnState]], OwnState], done: WorkDone
    ) -> None:
        self._task, self._solve, self._done = task, solve, done
        self._record: dict[str, Any] = {"cells": 0, "unknowns": 0, "degree": 0}
        #: States by σ_XY/σ_YY and load, in the order of their last use.
        self._kept: dict[State, OwnState] = {}

    def states(self, g: NDArray, load: Any = None) -> Solution:
        return solution_of(self._task, self._solved, g, load)

    def _solved(self, g: NDArray, load: Any) -> list[SolvedStates]:
        loads = np.broadcast_to(self._task.body.loaded(load).load, g.shape).tolist()
        return [self._state(*state).states for state in zip(g.tolist(), loads)]

    def _state(self, g: float, load: float) -> OwnState:
        state = self._kept.pop((g, load), None)
        if state is None:
            task = replace(self._task, body=self._task.body.loaded(load), loads=(load,))
            state = self._solve(g, task, self._kept)
            for name, value in state.solved.record().items():
                self._record[name] = max(self._record.get(name, value), value)
        self._kept[g, load] = state
        while len(self._kept) > OWN_MESHES_KEPT:
            self._kept.pop(next(iter(self._kept))).solved.close()
        return state

    def record(self) -> dict[str, Any]:
        return self._record | vars(self._done)

    def close(self) -> None:
        """Free the kept states."""
        for state in self._kept.values():
            state.solved.close()


@contextmanager
def over_layers(work: Discretisation, task: Task, g: NDArray) -> Iterator[OwnMeshesAtSpeed]:
    """Contacts over layers, whose ends are searched for on meshes that follow them."""
    done = WorkDone()

    def solve(g: float, alone: Task, kept: dict[State, OwnState]) -> OwnState:
        # Half-widths of solved states under the load by the difference of their frictions.
        near = [
            (abs(other - g), float(state.states.ends.half_width[0]))
            for (other, load), state in kept.items()
            if load == alone.body.load
        ]
        first = min(near)[1] if near else float(alone.body.half_width)
        return _Search(work, alone, g, done).solved(first)

    with closing(OwnMeshesAtSpeed(task, solve, done)) as at:
        yield at


@contextmanager
def between_kinks(work: Discretisation, task: Task, g: NDArray) -> Iterator[OwnMeshesAtSpeed]:
    """Contacts with kinks, whose ends are solved for first: to the tolerance, for sample states."""
    near: dict[State, Lengths] = {}

    def level(space: Space, g: NDArray) -> EndsLevel:
        return EndsLevel(work.for_ends, task, space, g, near)

    done = WorkDone()
    with closing(climb(work.for_ends, task, g, level, done=done)) as solved:

        def solve(g: float, alone: Task, kept: dict[State, OwnState]) -> OwnState:
            of = np.array([g])
            load = alone.body.load
            (lengths,), unseen = solved.level.lengths(of, np.array([load]))
            ends = EndsBetweenKinks(alone.body, tuple(lengths.tolist()), work.plan.tolerance)
            mesh = work.on(ends.drawn(work.plan), refine=lambda plan: ends.drawn(on_finer_cells(plan)))
            state = own_state(mesh, alone, of, ends, done)
            state.states.errors[INTENSITIES] += solved.error.of(of, load)[INTENSITIES] + unseen
            return state

        with closing(OwnMeshesAtSpeed(task, solve, done)) as at:
            yield at
