"""What a long run tells a user who waits in front of a terminal."""

import sys
from typing import Any

from app import ranks


class Progress:
    """Text, share done and remaining time on a terminal's error stream; silent elsewhere.

    Use it as a context manager.
    """

    def __init__(self) -> None:
        self._bar: Any = None
        self._task: Any = None

    def __enter__(self) -> "Progress":
        if ranks.is_root() and sys.stderr.isatty():
            from rich import progress
            from rich.console import Console

            self._bar = progress.Progress(
                progress.TextColumn("{task.description}"),
                progress.BarColumn(bar_width=20),
                progress.TaskProgressColumn(),
                progress.TimeRemainingColumn(),
                console=Console(stderr=True),
                transient=True,
            )
            self._task = self._bar.add_task("", total=None)
            self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar:
            self._bar.stop()

    def say(self, text: str) -> None:
        """What is being done now."""
        if self._bar:
            self._bar.update(self._task, description=text)

    def done(self, states: int, of: int) -> None:
        """So many states are finished."""
        if self._bar:
            self._bar.update(self._task, completed=states, total=of)
