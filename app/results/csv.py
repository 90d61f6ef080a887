"""Archives as comma-separated values: one tidy table, read and written some rows at a time."""

import csv
from collections.abc import Iterable, Iterator
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from galinx.postprocess.hdf5 import archive as reader
from galinx.postprocess.quantities import Quantity, of_states, runs, table
from galinx.postprocess.quantities.quantity import INSIDE, POINT, STATE
from galinx.postprocess.quantities.states import LOAD, SPEED
from galinx.postprocess.tables import parameters
from galinx.postprocess.units import Scaled, Units
from galinx.solvers.contact import BELOW, ON_SURFACE

from ..errors import BadInput
from ..scene import read as scenes

#: Dimension of the values of states, and the word of output.quantities that asks for them, by table.
TABLES = {"states": ("", ""), "surface": (POINT, ON_SURFACE), "inside": (INSIDE, BELOW)}

#: Rows held at once.
_TOGETHER = 20_000


def pieces(path: Path, which: str = "states", dimensionless: bool = False) -> Iterator[str]:
    """Text of a table, piece by piece, its heads with units first; NaN is an empty cell.

    Args:
        path: of an archive.
        which: of ``TABLES``: a row a state, or a row for each point of each state.
        dimensionless: stresses over N/(2a), positions over a and speeds over c_s, as archived.

    Raises:
        UnreadableArchive: no archive, a damaged one, one that does not fit the schema, or of a newer one.
        BadInput: it holds no such table.
    """
    where, word = TABLES[which]
    with reader.opened(path) as archive:
        rows = _rows(archive, where, not dimensionless)
        if where and not any(where in row.over for row in rows):
            raise BadInput(
                f"{path} holds no stresses for --{which}; a scene asks for them by "
                f'output.quantities = ["{word}"]'
            )
        rows, columns = _columns(archive, rows, dimensionless)
        yield _text([["state", *(column.head for column in columns)]])
        for numbers, data in _blocks(archive, rows, where):
            cells = (_cells(column.of(data[row.path], numbers)) for row, column in zip(rows, columns))
            yield _text(zip(numbers, *cells))


def _rows(archive: reader.Archive, where: str, load: bool) -> list[Quantity]:
    """Quantities of a table: parameters that distinguish states, positions, all with one value each."""
    first = parameters(archive.data)
    if load:
        first[LOAD.path] = LOAD
    there = [row for path, row in table().items() if path in archive.names and of_states(path)]
    shapes = [(where,), (STATE, where)] if where else [(STATE,)]
    others = (row for shape in shapes for row in there if row.over == shape and row.path not in first)
    return [*first.values(), *others]


def _columns(
    archive: reader.Archive, rows: list[Quantity], dimensionless: bool
) -> tuple[list[Quantity], list[Scaled]]:
    """Quantities that have a column in the units of the table, and their columns."""
    scene = scenes.parse(archive.data[runs.SCENE.path], "the scene of the archive")
    units = Units(scene.body, archive.data, dimensionless)
    scaled_rows = ((row, units(row)) for row in rows)
    kept = [(row, column) for row, column in scaled_rows if column]
    return [row for row, _ in kept], [column for _, column in kept]


def _blocks(
    archive: reader.Archive, rows: list[Quantity], where: str
) -> Iterator[tuple[list[int], dict[str, Any]]]:
    """Numbers of states, and columns by path, for blocks of rows of the table."""
    states = len(archive.data[SPEED.path])
    points = next((len(archive.data[row.path]) for row in rows if row.over == (where,)), 1)
    together = max(1, _TOGETHER // max(1, points))
    for start in range(0, states, together):
        block = slice(start, min(start + together, states))
        data = archive.rows(block, [row.path for row in rows if row.path in archive.names])
        data.setdefault(LOAD.path, np.full(block.stop - block.start, archive.attributes["load"]))
        for first in range(0, points, _TOGETHER):
            at = slice(first, min(first + _TOGETHER, points))
            shape = block.stop - block.start, at.stop - at.start
            columns = {
                row.path: data[row.path][..., at] if where in row.over else data[row.path][:, None]
                for row in rows
            }
            numbers = np.repeat(np.arange(block.start, block.stop), shape[1]).tolist()
            yield (
                numbers,
                {path: np.broadcast_to(values, shape).ravel() for path, values in columns.items()},
            )


def _cells(values: Any) -> list[Any]:
    """Cells of a column, empty for NaN; text stays."""
    return ["" if value != value else value for value in values.tolist()]


def _text(lines: Iterable[Iterable[Any]]) -> str:
    text = StringIO()
    csv.writer(text, lineterminator="\n").writerows(lines)  # which gives floats all their digits
    return text.getvalue()
