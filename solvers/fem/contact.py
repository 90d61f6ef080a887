"""Rigid punches by finite elements at one speed, their pressure unknown, to the measured error.

A contact is made of three things: its ends (:class:`Ends`), a mesh, which contacts share or which is
drawn for each (:mod:`galinx.solvers.fem.own_meshes`), and the recovery of the pressure from nodal forces.
A :class:`PunchLevel` solves contacts at one degree; a :class:`galinx.solvers.fem.solution.Solution` has
their states.

With free ends: the half-plane has no length, so the mesh is that of a contact from -1 to 1 whatever its
width is, and the displacement prescribed under the punch is a combination of few shapes: 1 and s for a
tilted flat base, 1, s and s² for a parabola, as many polynomials as it takes for any other smooth
profile. Load and vanishing intensities at free ends are linear in their amplitudes, from which half-width
and middle follow; of a parabola directly, of other profiles by the conditions of
:mod:`galinx.solvers.contact.free_ends`. Every friction and every load is solved in the basis of the
speed.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..contact import INTENSITIES
from ..contact.edges import EdgeExponents
from ..contact.fem_plan import FemPlan
from ..contact.free_ends import SHAPES, free_ends, heights_of_shapes, slopes_of_shapes
from ..contact.pressure import Expansion
from ..contact.recovery import (
    ContactRecovery,
    Polynomials,
    chebyshev,
    contact_recovery,
    from_moments,
    without_zeros,
)
from ..contact.solution import Contact, Task
from ..contact.stresses import Surface, Turns
from ..errors import SolveError
from ..profiles.flat import Flat
from ..profiles.power import Parabolic
from .discretisation import Discretisation
from .displacement import Displacement
from .fields import Slopes
from .ladder import Gauge, Level, of_pressure, solved_to_tolerance
from .punch import ContactStates, FittedPunch, Part, Punch, SlidingPunch, combined, sliding_punch
from .solution import Solution, SolvedStates, solution_of
from .space import Space

#: Change of the contact forces over the tolerance, and at most, for which no solution is refined and
#: nothing more is added for friction. The most keeps results on any number of ranks equal to 1e-9.
_NEGLIGIBLE, _NEGLIGIBLE_MOST = 1e-4, 1e-10

#: Share of that where stresses are requested: next to an edge a force counts by the little load there.
_BESIDE_EDGES = 0.1

#: Least distance over a from a free end at which stresses are evaluated, besides the end itself.
_NEAREST = 1e-6

#: Weights of a single field.
_SINGLE = np.ones((1, 1))


def negligible(work: Any) -> float:
    """Relative change of the contact forces that affects no result."""
    least = min(_NEGLIGIBLE * work.plan.tolerance, _NEGLIGIBLE_MOST)
    return _BESIDE_EDGES * least if work.stresses else least


@dataclass(frozen=True)
class SolvedEnds:
    """Contacts with their ends, as sums of a punch's parts.

    Attributes:
        contact: nodal forces and weights; v₀ of the punch's lowest point.
        half_width, centre: half-width and middle of each contact [m], (states,).
        free: True where the left and the right end are free, (states, 2).
        unresolved: part of the profile's slope that its shapes leave out, relative, (states,) or 0.
    """

    contact: ContactStates
    half_width: NDArray[np.float64]
    centre: NDArray[np.float64]
    free: NDArray[np.bool_]
    unresolved: Any = 0.0


class Ends:
    """Ends of contacts: displacements that are prescribed under a punch, and their sums that are states.

    Attributes:
        single: True where a level has a single state, on a mesh of its own.
    """

    single = False

    def heights(self, level: "PunchLevel") -> NDArray[np.float64] | None:
        """Heights over N/(2μ) at the contact nodes, of the punch or of shapes; None for a flat punch."""
        raise NotImplementedError

    def solved(self, level: "PunchLevel", g: NDArray, body: Contact) -> SolvedEnds:
        """Contacts with frictions g = σ_XY/σ_YY, (states,), under the load of the body for each.

        Raises:
            SolveError: no contact carries the load.
        """
        raise NotImplementedError

    def pressure(self, level: "PunchLevel", ends: SolvedEnds) -> Any:
        """Pressure of contacts from their nodal forces."""
        raise NotImplementedError

    def gauge(self, level: "PunchLevel", states: SolvedStates) -> Gauge:
        """Gauge of pressure and ends."""
        raise NotImplementedError

    def task(self, task: Task) -> Task:
        """Task with the places at which stresses are measured."""
        return task

    def continuation(self, level: "PunchLevel") -> Callable[[NDArray], Any] | None:
        """Continuation of slopes to free ends, see :class:`Displacement`; None where there is none."""
        return None

    def nearest(self, pressure: Any) -> float:
        """Least distance over a from free ends and kinks at which stresses are evaluated."""
        return _NEAREST

    def turns(self, states: SolvedStates) -> Callable[[Surface], Turns] | None:
        """Function for limits of stresses on a surface; None for limits at free ends alone."""
        return None


class SharpEnds(Ends):
    """Sharp edges at both ends of the base of a punch that touches all along it."""

    def heights(self, level: "PunchLevel") -> NDArray[np.float64] | None:
        body = level.task.body
        return None if body.flat else body.height(level.r)

    def solved(self, level: "PunchLevel", g: NDArray, body: Contact) -> SolvedEnds:
        contact = level.punch.states(g, share=level.task.body.load / body.load)
        half_width = np.full(len(g), float(body.half_width))
        return SolvedEnds(contact, half_width, 0.0 * half_width, np.zeros((len(g), 2), dtype=bool))

    def pressure(self, level: "PunchLevel", ends: SolvedEnds) -> Expansion:
        return level.over_flat(ends.contact, ends.contact.g)

    def gauge(self, level: "PunchLevel", states: SolvedStates) -> Gauge:
        moments = states.contact.tested(level.moments)
        plan, margin = level.plan, level.task.response.margin
        moved = plan.kind.moved_edges(plan.wanted, level.space.degree, margin)
        return of_pressure(states.pressure, moments, moved)


class FreeEnds(Ends):
    """Free ends of smooth punches and of lifted bases, on the mesh of all contacts.

    Args:
        shapes: number of polynomials whose sum is the punch under every contact.
    """

    def __init__(self, shapes: int) -> None:
        self._shapes = shapes

    def heights(self, level: "PunchLevel") -> NDArray[np.float64]:
        return heights_of_shapes(level.r, self._shapes)

    def solved(self, level: "PunchLevel", g: NDArray, body: Contact) -> SolvedEnds:
        parts, local = level.punch.parts(g), EdgeExponents(level.task.response, g)
        loads = np.stack([part.load for part in parts], axis=1)
        solve = _SOLVES.get(type(body.profile), _smooth)
        amplitudes, h, m, free, lowest, unresolved = solve(body, loads, level.K_I(parts, g), local)
        if not np.all((h > 0.0) & np.isfinite(h)):
            raise SolveError("no contact of a finite half-width carries the load")
        contact = combined(g, parts, amplitudes)
        return SolvedEnds(replace(contact, v0=contact.v0 + lowest), h, m, free, unresolved)

    def pressure(self, level: "PunchLevel", ends: SolvedEnds) -> Expansion:
        whole, free = level.over_flat(ends.contact, ends.contact.g), ends.free
        smooth = without_zeros(whole.c, free)
        return replace(whole, α=whole.α + free[:, 1:], β=whole.β + free[:, :1], c=smooth)

    def gauge(self, level: "PunchLevel", states: SolvedStates) -> Gauge:
        moments = states.contact.tested(level.moments)
        gauge = of_pressure(level.over_flat(states.contact, states.contact.g), moments)
        lengths = np.column_stack([states.half_width, states.centre])
        return replace(
            gauge,
            values=np.concatenate([gauge.values, lengths], axis=1),
            scale=np.concatenate([gauge.scale, np.tile(states.half_width[:, None], 2)], axis=1),
        )


#: Amplitudes of the shapes (states, parts), half-widths, middles, free ends, depth of the punch's lowest
#: point below the level of the first shape, over N/(2μ), and slope beyond the shapes, relative.
_Solved = tuple[NDArray, NDArray, NDArray, NDArray, NDArray, NDArray]


def _parabola(body: Contact, loads: NDArray, K: NDArray, local: EdgeExponents) -> _Solved:
    """Amplitudes of v = -v₀ + c₁ s + c₂ s²/2 with the load, and without intensity at both ends.

    Args:
        body: the sliding contact.
        loads: ∫σ_YY of every part, (states, parts).
        K: intensities of every part at both ends, (states, 2, parts).
        local: exponents of a flat punch.
    """
    punch = body.profile
    assert isinstance(punch, Parabolic)
    A = np.concatenate([loads[:, None, :3], K[..., :3]], axis=1)
    first = np.linalg.solve(A, np.tile([-2.0, 0.0, 0.0], (len(A), 1))[..., None])[..., 0]
    amplitudes = np.concatenate([first, np.zeros((len(A), loads.shape[1] - 3))], axis=1)
    _, c1, c2 = first.T
    with np.errstate(invalid="ignore"):
        h = np.sqrt(punch.radius * c2 * body.displacement)
    free = np.ones((len(A), 2), dtype=bool)
    return amplitudes, h, h * c1 / c2, free, c1**2 / (2.0 * c2), 0.0 * h


def _smooth(body: Contact, loads: NDArray, K: NDArray, local: EdgeExponents) -> _Solved:
    """Amplitudes of v = -v₀ + the punch's height with the load, and without intensity at both ends."""
    punch, few = body.profile, slice(1 + SHAPES)
    units = np.broadcast_to(body.displacement, len(loads)).tolist()
    conditions, near = free_ends(local, K[..., few], loads[:, few]), None
    ends, slopes = [], []
    for condition, unit in zip(conditions, units):
        near = condition.solve(punch, unit, near)
        ends.append(near)
        slopes.append(slopes_of_shapes(punch, *near, 2 * loads.shape[1]) / unit)
    (m, h), size, count = np.transpose(ends), np.abs(slopes), loads.shape[1] - 1
    shapes = np.array(slopes)[:, :count]
    v0 = (-2.0 - (shapes * loads[:, 1:]).sum(axis=1)) / loads[:, 0]
    lowest = np.asarray(punch.height(m)) / units
    unresolved = size[:, count:].sum(axis=1) / size.max(axis=1)
    free = np.ones((len(m), 2), dtype=bool)
    return np.column_stack([v0, shapes]), h, m, free, lowest, unresolved


def _tilted(body: Contact, loads: NDArray, K: NDArray, local: EdgeExponents) -> _Solved:
    """Amplitudes of v = -v₀ + c₁ s with the load; c₁ is that of the tilt, or, where the higher edge is
    lifted, that without intensity there."""
    punch = body.profile
    assert isinstance(punch, Flat)
    side = 1 if punch.rise > 0.0 else 0
    c1 = punch.rise * punch.half_width / body.displacement * np.ones(len(loads))
    v0 = (-2.0 - c1 * loads[:, 1]) / loads[:, 0]
    lifted = (K[:, side] * np.column_stack([v0, c1])).sum(axis=1) < 0.0
    A = np.stack([loads, K[:, side]], axis=1)
    given_up = np.linalg.solve(A, np.tile([-2.0, 0.0], (len(A), 1))[..., None])[..., 0]
    amplitudes = np.where(lifted[:, None], given_up, np.column_stack([v0, c1]))
    h = np.where(lifted, amplitudes[:, 1] * body.displacement / punch.rise, punch.half_width)
    free = np.zeros((len(loads), 2), dtype=bool)
    free[:, side] = lifted
    centre = np.where(lifted, np.sign(punch.rise) * (h - punch.half_width), 0.0)
    return amplitudes, h, centre, free, np.abs(amplitudes[:, 1]), 0.0 * h


#: Solutions for profiles whose conditions are linear.
_SOLVES = {Flat: _tilted, Parabolic: _parabola}


def ends_of(plan: FemPlan) -> Ends:
    """Ends of contacts on the mesh of all of them."""
    return FreeEnds(plan.shapes) if plan.shapes else SharpEnds()


class PunchLevel(Level):
    """Punch at one degree, and the maps from its contact forces to its pressure.

    Args:
        work, task, space, g: as of :class:`galinx.solvers.fem.ladder.Level`.
        fitted: punch fitted through other speeds; it is solved if None.
        recovery: maps from contact forces to pressure on this space; computed if None.
        ends: ends of the contacts; by the plan if None.

    Attributes:
        plan: plan of the finite elements.
        ends: ends of the contacts.
        only: the single state on a mesh of its own; None on a mesh of all contacts.
    """

    def __init__(
        self, work: Discretisation, task: Task, space: Space, g: NDArray,
        fitted: FittedPunch | None = None, recovery: ContactRecovery | None = None,
        ends: Ends | None = None,
    ) -> None:  # fmt: skip
        super().__init__(work, task, space, g)
        self.plan = work.plan
        self.ends = ends or ends_of(work.plan)
        self._fitted = fitted
        self.only: SolvedEnds | None = None
        self._field: Any = None
        self._tests = tests_of(self.plan, space.degree - self.plan.degrees[task.number])
        if fitted is not None and recovery is not None:
            self.punch: Punch = fitted
            self.recovery, self.moments = recovery, recovery.moments
            return
        least, single = negligible(work), self.ends.single
        # The rest of friction's iteration is equal at all degrees: no estimate of stresses would show it.
        friction_rest = 0.0 if work.stresses or single else least
        solved = self.sliding(
            space, task.response, self.plan.solver, least, self.ends.heights(self), friction_rest
        )
        self.punch, self.factor = solved, solved.factor
        try:
            # The basis is complete before traces are taken, and the same whatever states are still to do.
            solved.prepare(g)
            if single:
                self.only = self._summed(self.ends.solved(self, g, task.body))
        finally:
            if single:
                solved.destroy()
        self.stress_gauges  # noqa: B018 - cached

    def sliding(self, *punch: Any) -> SlidingPunch:
        """Punch of the level, of these arguments."""
        return sliding_punch(*punch)

    def _summed(self, ends: SolvedEnds) -> SolvedEnds:
        """The only state, by its own displacement and nodal forces."""
        field = self.punch.fields[0].duplicate()
        field.zeroEntries()
        field.maxpy(ends.contact.weights[0].tolist(), self.punch.fields)
        self._field, contact = field, ends.contact
        forces = np.tensordot(contact.weights, contact.forces, 1)
        return replace(ends, contact=replace(contact, weights=_SINGLE, forces=forces))

    @property
    def fields(self) -> Sequence[Any]:
        """Displacements over N/(2μ), whose combinations are the states."""
        return [self._field] if self.only else self.punch.fields

    @cached_property
    def r(self) -> NDArray[np.float64]:
        """Positions over a of the contact nodes, (nodes,)."""
        return self.space.chart.surface_position(self.space.contact.s)

    @cached_property
    def moments(self) -> NDArray[np.float64]:
        """Map from nodal forces to moments of the pressure, (nodes, moments)."""
        return self._tests(self.r)

    @cached_property
    def recovery(self) -> ContactRecovery:
        """Maps from nodal forces to moments, raw pressure and exponents."""
        space, X = self.space, self.task.places.X
        return contact_recovery(space.contact.s, space.degree, space.chart, X, tests=self._tests)

    def measured_task(self, task: Task) -> Task:
        return self.ends.task(task)

    @property
    def slopes(self) -> Slopes:
        """Slopes of the fields on the surface, at no place where no stress is requested."""
        count = len(self.fields)
        nowhere = Slopes(np.empty((2, 0, count)), np.empty((0, count)))
        return self.stress_gauges.slopes if self.work.stresses else nowhere

    def displacement_at(self, task: Task) -> Displacement:
        slopes = self._fitted.slopes if self._fitted else None
        return Displacement(task, self.space, self.fields, slopes, self.ends.continuation(self))

    @property
    def mirrored(self) -> bool:  # type: ignore[override]
        """True where there is a mirror image on the same mesh."""
        return self.task.response.mirrored and not self.ends.single

    def over_flat(self, part: Part, g: NDArray, more: float = 0.0) -> Expansion:
        """Pressure from moments, with exponents of sharp edges at frictions g, or larger ones."""
        local = EdgeExponents(self.task.response, g)
        functions = self.plan.tests.stretch if self.plan.tests else Polynomials()
        moments = part.tested(self.moments)
        return from_moments(moments, local.α + more, local.β + more, functions)

    def K_I(self, parts: Sequence[Part], g: NDArray) -> NDArray[np.float64]:
        """Intensities of parts at both ends, (states, 2, parts)."""
        return np.stack([self.over_flat(part, g).K_I for part in parts], axis=2)

    def states(self, g: NDArray, load: Any = None) -> SolvedStates:
        body = self.task.body.loaded(load)
        ends = self.only or self.ends.solved(self, g, body)
        states = SolvedStates(
            self.task, body, ends.contact, self.ends.pressure(self, ends), self.displacement,
            ends.half_width, ends.centre, ends.free, ends.unresolved,
            None if self.ends.single else lambda: self.recovery,
        )  # fmt: skip
        nearest = self.ends.nearest(states.pressure)
        return replace(states, turns=self.ends.turns(states), nearest=nearest)

    def gauges(self, states: SolvedStates) -> list[Gauge]:
        """Gauges of states: of pressure and ends, and of requested stresses."""
        return [self.ends.gauge(self, states), *super().gauges(states)]

    def rounding(self, g: NDArray, load: Any = None) -> list[float]:
        """Effect of rounding on each gauge, relative: difference of a flat punch from its mirror at -g.

        In a solid without mirror symmetry it is the difference of K_I at the two ends, which are equal
        under a flat punch all the same. Over layers they differ, and a single state has no flat punch
        beside it: what the solve leaves of its forces stands for rounding there. Stresses are relative to
        those of the states themselves: beside a flat punch's sharp edges they are large, beside free ends
        they are not, and their rounding is as large.
        """
        own = self.fields_of(self.states(g, load))
        if not self.mirrored:
            of_edges = self.factor.largest_residual
            if not (self.ends.single or self.task.body.layered):
                K_left, K_right = self.over_flat(self.punch.states(g, flat=True), g).K_I.T
                of_edges = float(np.abs(K_left / K_right - 1.0).max())
            return [of_edges, *self.stress_gauges.rounding(*own)]
        both, size = [], self.stress_gauges.size(*own)
        for sign in (1.0, -1.0):
            flat = self.punch.states(sign * g, flat=True)
            pressure = self.over_flat(flat, sign * g)
            σ_YY = pressure.σ_YY(self.measured_task(self.task).places.X)
            gauges = self.stress_gauges.mirrored(sign, sign * g, flat.weights, σ_YY, size)
            K_I = pressure.K_I[:, :: int(sign)]
            both.append([Gauge(INTENSITIES, K_I, np.abs(K_I)), *gauges])
        return [float(gauge.change(mirror).max()) for gauge, mirror in zip(*both)]

    def release(self) -> None:
        """Free factor and fields; a single state keeps its field."""
        if not self.only:
            self.punch.release()

    def destroy(self) -> None:
        if self.only:
            self._field.destroy()
        else:
            self.punch.destroy()


def tests_of(plan: FemPlan, more: int) -> Callable[[NDArray], NDArray]:
    """Test functions of r for nodal forces; over layers for ``more`` degrees above the plan's."""
    tests = plan.tests
    if tests is None:
        return chebyshev
    return lambda r: tests.stretch.values(r, tests.count + more * tests.a_degree)


@dataclass(frozen=True)
class AtSpeed:
    """States at one speed on a mesh that they share, solved to the tolerance.

    Attributes:
        level: the last level, a :class:`galinx.solvers.fem.ladder.Level`.
        error: error of that level.
        record: gives numbers of the work.
        fitted: True where the speed was fitted through others.
    """

    level: Any
    error: Any
    record: Callable[[], dict[str, Any]]
    fitted: bool = False

    def states(self, g: NDArray, load: Any = None) -> Solution:
        return solution_of(self.level.task, self._solved, g, load)

    def _solved(self, g: NDArray, load: Any) -> list[SolvedStates]:
        states = self.level.states(g, load)

        def errors() -> dict[str, NDArray[np.float64]]:
            of = self.error.of(g, states.body.load, lambda: self.level.gauges(states))
            return {word: values + states.unresolved for word, values in of.items()}

        return [replace(states, errors=errors, fitted=self.fitted)]


@contextmanager
def shared_mesh(work: Discretisation, task: Task, g: NDArray, level: Any) -> Iterator[AtSpeed]:
    """Raise the degree until the measured error of sample states is within tolerance.

    Args:
        work: gives spaces.
        task: the speed.
        g: all values of σ_XY/σ_YY that will be solved, sorted.
        level: class of levels, made of ``work``, ``task``, a space and g.
    """
    with solved_to_tolerance(work, task, g, lambda space, g: level(work, task, space, g)) as solved:
        ladder, error = solved
        yield AtSpeed(ladder.levels[-1], error, lambda: ladder.record() | error.record())
