"""The study as a program: its tables and figures, computed and set beside what it printed."""

import json
from io import StringIO
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
from galinx.postprocess.target import ARCHIVE, PAGE, TABLES, Folder, Target

#: What is written besides figures.
_FILES = {"study.h5": ARCHIVE, "inside.h5": ARCHIVE, "tables.txt": TABLES, "report.html": PAGE}


def reproduce(folder: Folder, progress: Progress, quiet: bool = False) -> bool:
    """Write the study's archives, tables, figures and report into ``folder``; True where all agrees.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    study, inside = (scenes.read(SCENES / f"{name}.toml") for name in ("study", "inside"))
    targets = {name: folder.target(name, kind) for name, kind in _FILES.items()}
    if not ranks.is_root():
        compute(study), compute(inside)
        return True  # the verdict is rank 0's
    from galinx.app.pictures.choice import Choice
    from galinx.app.pictures.inside import inside as draw_inside
    from galinx.app.pictures.numerics import mesh
    from galinx.app.results.report import Report
    from galinx.app.study.drawings import of_study
    from galinx.postprocess.figures.canvas import save
    from galinx.postprocess.hdf5 import archive, reader

    results = []
    for name, scene in (("study.h5", study), ("inside.h5", inside)):
        with archive.Writer(targets[name]) as writer:
            writer.finish(compute(scene, writer, progress))
        results.append(reader.read(targets[name].path, just_sealed=True))
    (data, attributes), (below, _) = results
    good, sheets = _tables(data, attributes, study)
    report = Report(data, attributes, study, sheets)
    drawings, plain = [], Choice()
    for drawing in of_study(data, study):
        progress.say(f"figure: {drawing.name}")
        drawings.append(drawing)
    drawings += [draw_inside(below, inside, plain), mesh(data, study, plain)]
    pixels = save(((drawing.name, drawing.figure) for drawing in drawings), folder)
    for drawing in drawings:
        report.add(drawing, pixels[drawing.name])
    targets["report.html"].write(report.text().encode())
    _print(targets["tables.txt"], sheets, attributes, quiet)
    if not quiet:
        drawn = "Figs 1-10, sinusoidal, laws, inside and mesh as PDF and PNG"
        say(f"written to {folder.path}: {', '.join(_FILES)}, {drawn}")
        print(f"verdict: {'PASS' if good else 'FAIL'}")
        print(f"next: open {targets['report.html'].path} in a browser, or {program()} init")
    return good


def _print(target: Target, sheets: list[Sheet], attributes: dict[str, Any], quiet: bool) -> None:
    from galinx.app.console.sheets import new_console, print_sheet

    text = StringIO()
    for console in [new_console(text)] + [new_console(colours=colours())] * (not quiet):
        for sheet in sheets:
            print_sheet(console, sheet)
            console.print()
        for reason in json.loads(attributes["verdict_reasons"]):
            console.print(reason)
    target.write(text.getvalue().encode())


def _tables(data: dict[str, Any], attributes: dict[str, Any], study: Scene) -> tuple[bool, list[Sheet]]:
    """Whether all agrees, and the tables that show it."""
    rows = {name: intensity_rows(name, data) for name in INTENSITIES}
    sheets = [table1(), table3(study.solid, study.friction.pre_sliding)]
    sheets += [intensities(name, found) for name, found in rows.items()]
    agree = all(row.agrees for found in rows.values() for row in found) and all(rows.values())
    return attributes["verdict"] == "PASS" and agree, sheets
