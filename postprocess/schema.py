"""Layout of archives: the attributes of the root, and the datasets that belong together.

Names, units and types of datasets are the table of quantities. That an archive is as it was written its
digest shows; what is checked here is that this program knows all that is in it.
"""

import hashlib
import json
from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from . import over_time  # noqa: F401 - it adds its rules
from .quantities import table
from .quantities.runs import SCENE

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


def faults(attributes: Mapping[str, Any], datasets: Collection[str], scene: str) -> list[str]:
    """Faults of an archive's attributes and paths of datasets, one sentence each.

    Args:
        attributes: attributes of the root, ``schema_version`` among them.
        datasets: paths of the datasets.
        scene: text of the scene.
    """
    version, known = attributes["schema_version"], table()
    listed = json.loads(attributes.get("datasets", "[]"))
    sentences = [
        f"attribute {name}: missing, expected {row.expected}"
        for name, row in ATTRIBUTES.items()
        if row.since <= version and name not in attributes
    ]
    sentences += [
        f"dataset {name!r}: not in the table of quantities; is it registered by a file of yours (-x)?"
        for name in datasets
        if name not in known
    ]
    sentences += [f"{name!r}: missing" for name in listed if name not in datasets]
    if unlisted := [name for name in datasets if name in known and name not in listed]:
        sentences.append(f"attribute datasets: {', '.join(unlisted)} not listed, expected all")
    if attributes.get("complete", True) not in (True,):
        sentences.append(f"attribute complete: found {attributes['complete']}, expected true")
    digest = hashlib.sha256(scene.encode()).hexdigest()
    if attributes.get("scene_sha256", digest) != digest:
        sentences.append(f"{SCENE.path}: found a text of hash {digest}, expected that of scene_sha256")
    return sentences
