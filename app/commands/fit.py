"""Commands for measurements: fit."""

from pathlib import Path
from typing import Any

import click

from galinx.app import errors, ranks
from galinx.app.commands import options
from galinx.app.console.program import program
from galinx.postprocess.target import SECTION, Folder


@click.command()
@click.argument("law")
@click.argument("data", type=options.FILE)
@click.option(
    "--fix", multiple=True, metavar="KEY=VALUE", help="A parameter that is known; may be repeated."
)
@click.option(
    "--start", multiple=True, metavar="KEY=VALUE", help="What the search begins with; may be repeated."
)
@click.option("--speed", default="", metavar="SPEED", help="Of a table of slips, as '1 mm/s'.")
@click.option(
    "--rows", type=click.IntRange(1, 20), default=3, show_default=True,
    help="Of a law's table, as the springs of Maxwell slip.",
)  # fmt: skip
@options.folder("fit")
@options.overwrite
def fit(
    law: str, data: Path, fix: tuple[str, ...], start: tuple[str, ...], speed: str, rows: int,
    folder: Path, overwrite: bool,
) -> int:  # fmt: skip
    """Find the parameters of the friction law LAW from measured friction DATA.

    DATA is a table of comma-separated values. Its first line names the columns, units in brackets: "slip
    [mm],f" for one stroke from rest, or "time [s],position [mm],f" for any motion. f is friction over
    load. The section [friction] of a scene and a figure with the residuals are written into a folder.

    Example: ./run.sh fit dahl scenes/slip.csv -o fit
    """
    from galinx.app.results.fitted import figure, fitted, section
    from galinx.postprocess.figures.canvas import save

    if not ranks.is_root():
        return errors.GOOD
    to = Folder(folder, overwrite, options.inputs(data))
    target = to.target("friction.toml", SECTION)
    measured, found = fitted(law, data, list(fix), list(start), speed, rows)
    text = section(law, data, measured, found)
    target.write(text.encode())
    save([("fit", figure(measured, found))], to)
    print(text, end="")
    print(f"section: {folder / 'friction.toml'}")
    print(f"figure: {folder / 'fit.pdf'}")
    print(f"next: put the section into a scene, then {program()} run SCENE.toml")
    return errors.GOOD


COMMANDS: tuple[Any, ...] = (fit,)
