"""Strong and weak scaling of every step of a whole run, from one rank to two.

./run.sh bench scaling                       prints Markdown tables
"""

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import h5py
from measure import HOME, wall_cpu_memory

REPEATS = 3
#: Cuts of a cell's sides on the mesh that both have, and on one and two ranks those that give a rank the
#: same number of unknowns.
STRONG, WEAK = 40, (20, 28)
SCENE = ("solve.degree=2", "solve.tolerance=1e-4", "motion.c=0.0")


@dataclass(frozen=True)
class Measured:
    """Medians of whole runs: seconds by step, and MB of the largest process."""

    unknowns: int
    seconds: dict[str, float]
    memory: float


def measure(cuts: int, ranks: int, folder: Path) -> Measured:
    """Runs of one scene; the first warms caches and is left out."""
    archive = folder / "out.h5"
    command = [str(HOME / "run.sh"), "-n", str(ranks), "run", str(HOME / "scenes" / "tables4_5.toml")]
    for change in (*SCENE, f"solve.cuts={cuts}"):
        command += ["--set", change]
    found, memories = [], []
    for _ in range(REPEATS + 1):
        wall, _, memory = wall_cpu_memory([*command, "-o", str(archive), "--overwrite"])
        with h5py.File(archive) as file:
            steps = dict(zip(file["run/steps"].asstr()[()], file["run/seconds"][()]))
            unknowns = int(file["run/fem/unknowns"][0])
        rest = wall - sum(steps.values())
        found.append(steps | {"start, imports, all else": rest, "whole process": wall})
        memories.append(memory)
        print(f"{cuts} cuts, {ranks} ranks: {wall:.1f} s", file=sys.stderr, flush=True)
    seconds = {step: median(run[step] for run in found[1:]) for step in found[0]}
    return Measured(unknowns, seconds, median(memories[1:]))


def table(one: Measured, two: Measured) -> str:
    """Both as Markdown."""
    lines = [
        f"| step | 1 rank, {one.unknowns} unknowns (s) | 2 ranks, {two.unknowns} (s) | ratio |",
        "|---|---|---|---|",
    ]
    for step, before in one.seconds.items():
        if max(before, two.seconds[step]) >= 0.05:
            after = two.seconds[step]
            lines.append(f"| {step} | {before:.2f} | {after:.2f} | {before / after:.2f} |")
    lines.append(
        f"| largest process (MB) | {one.memory:.0f} | {two.memory:.0f} | {one.memory / two.memory:.2f} |"
    )
    return "\n".join(lines) + "\n"


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print("Strong scaling: a ratio of 2 would be perfect.\n")
        print(table(*(measure(STRONG, ranks, folder) for ranks in (1, 2))), flush=True)
        print("Weak scaling: a ratio of 1 would be perfect.\n")
        print(table(*(measure(cuts, ranks, folder) for ranks, cuts in zip((1, 2), WEAK))))


if __name__ == "__main__":
    main()
