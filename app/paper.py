"""The study as a program: its tables and figures, computed and set beside what it printed."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from app import ranks
from app import scene as scenes
from app.progress import Progress
from app.run import compute
from app.states import solid_of
from solvers.friction.dahl import Dahl, runge_kutta

_HOME = Path(__file__).parent
_SCENES = _HOME.parent / "scenes"

#: The parameters of Tables 4-5; the others of scenes/study.toml belong to the figures.
_REFERENCE = {"mu_c": 0.7, "sigma0_over_load": 25000.0, "delta": 1.0}

_SLOW, _FAST = 4.786e-7, 0.6


def published() -> dict[str, Any]:
    """The study's printed Tables 1-5."""
    return json.loads((_HOME / "published_tables.json").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class IntensityRow:
    """One row of Table 4 or 5: published, closed form and finite elements at both ends."""

    motion: str
    X_over_L: float
    K_I: tuple[float, float, float, float]
    diff_percent: tuple[float, float, float, float]

    @property
    def agrees(self) -> bool:
        """Do all computed values round to what is printed (±0.01 in Diff %)?"""
        printed, printed_diff = self.K_I[0], self.diff_percent[0]
        return all(round(value, 4) == printed for value in self.K_I[1:]) and all(
            abs(round(value, 2) - printed_diff) < 0.0101 for value in self.diff_percent[1:]
        )


def intensity_rows(name: str, data: dict[str, Any]) -> list[IntensityRow]:
    """Rows of ``"table4"`` or ``"table5"`` from an archive that holds its states."""
    table = published()[name]
    chosen = data["states/c"] == table["c"]
    for key, value in _REFERENCE.items():
        chosen = chosen & (data[f"states/{key}"] == value)
    series = [data[f"states/{path}"] for path in ("closed_form/K_I", "fem/K_I_left", "fem/K_I_right")]
    found = {}
    for i in np.flatnonzero(chosen):
        found[data["states/motion"][i], float(data["states/X_over_L"][i])] = [s[i] for s in series]
    rows = []
    for motion, X, K_I, diff in table["rows"]:
        first, second = (found[motion, x] for m, x, *_ in table["rows"] if m == motion)
        diffs = [100.0 * abs(b - a) / a for a, b in zip(first, second)]
        rows.append(IntensityRow(motion, X, (K_I, *found[motion, X]), (diff, *diffs)))
    return rows


def table1_rows() -> list[tuple[list[float], list[float]]]:
    """Rows of Table 1: printed, and computed by the study's scheme (f, x, k1 … k4)."""
    table = published()["table1"]
    steps = table["steps"]
    law = Dahl(table["mu_c"], table["sigma0_l_over_N"], table["delta_D"])
    computed = runge_kutta(law, 0.0, 1, table["L_m"], steps)
    stride = steps // (len(table["rows"]) - 1)
    return [
        (row, [float(computed.f[i]), float(computed.d[i]), *map(float, computed.k[i])])
        for row, i in zip(table["rows"], range(0, steps + 1, stride))
    ]


def reproduce(folder: Path) -> bool:
    """Write the study's archive, tables and figures into ``folder``; True where all agrees."""
    study = scenes.read(_SCENES / "study.toml")
    if not ranks.is_root():
        compute(study)
        return True  # the verdict is rank 0's
    from postprocess.hdf5 import archive

    folder.mkdir(parents=True, exist_ok=True)
    results = []
    with Progress() as progress:
        for name, scene in (("study.h5", study), ("loops.h5", scenes.read(_SCENES / "loops.toml"))):
            with archive.Writer(folder / name) as writer:
                writer.finish(compute(scene, writer, progress))
            results.append(archive.read(folder / name))
        (data, attributes), (loops, _) = results
        progress.say("figures")
        _figures(folder, data, loops)
    good = _tables(folder, data, attributes, study)
    print(f"written to {folder}: study.h5, loops.h5, tables.txt, Figs 2 and 5-10 as PDF and PNG")
    print(f"verdict: {'PASS' if good else 'FAIL'}")
    return good


def _tables(folder: Path, data: dict[str, Any], attributes: dict[str, Any], study: Any) -> bool:
    from io import StringIO

    from postprocess.tables import new_console, new_table

    text = StringIO()
    console = new_console(text)
    table = new_table("Table 1. Dahl's law by Runge-Kutta; x in m, the rest dimensionless",
                      "", "f", "x", "k1", "k2", "k3", "k4")  # fmt: skip
    for printed, computed in table1_rows():
        for label, row in (("published", printed), ("computed", computed)):
            table.add_row(label, f"{row[0]:.4f}", f"{row[1]:.2e}", *(f"{k:.4f}" for k in row[2:]))
    console.print(table)
    console.print(
        "The last f is printed 0.4957, a misprint: its own k1 = 1 - f/μ_C = 0.0067 gives 0.4966.\n"
    )

    solid, given = solid_of(study), published()["table3"]
    table = new_table("Table 3. Slow and high speed", "", "c (1)", "V (m/s)", "time of a stroke (s)")
    for name, c in (("SS", _SLOW), ("HS", _FAST)):
        V = c * solid.c_s
        table.add_row(
            f"{name} published", *(f"{given[name][key]:.4g}" for key in ("c", "V_m_s", "time_s"))
        )
        table.add_row(f"{name} computed", f"{c:.4g}", f"{V:.5g}", f"{study.friction.pre_sliding / V:.4g}")
    console.print(table)
    console.print(
        "The study's text has V = 1880.4 m/s for c = 0.6, which Table 2 confirms; 1884 is a misprint.\n"
    )

    all_rows = []
    for name, title in (("table4", "Table 4. Slow speed"), ("table5", "Table 5. High speed")):
        table = new_table(
            f"{title}: K_I (dimensionless) and Diff % of the study, the closed form and FE",
            "", "X/L", "K publ", "exact", "FE -a", "FE a", "D% publ", "exact", "FE -a", "FE a", "agree",
        )  # fmt: skip
        rows = intensity_rows(name, data)
        all_rows += rows
        for row in rows:
            table.add_row(
                row.motion, f"{row.X_over_L:g}", *(f"{value:.4f}" for value in row.K_I),
                *(f"{value:.2f}" for value in row.diff_percent), "yes" if row.agrees else "NO",
            )  # fmt: skip
        console.print(table)
    for reason in json.loads(attributes["verdict_reasons"]):
        console.print(reason)
    (folder / "tables.txt").write_text(text.getvalue(), encoding="utf-8")
    print(text.getvalue(), end="")
    return attributes["verdict"] == "PASS" and all(row.agrees for row in all_rows)


def _figures(folder: Path, data: dict[str, Any], loops: dict[str, Any]) -> None:
    from postprocess import figures
    from postprocess.figures import Curves, parameters_match

    reference = parameters_match(loops, **_REFERENCE)
    figures.save(
        figures.loops_figure(loops, [("Dahl's law", {"FM1, BM1, FM2": reference})]), folder, "fig2"
    )
    labels = {
        "mu_c": (r"$\mu_C$", "{:g}"),
        "sigma0_over_load": (r"$\sigma_0 l/N$ (1/m)", "{:g}"),
        "delta": (r"$\delta_D$ (dimensionless)", "{:g}"),
    }
    panels = []
    for key, (symbol, _) in labels.items():
        curves = {
            f"{value:g}": parameters_match(loops, **(_REFERENCE | {key: value}))
            for value in np.unique(loops[f"states/{key}"])
        }
        panels.append((symbol, curves))
    figures.save(figures.loops_figure(loops, panels), folder, "fig6")

    for name, c in (("fig5", _SLOW), ("fig7", _FAST)):
        states = np.flatnonzero(parameters_match(data, c=c, **_REFERENCE))
        columns = []
        for X in np.unique(data["states/X_over_L"]):
            at = [i for i in states if data["states/X_over_L"][i] == X]
            columns.append(
                Curves(at, [str(data["states/motion"][i]) for i in at], f"c = {c:g}, X/L = {X:g}")
            )
        figures.save(figures.surface_figure(data, columns, loops), folder, name)

    moving = (data["states/motion"] == "FM1") & (data["states/X_over_L"] == 0.8)
    for name, (key, (symbol, form)) in zip(("fig8", "fig9", "fig10"), labels.items()):
        columns = []
        for c in (_SLOW, _FAST):
            values = np.unique(data[f"states/{key}"])
            at = [
                int(
                    np.flatnonzero(moving & parameters_match(data, c=c, **(_REFERENCE | {key: value})))[0]
                )
                for value in values
            ]
            text = [f"{symbol} = {form.format(value)}" for value in values]
            columns.append(Curves(at, text, f"FM1, X/L = 0.8, c = {c:g}"))
        figures.save(figures.surface_figure(data, columns), folder, name)
