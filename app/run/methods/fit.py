"""A fit through speeds that were solved: one rational function for all numbers of a punch's parts."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.sweep import Sweep
from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.ladder import WorkDone
from galinx.postprocess.quantities.strata import AT_INTERFACES
from galinx.postprocess.quantities.stresses import BELOW, YIELD
from galinx.solvers.fem.fitted import (
    FittedPunch,
    Frictions,
    Sampled,
    Singular,
    sampled,
    together,
)
from galinx.solvers.fem.space import Space
from galinx.solvers.rational import Rational, fitted, polynomial_weights
from galinx.solvers.sie.closed_form import FlatPunch

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
    mode: ModuleType
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
            yield self.mode.Level(self.work, task, self.space, self.at.g, punch, self.recovery)
        finally:
            punch.destroy()

    def record(self, number: int) -> dict[str, Any]:
        """Numbers of the work at a speed; none was done where it is fitted."""
        space = self.space
        size = {"cells": space.cells, "unknowns": space.size, "degree": space.degree}
        return self.records.get(number) or size | vars(WorkDone())
