"""Commands to begin with: init, materials and schema; and fit, for measured friction."""

import json
from pathlib import Path
from typing import Any

import click

from galinx.postprocess.target import SECTION, Folder, Target

from .. import errors, ranks
from ..console import program, say
from ..errors import BadInput
from . import options


@click.command()
@click.argument("name", required=False)
@click.option("-o", "output", type=options.FILE, help="Scene; default: NAME.toml.")
@options.overwrite
def init(name: str | None, output: Path | None, overwrite: bool) -> int:
    """Write a commented scene to begin with; without NAME, list them.

    Example: ./run.sh init own_material -o mine.toml
    """
    from ..errors import nearest, short
    from ..scene.library import templates

    available = templates()
    if not ranks.is_root():
        return errors.GOOD
    if name is None:
        for template in available.values():
            say(f"{template.name:<16} {template.about}", 17)
        return errors.GOOD
    if name not in available:
        raise BadInput(f"init {short(name)}: no such scene{nearest(name, available)}")
    target = output or Path(f"{name}.toml")
    Target(target, None, overwrite, options.inputs()).write(available[name].text.encode())
    print(f"scene: {target}")
    print(f"next: edit it, then {program()} plan {target}")
    return errors.GOOD


@click.command()
def materials() -> int:
    """List the solids that scenes know by name, with their sources.

    Example: ./run.sh materials
    """
    from ..scene.library import LIBRARY

    if ranks.is_root():
        for name, material in LIBRARY.items():
            say(f"{name}: {material.about}")
            say(f"  {material.kind}: {material.told}", 4)
            say(f"  {material.source}", 4)
            if material.yield_strength:
                say(f"  yield strength {material.yield_strength}: {material.yield_source}", 4)
    return errors.GOOD


@click.command()
def schema() -> int:
    """Print the JSON schema of scenes, for editors that complete and check TOML.

    Example: ./run.sh schema > scene.schema.json
    """
    from ..scene.sections import schema as made

    if ranks.is_root():
        print(json.dumps(made(), ensure_ascii=False, indent=1))
    return errors.GOOD


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
    from ..figures.files import save
    from ..results.fitted import figure, fitted, section

    if not ranks.is_root():
        return errors.GOOD
    to = Folder(folder, overwrite, options.inputs(data))
    target = to.target("friction.toml", SECTION)
    measured, result = fitted(law, data, list(fix), list(start), speed, rows)
    text = section(law, data, measured, result)
    target.write(text.encode())
    save([("fit", figure(measured, result))], to)
    print(text, end="")
    print(f"section: {folder / 'friction.toml'}")
    print(f"figure: {folder / 'fit.pdf'}")
    print(f"next: put the section into a scene, then {program()} run SCENE.toml")
    return errors.GOOD


COMMANDS: tuple[Any, ...] = (init, materials, schema, fit)
