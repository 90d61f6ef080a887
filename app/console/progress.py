"""What a long run tells: a bar on a terminal, lines for who wants them, a log file."""

import logging
import sys
from pathlib import Path
from typing import Any

from galinx.app import ranks
from galinx.app.console.streams import bare, plain
from galinx.app.errors import MachineFailure

#: Level of what is told: above INFO, which is muted because the form compiler floods it.
_NOTE = logging.INFO + 5


class Progress:
    """Text, share done and remaining time on a terminal's error stream; silent elsewhere.

    Use it as a context manager.

    Args:
        quiet: no bar.
        verbose: every step as a line on the error stream, instead of a bar.
        log: file that every step is added to, with its time.

    Raises:
        MachineFailure: the log file cannot be written.
    """

    def __init__(self, quiet: bool = False, verbose: bool = False, log: Path | None = None) -> None:
        self._quiet, self._verbose, self._log = quiet, verbose, log
        self._bar: Any = None
        self._task: Any = None
        self._last = ""
        self._logger = logging.Logger("galinx", _NOTE)

    def __enter__(self) -> "Progress":
        if not ranks.is_root():
            return self
        if self._verbose:
            self._add(logging.StreamHandler(sys.stderr), "%(message)s")
        elif not self._quiet and sys.stderr.isatty():
            self._bar, self._task = _start_bar()
        if self._log:
            try:
                self._add(logging.FileHandler(self._log, encoding="utf-8"), "%(asctime)s %(message)s")
            except OSError as error:
                raise MachineFailure(f"cannot write the log {self._log}: {error.strerror}") from None
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar:
            self._bar.stop()
        for handler in self._logger.handlers:
            handler.close()

    def say(self, text: str) -> None:
        """What is being done now."""
        if self._bar:
            self._bar.update(self._task, description=plain(text))
        self.note(text)

    def note(self, text: str) -> None:
        """For those who listen closely: verbose runs and log files."""
        if text != self._last:
            self._logger.log(_NOTE, "%s", plain(text))
            self._last = text

    def done(self, count: int, of: int, what: str = "states") -> None:
        """So many of them are finished."""
        if self._bar:
            self._bar.update(self._task, completed=count, total=of)
        self.note(f"{count} of {of} {what}")

    def _add(self, handler: logging.Handler, form: str) -> None:
        handler.setFormatter(logging.Formatter(form))
        self._logger.addHandler(handler)


def _start_bar() -> tuple[Any, Any]:
    from rich import progress
    from rich.console import Console

    bar = progress.Progress(
        progress.TextColumn("{task.description}", markup=False),
        progress.BarColumn(bar_width=20),
        progress.TaskProgressColumn(),
        progress.TimeRemainingColumn(),
        console=Console(file=bare(sys.stderr)),
        transient=True,
        # What is printed meanwhile goes its own way: rich would take its control characters for colours.
        redirect_stdout=False,
        redirect_stderr=False,
    )
    task = bar.add_task("", total=None)
    bar.start()
    return bar, task
