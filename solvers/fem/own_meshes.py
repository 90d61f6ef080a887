"""Contacts with free ends by finite elements, each on a mesh drawn for it.

**Kinks.** The slope of a convex punch, or its derivative, may jump at places that depend on the state. So
the ends are solved for first, on the mesh of all speeds, where a few polynomial shapes give the ends of
every friction and every load, and cells need not resolve a kink (:class:`EndsLevel`). Then every state
has a mesh with cells graded towards its kinks (:class:`BetweenKinks`).

**Layers** have a length, so each contact has a mesh drawn for its half-width. That is searched for by
:mod:`galinx.solvers.contact.ends`, at a lower degree first: the load that makes a contact of the mesh's
half-width is to be the load of the task (:class:`Followed`). Three displacements are prescribed under
the punch: its height around a nearby middle, the change of that height where the middle moves, and a
constant. Their loads and the intensities at both ends are linear in their amplitudes. So the half-width
of a mesh has a load of its own, at which both intensities vanish, and a middle: of a parabola at once, of
other profiles once the middle hardly moves (:class:`BalancedLevel`). The contact of a tilted base has one
free end and a middle that follows from its half-width (:class:`TiltedLevel`). Kinks on layers, and kinks
of friction, which are elsewhere over each half-width, are followed in the same way
(:class:`KinkedSplineLevel`).

On the mesh of a contact the degree rises until the measured error is within tolerance. Where contacts of
all loads differ in size alone, a single state of a friction stands for all of them.
"""

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import ceil, log
from typing import Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.kind import DEGREES
from galinx.meshes.rings import QuadMesh, rings_at_kinks, with_kinks

from ..contact import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE
from ..contact.ends import SHAPES, Punch, half_width_of_load
from ..contact.fem_plan import (
    OWN_MESHES_KEPT,
    FemPlan,
    at_friction_kinks,
    crowded_kinks,
    joined_kinks,
    kind_of,
    required_on_layers,
    requirements,
    uncrowded_kinks,
)
from ..contact.pressure import ENDS, Expansion
from ..contact.recovery import KinkedPressure, gaps_of, slopes_towards_ends
from ..contact.solution import Contact, Task, make_contact
from ..contact.stresses import (
    NEAR_TIP,
    Places,
    Surface,
    Turns,
    at_and_between,
    of_factor,
    off_tips,
    turns_at_ends,
)
from ..errors import SolveError
from ..profiles import check_reach, cusp, exponent, kinks, kinks_between, leaving
from ..profiles.punches import Flat, is_level
from .contact import (
    ACROSS,
    BESIDE_ENDS,
    FreeLevel,
    PunchLevel,
    SplineLevel,
    carrying,
    without_intensity,
)
from .discretisation import Discretisation
from .ladder import Gauge, WorkDone, climb, joined, to_tolerance
from .punch import ContactStates
from .solution import Solution, SolvedStates, solution_of
from .space import Space

#: A state by σ_XY/σ_YY and load [N/m]; a contact by middle and half-width [m].
State: TypeAlias = tuple[float, float]
Lengths: TypeAlias = tuple[float, float]


class OwnMeshes:
    """Contacts at one speed, each solved on its mesh when first needed; the last few are kept.

    Args:
        work: gives meshes.
        task: the speed.
        g: all values of σ_XY/σ_YY that will be solved.
    """

    def __init__(self, work: Discretisation, task: Task, g: NDArray) -> None:
        self._work, self._task, self._done = work, task, WorkDone()
        self._record: dict[str, Any] = {"cells": 0, "unknowns": 0, "degree": 0}
        #: Warnings of the state with the largest error, and this error.
        self._missed: tuple[float, Sequence[str]] = 0.0, ()
        #: States by σ_XY/σ_YY and load, in the order of their last use; the error on the last mesh.
        self._kept: dict[State, SolvedStates] = {}
        self._error: Any = None

    def states(self, g: NDArray, load: Any = None) -> Solution:
        def each(g: NDArray, load: Any) -> list[SolvedStates]:
            loads = np.broadcast_to(self._task.body.loaded(load).load, g.shape).tolist()
            return [self._state(*state) for state in zip(g.tolist(), loads)]

        return solution_of(self._task, each, g, load)

    def _state(self, g: float, load: float) -> SolvedStates:
        state = self._kept.pop((g, load), None)
        if state is None:
            task = replace(self._task, body=self._task.body.loaded(load), loads=(load,))
            state = self._solved(np.array([g]), task)
            if self._error.missed and self._error.worst > self._missed[0]:
                self._missed = self._error.worst, self._error.missed
        self._kept[g, load] = state
        while len(self._kept) > OWN_MESHES_KEPT:
            self._kept.pop(next(iter(self._kept))).level.close()
        return state

    def _solved(self, g: NDArray, task: Task) -> SolvedStates:
        """Contact with σ_XY/σ_YY g, (1,), under the one load of a task, solved to the tolerance.

        Raises:
            SolveError: no contact carries the load, or the equations could not be solved.
        """
        raise NotImplementedError

    def _on(
        self, mesh: Discretisation, task: Task, g: NDArray, level: Callable[[Space, NDArray], Any]
    ) -> SolvedStates:
        """Contact on its mesh, by a :class:`SingleLevel` whose degree is raised to the tolerance."""
        solved = to_tolerance(mesh, task, g, level, self._done)
        self._error = solved.error
        for name, value in solved.numbers.items():
            self._record[name] = max(self._record.get(name, value), value)
        return solved.on_mesh(g)[0]

    def record(self) -> dict[str, Any]:
        return self._record | vars(self._done) | {"missed": self._missed[1]}

    def close(self) -> None:
        """Free the kept states."""
        for state in self._kept.values():
            state.level.close()


class EndsLevel(FreeLevel):
    """Ends of contacts under any convex punch at one degree; see :class:`.contact.PunchLevel`."""

    shapes = SHAPES

    def lengths(self, g: NDArray, load: Any = None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Middle and half-width [m] of every state, (2, states), and what shapes leave out, (states,).

        Raises:
            SolveError: no contact carries the load.
        """
        _, loads, K = self.parts(g)
        return self.ends(g, self.task.body.loaded(load), loads, K)

    def gauges(self, g: NDArray, load: Any = None) -> list[Gauge]:
        (m, h), unseen = self.lengths(g, load)
        # Differences of the half-widths' logarithms are relative changes.
        return [joined(INTENSITIES, [(np.column_stack([np.log(h), m / h, unseen]), 1.0)])]


class SingleLevel(PunchLevel):
    """A single contact on a mesh of its own: its displacement and nodal forces are kept, no others.

    Args:
        work, task, space, g: as of :class:`.contact.PunchLevel`.
        base: ends of the contact, or of one near by, and the punch between them.

    """

    twins = False
    recovery = None  # type: ignore[assignment]

    def __init__(
        self, work: Discretisation, task: Task, space: Space, g: NDArray, base: "EndsBetweenKinks"
    ) -> None:
        self.base = base
        super().__init__(work, task, space, g)
        try:
            contact, field = self.solved(g, task.body), self.fields[0].duplicate()
            field.zeroEntries()
            field.maxpy(contact.weights[0].tolist(), self.fields)
        finally:
            self.punch.destroy()
        self.fields = [field]
        forces = np.tensordot(contact.weights, contact.forces, 1)
        #: The contact.
        self.contact = replace(contact, weights=np.ones((1, 1)), forces=forces)

    def states(self, g: NDArray, load: Any = None) -> SolvedStates:
        return SolvedStates(self, self.task.body.loaded(load), self.contact, self.pressure(self.contact))

    def close(self) -> None:
        self.fields[0].destroy()


#: Distance over a from an end or a kink from which on stresses are looked at, the place itself besides:
#: in innermost cells, nearer than which these follow no logarithm; and where derivatives lose digits.
_CELLS, _DIGITS = 3.0, 1e-5

#: Rings of the usual ratio more around a cusp of the pressure; size of innermost cells at a kink, over
#: the tolerance.
_AROUND_CUSP, _INNERMOST = 4, 30.0

#: Size of the innermost cells at a tip, over the least distance from it at which stresses are evaluated.
_OF_TIP = 0.25


@dataclass(frozen=True)
class EndsBetweenKinks:
    """Ends of one contact, and kinks between them, towards which its mesh is graded.

    Attributes:
        body: the sliding contact, under its load.
        lengths: middle and half-width [m].
        tolerance: of the scene.
        trial: True in a search, where kinks towards which cells cannot be graded are left out.
        of_friction: rising positions over the half-width at which friction, or a derivative of it, jumps.

    Raises:
        SolveError: cells cannot be graded towards the punch's kinks.
    """

    body: Contact
    lengths: Lengths
    tolerance: float
    trial: bool = False
    of_friction: Sequence[float] = ()

    def __post_init__(self) -> None:
        if crowded := crowded_kinks(self.places):
            other = "sie" if self.body.no_closed_form else "closed_form"
            raise SolveError(f'the punch has {crowded}; take methods = ["{other}"]')

    @cached_property
    def of_punch(self) -> NDArray[np.float64]:
        """Positions of the punch's kinks over the half-width."""
        return kinks_between(self.body.profile, *self.lengths)

    @cached_property
    def places(self) -> NDArray[np.float64]:
        """Positions of the kinks over the half-width, rising; of friction those that cells can follow."""
        places = joined_kinks(self.of_punch, self.of_friction)
        return uncrowded_kinks(places) if self.trial else places

    @cached_property
    def exponents(self) -> NDArray[np.float64]:
        """Powers of the distance with which the pressure leaves its values at kinks, (kinks,)."""
        return np.where(np.isin(self.places, self.of_punch), leaving(self.body.profile), 1.0)

    @property
    def tips(self) -> NDArray[np.float64]:
        """Kinks at which stresses are infinite."""
        return self.places[self.exponents == 0.0]

    @property
    def kinks(self) -> NDArray[np.float64]:
        """Kinks at which stresses are finite."""
        return self.places[self.exponents > 0.0]

    def drawn(self, plan: FemPlan) -> QuadMesh:
        """Mesh of a plan whose cells are graded towards the kinks.

        Rings are no steeper than the usual ones of its mesh. They are steeper where cells are finer in
        angle, which does at ends that are free: the pressure at a kink is no power of the distance, and a
        ring that spans a fifth of it is slow to follow that.

        Next to a kink of the slope's derivative the pressure is d log d, and its error in the innermost
        cells is of their size at any degree. At a tip the pressure is infinite, and stresses are
        evaluated farther away: if an innermost cell reached that far, no degree would resolve them at
        any tolerance.
        """
        rings, ratio = plan.refinement, plan.kind.ratio
        if rings.ratio < ratio:
            count = ceil(rings.levels * log(rings.ratio) / log(ratio))
            rings = replace(rings, levels=count, ratio=ratio)
        order = max((exponent(self.body.profile) or 2.0) - 1.0, 1.0)
        size = _OF_TIP * NEAR_TIP if len(self.tips) else (_INNERMOST * plan.tolerance) ** (1.0 / order)
        more = max(0, rings_at_kinks(rings, size))
        if cusp(self.body.profile):
            more = ceil(_AROUND_CUSP * log(ratio) / log(rings.ratio))
        return with_kinks(rings, self.places, more)


#: Step over the half-width of a derivative at an end; relative rate of the slope of a cube there.
_STEP, _CUBE = 1e-6, 2.0


class KinkedLevel(SplineLevel, SingleLevel):
    """Contact between ends that were solved for before, on cells graded towards kinks of the punch."""

    @property
    def kinks(self) -> NDArray[np.float64]:
        return self.base.places

    @property
    def _gaps(self) -> tuple[float, float]:
        """Distances over a from both ends within which the pressure is smooth but for the ends."""
        # Where a steep punch's slope changes faster than that of a cube, the pressure does, too.
        beside = ENDS[:, None] * [1.0, 1.0 - _STEP]
        of_ends, next_to_them = self.base.body.slope(beside, *self.base.lengths).T
        rates = np.abs(1.0 - next_to_them / of_ends) / _STEP
        left, right = np.minimum(gaps_of(self.base.places), _CUBE / np.maximum(rates, _CUBE / 2.0))
        return float(left), float(right)

    @property
    def end_exponents(self) -> tuple[float, float]:
        """Exponents of the pressure at its left and its right free end."""
        base = self.base
        local = base.body.edges(self.task.response, self.g, base.lengths[1], True)
        return float(local.β[0]), float(local.α[0])

    def continuation(self) -> Callable[[NDArray], Any] | None:
        gaps, exponents = self._gaps, self.end_exponents
        return lambda X: slopes_towards_ends(X, gaps, exponents)

    def heights(self) -> NDArray[np.float64]:
        return self.base.body.height(self.r, *self.base.lengths)

    def solved(self, g: NDArray, body: Contact) -> ContactStates:
        m, h = self.base.lengths
        return self.punch.states(g).between(h, m, True)

    def at_ends(self, contact: ContactStates, coarse: bool = False) -> Expansion:
        """Pressure that holds next to the ends, see :meth:`splines`."""
        return self.splines(contact.g, self.half_widths(contact), contact.tested, coarse, True)

    def pressure(self, contact: ContactStates) -> KinkedPressure:
        space, at_ends = self.space, self.at_ends(contact)
        return KinkedPressure(
            space.contact.s, space.degree, space.chart, contact.normal[0], self.base.places,
            self.end_exponents, at_ends, self.base.exponents, self.base.tolerance,
        )  # fmt: skip

    def nearest(self, states: SolvedStates) -> float:
        at = np.concatenate([[-1.0], self.base.kinks, [1.0]])
        return max(_CELLS * float(states.pressure.cells_beside(at).max()), _DIGITS)

    @property
    def measured_task(self) -> Task:
        """Task without places next to tips, where stresses are infinite."""
        places, tips = self.task.places, self.base.tips
        X, points, around = places.X, places.points, places.around
        return replace(
            self.task,
            places=replace(
                places,
                X=X[off_tips(X, tips)],
                points=points[off_tips(points[:, 0], tips, points[:, 1])],
                around=around[off_tips(around[:, 0], tips, around[:, 1])],
            ),
        )

    def gauge(self, states: SolvedStates) -> Gauge:
        """Gauge of the pressure's moments over the load, and of the pressure over its largest.

        Kinks are among the places: there it is a limit, which has less digits than what it is taken from.
        """
        pressure, across = states.pressure, ACROSS[off_tips(ACROSS, self.base.tips)]
        at_kinks = [pressure.at_kink(i) for i in np.flatnonzero(self.base.exponents).tolist()]
        σ = np.append(pressure.σ_YY(across), at_kinks)[None]
        size = np.abs(σ).max(keepdims=True)
        # Splines of all degrees are off alike next to ends, where they are the pressure.
        gaps = np.minimum(gaps_of(self.base.kinks), 1.0)
        beside = (ENDS[:, None] * (1.0 - np.outer(gaps, BESIDE_ENDS))).ravel()
        each = pressure.at_ends, self.at_ends(states.contact, coarse=True)
        now, coarse = (of.σ_YY(beside) for of in each)
        left = np.abs(coarse - now).max() + pressure.left_at_kinks
        return self.gauge_of_free(states, σ, size, float(left / size[0, 0]))

    def turns(self, states: SolvedStates, surface: Surface) -> Turns:
        """Limits of stresses at both ends, and under kinks where they are finite."""
        X, pressure, numbers = self.base.kinks, states.pressure, np.flatnonzero(self.base.exponents)
        σ_YY = np.array([pressure.at_kink(i) for i in numbers.tolist()])

        def strain(r: NDArray) -> NDArray[np.float64]:
            return states.displacement.strains(r, states.contact.weights)[0]

        u_X = np.array([pressure.limit_at_kink(i, strain) for i in numbers.tolist()])
        response, σ_XY = states.task.response, states.ratio(X)[0] * σ_YY
        under = np.array([response.σ_XX(u_X, σ_YY, σ_XY), σ_YY, σ_XY])

        def in_plane(r: NDArray) -> NDArray[np.float64]:
            # At an end itself a slope has no digits.
            return states.in_plane(np.clip(r, _DIGITS - 1.0, 1.0 - _DIGITS))

        between = None
        if len(X):
            places = np.array([-1.0, *X, 1.0])
            # Nearer to ends and kinks the limits there stand for the stress.
            _, between = at_and_between(places, in_plane, nearest=self.nearest(states))
        at_ends = super().turns(states, surface)
        assert at_ends
        return at_ends.joined(Turns(X[None], under[:, None], between))


class BetweenKinks(OwnMeshes):
    """Contacts with kinks, whose ends are solved for first: to the tolerance, for sample states."""

    def __init__(self, work: Discretisation, task: Task, g: NDArray) -> None:
        super().__init__(work, task, g)
        ends = work.for_ends
        self._ends = climb(ends, task, g, partial(EndsLevel, ends, task), done=self._done)

    def _solved(self, g: NDArray, task: Task) -> SolvedStates:
        work, load = self._work, task.body.load
        lengths, unseen = self._ends.level.lengths(g, np.array([load]))
        between = EndsBetweenKinks(task.body, tuple(lengths[:, 0].tolist()), work.plan.tolerance)
        mesh = replace(work, plan=replace(work.plan, graded=between.drawn))
        state = self._on(mesh, task, g, partial(KinkedLevel, mesh, task, base=between))
        state.errors[INTENSITIES] += self._ends.error.of(g, load)[INTENSITIES] + unseen
        return state

    def close(self) -> None:
        super().close()
        self._ends.close()


#: Growth of the load's logarithm with that of the half-width, as on a half-plane under a parabola.
GROWTH = 2.0


class BalancedLevel(SplineLevel, SingleLevel):
    """Contact over layers without intensities, on a mesh drawn for its half-width.

    The contact has that half-width under a load of its own. Its half-width under the task's load is
    estimated by the growth of loads on a half-plane. The task's lengths are over the half-width.

    The base of the level has the mesh's half-width and the middle of a contact near by.
    """

    #: Growth of loads on a half-plane; True where an end is a sharp edge.
    growth: ClassVar[float] = GROWTH
    sharp: ClassVar[bool] = False

    @property
    def off(self) -> float:
        """Logarithm of the load of a contact of the mesh's half-width, over the task's."""
        return -self.growth * float(np.log(self.contact.half_width[0] / self.base.lengths[1]))

    @property
    def lean(self) -> float:
        """Middle of the contact over the mesh's half-width."""
        return float(self.contact.centre[0] / self.base.lengths[1])

    def heights(self) -> NDArray[np.float64]:
        body, lengths = self.base.body, self.base.lengths
        return np.stack([body.height(self.r, *lengths), body.slope(self.r, *lengths)])

    def solved(self, g: NDArray, body: Contact) -> ContactStates:
        """Contact without intensities.

        Raises:
            SolveError: no load makes such a contact.
        """
        parts, loads, K = self.parts(g)
        amplitudes = without_intensity(loads, K)
        return self.punch.summed(g, parts, amplitudes).between(*self.lengths(amplitudes), True)

    def lengths(self, amplitudes: NDArray) -> tuple[float, float]:
        """Half-width and middle [m] of the contact without intensities, by its parts' amplitudes."""
        (near, h), (_, share, slope) = self.base.lengths, amplitudes[0].tolist()
        return self.under_load(share), near + h * slope / share

    def under_load(self, share: float) -> float:
        """Half-width [m] under the task's load, by the amplitude of the punch's height on this mesh.

        Over its own load the punch's height is that over the task's load times their quotient.

        Raises:
            SolveError: no load makes such a contact.
        """
        h = self.base.lengths[1]
        if not share > 0.0:
            raise SolveError(f"finite elements found no load for a contact of the half-width {h:g} m")
        return h * share ** (1.0 / self.growth)

    def half_widths(self, contact: ContactStates) -> NDArray[np.float64]:
        return np.full(len(contact.g), self.task.body.half_width)

    def parts(self, g: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        parts, h = self.punch.parts(g), self.task.body.half_width
        return parts, self.punch.loads(parts), self.intensities(parts, g[0], h).T[None]


class TiltedLevel(BalancedLevel):
    """Contact of a tilted base over layers, all along it or with its higher edge lifted off.

    On a mesh as wide as the base that edge is down where it has no intensity under a smaller load, or
    under none.
    """

    growth, sharp = 1.0, True

    @property
    def lean(self) -> float:
        return self.base.lengths[0] / self.base.lengths[1]

    def heights(self) -> NDArray[np.float64]:
        body = self.base.body
        heights = body.height(self.r, *self.base.lengths)[None]
        return heights[:0] if is_level(body.profile) else heights

    def solved(self, g: NDArray, body: Contact) -> ContactStates:
        (parts, loads, K), (_, h) = self.parts(g), self.base.lengths
        punch: Any = self.base.body.profile
        if not is_level(punch):
            free = np.logical_not(punch.sharp)
            lifted = without_intensity(loads, K[:, free])
            share = float(lifted[0, 1])
            if h < punch.half_width or 0.0 < share < 1.0:
                contact, wide = self.punch.summed(g, parts, lifted), self.under_load(share)
                return contact.between(wide, punch.middle(wide), free)
        down = carrying(loads, np.ones((1, len(loads[0]) - 1)))
        return self.punch.summed(g, parts, down).between(h, 0.0, False)

    def turns(self, states: SolvedStates, surface: Surface) -> Turns:
        return turns_at_ends(surface, states.local)  # of other states, too

    def gauge(self, states: SolvedStates) -> Gauge:
        gauge, K = self.gauge_of_edges(states), np.abs(states.pressure.series(ENDS))
        own = self.gauge_of_free(states, gauge.values, gauge.scale, gauge.unresolved)
        # Next to its lift-off an edge has little left of the intensity without a tilt.
        cancelled = np.where(states.contact.free, 1.0, K.max() / of_factor(K)).max(axis=1)
        (moment,) = states.contact.tested(self.moments[:, 1:2]).T / 2.0
        return replace(own, cancelled=cancelled, leaning=np.abs(moment))


class KinkedSplineLevel(BalancedLevel, KinkedLevel):
    """Contact under a punch with kinks, on a mesh graded towards these, with any friction along it."""

    def continuation(self) -> None:
        # Next to an end where friction varies slopes have logarithms, which no series of powers follows.
        return None

    def solved(self, g: NDArray, body: Contact) -> ContactStates:
        contact, parts, h = super().solved(g, body), self.punch.parts(g), self.task.body.half_width
        K = self.intensities(parts, g[0], h, coarse=True).T[None]
        half_width, centre = self.lengths(without_intensity(self.punch.loads(parts), K))
        #: Change of the ends over the half-width where splines have no knots next to ends and kinks.
        self.moved = max(abs(half_width - contact.half_width[0]), abs(centre - contact.centre[0])) / h
        return contact

    def gauge(self, states: SolvedStates) -> Gauge:
        gauge = super().gauge(states)
        return replace(gauge, unresolved=gauge.unresolved + self.moved)


def drawn_for(task: Task, plan: FemPlan, words: frozenset[str], kinks: NDArray, sharp: bool) -> FemPlan:
    """Plan of a mesh drawn for a contact over layers.

    Args:
        task: the speed, with lengths over the half-width of the mesh.
        plan: plan of all contacts.
        words: words of output.quantities that request stresses.
        kinks: rising positions of kinks, those of friction among them, over the half-width.
        sharp: True where an end is a sharp edge.
    """
    places, interfaces = task.places, task.places.interfaces
    kind = kind_of(interfaces, [task.response], (-1.0, *kinks.tolist(), 1.0))
    below = places.points if BELOW in words else np.empty((0, 2))
    if AT_INTERFACES in words:
        X, depth = np.meshgrid(places.along, interfaces)
        below = np.concatenate([below, np.column_stack([X.ravel(), -depth.ravel()])])
    X = places.X if ON_SURFACE in words else np.empty(0)
    requested = Places(X, below, places.around)
    target = requirements(plan.tolerance, requested, plan.sharp, [task.response])
    target = required_on_layers(target, sharp)
    degree = kind.degree(target, task.response.margin)
    return replace(
        plan, kind=kind, wanted=target, degrees=(degree,) * len(plan.degrees)
    )  # fmt: skip


#: Error of the half-width at a lower degree, and by how much that is lower; the error over the tolerance
#: at the usual degree.
_ROUGH, _LOWER, _SETTLED = 3e-2, 3, 0.5
#: Least difference of the half-width's logarithm from which the growth of the load is computed; error of
#: that growth, which hardly depends on the degree; most trials at the usual degree.
_APART, _OF_GROWTH, _TRIALS = 1e-5, 0.05, 5
#: Largest error by the mesh's ends over the tolerance once all is solved; else another mesh is drawn.
_ERROR = 0.3


class Followed(OwnMeshes):
    """Contacts whose half-widths and middles are searched for on meshes that follow them.

    They are those over layers, and those with kinks and friction that varies along them.
    """

    #: Level on layers where the punch has no kinks; growth of the load's logarithm with that of the
    #: half-width, of the last contact; None before.
    _level: type[BalancedLevel] = BalancedLevel
    _growth: float | None = None

    def _solved(self, g: NDArray, task: Task) -> SolvedStates:
        # Half-widths under the load by those of solved states, the nearest by load, then by friction.
        load, growth = task.body.load, self._growth or self._level.growth
        near = [
            (
                abs(float(np.log(load / other[1]))),
                abs(other[0] - float(g[0])),
                state.contact.half_width[0] * (load / other[1]) ** (1.0 / growth),
            )
            for other, state in self._kept.items()
        ]
        #: The contact sought, and its middle over the half-width.
        self._sought, self._g, self._lean = task, g, 0.0
        drawn = self._half_width(float(min(near)[-1] if near else task.body.half_width))
        state, lean, h = self._contact(drawn)
        if self._off(h / drawn, lean - self._lean) > self._closeness * self._work.plan.tolerance:
            state.level.close()
            drawn, self._lean = h, lean
            state, lean, h = self._contact(drawn)
        check_reach(task.body.profile, h * (lean - 1.0), h * (lean + 1.0))
        contact = state.contact.between(h, self._middle(h, lean), state.contact.free)
        off = self._off(h / drawn, lean - self._lean)
        errors = {word: value + off for word, value in state.errors.items()}
        deeper = h / drawn if task.body.solid.layers else 1.0
        return replace(state, body=task.body, contact=contact, errors=errors, deeper=deeper)

    def _middle(self, h: float, lean: float) -> float:
        """Middle [m] of a contact of half-width h [m], by that over the half-width on a mesh near by."""
        return h * lean

    def _off(self, wider: float, moved: float) -> float:
        """Relative error of a contact that is near to that of its mesh.

        Args:
            wider: its half-width over that of the mesh.
            moved: distance of their middles over the half-width.
        """
        # Heights are linear in the middle; but kinks are elsewhere than those of the mesh.
        return max(abs(wider - 1.0), abs(moved) if kinks(self._sought.body.profile) else moved**2)

    @property
    def _closeness(self) -> float:
        """Distance of a mesh from its contact over the tolerance: next to tips stresses are steep."""
        return _ERROR * (NEAR_TIP if kinks(self._sought.body.profile) else 1.0)

    def _contact(self, h: float) -> tuple[SolvedStates, float, float]:
        """Contact on a mesh drawn for a half-width [m]; its middle over its half-width, and this [m]."""
        mesh, task, level = self._drawn(h, self._work.stresses)
        state = self._on(mesh, task, self._g, level)
        return state, state.level.lean, self._moved({h: state.level.off})

    def _half_width(self, h: float) -> float:
        """Half-width [m] of the contact that carries the load, from a half-width near by."""
        body, settled = self._sought.body, _SETTLED * self._work.plan.tolerance
        tried, rough = dict[float, float](), max(_ROUGH, settled)

        def off(h: float) -> float:
            tried[h] = self._load(h, _LOWER, rough)
            return tried[h]

        h = half_width_of_load(off, h, Punch(body.profile, 1.0, float(body.compression)), rough)
        h = self._moved(tried | {h: tried.pop(h)})
        # Loads of a low degree do not compare with those of a high one, but they grow alike.
        tried = {}
        for _ in range(_TRIALS):
            tried[h] = self._load(h, 0, settled)
            error = abs(tried[h]) * (_OF_GROWTH if self._growth else 1.0)
            h = self._moved(tried)
            if error <= settled:
                break
        return h

    def _moved(self, tried: dict[float, float]) -> float:
        """Half-width [m] under the task's load, by the last of some near by.

        Args:
            tried: logarithms of the loads of half-widths [m] over the task's.
        """
        (first, of_first), *_, (last, of_last) = 2 * [*tried.items()]
        apart = float(np.log(last / first))
        if abs(apart) > _APART:
            self._growth = (of_last - of_first) / apart
        return last * float(np.exp(-of_last / (self._growth or self._level.growth)))

    def _load(self, h: float, lower: int, error: float) -> float:
        """Logarithm of the load that makes a contact of half-width h [m], over the task's.

        Args:
            h: half-width [m].
            lower: difference of the degree from the usual one.
            error: relative error that is allowed.
        """
        moved = np.inf
        while self._off(1.0, moved) > error * self._closeness / _ERROR:
            mesh, task, solve = self._drawn(h, frozenset(), trial=True)
            degree = max(mesh.plan.degrees[task.number] - lower, DEGREES[0])
            with closing(solve(mesh.space(degree), self._g)) as level:
                self._done.count(level.factor)
                moved, self._lean = level.lean - self._lean, level.lean
        return level.off

    def _drawn(
        self, h: float, words: frozenset[str], trial: bool = False
    ) -> tuple[Discretisation, Task, Callable[[Space, NDArray], BalancedLevel]]:
        """Mesh drawn for a half-width [m], the task with lengths over it, and the solution in a space."""
        sought, plan, g = self._sought, self._work.plan, float(self._g[0])
        friction = sought.body.friction(g, h)
        along = {g: friction} if sought.body.along else {}
        task = replace(
            sought, body=make_contact(sought.body.solid, Flat(h), sought.body.load, along=along)
        )
        lengths = h * self._lean, h
        base = EndsBetweenKinks(sought.body, lengths, plan.tolerance, trial, friction.jumps)
        layered, smooth = len(sought.response.depths) > 0, not len(base.of_punch)
        if layered:
            depths = sought.body.solid.depths / h  # type: ignore[attr-defined]
            task = replace(
                task,
                response=sought.body.solid.response(sought.response.c, h),
                places=replace(sought.places, interfaces=depths),
            )
            plan = drawn_for(task, plan, words, base.places, self._level.sharp)
        elif smooth:
            plan = replace(plan, graded=partial(at_friction_kinks, kinks=base.places))
        else:
            plan = replace(plan, graded=base.drawn)
        mesh = replace(self._work, plan=plan, stresses=words)
        kind = self._level if smooth else KinkedSplineLevel
        return mesh, task, partial(kind, mesh, task, base=base)


class LiftedOff(Followed):
    """Contacts of tilted bases over layers: as wide as the base, or less where the higher edge lifts off.

    The lower edge stays where it is, so that the half-width has a middle.
    """

    _level = TiltedLevel

    @property
    def _punch(self) -> Any:
        return self._sought.body.profile

    def _half_width(self, h: float) -> float:
        widest = float(self._punch.half_width)
        if self._load(widest, _LOWER, _ROUGH) <= 0.0:
            return widest
        return super()._half_width(min(h, widest))

    def _moved(self, tried: dict[float, float]) -> float:
        return min(super()._moved(tried), self._punch.half_width)

    def _middle(self, h: float, lean: float) -> float:
        return float(self._punch.middle(h))

    def _drawn(self, h: float, *args: Any, **options: Any) -> Any:
        self._lean = self._middle(h, self._lean) / h
        return super()._drawn(h, *args, **options)
