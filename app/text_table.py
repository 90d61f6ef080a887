"""Tables of numbers in text files, as measuring devices and spreadsheets write them.

The first line names the columns, units in brackets. Tabs, semicolons or commas separate columns; numbers
have a decimal point, or where commas do not separate columns a decimal comma.
"""

import csv
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from galinx import files

from .errors import BadInput, excerpt, meant, text_of
from .scene.units import to_si

#: Bytes of a table.
_LARGEST = 100 * 10**6
#: A column's head: its name, and its unit in brackets.
_HEAD = re.compile(r"\s*([^\[\]()]*?)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")
#: Names of columns by what they are, without case.
_NAMES = {
    "slip": ("slip",),
    "time": ("time", "t"),
    "position": ("position", "x", "displacement"),
    "friction": (
        "f", "friction", "friction_coefficient", "coefficient_of_friction", "cof", "mu", "µ", "μ",
    ),
    "force": ("force", "friction_force", "tangential_force"),
    "load": ("load", "normal_load", "normal_force", "n"),
    "pressure": ("pressure", "p"),
    "sigma_XX": ("sigma_xx",),
}  # fmt: skip
#: What spreadsheets write before the head to name the separator.
_SEPARATOR = re.compile(r"sep=.?", re.IGNORECASE)
#: Numbers with a decimal comma, and with a decimal point.
_COMMA = re.compile(r"\s*[-+]?[0-9]*,[0-9]*(?:[eE][-+]?[0-9]+)?\s*")
_POINT = re.compile(r"\s*[-+]?[0-9]*\.[0-9]*(?:[eE][-+]?[0-9]+)?\s*")


@dataclass(frozen=True)
class TextTable:
    """A table of cells with heads.

    Attributes:
        path: its file.
        names: names of the columns in small letters, with ``_`` for blanks.
        units: units of the columns as they are written, "" where there is none.
        rows: number of the line and cells of each row.
        decimal: sign before decimals, "," or ".".
    """

    path: Path
    names: list[str]
    units: list[str]
    rows: list[tuple[int, list[str]]]
    decimal: str

    @property
    def kinds(self) -> list[str]:
        """Kinds of the columns: ``"friction"`` for f, COF and mu; "" for any other."""
        return [
            next((kind for kind, valid in _NAMES.items() if name in valid), "") for name in self.names
        ]

    @property
    def heads(self) -> str:
        """Names of the columns in the first line, in words."""
        names = [name for name in self.names if name]
        if len(self.names) > 1:
            return f"the columns {excerpt(', '.join(names))}" if names else "columns without a name"
        return "one column; tabs, semicolons or commas separate columns"

    @property
    def near_miss(self) -> str:
        """Hint at the name that a column without one may be meant to have, for the end of a message."""
        valid = [name for names in _NAMES.values() for name in names if len(name) > 1]
        hints = (meant(name, valid) for name, kind in zip(self.names, self.kinds) if not kind)
        return next(filter(None, hints), "")

    def numbers(self, column: int, unit: str) -> NDArray[np.float64]:
        """Numbers of a column in an SI unit, "" for dimensionless, (rows,).

        Raises:
            BadInput: a cell is no finite number, or the column has a unit of another dimension.
        """
        factor = self.factor(column, unit)
        return factor * np.array([self._number(line, row, column) for line, row in self.rows])

    def factor(self, column: int, unit: str) -> float:
        """A column's unit in an SI unit; 1 where it has none.

        Raises:
            BadInput: it is of another dimension.
        """
        given = self.units[column]
        try:
            return 1.0 if given in ("", "1", "-") else to_si(f"1 {given}", unit, given)
        except ValueError as error:
            raise BadInput(f"{self.path}, line 1, {self.names[column]}: {error}") from None

    def _number(self, line: int, row: list[str], column: int) -> float:
        cell = row[column] if column < len(row) else ""
        try:
            number = float(cell.replace(",", ".") if self.decimal == "," else cell)
        except ValueError:
            number = np.nan
        if not np.isfinite(number):
            name = f", {self.names[column]}" * bool(self.names[column])
            said = f"{self.path}, line {line}{name}: found {excerpt(cell)}"
            sign = "comma" if self.decimal == "," else "point"
            hint = f" with a decimal {sign}, as other numbers of the table have" if "," in cell else ""
            nothing = cell.strip().lower() in ("", "-", "na", "n/a", "nan")
            hint = hint or "; leave rows without one away" * nothing
            raise BadInput(f"{said}, expected a finite number{hint}")
        return number


def read_table(path: Path, form: str, columns: int = 0) -> TextTable:
    """Table of a file; before the head lines that begin with #, sep=; and empty ones are left out.

    Args:
        path: the file.
        form: a valid first line, for messages.
        columns: number of columns of a table that needs no head; its units are those asked for then, and
            it may be empty. 0 for a table with a head.

    Raises:
        BadInput: the file cannot be read or is no table.
    """
    try:
        text = text_of(files.read(path, _LARGEST + 1), path, "a table of numbers")
    except OSError as error:
        raise BadInput(f"cannot read {path}: {error.strerror}") from None
    except ValueError:  # a name with a zero in it
        raise BadInput(f"found {excerpt(str(path))}, expected the name of a file") from None
    if len(text) > _LARGEST:
        raise BadInput(f"{path} is larger than {_LARGEST // 10**6} MB, expected a table of numbers")
    lines = text.splitlines()
    heads_at = (
        n for n, line in enumerate(lines)
        if line.strip() and line[0] != "#" and not _SEPARATOR.fullmatch(line.strip())
    )  # fmt: skip
    first = next(heads_at, None)
    if first is None and not columns:
        raise BadInput(f"{path} is empty, expected a first line as {form}")
    start = first or 0
    separator = next((sign for sign in "\t;" if sign in "".join(lines[start : start + 1])), ",")
    rows = [
        (line, row)
        for line, row in enumerate(csv.reader(lines[start:], delimiter=separator), start + 1)
        if any(map(str.strip, row))
    ]
    headless = not rows or (columns > 0 and any(map(_is_number, rows[0][1])))
    heads = [""] * columns if headless else rows[0][1]
    matches = [_HEAD.fullmatch(head) for head in heads]
    for line, row in rows:
        if any(map(str.strip, row[len(heads) :])) or (columns and len(row) != columns):
            hint = "; with decimal commas, separate columns by semicolons" if separator == "," else ""
            expected = columns or f"{len(heads)} as in the first line"
            raise BadInput(
                f"{path}, line {line}: found {len(row)} columns, {excerpt(separator.join(row))}, "
                f"expected {expected}{hint}"
            )
    if columns and None in matches:
        wrong = heads[matches.index(None)]
        raise BadInput(f"{path}, line {rows[0][0]}: found {excerpt(wrong)}, expected as in {form}")
    rows = rows if headless else rows[1:]
    cells = [cell for _, row in rows for cell in row]
    comma = any(map(_COMMA.fullmatch, cells)) and not any(map(_POINT.fullmatch, cells))
    return TextTable(
        path,
        ["_".join(match[1].lower().split()) if match else "" for match in matches],
        [match[2] or "" if match else "" for match in matches],
        rows,
        "," if comma and separator != "," else ".",
    )


def _is_number(cell: str) -> bool:
    try:
        return np.isfinite(float(cell.replace(",", ".")))
    except ValueError:
        return False
