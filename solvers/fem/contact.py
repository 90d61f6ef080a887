"""Rigid punches by finite elements at one speed, their pressure unknown, to the measured error.

A :class:`PunchLevel` solves contacts at one degree. Its kinds differ in the ends of the contact: sharp
(:class:`SharpLevel`, :class:`SharpSplineLevel`), free (:class:`FreeLevel`), or those of one contact on a
mesh drawn for it (:mod:`galinx.solvers.fem.own_meshes`).

With free ends: the half-plane has no length, so the mesh is that of a contact from -1 to 1 whatever its
width is, and the displacement prescribed under the punch is a combination of few shapes: 1 and s for a
tilted flat base, 1, s and s² for a parabola, as many polynomials as it takes for any other smooth
profile. Load and vanishing intensities at free ends are linear in their amplitudes, from which half-width
and middle follow; of a parabola directly, of other profiles by the conditions of
:mod:`galinx.solvers.contact.ends`. Every friction and every load is solved in the basis of the
speed.
"""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import replace
from functools import cache, cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..contact import FREE_ENDS, INTENSITIES, VARYING, VARYING_FREE
from ..contact.along import FittedSplines, Splines
from ..contact.edges import EdgeExponents
from ..contact.ends import SHAPES, end_conditions, heights_of_shapes, slopes_of_shapes
from ..contact.fem_plan import SHARP_ON_LAYERS, graded_kinks
from ..contact.pressure import ENDS, Expansion
from ..contact.recovery import (
    MOMENTS,
    ContactFacets,
    ContactRecovery,
    chebyshev,
    from_moments,
    without_zeros,
)
from ..contact.solution import ONE_FREE, Contact, Task
from ..contact.stresses import of_factor
from ..errors import SolveError
from ..profiles import radius
from .discretisation import Discretisation
from .fields import Displacement
from .ladder import Gauge, Level, joined, of_pressure
from .punch import LEAST, ContactStates, Punch, SlidingPunch, sliding_punch
from .solution import SolvedStates
from .space import Space

#: Least distance over a from a free end at which stresses are evaluated, besides the end itself.
_NEAREST = 1e-6

#: Residual of the contact forces at degrees that only measure the error of another, over the tolerance,
#: and at most: next to edges stresses have some thousand times as much of it.
_OF_TOLERANCE, _ROUGH = 1e-4, 1e-10


class PunchLevel(Level):
    """Punch at one degree, and the maps from its contact forces to its pressure.

    Args:
        work, task, space, g: as of :class:`galinx.solvers.fem.ladder.Level`.
        fitted: the punch, where it is known from other speeds; it is solved if None.
        recovery: maps from nodal forces that were made for another speed in the same space.

    Attributes:
        twins: True where contacts have mirror images on the same mesh.
        punch: the punch.
        plan: plan of the finite elements.
    """

    twins = True

    def __init__(
        self, work: Discretisation, task: Task, space: Space, g: NDArray, fitted: Punch | None = None,
        recovery: ContactRecovery | None = None,
    ) -> None:  # fmt: skip
        super().__init__(work, task, space, g)
        self.plan = work.plan
        if recovery:
            self.recovery = recovery
        self.punch = fitted or self._solved()
        self.fields = self.punch.fields

    def _solved(self) -> Punch:
        """The punch, solved for all states that are still to do."""
        plan, least = self.plan, LEAST
        # It measures an error, no more; a fit interpolates between frictions, to a few 1e-12.
        if not plan.sweep and self.space.degree < plan.degrees[self.task.number]:
            least = max(min(_OF_TOLERANCE * plan.tolerance, _ROUGH), LEAST)
        punch = sliding_punch(
            self.space, self.task.response, plan.solver, self.heights(), self.along(), least=least
        )
        self.factor = punch.factor
        self.prepare(punch)
        return punch

    def prepare(self, punch: SlidingPunch) -> None:
        """Complete the fields of a punch for all states of the level."""
        punch.prepare(self.g)

    @abstractmethod
    def heights(self) -> NDArray[np.float64] | None:
        """Heights of the punch or of shapes at the contact nodes, in the level's unit; None if flat."""

    @abstractmethod
    def solved(self, g: NDArray, body: Contact) -> ContactStates:
        """Contacts with frictions g = σ_XY/σ_YY, (states,), under the load of the body for each.

        Raises:
            SolveError: no contact carries the load.
        """

    @abstractmethod
    def pressure(self, contact: ContactStates) -> Any:
        """Pressure of contacts from their nodal forces."""

    @abstractmethod
    def gauge(self, states: SolvedStates) -> Gauge:
        """Gauge of pressure and ends."""

    def along(self) -> Callable[[Any], NDArray] | None:
        """Map from g to G where friction varies along the contact, see :class:`SlidingPunch`."""
        return None

    def continuation(self) -> Callable[[NDArray], Any] | None:
        """Continuation of slopes to free ends, see :class:`Displacement`; None where there is none."""
        return None

    def nearest(self, states: SolvedStates) -> float:
        return _NEAREST

    @cached_property
    def r(self) -> NDArray[np.float64]:
        """Positions over a of the contact nodes, (nodes,)."""
        return self.space.chart.surface_position(self.space.contact.s)

    @property
    def count(self) -> int:
        """Number of moments of the pressure."""
        return MOMENTS

    @cached_property
    def moments(self) -> NDArray[np.float64]:
        """Map from nodal forces to moments of the pressure, (nodes, moments)."""
        return chebyshev(self.r, self.count)

    @cached_property
    def recovery(self) -> ContactRecovery:  # type: ignore[override]
        """Maps from nodal forces to moments, raw pressure and exponents."""
        space, X = self.space, self.task.places.X
        return ContactRecovery(space.contact.s, space.degree, space.chart, X)

    def displacement_at(self, task: Task) -> Displacement:
        return Displacement(task, self.space, self.fields, self.punch.slopes, self.continuation())

    @property
    def mirrored(self) -> bool:  # type: ignore[override]
        """True where there is a mirror image on the same mesh."""
        return self.task.response.mirrored and self.twins

    def over_flat(self, moments: NDArray, g: NDArray) -> Expansion:
        """Pressure from moments, with exponents of sharp edges at frictions g."""
        local = EdgeExponents(self.task.response, g)
        return from_moments(moments, local.α, local.β)

    def parts(self, g: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """Parts of the punch, their loads, (states, parts), and intensities, (states, 2, parts)."""
        parts = self.punch.parts(g)
        moments = self.punch.tested(parts, self.moments).swapaxes(0, 1)
        K_I = np.stack([self.over_flat(of_part, g).K_I for of_part in moments], axis=2)
        return parts, self.punch.loads(parts), K_I

    def gauge_of_free(
        self, states: SolvedStates, σ: NDArray, size: NDArray, unresolved: Any = 0.0
    ) -> Gauge:
        """Gauge of a pressure between free ends, of its moments over the load, and of the ends.

        Args:
            states: the states.
            σ: numbers that stand for their pressure, (states, n).
            size: sizes of these, to which their changes are relative.
            unresolved: relative error that the level shows by itself, (states,) or 0.
        """
        contact, h = states.contact, states.contact.half_width
        # Differences of the half-widths' logarithms are relative changes.
        lengths = np.column_stack([np.log(h), contact.centre / h])
        groups = (contact.tested(self.moments[:, 1:6]), 2.0), (σ, size), (lengths, 1.0)
        return joined(INTENSITIES, groups, unresolved)

    def states(self, g: NDArray, load: Any = None) -> SolvedStates:
        body = self.task.body.loaded(load)
        contact = self.solved(g, body)
        return SolvedStates(self, body, contact, self.pressure(contact))

    def gauges(self, g: NDArray, load: Any = None) -> list[Gauge]:
        """Gauges of states: of pressure and ends, and of requested stresses."""
        states = self.states(g, load)
        return [self.gauge(states), *(self.stress_gauges(states) if self.work.stresses else [])]

    def rounding(self, g: NDArray, load: Any = None) -> list[float]:
        """Effect of rounding on each gauge, relative: difference of a flat punch from its mirror at -g.

        In a solid without mirror symmetry it is the difference of K_I at the two ends, which are equal
        under a flat punch all the same. Where they differ, or a single state has no flat punch beside it,
        what the solve leaves of its forces stands for rounding. Stresses are relative to those of the
        states themselves: beside a flat punch's sharp edges they are large, beside free ends they are
        not, and their rounding is as large.
        """
        own = self.states(g, load)
        if not self.twins:
            return [self.factor.largest_residual, *self.rounding_of_stresses(own)]
        K_I, σ_XX = [], []
        for sign in (1, -1) if self.mirrored else (1,):
            flat = self.punch.states(sign * g, flat=True)
            pressure = self.over_flat(flat.tested(self.moments), sign * g)
            K_I.append(pressure.K_I[:, ::sign])
            if self.work.stresses:
                σ_XX.append(self.in_plane(replace(own, contact=flat, pressure=pressure))[:, ::sign])
        if not self.mirrored:
            K_left, K_right = K_I[0].T
            return [float(np.abs(K_left / K_right - 1.0).max()), *self.rounding_of_stresses(own)]
        noise = np.abs(σ_XX[0] - σ_XX[1]) if σ_XX else None
        of_edges = float((np.abs(K_I[0] - K_I[1]) / np.abs(K_I[0])).max())
        return [of_edges, *self.rounding_of_stresses(own, noise)]

    def close(self) -> None:
        self.punch.destroy()


class SharpLevel(PunchLevel):
    """Sharp edges at both ends of the base of a punch that touches all along it."""

    def heights(self) -> NDArray[np.float64] | None:
        body = self.task.body
        # Over a length of the punch, not over one that has the load: digits are the same under any load.
        return None if body.flat else body.profile.height(body.half_width * self.r) / body.half_width

    def solved(self, g: NDArray, body: Contact) -> ContactStates:
        contact = self.punch.states(g, share=body.half_width / body.displacement)
        return contact.between(float(body.half_width), 0.0, False)

    def pressure(self, contact: ContactStates) -> Expansion:
        return self.over_flat(contact.tested(self.moments), contact.g)

    def gauge(self, states: SolvedStates) -> Gauge:
        return of_pressure(states.pressure, states.contact.tested(self.moments))


#: Distance from an end or a kink within which the pressure without its weight has no knots, over the root
#: of the length in which friction varies: nearer, innermost cells are not sure. That from which on it has
#: several in a cell, over that length; how many; degree of the cells less that of its splines.
_NEXT, _WIDE, _IN_A_CELL, _LESS = 1e-5, 1e-2, 4, 2
#: Unit of the first of these over the thickness of the uppermost layer or over the least distance between
#: ends and kinks, where there are no logarithms.
_ANALYTIC = 100.0
#: Growth of the first of these for splines that show what the others leave out, and factor of what they
#: show.
_COARSE, _SURE = 4.0, 1.5
#: Places over a at which a pressure between sharp edges is measured, and those beside a kink of friction;
#: least stress over the mean to which its error is relative.
_ALL_ACROSS, _BESIDE_KINK = np.cos(np.pi * (np.arange(64) + 0.5) / 64.0), (-1e-3, -2e-4, 2e-4, 1e-3)
_SMALL = 0.1


#: Splines that are kept with their tests.
_FITTED = 4


class SplineLevel(PunchLevel):
    """Contacts whose pressures are splines: over layers, or with friction that varies along them."""

    twins = False

    @cached_property
    def facets(self) -> ContactFacets:
        return ContactFacets(self.space.contact.s, self.space.degree, self.space.chart)

    def along(self) -> Callable[[Any], NDArray] | None:
        body = self.task.body
        if not body.along:
            return None
        return cache(lambda g: self.facets.product(body.friction(g, body.half_width)))

    @property
    def kinks(self) -> NDArray[np.float64]:
        """Rising positions over a between the ends at which the pressure is not smooth."""
        return np.array(graded_kinks(self.task.body))

    def half_widths(self, contact: ContactStates) -> NDArray[np.float64]:
        """Half-widths [m] on which frictions of contacts depend, (states,)."""
        return np.asarray(contact.half_width)

    def pressure(self, contact: ContactStates, coarse: bool = False) -> Expansion:
        lengths = self.half_widths(contact)
        return self.splines(contact.g, lengths, contact.tested, coarse, contact.free)

    def splines(
        self, g: NDArray, half_width: NDArray, tested: Callable[[NDArray], NDArray],
        coarse: bool = False, free: Any = False,
    ) -> Expansion:  # fmt: skip
        """Pressure of contacts, by splines without knots within a distance of ends and kinks.

        Args:
            g, half_width: numbers of the frictions, and half-widths of the contacts [m], (states,).
            tested: normal forces times tests (nodes, n), (states, n).
            coarse: leave out more knots next to ends and kinks, one at least next to a sharp end.
            free: True where the left and the right end are free, broadcast to (states, 2).
        """
        body, degree, kinks = self.task.body, self.space.degree, self.kinks
        places = np.concatenate([[-1.0], kinks, [1.0]])
        ends_of_cells = self.r[::degree]
        ratio = np.broadcast_to(body.ratio(g, ends_of_cells, half_width), (len(g), len(ends_of_cells)))
        steepest = np.abs(np.diff(ratio) / np.diff(ends_of_cells)).max(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            length = np.nanmin(np.append(np.ptp(ratio, axis=1) / steepest, 1.0))
        first = _NEXT * (self._analytic or np.sqrt(length))
        of_knots = [places]
        # Nodes have to tell all splines apart: no more of these than nodes, and a node in each step.
        count = min(_IN_A_CELL, degree) if degree > _LESS else 1
        shares = np.arange(1, count) / count
        within = (ends_of_cells[:-1, None] + np.diff(ends_of_cells)[:, None] * shares).ravel()
        for candidates, least in ((ends_of_cells, first), (within, _WIDE * length)):
            of_knots.append(candidates[np.abs(candidates[:, None] - places).min(axis=1) > least])
        knots = np.unique(np.concatenate(of_knots))
        if coarse:
            apart = np.abs(knots[:, None] - places).min(axis=1)
            kept = (apart > _COARSE * first) | (apart == 0.0)
            kept[[1, -2]] &= np.all(np.broadcast_to(free, (len(g), 2)), axis=0)
            knots = knots[kept]
        # Of a degree that rises with that of the cells, so that changes show what splines do not follow.
        of_splines = max(degree - _LESS, 0)
        splines = Splines(tuple(knots.tolist()), tuple(kinks.tolist()), of_splines, self._graded)
        fitted, local = self._fitted(splines), body.edges(self.task.response, g, half_width, free)
        return fitted.pressure(tested(fitted.nodal), local.α, local.β)

    @cached_property
    def _fitted(self) -> Callable[[Splines], FittedSplines]:
        """Splines with their tests; the last ones are kept, as a search for ends asks for them often."""
        # Nodal forces know of tests their interpolants only.
        return lru_cache(_FITTED)(
            lambda splines: FittedSplines(splines, splines.sparse(self.r), self.facets.interpolation)
        )

    @cached_property
    def _analytic(self) -> float:
        """Unit over a of the nearest knots' distances where the pressure less its weight is analytic.

        Logarithms beside it are among the splines. It is 0 where friction varies.
        """
        if self.task.body.along:
            return 0.0
        response = self.task.response
        changes = [length / response.a for length in response.solid.changes[:1]] if self._graded else []
        apart = np.diff(self.kinks, prepend=-1.0, append=1.0)
        return _ANALYTIC * float(min([1.0, *response.depths[:1], *changes, *apart]))

    @property
    def _graded(self) -> bool:
        """True for a solid that is graded from the surface on."""
        response = self.task.response
        return bool(len(response.depths)) and response.solid.layers[0].bottom is not None  # type: ignore[attr-defined]

    def gauge_of_edges(self, states: SolvedStates) -> Gauge:
        """Gauge of the pressure's factors at ends, 0 at free ones, and of the pressure between these."""
        contact, beside = states.contact, np.add.outer(self.kinks, _BESIDE_KINK).ravel()
        places = np.append(_ALL_ACROSS, beside[np.abs(beside) < 1.0])
        (K, σ), (coarse_K, coarse_σ) = (
            (np.where(contact.free, 0.0, pressure.series(ENDS)), pressure.σ_YY(places))
            for pressure in (states.pressure, self.pressure(contact, coarse=True))
        )
        size, of_K = np.maximum(np.abs(σ), _SMALL), of_factor(K)
        # Without the nearest knots splines show less of the error of the innermost cells.
        off = np.abs(np.column_stack([(coarse_K - K) / of_K, (coarse_σ - σ) / size])).max(axis=1)
        groups = (K, of_K), (σ, size), (contact.tested(self.moments[:, 1:6]), 2.0)
        return replace(joined(INTENSITIES, groups, _SURE * off), of_cells=True)

    def intensities(
        self, parts: NDArray, g: Any, half_width: float, coarse: bool = False
    ) -> NDArray[np.float64]:
        """Intensities of the parts (1, parts, fields) of one state at both ends, (parts, 2)."""
        each, lengths = np.multiply.outer([g, half_width], np.ones(parts.shape[1]))
        return self.splines(each, lengths, lambda tests: self.punch.tested(parts, tests)[0], coarse).K_I

    def gauge(self, states: SolvedStates) -> Gauge:
        """Gauge of contacts with free ends, by moved knots."""
        contact, σ = states.contact, states.pressure.σ_YY(ACROSS)
        size = np.abs(σ).max(axis=1, keepdims=True)
        off = np.abs(self.pressure(contact, coarse=True).σ_YY(ACROSS) - σ) / size
        return self.gauge_of_free(states, σ, size, off.max(axis=1))


class SharpSplineLevel(SplineLevel, SharpLevel):
    """Sharp edges of a flat punch over layers, or with friction that varies along the contact."""

    def gauge(self, states: SolvedStates) -> Gauge:
        return self.gauge_of_edges(states)


#: Amplitudes of the shapes (states, parts), depth of the punch's lowest point below the level of the
#: first shape, over N/(2μ), (states,), and the ends, see :meth:`ContactStates.between`.
_Solved = tuple[NDArray, NDArray, dict[str, Any]]


#: Moments of a pressure more than shapes of its punch: one for each, and some to measure what is left.
_MORE = 4


class FreeLevel(PunchLevel):
    """Free ends of smooth punches and of lifted bases, on the mesh of all contacts."""

    @property
    def shapes(self) -> int:
        """Number of polynomials whose sum is the punch under every contact."""
        return self.plan.shapes

    @property
    def count(self) -> int:
        return max(MOMENTS, self.shapes + _MORE)

    def heights(self) -> NDArray[np.float64]:
        return heights_of_shapes(self.r, self.shapes)

    def solved(self, g: NDArray, body: Contact) -> ContactStates:
        (parts, loads, K), linear = self.parts(g), _LINEAR.get(self.shapes)
        if linear:
            return self.summed(g, parts, linear(body, loads, K))
        (m, h), _ = self.ends(g, body, loads, K)
        return self.summed(g, parts, self.smooth(body, loads, m, h))

    def summed(self, g: NDArray, parts: NDArray, solved: "_Solved") -> ContactStates:
        """Contacts by their parts and these parts' amplitudes."""
        amplitudes, lowest, ends = solved
        contact = self.punch.summed(g, parts, amplitudes).between(**ends)
        if not np.all((contact.half_width > 0.0) & np.isfinite(contact.half_width)):
            raise SolveError("no contact of a finite half-width carries the load")
        return replace(contact, v0=contact.v0 + lowest)

    @cached_property
    def _ends(self) -> dict[tuple[float, float], tuple[float, float]]:
        """Middles and half-widths [m] of solved states, by σ_XY/σ_YY and load [N/m]."""
        return {}

    def ends(
        self, g: NDArray, body: Contact, loads: NDArray, K: NDArray
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Middles and half-widths [m] of contacts, (2, states), and what the shapes leave out, (states,).

        Args:
            g: σ_XY/σ_YY, (states,).
            body, loads, K: as of :func:`_parabola`; ``SHAPES`` shapes are used.

        Raises:
            SolveError: no contact carries the load.
        """
        few = slice(1 + SHAPES)
        conditions = end_conditions(EdgeExponents(self.task.response, g), K[..., few], loads[:, few])
        each = np.broadcast_arrays(g, body.load, body.displacement)
        ends, last = [], next(reversed(self._ends.values()), None)
        for condition, friction, load, unit in zip(conditions, *(of.tolist() for of in each)):
            if (friction, load) not in self._ends:
                self._ends[friction, load] = condition.solve(body.profile, unit, last)
            last = self._ends[friction, load]
            ends.append(last)
        return np.transpose(ends), np.array([condition.unseen for condition in conditions])

    def smooth(self, body: Contact, loads: NDArray, m: NDArray, h: NDArray) -> _Solved:
        """Amplitudes of v = -v₀ + the punch's height with the load, between ends [m] that are known."""
        punch, count, units = body.profile, loads.shape[1] - 1, body.displacement * np.ones(len(m))
        each = zip(m.tolist(), h.tolist(), units.tolist())
        slopes = np.array([slopes_of_shapes(punch, m, h, 2 * (1 + count)) / unit for m, h, unit in each])
        ends = {"half_width": h, "centre": m, "free": True, "unresolved": left_out(slopes, count)}
        return carrying(loads, slopes[:, :count]), np.asarray(punch.height(m)) / units, ends

    def pressure(self, contact: ContactStates) -> Expansion:
        free = contact.free
        whole = self.over_flat(contact.tested(self.moments), contact.g)
        smooth = without_zeros(whole.c, free)
        return replace(whole, α=whole.α + free[:, 1:], β=whole.β + free[:, :1], c=smooth)

    def gauge(self, states: SolvedStates) -> Gauge:
        moments = states.contact.tested(self.moments)
        gauge = of_pressure(self.over_flat(moments, states.contact.g), moments)
        return self.gauge_of_free(states, gauge.values, gauge.scale, gauge.unresolved)


#: Frictions whose matrices are kept; accuracy of intensities at free ends that vanish, and the most left.
_KEPT, _BALANCED, _OF_INTENSITIES = 32, 1e-12, 1e-7
#: Distances over the half-width from free ends at which the pressure is measured, and all places.
BESIDE_ENDS = np.array([0.015, 0.01, 0.005, 1e-3, 1e-4, 1e-6])
ACROSS = np.append(
    np.cos(np.pi * (np.arange(24) + 0.5) / 24.0), np.outer(ENDS, 1.0 - BESIDE_ENDS).ravel()
)


class VaryingFreeLevel(SplineLevel, FreeLevel):
    """Free ends of smooth punches and of tilted bases with friction that varies along the contact.

    Middle and half-width are the root of the intensities at the free ends, with the friction of each
    half-width.
    """

    def along(self) -> Callable[[Any], NDArray]:
        return lru_cache(_KEPT)(self.facets.product)

    def prepare(self, punch: SlidingPunch) -> None:
        self.punch = punch
        g, loads = self.g, np.array(self.task.loads)
        # Parts that are asked for add fields.
        contact = self.solved(np.repeat(g, len(loads)), self.task.body.loaded(np.tile(loads, len(g))))
        punch.prepare(self._frictions(contact.g[-1:], contact.half_width[-1:]))

    def solved(self, g: NDArray, body: Contact) -> ContactStates:
        loads = np.broadcast_to(body.load, g.shape).tolist()
        each = [self._balanced(*state) for state in zip(g.tolist(), loads)]
        (m, h), free = np.transpose([lengths for lengths, _ in each]), np.array([of for _, of in each])
        parts = self.punch.parts(self._frictions(g, h))
        amplitudes, lowest, ends = self.smooth(body, self.punch.loads(parts), m, h)
        if body.ends == ONE_FREE:
            lowest = np.abs(amplitudes[:, 1])  # an edge is the lowest point of a tilted base
        return self.summed(g, parts, (amplitudes, lowest, ends | {"free": free}))

    def _frictions(self, g: NDArray, h: NDArray) -> NDArray[Any]:
        """Frictions along contacts of half-widths [m], objects of :class:`.along.Along`, (states,)."""
        each = zip(g.tolist(), h.tolist())
        return np.array([self.task.body.friction(*state) for state in each], dtype=object)

    @cached_property
    def _balanced(self) -> Callable[[float, float], tuple[tuple[float, float], list[bool]]]:
        """Ends by σ_XY/σ_YY and load [N/m], see :meth:`_balance`; each is searched for once."""
        return cache(self._balance)

    def _balance(self, g: float, load: float) -> tuple[tuple[float, float], list[bool]]:
        """Middle and half-width [m] of a contact, and which ends are free; its search adds fields.

        Raises:
            SolveError: no contact carries the load.
        """
        from scipy.optimize import root  # a slow import

        body = self.task.body.loaded(load)
        punch: Any = body.profile
        tilted, free = body.ends == ONE_FREE, np.logical_not(punch.sharp)
        scale = float(body.half_width)

        def ends(x: NDArray) -> tuple[float, float]:
            h = scale * float(np.exp(x[-1]))
            # The lower edge of a tilted base stays.
            return float(punch.middle(h) if tilted else scale * x[0]), h

        def intensities(x: NDArray) -> NDArray[np.float64]:
            m, h = ends(x)
            parts = self.punch.parts(np.array([body.friction(g, h)], dtype=object))
            amplitudes, *_ = self.smooth(body, self.punch.loads(parts), np.array([m]), np.array([h]))
            return (amplitudes[0] @ self.intensities(parts, g, h))[free]

        if tilted and intensities(whole := np.log([punch.half_width / scale]))[0] >= 0.0:
            return ends(whole), [False, False]
        x = root(intensities, [0.0, 0.0][tilted:], tol=_BALANCED).x
        if not np.abs(intensities(x)).max() < _OF_INTENSITIES:
            raise SolveError("no contact of a finite half-width carries the load")
        return ends(x), free.tolist()


def without_intensity(loads: NDArray, K: NDArray) -> NDArray[np.float64]:
    """Amplitudes of parts whose sum carries the load and has no intensity at some ends, (states, parts).

    Args:
        loads: ∫σ_YY of every part, (states, parts).
        K: intensities of every part at these ends, one less than there are parts, (states, ends, parts).
    """
    b = np.zeros((*loads.shape, 1))
    b[:, 0] = -2.0
    return np.asarray(np.linalg.solve(np.concatenate([loads[:, None], K], axis=1), b)[..., 0])


def carrying(loads: NDArray, shapes: NDArray) -> NDArray[np.float64]:
    """Amplitudes of parts whose sum carries the load, by those of shapes, (states, shapes).

    Args:
        loads: ∫σ_YY of every part, the flat one first, (states, 1 + shapes).
        shapes: amplitudes of the others.
    """
    v0 = (-2.0 - (shapes * loads[:, 1:]).sum(axis=1)) / loads[:, 0]
    return np.column_stack([v0, shapes])


def left_out(slopes: NDArray, count: int) -> NDArray[np.float64]:
    """Slope beyond the first shapes over the largest of all, (...), 0 where all vanish."""
    size = np.abs(slopes)
    return size[..., count:].sum(axis=-1) / np.maximum(size.max(axis=-1), np.finfo(float).tiny)


def _parabola(body: Contact, loads: NDArray, K: NDArray) -> _Solved:
    """Amplitudes of v = -v₀ + c₁ s + c₂ s²/2 with the load, and without intensity at both ends.

    Args:
        body: the sliding contact.
        loads: ∫σ_YY of every part, (states, parts).
        K: intensities of every part at both ends, (states, 2, parts).
    """
    amplitudes = np.zeros_like(loads)
    amplitudes[:, :3] = without_intensity(loads[:, :3], K[..., :3])
    _, c1, c2 = amplitudes[:, :3].T
    with np.errstate(invalid="ignore"):
        h = np.sqrt(radius(body.profile) * c2 * body.displacement)
    return amplitudes, c1**2 / (2.0 * c2), {"half_width": h, "centre": h * c1 / c2, "free": True}


def _tilted(body: Contact, loads: NDArray, K: NDArray) -> _Solved:
    """Amplitudes of v = -v₀ + c₁ s with the load; c₁ is that of the tilt, or, where the higher edge is
    lifted, that without intensity there."""
    punch: Any = body.profile
    side = 1 if punch.rise > 0.0 else 0
    c1 = punch.rise * punch.half_width / body.displacement * np.ones(len(loads))
    amplitudes = carrying(loads, c1[:, None])
    lifted = (K[:, side] * amplitudes).sum(axis=1) < 0.0
    amplitudes = np.where(lifted[:, None], without_intensity(loads, K[:, [side]]), amplitudes)
    with np.errstate(divide="ignore", invalid="ignore"):  # a base that is not tilted lifts off nowhere
        h = np.where(lifted, amplitudes[:, 1] * body.displacement / punch.rise, punch.half_width)
    free = np.zeros((len(loads), 2), dtype=bool)
    free[:, side] = lifted
    centre = np.where(lifted, punch.middle(h), 0.0)
    return amplitudes, np.abs(amplitudes[:, 1]), {"half_width": h, "centre": centre, "free": free}


#: Solutions by the number of polynomials whose sum is the punch, where conditions are linear.
_LINEAR = {1: _tilted, 2: _parabola}

#: Levels of punches on the mesh of all contacts, by the plan's mode.
PUNCHES: dict[str, type[PunchLevel]] = {
    "contact": SharpLevel,
    SHARP_ON_LAYERS: SharpSplineLevel,
    FREE_ENDS: FreeLevel,
    VARYING: SharpSplineLevel,
    VARYING_FREE: VaryingFreeLevel,
}
