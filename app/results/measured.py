"""Measured friction: a table of comma-separated values, units in its head."""

import csv
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from galinx import files
from galinx.app.errors import BadInput
from galinx.app.scene.excerpt import excerpt
from galinx.app.scene.units import to_si

#: Bytes of a table.
_LARGEST = 100 * 10**6
#: A column's head: its name, and its unit in brackets.
_HEAD = re.compile(r"\s*([^\s\[\]()]+)\s*(?:[\[(]\s*([^\])]*)\s*[\])])?\s*")
#: SI units of the columns, by name, and the two kinds of tables.
_UNITS = {"slip": "m", "time": "s", "position": "m", "f": ""}
_TABLES = (("slip", "f"), ("time", "position", "f"))
_FORM = '"slip [m],f" or "time [s],position [m],f"'


@dataclass(frozen=True)
class Measured:
    """Friction as it was measured, (samples,) each.

    Attributes:
        t: time [s]; that of a slip at 1 m/s where slip was measured alone.
        X: position [m].
        f: friction coefficient.
        timed: was time measured?
    """

    t: NDArray[np.float64]
    X: NDArray[np.float64]
    f: NDArray[np.float64]
    timed: bool


def read(path: Path) -> Measured:
    """Read a table of measured friction.

    Args:
        path: a file whose first line names the columns, ``slip`` and ``f``, or ``time``, ``position`` and
            ``f``, in any order and with any others beside them; a unit stands in brackets.

    Raises:
        BadInput: it is none; the message names the line.
    """
    try:
        text = files.read(path, _LARGEST).decode("utf-8-sig")
    except OSError as error:
        raise BadInput(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise BadInput(f"{path} is not UTF-8 (byte {error.start}); save it as UTF-8") from None
    rows = [
        (line, row) for line, row in enumerate(csv.reader(text.splitlines()), 1) if row and any(row)
    ]  # fmt: skip
    if not rows:
        raise BadInput(f"{path} is empty, expected a first line as {_FORM}")
    factors = _columns(path, rows[0][1])
    numbers = np.array([_row(path, line, row, factors) for line, row in rows[1:]]).reshape(
        -1, len(factors)
    )
    found = dict(zip(factors, numbers.T))
    clock = found.get("time", found.get("slip", np.zeros(0)))
    if len(clock) < 3 or (np.diff(clock) <= 0.0).any():
        name = "time" if "time" in found else "slip"
        wrong = int(np.argmax(np.diff(clock) <= 0.0)) + 1 if len(clock) >= 3 else len(clock) - 1
        line = rows[min(wrong + 1, len(rows) - 1)][0]
        raise BadInput(f"{path}, line {line}: expected three or more rows in which the {name} grows")
    if "slip" in found:
        return _from_rest(found["slip"], found["f"])
    if not np.ptp(found["position"]):
        raise BadInput(f"{path}: found one position in all rows, expected a motion")
    return Measured(found["time"], found["position"], found["f"], True)


def _from_rest(slip: NDArray, f: NDArray) -> Measured:
    """Slip is counted from rest, whether a row is there or not."""
    if slip[0] < 0.0:
        raise BadInput(f"found the slip {slip[0]:g} m, expected slips from 0 on")
    if slip[0] > 0.0:
        slip, f = np.append(0.0, slip), np.append(np.nan, f)
    return Measured(slip, slip, f, False)


def _columns(path: Path, heads: list[str]) -> dict[str, tuple[int, float]]:
    """Number of the column, and its unit in SI, by name."""
    found: dict[str, tuple[int, float]] = {}
    for n, head in enumerate(heads):
        match = _HEAD.fullmatch(head)
        name = match[1].lower() if match else ""
        if match is None or name not in _UNITS:
            continue
        unit = (match[2] or "").strip()
        try:
            factor = 1.0 if unit in ("", "1") else to_si(f"1 {unit}", _UNITS[name])
        except ValueError as error:
            raise BadInput(f"{path}, line 1, {name}: {error}") from None
        found[name] = n, factor
    for table in _TABLES:
        if set(table) <= found.keys():
            return {name: found[name] for name in table}
    raise BadInput(f"{path}, line 1: found the columns {excerpt(heads)}, expected {_FORM}")


def _row(path: Path, line: int, row: list[str], factors: dict[str, tuple[int, float]]) -> list[float]:
    numbers = []
    for name, (n, factor) in factors.items():
        cell = row[n] if n < len(row) else ""
        try:
            number = float(cell)
        except ValueError:
            number = np.nan
        if not np.isfinite(number):
            raise BadInput(
                f"{path}, line {line}, {name}: found {excerpt(cell)}, expected a finite number"
            )
        numbers.append(factor * number)
    return numbers
