"""Changes of a scene's text, made where the value stands; comments and layout stay."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import Item

from galinx.solvers.solids import SOLIDS

from ..errors import BadInput, excerpt, nearest, short
from .sections import SECTIONS
from .units import in_si

#: Two names of a number: a new value is given to that name which the scene has.
_ONE_NUMBER = {"friction.mu": "friction.mu_c", "friction.mu_c": "friction.mu"}

#: Section with a number, as ``layer[0]``; a list of texts without quotes, as ``[1 mm, 2 mm]``; and a list
#: or a range with one unit for all, as ``[1, 2] mm``.
_NUMBERED = re.compile(r"(\w+)\[(\d{1,3})\]")
_TEXTS = re.compile(r"\[([^\[\]{}\"']+)\]")
_WITH_UNIT = re.compile(r"(\[[^\[\]{}\"']*\]|\{[^{}]*\})\s*([^\s\[\]{}\"'][^\[\]{}\"']*)")

#: Longest text that a change may set, in characters: the time of tomlkit grows with their square.
_LONGEST = 10_000


#: The value of a key that is to be removed, and has to exist.
UNSET = object()


def from_words(words: Iterable[str], unset: Iterable[str] = ()) -> dict[str, Any]:
    """Changes as the command line gives them: ``section.key=value``, the value as in TOML.

    A value that is not TOML is taken as a text: ``solid.E=70 GPa`` needs no quotes, nor does a list.

    Args:
        words: arguments of ``--set``.
        unset: arguments of ``--unset``, keys to be removed.

    Returns:
        New values by ``"section.key"``; ``UNSET`` for keys to be removed.

    Raises:
        BadInput: a word without key or value, or not UTF-8; a key that is both set and removed.
    """
    changes: dict[str, Any] = {}
    for word in words:
        try:
            word.encode()
        except UnicodeEncodeError:
            raise BadInput(f"--set {short(word)}: expected a text in UTF-8") from None
        key, equals, value = word.partition("=")
        if not equals or not key.strip():
            raise BadInput(
                f"--set {short(word)}: expected section.key=value, as in --set friction.mu_c=0.5"
            )
        key, value = key.strip(), value.strip()
        changes[key] = read = _value(value)
        if value.startswith("{") and isinstance(read, str):
            raise BadInput(
                f"--set {key}: found {short(value)!r}, expected a range as in TOML, its texts in "
                "quotes: '{from=0.1, to=1, number=3, spacing=\"log\"}'"
            )
    for key in unset:
        if key in changes:
            raise BadInput(f"--set and --unset {short(key)} exclude each other; keep one")
    return changes | dict.fromkeys(unset, UNSET)


def _value(value: str) -> Any:
    """Value of TOML, or of a text without the quotes that TOML asks for."""
    try:
        return tomlkit.value(value)
    except (TOMLKitError, ValueError, RecursionError):
        texts = _TEXTS.fullmatch(value)
        # In [5, 10 µm] the first number has no unit: it is refused.
        if texts and not any(map(_is_number, parts := _between_commas(texts[1]))):
            return parts
        return _with_unit(value)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _between_commas(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]


def _with_unit(value: str) -> Any:
    """A list or a range of numbers with their unit, of ``[5, 10, 20] µm``; any other text unchanged."""
    match = _WITH_UNIT.fullmatch(value)
    if not match:
        return value
    given, unit = match[1], match[2]
    if given.startswith("["):
        return [f"{number} {unit}" for number in _between_commas(given.strip("[]"))]
    try:
        table = tomlkit.value(given).unwrap()
    except (TOMLKitError, ValueError):
        return value
    return {key: f"{end} {unit}" if key in ("from", "to") else end for key, end in table.items()}


def changed(text: str, changes: Mapping[str, Any], name: str = "scene") -> str:
    """A scene's text with other values.

    Args:
        text: TOML.
        changes: new values by ``"section.key"``, or ``"title"``; None removes a key if it exists,
            ``UNSET`` one that has to exist, and ``"solid.material"`` the constants not among the changes.
        name: of the scene, for messages.

    Raises:
        BadInput: the text is not TOML, a key is not of that form, or one to be removed does not exist.
    """
    if strange := [key for key in changes if not isinstance(key, str)]:
        raise BadInput(f"{name} cannot be changed: found the key {excerpt(strange[0])}, expected a text")
    try:
        tree = tomlkit.parse(text)
        values = _keys(tree)
        keys = [*values]
        own = {key: _ONE_NUMBER.get(key, key) for key in changes}  # by the name that the scene has
        changes = {own[key] if own[key] in keys else key: value for key, value in changes.items()}
        if stale := [path for path in _stale(values, changes) if path in keys]:
            changes = dict.fromkeys(stale) | dict(changes)
        for path, value in changes.items():
            if value is UNSET and path not in keys:
                raise ValueError(f"found no key {excerpt(path)} to take away{nearest(path, keys)}")
            if value is not None or path in keys:
                _change(tree, path, None if value is UNSET else value)
        return tomlkit.dumps(tree)
    except (TOMLKitError, ValueError, TypeError) as error:
        raise BadInput(f"{name} cannot be changed: {error}") from None
    except RecursionError:
        raise BadInput(f"{name} cannot be changed: brackets are nested too deeply") from None


def _stale(keys: Mapping[str, Any], changes: Mapping[str, Any]) -> list[str]:
    """Keys that a newly chosen material replaces, or that only other models than the new one have.

    Args:
        keys: the scene's values by ``"section.key"``.
        changes: new values by key.
    """
    stale: list[str] = []
    for name in ("solid", "punch.solid", "punch", "friction"):
        section, gone = SECTIONS[name], set[str]()
        chosen, solid = f"{name}.{section.chosen}", section.models is SOLIDS
        model, alternatives = changes.get(chosen, ""), section.alternatives
        if solid and f"{name}.material" in changes:
            gone = section.every.keys() - section.own.keys() - {"plane"} | {"yield_strength"}
        elif (
            isinstance(model, str)
            and model in alternatives
            and model != keys.get(chosen, section.default)
        ):
            gone = section.every.keys() - alternatives[model].keys()
            gone |= {"material", "yield_strength"} if solid else set()
        stale += [f"{name}.{key}" for key in gone]
        tables = keys.get(f"{name}.vary", ())
        varied = {key for table in tables for key in table} if isinstance(tables, list) else set()
        stale += [f"{name}.vary"] * bool(varied & gone)
    return stale


def _keys(tree: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a scene by their keys, as ``"section.key"`` or ``"title"``."""
    values: dict[str, Any] = {}
    for name, value in tree.items():
        if isinstance(value, list) and all(isinstance(table, dict) for table in value):
            values |= {f"{name}[{i}].{key}": table[key] for i, table in enumerate(value) for key in table}
        elif isinstance(value, dict):
            of_section = {f"{name}.{key}": value[key] for key in value}
            if isinstance(of_punch := of_section.pop("punch.solid", None), dict):
                of_section |= {f"punch.solid.{key}": entry for key, entry in of_punch.items()}
            values |= of_section
        else:
            values[name] = value
    return values


def differences(texts: Iterable[str]) -> dict[str, list[str]]:
    """Values of the keys in which scenes differ, as text, "–" where a scene lacks the key.

    A number is the same in whatever unit it is written.

    Args:
        texts: of the scenes, TOML.
    """
    scenes = [_keys(tomlkit.parse(text).unwrap()) for text in texts]
    keys = dict.fromkeys(key for scene in scenes for key in scene)
    return {
        key: [_text(scene[key]) if key in scene else "–" for scene in scenes]
        for key in keys
        if any(in_si(scene.get(key)) != in_si(scenes[0].get(key)) for scene in scenes)
    }


def _text(value: Any) -> str:
    """A value as a person writes it: texts without quotes."""
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        table.update(value)
        return table.as_string()
    return value if isinstance(value, str) else tomlkit.item(value).as_string()


def _change(tree: Any, path: str, value: Any) -> None:
    """Set a key of a scene in place, or remove it where the value is None."""
    *sections, key = path.split(".")
    nested = len(sections) > 1 and sections != ["punch", "solid"]
    if nested or (not sections and key != "title"):
        raise ValueError(f"found {excerpt(path)}, expected section.key, as in friction.mu_c")
    if isinstance(value, str) and len(value) > _LONGEST:
        raise ValueError(f"found a text of {len(value)} characters, expected at most {_LONGEST}")
    for depth, section in enumerate(sections):
        tree = _section(tree, section, tomlkit.inline_table() if depth else tomlkit.table())
    if value is None:
        del tree[key]
    else:
        tree[key] = _item(value)


def _section(tree: Any, name: str, new: Any) -> Any:
    """Section of a scene, or a layer by its number, ``layer[0]``.

    A missing one is ``new``: within a section it stands in one line, which fits below dotted keys too.
    """
    match = _NUMBERED.fullmatch(name)
    tables = tree.get(match[1] if match else name)
    if isinstance(tables, list) or match or name == "layer":
        count = len(tables) if isinstance(tables, list) else 0
        number = int(match[2]) if match else count
        if number >= count:
            if not count:
                raise ValueError(
                    f"found {excerpt(name)}, but the scene has no layer; write a table [[layer]] with "
                    "thickness and material into it first"
                )
            raise ValueError(
                f"found {excerpt(name)}, expected layers by their number from the top: the scene has "
                f"{count}, the first of them layer[0], as in layer[0].thickness"
            )
        return tables[number]  # type: ignore[index]
    section = tree.setdefault(name, new)
    if not isinstance(section, dict):
        raise ValueError(f"found {excerpt(name)} without keys, expected a section")
    return section


def _item(value: Any) -> Any:
    """A value as tomlkit holds it; lists are parsed, as the time to build one grows with its square."""
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, dict) and not isinstance(value, Item):  # a range; stays in its line
        (table := tomlkit.inline_table()).update({key: _item(each) for key, each in value.items()})
        return table
    if isinstance(value, Item) or not isinstance(value, (list, tuple)):
        return value
    items = [tomlkit.item(_item(entry)) for entry in value]
    if any(isinstance(entry, dict) for entry in items):
        return list(value)
    return tomlkit.value(f"[{', '.join(entry.as_string() for entry in items)}]")


def with_law(text: str, fitted: str, name: str) -> str:
    """A scene's text with the friction law of another section ``[friction]``, and that one's comments.

    Raises:
        BadInput: the text is not TOML.
    """
    try:
        own = tomlkit.parse(text).get("friction", {})
    except TOMLKitError as error:
        raise BadInput(f"{name} cannot be changed: {error}") from None
    section = SECTIONS["friction"]
    kept = {key for key, (_, entry) in section.own.items() if not entry.stands_for}
    stale = own.keys() & section.every.keys() - kept if isinstance(own, dict) else ()
    law = {f"friction.{key}": item for key, item in tomlkit.parse(fitted)["friction"].items()}
    return changed(text, {f"friction.{key}": None for key in stale} | law, name)
