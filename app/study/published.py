"""The study's printed tables, and the rows that set computed values beside them."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from galinx.postprocess.quantities import column, states
from galinx.postprocess.quantities.quantity import FEM
from galinx.postprocess.tables import Sheet
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.integrate import runge_kutta
from galinx.solvers.solids import Solid

#: The parameters of the study's Tables 4 and 5.
REFERENCE = {"mu_c": 0.7, "sigma0_over_load": 25000.0, "delta": 1.0}

#: The tables of stress intensity factors, and what they show.
INTENSITIES = {"table4": "Table 4. Slow speed", "table5": "Table 5. High speed"}


#: Kolosov's constant of the study's solid, on which alone dimensionless results depend.
_KOLOSOV = 2.0


def like_the_studys(solid: Solid) -> bool:
    """Do results in this solid have the study's digits?"""
    return getattr(solid, "κ", None) == _KOLOSOV


def published() -> dict[str, Any]:
    """The study's printed Tables 1-5."""
    return json.loads(Path(__file__).with_name("published_tables.json").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class IntensityRow:
    """One row of Table 4 or 5: published, closed form and finite elements at both ends."""

    motion: str
    X_over_L: float
    K_I: tuple[float, float, float, float]
    diff_percent: tuple[float, float, float, float]

    @property
    def agreement(self) -> str:
        """Do all computed values round to what is printed? ``"yes"``, ``"≤ 0.01"``, or ``"NO"``.

        The second is said of Diff % alone, whose last printed digit is often off by one: K_I that are
        rounded to four digits leave it no better.
        """
        printed, printed_diff = self.K_I[0], self.diff_percent[0]
        off = max(abs(round(value, 2) - printed_diff) for value in self.diff_percent[1:])
        if any(round(value, 4) != printed for value in self.K_I[1:]) or off > 0.0101:
            return "NO"
        return "yes" if off < 0.005 else "≤ 0.01"

    @property
    def agrees(self) -> bool:
        """Does everything agree, Diff % within 0.01?"""
        return self.agreement != "NO"


def intensity_rows(name: str, data: dict[str, Any]) -> list[IntensityRow]:
    """Rows of ``"table4"`` or ``"table5"`` from an archive; none where it lacks their states."""
    table = published()[name]
    paths = [row.path for row in (states.K_I_BOTH, states.K_I_LEFT[FEM], states.K_I_RIGHT[FEM])]
    columns = [column(key) for key in REFERENCE]
    if any(path not in data for path in (*paths, *columns)):
        return []
    chosen = data[states.SPEED.path] == table["c"]
    for key, value in REFERENCE.items():
        chosen = chosen & (data[column(key)] == value)
    found = {
        (str(data[states.MOTION.path][i]), float(data[states.POSITION.path][i])): [
            data[path][i] for path in paths
        ]
        for i in np.flatnonzero(chosen)
    }
    if any((motion, X) not in found for motion, X, *_ in table["rows"]):
        return []
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
    computed = runge_kutta(law, law.rest(), 1, 0.0, table["L_m"], steps)
    stride = steps // (len(table["rows"]) - 1)
    return [
        (row, [float(computed.z[i, 0]), float(computed.d[i]), *(computed.k[i, :, 0] / law.λ).tolist()])
        for row, i in zip(table["rows"], range(0, steps + 1, stride))
    ]


def table1() -> Sheet:
    """Table 1, each row printed and computed."""
    return Sheet(
        "Table 1. Dahl's law by Runge-Kutta; x in m, the rest dimensionless",
        ("", "f", "x", "k1", "k2", "k3", "k4"),
        [
            (label, f"{row[0]:.4f}", f"{row[1]:.2e}", *(f"{k:.4f}" for k in row[2:]))
            for pair in table1_rows()
            for label, row in zip(("published", "computed"), pair)
        ],
        ("The last f is printed 0.4957, a misprint: its own k1 = 1 - f/μ_C = 0.0067", "gives 0.4966."),
    )


def table3(solid: Solid, pre_sliding: float) -> Sheet:
    """Table 3: the two speeds; ``pre_sliding`` is the length of a stroke [m]."""
    rows = []
    for name in ("SS", "HS"):
        row = published()["table3"][name]
        V = row["c"] * solid.c_s
        printed = (f"{row[key]:.4g}" for key in ("c", "V_m_s", "time_s"))
        rows.append((f"{name} published", *printed))
        rows.append((f"{name} computed", f"{row['c']:.4g}", f"{V:.5g}", f"{pre_sliding / V:.4g}"))
    return Sheet(
        "Table 3. Slow and high speed",
        ("", "c (1)", "V (m/s)", "time of a stroke (s)"),
        rows,
        (
            "The text of the study has V = 1880.4 m/s for c = 0.6, which Table 2 confirms;",
            "1884 is a misprint.",
        ),
    )


def intensities(name: str, rows: list[IntensityRow]) -> Sheet:
    """Table 4 or 5 with all values beside what is printed."""
    return Sheet(
        f"{INTENSITIES[name]}: K_I (dimensionless), Diff % (D%); FE: finite elements",
        ("", "X/L", "K publ", "exact", "FE -a", "FE a", "D%", "exact", "FE -a", "FE a", "agree"),
        [
            (
                row.motion,
                f"{row.X_over_L:g}",
                *(f"{value:.4f}" for value in row.K_I),
                *(f"{value:.2f}" for value in row.diff_percent),
                row.agreement,
            )
            for row in rows
        ],
        ("≤ 0.01: K_I are those printed, Diff % is within 0.01 of what is printed",),
    )
