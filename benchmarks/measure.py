"""Run time against error of whole galinx processes; see benchmarks/README.md."""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass, field, fields
from io import BytesIO
from pathlib import Path
from statistics import median
from typing import Any

import h5py
import matplotlib
import numpy as np
from energy import counters, joules

import galinx
from galinx.postprocess.errors import Occupied, UnwritableArchive
from galinx.postprocess.target import Folder, Target

matplotlib.use("Agg")
from matplotlib import pyplot as plt

HOME = Path(__file__).parent.parent
REPEATS = 3


@dataclass(frozen=True)
class Case:
    """A scene of scenes/ with other values by ``"section.key"``, on a number of ranks."""

    name: str
    scene: str
    changes: dict[str, Any] = field(default_factory=dict)
    ranks: int = 1


@dataclass(frozen=True)
class Figures:
    """Medians of a case; seconds of the whole process, memory in MB, errors relative, energy in J."""

    name: str
    states: int
    unknowns: int
    wall: float
    cpu: float
    memory: float
    K_I: float
    sigma_YY: float
    sigma_XX: float
    estimate: float
    energy: float = np.nan


def positions(count: int) -> dict[str, Any]:
    """So many positions along a stroke."""
    return {"motion.X_over_L": {"from": 0.0, "to": 1.0, "number": count}}


FEM_ALONE = {"solve.methods": ["fem"]}
ONE_STATE = {"motion.c": 0.6, "motion.X_over_L": 0.8, "motion.strokes": ["forward"]}
SIXTEEN = {"motion.c": [n / 20 for n in range(16)], "solve.sweep": "every"} | positions(334) | FEM_ALONE
SPEEDS = {"motion.c": {"from": 0, "to": 0.9, "number": 256}} | positions(34)
FINE = {"solve.tolerance": 1e-9}
#: One speed, one friction, K_I or what stands in its place, by finite elements at 1e-6.
ALIKE = {"motion.c": 0.6, "motion.X_over_L": 0.8, "motion.strokes": ["forward"], "solve.tolerance": 1e-6}
ALIKE |= {"output.quantities": ["friction", "sif"], "solve.methods": ["closed_form", "fem"]}
CYLINDER = {"punch.profile": "parabolic", "punch.radius": "20 mm", "punch.load": "55.3 N/mm"}
LOADS = {"punch.load": {"from": "1 N/mm", "to": "50 N/mm", "number": 1000}}
FIBRES = {"solid.material": "carbon-epoxy", "solid.angle": 30, "motion.c": 0.2}
STACK = {"friction.mu_c": 0.4, "solve.tolerance": 1e-6}
K_I_ALONE = {"output.quantities": ["friction", "sif"]}
BOTH, SIE = {"solve.methods": ["sie", "fem"]}, {"solve.methods": ["sie"]}
COATED = STACK | K_I_ALONE | {"friction.model": "dahl", "friction.sigma0_over_load": "25000 1/m"}
COATED |= {"friction.pre_sliding": "0.1 mm", "friction.delta": 1.0} | positions(100) | FEM_ALONE
COATED_SPEEDS = {"motion.speed": {"from": "1 m/s", "to": "900 m/s", "number": 256}}
LOOP = {"output.quantities": ["friction"]} | positions(33334)

#: What else slides, beside the flat punch on steel.
OTHERS = [
    Case("flat punch", "tables4_5", ALIKE),
    Case("cylinder", "shoulders", ALIKE | CYLINDER),
    Case("wedge", "shoulders", {"punch.profile": "wedge", "punch.slope": 0.005} | ALIKE),
    Case("rounded flat", "shoulders", ALIKE),
    Case("cylinder, 1 000 loads", "shoulders", ALIKE | CYLINDER | LOADS),
    Case("copper", "tables4_5", {"solid.material": "copper"} | ALIKE),
    Case("fibres at 30°", "tables4_5", ALIKE | FIBRES),
    Case("coating, integral equation", "coating", STACK | K_I_ALONE | SIE),
    Case("coating, both methods", "coating", STACK | K_I_ALONE | BOTH),
    Case("coating, both, with its interface", "coating", STACK | BOTH),
    Case("coating, 1 speed x 100 states, finite elements", "coating", COATED),
    Case("coating, 256 speeds x 100 states, finite elements", "coating", COATED | COATED_SPEEDS),
    Case("cylinder on a coating, both", "coating", STACK | BOTH | CYLINDER),
    Case("start from rest to t = 20, both", "start_from_rest", {"time.end": 20.0}),
    Case("friction: Dahl", "fig2", LOOP),
    Case("stick-slip, 30 s", "slider"),
]

CASES = [
    *(Case(f"tolerance 1e-{n}", "tables4_5", {"solve.tolerance": 10.0**-n}) for n in range(2, 10)),
    *(
        Case(f"c = 0.9, tolerance 1e-{n}", "tables4_5", {"motion.c": 0.9, "solve.tolerance": 10.0**-n})
        for n in (4, 6, 8)
    ),
    Case("study's box", "box"),
    Case("graded mesh", "graded"),
    Case("1 state", "tables4_5", ONE_STATE | FEM_ALONE),
    Case("10 002 states", "tables4_5", {"motion.c": 0.6} | positions(3334) | FEM_ALONE),
    Case("16 speeds x 1 002 states", "tables4_5", SIXTEEN),
    Case("the same, 2 ranks", "tables4_5", SIXTEEN, ranks=2),
    Case("16 speeds x 1 002 states, 1e-9", "tables4_5", SIXTEEN | FINE),
    Case("the same, 1e-9, 2 ranks", "tables4_5", SIXTEEN | FINE, ranks=2),
    Case("256 speeds x 102 states", "tables4_5", SPEEDS),
    Case("friction alone", "fig6"),
    Case("closed form alone", "tables4_5", {"solve.methods": ["closed_form"]}),
]


def run(case: Case, folder: Path) -> Figures:
    """Median figures of a case, after one run that warms the caches."""
    scene, archive = folder / "scene.toml", folder / "out.h5"
    scene.write_text(galinx.template(case.scene, case.changes).text, encoding="utf-8")
    command = [str(HOME / "run.sh")] + (["-n", str(case.ranks)] if case.ranks > 1 else [])
    command += ["run", str(scene), "-o", str(archive), "--overwrite"]
    measured = [consumption(command) for _ in range(REPEATS + 1)][1:]
    used = {name: median(each[name] for each in measured) for name in measured[0]}
    return Figures(case.name, **used, **_results(archive))


def consumption(command: list[str], environment: dict[str, str] | None = None) -> dict[str, float]:
    """Wall and processor seconds of a command, MB of its largest process, J of the processor or NaN."""
    before, started = counters(), time.perf_counter()
    process = subprocess.Popen(
        command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode > 1:
        sys.exit(f"error: {' '.join(command)} ended with status {process.returncode}")
    return {
        "wall": time.perf_counter() - started,
        "cpu": usage.ru_utime + usage.ru_stime,
        "memory": usage.ru_maxrss / 1024.0,
        "energy": joules(before, counters()),
    }


def _results(archive: Path) -> dict[str, float]:
    with h5py.File(archive) as file:
        worst = json.loads(file.attrs["comparisons"])
        unknowns = file["run/fem/unknowns"][()].max() if "run/fem" in file else 0
        states = len(file["states/f"])

    def of(beginning: str) -> float:
        return next((value for text, value in worst.items() if text.startswith(beginning)), np.nan)

    return {
        "states": states,
        "unknowns": int(unknowns),
        "K_I": of("K_I"),
        "sigma_YY": of("σ_YY"),
        "sigma_XX": of("σ_XX"),
        "estimate": of("estimated"),
    }


def without_start() -> list[Figures]:
    """One state at rest: galinx's default, and the study's block with its number of elements."""
    script = HOME / "benchmarks" / "study_box.py"
    environment = os.environ | {"PYTHONPATH": str(HOME)}
    text = subprocess.run(
        [sys.executable, str(script)], env=environment, capture_output=True, text=True, check=True
    ).stdout
    nothing = {"states": 1, "sigma_YY": np.nan, "sigma_XX": np.nan, "estimate": np.nan}
    rows = [json.loads(line) for line in text.splitlines()]
    names = [each.name for each in fields(Figures)]
    return [Figures(**{k: v for k, v in (nothing | row).items() if k in names}) for row in rows]


def steps(folder: Path) -> str:
    """Where the time of Tables 4 and 5 goes, with nothing in the caches and with all, as Markdown.

    Steps that take less than a twentieth of a second are left out.
    """
    scene, archive = HOME / "scenes" / "tables4_5.toml", folder / "out.h5"
    command = [str(HOME / "run.sh"), "run", str(scene), "-o", str(archive), "--overwrite"]
    found = []
    environment = os.environ | {"XDG_CACHE_HOME": str(folder / "cache")}
    for _ in range(2):  # cold, then warm
        wall = consumption(command, environment)["wall"]
        with h5py.File(archive) as file:
            seconds = dict(zip(file["run/steps"].asstr()[()], file["run/seconds"][()]))
        found.append({"whole process": wall} | seconds)
    lines = ["| step | cold (s) | warm (s) |", "|---|---|---|"]
    lines += [
        f"| {name} | {found[0][name]:.3f} | {found[1][name]:.3f} |"
        for name in found[0]
        if found[0][name] >= 0.05
    ]
    return "\n".join(lines) + "\n"


def table(figures: list[Figures]) -> str:
    """The figures as Markdown; energy where any case has it."""
    told = any(not np.isnan(f.energy) for f in figures)
    titles = ["case", "states", "unknowns", "wall (s)", "memory (MB)"]
    titles += ["energy (J)"] * told + ["K_I", "σ_XX", "estimate"]
    lines = [f"| {' | '.join(titles)} |", "|---" * len(titles) + "|"]
    for f in figures:
        errors = (f.K_I, f.sigma_XX, f.estimate)
        row = [f.name, str(f.states), str(f.unknowns or "–"), f"{f.wall:.2f}", f"{f.memory:.0f}"]
        row += [f"{f.energy:.0f}"] * told
        row += ["–" if np.isnan(e) else f"{e:.1e}" for e in errors]
        lines.append(f"| {' | '.join(row)} |")
    return "\n".join(lines) + "\n"


def draw(figures: list[Figures]) -> bytes:
    """Error against time, a picture."""
    figure, axis = plt.subplots(figsize=(5.5, 4.6))
    groups = {
        "confocal, c <= 0.6": "tolerance",
        "confocal, c = 0.9": "c = 0.9",
        "the study's box": "study's box",
        "default, one state, start apart": "default, one",
        "145 040 quadratic elements, the same": "study's element",
    }
    for (label, beginning), marker in zip(groups.items(), "osD^v"):
        points = [(f.cpu, f.K_I) for f in figures if f.name.startswith(beginning)]
        axis.loglog(*zip(*points), marker=marker, label=label)
    axis.set_xlabel("processor time (s), of the whole process if not said otherwise")
    axis.set_ylabel("largest relative error of $K_I$ (dimensionless)")
    axis.grid(alpha=0.3, which="both")
    figure.legend(loc="lower center", ncols=2, fontsize="small")
    figure.tight_layout(rect=(0.0, 0.16, 1.0, 1.0))
    data = BytesIO()
    figure.savefig(data, format="png", dpi=160)
    return data.getvalue()


def archived(figures: list[Figures]) -> bytes:
    """The figures as an HDF5 file."""
    rows, data = [asdict(f) for f in figures], BytesIO()
    units = {"wall": "s", "cpu": "s", "memory": "MB", "energy": "J"}
    with h5py.File(data, "w") as file:
        for name in rows[0]:
            file[name] = [row[name] for row in rows]
            file[name].attrs["units"] = units.get(name, "1")
    return data.getvalue()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", dest="folder", type=Path, default=Path("benchmark"))
    folder = Folder(parser.parse_args().folder).path
    names = "table.md", "error_against_time.png", "benchmark.h5"
    targets = [Target(folder / name, overwrite=True) for name in names]  # before the work of hours
    figures, others = [], []
    cases = [(case, figures) for case in CASES] + [(case, others) for case in OTHERS]
    with tempfile.TemporaryDirectory() as work:
        for i, (case, rows) in enumerate(cases):
            print(f"{i + 1}/{len(cases)} {case.name}", file=sys.stderr, flush=True)
            rows.append(run(case, Path(work)))
        print("one state, start apart", file=sys.stderr, flush=True)
        figures += without_start()
        machine = f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"
        text = f"{machine}; seconds of the whole process, median of {REPEATS}\n\n{table(figures)}"
        text += f"\nWhat else slides:\n\n{table(others)}\n{steps(Path(work))}"
    figures += others
    for target, content in zip(targets, (text.encode(), draw(figures), archived(figures))):
        target.write(content)
    print(text, end="")


if __name__ == "__main__":
    try:
        main()
    except (Occupied, UnwritableArchive) as error:
        sys.exit(f"error: {error}")
