"""Where results go, and who takes them there."""

from time import perf_counter
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from galinx.app import ranks
from galinx.app.console.progress import Progress
from galinx.app.plan.plan import RECORD, Plan
from galinx.app.run.judge import Judge
from galinx.postprocess.journal import Journal, Part
from galinx.solvers.errors import SolveError


class Sink(Protocol):
    """Where results go: an archive in the making, or memory."""

    def put(self, name: str, value: Any) -> None:
        """A whole dataset."""

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        """Room for a dataset that comes by rows."""

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        """Rows of a reserved dataset."""


class Memory(dict[str, Any]):
    """A sink that keeps the datasets by path, as an archive would give them back."""

    def put(self, name: str, value: Any) -> None:
        self[name] = np.array(value, dtype=object) if isinstance(value, list) else value

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        self[name] = np.full(shape, np.nan)

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        self[name][rows] = values


class Nowhere:
    """The sink of ranks other than 0."""

    def put(self, name: str, value: Any) -> None:
        pass

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        pass

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        pass


class Collector:
    """Takes finished parts in: judges, writes and keeps them.

    Attributes:
        records: of the speeds that are complete, by number.
        seconds: wall time spent here.
    """

    def __init__(
        self, sink: Sink, judge: Judge, progress: Progress, journal: Journal | None, states: int
    ) -> None:
        self.sink, self.judge, self.progress = sink, judge, progress
        self.records: dict[int, dict[str, Any]] = {}
        self.seconds = 0.0
        self._journal, self._states, self._done = journal, states, 0

    def earlier(self) -> frozenset[int]:
        """Take in what the journal has; first rows of those parts."""
        found = set()
        for part in self._journal.parts() if self._journal else ():
            found.add(part.rows.start)
            self._take(part)
        return frozenset(found)

    def take(self, part: Part) -> None:
        """Take in a part that was just computed; a failure is tried again by a run that goes on."""
        if not ranks.is_root():
            return  # all ranks share one mesh and have the same results
        if self._journal and "failure" not in (part.record or {}):
            self._journal.keep(part)
        self._take(part)

    def _take(self, part: Part) -> None:
        started = perf_counter()
        self.judge.see(part.comparisons)
        for name, values in part.data.items():
            self.sink.write(name, part.rows, values)
        if part.record:
            self.records[part.record["speed"]] = part.record
        self._done += part.rows.stop - part.rows.start
        self.progress.done(self._done, self._states)
        self.seconds += perf_counter() - started

    def finish(self, plan: Plan) -> None:
        """Write the records of the speeds.

        Raises:
            SolveError: no speed could be solved.
        """
        if not plan.fem or not ranks.is_root():
            return
        records = [self.records[i] for i in sorted(self.records)]
        failures = [
            f"c = {record['c']:g}: {record['failure']}" for record in records if "failure" in record
        ]
        if len(failures) == len(plan.speeds):
            raise SolveError(failures[0])
        self.judge.failures = failures
        self.sink.put("run/failures", failures)
        for name in RECORD:
            self.sink.put(f"run/fem/{name}", np.array([record[name] for record in records]))
        changes = [record.get("change_by_degree", []) for record in records]
        if longest := max(map(len, changes)):
            padded = [change + [0.0] * (longest - len(change)) for change in changes]
            self.sink.put("run/fem/change_by_degree", np.array(padded))
