"""Measured error of finite elements, and the degree that brings it within tolerance.

The contacts of a speed are solved at rising degrees. Of every degree gauges of some states are kept,
numbers with the sizes to which their changes are relative (:class:`Gauge`). The error of the last degree
follows from the changes from one to the next (:class:`MeasuredError`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.kind import DEGREES

from ..contact import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE, VARYING, YIELD, stresses
from ..contact.edges import from_edge
from ..contact.estimate import AT_DEPTHS, SAFETY, SLOWEST, Rate, before, of_degrees, remaining
from ..contact.fem_plan import levels
from ..contact.pressure import ENDS, Expansion
from ..contact.solution import Task
from ..contact.stresses import Surface, Turns, turns_at_ends
from .discretisation import Discretisation
from .fields import Displacement
from .punch import spread
from .solution import Solution, SolvedStates, solution_of
from .space import Space

#: Most points inside on which the error is measured; of more points so many are picked.
_POINTS = 400

#: Positions r under the punch at which the pressure's smooth factor is measured, both edges among them.
_ACROSS = np.append(np.cos(np.pi * np.arange(9) / 8.0), np.outer(ENDS, [0.99, 0.997, 0.999]))

#: Effect of rounding on stresses over that of the last digits of the displacements alone, times the root
#: of the response's margin: 0.2 to 2.8 times the difference of mirror images where solids have them.
_SOLVED = 100.0


@dataclass(frozen=True)
class Gauge:
    """Numbers of states that stand for a word of output.quantities.

    Attributes:
        word: the word.
        values: the numbers, (states, n).
        scale: sizes to which their changes are relative, (states, n).
        unresolved: relative error that a level shows by itself, (states,) or 0.
        cancelled: size of the largest parts whose sum a number is, over its own, (states,) or 1.
        leaning: distance over a of the pressure's centre from the contact's middle, (states,) or 0.
        of_cells: True where finer cells leave less unresolved.
    """

    word: str
    values: NDArray[np.float64]
    scale: NDArray[np.float64]
    unresolved: Any = 0.0
    cancelled: Any = 1.0
    leaning: Any = 0.0
    of_cells: bool = False

    def change(self, coarse: "Gauge") -> NDArray[np.float64]:
        """Largest relative difference of each state from the same gauge of another level, (states,)."""
        return np.max(np.abs(self.values - coarse.values) / self.scale, axis=1)


def largest_changes(gauges: Sequence[Gauge], others: Sequence[Gauge]) -> dict[str, float]:
    """Largest relative difference of two lists of gauges, by word of output.quantities."""
    return {gauge.word: float(gauge.change(other).max()) for gauge, other in zip(gauges, others)}


def joined(word: str, groups: Sequence[tuple[NDArray, Any]], unresolved: Any = 0.0) -> Gauge:
    """Gauge of groups of numbers, (states, n) each, with the sizes that scale their changes."""
    values, sizes = zip(*((of, np.broadcast_to(size, of.shape)) for of, size in groups))
    return Gauge(word, np.concatenate(values, axis=1), np.concatenate(sizes, axis=1), unresolved)


def of_pressure(pressure: Expansion, moments: NDArray) -> Gauge:
    """Gauge of K_I, the pressure all over the contact, and its moments 1 to 5 over the load.

    Args:
        pressure: of the states.
        moments: of it, (states, moments).
    """
    factor = pressure.series(_ACROSS)
    groups = (factor, stresses.of_factor(factor)), (moments[:, 1:6], 2.0)
    return joined(INTENSITIES, groups, pressure.unresolved)


def _from_edges(points: NDArray) -> NDArray[np.float64]:
    """Distances over a of points (n, 2) from the nearer edge."""
    return np.hypot(from_edge(points[:, 0]), points[:, 1])


class Level:
    """Solution at one degree.

    Args:
        work: has the plan and the words of the requested stresses.
        task: the speed.
        space: space of the degree.
        g: all values of σ_XY/σ_YY that will be solved.

    Attributes:
        factor: of the linear system, with numbers of its work.
        fields: displacements over N/(2μ), whose combinations are the states.
        mirrored: True where :meth:`rounding` is that of mirror images, not only a bound on rounding.
        recovery: maps from nodal forces to raw pressure and exponents, None without any.
    """

    factor: Any
    fields: Sequence[Any]
    mirrored: bool
    recovery: Any = None

    def __init__(self, work: Discretisation, task: Task, space: Space, g: NDArray) -> None:
        self.work, self.task, self.space, self.g = work, task, space, g

    def displacement_at(self, task: Task) -> Displacement:
        """Displacement, for stresses at the places of a task."""
        return Displacement(task, self.space, self.fields)

    @property
    def measured_task(self) -> Task:
        """Task with the places at which stresses are measured."""
        return self.task

    @cached_property
    def gauged_task(self) -> Task:
        """Task with no more points inside than the error is measured at, at all distances from edges."""
        task, few = self.measured_task, {}
        for name in ("points", "around"):
            points = getattr(task.places, name)
            if len(points) > _POINTS:
                order = np.argsort(_from_edges(points), kind="stable")
                few[name] = points[np.sort(spread(order, _POINTS))]
        return replace(task, places=replace(task.places, **few)) if few else task

    @cached_property
    def gauged_displacement(self) -> Displacement:
        """Displacement, for stresses at these."""
        return self.displacement_at(self.gauged_task)

    @cached_property
    def displacement(self) -> Displacement:
        """Displacement, for stresses at all places."""
        if self.gauged_task is self.task:
            return self.gauged_displacement
        return self.displacement_at(self.task)

    def states(self, g: NDArray, load: Any = None) -> SolvedStates:
        """States with values g of σ_XY/σ_YY, (states,), under the task's load or others [N/m].

        Raises:
            SolveError: no contact carries the load.
        """
        raise NotImplementedError

    def turns(self, states: SolvedStates, surface: Surface) -> Turns | None:
        """Limits of stresses on a surface, None where there are none."""
        return turns_at_ends(surface, states.local) if states.contact.free.any() else None

    def nearest(self, states: SolvedStates) -> float:
        """Least distance over a from free ends and kinks at which stresses are evaluated."""
        return 1.0

    def gauges(self, g: NDArray, load: Any = None) -> list[Gauge]:
        """Gauges of states; arguments as of :meth:`states`."""
        return self.stress_gauges(self.states(g, load)) if self.work.stresses else []

    def stress_gauges(self, states: SolvedStates) -> list[Gauge]:
        """Gauges of the requested stresses of states."""
        at, places = self.gauged_displacement, self.gauged_task.places
        #: Stresses inside by word, and their sizes.
        by_word: dict[str, tuple[Callable[[NDArray], NDArray], Callable[[NDArray], NDArray]]] = {
            BELOW: (at.inside, lambda σ: stresses.of_inside(σ, *places.points.T)),
            YIELD: (at.around, lambda σ: stresses.of_inside(σ, *places.around.T)),
            AT_INTERFACES: (at.interfaces, stresses.of_interfaces),
        }
        gauges = [self._on_surface(states)] if ON_SURFACE in self.work.stresses else []
        for word, (evaluate, size) in by_word.items():
            if word in self.work.stresses:
                σ = evaluate(states.contact.weights)
                by_state = [np.moveaxis(of, 1, 0) for of in (σ, np.broadcast_to(size(σ), σ.shape))]
                gauges.append(Gauge(word, *(of.reshape(len(of), -1) for of in by_state)))
        return gauges

    def _on_surface(self, states: SolvedStates) -> Gauge:
        """Gauge of σ_XX on the surface, and of its limits at free ends, its extremes there."""
        places, σ_XX = self.measured_task.places, self.in_plane(states)
        surface = Surface(places, np.full(σ_XX.shape, np.nan), σ_XX)
        # As many numbers at every degree: an edge may lift off at some of them only.
        at_ends = np.where(states.contact.free, turns_at_ends(surface, states.local).σ[0], 0.0)
        largest = np.nanmax(np.abs(np.column_stack([σ_XX, at_ends])), axis=1)[:, None]
        groups = (σ_XX, stresses.of_in_plane(σ_XX, places.X)), (at_ends, largest)
        return joined(ON_SURFACE, groups)

    def in_plane(self, states: SolvedStates) -> NDArray[np.float64]:
        """σ_XX over N/(2a) where stresses on the surface are measured, (states, n)."""
        X, weights = self.measured_task.places.X, states.contact.weights
        return self.gauged_displacement.surface(states.ratio(X), weights, states.pressure.σ_YY(X)).σ_XX

    def rounding(self, g: NDArray, load: Any = None) -> list[float]:
        """Effect of rounding alone on each gauge, relative; arguments as of :meth:`states`."""
        raise NotImplementedError

    def rounding_of_stresses(self, states: SolvedStates, noise: NDArray | None = None) -> list[float]:
        """Effect of rounding on stresses, relative, by word.

        Points inside have no mirror image, those on the surface have: σ_XX there stands for all stresses,
        no nearer to an edge than the word's points are.

        Args:
            states: the states.
            noise: effect of rounding on σ_XX, (states, n); a bound by the last digits of the fields, if
                it is None.
        """
        places, response = self.gauged_task.places, self.task.response
        nearest = {
            ON_SURFACE: lambda: from_edge(places.X),
            BELOW: lambda: _from_edges(places.points),
            YIELD: lambda: _from_edges(places.around),
            AT_INTERFACES: lambda: np.hypot(from_edge(places.along), places.interfaces[:, None]),
        }
        words = [word for word in nearest if word in self.work.stresses]
        if not words:
            return []  # no derivative is taken that is not requested
        size = stresses.of_in_plane(self.in_plane(states), places.X)
        if noise is None:
            noise = (
                _SOLVED / response.margin**0.5 * self.gauged_displacement.rounding(states.contact.weights)
            )
        on_surface = from_edge(places.X)
        least = [min(nearest[word]().min(initial=np.inf), on_surface.max()) for word in words]
        return [float((noise / size)[:, on_surface >= distance].max()) for distance in least]

    def close(self) -> None:
        """Free factor and fields."""
        raise NotImplementedError


@dataclass
class WorkDone:
    """Numbers of linear algebra, as they are archived."""

    factorisations: int = 0
    back_substitutions: int = 0
    iterations: int = 0
    largest_residual: float = 0.0
    largest_condition: float = 0.0

    def count(self, factor: Any) -> None:
        """Count the work of a factor."""
        self.factorisations += 1
        self.back_substitutions += factor.solves
        self.iterations = max(self.iterations, factor.iterations)
        self.largest_residual = max(self.largest_residual, factor.largest_residual)
        self.largest_condition = max(self.largest_condition, factor.condition)


#: Effect of rounding, over its part that breaks the mirror image.
ROUNDING = 3.0
#: Effect of higher moments without friction, over that at σ_XY = σ_YY.
_UPRIGHT = 0.1
#: States, spread over all of a speed, at which the error is measured.
PROBES = 9
#: Degrees over which the decay of changes is measured; the degree rises no further where the error at the
#: highest one, extrapolated, exceeds the tolerance by this factor.
_DECAY, _DOUBT = 2, 3.0
#: Share of a part of the error at the degree before from which on it is the same at all degrees.
_LASTS = 0.7
#: Share of a bound on rounding that rounding takes at least, see ``_SOLVED``.
_CERTAIN = 0.2


@dataclass(frozen=True)
class Estimate:
    """Estimated relative errors of the states of a speed, by those of some frictions and loads.

    Attributes:
        g: the frictions, rising, (frictions,).
        loads: the loads [N/m], rising, (loads,); a single one where contacts under all are similar.
        errors: errors of these states, (loads, frictions), by word of output.quantities.
    """

    g: NDArray[np.float64]
    loads: NDArray[np.float64]
    errors: dict[str, NDArray[np.float64]]

    #: Warnings that the tolerance is not reached.
    missed: ClassVar[Sequence[str]] = ()

    def of(self, g: NDArray, load: Any = None) -> dict[str, NDArray[np.float64]]:
        """Errors of states with frictions g, (states,), and loads [N/m], all loads if None.

        They are the largest ones of the frictions and the loads on both sides.
        """
        both = around(self.g, g)[:, None]
        of_load = np.arange(len(self.loads))[None, :, None]
        if load is not None:
            of_load = around(self.loads, np.broadcast_to(load, g.shape))[..., None]
        return {word: errors[of_load, both].max(axis=(1, 2)) for word, errors in self.errors.items()}


def stand_ins(
    task: Task, g: NDArray, most: int = PROBES
) -> tuple[NDArray[np.float64], NDArray | None, NDArray]:
    """States with frictions g that stand for all: frictions, loads, None if similar, and each load.

    Args:
        task: the speed.
        g: σ_XY/σ_YY, (n,).
        most: number of loads at most, from the least to the largest.
    """
    if task.body.alike:
        return g, None, np.zeros(1)
    loads = spread(np.unique(task.loads), most)
    return np.tile(g, len(loads)), np.repeat(loads, len(g)), loads


def around(places: NDArray, x: NDArray) -> NDArray[np.int64]:
    """Indices of the rising places on both sides of each x, equal where x is a place, (len(x), 2)."""
    last = len(places) - 1
    above = np.clip(np.searchsorted(places, x), 0, last)
    below = np.where(places[above] > x, above - 1, above)
    return np.column_stack([np.clip(below, 0, last), above])


@dataclass(frozen=True)
class Solved:
    """States at one speed on a mesh that they share, solved to the tolerance.

    Attributes:
        level: the last degree's.
        error: its error, an :class:`Estimate`.
        numbers: numbers of the work and the size of the last system, as they are archived.
        fitted: True where the speed was fitted through others.
    """

    level: Any
    error: Any
    numbers: dict[str, Any]
    fitted: bool = False

    def states(self, g: NDArray, load: Any = None) -> Solution:
        return solution_of(self.level.task, self.on_mesh, g, load)

    def on_mesh(self, g: NDArray, load: Any = None) -> list[SolvedStates]:
        """States with their estimated errors, on the one mesh."""
        states = self.level.states(g, load)
        of = self.error.of(g, None if len(self.error.loads) == 1 else states.body.load)
        errors = {word: values + states.contact.unresolved for word, values in of.items()}
        return [replace(states, errors=errors, fitted=self.fitted)]

    def record(self) -> dict[str, Any]:
        return self.numbers | {"missed": self.error.missed}

    def close(self) -> None:
        """Free factor and fields."""
        self.level.close()


def to_tolerance(
    work: Any, task: Task, g: NDArray, solve: Callable[[Space, NDArray], Any],
    done: WorkDone | None = None,
) -> Solved:  # fmt: skip
    """Solve a speed as :func:`climb` does, on finer cells where no degree reaches the tolerance.

    Args:
        work, task, g, solve: as of :func:`climb`; ``work.finer`` has the finer cells.
        done: takes the numbers of the work.
    """
    done = WorkDone() if done is None else done
    solved = climb(work, task, g, solve, done=done)
    if solved.error.of_cells:
        solved.close()
        share = work.plan.tolerance / work.finer.plan.tolerance
        solved = climb(work.finer, task, g, solve, share=share, done=done)
    return solved


def climb(
    work: Any, task: Task, g: NDArray, solve: Callable[[Space, NDArray], Any],
    degree: int | None = None, share: float = 1.0, done: WorkDone | None = None,
) -> Solved:  # fmt: skip
    """Solve a speed, the degree raised until the measured error is within tolerance or hardly falls.

    Args:
        work: gives spaces.
        task: the speed.
        g: its values of σ_XY/σ_YY, sorted.
        solve: gives the :class:`Level` of a space, for all values of g.
        degree: degree to begin with; the plan's if None.
        share: share of the tolerance that the error may take.
        done: takes the numbers of the work.
    """
    plan, done = work.plan, WorkDone() if done is None else done
    level: Any = None
    # States of friction along the contact are no family, of which some stand for the others.
    every = len(g) if VARYING in task.body.modes else PROBES
    probes = spread(g, every)
    to_solve = levels(degree or plan.degrees[task.number], plan.cuts, plan.fixed)
    measured: list[tuple[int, list[Gauge]]] = []
    try:
        while True:
            for p, cuts in to_solve:
                if level:
                    level.close()
                level = solve(work.space(p, cuts), g)
                done.count(level.factor)
                measured.append((p, level.gauges(*stand_ins(task, probes)[:2])))
            error = MeasuredError(work, level, probes, measured, share)
            if plan.fixed or p == DEGREES[1] or not error.of_degree or error.stalls:
                changes = {"change_by_degree": error.change_by_degree}
                return Solved(level, error, size_of(level.space) | vars(done) | changes)
            to_solve = [(p + 1, plan.cuts)]
    except BaseException:
        if level:
            level.close()
        raise


def size_of(space: Space) -> dict[str, int]:
    """Size of a system, as it is archived."""
    return {"cells": space.cells, "unknowns": space.size, "degree": space.degree}


class MeasuredError(Estimate):
    """Error of the last degree, estimated from changes from degree to degree.

    Args:
        work: has the plan.
        level: the last :class:`Level`.
        g: values of σ_XY/σ_YY that stand for all of the speed, rising.
        measured: degrees, and gauges of these states under all loads; three at least of rising degree, or
            a better one and that of a fixed degree.
        share: share of the tolerance that the error may take.

    Attributes:
        excessive: True where an error exceeds the tolerance, and most of it is not of the outer radius.
        of_degree: True where, besides, most of it, or enough for the tolerance, is not of what lasts at
            any degree: the effect of the outer radius, rounding, and what a level shows by itself where
            the degree before showed hardly more.
        floor: least error that finer cells would leave.
        of_cells: True where, besides, most of it does not last on finer cells either, and the floor is
            within tolerance.
        worst: largest relative error.
    """

    def __init__(
        self, work: Any, level: Any, g: NDArray, measured: list[tuple[int, list[Gauge]]], share: float
    ) -> None:
        self._work, self._level, self._degree = work, level, measured[-1][0]
        self._tolerance = tolerance = share * work.plan.tolerance
        #: Largest changes from the degree before, by degree and word; none at a fixed degree.
        self._changes: dict[int, dict[str, float]] = {}
        if not work.plan.fixed:
            self._changes = {
                degree: largest_changes(gauges, before)
                for (_, before), (degree, gauges) in pairwise(measured)
            }
        probes, loads, each_load = stand_ins(level.task, g)
        each, errors = zip(*(gauges for _, gauges in measured[-3:])), {}
        self.floor, self.excessive, enough, mended = 0.0, False, False, False
        for gauges, rounding in zip(each, level.rounding(probes, loads)):
            word = gauges[-1].word
            unseen = gauges[-1].cancelled * self._unseen(gauges[-1], probes, measured[-1][1][0].leaning)
            earlier, last = (gauge.unresolved for gauge in gauges[-2:])
            # What a level shows by itself where the level before showed hardly more.
            lasts = not gauges[-1].of_cells and last > _LASTS * earlier
            own = np.where(lasts, last, 0.0)
            changes = [late.change(early) for early, late in pairwise(gauges)]
            rounding, bound = self._rounding(word, rounding, float(changes[-1].max()))
            rate = self._rate(word)
            if work.plan.fixed:
                of_levels = before(changes[0], rate)
            else:
                of_levels = remaining(changes[0], changes[1], changes, rate, rounding)
            error = errors[word] = of_levels + unseen + gauges[-1].unresolved + ROUNDING * rounding
            lasting = ROUNDING * min(rounding, bound) + unseen + own
            if self._is_rounding(word, changes, ROUNDING * bound):
                lasting = np.maximum(lasting, error)
            # Where the outer radius alone spoils the tolerance, the cells need not do better than it.
            wrong = error > np.maximum(tolerance, 1.1 * unseen)
            self.excessive |= bool(wrong.any())
            mended |= bool((wrong & (2.0 * lasting < error)).any())
            enough |= bool((wrong & (lasting <= tolerance)).any())
            certain = 1.0 if level.mirrored else _CERTAIN
            # What rounding may do at most can be much more than what the last change shows that it does.
            remains = np.minimum(ROUNDING * certain * bound + own, error)
            self.floor = max(self.floor, float(np.max(remains)))
        self.of_cells = not work.plan.fixed and mended and self.floor <= tolerance
        self.of_degree = mended or enough
        self.worst = max((float(error.max()) for error in errors.values()), default=0.0)
        by_load = {word: error.reshape(-1, len(g)) for word, error in errors.items()}
        super().__init__(g, each_load, by_load)

    @property
    def stalls(self) -> bool:
        """True where changes fall so slowly that the highest degree would not reach the tolerance."""
        before, last = (self._change(self._degree - i) for i in (_DECAY, 0))
        ρ = (last / before) ** (1.0 / _DECAY) if before else 0.0
        if ρ >= 1.0:
            return True
        at_last = last * ρ ** (DEGREES[1] - self._degree)
        return SAFETY * at_last * ρ / (1.0 - ρ) > _DOUBT * self._tolerance

    def _change(self, degree: int) -> float:
        """Largest change from the degree before; 0 where that was not solved."""
        return max(self._changes.get(degree, {}).values(), default=0.0)

    @property
    def missed(self) -> list[str]:
        """Warning that the tolerance is not reached; none where it is."""
        if not self.excessive or self._work.plan.fixed:
            return []
        rest = "and falls too slowly"
        if self.floor > self._tolerance:
            rest = f"of which {self.floor:.1e} would remain on any cells"
        return [
            f"finite elements at c = {self._level.task.response.c:g} do not reach the tolerance "
            f"{self._tolerance:.2g}: the estimated error is {self.worst:.1e} at degree "
            f"{self._degree}, {rest}"
        ]

    @property
    def change_by_degree(self) -> list[float]:
        """Largest changes from the degree before, by degree; empty where nothing changed."""
        changes = [self._change(degree) for degree in range(DEGREES[1] + 1)]
        return changes if any(changes) else []

    def _rounding(self, word: str, rounding: float, last: float) -> tuple[float, float]:
        """Rounding that shows in a gauge, and what it may be at most, by the last change."""
        if self._level.mirrored:
            return rounding, rounding
        # Intensities at both ends differ by what the degree leaves, too; residuals of a solve do not.
        # Only what rounding might do is known there; what it does is in the last change, once.
        of_solve = self._level.factor.largest_residual if word == INTENSITIES else np.inf
        return min(rounding, last / ROUNDING), min(rounding, of_solve)

    def _is_rounding(self, word: str, changes: list[NDArray], bound: float) -> bool:
        """True where a bound on rounding explains the changes, which do not fall either."""
        # One change as large as the last may be luck: that of two degrees before counts, too.
        *earlier, change = (float(of.max()) for of in changes)
        earlier.append(self._changes.get(self._degree - _DECAY, {}).get(word, np.inf))
        return _LASTS * max(earlier) <= change <= bound

    def _rate(self, word: str) -> Rate:
        """Usual rate of convergence, or a slower one by the decay over two degrees; one may be luck."""
        rate = of_degrees(1)
        if word == AT_INTERFACES:
            rate = AT_DEPTHS
        elif word == INTENSITIES:
            rate = self._work.plan.rate
        earlier = self._changes.get(self._degree - _DECAY, {}).get(word)
        if not earlier:
            return rate
        ρ = min((self._changes[self._degree][word] / earlier) ** (1.0 / _DECAY), SLOWEST)
        return Rate(max(ρ, rate.usual), max(ρ, rate.believed), rate.least)

    def _unseen(self, gauge: Gauge, g: NDArray, leaning: Any) -> NDArray[np.float64]:
        """Estimated errors common to all levels, of outer radius and innermost cells, (states,).

        Args:
            gauge: of a word.
            g: σ_XY/σ_YY of the states.
            leaning: see :class:`Gauge`.
        """
        plan, response, body = self._work.plan, self._level.task.response, self._level.task.body
        kind, target, margin = plan.kind, plan.wanted, response.margin
        innermost = kind.unseen(target, self._degree, plan.cuts, margin)
        # Measured at far boundaries of 100 a, 1e3 a and 1e4 a; see docs/verification.md. n times the
        # margin is about the surface's compliance at rest, 1/10 to 10 for the solids that were tried.
        compliance = 2.0 + 0.55 * max(float(np.log(4.0 * response.n * margin)), -1.0)
        # Stiffness across the depth moves the boundary nearer, unless it is drawn for the solid.
        nearer = max(response.m / response.n, 1.0) ** 0.5
        nearer /= 1.0 if kind.chart.contracts else response.contraction.imag
        far = nearer * kind.truncation(target, margin)
        lean = response.n12 / response.n
        # Without friction nothing leans to a side, but every other of the higher moments needs no side.
        across = np.abs(body.ratio(g, _ACROSS)).max(axis=1)
        leaning = leaning + across + 0.5 * abs(lean) + _UPRIGHT * (kind.terms(target) > 1)
        of_edges = compliance * leaning / np.abs(1.0 + g * lean) + 1.8 * far
        if gauge.word == INTENSITIES:
            return np.asarray(innermost + far * of_edges)
        of_places = compliance * (0.3 + 1.9 / gauge.scale.min(axis=1)) / margin ** (1.0 / 6.0)
        # No interface is near an edge.
        beside = kind.unseen_beside(target, self._degree, plan.cuts) * (gauge.word != AT_INTERFACES)
        return np.asarray(innermost + beside + far * (of_edges + of_places))
