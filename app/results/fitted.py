"""Measured friction, and the law that is fitted to it.

Friction is read from a table of comma-separated values with units in its head. A fitted law is written as
a section of a scene, and drawn beside the measured friction.
"""

import csv
import json
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import files
from galinx.solvers.friction import LAWS
from galinx.solvers.friction.fit import FittedLaw, fit, moves
from galinx.solvers.parameters import parameters

from ..errors import BadInput, excerpt, nearest, short
from ..figures.friction import fitted_figure
from ..scene.units import to_si
from ..scene.values import Choice, Number, Rows

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
        timed: True where time was measured.
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
    columns = dict(zip(factors, numbers.T))
    clock = columns.get("time", columns.get("slip", np.zeros(0)))
    if len(clock) < 3 or (np.diff(clock) <= 0.0).any():
        name = "time" if "time" in columns else "slip"
        wrong = int(np.argmax(np.diff(clock) <= 0.0)) + 1 if len(clock) >= 3 else len(clock) - 1
        line = rows[min(wrong + 1, len(rows) - 1)][0]
        raise BadInput(f"{path}, line {line}: expected three or more rows in which the {name} grows")
    if "slip" in columns:
        return _from_rest(columns["slip"], columns["f"])
    if not np.ptp(columns["position"]):
        raise BadInput(f"{path}: found one position in all rows, expected a motion")
    return Measured(columns["time"], columns["position"], columns["f"], True)


def _from_rest(slip: NDArray, f: NDArray) -> Measured:
    """Friction over a slip that is counted from rest, whether the table has a row of rest or not."""
    if slip[0] < 0.0:
        raise BadInput(f"found the slip {slip[0]:g} m, expected slips from 0 on")
    if slip[0] > 0.0:
        slip, f = np.append(0.0, slip), np.append(np.nan, f)
    return Measured(slip, slip, f, False)


def _columns(path: Path, heads: list[str]) -> dict[str, tuple[int, float]]:
    """Number of the column, and its unit in SI, by name."""
    columns: dict[str, tuple[int, float]] = {}
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
        columns[name] = n, factor
    for table in _TABLES:
        if set(table) <= columns.keys():
            return {name: columns[name] for name in table}
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


def fitted(
    name: str, data: Path, fixed: list[str], started: list[str], speed: str, rows: int
) -> tuple[Measured, FittedLaw]:
    """Measured friction of a table, and a law fitted to it.

    Args:
        name: of the law.
        data: the table.
        fixed, started: ``KEY=VALUE`` of parameters that are held, and of starting values.
        speed: of a table of slips, with its unit.
        rows: of a law's table.

    Raises:
        BadInput: there is no such law, the table is none, or the law cannot be fitted to it.
    """
    if name not in LAWS:
        raise BadInput(f"friction law {short(name)!r}: there is none{nearest(name, LAWS)}")
    kind, measured = LAWS[name], read(data)
    if measured.timed and speed:
        raise BadInput("--speed: found one, but the table tells the time; leave it away")
    if not measured.timed and kind.depends_on_speed and not speed:
        raise BadInput(f"{kind.about} depends on the speed: give --speed, as in --speed '1 mm/s'")
    try:
        if speed:
            V = Number("m/s")(speed)
            if V <= 0.0:
                raise ValueError(f"--speed: found {V:g} m/s, expected > 0")
            measured = replace(measured, t=measured.t / V)
        way = moves(measured.t, measured.X, kind.depends_on_speed)
        result = fit(kind, way, measured.f, _values(name, fixed), _values(name, started), rows)
    except ValueError as error:
        raise BadInput(f"{data}, {name}: {error}") from None
    return measured, result


def _values(name: str, words: list[str]) -> dict[str, Any]:
    """Parameters by key from ``KEY=VALUE``.

    Raises:
        ValueError: one of them is none.
    """
    declared = parameters(LAWS[name])
    values: dict[str, Any] = {}
    for word in words:
        key, equals, text = word.partition("=")
        key = key.strip()
        if not equals or key not in declared:
            raise ValueError(f"found {short(word)!r}, expected KEY=VALUE with {', '.join(declared)}")
        parameter = declared[key]
        try:
            if parameter.options:
                values[key] = Choice(parameter.options)(text.strip())
            elif parameter.columns:
                values[key] = Rows(parameter.columns)(json.loads(text))
            else:
                values[key] = to_si(_number(text), parameter.unit)
                if values[key] not in parameter.range:
                    raise ValueError(f"found {values[key]:g}, expected {parameter.range}")
        except ValueError as error:
            raise ValueError(f"{key}: {error}") from None
    return values


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text.strip()


def section(name: str, data: Path, measured: Measured, result: FittedLaw) -> str:
    """Section of a scene with the fitted law, and the deviation of each number as a comment."""
    declared, residual = parameters(type(result.law)), result.f - measured.f
    rms = float(np.sqrt(np.nanmean(residual**2)))
    errors = dict(zip(result.names, result.deviations.tolist()))
    lines = [
        f"# Fitted by galinx: {type(result.law).about} to {np.isfinite(residual).sum()} samples",
        f"# of {data.name}; root mean square of the residuals of f: {rms:.3g} (dimensionless);",
        "# ± is one standard deviation",
        "[friction]",
        f"model = {json.dumps(name)}",
    ]
    for key, value in result.values.items():
        unit = declared[key].unit
        text = f"{value:.9g} {unit}" if unit else value
        if declared[key].columns:
            text = [[float(f"{number:.9g}") for number in row] for row in value]
        elif not unit and not isinstance(value, str):
            text = float(f"{value:.9g}")
        said = _deviation(key, errors, unit or "dimensionless" * (not declared[key].options))
        lines.append(f"{key} = {json.dumps(text)}{said}")
    return "\n".join(lines) + "\n"


def _deviation(key: str, errors: dict[str, float], unit: str) -> str:
    """Comment on a number: its unit, and its standard deviation or that it was given."""
    mine = {name: value for name, value in errors.items() if name.partition("[")[0] == key}
    if not mine:
        return f"  # {unit + ', ' if unit else ''}given"
    texts = ", ".join(
        "not determined" if np.isnan(value) else f"± {value:.2g}" for value in mine.values()
    )
    return f"  # {unit if key in mine else 'in SI'}, {texts}"


def figure(measured: Measured, result: FittedLaw) -> Any:
    """Figure of measured and fitted friction, and their difference."""
    return fitted_figure(measured.t, measured.X, measured.f, result.f, measured.timed)
