"""Run the matrix, print its table, write its archive and figures."""

from collections.abc import Callable
from pathlib import Path

from galinx.app import ranks
from galinx.app.console.progress import Progress
from galinx.app.extremes import friction_law, mechanics, resolution
from galinx.app.extremes.row import Row

#: Every row, cheap ones first.
ROWS: tuple[Callable[[], Row], ...] = (
    friction_law.exact_law, friction_law.runge_kutta_steps, mechanics.units, mechanics.frictions,
    mechanics.speeds, mechanics.solids, resolution.edges, resolution.radii, resolution.degrees,
)  # fmt: skip


def stress(folder: Path) -> bool:
    """Whether every row keeps its word; archive, figures and table go into ``folder``."""
    rows = []
    with Progress() as progress:
        for i, make in enumerate(ROWS):
            progress.say((make.__doc__ or make.__name__).splitlines()[0])
            rows.append(make())
            progress.done(i + 1, len(ROWS))
    good = all(verdict.holds for row in rows for verdict in row.verdicts)
    if ranks.is_root():
        _write(folder, rows, good)
    return good


def _write(folder: Path, rows: list[Row], good: bool) -> None:
    from galinx.app.console.sheets import new_console
    from galinx.postprocess.figures.canvas import save
    from galinx.postprocess.figures.lines import lines_figure
    from galinx.postprocess.hdf5 import archive

    folder.mkdir(parents=True, exist_ok=True)
    with archive.Writer(folder / "stress.h5") as writer:
        for row in rows:
            writer.put(f"{row.name}/x", row.x, ("1", row.x_label))
            for label, values in row.lines.items():
                writer.put(f"{row.name}/{label.replace('/', ' over ')}", values, ("1", row.y_label))
            texts = [f"{'holds' if v.holds else 'FAILS'}: {v.text}" for v in row.verdicts]
            writer.put(f"{row.name}/verdicts", texts, ("none", row.title))
        writer.finish({"program": "galinx stress", "verdict": "PASS" if good else "FAIL"})
    console = new_console()
    for row in rows:
        figure = lines_figure(row.x, row.lines, row.x_label, row.y_label, row.title, row.log_x)
        save(figure, folder, row.name)
        console.print(f"{row.name}: {row.title}")
        for verdict in row.verdicts:
            console.print(f"  {'holds' if verdict.holds else 'FAILS'}  {verdict.text}")
    console.print(f"written to {folder}: stress.h5, a figure of each row as PDF and PNG")
    console.print(f"verdict: {'PASS' if good else 'FAIL'}")
