"""Text of the program on a terminal: its progress while it works, and tables, verdict and times at the
end.

All text goes to the terminal here: control characters that would command it are written out instead.
Progress is a bar on a terminal, lines on the error stream on request, and a log file. Commands are named
as the user called the program, ``./run.sh`` or ``galinx``.
"""

import io
import json
import logging
import os
import re
import shutil
import sys
import textwrap
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from shlex import quote
from typing import Any

from galinx.clock import Clock
from galinx.texts import UNSEEN

from . import ranks
from .errors import MachineFailure


def width() -> int:
    """Columns of the terminal, 80 where it is none; never so few that nothing could be read."""
    return max(shutil.get_terminal_size().columns, 40)


def plain(text: str) -> str:
    r"""A text whose control characters but tabs and ends of lines are written out, ESC as ``\u001b``."""
    return UNSEEN.sub(lambda of: of[0] if of[0] in "\t\n" else f"\\u{ord(of[0]):04x}", text)


class Output(io.FileIO):
    """The output below Python's buffers: where it cannot be written, the message names it."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            raise
        except OSError as error:
            raise OSError(
                f"cannot write the output: {error.strerror}; make room, or send it elsewhere"
            ) from None


class PlainStream:
    """A text stream to which plain text only is written.

    Args:
        bare: stream below, also for texts with control characters of their own.
    """

    def __init__(self, bare: Any) -> None:
        self.bare = bare

    def write(self, text: str) -> int:
        self.bare.write(plain(text))
        return len(text)

    def writelines(self, lines: list[str]) -> None:
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.bare, name)


def bare(stream: Any) -> Any:
    """Stream below, for colours and bars; other texts have to be made plain before."""
    return getattr(stream, "bare", stream)


@contextmanager
def plain_streams() -> Iterator[None]:
    """Context in which all text that reaches the output and error streams is plain."""
    out, err = (stream and PlainStream(stream) for stream in (sys.stdout, sys.stderr))
    with redirect_stdout(out), redirect_stderr(err):
        yield


def program() -> str:
    """Command by which the user called the program: ``./run.sh`` in the tree, ``galinx`` elsewhere."""
    return os.environ.get("GALINX_COMMAND") or "galinx"


def as_called(text: str) -> str:
    """A text whose commands begin with ``./run.sh``, as the user would type them.

    An installed galinx is started on several ranks by mpirun itself.
    """
    if not os.environ.get("GALINX_COMMAND"):
        text = re.sub(r"\./run\.sh -n (\d+)", r"mpirun -n \1 galinx", text)
    return text.replace("./run.sh", program())


def on_terminal() -> bool:
    """True where the error stream is a terminal; run.sh says so to ranks, to which mpirun gives none."""
    return sys.stderr.isatty() or "GALINX_TERMINAL" in os.environ


#: Level of logged lines: above INFO, which is muted because the form compiler floods it.
_NOTE = logging.INFO + 5


class Progress:
    """Bar with text, share of the work and remaining time on a terminal; silent elsewhere.

    Use it as a context manager.

    Args:
        quiet: no bar.
        verbose: every step as a line on the error stream, instead of a bar.
        log: file that every step is added to, with its time.

    Raises:
        MachineFailure: the log file cannot be written.
    """

    def __init__(self, quiet: bool = False, verbose: bool = False, log: Path | None = None) -> None:
        self.quiet, self.verbose, self._log = quiet, verbose, log
        self._bar: Any = None
        self._task: Any = None
        self._last = ""
        self._logger = logging.Logger("galinx", _NOTE)

    def __enter__(self) -> "Progress":
        if not ranks.is_root():
            return self
        if self.verbose:
            self._add(logging.StreamHandler(sys.stderr), "%(message)s")
        elif not self.quiet and on_terminal():
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
        """Show the step that begins now."""
        if self._bar:
            self._bar.update(self._task, description=plain(text))
        self.note(text)

    def note(self, text: str) -> None:
        """Log a line, for verbose runs and log files."""
        if text != self._last:
            self._logger.log(_NOTE, "%s", plain(text))
            self._last = text

    def warn(self, text: str) -> None:
        """Show a warning at once, on whatever rank it was raised."""
        line = f"warning: {plain(text)}"
        if self._bar:
            self._bar.console.print(line, markup=False, highlight=False, soft_wrap=True)
        elif not self.verbose:
            print(line, file=sys.stderr, flush=True)
        self.note(line)

    def done(self, count: float, of: int, what: str = "states") -> None:
        """Show how many are finished; a fraction of the next moves the bar, and the log has its
        tenths."""
        if self._bar:
            self._bar.update(self._task, completed=count, total=of)
        self.note(f"{int(10.0 * count + 1e-9) / 10.0:g} of {of} {what}")

    def _add(self, handler: logging.Handler, form: str) -> None:
        handler.setFormatter(logging.Formatter(form))
        self._logger.addHandler(handler)


class _LogFile(logging.StreamHandler):
    """Adds lines to a file; a disk that becomes full ends the log, not the run.

    Args:
        path: the file; one that is there is added to.

    Raises:
        MachineFailure: it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        try:
            super().__init__(open(path, "ab", buffering=0))  # noqa: SIM115 - closed by close
        except OSError as error:
            raise MachineFailure(f"cannot write the log {path}: {error.strerror}") from None

    def emit(self, record: logging.LogRecord) -> None:
        line, start = memoryview(f"{self.format(record)}\n".encode()), self.stream.seek(0, os.SEEK_END)
        try:
            while line:  # a disk that becomes full takes a part
                line = line[self.stream.write(line) :]
        except OSError as error:
            self.stream.truncate(start)
            self.setLevel(logging.CRITICAL)
            print(f"warning: the log {self.stream.name} ends here: {error.strerror}", file=sys.stderr)

    def close(self) -> None:
        self.stream.close()
        super().close()


def _start_bar() -> tuple[Any, Any]:
    from rich import progress
    from rich.console import Console

    bar = progress.Progress(
        progress.TextColumn("{task.description}", markup=False),
        progress.BarColumn(bar_width=20),
        progress.TaskProgressColumn(),
        progress.TimeRemainingColumn(),
        console=Console(file=bare(sys.stderr), force_terminal=True),
        transient=True,
        # What is printed meanwhile goes its own way: rich would take its control characters for colours.
        redirect_stdout=False,
        redirect_stderr=False,
    )
    task = bar.add_task("", total=None)
    bar.start()
    return bar, task


def new_console(file: Any = None, colours: bool | None = None) -> Any:
    """Rich console that highlights no numbers and wraps no line.

    Its colours are its own: those of texts are shown as the characters they are. By default the output
    has colours, if it is a terminal and NO_COLOR is not set; mpirun hands its ranks a terminal even
    where there is none.
    """
    if colours is None:
        terminal = not file and not ranks.by_mpirun() and sys.stdout.isatty()
        colours = terminal and not os.environ.get("NO_COLOR")
    from rich.console import Console  # a slow import
    from rich.text import Text

    class _PlainConsole(Console):
        def render_str(self, text: str, **options: Any) -> Text:
            return super().render_str(plain(text), **options)

    return _PlainConsole(
        file=bare(file or sys.stdout), highlight=False, markup=False, soft_wrap=True, width=width(),
        color_system="auto" if colours else None,
    )  # fmt: skip


def print_sheet(console: Any, sheet: Any) -> None:
    """Print a table, labels to the left and numbers to the right, in parts where it is too wide."""
    from rich import box
    from rich.table import Table

    if sheet.title:
        _print_folded(console, sheet.title)
    heads = any(sheet.columns)
    for columns in _parts(sheet, console.width):
        table = Table(
            box=box.SIMPLE_HEAD if heads else None, header_style="bold", pad_edge=False,
            padding=(0, 1 if heads else 2, 0, 0), show_header=heads,
        )  # fmt: skip
        for i in columns:
            words = sheet.words or not i
            table.add_column(sheet.columns[i], justify="left" if words else "right", no_wrap=not words)
        for row in sheet.rows:
            table.add_row(*(row[i] for i in columns))
        console.print(table)
    for note in sheet.notes:
        _print_folded(console, note)


def _parts(sheet: Any, width: int) -> list[list[int]]:
    """Columns that stand side by side, the first of all in every part."""
    from rich.cells import cell_len

    if sheet.words:
        return [list(range(len(sheet.columns)))]
    wide = [
        max(cell_len(line) for cell in column for line in cell.split("\n")) + 2
        for column in zip(sheet.columns, *sheet.rows)
    ]
    wide[0] = min(wide[0], max(width // 2, 12))  # labels may take several lines

    def parts(room: int) -> list[list[int]]:
        made = [[0]]
        for i in range(1, len(wide)):
            if len(made[-1]) > 1 and sum(wide[k] for k in made[-1]) + wide[i] > room:
                made.append([0])
            made[-1].append(i)
        return made

    # As few parts as the width needs, all of about the same width: no column stands alone.
    fewest = len(parts(width))
    return next(made for room in range(1, width + 1) if len(made := parts(room)) == fewest)


def print_verdict(
    console: Any, data: dict[str, Any], attributes: dict[str, Any], verbose: bool = False
) -> None:
    """Print how well numbers were checked, and the verdict of an archive; verbose, all comparisons."""
    from galinx.postprocess.compare import checked

    _print_folded(console, checked(data, attributes))
    styles = {"PASS": "bold green", "FAIL": "bold red"}
    console.print(f"verdict: {attributes['verdict']}", style=styles.get(attributes["verdict"]))
    if verbose:
        reasons = json.loads(attributes["verdict_reasons"])
        others = [
            f"{text}: {value:.1e}"
            for text, value in json.loads(attributes["comparisons"]).items()
            if not any(reason.startswith(f"{text}: ") for reason in reasons)
        ]
        for line in (*reasons, *others):
            _print_folded(console, f"  {line}")


def _print_folded(console: Any, text: str, **style: Any) -> None:
    console.print(_fill(text), **style)


def _fill(text: str, hang: int = 2) -> str:
    """A text in lines as wide as the terminal, 80 columns where it is none."""
    return textwrap.fill(
        plain(text), width(), subsequent_indent=" " * hang, break_on_hyphens=False, break_long_words=False
    )


def say(text: str, hang: int = 2) -> None:
    """Print a line, folded at the terminal's width (80 columns where it is none)."""
    print(_fill(text, hang))


def print_result(
    sheets: Iterable[Any], data: dict[str, Any], attributes: dict[str, Any], verbose: bool = False
) -> None:
    """Print what failed, tables of a result, how well numbers were checked, and the verdict."""
    from galinx.postprocess.compare import failed

    console = new_console()
    for i, line in enumerate(failed(data, attributes)):
        _print_folded(
            console, f"FAIL: {line}" if i == 0 else f"  {line}", style="bold red" if i == 0 else ""
        )
    for i, sheet in enumerate(sheets):
        if i:
            console.print()
        print_sheet(console, sheet)
    print_verdict(console, data, attributes, verbose)


def print_sheets(sheets: Iterable[Any], notes: Iterable[str]) -> None:
    """Print tables, and lines below them."""
    console = new_console()
    for sheet in sheets:
        print_sheet(console, sheet)
    for note in notes:
        _print_folded(console, note)


def print_failure(path: Path, data: dict[str, Any], attributes: dict[str, Any]) -> None:
    """Print on the error stream that an archive failed, and by how much where it is worst."""
    from galinx.postprocess.compare import failed

    if lines := failed(data, attributes):
        more = f"FAIL of {path}: {lines[0]}\n  {program()} show {quote(str(path))} says more"
        print(for_people(more), file=sys.stderr)


def print_warnings(attributes: dict[str, Any]) -> None:
    """Print the warnings of an archive on the error stream."""
    for text in json.loads(attributes["warnings"]):
        print(for_people(f"warning: {text}"), file=sys.stderr)


def for_people(text: str) -> str:
    """A text for the error stream: its lines are folded where that is a terminal."""
    if not sys.stderr.isatty():
        return text
    return "\n".join(_fill(line, 4 if line.startswith(" ") else 2) for line in text.split("\n"))


def print_times(clock: Clock) -> None:
    """Print the wall time of the process, and of the steps that took most of it."""
    clock.lap()
    steps = sorted(((seconds, name) for name, seconds in clock.items()), reverse=True)
    longest = ", ".join(f"{name} {seconds:.2g} s" for seconds, name in steps[:4] if seconds >= 0.01)
    say(f"time: {sum(clock.values()):.3g} s{f' ({longest})' if longest else ''}")
