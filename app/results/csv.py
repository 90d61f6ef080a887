"""Archives as comma-separated values: one tidy table, read and written some rows at a time."""

import csv
from collections.abc import Collection, Iterable, Iterator
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.hdf5 import archive as reader
from galinx.postprocess.quantities import Quantity, over_time, preferred, runs, states, table
from galinx.postprocess.quantities.quantity import ALONG, FRICTION_ALONE, INSIDE, INTERFACE, POINT, STATE
from galinx.postprocess.tables import parameters, state_columns, states_of_loops, states_of_sliders
from galinx.postprocess.units import Units
from galinx.solvers.contact import AT_INTERFACES, BELOW, ON_SURFACE

from ..errors import BadInput
from ..scene import read as scenes
from ..scene.scene import Scene

#: Dimensions of tables, outermost first, with the word of output.quantities that asks for them, and the
#: section that it needs.
TABLES: dict[str, tuple[tuple[str, ...], str, str]] = {
    "states": ((STATE,), "", ""),
    "surface": ((STATE, POINT), ON_SURFACE, ""),
    "interfaces": ((STATE, INTERFACE, ALONG), AT_INTERFACES, "[[layer]]"),
    "inside": ((STATE, INSIDE), BELOW, ""),
    "histories": ((runs.LOOP, runs.STEP), FRICTION_ALONE, ""),
    "time": ((over_time.START, over_time.INSTANT), over_time.TIME, "[time]"),
    "slider": ((runs.LAW, runs.TIME), runs.SLIDER, "[slider]"),
}
#: Names of numbers of rows, by dimension.
_NUMBERED = {
    STATE: "state", INTERFACE: "interface", runs.LOOP: "loop", over_time.START: "start", runs.LAW: "law",
}  # fmt: skip
#: Rows held at once.
_TOGETHER = 20_000

#: Head of a column, and its values, with an axis for each dimension of the table.
_Column = tuple[str, NDArray]


def usual(scene: Scene) -> str:
    """Name of the table of what a scene computes: motions in time, of sliders, or states."""
    return next(
        (name for name in (over_time.TIME, runs.SLIDER) if name in scene.output.quantities), "states"
    )


def pieces(
    path: Path, which: str = "states", dimensionless: bool = False, verified: bool = False
) -> Iterator[str]:
    """Text of a table, piece by piece, its heads with units first; NaN is an empty cell.

    Args:
        path: of an archive.
        which: of ``TABLES``: a row a state; a row for each point of each state, along the surface, along
            interfaces or inside; friction along strokes; motions in time; motions of sliders.
        dimensionless: stresses over N/(2a), positions over a and speeds over c_s, as archived.
        verified: this very process has verified the archive's digest before.

    Raises:
        UnreadableArchive: no archive, a damaged one, one that does not fit the schema, or of a newer one.
        BadInput: it holds no such table.
    """
    (over, word, section), quantities = TABLES[which], table()
    with reader.opened(path, verified) as archive:
        scene = scenes.parse(archive.data[runs.SCENE.path], "the scene of the archive")
        units = Units(scene.body, archive.data, dimensionless)
        rows = _rows(archive, over)
        if word and not any(row.over == over for row in rows):
            raise BadInput(
                f"{path} holds nothing for --{which}; a scene asks for it by "
                f'output.quantities = ["{word}"]' + f" and {section}" * bool(section)
            )
        lengths = {STATE: len(archive.data[states.FRICTION.path])}
        for name, values in archive.data.items():
            lengths = dict(zip(quantities[name].over, np.shape(values))) | lengths
        sizes = [lengths[name] for name in over]
        large = [row.path for row in rows if STATE in row.over] if word else []
        together = max(1, _TOGETHER // max(1, int(np.prod(sizes[1:]))))
        for start in range(0, sizes[0], together):
            block = slice(start, min(start + together, sizes[0]))
            shape = block.stop - block.start, *sizes[1:]
            rows_, *others = np.indices(shape, sparse=True)
            columns: list[_Column] = [  # numbers of interfaces are from 1, others from 0
                (_NUMBERED[name], at + (name == INTERFACE))
                for name, at in zip(over, (rows_ + start, *others)) if name in _NUMBERED
            ]  # fmt: skip
            if word:
                data = {**archive.data, **(archive.rows(block, large) if large else {})}
                columns += _parameters(archive.data, units, block, len(over)) if large else []
                columns += _over(data, rows, units, block, over)
                if over[0] == runs.LOOP:
                    strokes = np.array([leg.name for leg in scene.legs])
                    columns.insert(1, ("stroke", np.repeat(strokes, sizes[1] // len(strokes))[None]))
                    columns += _of_loops(archive.data, units, block)
                if over[0] == runs.LAW:
                    own = states_of_sliders(archive.data)[block]
                    without = states.SPEED, states.MOTION, states.POSITION
                    columns += _parameters(archive.data, units, own, len(over), without)
            else:
                columns += [(head, values[block]) for head, values in _of_states(archive.data, units)]
            if start == 0:
                yield _text([[head for head, _ in columns]])
            whole = [np.broadcast_to(values, shape).flat for _, values in columns]
            for first in range(0, int(np.prod(shape)), _TOGETHER):
                part = slice(first, first + _TOGETHER)
                yield _text(zip(*(_cells(values[part], dimensionless) for values in whole)))


def _parameters(
    data: dict[str, Any], units: Units, block: Any, axes: int, without: Collection[Quantity] = ()
) -> list[_Column]:
    """Columns that tell some states apart, and their load."""
    columns = [
        (scaled.head, scaled.of(data[path]))
        for path, row in parameters(data).items()
        if path != states.LOAD.path and row not in without and (scaled := units(row))
    ]
    if states.LOAD not in without:
        load = units.scale(states.LOAD.unit)
        columns.append(
            (f"load [{load.unit}]", load.of(np.full(len(data[states.FRICTION.path]), units.load)))
        )
    return [(head, np.asarray(v)[block].reshape(-1, *(1,) * (axes - 1))) for head, v in columns]


def _of_loops(data: dict[str, Any], units: Units, block: slice) -> list[_Column]:
    """Columns of what tells friction loops apart; a loop may be that of several speeds and loads."""
    loop, own = data[runs.LOOP_OF_STATE.path], states_of_loops(data)[block]

    def differs(row: Quantity) -> bool:
        values = data.get(row.path, np.zeros(len(loop)))
        return len(np.unique(loop)) < len({*zip(loop.tolist(), values.tolist())})

    columns = _parameters(
        data, units, own, 2, (states.MOTION, states.POSITION, *[states.SPEED] * differs(states.SPEED))
    )
    if differs(states.LOAD):  # energies are those under the first
        head, first = columns[-1]
        columns[-1] = f"cycle_dissipated_{head}", first
    return columns


def _of_states(data: dict[str, Any], units: Units) -> list[_Column]:
    """Columns of :func:`galinx.postprocess.tables.state_columns`, then those of all other quantities.

    Quantities of a state that have several numbers, as those of interfaces, have a column for each.
    """
    first = state_columns(data, units)
    columns = [
        (f"{c.name} [{c.unit}]" if c.unit != "none" else c.name, np.asarray(c.values)) for c in first
    ]
    taken = {column.path for column in first}
    if preferred(data, states.RESULTANT_RATIO):
        # These stand for a friction that varies along the contact.
        taken |= {states.FRICTION.path, states.RATIO.path, states.INNER_STATE.path}
    for path, row in table().items():
        if path not in data or path.split("/")[0] not in ("states", "interfaces") or path in taken:
            continue
        scaled = units(row)
        if scaled is None or row.over[:1] != (STATE,) or len(row.over) > 2:
            continue
        values = scaled.of(data[path])
        if len(row.over) == 1:
            columns.append((scaled.head, values))
        else:
            unit = scaled.head.removeprefix(scaled.name)
            columns += [(f"{scaled.name}_{i + 1}{unit}", of) for i, of in enumerate(values.T)]
    return columns


def _rows(archive: reader.Archive, over: tuple[str, ...]) -> list[Quantity]:
    """Quantities of a table, positions first: those along its dimensions, but of one value a state."""
    rows = [
        row
        for path, row in table().items()
        if path in archive.names and row.over and set(row.over) <= set(over)
        if over[0] != STATE or row.over not in ((STATE,), over[:2]) or row.over == over
    ]
    return sorted(rows, key=lambda row: (len(row.over), over[0] in row.over))


def _over(
    data: dict[str, Any], rows: Iterable[Quantity], units: Units, block: slice, over: tuple[str, ...]
) -> list[_Column]:
    """Columns of quantities along a table's dimensions, in a block of the outermost one."""
    columns = []
    for row in rows:
        if not (scaled := units(row)):
            continue
        held = np.asarray(data[row.path])
        if over[0] in row.over and STATE not in row.over:
            held = held[block]
        sizes = dict(zip(row.over, held.shape))
        held = held.reshape([sizes.get(name, 1) for name in over])
        if held.dtype.kind in "fiu":
            if np.ndim(scaled.factor) and len(held) == 1:
                held = np.broadcast_to(held, (block.stop - block.start, *held.shape[1:]))
            held = scaled.of(held, block)
        columns.append((scaled.head, held))
    return columns


def _cells(values: NDArray, exact: bool) -> list[Any]:
    """Cells of a column, empty for NaN; text stays.

    Numbers in other units than the archive's have 15 digits: a speed of 500 m/s is 500 again.
    """
    cells = values.tolist()
    if values.dtype.kind != "f" or exact:
        return ["" if value != value else value for value in cells]
    return ["" if value != value else f"{value:.15g}" for value in cells]


def _text(lines: Iterable[Iterable[Any]]) -> str:
    text = StringIO()
    csv.writer(text, lineterminator="\n").writerows(lines)  # which gives floats all their digits
    return text.getvalue()
