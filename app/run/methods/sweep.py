"""Many speeds for the price of a dozen: some are solved, a rational fit tells the others.

What is fitted are the parts of a punch at a few frictions: nodal forces, slopes, displacements, from
which its states of all frictions and loads follow. One rational function serves all of these numbers.
Speeds are solved far from those before, or where the fit changed most, and each is first told by the fit:
how far that was off, and how much the fit then changes all over the sweep, is its error.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.sweep import LADDERS, MOST, Sweep
from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.error import PROBES, climbed
from galinx.app.run.methods.fit_error import Estimates, FitError, largest_changes
from galinx.app.run.methods.gauge import Gauge
from galinx.app.run.methods.ladder import WorkDone
from galinx.postprocess.quantities.stresses import BELOW, YIELD
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.fitted import (
    FittedPunch,
    Frictions,
    Sampled,
    Singular,
    sampled,
    together,
)
from galinx.solvers.fem.space import Space
from galinx.solvers.rational import (
    Rational,
    chebyshev_nodes,
    fitted,
    leja,
    polynomial_weights,
    rotated,
)
from galinx.solvers.sie.closed_form import FlatPunch

#: Share of the tolerance that the discretisation may take, and that of the larger of both which the fit
#: may: together they stay below.
DISCRETISATION, FIT = 0.88, 0.1

#: Sum of shares in absolute value from which a fit is worth nothing: a pole is near.
_LARGEST = 1e4

#: What may be rounding in the numbers of a sample, which are over their largest.
_NOISE = 3e-9

#: Numbers of frictions that are tried until what lies between is known to this share of the tolerance,
#: and at most so well as rounding lets it.
_FRICTIONS, _BETWEEN, _ROUNDING = (8, 12, 16, 20, 26, 34, 44, 60), 1e-6, 1e-12


class HigherDegree(Exception):
    """One of the speeds asks for a higher degree than those before were solved with."""


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
        moved: by how many parts of a punch the far boundary is moved.
        solved: numbers of the speeds, in the order in which they were solved.
        samples: of these, without what edges do.
        records: of the work, by a speed's number.
        rational: through the samples; None for less than three.
    """

    work: Discretisation
    mode: ModuleType
    tasks: list[Task]
    sweep: Sweep
    space: Space
    at: Frictions
    recovery: Any
    moved: int
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

    def add(self, task: Task, level: Any, record: dict[str, Any]) -> None:
        """Take in a speed that was solved."""
        fields = bool({BELOW, YIELD} & self.work.stresses)
        found = sampled(level.punch, self.at, level.slopes, fields)
        self.samples.append(found.smooth(self.singular(task)))
        self.solved.append(task.number)
        self.records[task.number] = record
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
        punch = FittedPunch(self.space, task.response, self.at, known, self.moved)
        try:
            yield self.mode.Level(self.work, task, self.space, self.at.g, punch, self.recovery)
        finally:
            punch.destroy()

    def record(self, number: int) -> dict[str, Any]:
        """Numbers of the work at a speed; none was done where it is fitted."""
        space = self.space
        size = {"cells": space.cells, "unknowns": space.size, "degree": space.degree}
        return self.records.get(number) or size | vars(WorkDone())


@dataclass(frozen=True)
class Trained:
    """A fit that is good enough, and how good it is.

    Attributes:
        fit: through the speeds that were solved.
        estimates: of the discretisation, measured at some speeds.
        error: of the fit, by word of output.quantities.
    """

    fit: Fit
    estimates: Estimates
    error: dict[str, float]

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Any]:
        """Punches at a speed, of the fit's mode; None where they have to be solved.

        That is where what is estimated there is beyond the tolerance: alone it may do better.
        """
        number, fit = task.number, self.fit
        told = number not in fit.solved
        error = FitError(self.estimates, fit.sweep.z[number], self.error if told else {})
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
    """Solve speeds until a fit tells the others to the tolerance; None where none does.

    Args:
        work: gives spaces.
        tasks: all speeds.
        mode: what punches are: a module with a ``Level`` and an ``AtSpeed``.
        say: is told what is done.
    """
    assert work.plan.sweep
    degree: int | None = None
    while True:
        try:
            training = _Training(work, tasks, mode, work.plan.sweep, say, degree)
            return training.done()
        except HigherDegree as higher:
            degree = higher.args[0]
        except SolveError as error:  # each speed by itself tells which, and why
            say(f"no fit through speeds: {error}")
            return None


class _Training:
    """See :func:`train`; ``degree`` is that to begin with, the plan's if None."""

    def __init__(
        self, work: Discretisation, tasks: list[Task], mode: ModuleType, sweep: Sweep,
        say: Callable[[str], None], degree: int | None,
    ) -> None:  # fmt: skip
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
        """The fit, None where it does not become good enough."""
        tasks, z = self._tasks, self._sweep.z
        fastest = int(np.argmin([task.response.margin for task in tasks]))
        number: int | None = fastest
        chosen: list[int] = []
        for count in range(min(MOST, len(tasks) // 2)):
            number = leja(z, chosen) if number is None else number
            if number is None:
                break  # there is no other speed
            chosen.append(number)
            task, number = tasks[number], None
            self._say(f"finite elements at c = {task.response.c:g}, speed {count + 1} of the fit")
            if count < LADDERS:
                self._measured(task)
                continue
            before, error = self._checked(task)
            if self._good(error):
                changes = {worst: self._change(before, worst) for worst in self._worst(before)}
                error = {word: max(one[word] for one in (error, *changes.values())) for word in error}
                if self._good(error):
                    assert self._fit
                    return Trained(self._fit, self._estimates, error)
                number = max(changes, key=lambda worst: self._excess(changes[worst]))
        self._say("no fit through speeds is good enough: each is solved")
        return None

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

    def _measured(self, task: Task) -> None:
        """Solve a speed with all that measures its error."""
        work, mode = self._work, self._mode

        def solved(space: Space, g: NDArray) -> Any:
            return mode.Level(work, task, space, g)

        with climbed(work, task, self._all, solved, self._degree, DISCRETISATION) as (ladder, error):
            if self._fit and ladder.degree > self._fit.space.degree:
                raise HigherDegree(ladder.degree)
            level, self._degree = ladder.levels[-1], ladder.degree
            of_probes = error.of(self._probes, self._loads)
            self._estimates.add(task.number, self._sweep.z[task.number], of_probes)
            if not self._fit:
                self._fit = self._begun(level)
            self._fit.add(task, level, ladder.record() | error.record())

    def _begun(self, level: Any) -> Fit:
        """A fit without samples: at as many frictions as tell those between."""
        moved, at = level.punch.moved, self._frictions(_FRICTIONS[-1])
        if not self._sweep.few:
            wanted = max(_BETWEEN * self._work.plan.tolerance, _ROUNDING)
            true = [part.normal for part in level.punch.parts(self._probes)]
            for count in _FRICTIONS:
                at = self._frictions(count)
                shares = at.shares(self._probes)
                told = [shares @ part.normal for part in level.punch.parts(at.g)]
                off = max(np.abs(a - b).max() / np.abs(b).max() for a, b in zip(told, true))
                if off <= wanted:
                    break
        return Fit(
            self._work, self._mode, self._tasks, self._sweep, level.space, at, level.recovery, moved
        )

    def _checked(self, task: Task) -> tuple[Rational, dict[str, float]]:
        """Solve a speed and take it in; the fit before, and how far it was off there, by word."""
        work, fit = self._work, self._fit
        assert fit and fit.rational
        with fit.level(task) as told:
            expected = told.measured(self._probes, self._loads)
        level = self._mode.Level(work, task, fit.space, self._all)
        try:
            found = level.measured(self._probes, self._loads)
            done = WorkDone()
            done.count(level)
            before = fit.rational
            fit.add(task, level, fit.record(task.number) | vars(done))
        finally:
            level.destroy()
        return before, largest_changes(found, expected)

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
