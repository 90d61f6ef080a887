"""The study as a program: its tables, statements and figures, computed and set beside what it printed."""

import json
from collections.abc import Sequence
from io import StringIO
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.compare import RULES, judged
from galinx.postprocess.quantities import states as of
from galinx.postprocess.quantities import stresses
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.postprocess.tables import Sheet
from galinx.postprocess.target import ARCHIVE, PAGE, TABLES, Folder, Target
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.equation import UNIFORM, Equation
from galinx.solvers.contact.fem_plan import ASSEMBLERS
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.motion import friction_along

from .. import ranks
from ..console import Progress, new_console, print_sheet, program, say
from ..results.result import Result
from ..run.flow import Memory, compute
from ..scene import read as scenes
from ..scene.library import SCENES
from ..scene.scene import Scene
from .published import (
    FAST,
    INTENSITIES,
    REFERENCE,
    SLOW,
    dimensions_sheet,
    frame_sheet,
    friction_sheet,
    intensity_rows,
    intensity_sheets,
    not_as_printed,
    state_of,
    table1,
    table2,
    table3,
)
from .statements import statements, statements_sheet

#: Files that are written besides figures, and their kinds.
_FILES = {
    "study.h5": ARCHIVE, "inside.h5": ARCHIVE, "tables.txt": TABLES, "statements.txt": TABLES,
    "report.html": PAGE,
}  # fmt: skip

#: The state at which methods are set beside each other: the most friction of Tables 4 and 5.
_STROKE, _PLACE = "FM1", 0.8

#: Polynomials of the expansion; one would do for a flat punch.
_TERMS = 8


#: Lines of a verdict, as of :func:`galinx.postprocess.compare.judged`: the largest difference,
#: dimensionless, or a number of entries, and the largest that passes, by what is compared.
_Checks = dict[str, tuple[float, float]]


def failing(checks: _Checks) -> list[str]:
    """Comparisons that do not pass; NaN does not."""
    return [text for text, (value, limit) in checks.items() if not value <= limit]


def _worst(result: Result, rule: str) -> float:
    """The largest value of a comparison; NaN where nothing was compared."""
    return result.comparisons.get(RULES[rule].text, np.nan)


def reproduce(folder: Folder, progress: Progress, quiet: bool = False) -> bool:
    """Write the study's archives, tables, figures and report into ``folder``; True where all agrees.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    targets = {name: folder.target(name, kind) for name, kind in _FILES.items()}
    results = [
        _computed(scenes.read(SCENES / f"{name}.toml"), progress, targets[f"{name}.h5"])
        for name in ("study", "inside")
    ]
    results += [_computed(scene, progress) for scene in _beside()]
    if not ranks.is_root():
        return True  # the verdict is rank 0's
    study, inside, *_ = results
    methods, checks = _judged(*results)
    failed = sum(result.verdict != "PASS" for result in results)
    checks[f"runs behind these lines that are no PASS, of {len(results)}"] = failed, 0
    good = not failing(checks)
    cells = [
        (text, f"{value}" if isinstance(value, int) else f"{value:.1e}", f"{limit:g}")
        for text, (value, limit) in checks.items()
    ]
    decided = statements_sheet(statements(study.data, study.scene.solid))
    scene, details = study.scene, _details(study)
    tables = [
        table1(), table2(scene.solid), table3(scene.solid, scene.friction.pre_sliding),
        *intensity_sheets(study.data, scene.body.half_width), methods,
    ]  # fmt: skip
    reasons = [f"{text}: {value}, at most {limit}" for text, value, limit in cells]
    verdict = "PASS" if good else "FAIL"
    study.attributes |= {
        "verdict": verdict, "verdict_reasons": json.dumps(reasons, ensure_ascii=False),
    }  # fmt: skip
    page = _draw(study, inside, [decided, *tables, *details], folder, progress)
    targets["report.html"].write(page.encode())
    for name, sheets in (("tables.txt", [*tables, *details]), ("statements.txt", [decided])):
        text = StringIO()
        _print(sheets, new_console(text))
        targets[name].write(text.getvalue().encode())
    if not quiet:
        lines = Sheet("Verdict", ("", "largest", "at most"), cells)
        _print([*tables, decided, lines], new_console())
        say(f"more in tables.txt: {', '.join(sheet.title.partition(',')[0] for sheet in details)}")
        drawn = "Figs 1-10, sinusoidal, laws, inside and mesh as PDF and PNG"
        say(f"written to {folder.path}: {', '.join(_FILES)}, {drawn}")
        print(f"verdict: {verdict}")
        print(f"next: open {targets['report.html'].path} in a browser, or {program()} init")
    return good


def _computed(scene: Scene, progress: Progress, target: Target | None = None) -> Result:
    """Results of a scene, archived where there is a target; collective, rank 0 alone has the data."""
    if target is None or not ranks.is_root():
        memory = Memory()
        return Result(memory, compute(scene, memory, progress if ranks.is_root() else None))
    from galinx.postprocess.hdf5 import archive

    with archive.Writer(target) as writer:
        writer.finish(compute(scene, writer, progress))
    return Result(*archive.read(target.path, verified=True))


def _draw(
    study: Result, inside: Result, sheets: Sequence[Sheet], folder: Folder, progress: Progress
) -> str:
    """Write the figures; the report, with all of them and all tables."""
    from ..figures.choice import Archive, Choice
    from ..figures.files import Files
    from ..figures.numerics import mesh
    from ..figures.stresses import inside as draw_inside
    from ..results.report import page
    from .drawings import of_study

    drawings, plain = [], Choice()
    for drawing in of_study(study.data, study.scene):
        progress.say(f"figure: {drawing.name}")
        drawings.append(drawing)
    drawings.append(draw_inside(Archive(inside.data, inside.scene, plain)))
    drawings.append(mesh(Archive(study.data, study.scene, plain)))
    written = Files(folder.path, overwrite=folder.overwrite, inputs=folder.inputs).write(drawings)
    pixels = {file.path.stem: file.data for file in written if file.path.suffix == ".png"}
    return page(study, drawings, sheets, True, pixels)


def _beside() -> list[Scene]:
    """Scenes at the fast speed alone, whose results stand beside the study's.

    The block, and Dahl's friction with the exact pressure as tractions, in one state each; and K_I of the
    tables by either assembler on one mesh.
    """
    fast = {"motion.c": FAST, "output.quantities": ["sif"]}
    state = fast | {"motion.strokes": ["forward"], "motion.X_over_L": _PLACE}
    # Only the difference of both assemblers is read off.
    fem = {"solve.methods": [FEM], "solve.degree": 6, "solve.tolerance": 1e-3}
    return [
        scenes.read(SCENES / "box.toml", state),
        scenes.read(SCENES / "traction.toml", state | {"output.quantities": ["sif", "surface"]}),
        *(
            scenes.read(SCENES / "tables4_5.toml", fast | fem | {"solve.assembler": name})
            for name in ASSEMBLERS
        ),
    ]


def _print(sheets: Sequence[Sheet], console: Any) -> None:
    for sheet in sheets:
        print_sheet(console, sheet)
        console.print()


def _details(study: Result) -> list[Sheet]:
    """Tables of friction, of the moving frame, of intensities with dimensions, and of displacements."""
    scene, data = study.scene, study.data
    laws = [law for law in scene.friction.laws() if isinstance(law, Dahl)]
    sheets = [
        friction_sheet(laws, scene.friction.pre_sliding),
        frame_sheet(scene.solid),
        dimensions_sheet(data, scene.punch.load, scene.body.half_width),
    ]
    from ..results.fields import displacement_under_punch

    numbers = [state_of(data, c, _STROKE, _PLACE) for c in (SLOW, FAST)]
    X, displacements = displacement_under_punch(scene, numbers, 7)  # for four digits
    places = [int(np.abs(X - place).argmin()) for place in (-1.0, 0.0, 1.0)]
    rows = [
        (f"{name} ({component})", *(f"{1e6 * of_state[i][n]:+.4f}" for n in places))
        for name, of_state in zip(("SS", "HS"), displacements)
        for i, component in enumerate("uv")
    ]
    return [*sheets, Sheet(
        f"Displacements under the punch (µm), {_STROKE}, X/L = {_PLACE:g}, finite elements",
        ("", "X = -a", "X = 0", "X = a"),
        rows,
        ("Relative to the mean of the surface 100 a ahead and behind; v is the same under the punch.",),
    )]  # fmt: skip


def _judged(
    study: Result, inside: Result, block: Result, tractions: Result, *assembled: Result
) -> tuple[Sheet, _Checks]:
    """Table of the methods beside each other, and every line of the verdict."""
    scene, data = study.scene, study.data
    methods, off = _methods(study, block)
    off_table = not_as_printed(scene.solid, scene.friction.pre_sliding)
    rows = [row for name in INTENSITIES for row in intensity_rows(name, data)]
    entries = sum(not row.agrees for row in rows) + 12 - len(rows)
    return methods, {
        "Tables 1 and 3: entries not as printed, misprints aside": (off_table, 0),
        "Tables 4 and 5: rows not as printed, of 12": (entries, 0),
        **judged(study.attributes),
        "σ_YY of the raw nodal forces, no exponent assumed, relative": (_raw(data), 1e-6),
        "edge exponents fitted to them, absolute": (_worst(study, "exponents"), 1e-4),
        **{text: figures for text, figures in judged(inside.attributes).items() if "inside" in text},
        "Runge-Kutta against the exact law, f": (off["rk4"], 1e-5),
        "expansion-collocation against the closed form, K_I, relative": (off["collocation"], 1e-12),
        "the block of Fig 4: K_I, relative; its walls set it": (off["block"], 1e-2),
        "Dahl's friction and the pressure as tractions: v,X under the punch over that beside it":
            (_worst(tractions, "slope under the punch"), 1e-5),
        "K_I by dolfinx's own assembler on the same mesh at the same degree, relative":
            (_apart(*assembled), 1e-9),
    }  # fmt: skip


#: X/L of the steps of the study's Runge-Kutta scheme.
_STEPS = np.linspace(0.0, 1.0, 21)


def _methods(study: Result, block: Result) -> tuple[Sheet, dict[str, float]]:
    """Table of the methods at one state, and their differences at all of Tables 4 and 5, by name."""
    scene, data, sign = study.scene, study.data, study.scene.friction.stress_ratio
    exact, by_steps = (
        np.array([
            stroke.f for stroke in friction_along(
                Dahl(*REFERENCE.values()), scene.motion.strokes, scene.friction.pre_sliding, _STEPS,
                integrator=integrator,
            )
        ])
        for integrator in ("exact", "rk4")
    )  # fmt: skip
    f, stepped = (float(np.interp(_PLACE, _STEPS, values[0])) for values in (exact, by_steps))

    def expanded(c: float, g: float) -> NDArray[np.float64]:
        """K_I at the left and the right end by expansion and collocation, (2,)."""
        return Equation(scene.solid.response(c), UNIFORM, g, np.zeros_like).pressure(_TERMS).K_I

    of_tables = [
        (c, state_of(data, c, motion, X))
        for c, motion, X in product((SLOW, FAST), ("FM1", "BM1", "FM2"), (0.2, 0.8))
    ]
    off = {
        "rk4": float(np.abs(exact - by_steps).max()),
        "collocation": max(
            float(np.abs(expanded(c, data[of.RATIO.path][i]) / data[of.K_I_BOTH.path][i] - 1.0).max())
            for c, i in of_tables
        ),
        "confocal": _worst(study, "K_I"),
        "block": _worst(block, "K_I"),
    }

    def row(name: str, f: str, K_I: Sequence[float], key: str = "") -> tuple[str, ...]:
        blank = [""] * (2 - len(K_I))  # the block's state is a fast one
        return name, f, *blank, *(f"{value:.8f}" for value in K_I), f"{off[key]:.1e}" if key else "-"

    def formula(f: float) -> list[float]:
        return [FlatPunch(scene.solid.response(c), sign * f).K_I for c in (SLOW, FAST)]

    K_I = data[of.K_I_LEFT[FEM].path]
    rows = [
        row("exact law, closed form", f"{f:.6f}", formula(f)),
        row("Runge-Kutta, 20 steps a stroke", f"{stepped:.6f}", formula(stepped), "rk4"),
        row(
            f"expansion-collocation, {_TERMS} terms", "",
            [expanded(c, sign * f)[0] for c in (SLOW, FAST)], "collocation",
        ),
        row(
            "finite elements, confocal mesh", "",
            [K_I[state_of(data, c, _STROKE, _PLACE)] for c in (SLOW, FAST)], "confocal",
        ),
        row("finite elements, block of Fig 4", "", block.data[of.K_I_LEFT[FEM].path], "block"),
    ]  # fmt: skip
    return Sheet(
        f"Methods beside each other: {_STROKE}, X/L = {_PLACE:g}, dimensionless",
        ("", "f", "K_I, SS", "K_I, HS", "off by"),
        rows,
        (
            "K_I at X = -a; off by: the largest difference at either end in all strokes, of the block in "
            "this state at HS alone; of f absolute, of K_I relative. The block is as large as the "
            "study's, 100 punch widths: its walls, not its cells, cost that much.",
        ),
    ), off


def _apart(first: Result, second: Result) -> float:
    """Largest relative difference of K_I of finite elements between two results, at both edges."""
    paths = (of.K_I_LEFT[FEM].path, of.K_I_RIGHT[FEM].path)
    return float(max(np.abs(second.data[path] / first.data[path] - 1.0).max() for path in paths))


def _raw(data: dict[str, Any]) -> float:
    """Largest relative difference of σ_YY of nodal forces from the closed form under the punch."""
    raw, exact = data[stresses.RAW_PRESSURE.path], data[stresses.PRESSURE[CLOSED_FORM].path]
    under = np.isfinite(exact)
    return float(np.abs(raw[under] / exact[under] - 1.0).max())
