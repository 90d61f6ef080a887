"""Rigid punches by finite elements at one speed, mode ``contact``, to the measured error.

The pressure is unknown. Punches have two sharp edges (:class:`PunchLevel`) or free ends
(:class:`FreeLevel`).

With free ends: the half-plane has no length, so the mesh is that of a contact from -1 to 1 whatever its
width is, and the displacement prescribed under the punch is a combination of few shapes: 1 and s for a
tilted flat base, 1, s and s² for a parabola, as many polynomials as it takes for any other smooth
profile. Load and vanishing intensities at free ends are linear in their amplitudes, from which half-width
and middle follow; of a parabola directly, of other profiles by the conditions of
:mod:`galinx.solvers.contact.free_ends`. Every friction and every load is solved in the basis of the
speed.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.layered import OnLayers

from ..contact.edges import EdgeExponents, Exponents
from ..contact.fem_plan import FemPlan
from ..contact.free_ends import SHAPES, free_ends, heights_of_shapes, slopes_of_shapes, turns_at_ends
from ..contact.method import Pressure
from ..contact.recovery import (
    ContactRecovery,
    JacobiPressure,
    chebyshev,
    contact_recovery,
    from_moments,
    largest,
    without_zeros,
)
from ..contact.recovery import stretched_from_moments as from_stretched
from ..contact.residual import of_contact
from ..contact.solution import Body, Places, Surface, Task
from ..contact.yielding import Strength
from ..errors import SolveError
from ..profiles.flat import Flat
from ..profiles.power import Parabolic
from . import ladder as error
from .discretisation import Discretisation
from .displacement import Displacement
from .ladder import Gauge, StressGauges, solved_to_tolerance
from .punch import ContactStates, FittedPunch, Part, Punch, SlidingPunch, combined
from .space import Space

#: Change of the contact forces over the tolerance, and at most, for which no solution is refined and
#: nothing more is added for friction. The most keeps results on any number of ranks equal to 1e-9.
_NEGLIGIBLE, _NEGLIGIBLE_MOST = 1e-4, 1e-10

#: Share of that where stresses are requested: next to an edge a force counts by the little load there.
_BESIDE_EDGES = 0.1


def negligible(work: Any) -> float:
    """Relative change of the contact forces that affects no result."""
    least = min(_NEGLIGIBLE * work.plan.tolerance, _NEGLIGIBLE_MOST)
    return _BESIDE_EDGES * least if work.stresses else least


@contextmanager
def solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["PunchesAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with solved_to_tolerance(work, task, g, lambda space, g: PunchLevel(work, task, space, g)) as (
        ladder,
        error,
    ):
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
        local = EdgeExponents(task.response, states.g)
        pressure = from_moments(states.tested(recovery.moments), local.α, local.β)
        yield space, punch.fields, states.weights[0], lambda X: pressure.σ_YY(X)[0]
    finally:
        punch.destroy()


class PunchLevel:
    """Punch at one degree, and the maps from its contact forces to its pressure.

    Args:
        work: has the plan and the words of the requested stresses.
        task: the speed.
        space: space of the degree.
        g: all values of σ_XY/σ_YY that will be solved.
        fitted: punch fitted through other speeds; it is solved if None.
        recovery: maps from contact forces to pressure on this space; computed if None.
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
        # The rest of friction's iteration is equal at all degrees: no estimate of stresses would show it.
        friction_rest = 0.0 if work.stresses else least
        solved = SlidingPunch(space, task.response, plan.solver, least, self.heights(), friction_rest)
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
        """Slopes of the fields on the surface, None where no stress is requested."""
        return self._gauges.slopes

    def displacement(self, at: Task | None = None) -> Displacement:
        """Displacement, for stresses at the places of the task or of another."""
        slopes = self._fitted.slopes if self._fitted else None
        return Displacement(at or self.task, self.space, self.punch.fields, slopes)

    def heights(self) -> NDArray[np.float64] | None:
        """Heights of the punch, or of shapes, over N/(2μ) at the contact nodes; None for a flat punch."""
        return profile_on(self.space, self.task.body)

    @property
    def mirrored(self) -> bool:
        return self.task.response.mirrored

    def pressure(self, states: ContactStates) -> JacobiPressure:
        """Pressure from its Jacobi moments, whose weight has the exponents of the local analysis."""
        local = EdgeExponents(self.task.response, states.g)
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
        """Gauges of states and their pressure."""
        moments = states.tested(self.recovery.moments)
        gauges = [error.of_pressure(pressure, moments, self._moved_edges)]
        if self._gauges.any_stress:
            gauges += self._gauges.of(states.g, states.weights, pressure.σ_YY(self.task.places.X))
        return gauges

    @property
    def _moved_edges(self) -> float:
        """Distance over a by which the edges seem off on straight cells along layers; 0 on others."""
        plan = self._work.plan
        if not isinstance(plan.kind, OnLayers):
            return 0.0
        return plan.kind.moved_edges(plan.wanted, self.space.degree, self.task.response.margin)

    def rounding(self, g: NDArray) -> list[float]:
        """Effect of rounding on each gauge, relative: difference of a flat punch from its mirror at -g.

        In a solid without mirror symmetry it is the difference of K_I at the two ends, which are equal
        under a flat punch all the same. Stresses are relative to those of the states themselves: beside
        a flat punch's sharp edges they are large, beside free ends they are not, and their rounding is
        as large.
        """
        if not self.task.response.mirrored:
            states = self.punch.states(g, flat=True)
            pressure = self.pressure(states)
            K_left, K_right = pressure.K_I.T
            # Over layers they differ, and what a solve leaves of its forces stands for rounding.
            layered = self.task.body.layered
            of_edges = self.factor.largest_residual if layered else np.abs(K_left / K_right - 1.0).max()
            stresses = self._gauges.rounding(g, *self._on_surface(g))
            return [float(of_edges), *stresses]
        both, size = [], self._gauges.size(g, *self._on_surface(g))
        for sign in (1.0, -1.0):
            states = self.punch.states(sign * g, flat=True)
            pressure = self.pressure(states)
            σ_YY = pressure.σ_YY(self.task.places.X)
            gauges = self._gauges.mirrored(sign, sign * g, states.weights, σ_YY, size)
            both.append([error.of_intensities(pressure.K_I[:, :: int(sign)]), *gauges])
        return [float(gauge.change(mirror).max()) for gauge, mirror in zip(*both)]

    def _on_surface(self, g: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Weights (states, fields) of states, and their σ_YY on the surface, (states, n)."""
        states = self.contact(g)
        return states.weights, self.pressure(states).σ_YY(self.task.places.X)

    def release(self) -> None:
        self.punch.release()

    def destroy(self) -> None:
        self.punch.destroy()


def tests_of(plan: FemPlan, more: int) -> Callable[[NDArray], NDArray]:
    """Test functions of r for nodal forces; over layers for ``more`` degrees above the plan's."""
    tests = plan.tests
    if tests is None:
        return chebyshev
    return lambda r: tests.stretch.functions(r, tests.count + more * tests.a_degree)


def profile_on(space: Space, body: Body) -> NDArray[np.float64] | None:
    """Height of the punch over N/(2μ) at the contact nodes; None for a flat punch, which needs none."""
    return None if body.flat else body.height(space.chart.surface_position(space.contact.s))


class PunchesAtSpeed:
    """Rigid punches at one speed, their pressure solved to the tolerance.

    Args:
        ladder: ladder at its last level.
        error: error of that level.
        fitted: True where the speed was fitted through others.
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
        body: the sliding contact, under the load of each state.
    """

    at: PunchesAtSpeed
    g: NDArray[np.float64]
    contact: ContactStates
    body: Body

    @cached_property
    def local(self) -> EdgeExponents:
        return EdgeExponents(self.at.task.response, self.g)

    @cached_property
    def _pressure(self) -> JacobiPressure:
        return self.at.level.pressure(self.contact)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """K_I at X = -a and X = a, (states, 2)."""
        return self._pressure.K_I

    @cached_property
    def exponents(self) -> NDArray[np.float64]:
        """Exponents at X = a and X = -a, fitted from the raw pressure, (states, 2)."""
        return self.at.level.recovery.exponents(self.contact.normal)

    @property
    def residual(self) -> NDArray[np.float64]:
        """Residual of the integral equation under the pressure, relative, (states,)."""
        return of_contact(self.at.task.response, self.g, self.local, self.body, self._pressure.σ_YY)

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Normal force over N/2, (states,)."""
        return self.contact.load

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Tangential force over N/2, (states,)."""
        return self.contact.tangential.sum(axis=1)

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation over N/(2μ), (states,)."""
        return self.contact.v0

    @property
    def fitted(self) -> NDArray[np.float64]:
        """1 where the state was fitted through other speeds, 0 where it was solved, (states,)."""
        return np.full(len(self.g), float(self.at.fitted))

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by word of output.quantities."""
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
        """Places at which stresses are evaluated."""
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
        """Yield of the states."""
        at, weights = self.at, self.contact.weights
        field = at.displacement.at
        return Strength(
            lambda points: field(points, weights), self.body, at.task.response, self.g, self.local
        )


#: Least distance over a from a free end at which stresses are evaluated, besides the end itself.
_NEAREST = 1e-6


@contextmanager
def free_solver(work: Discretisation, task: Task, g: NDArray) -> Iterator["FreeAtSpeed"]:
    """Raise the degree until the measured error of sample states is within tolerance."""
    with solved_to_tolerance(work, task, g, lambda space, g: FreeLevel(work, task, space, g)) as (
        ladder,
        error,
    ):
        yield FreeAtSpeed(ladder, error)


@contextmanager
def free_state(
    work: Discretisation, task: Task, g: float, degree: int
) -> Iterator[tuple[Space, Any, NDArray, Pressure]]:
    """Space, fields, weights and pressure of one state, lengths over its half-width from its middle."""
    level = FreeLevel(work, task, work.space(degree, work.plan.cuts), np.array([g]))
    try:
        states = level.states(np.array([g]))
        yield (
            level.space,
            level.punch.fields,
            states.contact.weights[0],
            lambda X: states.pressure.σ_YY(X)[0],
        )
    finally:
        level.destroy()


@dataclass(frozen=True)
class FreeStates:
    """States of contacts with free ends.

    Attributes:
        contact: nodal forces and weights; v₀ of the punch's lowest point.
        half_width, centre: half-width and middle of the contact [m], (states,).
        free: True where the left and the right end are free, (states, 2).
        factor: Chebyshev coefficients of the pressure over a flat punch's weight, (states, moments).
        local: exponents of a flat punch.
        unresolved: part of the profile's slope beyond the shapes, relative, (states,).
    """

    contact: ContactStates
    half_width: NDArray[np.float64]
    centre: NDArray[np.float64]
    free: NDArray[np.bool_]
    factor: NDArray[np.float64]
    local: EdgeExponents
    unresolved: NDArray[np.float64]

    @property
    def exponents(self) -> Exponents:
        """Exponents of the pressure at the right and the left end."""
        return Exponents(self.local.α + self.free[:, 1], self.local.β + self.free[:, 0])

    @cached_property
    def pressure(self) -> JacobiPressure:
        ends = self.exponents
        return JacobiPressure(ends.α, ends.β, without_zeros(self.factor, self.free))

    @property
    def K_I(self) -> NDArray[np.float64]:
        """K_I at the left and the right end, 0 at a free end, (states, 2)."""
        intensities = -0.5 * self.factor @ chebyshev(np.array([-1.0, 1.0])).T
        return np.where(self.free, 0.0, intensities)


class FreeLevel(PunchLevel):
    """Punches with free ends at one degree; see :class:`PunchLevel`."""

    def heights(self) -> NDArray[np.float64]:
        s = self.space.chart.surface_position(self.space.contact.s)
        return heights_of_shapes(s, self._work.plan.shapes)

    def states(self, g: NDArray, load: Any = None) -> FreeStates:
        """States with values g of σ_XY/σ_YY, (states,), under the task's load or others [N/m].

        Raises:
            SolveError: no contact carries the load.
        """
        parts, local = self.punch.parts(g), EdgeExponents(self.task.response, g)
        K = np.stack([self._over_flat(part, local).K_I for part in parts], axis=2)
        loads = np.stack([part.load for part in parts], axis=1)
        body = self.task.body.loaded(load)
        solve = _SOLVES.get(type(body.profile), _smooth)
        amplitudes, h, m, free, lowest, unresolved = solve(body, loads, K, local)
        if not np.all((h > 0.0) & np.isfinite(h)):
            raise SolveError("no contact of a finite half-width carries the load")
        contact = combined(g, parts, amplitudes)
        factor = self._over_flat(contact, local).c
        deeper = replace(contact, v0=contact.v0 + lowest)
        return FreeStates(deeper, h, m, free, factor, local, unresolved)

    def _over_flat(self, part: Part, local: EdgeExponents) -> JacobiPressure:
        """Pressure of a part over a flat punch's weight."""
        return from_moments(part.tested(self.recovery.moments), local.α, local.β)

    def _on_surface(self, g: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        states = self.states(g)
        return states.contact.weights, states.pressure.σ_YY(self.task.places.X)

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        states = self.states(g, load)
        moments = states.contact.tested(self.recovery.moments)
        whole = JacobiPressure(states.local.α, states.local.β, states.factor)
        of_pressure = error.of_pressure(whole, moments)
        lengths = np.column_stack([states.half_width, states.centre])
        size = np.tile(states.half_width[:, None], 2)
        return [
            Gauge(
                of_pressure.word,
                np.concatenate([of_pressure.values, lengths], axis=1),
                np.concatenate([of_pressure.scale, size], axis=1),
            ),
            *self._gauges.of(g, states.contact.weights, states.pressure.σ_YY(self.task.places.X)),
        ]


#: Amplitudes of the shapes (states, parts), half-widths, middles, free ends, depth of the punch's lowest
#: point below the level of the first shape, over N/(2μ), and slope beyond the shapes, relative.
_Solved = tuple[NDArray, NDArray, NDArray, NDArray, NDArray, NDArray]


def _parabola(body: Body, loads: NDArray, K: NDArray, local: EdgeExponents) -> _Solved:
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


def _smooth(body: Body, loads: NDArray, K: NDArray, local: EdgeExponents) -> _Solved:
    """Amplitudes of v = -v₀ + the punch's height with the load, and without intensity at both ends."""
    punch, few = body.profile, slice(1 + SHAPES)
    units = np.broadcast_to(body.displacement, len(loads)).tolist()
    conditions, near = free_ends(local, K[..., few], loads[:, few]), None
    ends, slopes = [], []
    for condition, unit in zip(conditions, units):
        near = condition.found(punch, unit, near)
        ends.append(near)
        slopes.append(slopes_of_shapes(punch, *near, 2 * loads.shape[1]) / unit)
    (m, h), size, count = np.transpose(ends), np.abs(slopes), loads.shape[1] - 1
    shapes = np.array(slopes)[:, :count]
    v0 = (-2.0 - (shapes * loads[:, 1:]).sum(axis=1)) / loads[:, 0]
    lowest = np.asarray(punch.height(m)) / units
    unresolved = size[:, count:].sum(axis=1) / size.max(axis=1)
    free = np.ones((len(m), 2), dtype=bool)
    return np.column_stack([v0, shapes]), h, m, free, lowest, unresolved


def _tilted(body: Body, loads: NDArray, K: NDArray, local: EdgeExponents) -> _Solved:
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


class FreeAtSpeed(PunchesAtSpeed):
    """Punches with free ends at one speed, solved to the tolerance."""

    def states(self, g: NDArray, load: Any = None) -> Any:
        body = self.task.body.loaded(load)
        return FreePunches(self, g, self.level.states(g, load), body)


@dataclass(frozen=True)
class FreePunches:
    """Contacts with free ends, with several frictions, each with its own half-width and middle.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
        solved: ends, nodal forces and weights.
        body: the sliding contact, under the load of each state.
    """

    at: FreeAtSpeed
    g: NDArray[np.float64]
    solved: FreeStates
    body: Body

    @property
    def local(self) -> Exponents:
        return self.solved.exponents

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of the contact [m], (states,)."""
        return self.solved.half_width

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self.solved.centre

    @property
    def K_I(self) -> NDArray[np.float64]:
        """K_I at the left and the right end, 0 at a free end, (states, 2)."""
        return self.solved.K_I

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        σ_YY = self.solved.pressure.σ_YY
        value, top = largest(lambda x: -σ_YY(x), lambda i, x: -σ_YY(x)[i])
        infinite = ~self.solved.free.all(axis=1)
        return np.where(infinite, np.nan, value), np.where(infinite, np.nan, top)

    @property
    def residual(self) -> NDArray[np.float64]:
        """Residual of the integral equation under the pressure, relative, (states,)."""
        solved = self.solved
        return of_contact(
            self.at.task.response, self.g, self.local, self.body, solved.pressure.σ_YY,
            (solved.centre, solved.half_width),
        )  # fmt: skip

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Normal force over N/2, (states,)."""
        return self.solved.contact.load

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Tangential force over N/2, (states,)."""
        return self.solved.contact.tangential.sum(axis=1)

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation of the punch's lowest point over N/(2μ), (states,)."""
        return self.solved.contact.v0

    @property
    def fitted(self) -> NDArray[np.float64]:
        """1 where the state was fitted through other speeds, 0 where it was solved, (states,)."""
        return np.full(len(self.g), float(self.at.fitted))

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by word of output.quantities."""
        errors = self.at.error.of(self.g, self.body.load)
        return {word: values + self.solved.unresolved for word, values in errors.items()}

    @cached_property
    def surface(self) -> Surface:
        contact, places = self.solved.contact, self.at.task.places
        raw = contact.tested(self.at.level.recovery.raw)
        σ_YY = self.solved.pressure.σ_YY(places.X)
        return self.at.displacement.surface(self.g, contact.weights, σ_YY, raw)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self.at.displacement.inside(self.solved.contact.weights)

    @cached_property
    def strength(self) -> Strength:
        """Yield of the states."""
        at, weights = self.at, self.solved.contact.weights
        field = at.displacement.at
        return Strength(
            lambda points: field(points, weights), self.body, at.task.response, self.g, self.local,
            self.half_width, turns_at_ends(self.surface, self.local), _NEAREST,
        )  # fmt: skip
