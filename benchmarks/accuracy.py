"""Tables of docs/verification.md, computed again and written into the page.

Each stands there between a line ``<!-- ./run.sh bench accuracy NAME -->`` and a line ``<!-- end -->``.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from mpi4py import MPI

import galinx
from galinx.meshes import MESHES
from galinx.meshes.kind import Requirements
from galinx.meshes.rings import Refinement
from galinx.postprocess.compare import RULES
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.recovery import chebyshev, from_moments
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import MovingFrame
from galinx.solvers.solids.plane import Orthotropic

HOME = Path(__file__).parent.parent
PAGE = HOME / "docs" / "verification.md"

#: Scenes, and the columns that show them: headings by the names of comparisons.
SCENES = ("tables4_5", "high_speed", "graded", "box")
COMPARED = {
    "K_I": "K_I, both ends", "estimate": "its estimate", "sigma_YY": "σ_YY", "sigma_XX": "σ_XX",
    "estimate of sigma_XX": "its estimate", "exponents": "fitted exponents",
    "force balance": "force balance",
}  # fmt: skip
#: Scenes of other outputs.
OTHERS = ("traction", "inside")
OF_OTHERS = {
    "slope under the punch": "v,X under the punch over that beside it",
    "stresses inside": "stresses inside", "estimate inside": "their estimate",
}  # fmt: skip
TOLERANCES = [10.0**-n for n in (2, 4, 6, 8, 9)]
SPEEDS = (0.0, 0.6, 0.9, 0.91)
#: Moments that the far boundary follows, its distance over a, columns of cells outside the rings.
BOUNDARIES = ((0, 1e10, 6), (1, 482, 2), (2, 239, 2), (3, 131, 2), (5, 18, 1), (6, 18, 1), (8, 18, 1))

#: Orthotropic solids: E₁/E₂, angle of the stiff axis [°], speed over the limit.
FIBRES = ((14, 30, 0.6), (40, 30, 0.6), (40, 30, 0.95), (14, 60, 0.95), (14, 0, 0.95))
#: Sectors besides those of isotropic solids, pieces of the outermost ring.
FINER = ((0, 1), (1, 2), (2, 2), (4, 3))


def markdown(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    lines = [list(heads), *([cell.replace("|", r"\|") for cell in row] for row in rows)]
    lines.insert(1, ["---"] * len(lines[0]))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def short(value: float | None) -> str:
    """Two digits, or one where there is no more: 2.8e-11, 1e-6; a dash for none."""
    if value is None:
        return "–"
    digits, power = f"{value:.1e}".split("e")
    return f"{digits.removesuffix('.0')}e{int(power)}"


def worst(name: str, changes: dict[str, Any] | None = None) -> dict[str, float]:
    """Largest value over the states of a scene, of every comparison by name."""
    result = galinx.compute(galinx.template(name, changes))
    values = json.loads(result.attributes["comparisons"])
    return {name: values[rule.text] for name, rule in RULES.items() if rule.text in values}


def row_of(name: str, columns: Iterable[str]) -> list[str]:
    """The row of a scene."""
    errors, tolerance = worst(name), galinx.template(name).solve.tolerance
    return [f"`{name}`", short(tolerance), *(short(errors.get(column)) for column in columns)]


def scenes() -> str:
    return markdown(("scene", "tolerance", *COMPARED.values()), (row_of(n, COMPARED) for n in SCENES))


def others() -> str:
    return markdown(("scene", "tolerance", *OF_OTHERS.values()), (row_of(n, OF_OTHERS) for n in OTHERS))


def tolerances() -> str:
    """Estimated and true errors of K_I, |f| <= 1, both directions."""
    changes = {"friction.mu_c": [0.3, 1.0], "output.quantities": ["friction", "sif"]}
    heads = ["tolerance", *(f"c = {c:g}: {what}" for c, what in product(SPEEDS, ("estimate", "true")))]
    rows = []
    for tolerance in TOLERANCES:
        row = [short(tolerance)]
        for c in SPEEDS:
            errors = worst("tables4_5", changes | {"motion.c": c, "solve.tolerance": tolerance})
            row += [short(errors["estimate"]), short(errors["K_I"])]
        rows.append(row)
    return markdown(heads, rows)


def boundaries() -> str:
    """Error of K_I by the moments that the far boundary follows."""
    rows = [
        (
            str(terms or "none, held"),
            short(R) if R > 1e9 else str(R),
            str(count),
            short(of_boundary(terms, R, count)),
        )
        for terms, R, count in BOUNDARIES
    ]
    return markdown(("moments", "R/a", "columns", "error of K_I"), rows)


def of_boundary(terms: int, R: float, count: int) -> float:
    """Relative error of K_I at c = 0.6, g = 0.66, degree 10, with rings for a tolerance of 1e-8."""
    kind, response, g = MESHES["confocal"], MovingFrame(2.0, 0.6), 0.66
    levels = int(np.ceil(np.log(np.sqrt(1e-8 / 3.0) / (np.pi / 2.0)) / np.log(kind.ratio)))
    widths = ((np.arccosh(R) - np.pi / 2.0) / count,) * count
    cells = distribute(kind.build(Refinement(levels, kind.ratio, 2, widths)), MPI.COMM_SELF)
    space = Space(*cells, kind.chart, 10, terms=terms)
    pressure, local = recovered(space, response, g)
    return float(np.abs(pressure.K_I / local.K_I[:, None] - 1.0).max())


def planes() -> str:
    """Error of the pressure in solids whose fields live in planes apart, by cells finer in angle."""
    heads = ["cells", *(f"{E1:g}, {angle:g}°, {share:g}" for E1, angle, share in FIBRES)]
    rows = []
    for more, pieces in FINER:
        cells = [short(of_planes(*fibres, more, pieces)) for fibres in FIBRES]
        rows.append((f"{more} more sectors, outermost ring in {pieces}", *cells))
    return markdown(heads, rows)


def of_planes(E1: float, angle: float, share: float, more: int, pieces: int) -> float:
    """Largest relative error of σ_YY at degree 8 and g = -0.3, with rings for a tolerance of 1e-6."""
    solid = Orthotropic(E1 * 1e9, 1e9, 1e9, 0.3, 0.3, 0.4, 0.7e9, 1.5e3, np.radians(angle))
    kind, response, g = MESHES["confocal"], solid.response(share * solid.limit()), -0.3
    even = kind.refinement(Requirements(1e-6))
    pattern = kind.build(replace(even, sectors=even.sectors + more, pieces=pieces))
    space = Space(*distribute(pattern, MPI.COMM_SELF), kind.chart, 8, form=solid.form, terms=8)
    pressure, local = recovered(space, response, g)
    X = np.cos(np.pi * np.arange(1, 8) / 8.0)
    return float(np.abs(pressure.σ_YY(X) / local.σ_YY(X) - 1.0).max())


def recovered(space: Space, response: Any, g: float) -> tuple[Any, FlatPunch]:
    """The pressure by finite elements, and the exact one."""
    punch, local = SlidingPunch(space, response), FlatPunch(response, np.array([g]))
    moments = chebyshev(space.chart.surface_position(space.contact.s))
    pressure = from_moments(punch.states(g).tested(moments), local.α, local.β)
    punch.destroy()
    return pressure, local


def extremes() -> str:
    """What ``./run.sh stress`` says, a quarter of an hour."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([HOME / "run.sh", "stress", "-o", folder], stdout=sys.stderr)
        return of_archive(Path(folder) / "stress.h5")


#: A kind of random scenes, and its figures.
_KIND = re.compile(r"([a-z ]+?) ([\d.]+ to [\d.]+, median .*?)(?:; (?=[a-z ]+ [\d.]+ to)|$)")


def of_archive(path: Path) -> str:
    rows, kinds = [], []
    with h5py.File(path) as file:
        for name in file:
            verdicts = list(file[f"{name}/verdicts"].asstr())
            if name == "random":  # the first is of each kind of scene
                kinds = _KIND.findall(verdicts.pop(0).partition("errors: ")[2])
            about = file[f"{name}/verdicts"].attrs["long_name"]
            rows.append(f"- {about}: {'; '.join(v.removeprefix('holds: ') for v in verdicts)}")
    rows += [
        "",
        "Estimate over true error of K_I and σ_YY, of K_I alone, of stresses, in random scenes:",
        "",
    ]
    return "\n".join([*rows, *(f"- {kind}: {figures}" for kind, figures in kinds)])


def stacks() -> str:
    """Thirty random stacks, by their test, half an hour."""
    test = HOME / "tests" / "app" / "run" / "test_random_stacks.py"
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-s", "-q", "-k", "flat", "-p", "no:cacheprovider", test],
        cwd=HOME, text=True,
        env=os.environ | {"GALINX_THOROUGH": "1"}, stdout=subprocess.PIPE,
    )  # fmt: skip
    print(done.stdout, file=sys.stderr)
    return of_stacks(done.stdout)


def of_stacks(text: str) -> str:
    heads = ("layers", "stacks", "pressure", "K_I, both ends", "σ_XX on the surface", "at interfaces")
    rows = []
    for kind, words in (("uniform", "uniform"), ("graded", "some graded")):
        lines = [line for line in text.splitlines() if re.search(rf"seed \d+, {kind}:", line)]
        cells = []
        for what in ("pressure", "K_I", "sigma_XX", "interfaces"):
            pairs = [re.search(rf"{what} (\S+?)(?: of (\S+?))?(?:,|$)", line) for line in lines]
            off, estimates = ([float(p[i]) for p in pairs if p and p[i]] for i in (1, 2))
            cells.append(short(max(off)) + (f" ({short(max(estimates))})" if estimates else ""))
        rows.append((words, str(len(lines)), *cells))
    return markdown(heads, rows)


#: Tables by name, quick ones first.
TABLES: dict[str, Callable[[], str]] = {
    "scenes": scenes, "others": others, "boundaries": boundaries, "planes": planes,
    "tolerances": tolerances, "extremes": extremes, "stacks": stacks,
}  # fmt: skip


def put(page: str, name: str, table: str) -> str:
    """The page with another table of a name.

    Raises:
        ValueError: the page has no place for it.
    """
    place = re.compile(rf"(<!-- ./run.sh bench accuracy {name} -->\n\n).*?(\n\n<!-- end -->)", re.DOTALL)
    if not place.search(page):
        raise ValueError(
            f"the page has no table {name}: expected <!-- ./run.sh bench accuracy {name} -->"
        )
    return place.sub(lambda match: match[1] + table + match[2], page)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=f"{', '.join(TABLES)}; all by default")
    names = parser.parse_args().tables or list(TABLES)
    if unknown := [name for name in names if name not in TABLES]:
        parser.error(f"no table {', '.join(unknown)}; expected one of {', '.join(TABLES)}")
    for name in names:
        print(f"table {name}", file=sys.stderr, flush=True)
        table = TABLES[name]()
        print(table, flush=True)
        PAGE.write_text(put(PAGE.read_text(encoding="utf-8"), name, table), encoding="utf-8")


if __name__ == "__main__":
    main()
