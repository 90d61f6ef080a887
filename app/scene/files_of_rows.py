"""Tables of a scene that stand in files of their own: comma-separated values take the file's place."""

import csv
import re
import tomllib
from collections.abc import Iterator, Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from galinx import files
from galinx.app.errors import BadInput
from galinx.app.scene.excerpt import excerpt
from galinx.app.scene.keys import Section
from galinx.app.scene.tables import Rows, Wrapped
from galinx.app.scene.units import to_si

#: Bytes of a file, and the most rows that are put into a scene.
_LARGEST, _MOST = 10**7, 10_000
#: How names of such files end.
_NAMED = re.compile(r"\.csv[\"']", re.IGNORECASE)
#: A column's head: its name, and its unit in brackets.
_HEAD = re.compile(r"[^\[\]()]*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")


def filled(text: str, sections: Mapping[str, Section], folder: Path, name: str) -> str:
    """A scene's text with the rows themselves where it names a file of rows.

    So the scene, and the archive that keeps it, needs no other file any more.

    Args:
        text: TOML; returned as it is where it names no file, and where it is no TOML.
        sections: of scenes, by name.
        folder: that the files' names start from.
        name: of the scene, for messages.

    Raises:
        BadInput: a file cannot be read, or is no table of the columns that the key wants.
    """
    if not _NAMED.search(text):
        return text
    try:
        tree = tomllib.loads(text)
    except (ValueError, RecursionError):
        return text  # told of by who reads the scene
    found = {}
    for path, rows, file in _named(tree, sections):
        try:
            found[path] = _read(folder / file, rows.units)
        except ValueError as error:
            raise BadInput(f"{name}, {path}: {error}") from None
    if not found:
        return text
    from galinx.app.scene.changes import changed  # an import that only changes pay for

    return changed(text, found, name)


def _named(tree: Mapping[str, Any], sections: Mapping[str, Section]) -> Iterator[tuple[str, Rows, str]]:
    """Keys whose rows are in a file, with what they want and the file's name."""
    for section, given in tree.items():
        if section not in sections or not isinstance(given, dict):
            continue
        for key, known in sections[section].keys(given).items():
            kind = known.kind.kind if isinstance(known.kind, Wrapped) else known.kind
            file = given.get(key)
            if isinstance(kind, Rows) and isinstance(file, str) and _NAMED.search(f'{file}"'):
                yield f"{section}.{key}", kind, file


def _read(path: Path, units: tuple[str, ...]) -> list[list[float]]:
    """Rows in SI units.

    Raises:
        ValueError: the message names the file and the line.
    """
    try:
        text = files.read(path, _LARGEST + 1).decode("utf-8-sig")
    except OSError as error:
        raise ValueError(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ValueError(f"{path} is not UTF-8 (byte {error.start}); save it as UTF-8") from None
    except ValueError:  # a name with a zero in it
        raise ValueError(f"found {excerpt(str(path))}, expected the name of a file") from None
    rows = [
        (n, row) for n, row in enumerate(csv.reader(text.splitlines()), 1) if any(map(str.strip, row))
    ]
    factors = [1.0] * len(units)
    if rows and not any(map(_is_number, rows[0][1])):
        factors = _factors(path, *rows.pop(0), units)
    if len(text) > _LARGEST or len(rows) > _MOST:
        raise ValueError(f"{path} has more than {_MOST} rows, the most that a scene takes")
    return [_numbers(path, line, row, factors) for line, row in rows]


def _factors(path: Path, line: int, heads: list[str], units: tuple[str, ...]) -> list[float]:
    """Units of the columns in SI, from their heads."""
    if len(heads) != len(units):
        raise ValueError(_wrong_width(path, line, heads, len(units)))
    found = []
    for head, unit in zip(heads, units):
        match = _HEAD.fullmatch(head)
        if match is None:
            raise ValueError(f"{path}, line {line}: found {excerpt(head)}, expected as in X [mm]")
        given = match[1] or ""
        try:
            found.append(1.0 if given in ("", "1") else to_si(f"1 {given}", unit))
        except ValueError as error:
            raise ValueError(f"{path}, line {line}, {head.strip()}: {error}") from None
    return found


def _numbers(path: Path, line: int, row: list[str], factors: list[float]) -> list[float]:
    if len(row) != len(factors):
        raise ValueError(_wrong_width(path, line, row, len(factors)))
    for cell in row:
        if not _is_number(cell):
            raise ValueError(f"{path}, line {line}: found {excerpt(cell)}, expected a finite number")
    return [factor * float(cell) for factor, cell in zip(factors, row)]


def _wrong_width(path: Path, line: int, row: list[str], wanted: int) -> str:
    return (
        f"{path}, line {line}: found {len(row)} columns, {excerpt(','.join(row))}; expected {wanted}, "
        "separated by commas"
    )


def _is_number(cell: str) -> bool:
    try:
        return isfinite(float(cell))
    except ValueError:
        return False
