"""Commands to begin with: init, materials and schema; and fit, for measured friction."""

import json
import os
from collections.abc import Iterable
from pathlib import Path
from shlex import quote

import click

from galinx.postprocess.target import SECTION, Folder, Target

from .. import ranks
from ..console import Progress, new_console, print_sheet, program, say
from ..errors import BadInput, short
from . import options


@click.command()
@click.argument("name", required=False)
@click.option("-o", "output", type=options.FILE, help="Scene; default: NAME.toml.")
@options.overwrite
def init(name: str | None, output: Path | None, overwrite: bool) -> None:
    """Write a commented scene to begin with; without NAME, list them.

    Example: ./run.sh init own_material -o mine.toml
    """
    from ..errors import nearest
    from ..scene.library import templates

    available = templates()
    if not ranks.is_root():
        return
    if name is None:
        wide = max(map(len, available)) + 1
        for of_scene, text in available.items():
            say(f"{of_scene:<{wide}}{text.splitlines()[0].removeprefix('# ')}", wide)
        return
    if name not in available:
        raise BadInput(f"init {short(name)}: no such scene{nearest(name, available)}")
    target = output or Path(f"{name}.toml")
    Target(target, None, overwrite, options.inputs()).write(available[name].encode())
    print(f"scene: {target}")
    print(f"next: edit it, then {program()} plan {quote(str(target))}")


@click.command()
def materials() -> None:
    """List the solids that scenes know by name, with their sources.

    Example: ./run.sh materials
    """
    from ..scene.library import LIBRARY

    if ranks.is_root():
        for name, material in LIBRARY.items():
            constants = dict(material.constants)
            kind, strength = constants.pop("kind"), constants.pop("yield_strength", "")
            say(f"{name}: {material.about}")
            say(f"  {kind}: {', '.join(f'{key} = {value}' for key, value in constants.items())}", 4)
            say(f"  {material.source}", 4)
            if strength:
                say(f"  yield strength {strength}: {material.yield_source}", 4)


@click.command()
def schema() -> None:
    """Print the JSON schema of scenes, for editors that complete and check TOML.

    Example: ./run.sh schema > scene.schema.json
    """
    from ..scene.sections import schema as made

    if ranks.is_root():
        print(json.dumps(made(), ensure_ascii=False, indent=1))


def _pairs(option: str, words: Iterable[str]) -> dict[str, str]:
    """Values by key, of words KEY=VALUE."""
    pairs = {}
    for word in words:
        key, equals, value = (part.strip() for part in word.partition("="))
        if not (key and equals and value):
            raise BadInput(f"{option} {short(word)}: expected KEY=VALUE, as in {option} mu_c=0.4")
        pairs[key] = value
    return pairs


@click.command()
@click.argument("words", nargs=-1, required=True, metavar="[LAW] DATA...")
@click.option("--model", metavar="LAW", help="Law to fit; all: each, best first.  [default: all]")
@click.option(
    "--fix", multiple=True, metavar="KEY=VALUE", help="A parameter that is known; may be repeated."
)
@click.option(
    "--start", multiple=True, metavar="KEY=VALUE", help="What the search begins with; may be repeated."
)
@click.option(
    "--speed", multiple=True, metavar="SPEED",
    help="Of a table of slips, as '1 mm/s'; may be repeated, for each.",
)  # fmt: skip
@click.option(
    "--rows", type=int, default=3, show_default=True,
    help="Rows of a law's table, as the springs of Maxwell slip; 1 to 20.",
)  # fmt: skip
@click.option("--into", type=options.FILE, metavar="SCENE", help="Scene whose friction law is replaced.")
@click.option(
    "-o", "to", type=options.PATH, default=Path("fit"), show_default=True,
    help="Folder; it is made. With --into, NEW.toml: the scene with the law, SCENE stays.",
)  # fmt: skip
@options.overwrite
@options.talk
def fit(
    words: tuple[str, ...], model: str | None, fix: tuple[str, ...], start: tuple[str, ...],
    speed: tuple[str, ...], rows: int, into: Path | None, to: Path, overwrite: bool, progress: Progress,
    quiet: bool,
) -> None:  # fmt: skip
    """Find friction laws and their parameters from measured friction DATA.

    DATA are tables, measured on one contact. The first line names the columns, units in brackets: "slip
    [mm],f" for one stroke from rest, or "time [s],position [mm],f" for any motion; instead of f, friction
    over load, also "force [N],load [N]". Commas, semicolons with decimal commas, or tabs separate them.
    All laws are compared unless one is named. The section [friction] of the best, and figures with the
    residuals, are written into a folder.

    Example: ./run.sh fit scenes/slip.csv --model dahl -o fit
    """
    from ..figures.choice import Drawing
    from ..figures.files import Files
    from ..figures.friction import fitted_figure
    from ..results.fitted import ALL
    from ..results.fitted import fit as fit_laws
    from ..scene.read import read as read_scene

    if not ranks.is_root():
        return
    named = [words[0]] if not model and "." not in words[0] and not os.path.exists(words[0]) else []
    data = [Path(word) for word in words[len(named) :]]
    if not data:
        raise BadInput(f"found no table, expected as in {program()} fit scenes/slip.csv")
    new = to if into and to.suffix == ".toml" else into
    folder = Path("fit") if into and new == to else to
    inputs = options.inputs(*data, into if new != into else None)
    scene_to = Target(new, None, overwrite or new == into, inputs) if new else None
    if into:
        read_scene(into)  # its faults are reported before the work
    law = model or (named[0] if named else ALL)
    fixed, guess = _pairs("--fix", fix), _pairs("--start", start)
    if both := fixed.keys() & guess.keys():
        raise BadInput(f"--fix and --start {min(both)} exclude each other; keep one")
    with progress:
        best = fit_laws(data, law, fix=fixed, start=guess, speed=speed, rows=rows, progress=progress)
    to_folder = Folder(folder, overwrite, inputs)
    target = to_folder.target("friction.toml", SECTION)
    section = best.scene()
    if scene_to:
        scene_to.write(best.scene(into).encode())
    target.write(section.encode())
    names = ["fit", *(f"fit_{n}" for n in range(2, len(best.tables) + 1))]
    Files(folder, overwrite=overwrite, inputs=inputs).write(
        Drawing(name, "", fitted_figure(table.measured, f, table.timed))
        for name, table, f in zip(names, best.tables, best.f)
    )
    if not quiet:
        if law == ALL:
            print_sheet(new_console(), best.sheet())
        print(section, end="")
        for note in best.notes:
            say(f"note: {note}")
        print(f"scene: {new}" if new else f"section: {folder / 'friction.toml'}")
        print(f"figure: {', '.join(str(folder / f'{name}.pdf') for name in names)}")
        scene_name = new or "SCENE.toml"
        hint = f"{program()} run {scene_name}"
        print(f"next: {hint if new else f'put the section into a scene, with --into, then {hint}'}")
