"""What a long run tells: a bar on a terminal, lines for who wants them, a log file."""

import logging
import os
import sys
from pathlib import Path
from typing import Any

from galinx import files
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
            self._add(_LogFile(self._log), "%(asctime)s %(message)s")
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

    def warn(self, text: str) -> None:
        """What everybody should know, at once and whatever rank found it."""
        told = f"warning: {plain(text)}"
        if self._bar:
            self._bar.console.print(told, markup=False, highlight=False, soft_wrap=True)
        elif not self._verbose:
            print(told, file=sys.stderr, flush=True)
        self.note(told)

    def done(self, count: float, of: int, what: str = "states") -> None:
        """So many of them are finished; a share of one moves the bar, and a line tells its tenths."""
        if self._bar:
            self._bar.update(self._task, completed=count, total=of)
        self.note(f"{int(10.0 * count + 1e-9) / 10.0:g} of {of} {what}")

    def _add(self, handler: logging.Handler, form: str) -> None:
        handler.setFormatter(logging.Formatter(form))
        self._logger.addHandler(handler)


class _LogFile(logging.Handler):
    """Adds lines to a file; a disk that becomes full ends the log, not the run.

    Args:
        path: the file; one that is there is added to.

    Raises:
        MachineFailure: it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._path, self._full = path, False
        try:
            handle = files.open_file(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
        except OSError as error:
            raise MachineFailure(f"cannot write the log {path}: {error.strerror}") from None
        self._file = open(handle, "ab", buffering=0)  # noqa: SIM115 - closed by close

    def emit(self, record: logging.LogRecord) -> None:
        if self._full:
            return
        line, start = memoryview(f"{self.format(record)}\n".encode()), self._file.seek(0, os.SEEK_END)
        try:
            while line:  # a disk that becomes full takes a part
                line = line[self._file.write(line) :]
        except OSError as error:
            self._full = True
            self._file.truncate(start)
            print(f"warning: the log {self._path} ends here: {error.strerror}", file=sys.stderr)

    def close(self) -> None:
        self._file.close()
        super().close()


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
