"""Solution of a plan's tasks: every method solves them, quantities are evaluated and compared."""

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, nullcontext
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.clock import Clock
from galinx.postprocess import compare
from galinx.postprocess.journal import Part
from galinx.postprocess.quantities import states
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, LOCAL
from galinx.postprocess.quantities.quantity import METHODS as IN_WORDS
from galinx.postprocess.quantities.runs import RECORD
from galinx.solvers.contact.solution import Contact, Method, Solver, Task
from galinx.solvers.errors import NoContact, SolveError

from ..errors import BadInput
from ..methods import METHODS
from ..plan.plan import Plan

#: Solver of a method's states at a speed, None where each load has its own, or the failure in its place.
_OfSpeed = Solver | NoContact | None


def _step(method: str, evaluated: bool = False) -> str:
    """Name of the step of the clock in which a method solves a speed, or evaluates its solutions."""
    return "recovery" if evaluated and method == FEM else IN_WORDS.get(method, method)


@dataclass(frozen=True)
class Work:
    """Solution of a plan's tasks by all its methods.

    Attributes:
        plan: the plan.
        g: σ_XY/σ_YY of all states of the archive, (states,).
        load: load of each of them [N/m], (states,); None where all have that of the plan.
        methods: methods by name.
        clock: takes wall time by step.
        finished: True for states that need not be computed again, (states,).
    """

    plan: Plan
    g: NDArray[np.float64]
    load: NDArray[np.float64] | None
    methods: Mapping[str, Method]
    clock: Clock
    finished: NDArray[np.bool_]

    def begin(self) -> None:
        """Prepare the methods for all speeds; collective, before speeds are shared out over the ranks."""
        for name, method in self.methods.items():
            if hasattr(method, "begin"):
                with self.clock(_step(name)):
                    method.begin()

    def batches(self, task: Task) -> list[list[slice]]:
        """Rows of a task's states that are still to be computed, in batches of at most a chunk."""
        batches: list[list[slice]] = []
        room, most = 0, self.plan.chunk
        pieces = (
            slice(first, min(first + most, run.stop))
            for run in task.runs
            for first in range(run.start, run.stop, most)
        )
        for rows in pieces:
            count = rows.stop - rows.start
            if self.finished[rows].all():
                continue
            if not batches or count > room:
                batches.append([])
                room = most
            batches[-1].append(rows)
            room -= count
        return batches

    def parts(self, task: Task) -> Iterator[Part]:
        """Results at one speed.

        The last part has the speed's record: numbers by the names of ``quantities.runs.RECORD``, the
        ``speed``, and a ``failure`` where it could not be solved. Under some of its loads a contact may
        have no answer: the others are solved all the same.
        """
        reasons: dict[str, str] = {}
        last, any_solved = None, any(self.finished[run].any() for run in task.runs)
        with ExitStack() as stack:
            solvers = self._solvers(task, task.of(self.g), stack, reasons)
            for runs in self.batches(task):
                rows = np.concatenate([np.arange(run.start, run.stop) for run in runs])
                data, solved, partly = self._solve(task, rows, solvers, reasons)
                any_solved |= partly
                with self.clock("comparison"):
                    for quantity in self.plan.quantities:
                        if quantity.of_data:
                            data[quantity.path] = quantity.of_data(data)
                    compared = self._compared(data, rows, solved) if solved.any() else {}
                first, whole = 0, bool(solved.all())
                for run in runs:
                    own = slice(first, first := first + run.stop - run.start)
                    if last:
                        yield last
                    last = Part(run, {path: of[own] for path, of in data.items()}, compared, None, whole)
                    compared = {}  # that of the whole batch
            assert last
            yield replace(last, record=self._record(task, solvers, reasons, any_solved))

    def of_states(self, task: Task, rows: NDArray[np.int64]) -> dict[str, NDArray]:
        """Quantities of states of a speed by path, without comparisons and what follows from others.

        Args:
            task: the speed.
            rows: of the states, (n,).

        Raises:
            SolveError: they could not be solved.
        """
        reasons: dict[str, str] = {}
        with ExitStack() as stack:
            solvers = self._solvers(task, self.g[rows], stack, reasons)
            data, *_ = self._solve(task, rows, solvers, reasons)
        if reasons:
            raise SolveError("; ".join(reasons.values()))
        return data

    def _solvers(
        self, task: Task, g: NDArray, stack: ExitStack, reasons: dict[str, str]
    ) -> dict[str, _OfSpeed]:
        """Solvers of the speed by method, None for a method of which each load has its own.

        Where a contact is too wide for the punch, its failure stands for the solver: other states may
        have an answer. Methods that fail otherwise are left out, and ``reasons`` gets why.
        """
        solvers: dict[str, _OfSpeed] = {}
        for name, method in self.methods.items():
            try:
                together = self.load is None or METHODS[name].loads
                with self.clock(_step(name)):
                    solvers[name] = (
                        stack.enter_context(method.at(task, np.unique(g))) if together else None
                    )
            except NoContact as error:
                solvers[name] = error
            except SolveError as error:
                reasons[name] = str(error)
        return solvers

    def _solve(
        self, task: Task, rows: NDArray[np.int64], solvers: Mapping[str, _OfSpeed],
        reasons: dict[str, str],
    ) -> tuple[dict[str, NDArray], NDArray[np.bool_], bool]:  # fmt: skip
        """Quantities of states by path, NaN where a method fails; where all solve them; if any does."""
        g, load = self.g[rows], None if self.load is None else self.load[rows]
        g.flags.writeable = False  # for quantities of the user's
        solved = np.ones(len(g), dtype=bool)
        data: dict[str, NDArray] = {}
        partly = not self.methods
        for name in self.methods:
            if name not in solvers:
                data, solved = data | self._unknown(name, len(g)), np.zeros_like(solved)
                continue
            with self.clock(_step(name, evaluated=True)):
                values, own, why = self._by(name, solvers[name], task, g, load)
            data, solved, partly = data | values, solved & own, partly or bool(own.any())
            if why:
                reasons.setdefault(name, why)
        with self.clock(_step(CLOSED_FORM)):
            local = task.body.local_exponents(task.response, g, load)
            # Without a solution of states; contacts that methods solved are known by now.
            of_edges = SimpleNamespace(
                local=local, g=g, places=task.places, response=task.response,
                half_width=task.body.half_widths(task.response, g, load),
            )  # fmt: skip
            data |= self._of(LOCAL, of_edges, task.body.loaded(load), len(g))
        return data, solved, partly

    def _by(
        self, name: str, solver: _OfSpeed, task: Task, g: NDArray, load: Any
    ) -> tuple[dict[str, NDArray], NDArray[np.bool_], str]:
        """Quantities by a method, where it solves, (states,), and why it does not elsewhere.

        States that have no answer together are tried again, load by load. Where contacts of a load are
        too wide for the punch, they are tried half by half of its frictions.
        """
        takes, loads = METHODS[name].loads, [] if load is None else np.unique(load).tolist()
        failure: SolveError | None = None
        if isinstance(solver, NoContact):
            solver, failure = None, solver
        elif solver or len(loads) < 2:
            body = task.body.loaded(load if takes or load is None else loads[0])
            try:
                with self._solver(name, solver, task, g, loads) as own:
                    solution = own.states(g, load) if takes else own.states(g)
                    return self._of(name, solution, body, len(g)), np.ones(len(g), dtype=bool), ""
            except SolveError as error:
                failure = error
        frictions = np.unique(g)
        if len(loads) > 1 and not (failure and task.body.alike):
            parts = [load == N for N in loads]
        elif len(frictions) > 1 and isinstance(failure, NoContact):
            lower = g < frictions[len(frictions) // 2]
            parts = [lower, ~lower]
        else:
            where = f"N = {loads[0]:g} N/m: " if loads and not task.body.alike else ""
            return self._unknown(name, len(g)), np.zeros(len(g), dtype=bool), f"{where}{failure}"
        data, solved, why = self._unknown(name, len(g)), np.zeros(len(g), dtype=bool), ""
        for rows in parts:
            of_rows = None if load is None else load[rows]
            values, solved[rows], of_part = self._by(name, solver, task, g[rows], of_rows)
            why = why or of_part
            for path in values:
                data[path][rows] = values[path]
        return data, solved, why

    def _solver(
        self, name: str, solver: Solver | None, task: Task, g: NDArray, loads: list[float]
    ) -> AbstractContextManager[Any]:
        """The solver of a speed, or one that a method makes for states with these frictions and loads."""
        if solver:
            return nullcontext(solver)
        if loads:
            body = task.body.loaded(loads[0])
            task = replace(task, body=body, response=body.response(task.response.c), loads=tuple(loads))
        return self.methods[name].at(task, np.unique(g))

    def _of(self, method: str, solution: Any, body: Contact, states: int) -> dict[str, NDArray]:
        """Quantities of a method's states by path.

        Raises:
            BadInput: a quantity of the user's has another shape than it says.
        """
        data = {}
        for quantity in self.plan.quantities:
            if quantity.of and quantity.method == method:
                # A copy: what a quantity of the user's changes is its own.
                data[quantity.path] = values = np.array(quantity.of(solution, body), dtype=float)
                expected = states, *self.plan.shape(quantity)
                if values.shape != expected:
                    raise BadInput(
                        f"the quantity {quantity.path!r} has the shape {values.shape}, expected "
                        f"{expected}, {' x '.join(quantity.over)}"
                    )
        return data

    def _unknown(self, method: str, states: int) -> dict[str, NDArray]:
        return {
            quantity.path: np.full((states, *self.plan.shape(quantity)), np.nan)
            for quantity in self.plan.quantities
            if quantity.of and quantity.method == method
        }

    def _compared(
        self, data: dict[str, NDArray], rows: NDArray[np.int64], solved: NDArray[np.bool_]
    ) -> dict[str, float]:
        """Comparisons over the states that are solved."""
        good = {path: values[solved] for path, values in data.items()} if not solved.all() else data
        load = self.plan.body.load if self.load is None else self.load[rows[solved]]
        given = {states.RATIO.path: self.g[rows[solved]]} | self.plan.positions
        return compare.comparisons(good | given, load, self.plan.rules)

    def _record(
        self, task: Task, solvers: Mapping[str, _OfSpeed], reasons: Mapping[str, str], solved: bool
    ) -> dict[str, Any] | None:
        """Numbers of the work at a speed, None where no method has any.

        Args:
            task: the speed.
            solvers: of its states, by method.
            reasons: why states could not be solved, by method.
            solved: True where some states were solved by a method.
        """
        speed: dict[str, Any] = {"speed": self.plan.speed + task.number, "c": task.response.c}
        numbers: dict[str, Any] = {}
        for solver in solvers.values() if solved or not reasons else ():
            if solver and not isinstance(solver, NoContact):
                numbers |= solver.record()
        if reasons:
            of_variant = f", {self.plan.scene.variant}" if self.plan.scene.swept else ""
            failure = {"failure": "; ".join(reasons.values()) + of_variant, "solved": solved}
            return dict.fromkeys(RECORD, 0.0) | numbers | speed | failure
        return numbers | speed if numbers else None
