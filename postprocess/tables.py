"""Tables as text: states, limits of the answers, friction loops, sliders, motions in time.

Quantities are written as archived, or scaled to other units. States of an archive are identified by their
parameters: speed, load, the law's constants, motion and position.
"""

import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isnan
from typing import Any

import numpy as np

from galinx.solvers.contact import YIELD
from galinx.texts import plain

from .quantities import (
    Quantity,
    layers,
    over_time,
    runs,
    stresses,
    table,
    validity,
    yielding,
)
from .quantities import states as of
from .quantities.quantity import CLOSED_FORM, CONTACT, FEM, SIE, TEXT, X_OVER_A
from .quantities.states import LOAD, MOTION, POSITION, SPEED
from .units import Scaled, Units, as_archived, engineering, number


def parameters(data: dict[str, Any]) -> dict[str, Quantity]:
    """Parameters that identify an archive's states, by the paths of their datasets, slowest first.

    Args:
        data: datasets of the archive by path.
    """
    rows = {path: row for path, row in table().items() if row.symbol and path in data}
    first, last = [SPEED.path, *({LOAD.path} & rows.keys())], [MOTION.path, POSITION.path]
    swept = [path for path in rows if "." in path]
    own = [path for path in rows if path not in (*swept, *first, *last)]
    return {path: rows[path] for path in (*swept, *first, *own, *last)}


#: Most states in a table, most of them side by side, and most inner variables of a law.
LIMIT, BESIDE, _VARIABLES = 24, 8, 6
#: Characters of a narrow column.
_NARROW = 11


@dataclass(frozen=True)
class Sheet:
    """Table as text: the first column is a label, the others are numbers.

    Attributes:
        title: title of the table.
        columns: heads of the columns, with units; all empty for lines without a head.
        rows: cells of each row as text.
        notes: lines below the table.
        words: True where cells are words, which may take several lines.
    """

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    notes: Sequence[str] = ()
    words: bool = False


@dataclass(frozen=True, eq=False)
class Column:
    """Column of a table in its units: a number, or a word, for each state.

    Attributes:
        head: what it is, in words.
        values: (states,), or as many texts.
        unit: "1" for dimensionless, "none" for words.
        name: in tables for programs; that of the archive where one dataset has the numbers.
        path: of that dataset, "" for none.
        digits: that are shown.
        place: True where it is a place of what the column before it has.
        step: to which numbers are rounded where they are shown, 0 for none.
    """

    head: str
    values: Any
    unit: str = "1"
    name: str = ""
    path: str = ""
    digits: int = 4
    place: bool = False
    step: float = 0.0

    @property
    def label(self) -> str:
        """Head with the unit."""
        return self.head + ("" if self.unit in ("1", "none") else f" [{self.unit}]")

    @property
    def constant(self) -> bool:
        """True where all states have the same."""
        return len(set(self.texts())) == 1

    def texts(self, count: int | None = None) -> list[str]:
        """The first cells as text."""
        cells = [*self.values[:count]]
        if self.step:
            cells = [round(cell / self.step) * self.step if cell == cell else cell for cell in cells]
        return [cell if isinstance(cell, str) else number(float(cell), self.digits) for cell in cells]

    def words(self, i: int) -> str:
        """Cell of state ``i`` with its unit."""
        text = self.texts()[i]
        return text + f" {self.unit}" * bool(text and self.unit not in ("1", "none"))


#: Step over a to which places are rounded where they are shown.
_STEP = 1e-5

#: Methods in the order in which their numbers are preferred.
_PREFERRED = (FEM, CLOSED_FORM, SIE)


def preferred(data: Mapping[str, Any], rows: Mapping[str, Quantity]) -> Quantity | None:
    """Quantity by the first of the methods that an archive has; None where it has none."""
    there = (rows[method] for method in (*_PREFERRED, "") if method in rows)
    return next((row for row in there if row.path in data), None)


_Spec = tuple[str, Mapping[str, Quantity]]

#: What a state's row has after its parameters: heads, and quantities by method. Heads that begin with
#: "at" are places of what stands before.
_OF_CONTACT: tuple[_Spec, ...] = (
    ("half-width", of.HALF_WIDTH),
    ("centre", of.CENTRE),
    ("peak pressure", of.LARGEST), ("at X", of.LARGEST_X),
    ("largest tension σ_XX", stresses.HIGHEST),
    ("at X", stresses.HIGHEST_X),
)  # fmt: skip
_OF_STRENGTH: tuple[_Spec, ...] = (
    ("largest von Mises", yielding.VON_MISES), ("at X", yielding.VON_MISES_X),
    ("at Y", yielding.VON_MISES_Y),
)  # fmt: skip
_OF_EDGES: tuple[_Spec, ...] = (
    ("K_I, left", of.K_I_LEFT),
    ("K_I, right", of.K_I_RIGHT),
    ("exponent β, left", {"": of.BETA}), ("exponent α, right", {"": of.ALPHA}),
)  # fmt: skip
_INDENTATION: _Spec = ("indentation v₀", {FEM: of.INDENTATION})
#: Pull under the punch, which no punch exerts.
_PULL: tuple[_Spec, ...] = (
    ("pull under the punch", validity.TENSION),
    ("at X", validity.TENSION_X),
)
#: What says where answers hold, and more of yield, in a table of its own.
_LIMITS: tuple[_Spec, ...] = (
    ("largest shear in the plane", yielding.SHEAR), ("at X", yielding.SHEAR_X),
    ("at Y", yielding.SHEAR_Y),
    ("yields within, from X = -a", yielding.REACH_LEFT),
    ("yields within, from X = a", yielding.REACH_RIGHT),
    ("slip reversed within, from X = -a", {CLOSED_FORM: validity.SLIP_REVERSED[0]}),
    ("slip reversed within, from X = a", {CLOSED_FORM: validity.SLIP_REVERSED[1]}),
    ("strain above 5 % within, from X = -a", {CLOSED_FORM: validity.STRAIN[0]}),
    ("strain above 5 % within, from X = a", {CLOSED_FORM: validity.STRAIN[1]}),
    ("waves that cross the contact in a stroke", {"": validity.CROSSINGS}),
    ("flutter from σ_XY/σ_YY > 0 of", {"": validity.FLUTTER["positive"]}),
    ("flutter from σ_XY/σ_YY < 0 of", {"": validity.FLUTTER["negative"]}),
)  # fmt: skip


def state_columns(data: Mapping[str, Any], units: Units) -> list[Column]:
    """Columns of the table of states, one row a state: its parameters, and its results.

    Every result stands once, by the preferred method. What an archive does not have is left out. The
    screen, CSV, notebooks and pages all show these columns.

    Args:
        data: datasets of the archive by path; stresses along the surface and inside are not needed.
        units: of the result.
    """
    contact, count = units.contact, len(data[of.FRICTION.path])
    results = [*_columns(data, units, _OF_CONTACT)]
    solved = bool(results) or any(preferred(data, rows) for _, rows in (*_OF_EDGES[:2], _INDENTATION))
    if solved and units.half_width is contact.half_width:
        length = units.scale(CONTACT)
        width = np.full(count, contact.half_width) * length.factor
        results.insert(0, Column("half-width", width, length.unit, "half_width"))
    if pull := [column for column in _columns(data, units, _PULL)]:
        results += pull if np.nanmax(pull[0].values) > 0.0 else []
    results += _shear_at_interfaces(data, units)
    results += _of_layers(data, units) or [
        *_columns(data, units, _OF_STRENGTH),
        *_yields(data, units),
    ]
    results += [
        c for c in _columns(data, units, (("depth of yield", yielding.DEPTH),)) if np.nanmax(c.values)
    ]
    edges = _columns(data, units, _OF_EDGES)
    if any(column.head.startswith("K_I") and np.any(column.values) for column in edges):
        results += edges
    results += _columns(data, units, (_INDENTATION,))
    return [*_parameter_columns(data, units), *results]


def _parameter_columns(data: Mapping[str, Any], units: Units) -> list[Column]:
    """Columns of what is given: friction, speed, load, and what else tells states apart."""
    f, count = data[of.FRICTION.path], len(data[of.FRICTION.path])
    apart = parameters(dict(data))
    motion, speed = apart.pop(of.MOTION.path), apart.pop(of.SPEED.path)
    apart.pop(of.LOAD.path, None)
    columns = [
        Column("stroke", [*map(str, data[motion.path])], "none", "motion", motion.path),
        Column("friction f", f, "1", "f", of.FRICTION.path),
    ]
    if resultant := preferred(data, of.RESULTANT_RATIO):
        # The force over the load is no mean of f over the contact, since the pressure weighs it.
        g = data[of.RATIO.path]
        force = f * data[resultant.path] / np.where(g == 0.0, 1.0, g)
        columns[1:] = [
            Column("friction f", force, "1", "f", resultant.path),
            Column("mean of f over X", f, "1", "mean_f", of.FRICTION.path),
        ]
    scaled = units(speed)
    assert scaled
    head = "speed c over the wave speed" if units.dimensionless else "speed"
    columns.append(
        Column(head, scaled.of(data[speed.path]), scaled.unit, scaled.name, speed.path, digits=6)
    )
    load = units.scale(of.LOAD.unit)
    columns.append(
        Column("load", load.of(np.full(count, units.load)), load.unit, "load", of.LOAD.path, digits=6)
    )
    for path, row in apart.items():
        values = data[path]
        if row.type != TEXT and np.allclose(values, np.abs(f), rtol=1e-12):
            continue  # Coulomb's coefficient is the friction
        scaled = units(row)
        assert scaled
        in_units = [*map(str, values)] if row.type == TEXT else scaled.of(values)
        columns.append(Column(plain(f"${row.symbol}$"), in_units, scaled.unit, scaled.name, path))
    return columns


def _columns(data: Mapping[str, Any], units: Units, specs: Sequence[_Spec]) -> list[Column]:
    """Columns of the quantities that an archive has; without finite numbers there is none."""
    columns = []
    for head, rows in specs:
        row = preferred(data, rows)
        scaled = row and units(row)
        if row and scaled and np.isfinite(data[row.path]).any():
            place = head.startswith("at ")
            head = f"{head}/a" if place and units.dimensionless else head
            values = scaled.of(data[row.path])
            along = row.scale in (X_OVER_A, CONTACT)
            step = _STEP * float(np.max(units.length.factor))
            columns.append(
                Column(
                    head, values, scaled.unit, scaled.name, row.path, place=place,
                    step=step if along and not units.dimensionless else 0.0,
                )
            )  # fmt: skip
    return columns


def _shear_at_interfaces(data: Mapping[str, Any], units: Units) -> list[Column]:
    """Columns of the largest |σ_XY| at each interface, and of its place."""
    rows = preferred(data, {method: of_all[4] for method, of_all in layers.INTERFACE_EXTREMES.items()})
    if rows is None:
        return []
    highest, at_highest, lowest, at_lowest = layers.INTERFACE_EXTREMES[rows.method][4:8]
    stress, X = units.stress, units(at_highest, "")
    assert X
    down = np.abs(data[lowest.path]) > np.abs(data[highest.path])
    shear = stress.of(np.where(down, np.abs(data[lowest.path]), np.abs(data[highest.path])))
    places = X.of(np.where(down, data[at_lowest.path], data[at_highest.path]))
    depths, several, columns = units.contact.solid.depths, shear.shape[1] > 1, []
    for i, depth in enumerate(depths):
        head = f"shear {engineering(depth, 'm')} deep" if several else "interface shear"
        name = f"interface_shear{f'_{i + 1}' * several}"
        columns += [
            Column(head, shear[:, i], stress.unit, name),
            Column(f"at X{'/a' * units.dimensionless}", places[:, i], X.unit, f"{name}_X", place=True),
        ]
    return columns


def _of_layers(data: Mapping[str, Any], units: Units) -> list[Column]:
    """Columns of the largest von Mises stress of each layer and of the solid below, its place, and
    whether that yields; none for uniform solids, nor where it was not computed."""
    row = preferred(data, yielding.OF_LAYERS)
    if row is None:
        return []
    values, columns = data[row.path], []
    places = [rows[row.method] for rows in (yielding.OF_LAYERS_X, yielding.OF_LAYERS_Y)]
    shares = data.get(yielding.OVER_STRENGTH[row.method].path, np.full(values.shape, np.nan))
    for i in range(values.shape[1]):
        below = i == values.shape[1] - 1
        where = "below the layers" if below else f"in layer {i + 1}"
        name = f"von_mises_{'below' if below else i + 1}"
        columns.append(
            Column(f"von Mises {where}", units.stress.of(values[:, i]), units.stress.unit, name)
        )
        for head, scale, place in zip("XY", (units.position, units.length), places):
            at = scale.of(data[place.path][:, i])
            head = f"at {head}{'/a' * units.dimensionless}"
            columns.append(Column(head, at, scale.unit, f"{name}_{head[3]}", place=True))
        if np.isfinite(shares[:, i]).any():
            words = [_share(share) for share in shares[:, i]]
            columns.append(Column(f"yields {where}", words, "of the yield strength", f"{name}_yields"))
    return columns


def _share(share: float) -> str:
    """Yes or no to yield under a share of the strength, with the share; "" for NaN."""
    return "" if isnan(share) else f"{'yes' if share >= 1.0 else 'no'}, {number(100.0 * share, 3)} %"


def _yields(data: Mapping[str, Any], units: Units) -> list[Column]:
    """Columns of whether every state yields, and from which load on; none where that was not computed."""
    count, contact = len(data[of.FRICTION.path]), units.contact
    first, stress = preferred(data, yielding.FIRST_LOAD), preferred(data, yielding.VON_MISES)
    if first is not None:
        shares, unit = np.full(count, units.load) / data[first.path], "of first yield"
    elif stress is not None and contact.yield_strength:
        strength = contact.yield_strength * 2.0 * units.half_width / units.load
        shares, unit = data[stress.path] / strength, "of the yield strength"
    elif preferred(data, yielding.REACH_LEFT) is not None:
        return [Column("yields", ["yes, at the sharp edges"] * count, "none", "yields")]
    else:
        return []
    words = [_share(share) for share in shares]
    loads = _columns(data, units, (("load at first yield", yielding.FIRST_LOAD),))
    return [Column("yields", words, unit, "yields"), *loads]


def layout(
    title: str, labels: Sequence[str], columns: Sequence[Column], width: int = 0, noun: str = "state"
) -> Sheet:
    """Table of columns that suits a width: lines for one row, few rows side by side, else as they are.

    Args:
        title: of the table.
        labels: of the rows.
        columns: of the table.
        width: characters of a line; 0 for rows below each other in any case.
        noun: what a row is of.
    """
    if width and len(labels) == 1:
        lines: list[list[str]] = []
        for column in columns:
            if column.place and lines:
                lines[-1][1] += f"{' ' if ' at ' not in lines[-1][1] else ', '}{_at(column)}"
            elif column.texts()[0]:
                lines.append([column.head, column.words(0)])
        return Sheet(title, ["", ""], lines)
    texts = [column.texts(len(labels)) for column in columns]
    heads = [f"  {column.label}" if column.place else column.label for column in columns]
    if width and len(labels) <= BESIDE:
        return Sheet(title, [noun, *labels], [[head, *row] for head, row in zip(heads, texts)])
    heads = [_folded(column) if width else column.label for column in columns]
    return Sheet(title, [noun, *heads], [[label, *row] for label, *row in zip(labels, *texts)])


def _folded(column: Column) -> str:
    """Head over a narrow column, in several lines."""
    wide = max(_NARROW, *map(len, column.texts()), *map(len, column.label.split()))
    return textwrap.fill(column.label, wide, break_on_hyphens=False)


def _at(column: Column) -> str:
    """Place in words: ``at X = -52.5 µm``, and further coordinates without at."""
    head = column.head.removeprefix("at ")
    return f"{'at ' * head.startswith('X')}{head} = {column.words(0)}"


def states_sheet(data: dict[str, Any], units: Units, title: str = "", width: int = 0) -> Sheet:
    """Table of the first states of an archive, with :func:`state_columns`.

    What is the same in all states of several stands in a note.

    Args:
        data: datasets of the archive by path.
        units: of the result.
        title: title of the table; "" for "States".
        width: as for :func:`layout`.
    """
    columns, count = state_columns(data, units), len(data[of.FRICTION.path])
    known = {*parameters(data), of.LOAD.path, of.FRICTION.path, ""}
    given = [column for column in columns if column.path in known and column.name != "yields"]
    same = [
        c for c in given if c.constant and not c.place and (count > 1 or c.name in ("motion", "X_over_L"))
    ]
    shown = [column for column in columns if column not in same]
    notes = [f"and {count - LIMIT} more states; csv and show --json list all"] if count > LIMIT else []
    told = [c for c in same if not (c.name in ("motion", "X_over_L") and count == 1)]
    told = [c for c in told if c.name != "motion" or not c.values[0].startswith("FM")]
    if told:
        notes.append(f"the same in all: {', '.join(f'{c.head} = {c.words(0)}' for c in told)}")
    notes += _notes(data, units, shown)
    labels = [*map(str, range(min(count, LIMIT)))]
    return replace(layout(title or "States", labels, shown, width), notes=notes)


def _notes(data: Mapping[str, Any], units: Units, columns: Sequence[Column]) -> Iterator[str]:
    """Notes on columns, and on how to ask for those that are not there."""
    heads = {column.head for column in columns}
    if "K_I, right" in heads:
        if "largest tension σ_XX" in heads:
            yield "σ_XX: further than 0.01 a from sharp edges, at which it is infinite"
        if not units.dimensionless:
            yield "K_I: limit of the pressure times (2π distance)^-exponent, at X = -a and X = a"
    if speeds := solved_speeds(data):
        yield speeds
    lacking = []
    if "half-width" in heads or "K_I, right" in heads:
        if "largest tension σ_XX" not in heads:
            lacking.append('"surface" (σ_XX)')
        if len(units.contact.solid.depths) and not any("shear" in head for head in heads):
            lacking.append('"interfaces" (their shear)')
        computed = any(word in head for head in heads for word in ("yields", "von Mises"))
        if not computed and YIELD not in units.contact.lacks:
            lacking.append('"yield" (von Mises, yields or not)')
    if lacking:
        yield f"not asked for: {', '.join(lacking)}; add these to output.quantities"


def sheets_of_run(data: dict[str, Any], units: Units, title: str, width: int) -> list[Sheet]:
    """Tables of what was computed: states, sliders and motions in time, those that there are."""
    states = states_sheet(data, units, title, width)
    sheets = states, sliders_sheet(data, units, width), starts_sheet(data, units, width)
    return [sheet for sheet in sheets if sheet.rows]


def limits_sheet(data: dict[str, Any], units: Units, width: int = 0) -> Sheet:
    """Table of more on yield, and of where answers hold, a row a state; none of what never occurs."""
    columns = [c for c in _columns(data, units, _LIMITS) if np.nanmax(np.abs(c.values)) > 0.0]
    kept = [c for c, before in zip(columns, [None, *columns]) if not c.place or before in columns]
    labels = [*map(str, range(min(len(data[of.FRICTION.path]), LIMIT)))]
    return layout("Where answers hold", labels, kept, width) if kept else Sheet("", [], [])


def solved_speeds(data: Mapping[str, Any]) -> str:
    """Number of speeds that finite elements solved, in words; "" where they solved every speed."""
    if of.FITTED.path not in data:
        return ""
    c, fitted = data[of.SPEED.path], data[of.FITTED.path]
    solved = len(np.unique(c[fitted == 0.0]))
    return f"finite elements: {solved} of {len(np.unique(c))} speeds solved, the others by a fit"


#: Labels and quantities of loops in their table, and functions that combine values of all strokes.
_OF_LOOPS: tuple[tuple[str, Quantity, Callable[[Any], Any]], ...] = (
    ("work", runs.LOOP_WORK, lambda values: values.sum(axis=1)),
    ("work of the closed loop", runs.LOOP_CYCLE, lambda values: values),
    ("breakaway force", runs.LOOP_BREAKAWAY, lambda values: values.max(axis=1)),
    ("stiffness", runs.LOOP_STIFFNESS, lambda values: values[:, 0]),
)


def loops_sheet(data: dict[str, Any], units: Units, width: int = 0) -> Sheet:
    """Table of the first friction loops: work, breakaway force and stiffness.

    Where friction varies along the contact there are no rows: the loops are those of the law alone.
    """
    if preferred(data, of.RESULTANT_RATIO):
        return Sheet("", [], [])
    of_state, count = data[runs.LOOP_OF_STATE.path], len(data[runs.LOOP_F.path])
    states = [int(np.argmax(of_state == n)) for n in range(count)]
    columns = [
        Column(c.head, [c.values[i] for i in states], c.unit, c.name, c.path, c.digits)
        for c in _parameter_columns(data, units)
        if c.name not in ("motion", "X_over_L", "f") and not c.constant
    ]
    for head, row, reduced in _OF_LOOPS:
        scaled = units(row)
        if row.path in data and scaled and np.nan_to_num(values := reduced(data[row.path])).any():
            columns.append(Column(head, scaled.of(values), scaled.unit, scaled.name, row.path, digits=5))
    note = "all per depth, in all strokes; stiffness: where the first stroke begins"
    if of.LOAD.path in data:
        load = units.scale(of.LOAD.unit)
        note += f"; under the first load, N = {load.text(load.factor * data[of.LOAD.path][0])}"
    sheet = layout("Friction loops", [*map(str, range(min(count, LIMIT)))], columns, width, "loop")
    return replace(sheet, notes=[note])


def inner_sheet(data: dict[str, Any]) -> Sheet:
    """Table of the law's inner variables at the first states; no rows without any, or for f alone.

    Where friction varies along the contact there are none either.
    """
    if preferred(data, of.RESULTANT_RATIO):
        return Sheet("", [], [])
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


_OF_SLIDERS = (
    ("period", runs.PERIOD), ("slip per cycle", runs.SLIP), ("peak velocity", runs.PEAK),
    ("least velocity", runs.LEAST),
)  # fmt: skip


def sliders_sheet(data: dict[str, Any], units: Units, width: int = 0) -> Sheet:
    """Table of the motion of the slider for the first laws, with its stick-slip."""
    if runs.OUTCOME.path not in data:
        return Sheet("", [], [])
    outcomes = [*map(str, data[runs.OUTCOME.path])]
    columns = [Column("motion", outcomes, "none", "outcome", runs.OUTCOME.path)]
    for head, row in _OF_SLIDERS:
        scaled = units(row)
        if scaled and np.isfinite(data[row.path]).any():
            columns.append(
                Column(head, scaled.of(data[row.path]), scaled.unit, scaled.name, row.path, digits=6)
            )
    labels = [*map(str, range(min(len(outcomes), LIMIT)))]
    return layout("Motion of the slider", labels, columns, width, "law")


def starts_sheet(data: dict[str, Any], units: Units, width: int = 0) -> Sheet:
    """Table of the first starts at the end of the motion, by finite elements if the archive has them."""
    title = "In time, at the end"
    method = next((name for name in (FEM, SIE) if over_time.V0[name].path in data), "")
    if not method:
        return Sheet(title, [], [])

    def scaled(row: Quantity) -> Scaled:
        return units(row) or as_archived(row, "")

    def column(head: str, row: Quantity, digits: int = 5) -> Column:
        values = data[row.path]
        last = values[:, -1] if values.ndim == 2 else values
        return Column(head, scaled(row).of(last), scaled(row).unit, digits=digits)

    time = scaled(over_time.TIMES)
    end, when = float(data[over_time.TIMES.path][-1]), data[over_time.WITHIN[method].path][:, 1]
    columns = [
        Column(
            "way", ["-+"[int(way > 0.0)] + "X" for way in data[over_time.DIRECTION.path][:, -1]], "none"
        ),
        column("c" if units.dimensionless else "speed", over_time.SPEED, 6),
        column("σ_XY/σ_YY", over_time.RATIO),
        column("v₀", over_time.V0[method]),
        column("centre", over_time.CENTRE[method]),
        column("K_I left", over_time.K_I_LEFT[method]),
        column("K_I right", over_time.K_I_RIGHT[method]),
        column("centre in steady motion", over_time.STEADY_CENTRE),
        Column("off steady motion", 100.0 * data[over_time.OFF[method].path], "%", digits=3),
        Column("within 1 % from", [_when(t, end, time) for t in when], "none"),
    ]
    by_formula = data[over_time.APPROACH.path]
    if np.isfinite(by_formula).any():
        columns.append(Column("by formula", [_rounded(t, time) for t in by_formula], "none"))
    labels = [*map(str, range(min(len(when), LIMIT)))]
    notes = [
        f"at t = {time.text(time.factor * end)}; centre: of the pressure, towards +X",
        "off: largest relative difference of K_I, or of the centre over a, from steady motion",
        "within 1 %: of both; ~ by 1/t after the end; by formula: for late times, of uniform solids",
        "K_I: dimensionless, by the final load",
    ]
    return replace(layout(title, labels, columns, width, "start"), notes=notes)


def _when(time: float, end: float, scaled: Scaled) -> str:
    """Time in words; with ~ where it is extrapolated beyond the end."""
    if isnan(time):
        return "later than can be told"
    return scaled.text(scaled.factor * time, 3) if time <= end else f"~ {_rounded(time, scaled)}"


def _rounded(time: float, scaled: Scaled) -> str:
    """Time in words, with two digits."""
    return "" if isnan(time) else scaled.text(scaled.factor * time, 2)
