"""Layout of archives: the attributes of the root, and the datasets that belong together.

Names, units and types of datasets are the table of quantities. That an archive is as it was written its
digest shows; what is checked here is that this program knows all that is in it.
"""

import hashlib
import json
from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np

from . import over_time  # noqa: F401 - it adds its rules
from .quantities import table
from .quantities.quantity import NUMBER, TEXT, WHOLE
from .quantities.runs import LINE, SCENE
from .quantities.states import FRICTION, MOTION, POSITION, RATIO, SPEED

#: Version of the layout, and the first version that is read: earlier archives had no digest.
VERSION, FIRST = 4, 2


class Attribute(NamedTuple):
    """Attribute of an archive's root: its meaning, its value in words, the first layout that has it."""

    about: str
    expected: str
    since: int = FIRST


_LIST = "a JSON list of texts"

ATTRIBUTES = {
    "program": Attribute("what wrote it", "galinx"),
    "version": Attribute("of the program", "a text"),
    "schema_version": Attribute("of this layout", "a whole number"),
    "created": Attribute("when it was finished", "date and time (ISO 8601)"),
    "complete": Attribute("nothing is missing", "true"),
    "datasets": Attribute("their paths", _LIST),
    "scene_sha256": Attribute("hash of the scene's text", "a text"),
    "title": Attribute("of the scene", "a text"),
    "load": Attribute(
        "N, pressed on per depth [N/m], the first where states differ in it", "a finite number"
    ),
    "material": Attribute("name of the solid in the library, or nothing", "a text", 3),
    "solid": Attribute(
        "its kind, its parameters and, where the scene gives it, yield_strength, in SI; layers in words",
        "a JSON object of numbers, texts and lists of them", 3,
    ),
    "half_width": Attribute(
        "a, half the width of the contact [m]; with free ends, at rest without friction",
        "a finite number", 3,
    ),
    "c_s": Attribute("wave speed to which c refers [m/s]", "a finite number", 3),
    "speed_limit": Attribute(
        "highest speed of finite elements, that of a wave along the surface [m/s]", "a number", 3
    ),
    "rules": Attribute("names of the comparisons that were made", _LIST),
    "comparisons": Attribute(
        "the largest over all states by what was compared", "a JSON object of numbers"
    ),
    "verdict": Attribute("on the comparisons", "PASS, FAIL or not judged"),
    "verdict_reasons": Attribute("the comparisons that it rests on", _LIST),
    "warnings": Attribute("warnings before the run, and where its answers do not hold", _LIST),
    "versions": Attribute("of libraries", "a JSON object of texts"),
    "machine": Attribute("that it ran on", "a text"),
}  # fmt: skip


#: Quantities that every archive has.
_IN_ALL = (SCENE, SPEED, MOTION, POSITION, FRICTION, RATIO)


class Layout(NamedTuple):
    """Kind of numbers that a dataset holds, as NumPy has it, its shape, and its unit."""

    kind: str
    shape: tuple[int, ...]
    unit: Any


#: Kinds of NumPy by type of a quantity, and types in words.
_KINDS = {TEXT: "O", WHOLE: "iu", NUMBER: "f"}
_IN_WORDS = {TEXT: "texts", WHOLE: "whole numbers", NUMBER: "numbers"}


def faults(attributes: Mapping[str, Any], datasets: Mapping[str, Layout], scene: Any) -> list[str]:
    """Faults of an archive's attributes and of its datasets' paths, types and shapes, one sentence each.

    Args:
        attributes: attributes of the root, ``schema_version`` among them.
        datasets: layouts of the datasets by path.
        scene: text of the scene.
    """
    version, declared = attributes["schema_version"], table()
    rows = {name: row for name, row in ATTRIBUTES.items() if row.since <= version}
    sentences = [
        f"attribute {name}: missing, expected {row.expected}"
        for name, row in rows.items()
        if name not in attributes
    ]
    sentences += [
        f"attribute {name}: found {attributes[name]!r}, expected {row.expected}"
        for name, row in rows.items()
        if name in attributes and not _holds(attributes[name], row.expected)
    ]
    sentences += [
        f"dataset {name!r}: not in the table of quantities; is it registered by a file of yours (-x)?"
        for name in datasets
        if name not in declared
    ]
    sentences += [
        f"{row.path!r}: missing, expected it in every archive"
        for row in _IN_ALL
        if row.path not in datasets
    ]
    sentences += _misshapen({name: layout for name, layout in datasets.items() if name in declared})
    if _holds(attributes.get("datasets"), _LIST):
        listed = json.loads(attributes["datasets"])
        sentences += [f"{name!r}: missing" for name in listed if name not in datasets]
        if unlisted := [name for name in datasets if name in declared and name not in listed]:
            sentences.append(f"attribute datasets: {', '.join(unlisted)} not listed, expected all")
    digest = hashlib.sha256(str(scene).encode()).hexdigest()
    if attributes.get("scene_sha256", digest) != digest:
        sentences.append(f"{SCENE.path}: found a text of hash {digest}, expected that of scene_sha256")
    return sentences


def _holds(value: Any, expected: str) -> bool:
    """True where an attribute is what is expected, in words of the table above."""
    if "JSON" in expected:
        held = None
        with suppress(TypeError, ValueError):
            held = json.loads(value)
        if expected == _LIST:
            return isinstance(held, list) and all(isinstance(each, str) for each in held)
        of = expected.partition("object ")[2]
        kinds = {"of numbers": (int, float), "of texts": str}.get(of, object)
        return isinstance(held, dict) and all(isinstance(each, kinds) for each in held.values())
    if expected == "true":
        return isinstance(value, (bool, np.bool_)) and bool(value)
    if "number" in expected:
        return isinstance(value, (np.floating, np.integer)) and (
            "finite" not in expected or bool(np.isfinite(value))
        )
    return isinstance(value, str)


def _misshapen(datasets: Mapping[str, Layout]) -> list[str]:
    """Faults of units, types, numbers of axes, and of axes of one dimension that differ in length."""
    sentences, lengths = [], dict[str, list[tuple[int, str]]]()
    for name, (kind, shape, unit) in datasets.items():
        row = table()[name]
        if not isinstance(unit, str) or unit != row.unit:
            sentences.append(f"{name!r}: found unit {unit!r}, expected {row.unit!r}")
        if kind not in _KINDS[row.type] or len(shape) != len(row.over):
            axes = " x ".join(row.over) or "a single value"
            sentences.append(
                f"{name!r}: found numbers of kind {kind!r} and shape {shape}, expected "
                f"{_IN_WORDS[row.type]}, {axes}"
            )
            continue
        for dimension, length in zip(row.over, shape):
            if dimension != LINE:
                lengths.setdefault(dimension, []).append((length, name))
    for dimension, each in lengths.items():
        usual = Counter(length for length, _ in each).most_common(1)[0][0]
        sentences += [
            f"{name!r}: found {length} {dimension}, expected {usual} as other datasets have"
            for length, name in each
            if length != usual
        ]
    return sentences
