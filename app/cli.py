"""The command line, and how every failure ends."""

import os
import sys
import time
import traceback
from pathlib import Path
from typing import NoReturn

import click

from galinx import __version__
from galinx.app import errors, ranks
from galinx.app.commands import begin, compute, look, options
from galinx.app.console.program import as_called, program
from galinx.app.errors import BadInput, MachineFailure
from galinx.postprocess.errors import Occupied, UnreadableArchive, UnwritableArchive
from galinx.solvers.errors import CompilerError, MeshError, SolveError

#: Failures whose message says all; others show where they happened.
_FAILURES = (
    MachineFailure, UnwritableArchive, SolveError, MeshError, CompilerError, OSError, MemoryError,
)  # fmt: skip


#: Seconds that other ranks leave to rank 0: where all fail alike it says so once. Some mpiruns end all
#: ranks when the first ends with a failure.
_PATIENCE = 1.0

#: What shells say of a program whose reader went away: 128 + SIGPIPE.
_CUT_OFF = 141


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
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
        from galinx.app.extend import extend

        extend(path)


for _command in (*begin.COMMANDS, *compute.COMMANDS, *look.COMMANDS):
    _command.help = as_called(_command.help)
    cli.add_command(_command)


def run_from_shell() -> None:
    """Run the command line; every failure ends with one readable message and its status."""
    try:
        status = cli.main(standalone_mode=False, prog_name=program()) or errors.GOOD
        sys.stdout.flush()
    except (click.ClickException, BadInput, Occupied, UnreadableArchive) as error:
        message = error.format_message() if isinstance(error, click.ClickException) else str(error)
        if ranks.is_root():  # every rank reads the same input and comes here
            _complain(message)
        else:
            time.sleep(_PATIENCE)
        sys.exit(errors.BAD_INPUT)
    except (BrokenPipeError, SystemExit):  # the second is what click makes of the first
        os._exit(_CUT_OFF)  # whoever reads has enough, as head does
    except click.exceptions.Abort:
        _stop("interrupted; nothing was written")
    except _FAILURES as error:
        _stop(str(error) or "out of memory")
    except Exception as error:
        traceback.print_exc()
        _stop(f"internal failure on rank {ranks.rank()}: {error}")
    sys.exit(status)


def _complain(message: str) -> None:
    print(f"error: {message}", file=sys.stderr, flush=True)


def _stop(message: str) -> NoReturn:
    """End at once with a failure that other ranks may not share.

    HDF5 crashes when it closes, at exit, a file that a full disk has kept it from closing.
    """
    if not ranks.is_root():
        time.sleep(_PATIENCE)
    _complain(message)
    sys.stdout.flush(), sys.stderr.flush()
    if ranks.size() > 1:
        ranks.abort(errors.FAILURE)
    os._exit(errors.FAILURE)
