"""Commands that compute: run, plan, paper, stress."""

import signal
import sys
from pathlib import Path
from typing import Any

import click

from galinx import __version__
from galinx.app import errors, ranks
from galinx.app.commands import options
from galinx.app.console.progress import Progress
from galinx.app.console.terminal import print_summary, print_times, say
from galinx.app.errors import MachineFailure
from galinx.app.scene import read as scenes
from galinx.app.scene.changes import from_words


@click.command()
@options.scene
@click.option("-o", "output", type=options.FILE, help="Archive; default: the scene's name with .h5.")
@options.changes
@click.option("--overwrite", is_flag=True, help="Replace an archive of that name.")
@click.option("--resume", is_flag=True, help="Go on with what an interrupted run left.")
@options.talk
def run(
    scene: Path, output: Path | None, changes: tuple[str, ...], overwrite: bool, resume: bool,
    progress: Progress, quiet: bool,
) -> int:  # fmt: skip
    """Compute SCENE and archive the results.

    Example: ./run.sh -n 2 run scenes/tables4_5.toml -o tables.h5
    """
    from galinx.app.plan import plan as planning
    from galinx.app.run.flow import compute
    from galinx.app.run.output import check_output

    target = output or Path(scene.stem + ".h5")
    checked = scenes.read(scene, from_words(changes))
    if not ranks.is_root() and not planning.make_plan(checked).fem:
        return errors.GOOD  # nothing to share
    check_output(target, overwrite)
    if not ranks.is_root():
        compute(checked)
        return errors.GOOD
    from galinx.postprocess.hdf5 import archive
    from galinx.postprocess.journal import Journal

    journal = Journal(target, f"{checked.sha256} {__version__}", resume, overwrite)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, journal.stop)
    try:
        with journal, archive.Writer(target, journal.folder) as writer, progress:
            progress.note(f"scene: {scene}")
            attributes = compute(checked, writer, progress, journal)
            progress.say("checking the archive")
            writer.finish(attributes)
            journal.complete()
            progress.note(f"verdict: {attributes['verdict']}; archive: {target}")
    except KeyboardInterrupt:
        kept = journal.states
        go_on = (
            f"{kept} finished states are kept, go on with --resume" if kept else "nothing was finished"
        )
        raise MachineFailure(f"interrupted; {go_on}") from None
    data, attributes = archive.read(target, stresses=False)
    print_summary(data, attributes, quiet)
    if not quiet:
        print_times(data)
        print(f"archive: {target}")
        print(f"next: ./run.sh report {target}")
    return errors.FAILED_VERDICT if attributes["verdict"] == "FAIL" else errors.GOOD


@click.command()
@options.scene
@options.changes
def plan(scene: Path, changes: tuple[str, ...]) -> int:
    """Show what a run of SCENE would do, and what it would skip; nothing is computed.

    Example: ./run.sh plan scenes/tables4_5.toml
    """
    from galinx.app.plan.plan import make_plan
    from galinx.app.plan.words import expense, lines

    checked = scenes.read(scene, from_words(changes))
    planned = make_plan(checked)
    if ranks.is_root():
        for text in lines(checked, planned):
            say(f"do    {text}", 6)
        for text in planned.skipped:
            say(f"skip  {text}", 6)
        say(f"cost  {expense(planned)}", 6)
        for text in planned.warnings:
            print(f"warning: {text}", file=sys.stderr)
    return errors.GOOD


@click.command()
@options.folder("results")
@options.talk
def paper(folder: Path, progress: Progress, quiet: bool) -> int:
    """Reproduce the study: Tables 1, 3, 4, 5, Figs 2 and 5-10, a report, into a folder.

    Example: ./run.sh paper -o results
    """
    from galinx.app.study.paper import reproduce

    with progress:
        good = reproduce(folder, progress, quiet)
    return errors.GOOD if good else errors.FAILED_VERDICT


@click.command()
@options.folder("stress")
def stress(folder: Path) -> int:
    """Try extremes of every parameter, and say whether the promises hold there.

    Example: ./run.sh stress -o stress
    """
    from galinx.app.extremes import matrix

    return errors.GOOD if matrix.stress(folder) else errors.FAILED_VERDICT


COMMANDS: tuple[Any, ...] = (run, plan, paper, stress)
