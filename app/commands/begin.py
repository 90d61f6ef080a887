"""Commands to begin with: init, materials, schema."""

import json
from pathlib import Path
from typing import Any

import click

from galinx.app import errors, ranks
from galinx.app.commands import options
from galinx.app.console.program import program
from galinx.app.console.terminal import say
from galinx.app.errors import BadInput
from galinx.postprocess.target import Target


@click.command()
@click.argument("name", required=False)
@click.option("-o", "output", type=options.FILE, help="Scene; default: NAME.toml.")
@options.overwrite
def init(name: str | None, output: Path | None, overwrite: bool) -> int:
    """Write a commented scene to begin with; without NAME, list them.

    Example: ./run.sh init own_material -o mine.toml
    """
    from galinx.app.scene.excerpt import nearest, short
    from galinx.app.scene.templates import templates

    known = templates()
    if not ranks.is_root():
        return errors.GOOD
    if name is None:
        for template in known.values():
            say(f"{template.name:<16} {template.about}", 17)
        return errors.GOOD
    if name not in known:
        raise BadInput(f"init {short(name)}: no such scene{nearest(name, known)}")
    target = output or Path(f"{name}.toml")
    Target(target, None, overwrite, options.inputs()).write(known[name].text.encode())
    print(f"scene: {target}")
    print(f"next: edit it, then {program()} plan {target}")
    return errors.GOOD


@click.command()
def materials() -> int:
    """List the solids that scenes know by name, with their sources.

    Example: ./run.sh materials
    """
    from galinx.app.scene.materials import LIBRARY

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
    from galinx.app.scene.schema import schema as made

    if ranks.is_root():
        print(json.dumps(made(), ensure_ascii=False, indent=1))
    return errors.GOOD


COMMANDS: tuple[Any, ...] = (init, materials, schema)
