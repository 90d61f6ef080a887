"""Measured error of finite elements, and the degree that brings it within tolerance.

Solutions of rising degree at one speed form a ladder (:class:`Ladder`). The error is measured by gauges,
numbers of states with the sizes to which their changes are relative (:class:`Gauge`), and estimated from
their changes from level to level (:class:`MeasuredError`).
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.kind import DEGREES

from ..contact import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE, YIELD, stresses
from ..contact.edges import from_edge
from ..contact.estimate import AT_DEPTHS, SAFETY, SLOWER, SLOWEST, Rate, before, of_degrees, remaining
from ..contact.fem_plan import levels
from ..contact.pressure import Expansion
from ..contact.solution import Task
from .discretisation import Discretisation
from .displacement import Displacement
from .fields import Slopes
from .solution import SolvedStates
from .space import Space

#: Most points inside on which the error is measured; of more points so many are picked.
_POINTS = 400

#: Positions r under the punch at which the pressure's smooth factor is measured, both edges among them.
_ACROSS = np.cos(np.pi * np.arange(9) / 8.0)


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
    """

    word: str
    values: NDArray[np.float64]
    scale: NDArray[np.float64]
    unresolved: Any = 0.0

    def change(self, coarse: "Gauge") -> NDArray[np.float64]:
        """Largest relative difference of each state from the same gauge of another level, (states,)."""
        return np.max(np.abs(self.values - coarse.values) / self.scale, axis=1)


def of_pressure(pressure: Expansion, moments: NDArray, moved: float = 0.0) -> Gauge:
    """Gauge of K_I, the pressure all over the contact, and its moments 1 to 5 over the load.

    Args:
        pressure: of the states.
        moments: of it, (states, moments).
        moved: distance over a by which the edges of the contact seem off, on cells that no degree mends.
    """
    factor = pressure.series(_ACROSS)
    values, size = np.concatenate([factor, moments[:, 1:6]], axis=1), stresses.of_factor(factor)
    unresolved = pressure.unresolved + (pressure.moved_edges(_ACROSS, moved) / size).max(axis=1)
    return Gauge(
        INTENSITIES, values, np.concatenate([size, 2.0 + 0.0 * moments[:, 1:6]], axis=1), unresolved
    )


def of_inside(σ: NDArray, points: NDArray, word: str = BELOW) -> Gauge:
    """Gauge of stresses inside, (3, states, m), for the word that requests them."""
    size = stresses.of_inside(σ, *points.T)
    return Gauge(word, np.concatenate(list(σ), axis=1), np.tile(size, (1, 3)))


def of_interfaces(σ: NDArray) -> Gauge:
    """Gauge of stresses along interfaces, (4, states, interfaces, n)."""
    size = np.broadcast_to(stresses.of_interfaces(σ), σ.shape)
    values, of = (np.moveaxis(part, 1, 0).reshape(σ.shape[1], -1) for part in (σ, size))
    return Gauge(AT_INTERFACES, values, of)


#: Words of output.quantities that request stresses, in the order of their gauges.
_STRESSES = (ON_SURFACE, BELOW, YIELD, AT_INTERFACES)


class StressGauges:
    """Gauges of the requested stresses, by combinations of fields; derivatives are taken on making.

    Args:
        work: has the words of the requested stresses, as ``stresses``.
        task: the speed, and the places.
        displaced: makes the displacement at a task's places.
    """

    def __init__(self, work: Any, task: Task, displaced: Callable[[Task], Displacement]) -> None:
        self._words = [word for word in _STRESSES if word in work.stresses]
        self._task = gauged(task)
        self._displacement = displaced(self._task)
        self._displacement.prepare(self._words)

    def displacement(self, task: Task) -> Displacement | None:
        """Displacement at all places of the task; None where errors are measured at fewer places."""
        return self._displacement if self._task is task else None

    @property
    def slopes(self) -> Slopes:
        """Slopes of the fields on the surface."""
        return self._displacement.slopes

    def of(self, g: NDArray, weights: NDArray, σ_YY: NDArray) -> list[Gauge]:
        """Gauges of states, by weights (states, fields) and σ_YY on the surface, NaN beside the punch."""
        gauges, places = [], self._task.places
        if ON_SURFACE in self._words:
            σ_XX = self._displacement.surface(g, weights, σ_YY).σ_XX
            gauges.append(Gauge(ON_SURFACE, σ_XX, stresses.of_in_plane(σ_XX, places.X)))
        if BELOW in self._words:
            gauges.append(of_inside(self._displacement.inside(weights), places.points))
        if YIELD in self._words:
            gauges.append(of_inside(self._displacement.around(weights), places.around, YIELD))
        if AT_INTERFACES in self._words:
            gauges.append(of_interfaces(self._displacement.interfaces(weights)))
        return gauges

    def mirrored(
        self, sign: float, g: NDArray, weights: NDArray, σ_YY: NDArray, size: NDArray | None
    ) -> list[Gauge]:
        """Gauges of states, of their mirror images where the sign is negative.

        Points inside have no mirror image, those on the surface have: σ_XX there stands for both, no
        nearer to an edge than the points are.

        Args:
            sign: 1, or -1 for the mirror images.
            g, weights, σ_YY: as of :meth:`of`.
            size: sizes to which changes are relative, (states, n), of :meth:`size`.
        """
        if size is None:
            return []  # no derivative is taken that is not requested
        surface = self._displacement.surface(g, weights, σ_YY).σ_XX[:, :: int(sign)]
        kept = [(word, self._as_near(word)) for word in self._words]
        return [Gauge(word, surface[:, near], size[:, near]) for word, near in kept]

    def size(self, g: NDArray, weights: NDArray, σ_YY: NDArray) -> NDArray[np.float64] | None:
        """Sizes of σ_XX on the surface, (states, n), None where no stress is requested."""
        if not self._words:
            return None
        σ_XX = self._displacement.surface(g, weights, σ_YY).σ_XX
        return stresses.of_in_plane(σ_XX, self._task.places.X)

    def rounding(self, g: NDArray, weights: NDArray, σ_YY: NDArray) -> list[float]:
        """Effect of rounding of the fields on stresses, relative, by word.

        It is that on the surface, no nearer to an edge than the word's points are.
        """
        size = self.size(g, weights, σ_YY)
        if size is None:
            return []
        noise = self._displacement.rounding(weights) / size
        solved = _SOLVED / self._task.response.margin**0.5
        return [solved * float(noise[:, self._as_near(word)].max()) for word in self._words]

    def _as_near(self, word: str) -> NDArray[np.bool_]:
        """Mask of the places on the surface no nearer to an edge than the places of a word, (n,)."""
        places = self._task.places
        X, Y = places.X, np.zeros(1)
        if word in (BELOW, YIELD):
            X, Y = (places.points if word == BELOW else places.around).T
        elif word == AT_INTERFACES:
            X, Y = places.along, places.interfaces[:, None]
        on_surface = from_edge(places.X)
        nearest = np.hypot(from_edge(X), Y).min(initial=np.inf)
        return np.asarray(on_surface >= min(nearest, on_surface.max()))


def gauged(task: Task) -> Task:
    """Task at fewer points inside, picked at all distances from the edges, from nearest to farthest."""
    points, around = (_picked(all_) for all_ in (task.places.points, task.places.around))
    if points is task.places.points and around is task.places.around:
        return task
    return replace(task, places=replace(task.places, points=points, around=around))


def _picked(points: NDArray) -> NDArray[np.float64]:
    if len(points) <= _POINTS:
        return points
    X, Y = points.T
    order = np.argsort(np.hypot(np.abs(X) - 1.0, Y), kind="stable")
    picked = order[np.unique(np.linspace(0, len(order) - 1, _POINTS).astype(int))]
    return points[np.sort(picked)]


#: Levels that are held in memory: two differences measure the error.
_HELD = 3


class Level:
    """Solution at one degree; its gauges can be evaluated after its release.

    Args:
        work: has the plan and the words of the requested stresses.
        task: the speed.
        space: space of the degree.
        g: all values of σ_XY/σ_YY that will be solved.

    Attributes:
        factor: of the linear system, with numbers of its work.
        mirrored: True where :meth:`rounding` is that of mirror images, not only a bound on rounding.
    """

    factor: Any
    mirrored: bool

    def __init__(self, work: Discretisation, task: Task, space: Space, g: NDArray) -> None:
        self.work, self.task, self.space, self.g = work, task, space, g

    def displacement_at(self, task: Task) -> Displacement:
        """Displacement, for stresses at the places of a task."""
        raise NotImplementedError

    def measured_task(self, task: Task) -> Task:
        """Task with the places at which stresses are measured."""
        return task

    @cached_property
    def stress_gauges(self) -> StressGauges:
        """Gauges of the requested stresses; derivatives are taken when they are made."""
        return StressGauges(self.work, self.measured_task(self.task), self.displacement_at)

    @cached_property
    def displacement(self) -> Displacement:
        """Displacement, for stresses at all places."""
        return self.stress_gauges.displacement(self.task) or self.displacement_at(self.task)

    def states(self, g: NDArray, load: Any = None) -> SolvedStates:
        """States with values g of σ_XY/σ_YY, (states,), under the task's load or others [N/m].

        Raises:
            SolveError: no contact carries the load.
        """
        raise NotImplementedError

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        """Gauges of states with values g of σ_XY/σ_YY.

        Args:
            g: σ_XY/σ_YY, (states,).
            load: load of each state [N/m], (states,); the task's if None.
        """
        return self.gauges(self.states(g, load))

    def gauges(self, states: SolvedStates) -> list[Gauge]:
        """Gauges of the requested stresses of states."""
        return self.stress_gauges.of(*self.fields_of(states)) if self.work.stresses else []

    def fields_of(self, states: SolvedStates) -> tuple[NDArray, NDArray, NDArray]:
        """Frictions, field weights, and σ_YY over N/(2a) where stresses are measured, of states."""
        X = self.measured_task(self.task).places.X
        return states.contact.g, states.contact.weights, states.pressure.σ_YY(X)

    def rounding(self, g: NDArray, load: Any = None) -> list[float]:
        """Effect of rounding alone on each gauge, relative; arguments as of :meth:`measured`."""
        raise NotImplementedError

    def release(self) -> None:
        """Free factor and fields."""
        raise NotImplementedError

    def destroy(self) -> None:
        """Free everything."""
        self.release()


class Ladder:
    """Solutions of rising degree, or on meshes cut more and more finely, at one speed.

    Args:
        work: gives spaces.
        task: the speed.
        solved: solves on a space for all values of g.
        degree: degree to begin with; the plan's if None.

    Attributes:
        degree: degree of the last level.
        levels: the last levels.
        changes: largest relative change of the gauges from the degree before, by degree and by word of
            output.quantities.
    """

    def __init__(
        self, work: Discretisation, task: Task, solved: Callable[[Space, NDArray], Any],
        degree: int | None = None,
    ) -> None:  # fmt: skip
        self.work, self.task = work, task
        self.degree = degree or work.plan.degrees[task.number]
        self.levels: list[Any] = []
        self.changes: dict[int, dict[str, float]] = {}
        self._solved = solved
        self._work = WorkDone()

    def add(self, g: NDArray, degree: int, cuts: int = 1) -> None:
        """Solve at a degree for all values of g; the previous factor is freed first."""
        for level in self.levels[-1:]:
            level.release()
        self.levels.append(self._solved(self.work.space(degree, cuts), g))
        self.degree = degree
        if len(self.levels) > _HELD:
            old = self.levels.pop(0)
            self._work.count(old)
            old.destroy()

    def record(self) -> dict[str, Any]:
        """Numbers of the work on all levels, and the size of the last."""
        space = self.levels[-1].space
        return {"cells": space.cells, "unknowns": space.size, "degree": space.degree} | vars(self.done)

    @property
    def done(self) -> "WorkDone":
        """Numbers of the work on all levels."""
        total = WorkDone(**vars(self._work))
        for level in self.levels:
            total.count(level)
        return total

    def destroy(self) -> None:
        for level in self.levels:
            level.destroy()


@dataclass
class WorkDone:
    """Numbers of linear algebra, as they are archived."""

    factorisations: int = 0
    back_substitutions: int = 0
    iterations: int = 0
    largest_residual: float = 0.0
    largest_condition: float = 0.0

    def count(self, level: Any) -> None:
        """Count the work of a level by its factor."""
        factor = level.factor
        self.add(WorkDone(1, factor.solves, factor.iterations, factor.largest_residual, factor.condition))

    def add(self, other: "WorkDone") -> None:
        """Add other work."""
        self.factorisations += other.factorisations
        self.back_substitutions += other.back_substitutions
        self.iterations = max(self.iterations, other.iterations)
        self.largest_residual = max(self.largest_residual, other.largest_residual)
        self.largest_condition = max(self.largest_condition, other.largest_condition)


#: Effect of rounding, over its part that breaks the mirror image.
ROUNDING = 3.0

#: Effect of higher moments without friction, over that at σ_XY = σ_YY.
_UPRIGHT = 0.1

#: States, spread over all of a speed, whose measured error decides the degree.
PROBES = 9


#: Degrees over which the decay of changes is measured; a ladder ends early where the error extrapolated
#: to the highest degree exceeds the tolerance by this factor.
_DECAY, _DOUBT = 2, 3.0

#: Share of a part of the error at the degree before from which on it is the same at all degrees.
_LASTS = 0.7

#: Share of a bound on rounding that rounding takes at least, see ``_SOLVED``.
_CERTAIN = 0.2


@contextmanager
def climbed(
    work: Discretisation, task: Task, g: NDArray, solved: Callable[[Space, NDArray], Any],
    degree: int | None = None, share: float = 1.0,
) -> Iterator[tuple[Ladder, "MeasuredError"]]:  # fmt: skip
    """Ladder whose degree was raised until the measured error is within tolerance; it is freed at exit.

    Args:
        work, task, solved, degree: as of :class:`Ladder`.
        g: the speed's values of σ_XY/σ_YY, sorted.
        share: share of the tolerance that the error may take.
    """
    ladder = Ladder(work, task, solved, degree)
    try:
        yield ladder, climb(ladder, g, share)
    finally:
        ladder.destroy()


@contextmanager
def solved_to_tolerance(
    work: Any, task: Task, g: NDArray, solved: Callable[[Space, NDArray], Any]
) -> Iterator[tuple[Ladder, "MeasuredError"]]:
    """Ladder as of :func:`climbed`, on finer cells where no degree reaches the tolerance on the plan's.

    Args:
        work, task, solved: as of :class:`Ladder`; ``work.finer`` has the finer cells.
        g: the speed's values of σ_XY/σ_YY, sorted.
    """
    tolerance = work.plan.tolerance
    with climbed(work, task, g, solved) as (ladder, error):
        if not error.of_cells:
            yield ladder, error.warned()
            return
    with climbed(work.finer, task, g, solved, None, tolerance / work.finer.plan.tolerance) as finer:
        ladder, error = finer
        yield ladder, error.warned()


def climb(ladder: Ladder, g: NDArray, share: float = 1.0) -> "MeasuredError":
    """Raise the degree until the measured error of sample states is within tolerance, or hardly falls.

    Args:
        ladder: ladder without a level.
        g: the speed's values of σ_XY/σ_YY, sorted.
        share: share of the tolerance that the error may take.
    """
    plan = ladder.work.plan
    for degree, cuts in levels(ladder.degree, plan.cuts, plan.fixed):
        ladder.add(g, degree, cuts)
    probes = g[np.unique(np.linspace(0, len(g) - 1, PROBES).astype(int))]
    probes, loads = ladder.task.probes(probes)
    error = MeasuredError(ladder, probes, loads, share)
    changes = dict(error.changes)
    while not plan.fixed and ladder.degree < DEGREES[1] and error.of_degree:
        if _stalls(changes, ladder.degree, share * plan.tolerance):
            break
        ladder.add(g, ladder.degree + 1)
        error = MeasuredError(ladder, probes, loads, share)
        changes |= error.changes
    error.changes = changes
    return error


def _stalls(changes: dict[int, float], degree: int, tolerance: float) -> bool:
    """True where changes fall so slowly that the highest degree would not reach the tolerance either."""
    before, last = changes.get(degree - _DECAY, 0.0), changes[degree]
    ρ = (last / before) ** (1.0 / _DECAY) if before else 0.0
    if ρ >= 1.0:
        return True
    at_last = last * ρ ** (DEGREES[1] - degree)
    return SAFETY * at_last * ρ / (1.0 - ρ) > _DOUBT * tolerance


class MeasuredError:
    """Error of a ladder's last level, estimated from changes from level to level.

    Args:
        ladder: with three levels of rising degree; or with a better one than the last, of a fixed degree.
        probes: values of σ_XY/σ_YY that stand for all of the speed, (probes,).
        loads: load of each probe [N/m]; the task's if None.
        share: share of the tolerance that the error may take.

    Attributes:
        changes: largest change of the probes from the degree before, by degree; none at a fixed degree.
        excessive: True where an error exceeds the tolerance, and most of it is not of the outer radius.
        of_degree: True where, besides, most of it, or enough for the tolerance, is not of what lasts at
            any degree, see :meth:`_lasting`.
        floor: least error that finer cells would leave, of the probes.
        of_cells: True where, besides, most of it does not last on finer cells either, and the floor is
            within tolerance.
        worst: largest relative error of the probes.
    """

    def __init__(
        self, ladder: Ladder, probes: NDArray, loads: NDArray | None = None, share: float = 1.0
    ) -> None:
        self._ladder = ladder
        gauges = [level.measured(probes, loads) for level in ladder.levels]
        self._sample = _changes(gauges)
        self._rounding = dict(zip(self._sample, ladder.levels[-1].rounding(probes, loads)))
        self._bounds = dict(self._rounding)
        if not ladder.levels[-1].mirrored:
            # Intensities at both ends differ by what the degree leaves, too; residuals of a solve do not.
            of_solve = ladder.levels[-1].factor.largest_residual
            if INTENSITIES in self._bounds:
                self._bounds[INTENSITIES] = min(self._bounds[INTENSITIES], of_solve)
            # Only what rounding might do is known there; what it does is in the last change, once.
            for word, changes in self._sample.items():
                shown = float(changes[-1].max()) / ROUNDING
                self._rounding[word] = min(self._rounding[word], shown)
        self.changes: dict[int, float] = {}
        if not ladder.work.plan.fixed:
            for i, degree in enumerate((ladder.degree - 1, ladder.degree)):
                by_word = {word: float(pair[i].max()) for word, pair in self._sample.items()}
                ladder.changes[degree] = by_word
                self.changes[degree] = max(by_word.values(), default=0.0)
        tolerance, unseen = share * ladder.work.plan.tolerance, self._unseen(gauges[-1], probes)
        # Where the outer radius alone spoils the tolerance, the cells need not do better than it.
        errors = self._errors(gauges, probes)
        wrong = {
            name: error > np.maximum(tolerance, 1.1 * unseen[name]) for name, error in errors.items()
        }
        self.excessive = any(bool(states.any()) for states in wrong.values())
        lasting = self._lasting(gauges, unseen, errors)
        mended = any(
            bool((states & (2.0 * lasting[name] < errors[name])).any()) for name, states in wrong.items()
        )
        self.floor = self._floor(gauges)
        self.of_cells = not ladder.work.plan.fixed and mended and self.floor <= tolerance
        self.of_degree = mended or any(
            bool((states & (lasting[name] <= tolerance)).any()) for name, states in wrong.items()
        )
        self.worst = max((float(error.max()) for error in errors.values()), default=0.0)
        self._tolerance = tolerance

    def warned(self) -> "MeasuredError":
        """This error, after a warning where the tolerance is not reached."""
        ladder = self._ladder
        if self.excessive and not ladder.work.plan.fixed:
            rest = "and falls too slowly"
            if self.floor > self._tolerance:
                rest = f"of which {self.floor:.1e} would remain on any cells"
            ladder.work.warn(
                f"finite elements at c = {ladder.task.response.c:g} do not reach the tolerance "
                f"{self._tolerance:.2g}: the estimated error is {self.worst:.1e} at degree "
                f"{ladder.degree}, {rest}"
            )
        return self

    def record(self) -> dict[str, list[float]]:
        """Changes by degree, as they are archived."""
        changes = np.zeros(DEGREES[1] + 1)
        for degree, change in self.changes.items():
            changes[degree] = change
        return {"change_by_degree": changes.tolist() if changes.any() else []}

    def of(
        self, g: NDArray, load: Any = None, last: Callable[[], list[Gauge]] | None = None
    ) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by word of output.quantities.

        Args:
            g: σ_XY/σ_YY, (states,).
            load: load of each state [N/m], (states,); the task's if None.
            last: gives the gauges of these states on the last level, where they have been solved.
        """
        *coarser, finest = self._ladder.levels
        gauges = [level.measured(g, load) for level in coarser]
        return self._errors([*gauges, last() if last else finest.measured(g, load)], g)

    def _errors(self, gauges: list[list[Gauge]], g: NDArray) -> dict[str, NDArray[np.float64]]:
        unseen = self._unseen(gauges[-1], g)
        own = {gauge.word: gauge.unresolved for gauge in gauges[-1]}
        return {
            word: self._of_levels(word, changes)
            + unseen[word]
            + own[word]
            + ROUNDING * self._rounding[word]
            for word, changes in _changes(gauges).items()
        }

    def _lasting(
        self, gauges: list[list[Gauge]], unseen: dict[str, NDArray], errors: dict[str, NDArray]
    ) -> dict[str, NDArray[np.float64]]:
        """Parts of errors that remain at any degree and on finer cells, (states,), by word.

        These are the effect of the outer radius, rounding, and what a level shows by itself where the
        degree before showed hardly more. Changes that a bound on rounding explains, and that are no
        smaller than those of the degree before, are rounding, and all of the error is.
        """
        lasting, own = {}, self._own(gauges)
        for word in errors:
            rounding = min(self._rounding[word], self._bounds[word])
            lasting[word] = ROUNDING * rounding + unseen[word] + own[word]
            # One change as large as the last may be luck: that of two degrees before counts, too.
            *earlier, change = (float(changes.max()) for changes in self._sample[word])
            earlier.append(self._ladder.changes.get(self._ladder.degree - _DECAY, {}).get(word, np.inf))
            if _LASTS * max(earlier) <= change <= ROUNDING * self._bounds[word]:
                lasting[word] = np.maximum(lasting[word], errors[word])
        return lasting

    def _own(self, gauges: list[list[Gauge]]) -> dict[str, Any]:
        """Errors that a level shows by itself where the level before showed hardly more, by word.

        Over layers these may fall later: with the degree more functions recover the pressure.
        """
        if self._ladder.task.body.layered:
            return {last.word: 0.0 for last in gauges[-1]}
        return {
            last.word: np.where(last.unresolved > _LASTS * earlier.unresolved, last.unresolved, 0.0)
            for earlier, last in zip(*gauges[-2:])
        }

    def _floor(self, gauges: list[list[Gauge]]) -> float:
        """Rounding that is certain, and what levels show by themselves; largest of all words."""
        certain = 1.0 if self._ladder.levels[-1].mirrored else _CERTAIN
        return max(
            (
                float(np.max(ROUNDING * certain * self._bounds[word] + own))
                for word, own in self._own(gauges).items()
            ),
            default=0.0,
        )

    def _of_levels(self, word: str, changes: list[NDArray]) -> NDArray[np.float64]:
        """Estimated relative errors by changes from level to level, (states,)."""
        rate = self._rate(word)
        if self._ladder.work.plan.fixed:
            return before(changes[0], rate)
        first, second = changes
        return remaining(first, second, self._sample[word], rate, self._rounding[word])

    def _rate(self, word: str) -> Rate:
        """Usual rate of convergence, or a slower one by the decay over two degrees; one may be luck."""
        rate, changes, degree = self._usual(word), self._ladder.changes, self._ladder.degree
        earlier = changes.get(degree - _DECAY, {}).get(word)
        if not earlier:
            return rate
        ρ = min((changes[degree][word] / earlier) ** (1.0 / _DECAY), SLOWEST)
        return Rate(max(ρ, rate.usual), max(ρ, rate.believed), rate.least)

    def _usual(self, word: str) -> Rate:
        if word == AT_INTERFACES:
            return AT_DEPTHS
        if word != INTENSITIES:
            return of_degrees(1)
        # What a thin layer adds converges unevenly: a small change says less there.
        return SLOWER if self._ladder.task.body.layered else of_degrees(2)

    def _unseen(self, gauges: list[Gauge], g: NDArray) -> dict[str, NDArray[np.float64]]:
        """Estimated errors common to all levels, of outer radius and innermost cells, (states,)."""
        plan, response = self._ladder.work.plan, self._ladder.task.response
        kind, target, margin = plan.kind, plan.wanted, response.margin
        innermost = kind.unseen(target, self._ladder.degree, plan.cuts, margin)
        # Measured at far boundaries of 100 a, 1e3 a and 1e4 a; see docs/verification.md. n times the
        # margin is about the surface's compliance at rest, 1/10 to 10 for the solids that were tried.
        compliance = 2.0 + 0.55 * max(float(np.log(4.0 * response.n * margin)), -1.0)
        # Stiffness across the depth moves the boundary nearer, unless it is drawn for the solid.
        nearer = max(response.m / response.n, 1.0) ** 0.5
        nearer /= 1.0 if kind.chart.contracts else response.contraction.imag
        far = nearer * kind.truncation(target, margin)
        lean = response.n12 / response.n
        # Without friction nothing leans to a side, but every other of the higher moments needs no side.
        leaning = (
            np.abs(self._ladder.task.body.ratio(g, _ACROSS)).max(axis=1)
            + 0.5 * abs(lean)
            + _UPRIGHT * (kind.terms(target) > 1)
        )
        of_edges = compliance * leaning / np.abs(1.0 + g * lean) + 1.8 * far
        errors = {}
        for gauge in gauges:
            if gauge.word == INTENSITIES:
                errors[gauge.word] = innermost + far * of_edges
            else:
                of_places = compliance * (0.3 + 1.9 / gauge.scale.min(axis=1)) / margin ** (1.0 / 6.0)
                # No interface is near an edge.
                beside = kind.unseen_beside(target, self._ladder.degree, plan.cuts)
                beside *= gauge.word != AT_INTERFACES
                errors[gauge.word] = innermost + beside + far * (of_edges + of_places)
        return errors


def _changes(levels: list[list[Gauge]]) -> dict[str, list[NDArray[np.float64]]]:
    """Largest changes of each state, (states,), from each level to the next, by word."""
    return {
        gauges[0].word: [late.change(early) for early, late in pairwise(gauges)]
        for gauges in zip(*levels)
    }
