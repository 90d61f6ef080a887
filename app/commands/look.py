"""Commands that look at archives: show, check, report, fields."""

import json
from math import nan
from pathlib import Path
from typing import Any

import click

from galinx.app import errors, ranks
from galinx.app.commands import options
from galinx.app.console.program import program
from galinx.app.console.terminal import print_sheets, print_warnings


@click.command()
@options.archive
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables.")
@options.si
def show(archive: Path, as_json: bool, si: bool) -> int:
    """Show states, friction loops and verdict of ARCHIVE, where it yields, and where its answers hold.

    Example: ./run.sh show tables.h5 --si
    """
    from galinx.app.results.si import scaling
    from galinx.postprocess.tables import (
        inner_sheet,
        limits_sheet,
        loops_sheet,
        sliders_sheet,
        starts_sheet,
        states_sheet,
    )

    result = _loaded(archive, stresses=False)
    data, attributes = result.data, result.attributes
    if ranks.is_root():
        scaled = scaling(result.scene if si else None, data)
        if as_json:
            print(json.dumps(_as_json(data, attributes, scaled), ensure_ascii=False, indent=1))
        else:
            states = states_sheet(data, attributes["title"], scaled)
            # Archives of friction alone, and of other programs, need not have them.
            unit = attributes.get("half_width", nan) / attributes.get("c_s", nan)
            friction = inner_sheet(data), loops_sheet(data), sliders_sheet(data)
            sheets = states, *friction, starts_sheet(data, unit), limits_sheet(data, scaled)
            print_sheets([sheet for sheet in sheets if sheet.rows], attributes)
            print_warnings(attributes)
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
@options.si
@options.overwrite
def report(archive: Path, output: Path | None, si: bool, overwrite: bool) -> int:
    """Write a page that shows all of ARCHIVE: one HTML file that needs no network.

    Example: ./run.sh report tables.h5
    """
    target, result = output or Path(f"{archive.stem}.html"), _loaded(archive)
    if ranks.is_root():
        result.report(target, overwrite, si)
        print(f"report: {target}")
        print(f"next: open it in a browser, or {program()} plot {archive} for PDF figures")
    return errors.GOOD


@click.command()
@options.archive
@click.option("--state", type=int, help="Number of the state, see show.  [default: 0]")
@click.option("--states", help="Several, as 0,4,7 or 0-5, as a series over their numbers.")
@click.option(
    "--extent", type=float, default=10.0, show_default=True,
    help="How far in X and Y, over a; cells that reach further are cut there.",
)  # fmt: skip
@click.option("-o", "output", type=options.FILE, help="File; default: ARCHIVE_STATES.hdf.")
@options.overwrite
def fields(
    archive: Path, state: int | None, states: str | None, extent: float, output: Path | None,
    overwrite: bool,
) -> int:  # fmt: skip
    """Write displacement and stresses of states of ARCHIVE for ParaView (VTKHDF).

    The states are computed once more by finite elements, at the degree that the archive used.

    Example: ./run.sh fields tables.h5 --state 3
    """
    if state is not None and states is not None:
        raise click.UsageError("--state and --states exclude each other; keep one")
    numbers = [state or 0] if states is None else options.numbers(states)
    target = output or Path(f"{archive.stem}_{states or numbers[0]}.hdf")
    _loaded(archive, stresses=False).fields(target, numbers, extent, overwrite)
    if ranks.is_root():
        print(f"fields: {target}")
        version = "5.12" if len(numbers) > 1 else "5.11"
        print(f"next: open it in ParaView ({version} or newer), and colour by von_mises_for_colours")
    return errors.GOOD


def _loaded(archive: Path, stresses: bool = True) -> Any:
    """An archive's result, which knows all that the command reads."""
    from galinx.app.results.result import load

    result = load(archive, stresses)
    result.inputs = options.inputs(archive)
    return result


def _as_json(data: dict[str, Any], attributes: dict[str, Any], scaled: Any) -> dict[str, Any]:
    """States as a list of objects nested like the archive's paths, and units likewise; NaN is null."""
    from galinx.postprocess.quantities import declared
    from galinx.postprocess.quantities.states import FRICTION

    states: list[dict[str, Any]] = [{} for _ in data[FRICTION.path]]
    units: dict[str, Any] = {}
    for name, values in data.items():
        section, *path, last = name.split("/")
        if section != "states" or (told := scaled(declared(name), last)) is None:
            continue
        for state, value in zip([units, *states], [told.unit, *told.of(values).tolist()]):
            for level in path:
                state = state.setdefault(level, {})
            state[told.name] = None if value != value else value
    return {
        "title": attributes["title"],
        "version": attributes["version"],
        "scene_sha256": attributes["scene_sha256"],
        "verdict": attributes["verdict"],
        "verdict_reasons": json.loads(attributes["verdict_reasons"]),
        "warnings": json.loads(attributes["warnings"]),
        "units": units,
        "states": states,
    }


COMMANDS: tuple[Any, ...] = (show, check, report, fields)
