"""Who takes results where they go."""

from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app import ranks
from galinx.app.console.progress import Progress
from galinx.app.plan.task import Plan
from galinx.app.run.judge import Judge
from galinx.app.run.sinks import Sink
from galinx.clock import Clock
from galinx.postprocess.journal import Journal, Part, joined
from galinx.postprocess.quantities.runs import CHANGES, FAILURES, RECORD
from galinx.solvers.errors import SolveError

#: Seconds after which small parts wait no longer for others: so much is lost at most.
_PATIENCE = 1.0

#: What the time is told as.
_STEP = "archive"


class Collector:
    """Takes finished parts in: judges, writes and keeps them.

    Args:
        sink: where results go.
        judge: is shown the comparisons.
        progress: is told what is done.
        journal: keeps parts; None for no journal.
        plan: the plan that is followed.
        clock: takes the time spent here.
    """

    def __init__(
        self,
        sink: Sink,
        judge: Judge,
        progress: Progress,
        journal: Journal | None,
        plan: Plan,
        clock: Clock,
    ) -> None:
        self._sink, self._judge, self._progress, self._plan = sink, judge, progress, plan
        self._journal, self._clock, self._done = journal, clock, 0
        self._small: list[Part] = []
        self._kept = perf_counter()
        self._records: dict[int, dict[str, Any]] = {}
        for quantity in plan.quantities:
            sink.reserve(quantity.path, (plan.states, *plan.shape(quantity)))

    def earlier(self) -> NDArray[np.bool_]:
        """Take in what the journal has; which states those are, (states,)."""
        found = np.zeros(self._plan.states, dtype=bool)
        if self._journal and self._journal.damaged:
            self._progress.warn(f"kept parts that are damaged: {self._journal.damaged}; computed again")
        for part in self._journal.parts() if self._journal else ():
            found[part.rows] = True
            self._take(part)
        return found

    def take(self, part: Part) -> None:
        """Take in a part that was just computed; a failure is tried again by a run that goes on."""
        if not ranks.is_root():
            return  # all ranks share one mesh and have the same results
        if "failure" in (part.record or {}):
            self._keep()
            self._take(part)
            return
        if self._small and self._small[-1].rows.stop != part.rows.start:
            self._keep()
        self._small.append(part)
        states = part.rows.stop - self._small[0].rows.start
        if part.record or states >= self._plan.chunk or perf_counter() - self._kept > _PATIENCE:
            self._keep()

    def _keep(self) -> None:
        """Keep the parts that wait, as one: a file a part, and a look at the archive, take their time."""
        if self._small:
            with self._clock(_STEP):
                part = joined(self._small)
                if self._journal:
                    self._journal.keep(part)
            self._small = []
            self._take(part)
        self._kept = perf_counter()

    def _take(self, part: Part) -> None:
        self._judge.see(part.comparisons)
        self._judge.validity.see(part.data)
        with self._clock(_STEP):
            for name, values in part.data.items():
                self._sink.write(name, part.rows, values)
        if part.record:
            self._records[part.record["speed"]] = part.record
        self._done += part.rows.stop - part.rows.start
        self._progress.done(self._done, self._plan.states)

    def finish(self) -> None:
        """Write the records of the speeds.

        Raises:
            SolveError: no speed could be solved.
        """
        if not ranks.is_root():
            return
        self._keep()
        records = [self._records[i] for i in sorted(self._records)]
        failures = [
            f"c = {record['c']:g}: {record['failure']}" for record in records if "failure" in record
        ]
        if len(failures) == len(self._plan.tasks) and not any(one.get("solved") for one in records):
            raise SolveError(failures[0])
        self._judge.failures = failures
        if self._plan.fem or failures:
            self._sink.put(FAILURES.path, failures)
        if not self._plan.fem:
            return
        for name, quantity in RECORD.items():
            values = np.array([record[name] for record in records], quantity.type)
            self._sink.put(quantity.path, values)
        changes = [record.get("change_by_degree", []) for record in records]
        if longest := max(map(len, changes)):
            padded = [change + [0.0] * (longest - len(change)) for change in changes]
            self._sink.put(CHANGES.path, np.array(padded))
