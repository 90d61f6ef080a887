"""Measured friction, read from tables."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.friction.fit import Measured

from ..errors import BadInput, excerpt
from ..text_table import TextTable, read_table

#: Names of columns by what they are; a friction with a unit of force is a force.
_NAMES = {
    "slip": ("slip",),
    "time": ("time", "t"),
    "position": ("position", "x", "displacement"),
    "friction": ("f", "friction", "friction_coefficient", "mu", "µ", "μ"),
    "force": ("force", "friction_force", "tangential_force"),
    "load": ("load", "normal_load", "normal_force", "n"),
}
_FORM = '"slip [mm],f", "time [s],position [mm],f", or with "force [N],load [N]" for f'
#: Units of forces: whole ones, and over a length.
_FORCES = ("N", "N/m")


@dataclass(frozen=True)
class Table:
    """Friction of a table.

    Attributes:
        name: of the file.
        measured: time, position and friction coefficient; the time is that of a slip at 1 m/s where slip
            was measured alone.
        timed: True where time was measured.
        notes: what a reader should know of how it was read.
    """

    name: str
    measured: Measured
    timed: bool
    notes: tuple[str, ...] = ()

    def at_speed(self, V: float) -> "Table":
        """Table of a slip at a speed [m/s]."""
        return replace(self, measured=replace(self.measured, t=self.measured.t / V))


def read(path: Path) -> Table:
    """Read a table of measured friction.

    Args:
        path: a file whose first line names the columns, units in brackets: slip, or time and position;
            and f, or friction force and normal load; in any order, with any others beside them.

    Raises:
        BadInput: it is none; the message names the line.
    """
    table = read_table(path, _FORM)
    columns = {
        kind: next((n for n, name in enumerate(table.names) if _is(table, n, kind, name)), None)
        for kind in _NAMES
    }
    slip, time, position = columns["slip"], columns["time"], columns["position"]
    if (slip is None and None in (time, position)) or not (
        columns["friction"] is not None or columns["force"] is not None
    ):
        raise BadInput(f"{path}, line 1: found the columns {excerpt(table.names)}, expected {_FORM}")
    f, notes = _friction(table, columns["friction"], columns["force"], columns["load"]), []

    def numbers(column: int, unit: str) -> NDArray[np.float64]:
        values = table.numbers(column, unit)
        if not table.units[column] and len(values):
            notes.append(
                f"{path}: {table.names[column]} has no unit in its head and is read in {unit}, "
                f"{values.min():g} to {values.max():g} {unit}; else write it in brackets, as [mm] or [ms]"
            )
        return values

    if time is None or position is None:
        assert slip is not None
        clock, X = numbers(slip, "m"), None
    else:
        clock, X = numbers(time, "s"), numbers(position, "m")
    back = np.flatnonzero(np.diff(clock) <= 0.0)
    if len(clock) < 3 or len(back):
        row = int(back[0]) + 1 if len(clock) >= 3 else len(clock) - 1
        line, name = (table.line(row) if len(clock) else 1), "slip" if X is None else "time"
        raise BadInput(f"{path}, line {line}: expected three or more rows in which the {name} grows")
    if X is None:
        return Table(path.name, _from_rest(clock, f), False, tuple(notes))
    if not np.ptp(X):
        raise BadInput(f"{path}: found one position in all rows, expected a motion")
    return Table(path.name, Measured(clock, X, f), True, tuple(notes))


def _is(table: TextTable, column: int, kind: str, name: str) -> bool:
    """True if a column of that name and unit is of a kind."""
    if kind in ("friction", "force") and name in _NAMES["friction"]:
        return (kind == "force") == _is_force(table, column)
    return name in _NAMES[kind] and (name != "n" or _is_force(table, column))


def _is_force(table: TextTable, column: int) -> bool:
    return _unit_of_force(table, column) is not None


def _unit_of_force(table: TextTable, column: int) -> str | None:
    """SI unit of a column of forces; None for anything else."""
    for unit in _FORCES if table.units[column] not in ("", "1", "-") else ():
        try:
            table.factor(column, unit)
        except BadInput:
            continue
        return unit
    return None


def _friction(
    table: TextTable, friction: int | None, force: int | None, load: int | None
) -> NDArray[np.float64]:
    """Friction coefficient of a table, or friction force over the size of the normal load."""
    if friction is not None:
        return table.numbers(friction, "")
    assert force is not None
    if load is None:
        raise BadInput(f"{table.path}, line 1: found a friction force without a load, expected {_FORM}")
    units = [_unit_of_force(table, column) for column in (force, load)]
    if None in units or units[0] != units[1]:
        found = ", ".join(f"{table.names[n]} [{table.units[n]}]" for n in (force, load))
        raise BadInput(f"{table.path}, line 1: found {found}, expected both in N, or both in N/m")
    N = np.abs(table.numbers(load, units[1] or ""))
    if not N.all():
        raise BadInput(f"{table.path}, line {table.line(int(np.argmin(N)))}: found no load, expected one")
    return table.numbers(force, units[0] or "") / N


def _from_rest(slip: NDArray, f: NDArray) -> Measured:
    """Friction over a slip that is counted from rest, whether the table has a row of rest or not."""
    if slip[0] < 0.0:
        raise BadInput(f"found the slip {slip[0]:g} m, expected slips from 0 on")
    if slip[0] > 0.0:
        slip, f = np.append(0.0, slip), np.append(np.nan, f)
    return Measured(slip, slip, f)
