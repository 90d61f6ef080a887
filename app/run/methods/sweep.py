"""Many speeds for the price of a dozen: some are solved, a rational fit tells the others.

What is fitted are the parts of a punch at a few frictions: nodal forces, slopes, displacements, from
which its states of all frictions and loads follow. One rational function serves all of these numbers.
Speeds are solved far from those before, or where the fit changed most, and each is first told by the fit:
how far that was off, and how much the fit then changes all over the sweep, is its error.

A fit through speeds that were solved: one rational function for all numbers of a punch's parts.

How far punches are off that other speeds tell of: by their discretisation, and by the fit.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities.layers import AT_INTERFACES
from galinx.postprocess.quantities.stresses import BELOW, YIELD
from galinx.solvers.approximation import (
    Rational,
    chebyshev_nodes,
    fitted,
    leja,
    polynomial_weights,
    rotated,
)
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.punch import FittedPunch, Frictions, Sampled, Singular, sampled, together
from galinx.solvers.fem.space import Space
from galinx.solvers.sie.closed_form import FlatPunch

from ...plan.fem import LADDERS, MOST, Sweep, levels
from ...plan.task import Task
from ..share import by_turns
from .discretisation import Discretisation
from .error import PROBES, Gauge, WorkDone, climbed
from .method import Mode

#: Sum of shares in absolute value from which a fit is worth nothing: a pole is near.
_LARGEST = 1e4

#: What may be rounding in the numbers of a sample, which are over their largest.
_NOISE = 3e-9


@dataclass
class Fit:
    """A fit through the speeds that have been solved so far.

    Attributes:
        work, mode: give spaces; what the punches are.
        tasks: all speeds, in the order of the plan.
        sweep: what the plan knows of them.
        space: of the last degree.
        at: frictions at which punches are sampled.
        recovery: how pressure is read off nodal forces.
        solved: numbers of the speeds, in the order in which they were solved.
        samples: of these, without what edges do.
        records: of the work, by a speed's number.
        rational: through the samples; None for less than three.
    """

    work: Discretisation
    mode: Mode
    tasks: list[Task]
    sweep: Sweep
    space: Space
    at: Frictions
    recovery: Any
    solved: list[int] = field(default_factory=list)
    samples: list[Sampled] = field(default_factory=list)
    records: dict[int, dict[str, Any]] = field(default_factory=dict)
    rational: Rational | None = None

    def singular(self, task: Task) -> Singular:
        """What edges do at a speed: powers of the distance whose exponents the local analysis knows."""
        s, places = self.space.contact.s, task.places.X
        left, right, _ = self.space.chart.under_punch(s - s[0], s[-1] - s)
        # At the edge itself the force is that of a piece of half the innermost distance or so.
        left, right = np.maximum(left, left[1] / 2.0), np.maximum(right, right[-2] / 2.0)
        local = FlatPunch(task.response, self.at.g)

        def power(from_left: NDArray, from_right: NDArray) -> NDArray[np.float64]:
            logs = np.outer(local.α, np.log(from_right)) + np.outer(local.β, np.log(from_left))
            return np.asarray(np.exp(logs))

        slopes = power(np.abs(1.0 + places), np.abs(1.0 - places))
        return Singular(power(left, right), slopes if self.work.stresses else slopes[:, :0])

    def sampled(self, task: Task, level: Any) -> Sampled:
        """What the fit is made of at a speed that was solved."""
        fields = bool({BELOW, YIELD, AT_INTERFACES} & self.work.stresses)
        found = sampled(level.punch, self.at, level.slopes, fields)
        return found.smooth(self.singular(task))

    def take(self, solved: Sequence[tuple[int, Sampled, dict[str, Any]]]) -> None:
        """Take in speeds that were solved: number, sample and record of each."""
        for number, sample, record in solved:
            self.samples.append(sample)
            self.solved.append(number)
            self.records[number] = record
        if len(self.samples) > 2:
            self.rational = self._rational()

    def _rational(self) -> Rational:
        """One without poles among the speeds, else the polynomial."""
        z = self.sweep.z[self.solved]
        found = fitted(z, self.values, _NOISE)
        if np.abs(found.shares(self.sweep.z)).sum(axis=1).max() < _LARGEST:
            return found
        return Rational(z, polynomial_weights(z))

    @property
    def values(self) -> NDArray[np.float64]:
        """All numbers of the samples, each kind over its largest, (samples, numbers)."""
        blocks = []
        for kinds in zip(*(one.numbers() for one in self.samples)):
            values = np.array(kinds)
            size = np.abs(values).max(initial=0.0)
            if size > 0.0:
                blocks.append(values / (size * values.shape[1] ** 0.5))
        return np.concatenate(blocks, axis=1)

    def shares(self, number: int) -> NDArray[np.float64]:
        """What of the samples makes a speed, (samples,)."""
        if number in self.solved:
            return np.eye(len(self.solved))[self.solved.index(number)]
        assert self.rational
        return self.rational.shares(self.sweep.z[[number]])[0]

    @contextmanager
    def level(self, task: Task, shares: NDArray | None = None) -> Iterator[Any]:
        """A speed as the fit, or other shares of the samples, tell it."""
        shares = self.shares(task.number) if shares is None else shares
        known = together(self.samples, shares).singular(self.singular(task))
        punch = FittedPunch(self.space, task.response, self.at, known)
        try:
            yield self.mode.level(self.work, task, self.space, self.at.g, punch, self.recovery)
        finally:
            punch.destroy()

    def record(self, number: int) -> dict[str, Any]:
        """Numbers of the work at a speed; none was done where it is fitted."""
        space = self.space
        size = {"cells": space.cells, "unknowns": space.size, "degree": space.degree}
        return self.records.get(number) or size | vars(WorkDone())


def largest_changes(gauges: Sequence[Gauge], others: Sequence[Gauge]) -> dict[str, float]:
    """Largest relative difference of two lists of gauges, by word of output.quantities."""
    return {one.word: float(one.change(other).max()) for one, other in zip(gauges, others)}


class Estimates:
    """Estimated errors of the discretisation at some speeds and frictions.

    Args:
        g: the frictions, rising, (frictions,).

    Attributes:
        numbers: of the speeds.
    """

    def __init__(self, g: NDArray) -> None:
        self._g, self.numbers = g, list[int]()
        self._z: list[float] = []
        self._errors: dict[str, list[NDArray]] = {}

    def add(self, number: int, z: float, errors: dict[str, NDArray]) -> None:
        """Those at a speed: its number, its place in the variable of the fit.

        Args:
            number, z: the speed.
            errors: by word, (n frictions,), those of some loads one after the other.
        """
        self.numbers.append(number)
        self._z.append(z)
        for word, values in errors.items():
            of_loads = values.reshape(-1, len(self._g)).max(axis=0)
            self._errors.setdefault(word, []).append(of_loads)

    def least(self, word: str) -> float:
        """The smallest of all."""
        return float(np.min(self._errors[word]))

    def covers(self, z: float) -> bool:
        """Were errors measured there, or on both sides of it?"""
        return min(self._z) <= z <= max(self._z)

    def beyond(self, tolerance: float) -> bool:
        """Are all of a word beyond it? Then no speed can be told to the tolerance."""
        return any(self.least(word) > tolerance for word in self._errors)

    def around(self, z: float, g: NDArray) -> dict[str, NDArray[np.float64]]:
        """The largest of those around a speed and frictions, (len(g),), by word.

        Of the solved speeds on both sides, and of the frictions: an error that falls from one to the
        other is not told smaller than it may be.
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
    """Numbers of the places on both sides of each x, twice the same where it is one, (len(x), 2)."""
    last = len(places) - 1
    right = np.clip(np.searchsorted(places, x), 0, last)
    left = np.where(places[right] > x, right - 1, right)
    return np.column_stack([np.clip(left, 0, last), right])


class FitError:
    """Errors at a speed that others tell of, as of :class:`.error.MeasuredError`.

    Args:
        estimates: of the discretisation.
        z: the speed in the variable of the fit.
        fit: error of the fit, by word of output.quantities; none where the speed was solved.
    """

    def __init__(self, estimates: Estimates, z: float, fit: dict[str, float]) -> None:
        self._estimates, self._z, self._fit = estimates, z, fit

    def of(self, g: NDArray, load: Any = None, last: Any = None) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by the word of output.quantities that asks for them."""
        around = self._estimates.around(self._z, g)
        return {word: values + self._fit.get(word, 0.0) for word, values in around.items()}

    def record(self) -> dict[str, Any]:
        """None: what was measured is in the records of the speeds that were solved."""
        return {}


#: Share of the tolerance that the discretisation may take, and that of the larger of both which the fit
#: may: together they stay below.
DISCRETISATION, FIT = 0.88, 0.1

#: Speeds that are solved before the fit is looked at again: two ranks have one each, and whatever their
#: number, the same speeds are solved.
AT_ONCE = 2

#: Numbers of frictions that are tried until what lies between is known so well, relative: forces have to
#: balance to 1e-9, and what cancels at free ends is as much larger than what is left.
_FRICTIONS, _BETWEEN = (8, 12, 16, 20, 26, 34, 44, 60), 3e-12


#: Share of what solving every speed costs that may be lost where no fit becomes good enough.
_REGRET = 0.08

#: Speeds, at both ends of the sweep, at which the discretisation's error is measured in any case.
_ENDS = 2


class HigherDegree(Exception):
    """One of the speeds asks for a higher degree than those before were solved with."""


@dataclass(frozen=True)
class Trained:
    """A fit through some speeds, and how good it is.

    Attributes:
        fit: through the speeds that were solved.
        estimates: of the discretisation, measured at some speeds.
        error: of the fit, by word of output.quantities; None where it is not good enough, and tells the
            solved speeds alone.
    """

    fit: Fit
    estimates: Estimates
    error: dict[str, float] | None

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Any]:
        """Punches at a speed, of the fit's mode; None where they have to be solved.

        That is where what is estimated there is beyond the tolerance: alone it may do better.
        """
        number, fit = task.number, self.fit
        told, z = number not in fit.solved, float(fit.sweep.z[number])
        if self.error is None and (told or not self.estimates.covers(z)):
            yield None
            return
        error = FitError(self.estimates, z, self.error if told and self.error else {})
        worst = max((values.max() for values in error.of(g).values()), default=0.0)
        if worst > fit.work.plan.tolerance:
            yield None
            return
        with fit.level(task) as level:
            yield fit.mode.at_speed(_Told(task, [level], fit.record(number)), error, told)


@dataclass(frozen=True)
class _Told:
    """A speed's level and record, as of a ladder."""

    task: Task
    levels: list[Any]
    numbers: dict[str, Any]

    def record(self) -> dict[str, Any]:
        return self.numbers


def train(
    work: Discretisation, tasks: list[Task], mode: Mode, say: Callable[[str], None]
) -> Trained | None:
    """Solve speeds until a fit tells the others to the tolerance.

    Where that may cost too much, were it in vain, it tells those that were solved.

    Args:
        work: gives spaces.
        tasks: all speeds.
        mode: what punches are: a mode with a level and its punches at a speed.
        say: is told what is done.
    """
    assert work.plan.sweep
    degree: int | None = None
    lost = 0.0
    while True:
        training = _Training(work, tasks, mode, work.plan.sweep, say, degree, lost)
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
    """A speed that was solved.

    Attributes:
        number: of the speed.
        degree: of its elements.
        sample: for the fit, None of a higher degree than its own.
        record: of the work.
        estimates: of the discretisation, by word, where they were measured.
        off: how far the fit before was, by word, where it told the speed.
    """

    number: int
    degree: int
    sample: Sampled | None
    record: dict[str, Any]
    estimates: dict[str, NDArray] | None = None
    off: dict[str, float] | None = None


def _cost(degree: int) -> float:
    """Of a factorisation and all that goes with it."""
    return float(degree**4)


def _cost_of_ladder(degree: int) -> float:
    return sum(_cost(p) for p, _ in levels(degree, 1, fixed=False))


class _Training:
    """See :func:`train`.

    Costs are counted in factorisations, which go with the fourth power of the degree or so.

    Args:
        work, tasks, mode, sweep, say: of that.
        degree: to begin with, the plan's if None.
        lost: cost of what was solved before, in vain.

    Attributes:
        spent: cost of all that was solved.
        allowed: cost that may be lost.
    """

    def __init__(
        self, work: Discretisation, tasks: list[Task], mode: Mode, sweep: Sweep,
        say: Callable[[str], None], degree: int | None, lost: float = 0.0,
    ) -> None:  # fmt: skip
        self.spent = lost
        self._alone = [_cost_of_ladder(degree) for degree in work.plan.degrees]
        self._lost, self.allowed = lost, _REGRET * sum(self._alone)
        self._work, self._tasks, self._mode, self._sweep = work, tasks, mode, sweep
        self._say, self._degree = say, degree
        body = tasks[0].body
        ends = {min(tasks[0].loads), max(tasks[0].loads)}
        probes = sweep.g if sweep.few else np.linspace(sweep.g[0], sweep.g[-1], PROBES)
        self._loads = None if body.alike else np.repeat(sorted(ends), len(probes))
        self._probes = probes if body.alike else np.tile(probes, len(ends))
        self._estimates = Estimates(np.unique(probes))
        self._fit: Fit | None = None

    def done(self) -> Trained | None:
        """The fit; of the solved speeds alone where it does not become good enough."""
        tasks = self._tasks
        # The fastest asks for the highest degree: it is solved first, by every rank for itself.
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
                error = {word: max(one[word] for one in (error, *changes.values())) for word in error}
                if self._good(error) and self._good(error := self._seconded(error, chosen)):
                    assert self._fit
                    return Trained(self._fit, self._estimates, error)
                number = max(changes, key=lambda worst: self._excess(changes[worst]))
        return self.given_up()

    def _seconded(self, error: dict[str, float], chosen: list[int]) -> dict[str, float]:
        """The error of a fit that is good, after that of the discretisation was measured at more speeds.

        That was put off, lest it be in vain.
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
        """What was solved tells of itself."""
        self._say("no fit through speeds is good enough at its cost: each is solved")
        return Trained(self._fit, self._estimates, None) if self._fit else None

    def _next(self, chosen: list[int], number: int | None) -> dict[int, bool]:
        """Numbers of the speeds that are solved next: the given one, and such as are far from all.

        Each with whether to measure its error, as at the ends of the sweep, and elsewhere as far as that
        may be in vain. Those that would cost too much are left out.
        """
        found = self._far([] if number is None else [number], chosen)
        lost, kept = self._lost, dict[int, bool]()
        for number in found:
            measured = len(self._estimates.numbers) + sum(kept.values())
            for measures in (True, False):
                more = self._cost(measures) - self._alone[number]
                allowed = measured < LADDERS if measures else measured >= _ENDS
                if allowed and lost + more <= self.allowed:
                    lost += more
                    kept[number] = measures
                    break
        return kept

    def _far(self, found: list[int], chosen: list[int]) -> list[int]:
        """Numbers of as many speeds as are solved at once: some, and others that are far from all."""
        while len(found) < AT_ONCE:
            number = leja(self._sweep.z, chosen + found)
            if number is None:
                break
            found = [*found, number]
        return found

    def _cost(self, measures: bool) -> float:
        """Of a speed at the fit's degree, with or without all that measures its error."""
        assert self._degree
        return _cost_of_ladder(self._degree) if measures else _cost(self._degree)

    def _solved(self, numbers: dict[int, bool]) -> tuple[Rational | None, dict[str, float]]:
        """Solve speeds, shared out over the ranks, and take them in.

        Args:
            numbers: of the speeds, and whether to measure the error there.

        Returns:
            The fit before; how far it was off at most, by word, nothing where there was none.
        """
        for number, measures in numbers.items():
            cost = self._cost(measures)
            self.spent, self._lost = self.spent + cost, self._lost + cost - self._alone[number]

        def solve(number: int) -> _Solved:
            return self._measured(number) if numbers[number] else self._checked(number)

        before = self._fit.rational if self._fit else None
        found = by_turns(list(numbers), solve, not self._work.plan.shared_speeds)
        self._take(found)
        off = [one.off for one in found if one.off]
        return before, {word: max(one[word] for one in off) for word in off[0]} if off else {}

    def _take(self, found: list["_Solved"]) -> None:
        fit = self._fit
        assert fit
        if (degree := max(one.degree for one in found)) > fit.space.degree:
            raise HigherDegree(degree)
        for one in found:
            if one.estimates:
                self._estimates.add(one.number, self._sweep.z[one.number], one.estimates)
        fit.take([(one.number, one.sample, one.record) for one in found if one.sample])

    def _frictions(self, count: int) -> Frictions:
        if self._sweep.few:
            return Frictions(self._sweep.g, polynomial_weights(self._sweep.g))
        return Frictions(*chebyshev_nodes(count, self._sweep.g[0], self._sweep.g[-1]))

    @property
    def _all(self) -> NDArray[np.float64]:
        """Frictions for which punches are solved: all at which one is ever looked at."""
        if self._sweep.few:
            return self._sweep.g
        tried = [self._frictions(count).g for count in _FRICTIONS]
        return np.unique(np.concatenate([self._probes, *tried]))

    def _measured(self, number: int) -> "_Solved":
        """Solve a speed with all that measures its error."""
        work, mode, task = self._work, self._mode, self._tasks[number]
        self._tell(task)
        expected = self._expected(task)

        def solved(space: Space, g: NDArray) -> Any:
            return mode.level(work, task, space, g)

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
        """What the fit says of a speed, None where there is none yet."""
        if not self._fit or not self._fit.rational:
            return None
        with self._fit.level(task) as told:
            return told.measured(self._probes, self._loads)

    def _off(self, level: Any, expected: list[Gauge] | None) -> dict[str, float] | None:
        """How far that is from what was solved, by word."""
        if expected is None:
            return None
        return largest_changes(level.measured(self._probes, self._loads), expected)

    def _tell(self, task: Task) -> None:
        self._say(f"finite elements at c = {task.response.c:g}, of the fit")

    def _begun(self, level: Any) -> Fit:
        """A fit without samples: at as many frictions as tell those between."""
        at = self._frictions(_FRICTIONS[-1])
        if not self._sweep.few:
            true = [part.normal for part in level.punch.parts(self._probes)]
            for count in _FRICTIONS:
                at = self._frictions(count)
                shares = at.shares(self._probes)
                told = [shares @ part.normal for part in level.punch.parts(at.g)]
                off = max(np.abs(a - b).max() / np.abs(b).max() for a, b in zip(told, true))
                if off <= _BETWEEN:
                    break
        return Fit(self._work, self._mode, self._tasks, self._sweep, level.space, at, level.recovery)

    def _checked(self, number: int) -> "_Solved":
        """Solve a speed alone."""
        work, fit, task = self._work, self._fit, self._tasks[number]
        assert fit
        self._tell(task)
        expected = self._expected(task)
        level = self._mode.level(work, task, fit.space, self._all)
        try:
            off = self._off(level, expected)
            done = WorkDone()
            done.count(level)
            record = fit.record(number) | vars(done)
            return _Solved(number, fit.space.degree, fit.sampled(task, level), record, off=off)
        finally:
            level.destroy()

    def _good(self, error: dict[str, float]) -> bool:
        """Is an error of the fit, by word, small enough?"""
        return self._excess(error) <= 1.0

    def _excess(self, error: dict[str, float]) -> float:
        """An error of the fit, by word, over what it may be, the largest."""
        tolerance, least = self._work.plan.tolerance, self._estimates.least
        return max(value / (FIT * max(tolerance, least(word))) for word, value in error.items())

    def _worst(self, before: Rational) -> list[int]:
        """Numbers of the speeds whose fit changed most, one in each gap between solved ones."""
        fit = self._fit
        assert fit and fit.rational
        z, solved = self._sweep.z, np.sort(self._sweep.z[fit.solved])
        values = rotated(fit.values)
        shares = fit.rational.shares(z)
        shares[:, : len(before.z)] -= before.shares(z)
        change = np.linalg.norm(shares @ values, axis=1)
        change[fit.solved] = -1.0
        gap = np.searchsorted(solved, z)
        worst = [np.flatnonzero(gap == one) for one in np.unique(gap)]
        found = [int(some[change[some].argmax()]) for some in worst]
        return [number for number in found if change[number] >= 0.0]

    def _change(self, before: Rational, number: int) -> dict[str, float]:
        """How much a speed changed with the last sample, by word."""
        fit, task = self._fit, self._tasks[number]
        assert fit
        shares = before.shares(self._sweep.z[[number]])[0]
        gauges: list[list[Gauge]] = []
        for which in (None, np.append(shares, 0.0)):
            with fit.level(task, which) as level:
                gauges.append(level.measured(self._probes, self._loads))
        return largest_changes(*gauges)
