"""From tasks to parts: every method answers, quantities are read off the answers and compared."""

from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Plan, Task
from galinx.app.run.methods.method import Method, Solver
from galinx.clock import Clock
from galinx.postprocess import compare
from galinx.postprocess.journal import Part
from galinx.postprocess.quantities import states
from galinx.postprocess.quantities.quantity import LOCAL
from galinx.postprocess.quantities.runs import RECORD
from galinx.solvers.errors import SolveError
from galinx.solvers.sie.found import local_exponents


@dataclass(frozen=True)
class Edges:
    """What is known of states without solving them: the local analysis of the punch's edges."""

    local: Any


@dataclass(frozen=True)
class Work:
    """What solves the tasks of a plan.

    Attributes:
        plan: the plan.
        g: σ_XY/σ_YY of all states, (states,).
        methods: by name.
        clock: takes wall time by step.
        finished: which states need not be computed again, (states,).
    """

    plan: Plan
    g: NDArray[np.float64]
    methods: Mapping[str, Method]
    clock: Clock
    finished: NDArray[np.bool_]

    def to_do(self, task: Task) -> list[slice]:
        """Rows that are still to be computed."""
        return [rows for rows in self.plan.chunks(task) if not self.finished[rows].all()]

    def parts(self, task: Task) -> Iterator[Part]:
        """Results at one speed.

        The last part has the speed's record: numbers by the names of ``quantities.runs.RECORD``, the
        ``speed``, and a ``failure`` where it could not be solved.
        """
        failures: dict[str, str] = {}
        with ExitStack() as stack:
            solvers: dict[str, Solver] = {}
            for name, method in self.methods.items():
                try:
                    solvers[name] = stack.enter_context(method.at(task, np.unique(self.g[task.rows])))
                except SolveError as error:
                    failures[name] = str(error)
            *others, last = self.to_do(task)
            for rows in others:
                yield self._part(task, rows, solvers, failures)
            part = self._part(task, last, solvers, failures)
            yield replace(part, record=_record(task, solvers, failures))

    def _part(
        self, task: Task, rows: slice, solvers: Mapping[str, Solver], failures: dict[str, str]
    ) -> Part:
        g = self.g[rows]
        with self.clock(_STEPS["closed_form"]):
            body = task.body
            local = local_exponents(task.response, g, body.profile, body.compression)
            data = self._read(LOCAL, Edges(local), task)
        for name in self.methods:
            try:
                if name not in failures:
                    with self.clock(_STEPS.get(name, name)):
                        data |= self._read(name, solvers[name].states(g), task)
            except SolveError as error:
                failures[name] = str(error)
            if name in failures:
                data |= self._unknown(name, len(g))
        with self.clock("comparison"):
            for quantity in self.plan.quantities:
                if quantity.of_data:
                    data[quantity.path] = quantity.of_data(data)
            return Part(rows, data, [] if failures else self._compared(data, g), None)

    def _read(self, method: str, solution: Any, task: Task) -> dict[str, NDArray]:
        return {
            quantity.path: quantity.of(solution, task.body)
            for quantity in self.plan.quantities
            if quantity.of and quantity.method == method
        }

    def _unknown(self, method: str, states: int) -> dict[str, NDArray]:
        return {
            quantity.path: np.full((states, *self.plan.shape(quantity)), np.nan)
            for quantity in self.plan.quantities
            if quantity.method == method
        }

    def _compared(self, data: dict[str, NDArray], g: NDArray) -> list[compare.Comparison]:
        given = {states.RATIO.path: g} | self.plan.positions
        return compare.comparisons(data | given, self.plan.body.load, self.plan.rules)


#: What the time to read a method's solutions is told as.
_STEPS = {"fem": "recovery", "closed_form": "closed form"}


def _record(
    task: Task, solvers: Mapping[str, Solver], failures: Mapping[str, str]
) -> dict[str, Any] | None:
    """Numbers of the work at a speed, None where no method has any."""
    speed = {"speed": task.number, "c": task.response.c}
    if failures:
        nothing = dict.fromkeys(RECORD, 0.0)
        return nothing | speed | {"failure": "; ".join(failures.values())}
    done = {key: value for solver in solvers.values() for key, value in solver.record().items()}
    return done | speed if done else None
