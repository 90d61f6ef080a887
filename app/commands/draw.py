"""Commands that draw what archives and scenes hold: plot, dispersion, response."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from galinx.app import errors, ranks
from galinx.app.commands import options
from galinx.app.console.terminal import say


@click.command()
@options.archive
@options.figures_to
@click.option(
    "--figure",
    default="",
    metavar="NAMES",
    help="friction, parameters, surface, interfaces, inside, angles, thicknesses, degrees, mesh, film; "
    "several as in surface,inside.",
)
@click.option("--states", default="", metavar="NUMBERS", help="States, see show: 0,4,7 or 0-3.")
@click.option("--quantity", default="", metavar="NAMES", help="Stresses, as in sigma_XX,von_mises.")
@click.option("--method", default="", metavar="NAME", help="closed_form, sie or fem; default: all.")
@click.option("--x", default="", metavar="NAME", help="What numbers of states are drawn over, as mu_c.")
@click.option("--y", default="", metavar="NAMES", help="These numbers, as in K_I_left,v0.")
@click.option("--by", default="", metavar="NAME", help="What tells their curves apart.")
@click.option(
    "--size", default="", metavar="SIZE", help="Width as 3.5in, or 89mm x 60mm; in, cm, mm, pt."
)
@click.option(
    "--dpi", type=int, default=0, metavar="NUMBER", help="Dots per inch; default: 300, of films 160."
)
@click.option(
    "--format",
    "formats",
    default="",
    metavar="NAMES",
    help="pdf, png, svg; of films mp4, gif; default: pdf,png.",
)
@click.option("--si", is_flag=True, help="Stresses in MPa; positions in mm where ends are found.")
@options.overwrite
def plot(
    archive: Path, to: Path, figure: str, states: str, quantity: str, method: str, x: str, y: str,
    by: str, size: str, dpi: int, formats: str, si: bool, overwrite: bool,
) -> int:  # fmt: skip
    """Draw what ARCHIVE holds, as figures for a column or a page of a journal, or as a film of strokes.

    What is not asked for is chosen by itself: the figures, the states on each, what numbers are drawn
    over. States that a figure does not show are named.

    Example: ./run.sh plot tables.h5 -o figures --states 0,4,7 --quantity sigma_XX --size 3.5in
    """
    from galinx.app.pictures import choice
    from galinx.app.pictures.files import Files
    from galinx.app.results.drawings import write
    from galinx.app.results.result import load
    from galinx.app.results.si import drawn_in_si

    wanted = choice.Choice(
        figures=choice.words(figure), quantities=choice.words(quantity),
        states=tuple(options.numbers(states)) if states else (),
        method=method, x=x, y=choice.words(y), by=by, size=choice.size(size),
    )  # fmt: skip
    files = Files(to, archive.stem, choice.words(formats), dpi, overwrite, options.inputs(archive))
    result = load(archive)
    if ranks.is_root():
        if si:
            wanted = replace(wanted, **drawn_in_si(result.data, result.scene))
        written = write(result.data, result.scene, wanted, files)
        for one, after in zip(written, [*written[1:], None]):
            print(f"{one.noun}: {one.path}")
            if one.left_out and (after is None or after.left_out != one.left_out):
                say(f"  {one.left_out}", 2)
    return errors.GOOD


@click.command()
@options.scene
@options.changes
@options.figures_to
@options.overwrite
def dispersion(
    scene: Path, changes: tuple[str, ...], unset: tuple[str, ...], to: Path, overwrite: bool
) -> int:
    """Tell and draw how fast the slowest waves along the layers of SCENE run.

    The highest speed of a punch is that of the slowest of them; some may be slowest in between.

    Example: ./run.sh dispersion scenes/coating.toml -o figures
    """
    from galinx.app.pictures import dispersion as waves
    from galinx.app.pictures.files import Files
    from galinx.app.scene.changes import from_words
    from galinx.app.scene.read import read

    files = Files(to, scene.stem, overwrite=overwrite, inputs=options.inputs(scene))
    files.check(["dispersion"])
    known = waves.curve(read(scene, from_words(changes, unset)))
    if ranks.is_root():
        print("kH (1)     wavelength (m)  speed (m/s)")
        for kH, length, speed in zip(known.kH, known.length, known.speed):
            print(f"{kH:<10.4g} {length:<15.6g} {'none' if speed != speed else f'{speed:.6g}'}")
        say("k is the wavenumber, H the thickness of all layers")
        if known.leaks:
            say(
                "none: no wave of that length is slower than the waves inside the solids; one that is "
                "faster radiates into them, and is no limit of the punch"
            )
        print(f"highest speed of a punch: {known.limit:.8g} m/s")
        for one in files.write(iter([waves.drawing(known)]), None):
            print(f"{one.noun}: {one.path}")
    return errors.GOOD


_FREQUENCY = click.FloatRange(0.0, 1e6, min_open=True)


@click.command()
@options.scene
@options.changes
@click.option(
    "--from",
    "first",
    type=_FREQUENCY,
    default=0.01,
    show_default=True,
    help="Lowest angular frequency, over c_s/a.",
)
@click.option(
    "--to", "last", type=_FREQUENCY, help="Highest one; default: 10, or as far as speeds allow."
)
@click.option(
    "--points", type=click.IntRange(2, 1000), default=41, show_default=True, help="How many."
)  # fmt: skip
@options.figures_to
@options.overwrite
def response(
    scene: Path,
    changes: tuple[str, ...],
    unset: tuple[str, ...],
    first: float,
    last: float | None,
    points: int,
    to: Path,
    overwrite: bool,
) -> int:
    """Tell and draw what the flat punch of SCENE answers to loads that oscillate while it slides.

    Its dynamic stiffness N/v0 is complex and per depth, for a load N e^(iωt) about that of the scene, at
    every speed and friction of the scene.

    Example: ./run.sh response scenes/start_from_rest.toml -o figures
    """
    from galinx.app.pictures import response as punch
    from galinx.app.pictures.files import Files
    from galinx.app.scene.changes import from_words
    from galinx.app.scene.read import read

    files = Files(to, scene.stem, overwrite=overwrite, inputs=options.inputs(scene))
    files.check(["response"])
    asked = read(scene, from_words(changes, unset))
    known = punch.answers(asked, first, last, points)
    if ranks.is_root():
        for one in known:
            print(one.words)
            print(*punch.table(asked, one), sep="\n")
        for drawn in files.write(iter([punch.drawing(known)]), None):
            print(f"{drawn.noun}: {drawn.path}")
    return errors.GOOD


COMMANDS: tuple[Any, ...] = (plot, dispersion, response)
