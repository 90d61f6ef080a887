"""Tables as text: states, limits of the answers, friction loops, sliders, motions in time.

Quantities are written as archived, or scaled to other units. States of an archive are identified by their
parameters: speed, load, the law's constants, motion and position.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import isnan
from typing import Any

import numpy as np

from galinx.texts import plain

from .quantities import (
    Quantity,
    layers,
    over_time,
    runs,
    table,
    validity,
    yielding,
)
from .quantities import states as of
from .quantities.quantity import CLOSED_FORM, FEM, SIE, TEXT
from .quantities.states import LOAD, MOTION, POSITION, SPEED
from .units import Scaled, Scaling, as_archived


def parameters(data: dict[str, Any]) -> dict[str, Quantity]:
    """Parameters that identify an archive's states, by the paths of their datasets, slowest first.

    Args:
        data: datasets of the archive by path.
    """
    rows = {path: row for path, row in table().items() if row.symbol and path in data}
    first, last = [SPEED.path, *({LOAD.path} & rows.keys())], [MOTION.path, POSITION.path]
    own = [path for path in rows if path not in (*first, *last)]
    return {path: rows[path] for path in (*first, *own, *last)}


#: Most states in a table, and most inner variables of a law.
LIMIT, _VARIABLES = 24, 6


@dataclass(frozen=True)
class Sheet:
    """Table as text: the first column is a label, the others are numbers.

    Attributes:
        title: title of the table.
        columns: heads of the columns, with units.
        rows: cells of each row as text.
        notes: lines below the table.
        words: True where cells are words, which may take several lines.
    """

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    notes: Sequence[str] = ()
    words: bool = False


#: Columns of the table of states after the parameters: (head, quantity, format).
_EITHER = [("K_I", of.K_I_BOTH, "{:.6f}"), ("error", of.TRUE_ERROR, "{:.1e}")]
_ALONE = [
    (head, row, "{:.6f}")
    for head, rows in (
        ("K(-a)", of.K_I_LEFT | layers.K_I_LEFT), ("K(a)", of.K_I_RIGHT | layers.K_I_RIGHT)
    )
    for row in (rows[FEM], rows[SIE])
]  # fmt: skip
_ENDS = [
    (head, row, "{:.4e}")
    for head, rows in (("a (m)", of.HALF_WIDTH), ("centre (m)", of.CENTRE))
    for row in (rows[FEM], rows[CLOSED_FORM], rows[SIE])
]
_BOTH = [
    ("estimate", of.ESTIMATE, "{:.1e}"),
    ("estimate", layers.ESTIMATE, "{:.1e}"), ("v₀ (m)", of.INDENTATION, "{:.4e}"),
    ("α", of.ALPHA, "{:.4f}"), ("β", of.BETA, "{:.4f}"),
]  # fmt: skip


def states_sheet(data: dict[str, Any], title: str, scaling: Scaling = as_archived) -> Sheet:
    """Table of the first states of an archive: their parameters, and the main results.

    Args:
        data: datasets of the archive by path.
        title: title of the table; "" for "States".
        scaling: scales of the quantities.
    """
    apart = {path: row for path, row in parameters(data).items() if path != of.MOTION.path}
    varied = {path: row for path, row in apart.items() if len(np.unique(data[path])) > 1}
    shown = {_head(row, scaling): (row, _form(row)) for row in varied.values()}
    results = _EITHER if of.K_I_BOTH.path in data else _ALONE
    shown["f"] = of.FRICTION, "{:+.4f}"
    for head, row, form in (*results, *_ENDS, *_BOTH):
        # Intensities at free ends are zeros.
        if row.path in data and head not in shown and data[row.path].any():
            shown[head] = row, form
    factors = {path: _scaled(row, scaling).factor for path, row in apart.items() if row.type != TEXT}
    series = [
        [value if row.type == TEXT else factors.get(row.path, 1.0) * value for value in values]
        for row, _ in shown.values()
        if (values := data[row.path][:LIMIT].tolist())
    ]
    forms = [form for _, form in shown.values()]
    labels = [f"{n} {motion}" for n, motion in enumerate(data[of.MOTION.path][:LIMIT].tolist())]
    rows = [
        [label, *(form.format(value) for form, value in zip(forms, row))]
        for label, row in zip(labels, zip(*series))
    ]
    notes = []
    hidden = len(data[of.FRICTION.path]) - LIMIT
    if hidden > 0:
        notes.append(f"and {hidden} more states; csv and show --json list all")
    same = [
        f"{_head(row, scaling)} = " + _form(row).format(factors.get(path, 1) * data[path][0])
        for path, row in apart.items()
        if path not in varied
    ]
    if same:
        notes.append(f"the same in all: {', '.join(same)}")
    of_speed = "; c is the speed over the shear wave speed" * (_scaled(of.SPEED, scaling).unit == "1")
    notes.append(f"dimensionless where no unit stands{of_speed}")
    if "error" in shown:
        notes.append("K_I: closed form, at both edges; error and estimate: of finite elements, relative")
    if speeds := solved_speeds(data):
        notes.append(speeds)
    if "a (m)" in shown:
        notes.append("a, centre: half-width of the contact, and its middle from the punch's axis")
    if "α" in shown:
        notes.append("α, β: exponents of the pressure at X = a and X = -a")
    return Sheet(title or "States", ["state", *shown], rows, notes)


def solved_speeds(data: Mapping[str, Any]) -> str:
    """Number of speeds that finite elements solved, in words; "" where they solved every speed."""
    if of.FITTED.path not in data:
        return ""
    c, fitted = data[of.SPEED.path], data[of.FITTED.path]
    solved = len(np.unique(c[fitted == 0.0]))
    return f"finite elements: {solved} of {len(np.unique(c))} speeds solved, the others by a fit"


def _form(row: Quantity) -> str:
    return "{}" if row.type == TEXT else "{:.4g}"


def _scaled(row: Quantity, scaling: Scaling) -> Scaled:
    symbol = plain(f"${row.symbol}$")
    return scaling(row, symbol) or as_archived(row, symbol)


def _head(row: Quantity, scaling: Scaling) -> str:
    scaled = _scaled(row, scaling)
    return scaled.name + ("" if scaled.unit in ("1", "none") else f" ({scaled.unit})")


#: Largest tension and its place, by method.
_TENSION = validity.TENSION | layers.TENSION

#: Quantities of yield and of where answers do not hold, by their labels in a table.
_LIMITS: tuple[tuple[str, dict[str, Quantity]], ...] = (
    ("largest von Mises", yielding.VON_MISES),
    ("  at X", yielding.VON_MISES_X),
    ("  at Y", yielding.VON_MISES_Y),
    ("largest shear", yielding.SHEAR),
    ("  at X", yielding.SHEAR_X),
    ("  at Y", yielding.SHEAR_Y),
    ("load at first yield", yielding.FIRST_LOAD),
    ("yield within, left", yielding.REACH_LEFT),
    ("yield within, right", yielding.REACH_RIGHT),
    ("depth of yield", yielding.DEPTH),
    ("waves in a stroke", {"": validity.CROSSINGS}),
    ("flutter from, g > 0", {"": validity.FLUTTER["positive"]}),
    ("flutter from, g < 0", {"": validity.FLUTTER["negative"]}),
    ("slip turned, left", {CLOSED_FORM: validity.SLIP_REVERSED[0]}),
    ("slip turned, right", {CLOSED_FORM: validity.SLIP_REVERSED[1]}),
    ("strain > 5 %, left", {CLOSED_FORM: validity.STRAIN[0]}),
    ("strain > 5 %, right", {CLOSED_FORM: validity.STRAIN[1]}),
    ("tension", {method: rows[0] for method, rows in _TENSION.items()}),
    ("  at X", {method: rows[1] for method, rows in _TENSION.items()}),
)
_METHODS = {CLOSED_FORM: "exact", SIE: "SIE", FEM: "FE", "": ""}
_CALLED = {"exact": "closed form", "SIE": "singular integral equation", "FE": "finite elements"}


def limits_sheet(data: dict[str, Any], scaling: Scaling = as_archived) -> Sheet:
    """Table of yield, and of limits of the answers: smallest and largest values of all states."""
    rows = []
    for label, by_method in _LIMITS:
        for method, row in by_method.items():
            scaled = scaling(row, "")
            if row.path in data and scaled and np.isfinite(values := data[row.path]).any():
                ends = (f"{end(scaled.of(values)):.4g}" for end in (np.nanmin, np.nanmax))
                unit = row.scale.lower() if scaled.unit == "1" and row.scale else scaled.unit
                rows.append([label, _METHODS[method], unit, *ends])
    notes = ["left, right: how far from X = -a and X = a; waves: how often one crosses the contact"]
    used = {row[1] for row in rows}
    if called := ", ".join(f"{short}: {long}" for short, long in _CALLED.items() if short in used):
        notes.append(called)
    return Sheet("Yield, and where answers hold", ["", "by", "unit", "least", "most"], rows, notes)


def loops_sheet(data: dict[str, Any]) -> Sheet:
    """Table of the first friction loops: work, breakaway force and stiffness."""
    varied = [
        row
        for path, row in parameters(data).items()
        if row not in (of.MOTION, of.POSITION) and len(np.unique(data[path])) > 1
    ]
    of_state, count = data[runs.LOOP_OF_STATE.path], min(len(data[runs.LOOP_F.path]), LIMIT)
    states = [int(np.argmax(of_state == n)) for n in range(count)]
    heads = ["loop", *(_head(row, as_archived) for row in varied)]
    rows = [
        [str(n), *(_form(row).format(data[row.path].tolist()[state]) for row in varied)]
        for n, state in enumerate(states)
    ]
    for head, row, reduced in _OF_LOOPS:
        if row.path in data:
            heads.append(head)
            for cells, values in zip(rows, data[row.path]):
                cells.append(f"{reduced(values):.5g}")
    note = (
        "work: dissipated in all strokes, and in a closed loop where there is one; breakaway: largest of "
        "all strokes; stiffness: where the first stroke begins; all per depth"
    )
    if of.LOAD.path in data:
        note += f"; under the first load, N = {data[of.LOAD.path][0]:.4g} N/m"
    return Sheet("Friction loops", heads, rows, [note])


def inner_sheet(data: dict[str, Any]) -> Sheet:
    """Table of the law's inner variables at the first states; no rows without any, or for f alone."""
    z, f = data.get(of.INNER_STATE.path), data[of.FRICTION.path]
    rows: list[list[str]] = []
    count = min(0 if z is None else z.shape[1], _VARIABLES)
    if z is not None and z.any() and not (z.shape[1] == 1 and np.allclose(z[:, 0], f, rtol=1e-12)):
        columns = data[of.MOTION.path], data[of.POSITION.path], f, z
        for n, (motion, X, of_state, inner) in enumerate(zip(*(values[:LIMIT] for values in columns))):
            components = (f"{value:.6g}" for value in inner[:count].tolist())
            rows.append([f"{n} {motion}", f"{X:.4g}", f"{of_state:+.4f}", *components])
    notes = ["z: inner variables, dimensionless, as defined in the law's file"]
    if z is not None and z.shape[1] > count:
        notes.append(f"and {z.shape[1] - count} more; show --json lists all")
    heads = ["state", "X/L", "f", *(f"z{n + 1}" for n in range(count))]
    return Sheet("Inner state of the friction law", heads, rows, notes)


#: Labels and quantities of loops in their table, and functions that combine values of all strokes.
_OF_LOOPS: tuple[tuple[str, Quantity, Callable[[Any], Any]], ...] = (
    ("work (J/m)", runs.LOOP_WORK, np.sum),
    ("closed loop (J/m)", runs.LOOP_CYCLE, float),
    ("breakaway (N/m)", runs.LOOP_BREAKAWAY, np.max),
    ("stiffness (N/m²)", runs.LOOP_STIFFNESS, lambda values: values[0]),
)
_OF_SLIDERS = (
    ("period (s)", runs.PERIOD), ("slip per cycle (m)", runs.SLIP),
    ("peak (m/s)", runs.PEAK), ("least (m/s)", runs.LEAST),
)  # fmt: skip


def sliders_sheet(data: dict[str, Any]) -> Sheet:
    """Table of the motion of the slider for the first laws, with its stick-slip."""
    columns = [data[row.path][:LIMIT].tolist() for _, row in _OF_SLIDERS if row.path in data]
    outcomes = map(str, data[runs.OUTCOME.path]) if columns else []
    rows = [
        [str(n), outcome, *("" if isnan(value) else f"{value:.6g}" for value in values)]
        for n, (outcome, values) in enumerate(zip(outcomes, zip(*columns)))
    ]
    heads = ["law", "motion", *(head for head, _ in _OF_SLIDERS)]
    return Sheet("Motion of the slider", heads, rows, ["peak, least: of the velocity in the last cycle"])


def starts_sheet(data: dict[str, Any], unit: float) -> Sheet:
    """Table of the first starts at the end of the motion, by finite elements if the archive has them.

    Args:
        data: datasets of the archive by path.
        unit: a/c_s [s].
    """
    title = "In time, at the end"
    method = next((name for name in (FEM, SIE) if over_time.V0[name].path in data), "")
    if not method:
        return Sheet(title, [], [], [])
    c, g, steady = (
        data[row.path][:LIMIT] for row in (over_time.SPEED, over_time.RATIO, over_time.STEADY_CENTRE)
    )
    ways = ["-+"[int(way > 0.0)] + "X" for way in data[over_time.DIRECTION.path][:LIMIT, -1]]
    by_method = over_time.V0, over_time.CENTRE, over_time.K_I_LEFT, over_time.K_I_RIGHT
    last = [data[row[method].path][:LIMIT, -1] for row in by_method]
    off, near = data[over_time.OFF[method].path], data[over_time.WITHIN[method].path][:, 1]
    columns = [values[:LIMIT].tolist() for values in (c, g, *last, steady, 100.0 * off)]
    end = data[over_time.TIMES.path][-1]
    rows = [
        [
            way,
            *(_number(value, 5) for value in row),
            _number(far, 3),
            _when(within, end, unit),
            _rounded(by_formula, unit),
        ]
        for way, *row, far, within, by_formula in zip(ways, *columns, near, data[over_time.APPROACH.path])
    ]
    heads = ["way", "c", "g", "v0 (N/2mu)", "centre/a", "K_I left", "K_I right", "steady"]
    heads += ["off (%)", "within 1 % from", "by formula"]
    notes = [
        f"at t = {end:g} a/c_s = {_seconds(end * unit)}; centre: of the pressure, towards +X",
        "steady: centre in steady motion",
        "off: largest relative difference of K_I, or of centre/a, from steady motion",
        "within 1 %: of both, over a/c_s; ~ by 1/t after the end",
        "by formula: for late times, of uniform solids, over a/c_s",
    ]
    return Sheet(title, heads, rows, notes)


def _number(value: float, digits: int) -> str:
    return "" if isnan(value) else f"{value:.{digits}g}"


def _when(time: float, end: float, unit: float) -> str:
    """Time over a/c_s in words; with ~ where it is extrapolated beyond the end."""
    if isnan(time):
        return "too short to tell"
    return f"{time:.3g} ({_seconds(time * unit)})" if time <= end else f"~ {_rounded(time, unit)}"


def _rounded(time: float, unit: float) -> str:
    """Time over a/c_s in words, with two digits."""
    return "" if isnan(time) else f"{float(f'{time:.1e}'):g} ({_seconds(time * unit, 2)})"


def _seconds(seconds: float, digits: int = 3) -> str:
    """Time in words, with a unit from s to ns."""
    for size, name in ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if seconds >= size:
            return f"{float(f'{seconds / size:.{digits - 1}e}'):g} {name}"
    return f"{float(f'{seconds / 1e-9:.{digits - 1}e}'):g} ns"
