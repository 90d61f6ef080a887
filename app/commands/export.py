"""Commands that give archives to other programs: csv."""

from pathlib import Path
from typing import Any

import click

from galinx.app import errors, ranks
from galinx.app.commands import options
from galinx.postprocess.target import TABLE, Target


@click.command()
@options.archive
@click.option("--states", is_flag=True, help="A row a state; this is the default.")
@click.option("--surface", is_flag=True, help="A row for each state and point on the surface.")
@click.option("--inside", is_flag=True, help="A row for each state and point inside.")
@options.si
@click.option("-o", "output", type=options.FILE, help="File; default: standard output.")
@options.overwrite
def csv(archive: Path, si: bool, output: Path | None, overwrite: bool, **tables: bool) -> int:
    """Write what ARCHIVE holds as one table of comma-separated values.

    Units stand in the head of each column, 1 for dimensionless. Numbers have all their digits; a cell is
    empty where there is no value, as that of the contact stress beside the punch.

    Example: ./run.sh csv tables.h5 --surface --si -o surface.csv
    """
    from galinx.app.results.csv import pieces

    chosen = [name for name, wanted in tables.items() if wanted] or ["states"]
    if len(chosen) > 1:
        raise click.UsageError(
            f"{' and '.join(f'--{name}' for name in chosen)} exclude each other; keep one"
        )
    if not ranks.is_root():
        return errors.GOOD
    if output is None:
        for piece in pieces(archive, chosen[0], si):
            print(piece, end="")
        return errors.GOOD
    target = Target(output, TABLE, overwrite, options.inputs(archive))
    target.write(piece.encode() for piece in pieces(archive, chosen[0], si))
    print(f"table: {output}")
    return errors.GOOD


COMMANDS: tuple[Any, ...] = (csv,)
