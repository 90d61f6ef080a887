"""Reading of scenes: TOML with units, all of whose faults are listed before any work starts.

A scene's text is read in four steps. A table that stands in a file of comma-separated values takes the
place of the file's name. TOML is parsed. Every text is checked for control characters, which HDF5 would
refuse only when results are archived. Then each section checks its keys.
"""

import re
import tomllib
from collections import deque
from collections.abc import Collection, Iterator, Mapping
from copy import copy
from dataclasses import replace
from itertools import product
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from galinx import files
from galinx.solvers.contact import BELOW
from galinx.solvers.friction import LAWS
from galinx.solvers.profiles import has_free_end
from galinx.texts import unseen

from ..console import program
from ..errors import BadInput, excerpt, listed, nearest, short, text_of
from ..text_table import read_table
from .library import LIBRARY
from .scene import Scene, contradictions, in_words, usual_quantities
from .sections import ADVECTED, SECTIONS, SWEPT, TOLERANCE_IN_TIME, Key
from .values import Number, Numbers, Or, Rows

#: Place in a message of TOML's reader, quotes of word processors, and values that stand without quotes:
#: 0,37 and 5 mm and steel.
_PLACE = re.compile(r"\(at line (\d+),")
_QUOTE = re.compile("[“”„‟«»‘’]")
_COMMA = re.compile(r"=\s*([-+]?\d+,\d+)\s*(#.*)?$")
_UNIT = re.compile(
    r"=\s*([-+]?[\d.]+(?:e[-+]?\d+)?\s*[^\W\d_e%]\S*(?:\s*[*/]\s*\S+)*|[-+]?[\d.]+\s*%)\s*(#.*)?$"
)
_WORD = re.compile(r"=\s*(?!(?:true|false)\b)([^\W\d][\w.-]*)\s*(#.*)?$", re.IGNORECASE)


def explained(text: str, said: str) -> str:
    """A message of TOML's reader, with the line and what to do where the fault is a usual one.

    Args:
        text: of the scene.
        said: the message.
    """
    place, lines = _PLACE.search(said), text.splitlines()
    if not place or int(place[1]) > len(lines):
        return said
    number, line = place[1], lines[int(place[1]) - 1].strip()
    if said.startswith(("Cannot overwrite a value", "Cannot declare")):
        return f"found {short(line)} in line {number}, whose name stands above already; keep one of them"
    if quote := _QUOTE.search(line):
        return f'found {quote[0]} in line {number}, expected straight quotes, as in "210 GPa"'
    if comma := _COMMA.search(line):
        point = comma[1].replace(",", ".")
        return f"found {comma[1]} in line {number}, expected a decimal point, as in {point}"
    if unit := _UNIT.search(line):
        return f'found {unit[1]} in line {number}, expected quotes around a number and unit, "{unit[1]}"'
    if word := _WORD.search(line):
        return f'found {word[1]} in line {number}, expected quotes around a text, "{word[1]}"'
    if said.startswith("Illegal character '\\n'"):
        return f"found {short(line)} in line {number}, whose text has no quote at its end"
    return said


def control_characters(tree: dict[str, Any]) -> Iterator[str]:
    """Faults of texts and keys of a scene with a control character, each with its place."""
    waiting: deque[tuple[str, Any]] = deque([("", tree)])  # deeper than Python's calls may be
    while waiting:
        place, value = waiting.popleft()
        if isinstance(value, str):
            if fault := unseen(value):
                yield f"{place}: {fault}"
        elif isinstance(value, list):
            waiting += ((f"{place}[{i}]", entry) for i, entry in enumerate(value))
        elif isinstance(value, dict):
            for key, entry in value.items():
                inside = f"{place}.{repr(key)[1:-1]}".removeprefix(".")
                if fault := unseen(key):
                    yield f"the key {inside}: {fault}"
                waiting.append((inside, entry))


#: Most rows of a file of them, and most variants of a scene.
_MOST = 10_000
#: End of the names of such files.
_NAMED = re.compile(r"\.csv[\"']", re.IGNORECASE)


def filled(text: str, folder: Path, name: str) -> str:
    """A scene's text with rows of numbers in place of the names of files that hold them.

    So the scene, and the archive that keeps it, needs no other file any more.

    Args:
        text: TOML; returned unchanged where it names no file, and where it is no TOML.
        folder: from which names of files are resolved.
        name: of the scene, for messages.

    Raises:
        BadInput: a file cannot be read, or is no table of the columns that the key expects.
    """
    if not _NAMED.search(text):
        return text
    try:
        tree = tomllib.loads(text)
    except (ValueError, RecursionError):
        return text  # the scene's reader reports it
    tables = {}
    for path, rows, file in _named(tree):
        try:
            tables[path] = _rows(folder / file, rows.units)
        except BadInput as error:
            raise BadInput(f"{name}, {path}: {error}") from None
    if not tables:
        return text
    from .changes import changed  # an import that only changes pay for

    return changed(text, tables, name)


def _named(tree: Mapping[str, Any]) -> Iterator[tuple[str, Rows, str]]:
    """Keys whose rows are in a file, each with its kind and the file's name."""
    for path, table, keys in _tables(tree, SECTIONS):
        for key, file in table.items():
            kind = keys[key].kind if key in keys else None
            if isinstance(kind, Or):
                kind = kind.kind
            if isinstance(kind, Rows) and isinstance(file, str) and _NAMED.search(f'{file}"'):
                yield f"{path}.{key}", kind, file


def _rows(path: Path, units: tuple[str, ...]) -> list[list[float]]:
    """Rows of a file, in SI units.

    Raises:
        BadInput: it cannot be read, or is no table of so many columns; the message names file and line.
    """
    table = read_table(path, "X [mm]", len(units))
    if len(table.rows) > _MOST:
        raise BadInput(f"{path} has more than {_MOST} rows, the most that a scene takes")
    return np.column_stack([table.numbers(i, unit) for i, unit in enumerate(units)]).tolist()


#: Most bytes of a scene: a million speeds fit, and a file without an end is not read for ever.
_LARGEST = 50 * 10**6

#: First bytes of archives, and of HDF5 files that were written without a seal.
_ARCHIVES = (b"galinx archive\n", b"\x89HDF\r\n\x1a\n")

#: Most faults that a message lists.
_FAULTS = 30


def read(path: Path, changes: Mapping[str, Any] | None = None) -> Scene:
    """Read and check a scene file.

    Args:
        path: the file. Files of rows that it names are looked for beside it.
        changes: new values by ``"section.key"``; they stand in the scene's text.

    Raises:
        BadInput: the file cannot be read, or the scene has faults; all are listed.
    """
    try:
        data = files.read(path, _LARGEST + 1)
    except OSError as error:
        raise BadInput(f"cannot read {path}: {error.strerror}") from None
    if len(data) > _LARGEST:
        raise BadInput(f"{path} is larger than {_LARGEST // 10**6} MB, expected a scene (TOML file)")
    if data.startswith(_ARCHIVES):
        raise BadInput(
            f"{path} is an archive of results, expected a scene (TOML file); "
            f"{program()} show {path} shows what it holds"
        )
    text = text_of(data, path, "a scene (TOML file)").replace("\r\n", "\n")
    if not text.strip():
        raise BadInput(f"{path} is empty, expected a scene; scenes/ holds examples")
    if changes:
        from .changes import changed  # an import that only changes pay for

        text = changed(text, changes, str(path))
    text = filled(text, path.parent, str(path))
    return parse(text, str(path))


def parse(text: str, name: str = "scene") -> Scene:
    """A checked scene from its text.

    Args:
        text: TOML.
        name: of the scene, for messages.

    Raises:
        BadInput: with all faults of the scene in one message.
    """
    try:
        tree = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{name} is not TOML: {explained(text, str(error))}") from None
    except RecursionError:
        raise BadInput(f"{name} cannot be read: its brackets are nested too deeply") from None
    except ValueError:  # Python's limit of digits
        raise BadInput(f"{name} cannot be read: a whole number has thousands of digits") from None
    faults = list(control_characters(tree))
    scenes = _scenes(tree, text, faults)
    if not faults:
        return replace(scenes[0], variants=tuple(scenes)) if scenes[0].swept else scenes[0]
    lines = [f"  {fault}" for fault in faults[:_FAULTS]]
    if len(faults) > _FAULTS:
        lines.append(f"  and {len(faults) - _FAULTS} more")
    listed = "\n".join(lines)
    raise BadInput(f"{name} has {len(faults)} fault{'s' * (len(faults) > 1)}:\n{listed}")


def constants(text: str) -> dict[str, float]:
    """Numbers of a scene by key that may be swept and are not, in the units of swept ones.

    Args:
        text: TOML without faults.
    """
    tree = tomllib.loads(text)
    _fill_in_materials(tree)
    _swept(tree, [])
    return {
        f"{path}.{key}": keys[key].kind(given)
        for path, table, keys in _tables(tree, SWEPT)
        for key, given in table.items()
        if key in keys and type(keys[key].kind) is Number and not isinstance(given, (list, dict))
    }


def _scenes(tree: dict[str, Any], text: str, faults: list[str]) -> list[Scene]:
    """Scenes of all combinations of swept numbers; ends of all contacts are free where some are."""
    _fill_in_materials(tree)
    before = len(faults)
    swept = _swept(tree, faults)
    if len(faults) > before:
        return []
    scenes = _variants(tree, swept, text, faults)
    if len({has_free_end(scene.punch.profile) for scene in scenes}) > 1:  # a tilt through 0
        scenes = _variants(tree, swept, text, faults, free_ends=True)
    return scenes


def _variants(
    tree: dict[str, Any], swept: Mapping[str, tuple[float, ...]], text: str, faults: list[str],
    free_ends: bool = False,
) -> list[Scene]:  # fmt: skip
    """Scenes of all combinations of swept numbers, up to the first with faults."""
    scenes: list[Scene] = []
    for combination in product(*swept.values()):
        values, own = dict(zip(swept, combination)), list[str]()
        scene = _checked(_with_values(tree, values), text, values, own, free_ends)
        of_variant = f"with {in_words(values)}: " if scenes else ""
        faults += [f"{of_variant}{fault}" for fault in own]
        if scene is None or faults:
            break
        scenes.append(scene)
    return scenes


def _swept(tree: Mapping[str, Any], faults: list[str]) -> dict[str, tuple[float, ...]]:
    """Values in SI of numbers that fix the problem and are lists or ranges, by key; faults are added.

    Speeds, loads and the parameters of friction laws have several values in any scene, and one solution
    serves many of them. A number of a solid, a layer or a punch makes another problem: a scene with
    several values of it stands for a scene for each combination. The last key changes fastest. A list of
    one value is that value, and takes its place.

    Args:
        tree: the scene as TOML gives it, with the constants of materials.
        faults: list to which messages are added.
    """
    values: dict[str, tuple[float, ...]] = {}
    for path, table, keys in _tables(tree, SWEPT):
        for key, given in table.items():
            a_range = isinstance(given, dict) and given.keys() & {"from", "to", "number"}
            several = isinstance(given, list) or a_range
            if several and key in keys and type(number := keys[key].kind) is Number:
                if isinstance(given, list) and len(given) == 1:
                    (table[key],) = given
                    continue
                try:
                    numbers = Numbers(number.unit, number.bounds)(given)
                    values[f"{path}.{key}"] = tuple(dict.fromkeys(numbers))
                except ValueError as error:
                    faults.append(f"{path}.{key} ({keys[key].about}): {error}")
    if (count := prod(map(len, values.values()))) > _MOST:
        faults.append(f"{listed([*values])}: found {count} combinations, expected at most {_MOST}")
    if values and (other := [name for name in ("time", "slider") if name in tree]):
        faults.append(
            f"{listed([*values])}: found several values beside [{other[0]}], which is of a single solid "
            "and punch; expected one value each"
        )
    motion = tree.get("motion")
    if "friction.pre_sliding" in values and isinstance(motion, dict) and "path" in motion:
        faults.append(
            "friction.pre_sliding: found several values beside motion.path, whose positions are over it; "
            "expected one value"
        )
    return values


def _tables(
    tree: Mapping[str, Any], names: Collection[str]
) -> Iterator[tuple[str, dict[str, Any], dict[str, Key]]]:
    """Path of each table of these sections, its values and its keys."""
    for name in (name for name in tree if name in names):
        given = tree[name]
        several = name == "layer" and isinstance(given, list)
        tables = {f"layer[{i}]": table for i, table in enumerate(given)} if several else {name: given}
        for path, table in tables.items():
            if isinstance(table, dict):
                yield path, table, SECTIONS[name].keys(table)


def _with_values(tree: dict[str, Any], values: Mapping[str, float]) -> dict[str, Any]:
    """A scene of one value of every swept number."""
    variant = dict(tree)
    for path, value in values.items():
        section, _, key = path.rpartition(".")
        name, _, number = section.partition("[")
        given = variant[name] = copy(variant[name])
        if number:
            given[int(number[:-1])] = given[int(number[:-1])] | {key: value}
        else:
            given[key] = value
    return variant


def _checked(
    tree: dict[str, Any], text: str, swept: Mapping[str, float], faults: list[str], free_ends: bool
) -> Scene | None:
    """Scene of single numbers, or None after its faults are added."""
    before = len(faults)
    steady = _fill_in_motion(tree)
    if "time" in tree and isinstance(solve := tree.get("solve", {}), dict):
        tree["solve"] = {"tolerance": TOLERANCE_IN_TIME} | solve
    named = "quantities" in tree["output"] if isinstance(tree.get("output"), dict) else False
    title = tree.pop("title", "")
    if not isinstance(title, str):
        faults.append(f"title: found {excerpt(title)}, expected a text")
    faults += [
        f"[{short(key)}]: no such section{nearest(key, [*SECTIONS, 'title'])}"
        for key in tree
        if key not in SECTIONS
    ]
    read = {key: section.read(key, tree.get(key, {}), faults) for key, section in SECTIONS.items()}
    if len(faults) > before:
        return None
    try:
        read["friction"] = read["friction"].under(read["punch"].loads)
    except ValueError as error:
        faults.append(str(error))
        return None
    scene = Scene(
        title, text, half_plane=read.pop("solid"), layers=read.pop("layer"), steady=steady,
        swept=swept, elastic_punch=read.pop("punch.solid"), free_ends=free_ends, **read,
    )  # fmt: skip
    if not named:
        usual = scene.time or scene.slider or (steady and scene.solve.methods)
        quantities = usual_quantities(scene) if usual else scene.output.quantities
        quantities += (BELOW,) * scene.output.has_places
        scene = replace(scene, output=replace(scene.output, quantities=quantities))
    faults += contradictions(scene)
    return None if len(faults) > before else scene


def _fill_in_materials(tree: dict[str, Any]) -> None:
    """Fill in the constants of the materials that a scene names; those that the scene gives stay.

    The solid of a punch becomes a section of its own.
    """
    punch = tree.get("punch")
    if isinstance(punch, dict) and "solid" in punch:
        tree["punch.solid"] = punch.pop("solid") or {"kind": "isotropic"}
    for name in tree.keys() & {"solid", "punch.solid"}:
        tree[name] = _with_constants(tree[name])
    if isinstance(tree.get("layer"), list):
        tree["layer"] = [_with_constants(table) for table in tree["layer"]]


def _with_constants(table: Any) -> Any:
    if not isinstance(table, dict) or not isinstance(table.get("material"), str) or "properties" in table:
        return table
    # An unknown name is one fault, which its key reports: no constant shall be missing besides.
    return (LIBRARY.get(table["material"]) or next(iter(LIBRARY.values()))).constants | table


def _fill_in_motion(tree: dict[str, Any]) -> bool:
    """True for steady sliding, a law without memory or advected, and no strokes; these are filled in."""
    friction, motion = tree.get("friction", {}), tree.get("motion", {})
    if not isinstance(friction, dict) or not isinstance(motion, dict):
        return False
    memory = LAWS[SECTIONS["friction"].model(friction)].has_memory
    if memory and friction.get("state") != ADVECTED:
        return False
    if motion.keys() & {"strokes", "X_over_L", "path"} or "slider" in tree:
        return False
    tree["motion"] = motion | {"strokes": ["forward"], "X_over_L": [1.0]}
    return True
