"""Many speeds for the price of a dozen: some are solved, a rational fit tells the others.

What is fitted are the parts of a punch at a few frictions: nodal forces, slopes, displacements, from
which its states of all frictions and loads follow. One rational function serves all of these numbers.
Speeds are solved far from those before, or where the fit changed most, and each is first told by the fit:
how far that was off, and how much the fit then changes all over the sweep, is its error.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.fem import levels
from galinx.app.plan.sweep import LADDERS, MOST, Sweep
from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.error import PROBES, climbed
from galinx.app.run.methods.fit import Fit
from galinx.app.run.methods.fit_error import Estimates, FitError, largest_changes
from galinx.app.run.methods.gauge import Gauge
from galinx.app.run.methods.ladder import WorkDone
from galinx.app.run.share import by_turns
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.fitted import Frictions, Sampled
from galinx.solvers.fem.space import Space
from galinx.solvers.rational import (
    Rational,
    chebyshev_nodes,
    leja,
    polynomial_weights,
    rotated,
)

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
            yield fit.mode.AtSpeed(_Told(task, [level], fit.record(number)), error, told)


@dataclass(frozen=True)
class _Told:
    """A speed's level and record, as of a ladder."""

    task: Task
    levels: list[Any]
    numbers: dict[str, Any]

    def record(self) -> dict[str, Any]:
        return self.numbers


def train(
    work: Discretisation, tasks: list[Task], mode: ModuleType, say: Callable[[str], None]
) -> Trained | None:
    """Solve speeds until a fit tells the others to the tolerance.

    Where that may cost too much, were it in vain, it tells those that were solved.

    Args:
        work: gives spaces.
        tasks: all speeds.
        mode: what punches are: a module with a ``Level`` and an ``AtSpeed``.
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
        self, work: Discretisation, tasks: list[Task], mode: ModuleType, sweep: Sweep,
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
            return mode.Level(work, task, space, g)

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
        level = self._mode.Level(work, task, fit.space, self._all)
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
