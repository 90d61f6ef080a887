"""Wall time by step."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter


class Clock(dict[str, float]):
    """Seconds by name of the step, in the order in which steps first ended."""

    @contextmanager
    def __call__(self, step: str) -> Iterator[None]:
        """Add the time of a block to a step."""
        started = perf_counter()
        try:
            yield
        finally:
            self[step] = self.get(step, 0.0) + perf_counter() - started
