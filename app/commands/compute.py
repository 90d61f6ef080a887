"""Commands that compute: run, plan, paper."""

import sys
import time
from pathlib import Path
from shlex import quote
from typing import Any

import click

from galinx import __version__
from galinx.clock import Clock, age
from galinx.postprocess.errors import UnwritableArchive
from galinx.postprocess.target import Folder, Target
from galinx.texts import counted

from .. import errors, process, ranks
from ..console import (
    Progress,
    print_failure,
    print_result,
    print_times,
    print_warnings,
    program,
    say,
    width,
)
from . import options


@click.command()
@options.scene
@click.option("-o", "output", type=options.ARCHIVE, help="Archive; default: the scene's name with .h5.")
@options.changes
@options.overwrite
@click.option("--resume", is_flag=True, help="Go on with what an interrupted run left.")
@options.dimensionless
@options.talk
def run(
    scene: Path, output: Path | None, changes: tuple[str, ...], unset: tuple[str, ...],
    overwrite: bool, resume: bool, dimensionless: bool, progress: Progress, quiet: bool,
) -> int:  # fmt: skip
    """Compute SCENE and archive the results.

    Example: ./run.sh -n 2 run scenes/tables4_5.toml -o tables.h5
    """
    from ..plan.plan import make_plan
    from ..run.flow import compute

    clock = Clock("start and end", age())
    path = output or Path(scene.stem + ".h5")
    checked = options.read(scene, changes, unset)
    if not ranks.is_root() and not make_plan(checked).shared:
        return errors.GOOD  # nothing to share
    target = Target(path, None, overwrite, options.inputs(scene))
    if not ranks.is_root():
        compute(checked)
        return errors.GOOD
    from galinx.postprocess.hdf5.archive import read
    from galinx.postprocess.journal import Journal
    from galinx.postprocess.tables import sheets
    from galinx.postprocess.units import Units

    journal = Journal(target.place, f"{checked.sha256} {__version__}", resume, overwrite)
    with progress:
        progress.note(f"scene: {scene}")
        verdict = _archived(checked, target, journal, progress, clock)
    data, attributes = read(path, stresses=False, verified=True)
    if not quiet:
        units = Units(checked.body, data, dimensionless)
        shown = sheets(data, units, attributes["title"], width())
        print_result(shown, data, attributes, progress.verbose)
    else:
        print_failure(path, data, attributes)
    print_warnings(attributes)
    if not quiet:
        print_times(clock)
        print(f"archive: {path}")
        print(f"next: {program()} report {quote(str(path))}")
    return errors.FAILED_VERDICT if verdict == "FAIL" else errors.GOOD


def _archived(scene: Any, target: Target, journal: Any, progress: Progress, clock: Clock) -> str:
    """Compute a scene into its archive, keeping finished states on the way; return the verdict."""
    from galinx.postprocess.hdf5 import archive

    from ..run.flow import compute

    def kept() -> str:
        states = journal.states
        return (
            f"{states} finished states are kept, go on with --resume"
            if states
            else "nothing was finished"
        )

    def leave() -> str:
        journal.leave()
        return kept()

    try:
        with journal, archive.Writer(target, journal.folder) as writer:
            if journal.states and not progress.quiet:
                say(f"resume: {counted(journal.states, 'state')} of an interrupted run taken over")
            with process.leaving(leave):
                with clock("other"):
                    attributes = compute(scene, writer, progress, journal, clock)
                process.too_late()
            progress.say("checking the archive")
            with clock("archive"):
                writer.finish(attributes)
            journal.complete()
            progress.note(f"verdict: {attributes['verdict']}; archive: {target.path}")
    except UnwritableArchive as error:
        if type(error) is UnwritableArchive:  # others say themselves what is to be done
            raise UnwritableArchive(f"{error}; {kept()}") from error
        raise
    return attributes["verdict"]


@click.command()
@options.scene
@options.changes
def plan(scene: Path, changes: tuple[str, ...], unset: tuple[str, ...]) -> None:
    """Show what a run of SCENE would do, and what it would skip; nothing is computed.

    Example: ./run.sh plan scenes/tables4_5.toml
    """
    from ..plan.plan import by_reason, expense
    from ..plan.variants import lines_of, make_plans

    plans = make_plans(options.read(scene, changes, unset))
    if ranks.is_root():
        for text in lines_of(plans):
            say(f"do    {text}", 6)
        for text in by_reason(text for each in plans for text in each.skipped):
            say(f"skip  {text}", 6)
        say(f"cost  {expense(*plans)}", 6)
        for text in dict.fromkeys(text for planned in plans for text in planned.warnings):
            print(f"warning: {text}", file=sys.stderr)


@click.command()
@options.folder("results")
@options.overwrite
@options.talk
def paper(folder: Path, overwrite: bool, progress: Progress, quiet: bool) -> int:
    """Reproduce the study: tables, statements, figures, a report, into a folder.

    Example: ./run.sh paper -o results
    """
    from ..study.paper import reproduce

    begun = time.time()
    try:
        with progress:
            good = reproduce(Folder(folder, overwrite, options.inputs()), progress, quiet)
    except process.Interrupted:
        names = sorted(path.name for path in folder.glob("[!.]*") if path.stat().st_mtime >= begun)
        process.end_stopped(f"written is {errors.listed(names)} alone" if names else process.NOTHING)
    return errors.GOOD if good else errors.FAILED_VERDICT
