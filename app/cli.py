"""The command line: run, plan, show, check, paper, stress, plot."""

import json
import os
import signal
import sys
import traceback
from pathlib import Path
from typing import Any, NoReturn

import click

from app import __version__, errors, ranks
from app import scene as scenes
from app.errors import BadInput, MachineFailure
from app.progress import Progress
from postprocess.errors import UnreadableArchive, UnwritableArchive
from solvers.errors import CompilerError, MeshError, SolveError

#: Failures whose message says all; others show where they happened.
_FAILURES = (
    MachineFailure, UnwritableArchive, SolveError, MeshError, CompilerError, OSError, MemoryError,
)  # fmt: skip

_ARCHIVE = click.Path(path_type=Path)


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="galinx")
def cli() -> None:
    """Sliding contact of a rigid punch, from rest to wave speed.

    Exit status: 0 good, 1 verdict FAIL, 2 bad input, 3 failure of program or machine.
    """


@cli.command()
@click.argument("scene", type=_ARCHIVE)
@click.option("-o", "output", type=_ARCHIVE, help="Archive; default: the scene's name with .h5.")
@click.option("--overwrite", is_flag=True, help="Replace an archive of that name.")
@click.option("--resume", is_flag=True, help="Go on with what an interrupted run left.")
def run(scene: Path, output: Path | None, overwrite: bool, resume: bool) -> int:
    """Compute SCENE and archive the results.

    Example: ./run.sh -n 2 run scenes/tables4_5.toml -o tables.h5
    """
    from app import plan as planning
    from app.run import check_output, compute

    target = output or Path(scene.stem + ".h5")
    checked = scenes.read(scene)
    if not ranks.is_root() and not planning.make_plan(checked).fem:
        return errors.GOOD  # nothing to share
    check_output(target, overwrite)
    if not ranks.is_root():
        compute(checked)
        return errors.GOOD
    from postprocess.hdf5 import archive
    from postprocess.journal import Journal

    signal.signal(signal.SIGTERM, signal.default_int_handler)
    journal = Journal(target, f"{checked.sha256} {__version__}", resume, overwrite)
    try:
        with journal, archive.Writer(target, journal.folder) as writer, Progress() as progress:
            attributes = compute(checked, writer, progress, journal)
            progress.say("checking the archive")
            writer.finish(attributes)
            journal.complete()
    except KeyboardInterrupt:
        kept = journal.states
        go_on = (
            f"{kept} finished states are kept, go on with --resume" if kept else "nothing was finished"
        )
        raise MachineFailure(f"interrupted; {go_on}") from None
    data, attributes = archive.read(target, stresses=False)
    _print_summary(data, attributes)
    print(f"archive: {target}")
    return _status(attributes)


@cli.command()
@click.argument("scene", type=_ARCHIVE)
def plan(scene: Path) -> int:
    """Show what a run of SCENE would do, and what it would skip; nothing is computed.

    Example: ./run.sh plan scenes/tables4_5.toml
    """
    from app import plan as planning

    checked = scenes.read(scene)
    planned = planning.make_plan(checked)
    if ranks.is_root():
        for text in planning.lines(checked, planned):
            print(f"do    {text}")
        for text in planned.skipped:
            print(f"skip  {text}")
        print(f"cost  {planning.expense(checked, planned)}")
        for text in planned.warnings:
            print(f"warning: {text}", file=sys.stderr)
    return errors.GOOD


@cli.command()
@click.argument("archive", type=_ARCHIVE)
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables.")
def show(archive: Path, as_json: bool) -> int:
    """Show the states and the verdict of ARCHIVE.

    Example: ./run.sh show tables.h5 --json
    """
    from postprocess.hdf5.archive import read

    data, attributes = read(archive, stresses=False)
    if ranks.is_root():
        if as_json:
            print(json.dumps(_as_json(data, attributes), ensure_ascii=False, indent=1))
        else:
            _print_summary(data, attributes)
    return errors.GOOD


@cli.command()
@click.argument("archive", type=_ARCHIVE)
def check(archive: Path) -> int:
    """Verify ARCHIVE: checksums, completeness, layout, finite values, balances, verdict.

    Example: ./run.sh check tables.h5
    """
    from app.judge import BALANCE_LIMIT
    from postprocess.check import faults

    found = faults(archive, BALANCE_LIMIT)
    if ranks.is_root():
        for text in found:
            print(f"fault: {text}")
        print(f"{archive}: {'is whole' if not found else f'faults: {len(found)}'}")
    return errors.GOOD if not found else errors.FAILED_VERDICT


@cli.command()
@click.option("-o", "folder", type=_ARCHIVE, default=Path("results"), show_default=True)
def paper(folder: Path) -> int:
    """Reproduce the study: Tables 1, 3, 4, 5, Figs 2 and 5-10, into a folder.

    Example: ./run.sh paper -o results
    """
    from app.paper import reproduce

    return errors.GOOD if reproduce(folder) else errors.FAILED_VERDICT


@cli.command()
@click.option("-o", "folder", type=_ARCHIVE, default=Path("stress"), show_default=True)
def stress(folder: Path) -> int:
    """Try extremes of every parameter, and say whether the promises hold there.

    Example: ./run.sh stress -o stress
    """
    from app.stress import matrix

    return errors.GOOD if matrix.stress(folder) else errors.FAILED_VERDICT


@cli.command()
@click.argument("archive", type=_ARCHIVE)
@click.option("-o", "folder", type=_ARCHIVE, default=Path("."), help="Folder; default: this one.")
def plot(archive: Path, folder: Path) -> int:
    """Draw what ARCHIVE holds, each figure as PDF and PNG.

    Example: ./run.sh plot tables.h5 -o figures
    """
    from postprocess.hdf5.archive import read

    data, _ = read(archive)
    if ranks.is_root():
        from postprocess.figures import draw_archive

        folder.mkdir(parents=True, exist_ok=True)
        for path in draw_archive(data, folder, archive.stem):
            print(f"figure: {path}")
    return errors.GOOD


def run_from_shell() -> None:
    """Run the command line; every failure ends with one readable message and its status."""
    try:
        status = cli.main(standalone_mode=False, prog_name="run.sh") or errors.GOOD
    except (click.ClickException, BadInput, UnreadableArchive) as error:
        message = error.format_message() if isinstance(error, click.ClickException) else str(error)
        _complain(message)
        sys.exit(errors.BAD_INPUT)  # every rank reads the same input and comes here
    except click.exceptions.Abort:
        _complain("interrupted; nothing was written")
        _stop(errors.FAILURE)
    except _FAILURES as error:
        _complain(str(error) or "out of memory")
        _stop(errors.FAILURE)
    except Exception as error:
        traceback.print_exc()
        _complain(f"internal failure on rank {ranks.rank()}: {error}")
        _stop(errors.FAILURE)
    sys.exit(status)


def _complain(message: str) -> None:
    if ranks.is_root():
        print(f"error: {message}", file=sys.stderr, flush=True)


def _stop(status: int) -> NoReturn:
    """End at once with a failure that other ranks may not share.

    HDF5 crashes when it closes, at exit, a file that a full disk has kept it from closing.
    """
    sys.stdout.flush(), sys.stderr.flush()
    if ranks.size() > 1:
        ranks.abort(status)
    os._exit(status)


def _status(attributes: dict[str, Any]) -> int:
    return errors.FAILED_VERDICT if attributes["verdict"] == "FAIL" else errors.GOOD


def _print_summary(data: dict[str, Any], attributes: dict[str, Any]) -> None:
    from postprocess.tables import print_states

    print_states(data, attributes)
    for text in json.loads(attributes["warnings"]):
        print(f"warning: {text}", file=sys.stderr)


def _as_json(data: dict[str, Any], attributes: dict[str, Any]) -> dict[str, Any]:
    """States as a list of objects nested like the archive's paths; NaN becomes null."""
    states: list[dict[str, Any]] = [{} for _ in data["states/f"]]
    for name, values in data.items():
        section, *path, last = name.split("/")
        if section != "states":
            continue
        for state, value in zip(states, values.tolist()):
            for level in path:
                state = state.setdefault(level, {})
            state[last] = None if value != value else value
    return {
        "title": attributes["title"],
        "version": attributes["version"],
        "scene_sha256": attributes["scene_sha256"],
        "verdict": attributes["verdict"],
        "verdict_reasons": json.loads(attributes["verdict_reasons"]),
        "warnings": json.loads(attributes["warnings"]),
        "states": states,
    }
