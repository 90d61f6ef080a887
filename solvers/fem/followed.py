"""Contacts with free ends over layers, by finite elements on meshes drawn for each contact.

Layers have a length, so each contact has a mesh drawn for its half-width. The half-width is solved for on
a few meshes, at a lower degree at first, until the load that makes a contact of that size is the load of
the task; then the degree rises until the measured error is within tolerance (:class:`FollowedState`).

Three displacements are prescribed under the punch: its height around a nearby middle, the change of that
height where the middle moves, and a constant. Their loads and the intensities at both ends are linear in
their amplitudes. So the half-width of a mesh has a load of its own, at which both intensities vanish, and
a middle: of a parabola at once, of other profiles once the middle hardly moves (:class:`FollowedLevel`).
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.kind import DEGREES

from ..contact import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE, stresses
from ..contact.edges import EdgeExponents
from ..contact.fem_plan import (
    FemPlan,
    kind_of,
    pressure_moments,
    required_of_free_ends_on_layers,
    requirements,
)
from ..contact.recovery import contact_recovery, largest, stretched_from_moments
from ..contact.solution import Places, Surface, Task
from ..errors import SolveError
from ..profiles import check_reach
from ..profiles.flat import Flat
from .contact import negligible, tests_of
from .discretisation import Discretisation, on_finer_cells
from .displacement import KinkedDisplacement
from .kinked import OnOwnMeshes, OwnMeshesAtSpeed, alone
from .ladder import Gauge, StressGauges, WorkDone, solved_to_tolerance
from .punch import ContactStates, Part, SlidingPunch, combined
from .space import Space

#: Places under the punch at which the pressure is measured.
_ACROSS = np.cos(np.pi * (np.arange(24) + 0.5) / 24.0)
#: Weights of a single field.
ONE = np.ones((1, 1))
#: Growth of the load's logarithm with that of the half-width, as on a half-plane under a parabola.
GROWTH = 2.0


@dataclass(frozen=True)
class Sized:
    """Task scaled to a contact: its lengths are over the contact's half-width.

    Attributes:
        task: the task, under one load.
        half_width: half-width of the contact [m].
    """

    task: Task
    half_width: float

    @cached_property
    def scaled(self) -> Task:
        """The task with lengths over the half-width."""
        task, h = self.task, self.half_width
        places, depths = task.places, task.body.solid.depths / h  # type: ignore[attr-defined]
        return replace(
            task,
            body=replace(task.body, profile=Flat(h)),
            response=replace(task.response, a=h),  # type: ignore[type-var]
            places=replace(places, interfaces=depths),
        )

    def plan(self, plan: FemPlan, words: frozenset[str], tolerance: float) -> FemPlan:
        """Plan of a mesh drawn for the contact.

        Args:
            plan: plan of all contacts.
            words: words of output.quantities that request stresses.
            tolerance: relative tolerance.
        """
        scaled = self.scaled
        places, interfaces = scaled.places, scaled.places.interfaces
        kind = kind_of(interfaces, [scaled.response])
        below = places.points if BELOW in words else np.empty((0, 2))
        if AT_INTERFACES in words:
            X, depth = np.meshgrid(places.along, interfaces)
            below = np.concatenate([below, np.column_stack([X.ravel(), -depth.ravel()])])
        X = places.X if ON_SURFACE in words else np.empty(0)
        requested = Places(X, below, places.around)
        target = requirements(tolerance, requested, plan.sharp, scaled.response.spread)
        target = required_of_free_ends_on_layers(target)
        degree = kind.degree(target, scaled.response.margin)
        return replace(
            plan, kind=kind, wanted=target, drawn=kind.drawn(target),
            degrees=(degree,) * len(plan.degrees),
            tests=pressure_moments(scaled.body.solid, kind, target),
        )  # fmt: skip


class FollowingMesh:
    """Spaces on a mesh of one contact; see :class:`Discretisation`.

    Args:
        work: discretisation of all contacts.
        plan: plan of the mesh.
        stresses: words of output.quantities that request stresses.
    """

    def __init__(self, work: Discretisation, plan: FemPlan, stresses: frozenset[str]) -> None:
        assert plan.drawn
        self._work, self.plan, self.stresses, self.clock = work, plan, stresses, work.clock
        self._mesh = work.own_mesh(plan.drawn)

    @cached_property
    def finer(self) -> "FollowingMesh":
        """Spaces on a mesh with cells for a tighter tolerance."""
        return FollowingMesh(self._work, on_finer_cells(self.plan), self.stresses)

    def warn(self, text: str) -> None:
        """Warn the user."""
        self._work.warn(text)

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree."""
        return self._work.space_of(self._mesh, degree)


class FollowedLevel:
    """A contact at one degree; see :class:`galinx.solvers.fem.ladder.Level`.

    Args:
        work: the mesh, and the words of the requested stresses.
        task: the task with lengths over the mesh's half-width.
        space: space of the degree.
        g: σ_XY/σ_YY.
        profile: profile of the punch.
        near: middle of a contact near by [m].

    Attributes:
        contact: nodal forces of the state, over the task's load.
        off: logarithm of the load that makes a contact of this half-width, over the task's load.
        centre: middle of the contact over its half-width.
        field: displacement over N/(2μ), condensed.
        pressure: pressure of the contact.
        factor: of the linear system, freed, with numbers of its work.
    """

    def __init__(
        self, work: FollowingMesh, task: Task, space: Space, g: float, profile: Any, near: float
    ) -> None:
        self.space, self._g, self._task, plan = space, np.array([g]), task, work.plan
        assert plan.tests
        stretch = plan.tests.stretch
        r = space.chart.surface_position(space.contact.s)
        h, unit = task.body.half_width, task.body.displacement
        shapes = profile.height(near + h * r) / unit, h * profile.slope(near + h * r) / unit
        solved = SlidingPunch(space, task.response, plan.solver, negligible(work), np.stack(shapes))  # type: ignore[arg-type]
        more = space.degree - plan.degrees[task.number]
        recovery = contact_recovery(
            space.contact.s, space.degree, space.chart, np.empty(0), tests=tests_of(plan, more)
        )
        local = EdgeExponents(task.response, self._g)
        try:
            self.factor = solved.factor

            def K_I(part: Part) -> NDArray[np.float64]:
                moments = part.tested(recovery.moments)
                return stretched_from_moments(moments, local.α, local.β, stretch).K_I[0]

            self.contact, self.off, moved = _balanced(solved, self._g, K_I, h)
            self.centre = near / h + moved
            self.field = solved.fields[0].duplicate()
            self.field.zeroEntries()
            self.field.maxpy(self.contact.weights[0].tolist(), solved.fields)
        finally:
            solved.destroy()
        self._moments = self.contact.tested(recovery.moments)
        self.pressure = stretched_from_moments(self._moments, local.α + 1.0, local.β + 1.0, stretch)
        gap = min(1.0, stretch.h)
        exponents = float(local.β[0]) + 1.0, float(local.α[0]) + 1.0
        self.displacement = KinkedDisplacement(task, space, self.field, (gap, gap), exponents)
        self._gauges = StressGauges(work, task, self.displacement.at_places_of)  # type: ignore[arg-type]

    @property
    def half_width(self) -> float:
        """Half-width of the contact under the task's load, over the mesh's half-width, approximately."""
        return float(np.exp(-self.off / GROWTH))

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        """Gauges of the level's only state."""
        σ_YY = self.pressure.σ_YY(self._task.places.X)
        return [self._of_forces(), *self._gauges.of(self._g, ONE, σ_YY)]

    def _of_forces(self) -> Gauge:
        """Gauge of the pressure, its moments over the load, and half-width and middle of the contact."""
        σ = self.pressure.σ_YY(_ACROSS)
        moments, lengths = self._moments[:, 1:6], np.array([[self.off / GROWTH, self.centre]])
        values = np.concatenate([σ, moments, lengths], axis=1)
        of_others = [2.0 + 0.0 * moments, np.ones_like(lengths)]
        # What the last functions add is largest where they are multiplied by most.
        factor = np.abs(self.pressure.factor(_ACROSS)).max(axis=1)
        ends = np.abs(self.pressure.factor(np.array([-1.0, 1.0]))).max(axis=1)
        unresolved = self.pressure.unresolved * ends / factor
        return Gauge(
            INTENSITIES, values, np.concatenate([stresses.of_factor(σ), *of_others], axis=1), unresolved
        )

    @property
    def mirrored(self) -> bool:
        """False: the mirror image of the state is another contact."""
        return False

    def rounding(self, g: NDArray) -> list[float]:
        """Effect of rounding on each gauge, relative; on the pressure by the solve's residual."""
        σ_YY = self.pressure.σ_YY(self._task.places.X)
        return [self.factor.largest_residual, *self._gauges.rounding(self._g, ONE, σ_YY)]

    def release(self) -> None:
        """Keep all: a level holds a single vector."""

    def destroy(self) -> None:
        self.field.destroy()


def _balanced(
    solved: SlidingPunch, g: NDArray, K_I: Any, half_width: float
) -> tuple[ContactStates, float, float]:
    """State without intensities, logarithm of its load over the task's, and shift of its middle over the
    half-width [m].

    Raises:
        SolveError: no load makes such a contact.
    """
    parts = solved.parts(g)
    K = np.stack([K_I(part) for part in parts], axis=1)
    loads = np.array([part.load[0] for part in parts])
    amplitudes = np.linalg.solve(np.vstack([loads, K]), np.array([-2.0, 0.0, 0.0]))
    # Over its own load the punch's height is that over the task's load times their quotient.
    _, share, slope = amplitudes.tolist()
    if not share > 0.0:
        raise SolveError(
            f"finite elements found no load for a contact of the half-width {half_width:g} m"
        )
    states = combined(g, parts, amplitudes[None])
    return states, float(-np.log(share)), slope / share


#: Meshes at most, the largest step of the half-width's logarithm, and the least and the most by which the
#: load's may grow with it.
_MESHES, _LARGEST, _SLOPES = 40, 1.2, (0.5, 15.0)
#: Step of the half-width's logarithm below which the degree is raised, by how much it is lower until
#: then, and step over the tolerance below which the half-width is accepted.
_ROUGH, _LOWER, _SETTLED = 3e-2, 3, 0.1
#: Least difference of the half-width's logarithm from which the growth of the load is computed.
_APART = 1e-5
#: Largest error of the half-width over the tolerance once all is solved; else another mesh is drawn.
_ERROR = 0.3

#: No stresses.
_NONE: frozenset[str] = frozenset()


@dataclass(frozen=True)
class FollowedState:
    """A solved contact; lengths over its half-width from its middle.

    Attributes:
        task: the speed and the load, with lengths over the half-width.
        half_width, centre: half-width and middle of the contact [m].
        level: the last level.
        estimates: estimated relative errors by word of output.quantities.
        record: numbers of the work, as they are archived.
    """

    task: Task
    half_width: float
    centre: float
    level: FollowedLevel
    estimates: dict[str, float]
    record: dict[str, Any]

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface, of a single state."""
        σ_YY = self.level.pressure.σ_YY(self.task.places.X)
        return self.level.displacement.surface(self.level.contact.g, ONE, σ_YY)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, m)."""
        return self.level.displacement.inside(ONE)[:, 0]

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, interfaces, n)."""
        return self.level.displacement.interfaces(ONE)[:, 0]

    def destroy(self) -> None:
        self.level.destroy()


class _Contact:
    """Search for the half-width and the middle of a contact.

    Args:
        work: gives meshes.
        task: the speed, and the load.
        g: σ_XY/σ_YY.
        done: takes the numbers of the work.
    """

    def __init__(self, work: Discretisation, task: Task, g: float, done: WorkDone) -> None:
        self.work, self.task, self.g, self.done = work, task, g, done
        self._growth, self._centre = GROWTH, 0.0
        self._before: tuple[float, float] | None = None

    def settled(self, h: float) -> float:
        """Half-width [m] of the contact that carries the load, from a half-width near by.

        Raises:
            SolveError: no half-width was found.
        """
        x, tolerance, rough = float(np.log(h)), self.work.plan.tolerance, True
        for _ in range(_MESHES):
            off, lean = self._off(float(np.exp(x)), rough)
            self._learn(x, off)
            x_next = self.moved(x, off)
            # The shift of the middle is accurate to its square.
            step = max(abs(x_next - x), lean**2)
            if not rough and step <= _SETTLED * tolerance:
                return float(np.exp(x_next))
            if rough and step <= max(_ROUGH, _SETTLED * tolerance):
                # Loads of a low degree do not compare with those of a high one.
                rough, self._before = False, None
            x = x_next
        raise SolveError(
            f"finite elements did not find the half-width of the contact: after {_MESHES} meshes it is "
            f"near {np.exp(x):.6g} m and still moves; take a speed farther from the limit"
        )

    def moved(self, x: float, off: float) -> float:
        """Next logarithm of the half-width, by the growth of the load with it."""
        return x - float(np.clip(off / self._growth, -_LARGEST, _LARGEST))

    def _learn(self, x: float, off: float) -> None:
        """Update the growth of the load with the half-width, by two half-widths of equal degree."""
        if self._before is not None and abs(x - self._before[0]) > _APART:
            low, high = _SLOPES
            self._growth = float(np.clip((off - self._before[1]) / (x - self._before[0]), low, high))
        self._before = x, off

    def _off(self, h: float, rough: bool) -> tuple[float, float]:
        """Logarithm of the load that makes a contact of half-width h [m], over the task's; and shift of
        the middle over h."""
        sized = Sized(self.task, h)
        plan = sized.plan(self.work.plan, _NONE, self.work.plan.tolerance)
        degree = plan.degrees[self.task.number]
        mesh = FollowingMesh(self.work, plan, _NONE)
        space = mesh.space(max(degree - _LOWER, DEGREES[0]) if rough else degree)
        level = self.level(mesh, sized.scaled, space)
        level.destroy()
        before, self._centre = self._centre, h * level.centre
        return level.off, (self._centre - before) / h

    def level(self, mesh: FollowingMesh, task: Task, space: Any) -> FollowedLevel:
        """The contact on a space."""
        profile = self.task.body.profile
        contact = FollowedLevel(mesh, task, space, self.g, profile, self._centre)
        self.done.count(contact)
        return contact

    def solved(self, h: float) -> tuple[Sized, FollowedLevel, dict[str, float]]:
        """Contact on a mesh drawn for a half-width [m], solved to the tolerance; errors by word."""
        sized = Sized(self.task, h)
        words = self.work.stresses
        mesh = FollowingMesh(
            self.work, sized.plan(self.work.plan, words, self.work.plan.tolerance), words
        )
        g = np.array([self.g])

        def level(space: Any, _: NDArray) -> FollowedLevel:
            return self.level(mesh, sized.scaled, space)

        with solved_to_tolerance(mesh, sized.scaled, g, level) as (ladder, error):
            of = {word: float(values[0]) for word, values in error.of(g).items()}
            self.record = error.record()
            return sized, ladder.levels.pop(), of


def solved(work: Discretisation, task: Task, g: float, near: float, done: WorkDone) -> FollowedState:
    """Solve the contact at a friction.

    Args:
        work: gives meshes.
        task: the speed, and the load.
        g: σ_XY/σ_YY.
        near: half-width of a contact near by [m].
        done: takes the numbers of the work.

    Raises:
        SolveError: no contact was found, or the equations could not be solved.
    """
    contact = _Contact(work, task, g, done)
    h = contact.settled(near)
    sized, last, estimates = contact.solved(h)
    h = float(np.exp(contact.moved(float(np.log(h)), last.off)))
    if abs(h / sized.half_width - 1.0) > _ERROR * work.plan.tolerance:
        last.destroy()
        sized, last, estimates = contact.solved(h)
        h = float(np.exp(contact.moved(float(np.log(h)), last.off)))
    check_reach(task.body.profile, h * (last.centre - 1.0), h * (last.centre + 1.0))
    off = abs(h / sized.half_width - 1.0)
    estimates = {word: value + off for word, value in estimates.items()}
    assert INTENSITIES in estimates
    size = {"cells": last.space.cells, "unknowns": last.space.size, "degree": last.space.degree}
    return FollowedState(sized.scaled, h, h * last.centre, last, estimates, size | contact.record)


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["FollowedAtSpeed"]:
    """Solver whose states are solved when first needed, each on meshes of its own."""
    at = FollowedAtSpeed(work, task)
    try:
        yield at
    finally:
        at.destroy()


class FollowedAtSpeed(OwnMeshesAtSpeed):
    """Contacts at one speed, see :class:`OwnMeshesAtSpeed`."""

    def states(self, g: NDArray, load: Any = None) -> "FollowedPunches":
        body = self.task.body.loaded(load)
        loads = np.broadcast_to(body.load, g.shape).tolist()
        contacts = [self._state(*state) for state in zip(g.tolist(), loads)]
        return FollowedPunches(self.task, g, contacts, body)

    def _solve(self, g: float, load: float) -> FollowedState:
        task = alone(self.task, load)
        return solved(self.work, task, g, self._near(g, load, task), self._done)

    def _near(self, g: float, load: float, task: Task) -> float:
        """Half-width [m] to begin with: that of the solved state of nearest friction, or that at rest."""
        same = [
            (abs(other - g), state.half_width) for (other, N), state in self._kept.items() if load == N
        ]
        return min(same)[1] if same else float(task.body.half_width)


class FollowedPunches(OnOwnMeshes):
    """Punches over layers with several frictions and loads."""

    @property
    def places(self) -> Places:
        """Places at which stresses are evaluated."""
        return self.task.places

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of the contact [m], (states,)."""
        return np.array([state.half_width for state in self.contacts])

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return np.array([state.centre for state in self.contacts])

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, (states,)."""
        each = [state.level.pressure.σ_YY for state in self.contacts]
        return largest(lambda x: np.concatenate([-σ_YY(x) for σ_YY in each]), lambda i, x: -each[i](x)[0])

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return np.stack([state.interfaces for state in self.contacts], axis=1)

    @cached_property
    def σ_ZZ(self) -> NDArray[np.float64]:
        """Normal stress out of the plane at points inside, (states, m)."""
        Y = self.places.points[:, 1]
        return np.array(
            [state.task.body.σ_ZZ(self.inside[:, i], Y) for i, state in enumerate(self.contacts)]
        )
