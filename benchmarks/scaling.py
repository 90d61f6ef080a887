"""Strong and weak scaling of every step of a whole run, from one rank to two.

./run.sh bench scaling                       prints Markdown tables
"""

import argparse
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import h5py
from measure import HOME, consumption

PAIRS = 5
#: Cuts of a cell's sides on the mesh that both have, and on one and two ranks those that give a rank the
#: same number of unknowns.
STRONG, WEAK = 40, (20, 28)
SCENE = ("solve.degree=2", "solve.tolerance=1e-4", "motion.c=0.0")


@dataclass(frozen=True)
class Run:
    """Seconds by step, and MB of the largest process."""

    unknowns: int
    seconds: dict[str, float]
    memory: float


def run(cuts: int, ranks: int, archive: Path) -> Run:
    """One whole process."""
    command = [str(HOME / "run.sh"), "-n", str(ranks), "run", str(HOME / "scenes" / "tables4_5.toml")]
    for change in (*SCENE, f"solve.cuts={cuts}"):
        command += ["--set", change]
    used = consumption([*command, "-o", str(archive), "--overwrite"])
    wall = used["wall"]
    with h5py.File(archive) as file:
        seconds = dict(zip(file["run/steps"].asstr()[()], file["run/seconds"][()]))
        unknowns = int(file["run/fem/unknowns"][0])
    seconds["start, imports, all else"] = wall - sum(seconds.values())
    print(f"{cuts} cuts, {ranks} ranks: {wall:.1f} s", file=sys.stderr, flush=True)
    return Run(unknowns, seconds | {"whole process": wall}, used["memory"])


def table(cuts: tuple[int, int], folder: Path) -> str:
    """One and two ranks in turn, as Markdown: medians, and the median ratio of pairs with its range."""
    pairs = [
        [run(k, ranks, folder / "out.h5") for ranks, k in enumerate(cuts, 1)] for _ in range(PAIRS + 1)
    ]
    pairs = pairs[1:]  # the first warms the caches
    one, two = pairs[0]
    lines = [
        f"| step | 1 rank, {one.unknowns} unknowns (s) | 2 ranks, {two.unknowns} (s) | ratio |",
        "|---|---|---|---|",
    ]
    for step in one.seconds:
        lines.append(_line(step, [[each.seconds[step] for each in pair] for pair in pairs], 2))
    lines.append(_line("largest process (MB)", [[each.memory for each in pair] for pair in pairs], 0))
    return "\n".join(line for line in lines if line) + "\n"


def _line(name: str, pairs: list[list[float]], digits: int) -> str:
    """A row; empty for a step that takes no time."""
    before, after = (median(column) for column in zip(*pairs))
    if max(before, after) < 0.05:
        return ""
    ratios = sorted(one / two for one, two in pairs)
    spread = f"{median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})"
    return f"| {name} | {before:.{digits}f} | {after:.{digits}f} | {spread} |"


def main() -> None:
    argparse.ArgumentParser(description=__doc__).parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print("Strong scaling: a ratio of 2 would be perfect.\n")
        print(table((STRONG, STRONG), folder), flush=True)
        print("Weak scaling: a ratio of 1 would be perfect.\n")
        print(table(WEAK, folder))


if __name__ == "__main__":
    main()
