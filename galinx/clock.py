"""Wall time by step."""

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter


class Clock(dict[str, float]):
    """Seconds by name of the step; they add up to the time since the clock was made.

    Time of a step within another counts for the inner one only. Time of no step counts for ``rest``.

    Args:
        rest: name of the rest.
        seconds: of the rest before the clock was made.
    """

    def __init__(self, rest: str = "other", seconds: float = 0.0) -> None:
        super().__init__()
        self._steps, self._since = [rest], perf_counter() - seconds

    @contextmanager
    def __call__(self, step: str) -> Iterator[None]:
        """Add the time of a block to a step."""
        self.lap()
        self._steps.append(step)
        try:
            yield
        finally:
            self.lap()
            self._steps.pop()

    def lap(self) -> None:
        """Add the time since the last lap to the step that is being done."""
        now, step = perf_counter(), self._steps[-1]
        self[step] = self.get(step, 0.0) + now - self._since
        self._since = now


def age() -> float:
    """Seconds since this process was started, before it became Python; 0 where that is unknown."""
    try:
        fields = Path("/proc/self/stat").read_text(encoding="ascii", errors="replace")
        started = int(fields.rpartition(")")[2].split()[19]) / os.sysconf("SC_CLK_TCK")
        return max(0.0, time.clock_gettime(time.CLOCK_BOOTTIME) - started)
    except (OSError, ValueError, AttributeError, IndexError):
        return 0.0
