"""Commands that look at results: show, check, report and fields of an archive, and compare of several.

Further ones draw archives and scenes, plot, dispersion and response, or give an archive to other
programs, csv.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from shlex import quote
from typing import Any

import click

from galinx.postprocess.target import TABLE, Target

from .. import errors, ranks
from ..console import print_failure, print_result, print_sheets, print_warnings, program, say, width
from . import options


@click.command()
@options.archive
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of tables.")
@options.dimensionless
@click.option("-v", "--verbose", is_flag=True, help="All comparisons, and their limits.")
def show(archive: Path, as_json: bool, dimensionless: bool, verbose: bool) -> None:
    """Show states, friction loops and verdict of ARCHIVE, where it yields, and where its answers hold.

    Example: ./run.sh show tables.h5 --dimensionless
    """
    from galinx.postprocess.tables import sheets

    result = _loaded(archive, stresses=False, failure=False)
    data, attributes = result.data, result.attributes
    if ranks.is_root():
        units = result.units(dimensionless)
        if as_json:
            print(json.dumps(_as_json(data, attributes, units), ensure_ascii=False, indent=1))
        else:
            shown = sheets(data, units, attributes["title"], width(), not result.scene.steady)
            print_result(shown, data, attributes, verbose)
            print_warnings(attributes)


_MEASURED = click.option(
    "--measured", type=options.FILE, metavar="FILE",
    help="Table of measured points that lie over the figure, as position [mm] and pressure [MPa] or "
    "sigma_XX [MPa]; slip [mm] and f.",
)  # fmt: skip


def _text(name: str, metavar: str, about: str, *parameter: str) -> Any:
    """Option that takes a text, by default none."""
    return click.option(f"--{name}", *parameter, default="", metavar=metavar, help=about)


@click.command()
@click.argument("archives", type=options.FILE, nargs=-1, required=True)
@click.option("-o", "to", type=options.PATH, help="Draw them as well: folder, or a file.")
@_text("states", "NUMBERS", "States of the first: 0,4,7 or 0-3.")
@_MEASURED
@options.dimensionless
@options.overwrite
def compare(
    archives: tuple[Path, ...], to: Path | None, states: str, measured: Path | None,
    dimensionless: bool, overwrite: bool,
) -> None:  # fmt: skip
    """Print the numbers of ARCHIVES side by side, and the differences of all from the first.

    States are paired by the parameters that vary in them where these agree, else by their order. -o draws
    contact pressure and in-plane stress of all in one figure.

    Example: ./run.sh compare tables.h5 tables.h5 -o both.pdf
    """
    from ..figures.files import Files
    from ..figures.measured import read as read_measured
    from ..results.compared import Comparison
    from ..results.result import numbers

    if len(archives) < 2:
        raise click.UsageError(f"found one archive, {archives[0]}; expected two or more")
    if measured and not to:
        raise click.UsageError("--measured lies over a figure; say by -o where to draw it")
    points = read_measured(measured) if measured else None
    results = [_loaded(archive, bool(to), failure=False) for archive in archives]
    comparison = Comparison(results, dimensionless, numbers(states) if states else ())
    if ranks.is_root():
        if to:
            inputs = options.inputs(*archives, measured)
            files = Files(to, archives[0].stem, overwrite=overwrite, inputs=inputs)
            files.check(["compare"])
            written = files.write([comparison.drawing(points)])
        print_sheets(comparison.sheets(), comparison.notes())
        _print_files(written if to else ())


@click.command()
@options.archive
def check(archive: Path) -> int:
    """Verify ARCHIVE: digest, layout, values; friction, comparisons and verdict once more.

    Example: ./run.sh check tables.h5
    """
    from ..results.check import faults

    texts = faults(archive)
    if ranks.is_root():
        for text in texts:
            print(f"fault: {text}")
        print(f"{archive}: {'is whole' if not texts else f'faults: {len(texts)}'}")
    return errors.GOOD if not texts else errors.FAILED_VERDICT


@click.command()
@options.archive
@click.option("-o", "output", type=options.FILE, help="Page; default: the archive's name with .html.")
@options.dimensionless
@options.overwrite
def report(archive: Path, output: Path | None, dimensionless: bool, overwrite: bool) -> None:
    """Write a page that shows all of ARCHIVE: one HTML file that needs no network.

    Example: ./run.sh report tables.h5
    """
    target, result = output or Path(f"{archive.stem}.html"), _loaded(archive)
    if ranks.is_root():
        result.report(target, overwrite, dimensionless)
        print(f"report: {target}")
        print(f"next: open it in a browser, or {program()} plot {quote(str(archive))} for PDF figures")


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
) -> None:  # fmt: skip
    """Write displacement and stresses of states of ARCHIVE for ParaView (VTKHDF).

    The states are computed once more by finite elements, at the degree that the archive used.

    Example: ./run.sh fields tables.h5 --state 3
    """
    if state is not None and states is not None:
        raise click.UsageError("--state and --states exclude each other; keep one")
    from ..results.result import numbers

    shown = [state or 0] if states is None else numbers(states)
    target = output or Path(f"{archive.stem}_{states or shown[0]}.hdf")
    result = _loaded(archive, stresses=False)
    result.fields(target, shown, extent, overwrite)
    if ranks.is_root():
        print(f"fields: {target}")
        if result.scene.time:
            say("They are those of steady motion: inside, stresses over time are not computed.")
        version = "5.12" if len(shown) > 1 else "5.11"
        print(f"next: open it in ParaView ({version} or newer), and colour by von_mises_for_colours")


def _loaded(archive: Path, stresses: bool = True, failure: bool = True) -> Any:
    """Result of an archive that knows all files which the command reads.

    Args:
        archive: its file.
        stresses: read stresses on the surface and inside, too.
        failure: say on the error stream that its verdict is FAIL, as what the command writes does not.
    """
    from ..results.result import load

    result = load(archive, stresses)
    result.inputs = options.inputs(archive)
    if failure and ranks.is_root():
        print_failure(archive, result.data, result.attributes)
    return result


def _as_json(data: dict[str, Any], attributes: dict[str, Any], scaled: Any) -> dict[str, Any]:
    """States as objects nested like the archive's paths, with units likewise; NaN becomes null."""
    from galinx.postprocess.quantities import declared
    from galinx.postprocess.quantities.states import FRICTION

    states: list[dict[str, Any]] = [{} for _ in data[FRICTION.path]]
    units: dict[str, Any] = {}
    for name, values in data.items():
        section, *path, last = name.split("/")
        if section != "states" or (scaled_row := scaled(declared(name), last)) is None:
            continue
        for state, value in zip([units, *states], [scaled_row.unit, *scaled_row.of(values).tolist()]):
            for level in path:
                state = state.setdefault(level, {})
            state[scaled_row.name] = None if value != value else value
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


@click.command()
@options.archive
@options.figures_to
@_text(
    "figure", "NAMES",
    "surface, along, inside, parameters, friction, slider, time, interfaces, pressures, stresses, "
    "energies, flutter, degrees, mesh, film; several as in surface,mesh; all for all.", "figures",
)  # fmt: skip
@_text("states", "NUMBERS", "States, see show: 0,4,7 or 0-3.")
@_text("quantity", "NAMES", "Stresses, as in sigma_XX,von_mises.", "quantities")
@_text("method", "NAME", "closed_form, sie or fem; default: all.")
@_text("x", "NAME", "Parameter that numbers of states are drawn over, as mu_c.")
@_text("y", "NAMES", "These numbers, as in K_I_left,v0.")
@_text("by", "NAME", "Parameter that distinguishes their curves.")
@_text("size", "SIZE", "Width as 3.5in, or 89mm x 60mm; in, cm, mm, pt.")
@click.option(
    "--dpi", type=click.IntRange(min=1), metavar="NUMBER",
    help="Dots per inch; default: 300, of films 160.",
)  # fmt: skip
@_text("format", "NAMES", "pdf, png, svg; of films mp4, gif; default: pdf,png.", "formats")
@_MEASURED
@options.dimensionless
@options.overwrite
def plot(
    archive: Path, to: Path, dpi: int | None, formats: str, measured: Path | None, overwrite: bool,
    **chosen: Any,
) -> None:  # fmt: skip
    """Draw what ARCHIVE holds, as figures for a column or a page of a journal, or as a film of strokes.

    Without options these are the stresses on the surface, at interfaces and below, what follows from what
    is swept, and the friction loop; states and axes are chosen automatically. States that a figure does
    not show are named.

    Example: ./run.sh plot tables.h5 -o figures --states 0,4,7 --quantity sigma_XX --size 3.5in
    """
    from ..figures.archive import write
    from ..figures.choice import words
    from ..figures.files import Files

    inputs = options.inputs(archive, measured)
    files = Files(to, archive.stem, words(formats), dpi or 0, overwrite, inputs)
    result = _loaded(archive)
    selection = result.choice(measured=measured, **chosen)
    if ranks.is_root():
        _print_files(write(result.data, result.scene, selection, files))


@click.command()
@options.scene
@options.changes
@options.figures_to
@options.overwrite
def dispersion(
    scene: Path, changes: tuple[str, ...], unset: tuple[str, ...], to: Path, overwrite: bool
) -> None:
    """Print and draw the speeds of the slowest waves along the layers of SCENE.

    The highest speed of a punch is that of the slowest of them; some may be slowest in between.

    Example: ./run.sh dispersion scenes/coating.toml -o figures
    """
    from ..figures import waves

    files = _files("dispersion", scene, to, overwrite)
    lines, notes, drawing = waves.slowest_waves(options.read(scene, changes, unset))
    if ranks.is_root():
        print(*lines, sep="\n")
        for note in notes:
            say(note)
        _print_files(files.write([drawing]))


def _files(name: str, scene: Path, to: Path, overwrite: bool) -> Any:
    """Files of a scene's figure of this name, into which it may be drawn."""
    from ..figures.files import Files

    files = Files(to, scene.stem, overwrite=overwrite, inputs=options.inputs(scene))
    files.check([name])
    return files


def _print_files(written: Sequence[Any]) -> None:
    """Print the names of files of figures, and what these leave out, once for the formats of a figure."""
    for file, following in zip(written, [*written[1:], None]):
        print(f"{file.noun}: {file.path}")
        if file.left_out and (following is None or following.left_out != file.left_out):
            say(f"  {file.left_out}", 2)


_FREQUENCY = click.FloatRange(0.0, 1e6, min_open=True)


@click.command()
@options.scene
@options.changes
@click.option(
    "--from", "first", type=_FREQUENCY, default=0.01, show_default=True,
    help="Lowest angular frequency, over c_s/a.",
)  # fmt: skip
@click.option(
    "--to", "last", type=_FREQUENCY, help="Highest one; default: 10, or as far as speeds allow."
)
@click.option("--points", type=click.IntRange(2, 1000), default=41, show_default=True, help="How many.")
@options.figures_to
@options.overwrite
def response(
    scene: Path, changes: tuple[str, ...], unset: tuple[str, ...], first: float, last: float | None,
    points: int, to: Path, overwrite: bool,
) -> None:  # fmt: skip
    """Print and draw the dynamic stiffness of the flat punch of SCENE under loads that oscillate.

    The stiffness N/v0 is complex and per depth, for a load N e^(iωt) about that of the scene, at
    every speed and friction of the scene.

    Example: ./run.sh response scenes/start_from_rest.toml -o figures
    """
    from ..figures import waves as punch

    files = _files("response", scene, to, overwrite)
    checked = options.read(scene, changes, unset)
    stiffnesses = punch.answers(checked, first, last, points)
    if ranks.is_root():
        for answer in stiffnesses:
            print(answer.words)
            print(*punch.table(checked, answer), sep="\n")
        _print_files(files.write([punch.response_drawing(stiffnesses)]))


@click.command()
@options.archive
@click.option("--states", is_flag=True, help="A row a state; the default, but for motions.")
@click.option("--surface", is_flag=True, help="A row for each state and point on the surface.")
@click.option("--interfaces", is_flag=True, help="A row for each state, interface and point.")
@click.option("--inside", is_flag=True, help="A row for each state and point inside.")
@click.option("--histories", is_flag=True, help="Friction along the strokes of every law.")
@click.option("--time", is_flag=True, help="Motions in time, a row for each time; their default.")
@click.option("--slider", is_flag=True, help="Motions of sliders, a row for each time; their default.")
@options.dimensionless
@click.option("-o", "output", type=options.FILE, help="File; default: standard output.")
@options.overwrite
def csv(archive: Path, dimensionless: bool, output: Path | None, overwrite: bool, **tables: bool) -> None:
    """Write what ARCHIVE holds as one table of comma-separated values.

    Units stand in the head of each column, 1 for dimensionless. Numbers have all their digits; a cell is
    empty where there is no value, as that of the contact stress beside the punch.

    Example: ./run.sh csv tables.h5 --surface -o surface.csv
    """
    from ..results.csv import pieces, usual

    chosen = [name for name, is_set in tables.items() if is_set]
    if len(chosen) > 1:
        raise click.UsageError(
            f"{' and '.join(f'--{name}' for name in chosen)} exclude each other; keep one"
        )
    scene = _loaded(archive, stresses=False).scene
    which = chosen[0] if chosen else usual(scene)
    made = pieces(archive, which, dimensionless, verified=True)
    if not ranks.is_root():
        return
    if output is None or str(output) == "-":
        for piece in made:
            print(piece, end="")
        return
    target = Target(output, TABLE, overwrite, options.inputs(archive))
    target.write(piece.encode() for piece in made)
    print(f"table: {output}")
