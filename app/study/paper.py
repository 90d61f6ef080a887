"""The study as a program: its tables and figures, computed and set beside what it printed."""

import json
from io import StringIO
from pathlib import Path
from typing import Any

from galinx.app import ranks
from galinx.app.console.program import program
from galinx.app.console.progress import Progress
from galinx.app.console.terminal import colours, say
from galinx.app.run.flow import compute
from galinx.app.scene import read as scenes
from galinx.app.scene.scene import Scene
from galinx.app.scene.templates import SCENES
from galinx.app.study.published import INTENSITIES, intensities, intensity_rows, table1, table3
from galinx.postprocess.tables import Sheet


def reproduce(folder: Path, progress: Progress, quiet: bool = False) -> bool:
    """Write the study's archives, tables, figures and report into ``folder``; True where all agrees."""
    study, inside = (scenes.read(SCENES / f"{name}.toml") for name in ("study", "inside"))
    if not ranks.is_root():
        compute(study), compute(inside)
        return True  # the verdict is rank 0's
    from galinx.app.results.drawings import inside as draw_inside
    from galinx.app.results.drawings import mesh
    from galinx.app.results.report import Report, write_report
    from galinx.app.study.drawings import of_study
    from galinx.postprocess.figures.canvas import save
    from galinx.postprocess.hdf5 import archive

    folder.mkdir(parents=True, exist_ok=True)
    results = []
    for name, scene in (("study", study), ("inside", inside)):
        with archive.Writer(folder / f"{name}.h5") as writer:
            writer.finish(compute(scene, writer, progress))
        results.append(archive.read(folder / f"{name}.h5"))
    (data, attributes), (below, _) = results
    good, sheets = _tables(data, attributes, study)
    report = Report(data, attributes, study, sheets)
    for drawing in (*of_study(data), draw_inside(below, inside), mesh(study)):
        progress.say(f"figure: {drawing.name}")
        report.add(drawing)
        save(drawing.figure, folder, drawing.name)
    write_report(folder / "report.html", report)
    _print(folder, sheets, attributes, quiet)
    if not quiet:
        figures = "Figs 2 and 5-10, inside and mesh as PDF and PNG"
        say(f"written to {folder}: study.h5, inside.h5, tables.txt, report.html, {figures}")
        print(f"verdict: {'PASS' if good else 'FAIL'}")
        print(f"next: open {folder / 'report.html'} in a browser, or {program()} init")
    return good


def _print(folder: Path, sheets: list[Sheet], attributes: dict[str, Any], quiet: bool) -> None:
    from galinx.app.console.sheets import new_console, print_sheet

    text = StringIO()
    for console in [new_console(text)] + [new_console(colours=colours())] * (not quiet):
        for sheet in sheets:
            print_sheet(console, sheet)
            console.print()
        for reason in json.loads(attributes["verdict_reasons"]):
            console.print(reason)
    (folder / "tables.txt").write_text(text.getvalue(), encoding="utf-8")


def _tables(data: dict[str, Any], attributes: dict[str, Any], study: Scene) -> tuple[bool, list[Sheet]]:
    """Whether all agrees, and the tables that show it."""
    rows = {name: intensity_rows(name, data) for name in INTENSITIES}
    sheets = [table1(), table3(study.solid, study.friction.pre_sliding)]
    sheets += [intensities(name, found) for name, found in rows.items()]
    agree = all(row.agrees for found in rows.values() for row in found) and all(rows.values())
    return attributes["verdict"] == "PASS" and agree, sheets
