"""Run the matrix, print its table, write its archive and figures."""

from collections.abc import Callable
from functools import partial
from typing import Any

import friction_law
import mechanics
import resolution
from all_kinds import all_kinds
from random_scenes import random_scenes
from row import Row

from galinx.app import ranks
from galinx.app.console import Progress
from galinx.postprocess.target import ARCHIVE, Folder, Target

#: Every row but the random scenes, cheap ones first.
ROWS: tuple[Callable[[], Row], ...] = (
    friction_law.exact_law, friction_law.runge_kutta_steps, mechanics.units, mechanics.frictions,
    mechanics.speeds, mechanics.solids, resolution.edges, resolution.radii, resolution.degrees,
)  # fmt: skip


def stress(folder: Folder, seed: int = 1, scenes: int = 300) -> bool:
    """Whether every row keeps its word; archive, figures and table go into ``folder``.

    Args:
        folder: is made.
        seed, scenes: random number seed, and number of the random scenes of each of both rows.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    makers: tuple[Callable[[], Row], ...] = (
        *ROWS, partial(random_scenes, seed, scenes), partial(all_kinds, seed, scenes),
    )  # fmt: skip
    target, rows = folder.target("stress.h5", ARCHIVE), []
    with Progress() as progress:
        for i, make in enumerate(makers):
            progress.say((getattr(make, "func", make).__doc__ or repr(make)).splitlines()[0])
            rows.append(make())
            progress.done(i + 1, len(makers))
    good = all(verdict.holds for row in rows for verdict in row.verdicts)
    if ranks.is_root():
        from galinx.app.figures.choice import Drawing
        from galinx.app.figures.files import Files

        drawings = (Drawing(row.name, row.title, _figure(row)) for row in rows)
        Files(folder.path, overwrite=folder.overwrite, inputs=folder.inputs).write(drawings)
        _write(target, rows, good)
    return good


def _figure(row: Row) -> Any:
    """Lines of a row over its x, the y axis logarithmic."""
    from galinx.app.figures.render import JOINED, Curve, Panel, Size, render
    from galinx.app.figures.style import LINES, looks

    curves = [
        Curve(row.x, y, look._replace(line=LINES[0]), label, JOINED)
        for (label, y), look in zip(row.lines.items(), looks(len(row.lines)))
    ]
    panel = Panel(row.x_label, row.y_label, curves=curves, title=row.title, log="y" + "x" * row.log_x)
    return render([panel], Size(5.0))


def _write(target: Target, rows: list[Row], good: bool) -> None:
    from galinx.app.console import new_console
    from galinx.postprocess.hdf5 import archive

    with archive.Writer(target) as writer:
        for row in rows:
            writer.put(f"{row.name}/x", row.x, ("1", row.x_label))
            for label, values in row.lines.items():
                writer.put(f"{row.name}/{label.replace('/', ' over ')}", values, ("1", row.y_label))
            texts = [f"{'holds' if v.holds else 'FAILS'}: {v.text}" for v in row.verdicts]
            writer.put(f"{row.name}/verdicts", texts, ("none", row.title))
        writer.finish({"program": "run.sh stress", "verdict": "PASS" if good else "FAIL"})
    console = new_console()
    for row in rows:
        console.print(f"{row.name}: {row.title}")
        for verdict in row.verdicts:
            console.print(f"  {'holds' if verdict.holds else 'FAILS'}  {verdict.text}")
    console.print(f"written to {target.path.parent}: stress.h5, a figure of each row as PDF and PNG")
    console.print(f"verdict: {'PASS' if good else 'FAIL'}")
