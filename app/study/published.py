"""The study's printed tables, and the rows that set computed values beside them."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from galinx.postprocess.quantities import column, states
from galinx.postprocess.quantities.quantity import FEM
from galinx.postprocess.quantities.validity import CROSSINGS
from galinx.postprocess.tables import Sheet
from galinx.postprocess.validity import FEW
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.integrate import runge_kutta
from galinx.solvers.solids import Solid
from galinx.solvers.solids.isotropic import Isotropic

#: The parameters of the study's Tables 4 and 5.
REFERENCE = {"mu_c": 0.7, "sigma0_over_load": 25000.0, "delta": 1.0}
#: Those of Figs 6 (c), (d), 9 and 10.
MILDER = REFERENCE | {"mu_c": 0.5}

#: The study's two speeds over the shear wave speed: its SS and HS.
SLOW, FAST = 4.786e-7, 0.6

#: The tables of stress intensity factors, and what they show.
INTENSITIES = {"table4": "Table 4. Slow speed", "table5": "Table 5. High speed"}


def has_study_digits(solid: Solid) -> bool:
    """Return True if dimensionless results in this solid have the study's digits: they depend on
    Kolosov's constant alone."""
    return getattr(solid, "κ", None) == 2.0


def published() -> dict[str, Any]:
    """The study's printed Tables 1-5."""
    return json.loads(Path(__file__).with_name("published_tables.json").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class IntensityRow:
    """One row of Table 4 or 5: published, closed form and finite elements at both ends.

    Attributes:
        motion, X_over_L: the state.
        K_I: stress intensity factors, dimensionless.
        diff_percent: difference of K_I between both places of the stroke over the first [%].
        diff_of_printed: Diff % of K_I that are rounded to four digits, which is the study's arithmetic.
    """

    motion: str
    X_over_L: float
    K_I: tuple[float, float, float, float]
    diff_percent: tuple[float, float, float, float]
    diff_of_printed: tuple[float, ...]

    @property
    def agrees(self) -> bool:
        """True where all computed K_I and Diff % round to the printed ones."""
        printed, printed_diff = self.K_I[0], self.diff_percent[0]
        same = all(round(value, _DIGITS) == printed for value in self.K_I[1:])
        return same and all(round(value, 2) == printed_diff for value in self.diff_of_printed)


#: Digits after the point of K_I in the study's tables.
_DIGITS = 4


def state_of(
    data: dict[str, Any], c: float = SLOW, motion: str = "FM1", X: float = 0.2, **law: float
) -> int:
    """Number of the state at a speed, on a stroke, at a place X/L, of the reference law or another.

    Raises:
        LookupError: the archive does not have it.
    """
    keys = {
        states.SPEED.path: c, states.MOTION.path: motion, states.POSITION.path: X,
        **{column(key): value for key, value in (REFERENCE | law).items()},
    }  # fmt: skip
    chosen = np.all([data[path] == value for path, value in keys.items()], axis=0)
    if not chosen.any():
        raise LookupError(f"no state at c = {c:g}, {motion}, X/L = {X:g}, {REFERENCE | law}")
    return int(np.argmax(chosen))


def intensity_rows(name: str, data: dict[str, Any]) -> list[IntensityRow]:
    """Rows of ``"table4"`` or ``"table5"`` from an archive; none where it lacks their states."""
    table = published()[name]
    paths = [row.path for row in (states.K_I_BOTH, states.K_I_LEFT[FEM], states.K_I_RIGHT[FEM])]
    columns = [column(key) for key in REFERENCE]
    if any(path not in data for path in (*paths, *columns)):
        return []
    try:
        computed = {
            (motion, X): [data[path][state_of(data, table["c"], motion, X)] for path in paths]
            for motion, X, *_ in table["rows"]
        }
    except LookupError:
        return []
    rows = []
    for motion, X, K_I, diff in table["rows"]:
        first, second = (computed[motion, x] for m, x, *_ in table["rows"] if m == motion)
        diffs = [_diff_percent(a, b) for a, b in zip(first, second)]
        rounded = (_diff_percent(round(a, _DIGITS), round(b, _DIGITS)) for a, b in zip(first, second))
        rows.append(IntensityRow(motion, X, (K_I, *computed[motion, X]), (diff, *diffs), tuple(rounded)))
    return rows


def _diff_percent(first: float, second: float) -> float:
    return 100.0 * abs(second - first) / first


def table1_rows() -> list[tuple[list[float], list[float]]]:
    """Rows of Table 1: printed, and computed by the study's scheme (f, x, k1 … k4)."""
    table = published()["table1"]
    steps = table["steps"]
    law = Dahl(table["mu_c"], table["sigma0_l_over_N"], table["delta_D"])
    z, k = runge_kutta(law, law.rest(), 1, 0.0, table["L_m"], steps)
    d = np.linspace(0.0, table["L_m"], steps + 1)
    stride = steps // (len(table["rows"]) - 1)
    return [
        (row, [float(z[i, 0]), float(d[i]), *(k[i, :, 0] / law.λ).tolist()])
        for row, i in zip(table["rows"], range(0, steps + 1, stride))
    ]


def table1() -> Sheet:
    """Table 1: each row printed and computed."""
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


def table2(solid: Solid) -> Sheet:
    """Table 2: the solid, and what follows from it."""
    assert isinstance(solid, Isotropic)
    printed = published()["table2"]
    rayleigh = solid.limit() * solid.c_s
    return Sheet(
        f"Table 2. {printed['material']}, plane strain; ν and κ dimensionless",
        ("", "E (GPa)", "ν", "ρ (kg/m³)", "μ (GPa)", "κ", "c_s (m/s)", "c_R (m/s)"),
        [
            ("published", *(f"{printed[key]:g}" for key in ("E_GPa", "nu", "rho_kg_m3")), *[""] * 4),
            (
                "computed", f"{solid.E / 1e9:g}", f"{solid.ν:g}", f"{solid.ρ:g}", f"{solid.μ / 1e9:.4g}",
                f"{solid.κ:g}", f"{solid.c_s:.1f}", f"{rayleigh:.1f}",
            ),
        ],
        ("c_s, c_R: speeds of shear and Rayleigh waves",),
    )  # fmt: skip


def speed_rows(solid: Solid, pre_sliding: float) -> dict[str, tuple[float, float, float]]:
    """Speeds of Table 3 by their name: c, V [m/s] and the time [s] of a stroke of a length [m]."""
    rows = {}
    for name in ("SS", "HS"):
        c = published()["table3"][name]["c"]
        rows[name] = (c, c * solid.c_s, pre_sliding / (c * solid.c_s))
    return rows


def table3(solid: Solid, pre_sliding: float) -> Sheet:
    """Table 3: the two speeds; ``pre_sliding`` is the length of a stroke [m]."""
    rows = []
    for name, (c, V, time) in speed_rows(solid, pre_sliding).items():
        row = published()["table3"][name]
        printed = (f"{row[key]:.4g}" for key in ("c", "V_m_s", "time_s"))
        rows.append((f"{name} published", *printed))
        rows.append((f"{name} computed", f"{c:.4g}", f"{V:.5g}", f"{time:.4g}"))
    return Sheet(
        "Table 3. Slow and high speed",
        ("", "c (1)", "V (m/s)", "time of a stroke (s)"),
        rows,
        (
            "The text of the study has V = 1880.4 m/s for c = 0.6, which Table 2 confirms; 1884 and "
            "5.308e-08 are misprints.",
        ),
    )


def not_as_printed(solid: Solid, pre_sliding: float) -> int:
    """Entries of Tables 1 and 3 that do not round to what is printed, or to its correction.

    Three are corrected: the last f of Table 1 by its own k1, V and the time of a fast stroke in Table 3
    by the V of the study's text.
    """
    printed, off = published(), 0
    pairs = table1_rows()
    for last, (row, computed) in zip([False] * (len(pairs) - 1) + [True], pairs):
        f = printed["table1"]["corrected_last_f"] if last else row[0]
        off += sum(round(value, 4) != k for value, k in zip(computed, (f, *row[1:])) if k > 1e-3)
        off += abs(computed[1] - row[1]) > 1e-12
    for name, (_, V, time) in speed_rows(solid, pre_sliding).items():
        row = printed["table3"][name]
        V_of_text = row.get("V_of_text_m_s", row["V_m_s"])
        stroke = pre_sliding / V_of_text if "V_of_text_m_s" in row else row["time_s"]
        off += f"{V:.{_places(V_of_text)}f}" != f"{V_of_text:.{_places(V_of_text)}f}"
        off += f"{time:.3e}" != f"{stroke:.3e}"
    return int(off)


def _places(value: float) -> int:
    """Digits after the point with which a number is printed."""
    return len(f"{value!r}".partition(".")[2])


def intensity_sheets(data: dict[str, Any], half_width: float) -> list[Sheet]:
    """Tables 4 and 5 with all values beside what is printed, those whose states an archive has.

    Args:
        data: the archive.
        half_width: a [m].
    """
    sheets = []
    for name, title in INTENSITIES.items():
        rows = [
            (
                row.motion,
                f"{row.X_over_L:g}",
                *(f"{value:.4f}" for value in row.K_I),
                f"{row.diff_percent[0]:.2f}",
                "/".join(dict.fromkeys(f"{value:.2f}" for value in row.diff_of_printed)),
                *(f"{value:.3f}" for value in row.diff_percent[1:3]),
                "yes" if row.agrees else "NO",
            )
            for row in intensity_rows(name, data)
        ]
        notes = (
            "K_I, D%: published. rounded: D% as the study has it, of K_I with four digits; "
            "exact, FE: D% of all digits.",
            _limit_of_steady_motion(name, data, half_width),
        )
        if rows:
            title += ": K_I (dimensionless), Diff % (D%); FE: finite elements"
            heads = "", "X/L", "K_I", "exact", "FE -a", "FE a", "D%", "rounded", "exact", "FE", "agree"
            sheets.append(Sheet(title, heads, rows, [*filter(None, notes)]))
    return sheets


def _limit_of_steady_motion(name: str, data: dict[str, Any], half_width: float) -> str:
    """A note on Table 4 or 5 where its strokes are too short for steady motion; "" elsewhere.

    Args:
        name: of the table.
        data: an archive with its states.
        half_width: a [m].
    """
    if CROSSINGS.path not in data:
        return ""
    often = data[CROSSINGS.path][data[states.SPEED.path] == published()[name]["c"]]
    if not often.size or not often.min() < FEW:
        return ""
    return (
        f"In a stroke at this speed a shear wave crosses the contact {often.min():.2g} times (a = "
        f"{1e3 * half_width:g} mm): these K_I are limits which such a stroke does not reach."
    )


def friction_sheet(laws: Iterable[Dahl], pre_sliding: float) -> Sheet:
    """Table of friction from rest under each law."""
    rows = []
    for law in laws:
        f = law.exact(law.rest(), 1, 0.0, pre_sliding * np.array([0.2, 1.0]))[:, 0]
        distance = 1e3 * law.distance(0.99)
        parameters = (f"{value:g}" for value in (law.μ_C, law.λ, law.δ))
        rows.append((*parameters, *(f"{value:.4f}" for value in f), f"{distance:.3f}"))
    return Sheet(
        "Friction from rest: where it has come to 99 % of μ_C",
        ("μ_C (1)", "σ₀l/N (1/m)", "δ_D (1)", "f at 0.2 L", "f at L", "L_a (mm)"),
        rows,
        (f"L = {1e3 * pre_sliding:g} mm. L_a: distance from rest at which f = 0.99 μ_C.",),
    )


def frame_sheet(solid: Solid) -> Sheet:
    """Table of the constants of the moving frame at both speeds."""
    assert isinstance(solid, Isotropic)
    rows = []
    for name, c in (("SS", SLOW), ("HS", FAST)):
        at = solid.response(c)
        scaled = (4.0 * value / (at.κ + 1.0) for value in (at.n, at.q, at.m, at.q))
        rows.append((f"{name}, c = {c:g}", *(f"{value:.6f}" for value in scaled)))
    return Sheet(
        "Constants of the singular integral equations, dimensionless",
        ("", "|π ω₁|", "ω₂", "|π ω₃|", "ω₄"),
        rows,
    )


def dimensions_sheet(data: dict[str, Any], load: float, half_width: float) -> Sheet:
    """Table of stress intensity factors with their dimensions at the states of Tables 4 and 5.

    Args:
        data: an archive with these states.
        load: N per depth [N/m].
        half_width: a [m].
    """
    rows, pressure, a = [], 1e-6 * load / half_width, 1e3 * half_width
    for name in INTENSITIES:
        table = published()[name]
        for motion, X, *_ in table["rows"]:
            i = state_of(data, table["c"], motion, X)
            α, β, K_left, K_right = (
                float(data[row.path][i])
                for row in (states.ALPHA, states.BETA, states.K_I_LEFT[FEM], states.K_I_RIGHT[FEM])
            )
            k = K_left * pressure * a**-β, K_right * pressure * a**-α
            rows.append(
                (
                    f"{motion} {table['c']:.4g}",
                    f"{X:g}",
                    f"{β:.4f}",
                    f"{α:.4f}",
                    *(f"{value:.4f}" for value in k),
                )
            )
    return Sheet(
        "Stress intensity factors with dimensions (Eqs 56-57), finite elements",
        ("at c (1)", "X/L", "β at -a", "α at a", "k_I(-a)", "k_I(a)"),
        rows,
        (
            "k_I(a): limit of -σ_YY 2^-β (a - X)^-α, in MPa mm^-α; k_I(-a): of -σ_YY 2^-α (a + X)^-β, in "
            f"MPa mm^-β. N = {1e-3 * load:g} N/mm, a = {a:g} mm.",
        ),
    )
