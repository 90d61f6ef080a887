"""Tables as text: states, limits of the answers, friction loops, sliders, motions in time.

Quantities are written as archived, or scaled to other units. States of an archive are identified by their
parameters: speed, load, the law's constants, motion and position.
"""

import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isnan, nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact import YIELD
from galinx.solvers.contact.solution import FINITE, STRENGTH
from galinx.texts import plain

from .quantities import (
    Quantity,
    column,
    layers,
    of_any_method,
    over_time,
    preferred,
    runs,
    stresses,
    swept,
    table,
    validity,
    yielding,
)
from .quantities import states as of
from .quantities.quantity import CLOSED_FORM, CONTACT, FEM, OVER_A, SIE, TEXT
from .units import Units, engineering, number, solved


def parameters(data: dict[str, Any]) -> dict[str, Quantity]:
    """Parameters that identify an archive's states, by the paths of their datasets, slowest first.

    Args:
        data: datasets of the archive by path.
    """
    rows = {path: row for path, row in table().items() if row.symbol and path in data}
    first, last = [of.SPEED.path, *({of.LOAD.path} & rows.keys())], [of.MOTION.path, of.POSITION.path]
    swept = [path for path in rows if "." in path]
    own = [path for path in rows if path not in (*swept, *first, *last)]
    return {path: rows[path] for path in (*swept, *first, *own, *last)}


#: Most states in a table, and most of them side by side.
LIMIT, BESIDE = 24, 8


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
        owner: of a place, the column of what is there.
        least: size up to which a number is rounding, and shown as 0.
        said: gives a number in words; None where it is shown as a number.
    """

    head: str
    values: Any
    unit: str = "1"
    name: str = ""
    path: str = ""
    digits: int = 4
    owner: "Column | None" = None
    least: float = 0.0
    said: Callable[[float], str] | None = None

    def __repr__(self) -> str:
        return f"{self.label}: {', '.join(self.texts())}"

    @property
    def label(self) -> str:
        """Head with the unit."""
        return self.head + ("" if self.unit in ("1", "none") else f" [{self.unit}]")

    @property
    def place(self) -> bool:
        """True for a place."""
        return self.owner is not None

    @property
    def constant(self) -> bool:
        """True where all states have the same."""
        texts = map(self._text, {*self.shown()})
        first = next(texts, None)
        return first is not None and all(text == first for text in texts)

    def of(self, states: Iterable[int]) -> "Column":
        """Column of some states in any order, as is that of what is at its places."""
        states = [*states]
        owner = self.owner and self.owner.of(states)
        return replace(self, values=[self.values[i] for i in states], owner=owner)

    def shown(self, count: int | None = None) -> list[Any]:
        """The first cells, those that are rounding as 0, and places of such as NaN."""
        cells = [*self.values[:count]]
        cells = [0.0 if not isinstance(cell, str) and abs(cell) <= self.least else cell for cell in cells]
        there = self.owner.shown(count) if self.owner else cells
        return [nan if self.owner and of == 0.0 else cell for cell, of in zip(cells, there)]

    def texts(self, count: int | None = None) -> list[str]:
        """The first cells as text."""
        return [self._text(cell) for cell in self.shown(count)]

    def _text(self, cell: Any) -> str:
        if isinstance(cell, str):
            return cell
        return self.said(cell) if self.said else number(float(cell), self.digits)

    def words(self, i: int) -> str:
        """Cell of state ``i`` with its unit."""
        text = self.texts(i + 1)[i]
        return text + f" {self.unit}" * bool(text and self.unit not in ("1", "none"))


class _Spec(NamedTuple):
    """Properties of a column.

    Attributes:
        head: what it is, in words; it begins with "at" for a place of what stands before.
        rows: a quantity, or one of each method.
        digits: that are shown.
        taken: gives the column's numbers from the quantity's values, and from an archive's data.
        name: in tables for programs, of a column that is no dataset's; "" for that of the quantity.
        exact: True where no small number is rounding.
    """

    head: str
    rows: Quantity | Mapping[str, Quantity]
    digits: int = 4
    taken: Callable[[Any, Mapping[str, Any]], Any] = lambda values, _: values
    name: str = ""
    exact: bool = False


def _nth(n: int) -> Callable[[Any, Any], Any]:
    """Function that takes the numbers of one of a state's layers, strokes or instants."""
    return lambda values, _: values[:, n]


def _where_tension(values: Any, data: Mapping[str, Any]) -> Any:
    """Values of the largest σ_XX, NaN where it is below 0."""
    largest = preferred(data, stresses.HIGHEST)
    assert largest
    return np.where(data[largest.path] < 0.0, np.nan, values)


#: What says where answers hold, and more of yield, in a table of its own.
_LIMITS = (
    _Spec("largest shear in the plane", yielding.SHEAR), _Spec("at X", yielding.SHEAR_X),
    _Spec("at Y", yielding.SHEAR_Y),
    _Spec("yields within, from X = -a", yielding.REACH_LEFT),
    _Spec("yields within, from X = a", yielding.REACH_RIGHT),
    _Spec("slip reversed within, from X = -a", validity.SLIP_REVERSED[0]),
    _Spec("slip reversed within, from X = a", validity.SLIP_REVERSED[1]),
    _Spec("strain above 5 % within, from X = -a", validity.STRAIN[0]),
    _Spec("strain above 5 % within, from X = a", validity.STRAIN[1]),
    _Spec("waves that cross the contact in a stroke", validity.CROSSINGS),
    _Spec("flutter threshold, σ_XY/σ_YY > 0", validity.FLUTTER["positive"]),
    _Spec("flutter threshold, σ_XY/σ_YY < 0", validity.FLUTTER["negative"]),
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

    def columns(*specs: _Spec) -> list[Column]:
        return _columns(data, units, specs)

    results = columns(
        _Spec("half-width", of.HALF_WIDTH),
        _Spec("centre", of.CENTRE),
        _Spec("peak pressure", of.LARGEST), _Spec("at X", of.LARGEST_X),
        _Spec("largest tension σ_XX", stresses.HIGHEST, 4, _where_tension),
        _Spec("at X", stresses.HIGHEST_X, 4, _where_tension),
    )  # fmt: skip
    intensities = columns(_Spec("K_I, left", of.K_I_LEFT), _Spec("K_I, right", of.K_I_RIGHT))
    indentation = columns(_Spec("indentation v₀", of.INDENTATION))
    given = units.half_width is contact.half_width and not units.dimensionless
    if (results or intensities or indentation) and given:
        length = units.scale(CONTACT)
        width = np.full(count, contact.half_width) * length.factor
        results.insert(0, Column("half-width", width, length.unit, "half_width"))
    # A pressure's own resultant, where it is not the load N.
    forces = of.RESULTANT | {FEM: of.NORMAL_FORCE}
    resultant = columns(_Spec("resultant of the pressure", forces, 4, lambda N, _: -N, "resultant"))
    load = units.scale(of.LOAD.unit).of(np.full(count, units.load))
    place = int(bool(results) and results[0].name == "half_width")
    results[place:place] = [c for c in resultant if np.any(np.abs(c.values / load - 1.0) > 1e-6)]
    # No punch can pull: where one would, the answer does not hold.
    results += _occurring(
        columns(_Spec("pull under the punch", validity.TENSION), _Spec("at X", validity.TENSION_X))
    )
    results += _shear_at_interfaces(data, units)
    results += _of_layers(data, units) or columns(
        _Spec("largest von Mises", yielding.VON_MISES), _Spec("at X", yielding.VON_MISES_X),
        _Spec("at Y", yielding.VON_MISES_Y),
    )  # fmt: skip
    results += _yields(data, units)
    results += _occurring(columns(_Spec("depth of yield", yielding.DEPTH, exact=True)))
    results += columns(
        _Spec("von Mises in the punch", yielding.PUNCH_VON_MISES),
        _Spec("at X", yielding.PUNCH_VON_MISES_X), _Spec("at Y", yielding.PUNCH_VON_MISES_Y),
        _Spec("first yield of the punch", yielding.PUNCH_FIRST_LOAD),
    )  # fmt: skip
    results += _yields_first(data, units)
    if _occurring(intensities):
        exponents = _Spec("exponent β, left", of.BETA), _Spec("exponent α, right", of.ALPHA)
        results += intensities + columns(*exponents)
    return [*_parameter_columns(data, units), *results, *indentation]


def _occurring(columns: Sequence[Column]) -> list[Column]:
    """Columns of numbers but those that are 0 in all states, with the places of those that are left."""
    left: list[Column] = []
    for each in columns:
        if np.nan_to_num(each.shown()).any() or any(each.owner is other for other in left):
            left.append(each)
    return left


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
        if preferred(data, of.HALF_WIDTH):  # slip over free ends follows the width, and the mean with it
            del columns[2]
    head = "speed c over the wave speed" if units.dimensionless else "speed"
    columns += _columns(data, units, [_Spec(head, speed, 6)])
    load = units.scale(of.LOAD.unit)
    loads = load.of(np.full(count, units.load))
    columns.append(Column("load", loads, load.unit, "load", of.LOAD.path, digits=6))
    for path, row in apart.items():
        if row.type == TEXT or not np.allclose(data[path], np.abs(f), rtol=1e-12):
            # else it is Coulomb's coefficient, which is the friction
            columns += _columns(data, units, [_Spec(plain(f"${row.symbol}$"), row)])
    return columns


def _columns(
    data: Mapping[str, Any], units: Units, specs: Sequence[_Spec], archived: bool = False
) -> list[Column]:
    """Columns of the quantities that an archive has; without finite numbers there is none.

    Args:
        data: datasets of the archive by path.
        units: of the result.
        specs: what the columns have.
        archived: columns without finite numbers stay, and no number is taken for rounding.
    """
    columns: list[Column] = []
    owner: Column | None = None
    # Places and lengths of the contact, and stresses over N/(2a), up to which they are rounding.
    length, stress = (solved(scale.factor).max() for scale in (units.scale(OVER_A), units.stress))
    length, stress = 5e-6 * length, 5e-8 * stress  # ten times as much by finite elements
    for head, rows, digits, taken, name, exact in specs:
        if not (place := head.startswith("at ")):
            owner = None
        by_method = {"": rows} if isinstance(rows, Quantity) else rows
        row = preferred(data, by_method)
        scaled = row and units(row)
        if not row or not scaled:
            continue
        values = taken(of_any_method(data, by_method, row), data)
        path = "" if name else row.path
        if row.type == TEXT:
            columns.append(Column(head, [*map(str, values)], "none", scaled.name, path))
        elif archived or np.isfinite(data[row.path]).any():
            least = stress * (row.unit == "N/(2a)") * (10.0 if row.method == FEM else 1.0)
            if place or row.scale in (CONTACT, OVER_A):
                least = 0.0 if exact else length
            columns.append(
                Column(
                    f"{head}/a" if units.dimensionless and (place or row.scale == OVER_A) else head,
                    scaled.of(values), scaled.unit, name or scaled.name, path, digits, owner,
                    0.0 if archived else float(least),
                )
            )  # fmt: skip
            owner = owner or columns[-1]
    return columns


def _shear_at_interfaces(data: Mapping[str, Any], units: Units) -> list[Column]:
    """Columns of the largest |σ_XY| at each interface, and of its place."""
    high = preferred(data, {method: rows[4] for method, rows in layers.INTERFACE_EXTREMES.items()})
    if high is None:
        return []
    at = layers.INTERFACE_EXTREMES[high.method][5]
    of_all, depths = layers.largest_shear(data, high.method), units.contact.solid.depths
    several, columns = len(depths) > 1, list[Column]()
    for i, (depth, shear, X) in enumerate(zip(depths, *(values.T for values in of_all)), 1):
        depths_differ = swept.INTERFACE_DEPTHS.path in data
        where = f"at interface {i}" if depths_differ else f"{engineering(depth, 'm')} deep"
        head = f"shear {where}" if several else "interface shear"
        name = f"interface_shear{f'_{i}' * several}"
        columns += _columns(data, units, [
            _Spec(head, high, 4, lambda *_, held=shear: held, name),
            _Spec("at X", at, 4, lambda *_, held=X: held, f"{name}_X"),
        ])  # fmt: skip
    return columns


def _of_layers(data: Mapping[str, Any], units: Units) -> list[Column]:
    """Columns of the largest von Mises stress of each layer and of the solid below, its place, and
    whether that yields; none for uniform solids, nor where it was not computed."""
    row = preferred(data, yielding.OF_LAYERS)
    if row is None:
        return []
    columns, shape = list[Column](), data[row.path].shape
    shares = data.get(yielding.OVER_STRENGTH[row.method].path, np.full(shape, np.nan))
    for i, share in enumerate(shares.T, 1):
        below = i == shape[1]
        where, name = "below the layers" if below else f"in layer {i}", "below" if below else i
        columns += _columns(data, units, [
            _Spec(head, rows, 4, _nth(i - 1), f"von_mises_{name}{axis}")
            for head, rows, axis in (
                (f"von Mises {where}", yielding.OF_LAYERS, ""), ("at X", yielding.OF_LAYERS_X, "_X"),
                ("at Y", yielding.OF_LAYERS_Y, "_Y"),
            )
        ])  # fmt: skip
        if np.isfinite(share).any():
            unit, name = "of the yield strength", f"von_mises_{name}_yields"
            columns.append(Column(f"yields {where}", share, unit, name, said=_share))
    return columns


def _share(share: float) -> str:
    """Yes or no to yield under a share of the strength, with the share; "" for NaN.

    What does not yield is not rounded up to 100 %.
    """
    if share == np.inf:
        return "yes, under any load"
    if isnan(share):
        return ""
    digits = next(n for n in range(3, 18) if share >= 1.0 or float(number(100.0 * share, n)) < 100.0)
    return f"{'yes' if share >= 1.0 else 'no'}, {number(100.0 * share, digits)} %"


def _yields(data: Mapping[str, Any], units: Units) -> list[Column]:
    """Columns of whether every state yields, and an elastic punch, and from which load on; none where
    that was not computed."""
    count, contact = len(data[of.FRICTION.path]), units.contact

    def column_of(head: str, first: Any, stress: Any, key: str, strength: float | None) -> list[Column]:
        load, largest = preferred(data, first), preferred(data, stress)
        if load is not None:
            with np.errstate(divide="ignore"):  # infinite stresses yield under any load
                shares, unit = np.full(count, units.load) / data[load.path], "of first yield"
        elif largest is not None and strength:
            unit = "of the yield strength"
            over = data.get(column(key), strength) * 2.0 * units.half_width / units.load
            shares = data[largest.path] / over
        else:
            return []
        name = "_".join(head.split())
        return [Column(head, shares, unit, name, said=_share)]

    # Layers have columns of their own.
    strength = None if contact.solid.layers else contact.yield_strength
    of_solid = column_of(
        "yields", yielding.FIRST_LOAD, yielding.VON_MISES, "solid.yield_strength", strength
    )
    # A contact with free ends says so without being asked.
    free = preferred(data, of.HALF_WIDTH) is not None
    answers = free or f'"{YIELD}"' in str(data.get(runs.SCENE.path, ""))
    words = "yes, at the sharp edges" * (preferred(data, yielding.REACH_LEFT) is not None)
    if answers and contact.yield_strength and FINITE not in contact.modes and not contact.solid.layers:
        words = words or _share(np.inf)  # at a tip, or beside an end that is free
    if words and not of_solid:
        depth = preferred(data, yielding.DEPTH)
        deep = np.isnan(data[depth.path]) if depth else np.zeros(count, dtype=bool)
        said = [words + ", deeper than 10 a" * bool(of_state) for of_state in deep]
        of_solid = [Column("yields", said, "none", "yields")]
    of_punch = column_of(
        "punch yields", yielding.PUNCH_FIRST_LOAD, yielding.PUNCH_VON_MISES, "punch.solid.yield_strength",
        contact.solid.punch_strength,
    )  # fmt: skip
    loads = _columns(data, units, [_Spec("load at first yield", yielding.FIRST_LOAD)])
    return [*of_solid, *of_punch, *loads]


def _yields_first(data: Mapping[str, Any], units: Units) -> list[Column]:
    """Column of the body that yields first of two elastic ones; none where that was not computed."""
    over = preferred(data, yielding.OVER_STRENGTH)
    of_plate, of_punch = (preferred(data, row) for row in (yielding.VON_MISES, yielding.PUNCH_VON_MISES))
    strengths = units.contact.yield_strength, units.contact.solid.punch_strength
    if not of_plate or not of_punch or not strengths[1] or not (over or strengths[0]):
        return []
    unit = units.load / (2.0 * units.half_width)
    if over:  # of the layer, or of the solid below, that yields first
        plate = np.nanmax(data[over.path], axis=1) / unit
    else:
        plate = data[of_plate.path] / data.get(column("solid.yield_strength"), strengths[0])
    punch = data[of_punch.path] / data.get(column("punch.solid.yield_strength"), strengths[1])
    words = ["" if isnan(a) else "plate" if a > b else "punch" for a, b in zip(plate, punch)]
    return [Column("yields first", words, "none", "yields_first")]


def layout(
    title: str, count: int, columns: Sequence[Column], width: int = 0, noun: str = "state"
) -> Sheet:
    """Table of columns that suits a width: lines for one row, few rows side by side, else as they are.

    Args:
        title: of the table.
        count: number of rows, of which the first are shown.
        columns: of the table.
        width: characters of a line; 0 for rows below each other in any case.
        noun: what a row is of.
    """
    labels = [*map(str, range(min(count, LIMIT)))]
    if width and len(labels) == 1:
        lines: list[list[str]] = []
        for column in columns:
            if not column.texts()[0]:
                continue
            if column.place and lines:  # as in "at X = -52.5 µm, Y = -41.2 µm"
                where = f"{column.head.removeprefix('at ')} = {column.words(0)}"
                lines[-1][1] += f", {where}" if " at " in lines[-1][1] else f" at {where}"
            else:
                lines.append([column.head, column.words(0)])
        return Sheet(title, ["", ""], lines)
    texts = [column.texts(len(labels)) for column in columns]
    heads = [f"  {column.label}" if column.place else column.label for column in columns]
    if width and len(labels) <= BESIDE:
        return Sheet(title, [noun, *labels], [[head, *row] for head, row in zip(heads, texts)])
    heads = [column.label for column in columns]
    for n, column in enumerate(columns if width else ()):  # in several lines over a narrow column
        wide = max(11, *map(len, texts[n]), *map(len, column.label.split()))
        heads[n] = textwrap.fill(column.label, wide, break_on_hyphens=False)
    return Sheet(title, [noun, *heads], [[label, *row] for label, *row in zip(labels, *texts)])


def shared(columns: Sequence[Column]) -> list[Column]:
    """Columns in which several states have the same, but for places and what has one."""
    followed = zip(columns, (*columns[1:], None))
    return [
        column for column, after in followed
        if len(column.values) > 1 and column.constant and not (column.place or (after and after.place))
    ]  # fmt: skip


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
    present = {*parameters(data), of.LOAD.path, of.FRICTION.path, ""}
    given = [column for column in columns if column.path in present and "yields" not in column.head]
    same = [
        c for c in given if c.constant and not c.place and (count > 1 or c.name in ("motion", "X_over_L"))
    ]
    shown = [column for column in columns if column not in same]
    notes = _more(count, "states")
    named = [c for c in same if c.name != "motion" or not c.values[0].startswith("FM")]
    if count > 1 and named:
        notes.append(f"the same in all: {', '.join(f'{c.head} = {c.words(0)}' for c in named)}")
    notes += _notes(data, units, shown)
    return replace(layout(title or "States", count, shown, width), notes=notes)


def _notes(data: Mapping[str, Any], units: Units, columns: Sequence[Column]) -> Iterator[str]:
    """Notes on columns, and on how to ask for those that are not there."""
    heads = {column.head for column in columns}
    if "stroke" in heads:
        yield "FM1, BM1: first forward, first backward motion; later ones are counted on"
    pressure = units.contact.pressure
    jumps = pressure is not None and pressure.values[[0, -1]].any() and data[of.RATIO.path].any()
    if "largest tension σ_XX" in heads and ("K_I, right" in heads or jumps):
        yield "σ_XX: further than 0.01 a from sharp edges, at which it is infinite"
    if "K_I, right" in heads and not units.dimensionless:
        where = "both ends" if "half-width" in heads else "X = -a and X = a"
        yield f"K_I: limit of the pressure times (2π distance)^(-exponent), at {where}"
    if units.dimensionless and "half-width" in heads:
        yield f"half-width, centre: {units.of_a}"
        yield "X/a, Y/a and N/(2a): a is the half-width of each contact, and X is from its middle"
    if {"resultant of the pressure", "load at first yield"} <= heads:
        yield "load at first yield: N; the pressure and its resultant grow with it"
    first, depth = preferred(data, yielding.FIRST_LOAD), preferred(data, yielding.DEPTH)
    if first and depth and (np.isnan(data[depth.path]) & (data[first.path] <= units.load)).any():
        yield "depth of yield: none is given beyond 10 a"
    if speeds := solved_speeds(data):
        yield speeds
    lacking = []
    if "half-width" in heads or "K_I, right" in heads:
        if "largest tension σ_XX" not in heads:
            lacking.append('"surface" (σ_XX)')
        if len(units.contact.solid.depths) and not any("shear" in head for head in heads):
            lacking.append('"interfaces" (their shear)')
        computed = any(word in head for head in heads for word in ("yields", "von Mises"))
        contact = units.contact
        bears = FINITE in contact.modes or STRENGTH not in contact.lacks
        # The integral equation leaves uniform solids with one friction to the closed form.
        by_others = any(f"/{method}/" in path for method in (CLOSED_FORM, FEM) for path in data)
        knows = by_others or bool(contact.solid.layers) or bool(contact.along)
        if not computed and bears and knows and YIELD not in contact.lacks:
            lacking.append('"yield" (von Mises, yields or not)')
    # What a scene asks for, and no method of it gives, is in its plan.
    scene = str(data.get(runs.SCENE.path, ""))
    lacking = [words for words in lacking if words.partition(" ")[0] not in scene]
    if lacking:
        yield f"not asked for: {', '.join(lacking)}; add these to output.quantities"


def sheets(
    data: dict[str, Any], units: Units, title: str | None, width: int, strokes: bool | None = None
) -> list[Sheet]:
    """Tables that have rows, that of states first.

    Args:
        data: datasets of the archive by path.
        units: of the result.
        title: of the first table, None to leave it away.
        width: characters of a line.
        strokes: True where strokes were asked for, which have friction loops; None for results alone:
            states, sliders and motions in time.
    """
    made = [] if title is None else [states_sheet(data, units, title, width)]
    made += [sliders_sheet(data, units, width), starts_sheet(data, units, width)]
    if strokes:
        made.append(loops_sheet(data, units, width))
    if strokes is not None:
        made.append(limits_sheet(data, units, width))
    return [sheet for sheet in made if sheet.rows]


def limits_sheet(data: dict[str, Any], units: Units, width: int = 0) -> Sheet:
    """Table of more on yield, and of where answers hold, a row a state; none of what never occurs."""
    kept = _occurring(_columns(data, units, _LIMITS))
    title, count, notes = "More, and where answers hold", len(data[of.FRICTION.path]), list[str]()
    if same := shared(kept):
        if len(same) < len(kept):
            kept = [c for c in kept if c not in same]
            notes = [f"the same in all: {', '.join(f'{c.head}: {c.words(0)}' for c in same)}"]
        else:  # one row, as lines
            title, count, width = f"{title}, the same in all states", 1, max(width, 1)
    notes += _more(count, "states")
    return replace(layout(title, count, kept, width), notes=notes) if kept else Sheet("", [], [])


def _more(count: int, noun: str) -> list[str]:
    """Note on the rows that a table leaves out, if any."""
    noun = noun.removesuffix("s") if count == LIMIT + 1 else noun
    return [f"and {count - LIMIT} more {noun}; csv and show --json list all"] * (count > LIMIT)


def solved_speeds(data: Mapping[str, Any]) -> str:
    """Number of speeds that finite elements solved, in words; "" where they solved every speed."""
    if of.FITTED.path not in data:
        return ""
    c, fitted = data[of.SPEED.path], data[of.FITTED.path]
    count, all_ = len(np.unique(c[fitted == 0.0])), len(np.unique(c))
    if count == all_:
        return ""
    return f"finite elements: {count} of {all_} speeds solved, the others by a fit"


def loops_sheet(data: dict[str, Any], units: Units, width: int = 0) -> Sheet:
    """Table of the first friction loops: work, breakaway force and stiffness.

    Where friction varies along the contact there are no rows: the loops are those of the law alone.
    """
    if preferred(data, of.RESULTANT_RATIO):
        return Sheet("", [], [])
    states, loops = states_of_loops(data), data[runs.LOOP_OF_STATE.path]
    columns = _parameters_of(states, data, units)
    # A law that does not depend on the speed has one loop for all speeds.
    several = {*zip(loops[loops >= 0].tolist(), data[of.SPEED.path][loops >= 0].tolist())}
    if len(several) > len(states):
        columns = [c for c in columns if c.path != of.SPEED.path]
    columns += _occurring(_columns(data, units, (
        _Spec("work", runs.LOOP_WORK, 5, lambda values, _: values.sum(axis=1)),
        _Spec("work of the closed loop", runs.LOOP_CYCLE, 5),
        _Spec("breakaway force", runs.LOOP_BREAKAWAY, 5, lambda values, _: values.max(axis=1)),
        _Spec("stiffness", runs.LOOP_STIFFNESS, 5, _nth(0)),
    )))  # fmt: skip
    note = "all per depth, in all strokes"
    if any(column.head == "stiffness" for column in columns):
        note += "; stiffness: where the first stroke begins"
    sheet = layout("Friction loops", len(states), columns, width, "loop")
    notes = [f"{note}{_under_the_first_load(data, units)}", *_more(len(states), "loops")]
    return replace(sheet, notes=notes)


def _parameters_of(states: Any, data: Mapping[str, Any], units: Units) -> list[Column]:
    """Columns of the loads and laws of some states, those that differ."""
    return [
        c.of(states)
        for c in _parameter_columns(data, units)
        if c.name not in ("motion", "X_over_L", "f") and not c.constant
    ]


def states_of_loops(data: Mapping[str, Any]) -> NDArray[np.int64]:
    """The first state of each friction loop, (loops,)."""
    loops, first = np.unique(data[runs.LOOP_OF_STATE.path], return_index=True)
    return first[loops >= 0]  # states without a loop have the number -1


def states_of_sliders(data: dict[str, Any]) -> NDArray[np.int64]:
    """A state with the load and the law of each slider, (sliders,)."""
    apart = parameters(data)
    law = [
        data[path].tolist()
        for path in apart
        if path not in (of.SPEED.path, of.MOTION.path, of.POSITION.path)
    ]
    rows = [*zip(*law)]
    each = next((i for i, row in enumerate(rows) if row != rows[0]), 0)
    return each * np.arange(len(data[runs.OUTCOME.path]))


def _under_the_first_load(data: Mapping[str, Any], units: Units) -> str:
    """Words on the load of numbers that are known under the first alone; "" where there is one."""
    if of.LOAD.path not in data:
        return ""
    load = units.scale(of.LOAD.unit)
    return f"; under the first load, N = {load.text(load.factor * data[of.LOAD.path][0])}"


def sliders_sheet(data: dict[str, Any], units: Units, width: int = 0) -> Sheet:
    """Table of the motion of the slider for the first laws, with its stick-slip."""
    if runs.OUTCOME.path not in data:
        return Sheet("", [], [])
    columns = [c for c in _parameters_of(states_of_sliders(data), data, units) if c.path != of.SPEED.path]
    columns += _columns(data, units, (
        _Spec("motion", runs.OUTCOME),
        _Spec("period", runs.PERIOD, 6), _Spec("slip per cycle", runs.SLIP, 6),
        _Spec("peak velocity", runs.PEAK, 6), _Spec("least velocity", runs.LEAST, 6),
    ))  # fmt: skip
    return layout("Motion of the slider", len(data[runs.OUTCOME.path]), columns, width, "law")


def starts_sheet(data: dict[str, Any], units: Units, width: int = 0) -> Sheet:
    """Table of the first starts at the end of the motion, by finite elements if the archive has them."""
    title = "In time, at the end"
    method = next((name for name in (FEM, SIE) if over_time.V0[name].path in data), "")
    if not method:
        return Sheet(title, [], [])
    time = units.scale(over_time.TIMES.unit)
    end, when = float(data[over_time.TIMES.path][-1]), data[over_time.WITHIN[method].path][:, 1]
    ways = ["-+"[int(way > 0.0)] + "X" for way in data[over_time.DIRECTION.path][:, -1]]

    def rounded(t: float) -> str:
        return "" if isnan(t) else time.text(time.factor * t, 2)

    def within(t: float) -> str:  # extrapolated beyond the end
        if isnan(t):
            return "after the end"
        return time.text(time.factor * t, 3) if t <= end else f"~ {rounded(t)}"

    specs = (
        _Spec("c" if units.dimensionless else "speed", over_time.SPEED, 6),
        _Spec("σ_XY/σ_YY", over_time.RATIO, 5),
        *(
            _Spec(head, rows[method], 5, _nth(-1))
            for head, rows in {
                "v₀": over_time.V0, "centre": over_time.CENTRE, "K_I left": over_time.K_I_LEFT,
                "K_I right": over_time.K_I_RIGHT,
            }.items()
        ),
        _Spec("centre in steady motion", over_time.STEADY_CENTRE, 5),
    )  # fmt: skip
    numbers = _columns(data, units, specs, archived=True)
    columns = [
        Column("direction", ways, "none"),
        *(column for column in numbers if np.isfinite(column.values).any()),
        *_occurring(
            [Column("off steady motion", 100.0 * data[over_time.OFF[method].path], "%", digits=3)]
        ),
        Column("within 1 % from", [*map(within, when)], "none"),
    ]
    by_formula = data[over_time.APPROACH.path]
    if np.isfinite(by_formula).any():
        columns.append(Column("by formula", [*map(rounded, by_formula)], "none"))
    heads = {
        column.head for column in columns if column.unit == "none" or np.isfinite(column.values).any()
    }
    notes = [
        f"at t = {time.text(time.factor * end)}; centre: of the pressure, towards +X"
        + _under_the_first_load(data, units)
    ]
    if "off steady motion" in heads:
        notes.append(
            "off: largest relative difference of K_I, or of the centre over a, from steady motion under "
            "the last load"
        )
    notes.append(
        "within 1 %: of both; ~ by 1/t after the end; by formula: for late times, of uniform solids"
    )
    if "K_I left" in heads:
        notes.append("K_I: dimensionless, over N")
    return replace(layout(title, len(when), columns, width, "start"), notes=notes)
