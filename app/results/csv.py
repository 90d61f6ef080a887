"""Archives as comma-separated values: one tidy table, read and written some rows at a time."""

import csv
from collections.abc import Iterable, Iterator
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.hdf5 import archive as reader
from galinx.postprocess.quantities import Quantity, over_time, runs, table
from galinx.postprocess.quantities.quantity import ALONG, FRICTION_ALONE, INSIDE, INTERFACE, POINT, STATE
from galinx.postprocess.quantities.states import FRICTION, LOAD
from galinx.postprocess.tables import parameters, state_columns
from galinx.postprocess.units import Scaled, Units
from galinx.solvers.contact import AT_INTERFACES, BELOW, ON_SURFACE

from ..errors import BadInput
from ..scene import read as scenes

#: Dimensions of tables, outermost first, with the word of output.quantities that asks for them.
TABLES: dict[str, tuple[tuple[str, ...], str]] = {
    "states": ((STATE,), ""),
    "surface": ((STATE, POINT), ON_SURFACE),
    "interfaces": ((STATE, INTERFACE, ALONG), AT_INTERFACES),
    "inside": ((STATE, INSIDE), BELOW),
    "histories": ((runs.LOOP, runs.STEP), FRICTION_ALONE),
    "time": ((over_time.START, over_time.INSTANT), over_time.TIME),
    "slider": ((runs.LAW, runs.TIME), runs.SLIDER),
}
#: Names of numbers of rows, by dimension.
_NUMBERED = {
    STATE: "state", INTERFACE: "interface", runs.LOOP: "loop", over_time.START: "start", runs.LAW: "law",
}  # fmt: skip

#: Rows held at once.
_TOGETHER = 20_000


def pieces(path: Path, which: str = "states", dimensionless: bool = False) -> Iterator[str]:
    """Text of a table, piece by piece, its heads with units first; NaN is an empty cell.

    Args:
        path: of an archive.
        which: of ``TABLES``: a row a state; a row for each point of each state, along the surface, along
            interfaces or inside; friction along strokes; motions in time; motions of sliders.
        dimensionless: stresses over N/(2a), positions over a and speeds over c_s, as archived.

    Raises:
        UnreadableArchive: no archive, a damaged one, one that does not fit the schema, or of a newer one.
        BadInput: it holds no such table.
    """
    over, word = TABLES[which]
    with reader.opened(path) as archive:
        scene = scenes.parse(archive.data[runs.SCENE.path], "the scene of the archive")
        units = Units(scene.body, archive.data, dimensionless)
        if which == "states":
            yield from _states(archive, units)
            return
        rows = _rows(archive, over)
        if not any(row.over == over for row in rows):
            raise BadInput(
                f"{path} holds nothing for --{which}; a scene asks for it by "
                f'output.quantities = ["{word}"]'
            )
        columns = [(row, scaled) for row in rows if (scaled := units(row))]
        if over[0] == STATE:
            of_states_ = _parameters(archive.data, units)
            outer = [(column.head, column.values) for column in of_states_]
        else:
            outer = []
        numbered = [_NUMBERED[name] for name in over if name in _NUMBERED]
        yield _text([[*numbered, *(head for head, _ in outer), *(scaled.head for _, scaled in columns)]])
        yield from _blocks(archive, over, [values for _, values in outer], columns, dimensionless)


class _Of(NamedTuple):
    """Column with one value a state."""

    head: str
    values: Any


def _parameters(data: dict[str, Any], units: Units) -> list[_Of]:
    """Columns that tell states apart, and their load."""
    columns = [
        _Of(scaled.head, scaled.of(data[path]))
        for path, row in parameters(data).items()
        if path != LOAD.path and (scaled := units(row))
    ]
    load = units.scale(LOAD.unit)
    loads = load.of(np.full(len(data[FRICTION.path]), units.load))
    return [*columns, _Of(f"load [{load.unit}]", loads)]


def _states(archive: reader.Archive, units: Units) -> Iterator[str]:
    """Table of states: the columns of :func:`galinx.postprocess.tables.state_columns`, then all others.

    Quantities of a state that have several numbers, as those of interfaces, have a column for each.
    """
    data = archive.data
    columns = [_Of(f"{c.name} [{c.unit}]" if c.unit != "none" else c.name, c.values) for c in (
        state_columns(data, units))]  # fmt: skip
    taken = {column.path for column in state_columns(data, units)}
    for path, row in table().items():
        if path not in data or path.split("/")[0] not in ("states", "interfaces") or path in taken:
            continue
        scaled = units(row)
        if scaled is None or row.over[:1] != (STATE,) or len(row.over) > 2:
            continue
        values = scaled.of(data[path])
        if len(row.over) == 1:
            columns.append(_Of(scaled.head, values))
        else:
            unit = scaled.head.removeprefix(scaled.name)
            columns += [_Of(f"{scaled.name}_{i + 1}{unit}", of) for i, of in enumerate(values.T)]
    yield _text([["state", *(column.head for column in columns)]])
    count = len(data[FRICTION.path])
    for start in range(0, count, _TOGETHER):
        block = slice(start, min(start + _TOGETHER, count))
        cells = [_cells(np.asarray(column.values)[block], units.dimensionless) for column in columns]
        yield _text(zip(range(block.start, block.stop), *cells))


def _rows(archive: reader.Archive, over: tuple[str, ...]) -> list[Quantity]:
    """Quantities of a table, positions first: those along its dimensions, but of one value a state."""
    there = [row for path, row in table().items() if path in archive.names]
    rows = [row for row in there if row.over and set(row.over) <= set(over)]
    rows = [
        row
        for row in rows
        if over[0] != STATE or row.over not in ((STATE,), over[:2]) or row.over == over
    ]
    return sorted(rows, key=lambda row: (len(row.over), over[0] in row.over))


def _blocks(
    archive: reader.Archive, over: tuple[str, ...], outer: list[Any],
    columns: list[tuple[Quantity, Scaled]],
    exact: bool,
) -> Iterator[str]:  # fmt: skip
    """Text of the rows of a table, some at a time."""
    sizes = {name: _size(archive, name) for name in over}
    inside = int(np.prod([sizes[name] for name in over[1:]]))
    together = max(1, _TOGETHER // max(1, inside))
    large = [row.path for row, _ in columns if STATE in row.over]
    for start in range(0, sizes[over[0]], together):
        block = slice(start, min(start + together, sizes[over[0]]))
        data = {**archive.data, **(archive.rows(block, large) if large else {})}
        shape = (block.stop - block.start, *(sizes[name] for name in over[1:]))
        whole = [
            np.arange(size).reshape(*(-1 if n == axis else 1 for n in range(len(over))))
            + (block.start if axis == 0 else 0)
            for axis, (name, size) in enumerate(zip(over, shape))
            if name in _NUMBERED
        ]
        whole += [np.asarray(values)[block].reshape(-1, *(1,) * (len(over) - 1)) for values in outer]
        whole += [_scaled(row, scaled, data, over, block) for row, scaled in columns]
        for first in range(0, int(np.prod(shape)), _TOGETHER):
            at = np.unravel_index(np.arange(first, min(first + _TOGETHER, int(np.prod(shape)))), shape)
            yield _text(zip(*(_cells(np.broadcast_to(values, shape)[at], exact) for values in whole)))


def _scaled(
    row: Quantity, scaled: Scaled, data: dict[str, Any], over: tuple[str, ...], block: slice
) -> NDArray:
    """Values of a quantity in its units, an axis for each dimension of the table."""
    values = np.asarray(data[row.path])
    if over[0] in row.over and STATE not in row.over:
        values = values[block]
    shape, sizes = [], dict(zip(row.over, values.shape))
    for name in over:
        shape.append(sizes.get(name, 1))
    values = values.reshape(shape)
    if values.dtype.kind not in "fiu":
        return values
    if np.ndim(scaled.factor) and len(values) == 1:
        values = np.broadcast_to(values, (block.stop - block.start, *values.shape[1:]))
    return scaled.of(values, block)


def _size(archive: reader.Archive, name: str) -> int:
    """Length of a dimension of an archive's datasets."""
    if name == STATE:
        return len(archive.data[FRICTION.path])
    rows = table()
    for path, values in archive.data.items():
        if path in rows and name in rows[path].over:
            return int(np.shape(values)[rows[path].over.index(name)])
    raise AssertionError(name)


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
