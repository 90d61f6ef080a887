"""Commands that look at archives: show, check, report, fields."""

import json
from pathlib import Path
from typing import Any

import click

from galinx.app import errors, ranks
from galinx.app.commands import options
from galinx.app.console.program import program
from galinx.app.console.terminal import print_summary


@click.command()
@options.archive
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables.")
def show(archive: Path, as_json: bool) -> int:
    """Show the states and the verdict of ARCHIVE.

    Example: ./run.sh show tables.h5 --json
    """
    from galinx.postprocess.hdf5.reader import read

    data, attributes = read(archive, stresses=False)
    if ranks.is_root():
        if as_json:
            print(json.dumps(_as_json(data, attributes), ensure_ascii=False, indent=1))
        else:
            print_summary(data, attributes)
    return errors.GOOD


@click.command()
@options.archive
def check(archive: Path) -> int:
    """Verify ARCHIVE: digest, layout, values; friction, comparisons and verdict once more.

    Example: ./run.sh check tables.h5
    """
    from galinx.app.results.check import faults

    found = faults(archive)
    if ranks.is_root():
        for text in found:
            print(f"fault: {text}")
        print(f"{archive}: {'is whole' if not found else f'faults: {len(found)}'}")
    return errors.GOOD if not found else errors.FAILED_VERDICT


@click.command()
@options.archive
@click.option("-o", "output", type=options.FILE, help="Page; default: the archive's name with .html.")
@options.overwrite
def report(archive: Path, output: Path | None, overwrite: bool) -> int:
    """Write a page that shows all of ARCHIVE: one HTML file that needs no network.

    Example: ./run.sh report tables.h5
    """
    target, result = output or Path(f"{archive.stem}.html"), _loaded(archive)
    if ranks.is_root():
        result.report(target, overwrite)
        print(f"report: {target}")
        print(f"next: open it in a browser, or {program()} plot {archive} for PDF figures")
    return errors.GOOD


@click.command()
@options.archive
@click.option("--state", type=int, default=0, show_default=True, help="Number of the state, see show.")
@click.option("--extent", type=float, default=10.0, show_default=True, help="How far, over a.")
@click.option("-o", "output", type=options.FILE, help="File; default: ARCHIVE_STATE.hdf.")
@options.overwrite
def fields(archive: Path, state: int, extent: float, output: Path | None, overwrite: bool) -> int:
    """Write displacement and stresses of a state of ARCHIVE for ParaView (VTKHDF).

    The state is computed once more by finite elements, at the degree that the archive used.

    Example: ./run.sh fields tables.h5 --state 3
    """
    target = output or Path(f"{archive.stem}_{state}.hdf")
    _loaded(archive, stresses=False).fields(target, state, extent, overwrite)
    if ranks.is_root():
        print(f"fields: {target}")
        print("next: open it in ParaView (5.11 or newer), and colour by von_mises")
    return errors.GOOD


def _loaded(archive: Path, stresses: bool = True) -> Any:
    """An archive's result, which knows all that the command reads."""
    from galinx.app.results.result import load

    result = load(archive, stresses)
    result.inputs = options.inputs(archive)
    return result


def _as_json(data: dict[str, Any], attributes: dict[str, Any]) -> dict[str, Any]:
    """States as a list of objects nested like the archive's paths; NaN becomes null."""
    from galinx.postprocess.quantities.states import FRICTION

    states: list[dict[str, Any]] = [{} for _ in data[FRICTION.path]]
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


COMMANDS: tuple[Any, ...] = (show, check, report, fields)
