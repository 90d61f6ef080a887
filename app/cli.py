"""The command line: its commands, models of the user's own, and the message and status of every failure.

A user's model is a Python file that registers laws, solids, profiles, meshes or quantities; it runs
before anything else.
"""

import os
import runpy
import sys
import traceback
from contextlib import suppress
from pathlib import Path
from traceback import extract_tb
from typing import Any, NoReturn

import click

from galinx import __version__
from galinx.postprocess.errors import Occupied, UnreadableArchive, UnwritableArchive
from galinx.solvers.errors import CompilerError, MeshError, SolveError

from . import errors, process, ranks
from .commands import begin, compute, look, options
from .console import as_called, plain_streams, program
from .errors import BadInput, MachineFailure, meant, short


def extend(path: Path) -> None:
    """Run a file that registers laws, solids, profiles, meshes or quantities.

    Raises:
        BadInput: it cannot be read, or it fails; the message says where.
    """
    try:
        there = path.is_file()
    except OSError as error:
        raise BadInput(f"cannot read {path}: {error.strerror}") from None
    if not there:
        raise BadInput(f"cannot read {path}: expected a Python file that registers models")
    try:
        runpy.run_path(str(path))
    except process.Interrupted:  # the process itself is to end
        raise
    except BaseException as error:  # whatever ends the file, sys.exit among it
        lines = [frame.lineno for frame in extract_tb(error.__traceback__) if frame.filename == str(path)]
        line = f", line {lines[-1]}" if lines else ""
        said = f": {error}" if str(error) else ""
        raise BadInput(f"{path} fails: {type(error).__name__}{said}{line}") from error


#: Failures whose message says all; others show where they happened.
_FAILURES = (
    MachineFailure, UnwritableArchive, SolveError, MeshError, CompilerError, OSError, MemoryError,
)  # fmt: skip


#: Commands by what they are for, in the order of the help.
_GROUPS = {
    "Begin": ("init", "materials", "fit"),
    "Compute": ("run", "plan"),
    "Look": ("show", "compare", "report", "plot", "csv"),
    "Expert": ("check", "fields", "dispersion", "response", "paper", "schema"),
}


class _Commands(click.Group):
    """Commands by name, in groups.

    click takes an unknown one that begins with a sign for a call for help.
    """

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands in groups, each with the first sentence of its help in full."""
        grouped = {name for names in _GROUPS.values() for name in names}
        others = tuple(name for name in self.commands if name not in grouped)
        for title, names in {**_GROUPS, "More": others}.items():
            rows = [
                (name, self.commands[name].get_short_help_str(limit=500))
                for name in names
                if name in self.commands
            ]
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        if args[0] not in self.commands:
            of_script = ["test", "bench", "stress", "docs"] * (program() == "./run.sh")
            commands = [*self.commands, *of_script]
            hint = meant(args[0], commands) or f"; {program()} --help lists the commands"
            ctx.fail(f"No such command {short(args[0])!r}{hint}")
        return super().resolve_command(ctx, args)


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="galinx")
@click.option(
    "-x", "--extend", "extensions", multiple=True, type=options.FILE,
    help="Python file that registers models of your own; may be repeated.",
)  # fmt: skip
def cli(extensions: tuple[Path, ...]) -> None:
    """Sliding contact of a rigid punch, from rest to wave speed.

    Exit status: 0 good, 1 verdict FAIL, 2 bad input, 3 failure of program or machine.
    """
    for path in extensions:
        extend(path)


for _room in (begin, compute, look):
    for _command in vars(_room).values():
        if isinstance(_command, click.Command):
            _command.help = as_called(_command.help or "")
            cli.add_command(_command)


def run_from_shell() -> None:
    """Run the command line; every failure ends with one readable message and its status."""
    with plain_streams():
        _run()


def _run() -> None:
    try:
        status = cli.main(standalone_mode=False, prog_name=program()) or errors.GOOD
        sys.stdout.flush()
    except (click.ClickException, BadInput, Occupied, UnreadableArchive) as error:
        message = error.format_message() if isinstance(error, click.ClickException) else str(error)
        _stop(message, errors.BAD_INPUT)
    except (BrokenPipeError, SystemExit):  # the second is what click makes of the first
        process.too_late()
        os._exit(141)  # whoever reads has enough, as head does; what shells say then, 128 + SIGPIPE
    except ImportError as error:
        _stop(errors.unavailable(error))
    except _FAILURES as error:
        _stop(str(error) or "out of memory")
    except Exception as error:
        traceback.print_exc()
        _stop(f"internal failure on rank {ranks.rank()}: {error}")
    process.too_late()
    sys.exit(int(os.environ.get("GALINX_FAIL", status)) if status == errors.FAILED_VERDICT else status)


def _stop(message: str, status: int = errors.FAILURE) -> NoReturn:
    """End at once, and with this rank all others: they may not have met the failure.

    HDF5 crashes when it closes, at exit, a file that a full disk has kept it from closing.
    """
    several = ranks.size() > 1  # MPI starts on all ranks together: before any of them waits
    process.complain(message)
    with suppress(OSError):
        sys.stdout.flush()
    sys.stderr.flush()
    if several:
        ranks.abort(status)
    os._exit(status)
