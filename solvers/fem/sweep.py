"""Sweeps of many speeds for the price of a dozen: a rational fit through solved speeds gives the others.

The fit is of the parts of a punch at a few frictions: nodal forces, slopes, displacements, from which its
states of all frictions and loads follow. A single rational function serves all of these numbers
(:class:`Fit`). The next speed is solved far from those before, or where the fit changed most, and is
predicted by the fit first: the error of that prediction, and the change of the fit all over the sweep,
are the error of the fit. A fitted speed has that error and the error of the discretisation
(:class:`FitError`).
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from ..approximation import Rational, chebyshev_nodes, fit_rational, leja, polynomial_weights, rotated
from ..contact import AT_INTERFACES, BELOW, YIELD
from ..contact.edges import EdgeExponents
from ..contact.fem_plan import LADDERS, MOST, Sweep, levels
from ..contact.solution import Task
from ..errors import SolveError
from .contact import AtSpeed, PunchLevel
from .discretisation import Discretisation
from .ladder import PROBES, Gauge, WorkDone, climbed
from .punch import FittedPunch, Frictions, Sampled, sampled, together
from .space import Space

#: Sum of absolute shares from which a fit is rejected: a pole is near.
_LARGEST = 1e4

#: Rounding in the numbers of a sample, relative to their largest.
_NOISE = 3e-9


@dataclass
class Fit:
    """A fit through the speeds that have been solved so far.

    Attributes:
        work: gives spaces.
        tasks: all speeds, in the order of the plan.
        sweep: the plan's sweep.
        space: space of the last degree.
        at: frictions at which punches are sampled.
        recovery: maps from nodal forces to pressure.
        solved: numbers of the speeds, in the order in which they were solved.
        samples: samples of these speeds, without the singular factors of the edges.
        records: numbers of the work, by a speed's number.
        rational: rational function through the samples; None for fewer than three.
    """

    work: Discretisation
    tasks: list[Task]
    sweep: Sweep
    space: Space
    at: Frictions
    recovery: Any
    solved: list[int] = field(default_factory=list)
    samples: list[Sampled] = field(default_factory=list)
    records: dict[int, dict[str, Any]] = field(default_factory=dict)
    rational: Rational | None = None

    def singular(self, task: Task) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Singular factors of the edges: powers of the distance with exponents of the local analysis.

        Returns:
            Factors of nodal forces, (frictions, nodes), and of slopes, (frictions, places).
        """
        s, places = self.space.contact.s, task.places.X
        d_left, d_right, _ = self.space.chart.under_punch(s - s[0], s[-1] - s)
        # At the edge itself the force is that of a piece of half the innermost distance or so.
        d_left, d_right = np.maximum(d_left, d_left[1] / 2.0), np.maximum(d_right, d_right[-2] / 2.0)
        local = EdgeExponents(task.response, self.at.g)

        def power(from_left: NDArray, from_right: NDArray) -> NDArray[np.float64]:
            logs = np.outer(local.α, np.log(from_right)) + np.outer(local.β, np.log(from_left))
            return np.asarray(np.exp(logs))

        slopes = power(np.abs(1.0 + places), np.abs(1.0 - places))
        return power(d_left, d_right), slopes if self.work.stresses else slopes[:, :0]

    def sampled(self, task: Task, level: Any) -> Sampled:
        """Sample of a solved speed for the fit, without the singular factors of the edges."""
        fields = bool({BELOW, YIELD, AT_INTERFACES} & self.work.stresses)
        sample = sampled(level.punch, self.at, level.slopes, fields)
        forces, slopes = self.singular(task)
        return sample.scaled(1.0 / forces, 1.0 / slopes)

    def take(self, solved: Sequence[tuple[int, Sampled, dict[str, Any]]]) -> None:
        """Take in speeds that were solved: number, sample and record of each."""
        for number, sample, record in solved:
            self.samples.append(sample)
            self.solved.append(number)
            self.records[number] = record
        if len(self.samples) > 2:
            self.rational = self._rational()

    def _rational(self) -> Rational:
        """Rational function without poles among the speeds, else the polynomial."""
        z = self.sweep.z[self.solved]
        rational = fit_rational(z, self.values, _NOISE)
        if np.abs(rational.shares(self.sweep.z)).sum(axis=1).max() < _LARGEST:
            return rational
        return Rational(z, polynomial_weights(z))

    @property
    def values(self) -> NDArray[np.float64]:
        """All numbers of the samples, each kind relative to its largest, (samples, numbers)."""
        blocks = []
        for kinds in zip(*(sample.numbers() for sample in self.samples)):
            values = np.array(kinds)
            size = np.abs(values).max(initial=0.0)
            if size > 0.0:
                blocks.append(values / (size * values.shape[1] ** 0.5))
        return np.concatenate(blocks, axis=1)

    def shares(self, number: int) -> NDArray[np.float64]:
        """Shares of the samples in a speed, (samples,)."""
        if number in self.solved:
            return np.eye(len(self.solved))[self.solved.index(number)]
        assert self.rational
        return self.rational.shares(self.sweep.z[[number]])[0]

    @contextmanager
    def level(self, task: Task, shares: NDArray | None = None) -> Iterator[Any]:
        """Level of a speed by the fit, or by other shares of the samples, (samples,)."""
        shares = self.shares(task.number) if shares is None else shares
        combined = together(self.samples, shares).scaled(*self.singular(task))
        punch = FittedPunch(self.space, task.response, self.at, combined)
        try:
            yield PunchLevel(self.work, task, self.space, self.at.g, punch, self.recovery)
        finally:
            punch.destroy()

    def record(self, number: int) -> dict[str, Any]:
        """Numbers of the work at a speed; none was done where it is fitted."""
        space = self.space
        size = {"cells": space.cells, "unknowns": space.size, "degree": space.degree}
        return self.records.get(number) or size | vars(WorkDone())


def largest_changes(gauges: Sequence[Gauge], others: Sequence[Gauge]) -> dict[str, float]:
    """Largest relative difference of two lists of gauges, by word of output.quantities."""
    return {gauge.word: float(gauge.change(other).max()) for gauge, other in zip(gauges, others)}


class Estimates:
    """Estimated errors of the discretisation at the speeds and frictions where they were measured.

    Args:
        g: the frictions, rising, (frictions,).

    Attributes:
        numbers: numbers of the speeds.
    """

    def __init__(self, g: NDArray) -> None:
        self._g, self.numbers = g, list[int]()
        self._z: list[float] = []
        self._errors: dict[str, list[NDArray]] = {}

    def add(self, number: int, z: float, errors: dict[str, NDArray]) -> None:
        """Add the errors at a speed.

        Args:
            number: number of the speed.
            z: the speed in the variable of the fit.
            errors: relative errors by word, (loads × frictions,), load by load.
        """
        self.numbers.append(number)
        self._z.append(z)
        for word, values in errors.items():
            of_loads = values.reshape(-1, len(self._g)).max(axis=0)
            self._errors.setdefault(word, []).append(of_loads)

    def least(self, word: str) -> float:
        """Smallest error of a word."""
        return float(np.min(self._errors[word]))

    def covers(self, z: float) -> bool:
        """True where errors were measured at z, or on both sides of it."""
        return min(self._z) <= z <= max(self._z)

    def beyond(self, tolerance: float) -> bool:
        """True where all errors of a word exceed the tolerance: then no speed can be fitted to it."""
        return any(self.least(word) > tolerance for word in self._errors)

    def around(self, z: float, g: NDArray) -> dict[str, NDArray[np.float64]]:
        """Largest errors around a speed z and frictions g, (len(g),), by word.

        They are taken over the solved speeds and the frictions on both sides, lest an error that falls
        from one side to the other be underestimated.
        """
        order = np.argsort(self._z, kind="stable")
        places = np.array(self._z)[order]
        beside = order[_around(places, np.array([z]))[0]]
        frictions = _around(self._g, g)
        return {
            word: np.array(errors)[beside][:, frictions].max(axis=(0, 2))
            for word, errors in self._errors.items()
        }


def _around(places: NDArray, x: NDArray) -> NDArray[np.int64]:
    """Indices of the places on both sides of each x, equal where x is a place, (len(x), 2)."""
    last = len(places) - 1
    above = np.clip(np.searchsorted(places, x), 0, last)
    below = np.where(places[above] > x, above - 1, above)
    return np.column_stack([np.clip(below, 0, last), above])


class FitError:
    """Estimated errors at a fitted speed, in the place of :class:`.error.MeasuredError`.

    Args:
        estimates: errors of the discretisation.
        z: the speed in the variable of the fit.
        fit: error of the fit, by word of output.quantities; empty where the speed was solved.
    """

    def __init__(self, estimates: Estimates, z: float, fit: dict[str, float]) -> None:
        self._estimates, self._z, self._fit = estimates, z, fit

    def of(self, g: NDArray, load: Any = None, last: Any = None) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by word of output.quantities."""
        around = self._estimates.around(self._z, g)
        return {word: values + self._fit.get(word, 0.0) for word, values in around.items()}


#: Share of the tolerance that the discretisation may take, and share of the larger of the tolerance and
#: that error that the fit may take: together they stay below the tolerance.
DISCRETISATION, FIT = 0.88, 0.1

#: Speeds that are solved before the fit is judged again: a speed for each of two ranks. Any number of
#: ranks solves the same speeds.
AT_ONCE = 2

#: Numbers of frictions that are tried until the interpolation between them is so accurate, relative:
#: forces have to balance to 1e-9, and at free ends terms cancel that are much larger than their sum.
_FRICTIONS, _BETWEEN = (8, 12, 16, 20, 26, 34, 44, 60), 3e-12


#: Share of the cost of solving every speed that may be lost where no fit becomes good enough.
_REGRET = 0.08

#: Speeds, at both ends of the sweep, at which the discretisation's error is measured in any case.
_ENDS = 2


class HigherDegree(Exception):
    """A speed needs a higher degree than the speeds before were solved with."""


@dataclass(frozen=True)
class Trained:
    """Fit through solved speeds, and its error.

    Attributes:
        fit: fit through the solved speeds.
        estimates: errors of the discretisation at the speeds where they were measured.
        error: error of the fit, by word of output.quantities; None where it is not good enough and serves
            the solved speeds alone.
    """

    fit: Fit
    estimates: Estimates
    error: dict[str, float] | None

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Any]:
        """Punches at a speed; None where they have to be solved.

        They have to be where the estimated error exceeds the tolerance: solved alone it may be smaller.
        """
        number, fit = task.number, self.fit
        fitted, z = number not in fit.solved, float(fit.sweep.z[number])
        if self.error is None and (fitted or not self.estimates.covers(z)):
            yield None
            return
        error = FitError(self.estimates, z, self.error if fitted and self.error else {})
        worst = max((values.max() for values in error.of(g).values()), default=0.0)
        if worst > fit.work.plan.tolerance:
            yield None
            return
        with fit.level(task) as level:
            yield AtSpeed(level, error, lambda: fit.record(number), fitted)


def train(work: Discretisation, tasks: list[Task], say: Callable[[str], None]) -> Trained | None:
    """Solve speeds until a fit through them gives the others to the tolerance.

    Where that may cost too much in vain, the fit serves the solved speeds alone; None for no fit.

    Args:
        work: gives spaces.
        tasks: all speeds.
        say: shows the work under way.
    """
    assert work.plan.sweep
    degree: int | None = None
    lost = 0.0
    while True:
        training = _Training(work, tasks, work.plan.sweep, say, degree, lost)
        try:
            return training.done()
        except HigherDegree as higher:
            degree, lost = higher.args[0], training.spent
            if lost > training.allowed:
                return training.given_up()
        except SolveError as error:  # each speed by itself tells which, and why
            say(f"no fit through speeds: {error}")
            return None


@dataclass(frozen=True)
class _Solved:
    """Solved speed.

    Attributes:
        number: number of the speed.
        degree: degree of its elements.
        sample: sample for the fit; None of a higher degree than the fit's.
        record: numbers of the work.
        estimates: errors of the discretisation, by word, where they were measured.
        off: error of the previous fit at this speed, by word, where it predicted the speed.
    """

    number: int
    degree: int
    sample: Sampled | None
    record: dict[str, Any]
    estimates: dict[str, NDArray] | None = None
    off: dict[str, float] | None = None


def _cost(degree: int) -> float:
    """Cost of a factorisation and all that goes with it, in arbitrary units."""
    return float(degree**4)


def _cost_of_ladder(degree: int) -> float:
    return sum(_cost(p) for p, _ in levels(degree, 1, fixed=False))


class _Training:
    """Training of a fit; see :func:`train`.

    Costs are counted in factorisations, which go with the fourth power of the degree or so.

    Args:
        work, tasks, say: as of :func:`train`.
        sweep: the plan's sweep.
        degree: degree to begin with; the plan's if None.
        lost: cost of the speeds that were solved before, in vain.

    Attributes:
        spent: cost of all solved speeds.
        allowed: cost that may be lost.
    """

    def __init__(
        self, work: Discretisation, tasks: list[Task], sweep: Sweep,
        say: Callable[[str], None], degree: int | None, lost: float = 0.0,
    ) -> None:  # fmt: skip
        self.spent = lost
        self._alone = [_cost_of_ladder(degree) for degree in work.plan.degrees]
        self._lost, self.allowed = lost, _REGRET * sum(self._alone)
        self._work, self._tasks, self._sweep = work, tasks, sweep
        self._say, self._degree = say, degree
        probes = sweep.g if sweep.few else np.linspace(sweep.g[0], sweep.g[-1], PROBES)
        self._probes, self._loads = tasks[0].probes(probes)
        self._estimates = Estimates(np.unique(probes))
        self._fit: Fit | None = None

    def done(self) -> Trained | None:
        """Train the fit; it serves the solved speeds alone where it does not become good enough."""
        tasks = self._tasks
        # The fastest needs the highest degree: it is solved first, by every rank for itself.
        chosen = [int(np.argmin([task.response.margin for task in tasks]))]
        self._take([self._measured(chosen[0])])
        self.spent += self._cost(True)  # it would be solved just so by itself
        number: int | None = None
        while len(chosen) < min(MOST, len(tasks) // 2):
            numbers = self._next(chosen, number)
            if not numbers:
                break  # there is no other speed, or it would cost too much
            before, error = self._solved(numbers)
            chosen += numbers
            if len(self._estimates.numbers) > 1 and self._estimates.beyond(self._work.plan.tolerance):
                break
            number = None
            if error and self._good(error):
                assert before
                changes = {worst: self._change(before, worst) for worst in self._worst(before)}
                error = {
                    word: max(errors[word] for errors in (error, *changes.values())) for word in error
                }
                if self._good(error) and self._good(error := self._seconded(error, chosen)):
                    assert self._fit
                    return Trained(self._fit, self._estimates, error)
                number = max(changes, key=lambda worst: self._excess(changes[worst]))
        return self.given_up()

    def _seconded(self, error: dict[str, float], chosen: list[int]) -> dict[str, float]:
        """Error of a good fit, after the discretisation's error was measured at more speeds.

        That measurement is put off until the fit is good, lest it be in vain.
        """
        while (missing := LADDERS - len(self._estimates.numbers)) > 0:
            more = self._far([], chosen)[:missing]
            if not more:
                break
            _, off = self._solved(dict.fromkeys(more, True))
            chosen += more
            error = {word: max(value, off.get(word, 0.0)) for word, value in error.items()}
        return error

    def given_up(self) -> Trained | None:
        """Fit that serves the solved speeds alone; None where no speed was solved."""
        self._say("no fit through speeds is good enough at its cost: each is solved")
        return Trained(self._fit, self._estimates, None) if self._fit else None

    def _next(self, chosen: list[int], number: int | None) -> dict[int, bool]:
        """Numbers of the speeds to solve next: ``number``, and speeds far from all solved ones.

        Each maps to True where its error is to be measured: at the ends of the sweep, and elsewhere as
        far as the cost may be in vain. Speeds that would cost too much are left out.
        """
        numbers = self._far([] if number is None else [number], chosen)
        lost, kept = self._lost, dict[int, bool]()
        for number in numbers:
            measured = len(self._estimates.numbers) + sum(kept.values())
            for measures in (True, False):
                more = self._cost(measures) - self._alone[number]
                allowed = measured < LADDERS if measures else measured >= _ENDS
                if allowed and lost + more <= self.allowed:
                    lost += more
                    kept[number] = measures
                    break
        return kept

    def _far(self, numbers: list[int], chosen: list[int]) -> list[int]:
        """Numbers of as many speeds as are solved at once: the given ones, and others far from all."""
        while len(numbers) < AT_ONCE:
            number = leja(self._sweep.z, chosen + numbers)
            if number is None:
                break
            numbers = [*numbers, number]
        return numbers

    def _cost(self, measures: bool) -> float:
        """Cost of a speed at the fit's degree, with or without the measurement of its error."""
        assert self._degree
        return _cost_of_ladder(self._degree) if measures else _cost(self._degree)

    def _solved(self, numbers: dict[int, bool]) -> tuple[Rational | None, dict[str, float]]:
        """Solve speeds, shared out over the ranks, and take them in.

        Args:
            numbers: numbers of the speeds; True where the error is to be measured.

        Returns:
            The previous fit; its largest error at these speeds, by word, empty where there was no fit.
        """
        for number, measures in numbers.items():
            cost = self._cost(measures)
            self.spent, self._lost = self.spent + cost, self._lost + cost - self._alone[number]

        def solve(number: int) -> _Solved:
            return self._measured(number) if numbers[number] else self._checked(number)

        before = self._fit.rational if self._fit else None
        speeds = by_turns(list(numbers), solve, not self._work.plan.shared_speeds)
        self._take(speeds)
        off = [speed.off for speed in speeds if speed.off]
        return before, {word: max(errors[word] for errors in off) for word in off[0]} if off else {}

    def _take(self, speeds: list["_Solved"]) -> None:
        fit = self._fit
        assert fit
        if (degree := max(speed.degree for speed in speeds)) > fit.space.degree:
            raise HigherDegree(degree)
        for speed in speeds:
            if speed.estimates:
                self._estimates.add(speed.number, self._sweep.z[speed.number], speed.estimates)
        fit.take([(speed.number, speed.sample, speed.record) for speed in speeds if speed.sample])

    def _frictions(self, count: int) -> Frictions:
        if self._sweep.few:
            return Frictions(self._sweep.g, polynomial_weights(self._sweep.g))
        return Frictions(*chebyshev_nodes(count, self._sweep.g[0], self._sweep.g[-1]))

    @property
    def _all(self) -> NDArray[np.float64]:
        """Frictions for which punches are solved: the probes, and all sets of frictions to try."""
        if self._sweep.few:
            return self._sweep.g
        tried = [self._frictions(count).g for count in _FRICTIONS]
        return np.unique(np.concatenate([self._probes, *tried]))

    def _measured(self, number: int) -> "_Solved":
        """Solve a speed and measure its error."""
        work, task = self._work, self._tasks[number]
        self._tell(task)
        expected = self._expected(task)

        def solved(space: Space, g: NDArray) -> Any:
            return PunchLevel(work, task, space, g)

        with climbed(work, task, self._all, solved, self._degree, DISCRETISATION) as (ladder, error):
            level = ladder.levels[-1]
            if not self._fit:
                self._fit, self._degree = self._begun(level), ladder.degree
            fits = ladder.degree <= self._fit.space.degree
            return _Solved(
                number, ladder.degree, self._fit.sampled(task, level) if fits else None,
                ladder.record() | error.record(), estimates=error.of(self._probes, self._loads),
                off=self._off(level, expected) if fits else None,
            )  # fmt: skip

    def _expected(self, task: Task) -> list[Gauge] | None:
        """Gauges of a speed predicted by the fit; None where there is no fit yet."""
        if not self._fit or not self._fit.rational:
            return None
        with self._fit.level(task) as level:
            return level.measured(self._probes, self._loads)

    def _off(self, level: Any, expected: list[Gauge] | None) -> dict[str, float] | None:
        """Largest relative difference of predicted from solved gauges, by word; None if none."""
        if expected is None:
            return None
        return largest_changes(level.measured(self._probes, self._loads), expected)

    def _tell(self, task: Task) -> None:
        self._say(f"finite elements at c = {task.response.c:g}, of the fit")

    def _begun(self, level: Any) -> Fit:
        """Fit without samples, at as many frictions as give those between them accurately."""
        at = self._frictions(_FRICTIONS[-1])
        if not self._sweep.few:
            true = [part.normal for part in level.punch.parts(self._probes)]
            for count in _FRICTIONS:
                at = self._frictions(count)
                shares = at.shares(self._probes)
                interpolated = [shares @ part.normal for part in level.punch.parts(at.g)]
                off = max(np.abs(a - b).max() / np.abs(b).max() for a, b in zip(interpolated, true))
                if off <= _BETWEEN:
                    break
        return Fit(self._work, self._tasks, self._sweep, level.space, at, level.recovery)

    def _checked(self, number: int) -> "_Solved":
        """Solve a speed without measuring its error."""
        work, fit, task = self._work, self._fit, self._tasks[number]
        assert fit
        self._tell(task)
        expected = self._expected(task)
        level = PunchLevel(work, task, fit.space, self._all)
        try:
            off = self._off(level, expected)
            done = WorkDone()
            done.count(level)
            record = fit.record(number) | vars(done)
            return _Solved(number, fit.space.degree, fit.sampled(task, level), record, off=off)
        finally:
            level.destroy()

    def _good(self, error: dict[str, float]) -> bool:
        """True where an error of the fit, by word, is small enough."""
        return self._excess(error) <= 1.0

    def _excess(self, error: dict[str, float]) -> float:
        """Largest error of the fit over its allowed value, among the words; dimensionless."""
        tolerance, least = self._work.plan.tolerance, self._estimates.least
        return max(value / (FIT * max(tolerance, least(word))) for word, value in error.items())

    def _worst(self, before: Rational) -> list[int]:
        """Numbers of the speeds whose fit changed most, a speed for each gap between solved ones."""
        fit = self._fit
        assert fit and fit.rational
        z, solved = self._sweep.z, np.sort(self._sweep.z[fit.solved])
        values = rotated(fit.values)
        shares = fit.rational.shares(z)
        shares[:, : len(before.z)] -= before.shares(z)
        change = np.linalg.norm(shares @ values, axis=1)
        change[fit.solved] = -1.0
        gap = np.searchsorted(solved, z)
        gaps = [np.flatnonzero(gap == index) for index in np.unique(gap)]
        worst = [int(numbers[change[numbers].argmax()]) for numbers in gaps]
        return [number for number in worst if change[number] >= 0.0]

    def _change(self, before: Rational, number: int) -> dict[str, float]:
        """Largest relative change of a speed's gauges with the last sample, by word."""
        fit, task = self._fit, self._tasks[number]
        assert fit
        shares = before.shares(self._sweep.z[[number]])[0]
        gauges: list[list[Gauge]] = []
        for which in (None, np.append(shares, 0.0)):
            with fit.level(task, which) as level:
                gauges.append(level.measured(self._probes, self._loads))
        return largest_changes(*gauges)


_Item = TypeVar("_Item")
_Result = TypeVar("_Result")


def by_turns(items: Sequence[_Item], solve: Callable[[_Item], _Result], together: bool) -> list[_Result]:
    """Results of all items, on every rank, each solved by one of them; collective over MPI's world.

    Args:
        items: items, equal on every rank.
        solve: solves an item.
        together: True where all ranks solve each item collectively.

    Raises:
        SolveError: an item could not be solved; on every rank.
    """
    world = MPI.COMM_WORLD
    if together or world.size == 1:
        return [solve(item) for item in items]
    mine: list[_Result] = []
    failure: SolveError | None = None
    try:
        mine.extend(solve(item) for item in items[world.rank :: world.size])
    except SolveError as error:
        failure = error
    of_all = world.allgather((mine, failure))
    for _, failed in of_all:
        if failed:
            raise failed
    return [of_all[i % world.size][0][i // world.size] for i in range(len(items))]
