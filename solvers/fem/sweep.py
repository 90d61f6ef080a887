"""Sweeps of many speeds for the price of a dozen: a rational fit through solved speeds gives the others.

The fit is of the parts of a punch at a few frictions: nodal forces, slopes, displacements, from which its
states of all frictions and loads follow. A single rational function serves all of these numbers
(:class:`Fit`). The next speed is solved far from those before, or where the fit changed most, and is
predicted by the fit first: the error of that prediction, and the change of the fit all over the sweep,
are the error of the fit. A fitted speed has that error and the error of the discretisation
(:class:`Trained`).
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from ..approximation import (
    Barycentric,
    chebyshev_nodes,
    fit_rational,
    leja,
    polynomial_through,
    rotated,
)
from ..contact import AT_INTERFACES, BELOW, YIELD
from ..contact.edges import EdgeExponents
from ..contact.fem_plan import LADDERS, MOST, Sweep, levels
from ..contact.solution import Task
from ..errors import SolveError
from .contact import PUNCHES, PunchLevel
from .discretisation import Discretisation
from .ladder import PROBES, Estimate, Gauge, Solved, WorkDone, around, climb, size_of
from .punch import FittedPunch, Sampled, sampled, together
from .space import Space

#: Sum of absolute shares from which a fit is rejected: a pole is near.
_LARGEST = 1e4
#: Rounding in the numbers of a sample, relative to their largest.
_NOISE = 3e-9
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


@dataclass(frozen=True)
class Speed:
    """Solved speed.

    Attributes:
        number: number of the speed.
        degree: degree of its elements.
        sample: sample for the fit, without the singular factors of the edges; None of a higher degree
            than the fit's.
        record: numbers of the work.
        estimate: errors of the discretisation, where they were measured.
        off: error of the previous fit at this speed, by word, empty where there was none.
    """

    number: int
    degree: int
    sample: Sampled | None
    record: dict[str, Any]
    estimate: Estimate | None
    off: dict[str, float]


@dataclass
class Fit:
    """A fit through the speeds that have been solved so far.

    Attributes:
        work: gives spaces.
        sweep: the plan's sweep.
        space: space of the last degree.
        at: frictions at which punches are sampled.
        recovery: maps from nodal forces to pressure.
        speeds: solved speeds, by number, in the order in which they were solved.
        rational: rational function through the samples; None for fewer than three.
    """

    work: Discretisation
    sweep: Sweep
    space: Space
    at: Barycentric
    recovery: Any
    speeds: dict[int, Speed] = field(default_factory=dict)
    rational: Barycentric | None = None

    @property
    def kind(self) -> type[PunchLevel]:
        """Kind of the levels."""
        return PUNCHES[self.work.plan.mode]

    @property
    def solved(self) -> list[int]:
        """Numbers of the solved speeds."""
        return list(self.speeds)

    @property
    def samples(self) -> list[Sampled]:
        """Samples of the solved speeds."""
        return [speed.sample for speed in self.speeds.values() if speed.sample]

    def singular(self, task: Task) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Singular factors of the edges: powers of the distance with exponents of the local analysis.

        Returns:
            Factors of nodal forces, (frictions, nodes), and of slopes, (frictions, places).
        """
        s, places = self.space.contact.s, task.places.X
        d_left, d_right, _ = self.space.chart.under_punch(s - s[0], s[-1] - s)
        # At the edge itself the force is that of a piece of half the innermost distance or so.
        d_left, d_right = np.maximum(d_left, d_left[1] / 2.0), np.maximum(d_right, d_right[-2] / 2.0)
        local = EdgeExponents(task.response, self.at.nodes)

        def power(from_left: NDArray, from_right: NDArray) -> NDArray[np.float64]:
            logs = np.outer(local.α, np.log(from_right)) + np.outer(local.β, np.log(from_left))
            return np.asarray(np.exp(logs))

        slopes = power(np.abs(1.0 + places), np.abs(1.0 - places))
        return power(d_left, d_right), slopes if self.work.stresses else slopes[:, :0]

    def sampled(self, task: Task, level: PunchLevel) -> Sampled:
        """Sample of a solved speed, without the singular factors of the edges."""
        fields = bool({BELOW, YIELD, AT_INTERFACES} & self.work.stresses)
        forces, slopes = self.singular(task)
        return sampled(level.punch, self.at, level.slopes, fields).scaled(1.0 / forces, 1.0 / slopes)

    def take(self, speeds: Sequence[Speed]) -> None:
        """Take in solved speeds; a rational function with a pole among the speeds is replaced."""
        self.speeds |= {speed.number: speed for speed in speeds if speed.sample}
        z = self.sweep.z[self.solved]
        if len(z) > 2:
            self.rational = fit_rational(z, self.values, _NOISE)
            if np.abs(self.rational.shares(self.sweep.z)).sum(axis=1).max() >= _LARGEST:
                self.rational = polynomial_through(z)

    @property
    def values(self) -> NDArray[np.float64]:
        """All numbers of the samples, each kind relative to its largest, (samples, numbers)."""
        blocks = []
        for kinds in zip(*(sample.blocks() for sample in self.samples)):
            values = np.array(kinds)
            size = np.abs(values).max(initial=0.0)
            if size > 0.0:
                blocks.append(values / (size * values.shape[1] ** 0.5))
        return np.concatenate(blocks, axis=1)

    @contextmanager
    def level(self, task: Task, rational: Barycentric | None = None) -> Iterator[PunchLevel]:
        """Level of a speed by the fit, or by another rational function through the first samples."""
        number = task.number
        if rational is None and number in self.speeds:
            shares = 1.0 * (np.array(self.solved) == number)
        else:
            through = rational or self.rational
            assert through
            shares = through.shares(self.sweep.z[[number]])[0]
        combined = together(self.samples, shares).scaled(*self.singular(task))
        punch, kind = FittedPunch(self.space, task.response, self.at, combined), self.kind
        with closing(kind(self.work, task, self.space, self.at.nodes, punch, self.recovery)) as level:
            yield level

    def record(self, number: int) -> dict[str, Any]:
        """Numbers of the work at a speed; none was done where it is fitted."""
        if number in self.speeds:
            return self.speeds[number].record
        return size_of(self.space) | vars(WorkDone())


@dataclass(frozen=True)
class Trained:
    """Fit through solved speeds, and its error.

    Attributes:
        fit: fit through the solved speeds.
        estimates: errors of the discretisation by the variable of the fit, rising, where they were
            measured.
        error: error of the fit, by word of output.quantities; None where it is not good enough and serves
            the solved speeds alone.
    """

    fit: Fit
    estimates: dict[float, Estimate]
    error: dict[str, float] | None

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Any]:
        """Punches at a speed; None where they have to be solved.

        They have to be where the estimated error exceeds the tolerance: solved alone it may be smaller.
        """
        number, fit = task.number, self.fit
        fitted, z = number not in fit.speeds, float(fit.sweep.z[number])
        covered = min(self.estimates) <= z <= max(self.estimates)
        known = self.error is not None or (not fitted and covered)
        # Errors of the speeds measured on both sides, the larger ones, and of the fit.
        places, each = np.array([*self.estimates]), list(self.estimates.values())
        low, high = (each[i] for i in around(places, np.array([z]))[0])
        of_fit = self.error if fitted and self.error else {}
        errors = {
            word: np.maximum(values, high.errors[word]) + of_fit.get(word, 0.0)
            for word, values in low.errors.items()
        }
        error = Estimate(low.g, low.loads, errors)
        worst = max((values.max() for values in error.of(g).values()), default=0.0)
        if known and worst <= fit.work.plan.tolerance:
            with fit.level(task) as level:
                yield Solved(level, error, fit.record(number), fitted)
        else:
            yield None


def train(work: Discretisation, tasks: list[Task], say: Callable[[str], None]) -> Trained | None:
    """Solve speeds until a fit through them gives the others to the tolerance.

    Where that may cost too much in vain, the fit serves the solved speeds alone; None for no fit.

    Args:
        work: gives spaces.
        tasks: all speeds.
        say: shows the work under way.
    """
    degree, lost = None, 0.0
    while True:
        training = _Training(work, tasks, say, degree, lost)
        try:
            return training.run()
        except _HigherDegree as higher:
            degree, lost = higher.args[0], training.spent
            if lost > training.allowed:
                return training.given_up()
        except SolveError as error:  # each speed by itself tells which, and why
            say(f"no fit through speeds: {error}")
            return None


class _HigherDegree(Exception):
    """A speed needs a higher degree than the speeds before were solved with."""


class _Training:
    """Training of a fit; see :func:`train`.

    Costs are counted in factorisations, which go with the fourth power of the degree or so.

    Args:
        work, tasks, say: as of :func:`train`.
        degree: degree to begin with; the plan's if None.
        lost: cost of the speeds that were solved before, in vain.

    Attributes:
        spent: cost of all solved speeds.
        allowed: cost that may be lost.
    """

    def __init__(
        self, work: Discretisation, tasks: list[Task], say: Callable[[str], None],
        degree: int | None, lost: float,
    ) -> None:  # fmt: skip
        assert work.plan.sweep
        self._sweep = sweep = work.plan.sweep
        self._work, self._tasks, self._say, self._degree = work, tasks, say, degree
        self._alone = [self._cost(True, of) for of in work.plan.degrees]
        self.spent, self._lost, self.allowed = lost, lost, _REGRET * sum(self._alone)
        probes = sweep.g if sweep.few else np.linspace(sweep.g[0], sweep.g[-1], PROBES)
        self._probes = tasks[0].probes(probes)
        self._fit: Fit | None = None
        self._estimates: dict[float, Estimate] = {}

    def run(self) -> Trained | None:
        """Train the fit; it serves the solved speeds alone where it does not become good enough."""
        tasks, tolerance = self._tasks, self._work.plan.tolerance
        # The fastest needs the highest degree: it is solved first, by every rank for itself.
        chosen = [int(np.argmin([task.response.margin for task in tasks]))]
        self._take([self._solve(chosen[0], True)])
        self.spent += self._cost(True)  # it would be solved just so by itself
        worst: list[int] = []
        while len(chosen) < min(MOST, len(tasks) // 2):
            numbers = self._next(worst, chosen)
            if not numbers:
                break  # there is no other speed, or it would cost too much
            before, error = self._solved(numbers)
            chosen, worst = [*chosen, *numbers], []
            if len(self._estimates) > 1 and any(self._least(word) > tolerance for word in self._words):
                break  # no speed can be fitted to the tolerance
            if before and self._excess(error) <= 1.0:
                changes = {number: self._change(before, number) for number in self._changed(before)}
                error = {word: max(of[word] for of in (error, *changes.values())) for word in error}
                if self._excess(error) <= 1.0:
                    error = self._seconded(error, chosen)
                    if self._excess(error) <= 1.0:
                        return self._trained(error)
                worst = [max(changes, key=lambda number: self._excess(changes[number]))]
        return self.given_up()

    def given_up(self) -> Trained | None:
        """Fit that serves the solved speeds alone; None where no speed was solved."""
        self._say("no fit through speeds is good enough at its cost: each is solved")
        return self._trained(None) if self._fit else None

    def _trained(self, error: dict[str, float] | None) -> Trained:
        assert self._fit
        return Trained(self._fit, dict(sorted(self._estimates.items())), error)

    def _seconded(self, error: dict[str, float], chosen: list[int]) -> dict[str, float]:
        """Error of a good fit, after the discretisation's error was measured at more speeds.

        That measurement is put off until the fit is good, lest it be in vain.
        """
        while (missing := LADDERS - len(self._estimates)) > 0:
            more = self._far([], chosen)[:missing]
            if not more:
                break
            _, off = self._solved(dict.fromkeys(more, True))
            chosen += more
            error = {word: max(value, off.get(word, 0.0)) for word, value in error.items()}
        return error

    def _next(self, worst: list[int], chosen: list[int]) -> dict[int, bool]:
        """Numbers of the speeds to solve next: the worst one, and speeds far from all solved ones.

        Each maps to True where its error is to be measured: at the ends of the sweep, and elsewhere as
        far as the cost may be in vain. Speeds that would cost too much are left out.
        """
        lost, kept = self._lost, dict[int, bool]()
        for number in self._far(worst, chosen):
            measured = len(self._estimates) + sum(kept.values())
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

    def _cost(self, measures: bool, degree: int | None = None) -> float:
        """Cost of a speed at a degree, the fit's if None, with or without measuring its error."""
        degree = degree or self._degree
        assert degree
        solved = [p for p, _ in levels(degree, 1, fixed=False)] if measures else [degree]
        return float(sum(p**4 for p in solved))

    def _solved(self, numbers: dict[int, bool]) -> tuple[Barycentric | None, dict[str, float]]:
        """Solve speeds, shared out over the ranks, and take them in.

        Args:
            numbers: numbers of the speeds; True where the error is to be measured.

        Returns:
            The previous fit; its largest error at these speeds, by word, empty where there was no fit.
        """
        for number, measures in numbers.items():
            cost = self._cost(measures)
            self.spent, self._lost = self.spent + cost, self._lost + cost - self._alone[number]
        before = self._fit.rational if self._fit else None
        speeds = by_turns(
            list(numbers), lambda number: self._solve(number, numbers[number]),
            not self._work.plan.shared_speeds,
        )  # fmt: skip
        self._take(speeds)
        off = [speed.off for speed in speeds if speed.off]
        return before, {word: max(of[word] for of in off) for word in off[0]} if off else {}

    def _take(self, speeds: list[Speed]) -> None:
        assert self._fit
        if (degree := max(speed.degree for speed in speeds)) > self._fit.space.degree:
            raise _HigherDegree(degree)
        for speed in speeds:
            if speed.estimate:
                self._estimates[float(self._sweep.z[speed.number])] = speed.estimate
        self._fit.take(speeds)

    def _solve(self, number: int, measures: bool) -> Speed:
        """Solve a speed, with or without the measurement of its error."""
        work, task, fit = self._work, self._tasks[number], self._fit
        kind = PUNCHES[work.plan.mode]
        self._say(f"finite elements at c = {task.response.c:g}, of the fit")
        expected: list[Gauge] = []
        if fit and fit.rational:
            with fit.level(task) as predicted:
                expected = predicted.gauges(*self._probes)
        if measures:
            solved = climb(
                work, task, self._all, lambda space, g: kind(work, task, space, g),
                self._degree, DISCRETISATION,
            )  # fmt: skip
        else:
            assert fit
            level, done = kind(work, task, fit.space, self._all), WorkDone()
            done.count(level.factor)
            solved = Solved(level, None, size_of(fit.space) | vars(done))
        with closing(solved):
            level = solved.level
            degree = level.space.degree
            if not fit:
                fit = self._fit = Fit(
                    work, self._sweep, level.space, self._frictions(level), level.recovery
                )
                self._degree = degree
            fits = degree <= fit.space.degree
            off = largest_changes(level.gauges(*self._probes), expected) if fits and expected else {}
            error = solved.error
            estimate = Estimate(error.g, error.loads, error.errors) if error else None
            sample = fit.sampled(task, level) if fits else None
            return Speed(number, degree, sample, solved.record(), estimate, off)

    @property
    def _all(self) -> NDArray[np.float64]:
        """Frictions for which punches are solved: the probes, and all sets of frictions to try."""
        g = self._sweep.g
        if self._sweep.few:
            return g
        tried = [chebyshev_nodes(count, g[0], g[-1]) for count in _FRICTIONS]
        return np.unique(np.concatenate([self._probes[0], *tried]))

    def _frictions(self, level: PunchLevel) -> Barycentric:
        """As many frictions as give punches at those between them accurately."""
        g, punch, probes = self._sweep.g, level.punch, np.unique(self._probes[0])
        if self._sweep.few:
            return polynomial_through(g)
        forces = punch.forces[:, -1]
        true = np.moveaxis(punch.parts(probes) @ forces, 1, 0)
        for count in _FRICTIONS:
            at = polynomial_through(chebyshev_nodes(count, g[0], g[-1]))
            interpolated = at.shares(probes) @ np.moveaxis(punch.parts(at.nodes) @ forces, 1, 0)
            off = np.abs(interpolated - true).max(axis=(1, 2)) / np.abs(true).max(axis=(1, 2))
            if off.max() <= _BETWEEN:
                break
        return at

    @property
    def _words(self) -> list[str]:
        """Words of output.quantities whose errors are measured."""
        return list(next(iter(self._estimates.values())).errors)

    def _least(self, word: str) -> float:
        """Smallest error of the discretisation."""
        return float(min(estimate.errors[word].min() for estimate in self._estimates.values()))

    def _excess(self, error: dict[str, float]) -> float:
        """Largest error of the fit over its allowed value, among the words; infinite for no word."""
        tolerance = self._work.plan.tolerance
        each = [value / (FIT * max(tolerance, self._least(word))) for word, value in error.items()]
        return max(each, default=np.inf)

    def _changed(self, before: Barycentric) -> list[int]:
        """Numbers of the speeds whose fit changed most, a speed for each gap between solved ones."""
        fit = self._fit
        assert fit and fit.rational
        z, solved = self._sweep.z, np.sort(self._sweep.z[fit.solved])
        shares = fit.rational.shares(z)
        shares[:, : len(before.nodes)] -= before.shares(z)
        change = np.linalg.norm(shares @ rotated(fit.values), axis=1)
        change[fit.solved] = -1.0
        gap = np.searchsorted(solved, z)
        gaps = [np.flatnonzero(gap == index) for index in np.unique(gap)]
        worst = [int(numbers[change[numbers].argmax()]) for numbers in gaps]
        return [number for number in worst if change[number] >= 0.0]

    def _change(self, before: Barycentric, number: int) -> dict[str, float]:
        """Largest relative change of a speed's gauges with the last samples, by word."""
        assert self._fit
        gauges: list[list[Gauge]] = []
        for rational in (self._fit.rational, before):
            with self._fit.level(self._tasks[number], rational) as level:
                gauges.append(level.gauges(*self._probes))
        return largest_changes(*gauges)


def largest_changes(gauges: Sequence[Gauge], others: Sequence[Gauge]) -> dict[str, float]:
    """Largest relative difference of two lists of gauges, by word of output.quantities."""
    return {gauge.word: float(gauge.change(other).max()) for gauge, other in zip(gauges, others)}


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
