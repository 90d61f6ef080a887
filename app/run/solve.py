"""Solution of a plan's tasks: every method solves them, quantities are evaluated and compared."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.clock import Clock
from galinx.postprocess import compare
from galinx.postprocess.journal import Part
from galinx.postprocess.quantities import states
from galinx.postprocess.quantities.quantity import LOCAL
from galinx.postprocess.quantities.runs import RECORD
from galinx.solvers.contact.solution import Contact, Method, Places, Solver, Task
from galinx.solvers.errors import SolveError

from ..methods import METHODS
from ..plan.plan import Plan


@dataclass(frozen=True)
class Edges:
    """Friction and the local analysis of the punch's edges, all that needs no solution of states."""

    local: Any
    g: NDArray[np.float64]
    places: Places


@dataclass(frozen=True)
class Work:
    """Solution of a plan's tasks by all its methods.

    Attributes:
        plan: the plan.
        g: σ_XY/σ_YY of all states, (states,).
        methods: methods by name.
        clock: takes wall time by step.
        finished: True for states that need not be computed again, (states,).
    """

    plan: Plan
    g: NDArray[np.float64]
    methods: Mapping[str, Method]
    clock: Clock
    finished: NDArray[np.bool_]

    def begin(self) -> None:
        """Prepare the methods for all speeds; collective, before speeds are shared out over the ranks."""
        for method in self.methods.values():
            if hasattr(method, "begin"):
                method.begin()

    def to_do(self, task: Task) -> list[slice]:
        """Rows of a task's states that are still to be computed, chunk by chunk."""
        return [rows for rows in self.plan.chunks(task) if not self.finished[rows].all()]

    def parts(self, task: Task) -> Iterator[Part]:
        """Results at one speed.

        The last part has the speed's record: numbers by the names of ``quantities.runs.RECORD``, the
        ``speed``, and a ``failure`` where it could not be solved. Under some of its loads a contact may
        have no answer: the others are solved all the same.
        """
        failures: dict[str, str] = {}
        of_loads: dict[str, str] = {}
        different, solved = len(task.body.dissimilar(task.loads)) > 1, False
        with ExitStack() as stack:
            solvers: dict[str, Solver] = {}
            for name, method in self.methods.items():
                try:
                    if self._together(name, task):
                        solvers[name] = stack.enter_context(method.at(task, np.unique(task.of(self.g))))
                except SolveError as error:
                    failures[name] = str(error)
            last: Part | None = None
            for runs in self._batches(task):
                reasons = dict(failures)
                parts = list(self._parts(task, runs, solvers, reasons))
                if reasons != failures and different:
                    parts = []
                    for load, runs_of_load in self._by_load(runs):
                        reasons = dict(failures)
                        parts += self._parts(task, runs_of_load, solvers, reasons)
                        solved |= not reasons
                        for name in reasons.keys() - failures.keys() - of_loads.keys():
                            of_loads[name] = f"N = {load:g} N/m: {reasons[name]}"
                else:
                    failures = reasons
                    solved |= len(task.loads) > 1 and not reasons
                for part in parts:
                    if last:
                        yield last
                    last = part
            assert last
            yield replace(last, record=_record(task, solvers, of_loads | failures, solved))

    def of_states(self, task: Task, rows: NDArray[np.int64]) -> dict[str, NDArray]:
        """Quantities of states of a speed by path, without comparisons.

        Args:
            task: the speed.
            rows: indices of the states, (n,).

        Raises:
            SolveError: they could not be solved.
        """
        g, load = self.g[rows], None
        if len(task.loads) > 1:
            load = self.plan.load(rows)
        body = task.body.loaded(load)
        local = task.body.local_exponents(task.response, g, load)
        data = self._of(LOCAL, Edges(local, g, task.places), body)
        for name, method in self.methods.items():
            with ExitStack() as stack:
                solver = None
                if self._together(name, task):
                    solver = stack.enter_context(method.at(task, np.unique(g)))
                data |= self._read(name, solver, task, g, load)
        return data

    def _by_load(self, runs: Sequence[slice]) -> Iterator[tuple[float, list[slice]]]:
        """Runs of states, cut so that each has a single load, with that load [N/m]."""
        for rows in runs:
            loads = self.plan.load(rows)
            first = np.flatnonzero(np.diff(loads, prepend=np.nan)).tolist()
            for start, stop in zip(first, [*first[1:], len(loads)]):
                yield float(loads[start]), [slice(rows.start + start, rows.start + stop)]

    def _batches(self, task: Task) -> list[list[slice]]:
        """Rows that are still to be computed, in batches of at most a chunk."""
        batches: list[list[slice]] = []
        room = 0
        for rows in self.to_do(task):
            count = rows.stop - rows.start
            if not batches or count > room:
                batches.append([])
                room = self.plan.chunk
            batches[-1].append(rows)
            room -= count
        return batches

    def _together(self, name: str, task: Task) -> bool:
        """True where a single solver takes the states of a method under all loads."""
        return len(task.loads) == 1 or METHODS[name].loads

    def _parts(
        self, task: Task, runs: Sequence[slice], solvers: Mapping[str, Solver], failures: dict[str, str]
    ) -> Iterator[Part]:
        """Results of runs of states, which are solved together."""
        g, load = np.concatenate([self.g[rows] for rows in runs]), None
        if len(task.loads) > 1:
            load = np.concatenate([self.plan.load(rows) for rows in runs])
        body = task.body.loaded(load)
        with self.clock(_STEPS["closed_form"]):
            local = task.body.local_exponents(task.response, g, load)
            data = self._of(LOCAL, Edges(local, g, task.places), body)
        for name in self.methods:
            try:
                if name not in failures:
                    with self.clock(_STEPS.get(name, name)):
                        data |= self._read(name, solvers.get(name), task, g, load)
            except SolveError as error:
                failures[name] = str(error)
            if name in failures:
                data |= self._unknown(name, len(g))
        with self.clock("comparison"):
            for quantity in self.plan.quantities:
                if quantity.of_data:
                    data[quantity.path] = quantity.of_data(data)
            first = 0
            for rows in runs:
                own = slice(first, first + rows.stop - rows.start)
                of_run = {path: values[own] for path, values in data.items()}
                N = body.load if load is None else load[own]
                compared = [] if failures else self._compared(of_run, g[own], N)
                yield Part(rows, of_run, compared, None)
                first = own.stop

    def _read(
        self, name: str, solver: Solver | None, task: Task, g: NDArray, load: NDArray | None
    ) -> dict[str, NDArray]:
        """Quantities of states by one method, by path; if no solver is given, each load has its own."""
        if solver is not None:
            loads = (load,) if METHODS[name].loads else ()
            return self._of(name, solver.states(g, *loads), task.body.loaded(load))
        assert load is not None
        data = self._unknown(name, len(g))
        for N in np.unique(load).tolist():
            rows_of_load = np.flatnonzero(load == N)
            alone = replace(task, body=task.body.loaded(N), loads=(N,))
            with self.methods[name].at(alone, np.unique(g[rows_of_load])) as solver_of_load:
                for path, values in self._of(
                    name, solver_of_load.states(g[rows_of_load]), alone.body
                ).items():
                    data[path][rows_of_load] = values
        return data

    def _of(self, method: str, solution: Any, body: Contact) -> dict[str, NDArray]:
        return {
            quantity.path: quantity.of(solution, body)
            for quantity in self.plan.quantities
            if quantity.of and quantity.method == method
        }

    def _unknown(self, method: str, states: int) -> dict[str, NDArray]:
        return {
            quantity.path: np.full((states, *self.plan.shape(quantity)), np.nan)
            for quantity in self.plan.quantities
            if quantity.method == method
        }

    def _compared(self, data: dict[str, NDArray], g: NDArray, load: Any) -> list[compare.Comparison]:
        given = {states.RATIO.path: g} | self.plan.positions
        return compare.comparisons(data | given, load, self.plan.rules)


#: Clock's step for the evaluation of a method's solutions, by method.
_STEPS = {"fem": "recovery", "closed_form": "closed form"}


def _record(
    task: Task, solvers: Mapping[str, Solver], reasons: Mapping[str, str], solved: bool
) -> dict[str, Any] | None:
    """Numbers of the work at a speed, None where no method has any.

    Args:
        task: the speed.
        solvers: of its states, by method.
        reasons: why states could not be solved, by method.
        solved: True where states under another load were solved.
    """
    speed: dict[str, Any] = {"speed": task.number, "c": task.response.c}
    numbers: dict[str, Any] = {}
    if solved or not reasons:
        numbers = {key: value for solver in solvers.values() for key, value in solver.record().items()}
    if reasons:
        failure = {"failure": "; ".join(reasons.values()), "solved": solved}
        return dict.fromkeys(RECORD, 0.0) | numbers | speed | failure
    return numbers | speed if numbers else None
