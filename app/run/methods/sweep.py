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

from galinx.app.plan.sweep import LADDERS, MOST, Sweep
from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.error import PROBES, climbed
from galinx.app.run.methods.fit import Fit
from galinx.app.run.methods.fit_error import Estimates, FitError, largest_changes
from galinx.app.run.methods.gauge import Gauge
from galinx.app.run.methods.ladder import WorkDone
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.fitted import (
    Frictions,
)
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

#: Numbers of frictions that are tried until what lies between is known so well, relative: forces have to
#: balance to 1e-9, and what cancels at free ends is as much larger than what is left.
_FRICTIONS, _BETWEEN = (8, 12, 16, 20, 26, 34, 44, 60), 3e-12


class HigherDegree(Exception):
    """One of the speeds asks for a higher degree than those before were solved with."""


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
            if self._estimates.beyond(self._work.plan.tolerance):
                break
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
            true = [part.normal for part in level.punch.parts(self._probes)]
            for count in _FRICTIONS:
                at = self._frictions(count)
                shares = at.shares(self._probes)
                told = [shares @ part.normal for part in level.punch.parts(at.g)]
                off = max(np.abs(a - b).max() / np.abs(b).max() for a, b in zip(told, true))
                if off <= _BETWEEN:
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
