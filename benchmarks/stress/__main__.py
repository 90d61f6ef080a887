"""``./run.sh stress``: extremes of every parameter, and whether the promises hold there."""

from pathlib import Path

import click

from galinx.__main__ import main
from galinx.app import errors
from galinx.app.cli import cli
from galinx.app.commands import options
from galinx.postprocess.target import Folder


@cli.command()
@options.folder("stress")
@click.option("--seed", type=int, default=1, show_default=True, help="Of the random scenes.")
@click.option(
    "--scenes", type=click.IntRange(4), default=300, show_default=True, help="Number of random scenes."
)
@options.overwrite
def stress(folder: Path, seed: int, scenes: int, overwrite: bool) -> int:
    """Try extremes of every parameter, and say whether the promises hold there.

    Example: ./run.sh stress -o stress
    """
    import matrix  # slow imports, which --help does without

    good = matrix.stress(Folder(folder, overwrite, options.inputs()), seed, scenes)
    return errors.GOOD if good else errors.FAILED_VERDICT


if __name__ == "__main__":
    main()
