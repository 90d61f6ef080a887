"""Punches over layers whose contact ends where the pressure says, by finite elements.

Layers have a length, so each contact has a mesh drawn for its half-width. That is found by solving on a
few of them, at a lower degree at first, until the load that makes a contact of that size is the one
wanted; then the degree rises until the measured error is within tolerance.

One contact over layers: its half-width found, the degree raised until the error is small enough.

A contact over layers at one degree on a mesh drawn for its half-width; what its error is measured on.

Held under the punch are its height around a middle that is nearly known, what that changes by where the
middle moves, and a constant; what they carry and the intensities at both ends are linear in their
amplitudes. So the mesh's half-width has a load of its own, at which no intensity is left, and a middle:
of a parabola at once, of others once that hardly moves.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.kind import DEGREES
from galinx.postprocess import stresses
from galinx.postprocess.pressure import contact_recovery, largest, stretched_from_moments
from galinx.postprocess.quantities.layers import AT_INTERFACES
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.postprocess.quantities.stresses import BELOW, ON_SURFACE
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.punch import ContactStates, Part, SlidingPunch, combined
from galinx.solvers.fem.space import Space
from galinx.solvers.profiles import check_reach
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solution import Places, Surface

from ...plan import fem
from ...plan.fem import FemPlan, wanted_for
from ...plan.task import Task
from .discretisation import Discretisation, on_finer_cells
from .displacement import KinkedDisplacement
from .error import Gauge, StressGauges, WorkDone, reached
from .kinked import OnOwnMeshes, OwnMeshesAtSpeed, alone
from .punch import negligible, tests_of

#: Places under the punch at which the pressure is measured.
_ACROSS = np.cos(np.pi * (np.arange(24) + 0.5) / 24.0)
#: Weights of a single field.
ONE = np.ones((1, 1))
#: Of the load's logarithm, by how much it grows with that of the half-width; of a half-plane it is 2.
GROWTH = 2.0


@dataclass(frozen=True)
class Sized:
    """A task as a contact of some half-width sees it; lengths are over that.

    Attributes:
        task: the task, under one load.
        half_width: [m].
    """

    task: Task
    half_width: float

    @cached_property
    def seen(self) -> Task:
        """With that length."""
        task, h = self.task, self.half_width
        places, depths = task.places, task.body.solid.depths / h  # type: ignore[attr-defined]
        return replace(
            task,
            body=replace(task.body, profile=Flat(h)),
            response=replace(task.response, a=h),  # type: ignore[type-var]
            places=replace(places, interfaces=depths),
        )

    def plan(self, plan: FemPlan, words: frozenset[str], tolerance: float) -> FemPlan:
        """Of a mesh drawn for it.

        Args:
            plan: of all contacts.
            words: of output.quantities that ask for stresses of it.
            tolerance: relative.
        """
        seen = self.seen
        places, interfaces = seen.places, seen.places.interfaces
        kind = fem.kind_of(interfaces, [seen.response])
        below = places.points if BELOW in words else np.empty((0, 2))
        if AT_INTERFACES in words:
            X, depth = np.meshgrid(places.along, interfaces)
            below = np.concatenate([below, np.column_stack([X.ravel(), -depth.ravel()])])
        X = places.X if ON_SURFACE in words else np.empty(0)
        asked = Places(X, below, places.around)
        wanted = wanted_for(tolerance, asked, plan.sharp, seen.response.spread)
        wanted = fem.wanted_of_free_ends_on_layers(wanted)
        degree = kind.degree(wanted, seen.response.margin)
        return replace(
            plan, kind=kind, wanted=wanted, drawn=kind.drawn(wanted),
            degrees=(degree,) * len(plan.degrees), tests=fem.tests_of(seen.body.solid, kind, wanted),
        )  # fmt: skip


class FollowingMesh:
    """Spaces on a mesh of one contact; see :class:`Discretisation`.

    Args:
        work: of all contacts.
        plan: of the mesh.
        stresses: words of output.quantities that ask for stresses of it.
    """

    def __init__(self, work: Discretisation, plan: FemPlan, stresses: frozenset[str]) -> None:
        assert plan.drawn
        self._work, self.plan, self.stresses, self.clock = work, plan, stresses, work.clock
        self._mesh = work.own_mesh(plan.drawn)

    @cached_property
    def finer(self) -> "FollowingMesh":
        """With cells for a tighter tolerance."""
        return FollowingMesh(self._work, on_finer_cells(self.plan), self.stresses)

    def warn(self, text: str) -> None:
        """What the user should know."""
        self._work.warn(text)

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree."""
        return self._work.space_of(self._mesh, degree)


class FollowedLevel:
    """A contact at one degree; see :class:`galinx.app.run.methods.error.Level`.

    Args:
        work: the mesh, and what is asked for.
        task: with lengths over the mesh's half-width, under the load that is wanted.
        space: of the degree.
        g: σ_XY/σ_YY.
        profile: of the punch.
        near: middle of the contact near by [m].

    Attributes:
        contact: nodal forces of the state, over that load.
        off: logarithm of the load that makes a contact of this half-width over the one that is wanted.
        centre: middle of the contact over its half-width.
        field: its displacement over N/(2μ), condensed.
        pressure: the contact's.
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
        local = FlatPunch(task.response, self._g)
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
        """Of the contact that carries the load that is wanted, over the mesh's, about."""
        return float(np.exp(-self.off / GROWTH))

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        """Of the one state there is."""
        σ_YY = self.pressure.σ_YY(self._task.places.X)
        return [self._of_forces(), *self._gauges.of(self._g, ONE, σ_YY)]

    def _of_forces(self) -> Gauge:
        """The pressure all over the contact, its moments over the load, and where the contact ends."""
        σ = self.pressure.σ_YY(_ACROSS)
        moments, lengths = self._moments[:, 1:6], np.array([[self.off / GROWTH, self.centre]])
        values = np.concatenate([σ, moments, lengths], axis=1)
        of_others = [2.0 + 0.0 * moments, np.ones_like(lengths)]
        # What the last functions add is largest where they are multiplied by most.
        factor = np.abs(self.pressure.factor(_ACROSS)).max(axis=1)
        ends = np.abs(self.pressure.factor(np.array([-1.0, 1.0]))).max(axis=1)
        left = self.pressure.unresolved * ends / factor
        return Gauge(
            INTENSITIES, values, np.concatenate([stresses.of_factor(σ), *of_others], axis=1), left
        )

    @property
    def mirrored(self) -> bool:
        """The image of a contact is another."""
        return False

    def rounding(self, g: NDArray) -> list[float]:
        """What a solve leaves of its forces stands for the rounding of these."""
        σ_YY = self.pressure.σ_YY(self._task.places.X)
        return [self.factor.largest_residual, *self._gauges.rounding(self._g, ONE, σ_YY)]

    def release(self) -> None:
        """There is one vector only."""

    def destroy(self) -> None:
        self.field.destroy()


def _balanced(
    solved: SlidingPunch, g: NDArray, K_I: Any, half_width: float
) -> tuple[ContactStates, float, float]:
    """The state without intensities, the logarithm of its load over the wanted one, and by how much its
    middle is moved, over the half-width [m].

    Raises:
        SolveError: no load makes such a contact.
    """
    parts = solved.parts(g)
    K = np.stack([K_I(part) for part in parts], axis=1)
    loads = np.array([part.load[0] for part in parts])
    amplitudes = np.linalg.solve(np.vstack([loads, K]), np.array([-2.0, 0.0, 0.0]))
    # Over the load that it takes the punch's height is that over the wanted one times their quotient.
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
#: How near the half-width has to be before a degree is high, by how much it is lower until then, and how
#: near, over the tolerance, before nothing is moved any more.
_ROUGH, _LOWER, _SETTLED = 3e-2, 3, 0.1
#: Least difference of the half-width's logarithm by which loads of two meshes tell how these grow.
_APART = 1e-5
#: Share of the tolerance that may be left of it once all is solved; a mesh more is drawn otherwise.
_LEFT = 0.3

#: No stresses.
_NONE: frozenset[str] = frozenset()


@dataclass(frozen=True)
class FollowedState:
    """A solved contact; lengths over its half-width from its middle.

    Attributes:
        task: the speed, and the load, as this contact sees them.
        half_width, centre: of the contact [m].
        level: the last.
        estimates: relative errors by the word of output.quantities that asks for what they are of.
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
        """Stresses on the surface, of one state."""
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
    """A contact that is looked for.

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
        """The half-width [m] that carries the load, from one near by.

        Raises:
            SolveError: none was found.
        """
        x, tolerance, rough = float(np.log(h)), self.work.plan.tolerance, True
        for _ in range(_MESHES):
            off, lean = self._off(float(np.exp(x)), rough)
            self._learn(x, off)
            x_next = self.moved(x, off)
            # What the middle moves by is known to the square of that.
            step = max(abs(x_next - x), lean**2)
            if not rough and step <= _SETTLED * tolerance:
                return float(np.exp(x_next))
            if rough and step <= max(_ROUGH, _SETTLED * tolerance):
                # What a low degree says of the load is no measure of what a high one does.
                rough, self._before = False, None
            x = x_next
        raise SolveError(
            f"finite elements did not find the half-width of the contact: after {_MESHES} meshes it is "
            f"near {np.exp(x):.6g} m and still moves; take a speed farther from the limit"
        )

    def moved(self, x: float, off: float) -> float:
        """The half-width's logarithm, by how the load grows with it."""
        return x - float(np.clip(off / self._growth, -_LARGEST, _LARGEST))

    def _learn(self, x: float, off: float) -> None:
        """How the load grows, by two half-widths of one degree."""
        if self._before is not None and abs(x - self._before[0]) > _APART:
            low, high = _SLOPES
            self._growth = float(np.clip((off - self._before[1]) / (x - self._before[0]), low, high))
        self._before = x, off

    def _off(self, h: float, rough: bool) -> tuple[float, float]:
        """Logarithm of the load that makes a contact of this half-width, over the one that is wanted; and
        by how much the middle moves, over the half-width."""
        sized = Sized(self.task, h)
        plan = sized.plan(self.work.plan, _NONE, self.work.plan.tolerance)
        degree = plan.degrees[self.task.number]
        mesh = FollowingMesh(self.work, plan, _NONE)
        space = mesh.space(max(degree - _LOWER, DEGREES[0]) if rough else degree)
        level = self.level(mesh, sized.seen, space)
        level.destroy()
        before, self._centre = self._centre, h * level.centre
        return level.off, (self._centre - before) / h

    def level(self, mesh: FollowingMesh, task: Task, space: Any) -> FollowedLevel:
        """The contact on a space."""
        profile = self.task.body.profile
        found = FollowedLevel(mesh, task, space, self.g, profile, self._centre)
        self.done.count(found)
        return found

    def solved(self, h: float) -> tuple[Sized, FollowedLevel, dict[str, float]]:
        """On a mesh drawn for a half-width [m], as good as it has to be; and relative errors by word."""
        sized = Sized(self.task, h)
        words = self.work.stresses
        mesh = FollowingMesh(
            self.work, sized.plan(self.work.plan, words, self.work.plan.tolerance), words
        )
        g = np.array([self.g])

        def level(space: Any, _: NDArray) -> FollowedLevel:
            return self.level(mesh, sized.seen, space)

        with reached(mesh, sized.seen, g, level) as (ladder, error):
            of = {word: float(values[0]) for word, values in error.of(g).items()}
            self.record = error.record()
            return sized, ladder.levels.pop(), of


def solved(work: Discretisation, task: Task, g: float, near: float, done: WorkDone) -> FollowedState:
    """The contact at a friction.

    Args:
        work: gives meshes.
        task: the speed, and the load.
        g: σ_XY/σ_YY.
        near: half-width near by [m].
        done: takes the numbers of the work.

    Raises:
        SolveError: no contact was found, or the equations could not be solved.
    """
    contact = _Contact(work, task, g, done)
    h = contact.settled(near)
    sized, last, estimates = contact.solved(h)
    h = float(np.exp(contact.moved(float(np.log(h)), last.off)))
    if abs(h / sized.half_width - 1.0) > _LEFT * work.plan.tolerance:
        last.destroy()
        sized, last, estimates = contact.solved(h)
        h = float(np.exp(contact.moved(float(np.log(h)), last.off)))
    check_reach(task.body.profile, h * (last.centre - 1.0), h * (last.centre + 1.0))
    off = abs(h / sized.half_width - 1.0)
    estimates = {word: value + off for word, value in estimates.items()}
    assert INTENSITIES in estimates
    size = {"cells": last.space.cells, "unknowns": last.space.size, "degree": last.space.degree}
    return FollowedState(sized.seen, h, h * last.centre, last, estimates, size | contact.record)


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["FollowedAtSpeed"]:
    """States are solved when they are asked for, each on meshes of its own."""
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
        found = [self._state(*state) for state in zip(g.tolist(), loads)]
        return FollowedPunches(self.task, g, found, body)

    def _solve(self, g: float, load: float) -> FollowedState:
        task = alone(self.task, load)
        return solved(self.work, task, g, self._near(g, load, task), self._done)

    def _near(self, g: float, load: float, task: Task) -> float:
        """Half-width [m] to begin with: of the nearest state, or that at rest."""
        same = [
            (abs(other - g), state.half_width) for (other, N), state in self._known.items() if load == N
        ]
        return min(same)[1] if same else float(task.body.half_width)


class FollowedPunches(OnOwnMeshes):
    """Punches over layers with several frictions and loads."""

    @property
    def places(self) -> Places:
        """Where stresses are."""
        return self.task.places

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
        return np.array([state.half_width for state in self.found])

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return np.array([state.centre for state in self.found])

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, (states,)."""
        each = [state.level.pressure.σ_YY for state in self.found]
        return largest(lambda x: np.concatenate([-σ_YY(x) for σ_YY in each]), lambda i, x: -each[i](x)[0])

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return np.stack([state.interfaces for state in self.found], axis=1)

    @cached_property
    def σ_ZZ(self) -> NDArray[np.float64]:
        """Normal stress out of the plane at points inside, (states, m)."""
        Y = self.places.points[:, 1]
        return np.array(
            [state.task.body.σ_ZZ(self.inside[:, i], Y) for i, state in enumerate(self.found)]
        )
