"""Attributes of an archive's root: what each says, and what it may be."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from math import isfinite
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Attribute:
    """What is known of an attribute.

    Attributes:
        about: what it says.
        expected: what it may be, in words.
        fits: may it be this? For whatever HDF5 gives.
        since: schema version from which on it is there.
    """

    about: str
    expected: str
    fits: Callable[[Any], bool]
    since: int = 1


def is_text(value: Any) -> bool:
    """A text that can be written anywhere: HDF5 and JSON have some that UTF-8 has not."""
    try:
        return isinstance(value, str) and bool(value.encode() or True)
    except UnicodeEncodeError:
        return False


def _number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        return False
    try:
        return isinstance(float(value), float)
    except OverflowError:  # JSON's integers have no end
        return False


def _finite(value: Any) -> bool:
    return _number(value) and isfinite(value)


def _moment(value: Any) -> bool:
    try:
        return bool(datetime.fromisoformat(value))
    except (TypeError, ValueError):
        return False


def _one_of(*texts: str) -> Callable[[Any], bool]:
    return lambda value: isinstance(value, str) and value in texts


def _from_json(value: Any) -> Any:
    try:
        return json.loads(value) if is_text(value) else None
    except (ValueError, RecursionError):
        return None


def _list(value: Any) -> bool:
    found = _from_json(value)
    return isinstance(found, list) and all(map(is_text, found))


def _constant(value: Any, depth: int = 2) -> bool:
    """A text or a number, a list of them, or a table: what parameters of a solid may be."""
    if isinstance(value, list) and depth:
        return all(_constant(entry, depth - 1) for entry in value)
    return is_text(value) or _number(value)


def _object(fits: Callable[[Any], bool]) -> Callable[[Any], bool]:
    def entries_fit(value: Any) -> bool:
        found = _from_json(value)
        return isinstance(found, dict) and all(is_text(key) and fits(found[key]) for key in found)

    return entries_fit


_LIST = "a JSON list of texts"

ATTRIBUTES = {
    "program": Attribute("what wrote it", "galinx", _one_of("galinx")),
    "version": Attribute("of the program", "a text", is_text),
    "schema_version": Attribute(
        "of this layout", "a whole number", lambda value: isinstance(value, np.integer)
    ),
    "created": Attribute("when it was finished", "date and time (ISO 8601)", _moment),
    "complete": Attribute(
        "nothing is missing", "true", lambda value: isinstance(value, np.bool_) and bool(value)
    ),
    "datasets": Attribute("their paths", _LIST, _list, since=2),
    "scene_sha256": Attribute("hash of the scene's text", "a text", is_text),
    "title": Attribute("of the scene", "a text", is_text),
    "load": Attribute(
        "N, pressed on per depth [N/m], the first where states differ in it", "a finite number", _finite
    ),
    "material": Attribute("name of the solid in the library, or nothing", "a text", is_text, since=3),
    "solid": Attribute(
        "its kind, its parameters and, where the scene gives it, yield_strength, in SI; layers in words",
        "a JSON object of numbers, texts and lists of them",
        _object(_constant),
        since=3,
    ),
    "half_width": Attribute(
        "a, half the width of the contact [m]; where ends are found, at rest without friction",
        "a finite number",
        _finite,
        since=3,
    ),
    "c_s": Attribute("wave speed to which c refers [m/s]", "a finite number", _finite, since=3),
    "speed_limit": Attribute(
        "highest speed of finite elements, that of a wave along the surface [m/s]",
        "a number",
        _number,
        since=3,
    ),
    "rules": Attribute("names of the comparisons that were made", _LIST, _list),
    "comparisons": Attribute(
        "the largest over all states by what was compared",
        "a JSON object of numbers",
        _object(_number),
    ),
    "verdict": Attribute(
        "on the comparisons",
        "PASS, FAIL or not judged",
        _one_of("PASS", "FAIL", "not judged"),
    ),
    "verdict_reasons": Attribute("the comparisons that it rests on", _LIST, _list),
    "warnings": Attribute(
        "what was told before the run, and where its answers do not hold", _LIST, _list
    ),
    "versions": Attribute("of libraries", "a JSON object of texts", _object(is_text)),
    "machine": Attribute("that it ran on", "a text", is_text),
}
