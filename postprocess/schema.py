"""Schema of archives: names, types, shapes, units and values of datasets and attributes.

The schema follows from the table of quantities and from ``ATTRIBUTES``, the table of the root's
attributes. No command reads an archive that does not fit. A fault is a sentence that names the dataset or
attribute, what was found and what was expected.
"""

import hashlib
import json
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from math import isfinite
from reprlib import repr as short
from typing import Any

import numpy as np

from galinx.solvers.parameters import Range

from . import over_time  # noqa: F401 - it adds its rules
from .compare import FINITE, RULES, not_finite
from .quantities import Quantity, layers, runs, states, stresses, table
from .quantities.quantity import ALONG, INSIDE, POINT

#: Version of the layout, and the first version that is read: earlier archives had no digest.
VERSION, FIRST = 4, 2


@dataclass(frozen=True)
class Attribute:
    """Attribute of an archive's root: its meaning, and the values that it may have.

    Attributes:
        about: its meaning.
        expected: allowed values in words.
        fits: function of a value as HDF5 gives it, True for allowed values.
        since: first schema version with this attribute.
    """

    about: str
    expected: str
    fits: Callable[[Any], bool]
    since: int = FIRST


def is_text(value: Any) -> bool:
    """True for a text that UTF-8 can encode: HDF5 and JSON can hold others."""
    try:
        return isinstance(value, str) and bool(value.encode() or True)
    except UnicodeEncodeError:
        return False


def _number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        return False
    try:
        return isinstance(float(value), float)
    except OverflowError:  # integers of JSON may be of any size
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
    texts = _from_json(value)
    return isinstance(texts, list) and all(map(is_text, texts))


def _constant(value: Any, depth: int = 2) -> bool:
    """True for a value that a parameter of a solid may have: a text or a number, a list or a table."""
    if isinstance(value, list) and depth:
        return all(_constant(entry, depth - 1) for entry in value)
    return is_text(value) or _number(value)


def _object(fits: Callable[[Any], bool]) -> Callable[[Any], bool]:
    def entries_fit(value: Any) -> bool:
        entries = _from_json(value)
        return isinstance(entries, dict) and all(is_text(key) and fits(entries[key]) for key in entries)

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
    "datasets": Attribute("their paths", _LIST, _list),
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
        "a, half the width of the contact [m]; with free ends, at rest without friction",
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
    "warnings": Attribute("warnings before the run, and where its answers do not hold", _LIST, _list),
    "versions": Attribute("of libraries", "a JSON object of texts", _object(is_text)),
    "machine": Attribute("that it ran on", "a text", is_text),
}


#: Datasets that every run writes.
_ALWAYS = (
    runs.SCENE, states.MOTION, states.POSITION, states.SPEED, states.FRICTION, states.RATIO,
    runs.LOOP_OF_STATE, runs.LOOP_X, runs.LOOP_F, runs.DONE, runs.SKIPPED, runs.SECONDS, runs.STEPS,
)  # fmt: skip
#: Datasets of positions by the dimensions of other datasets that need them.
_POSITIONS = {
    POINT: (stresses.SURFACE_X,), INSIDE: (stresses.INSIDE_X, stresses.INSIDE_Y),
    ALONG: (layers.ALONG_X,),
}  # fmt: skip


@dataclass(frozen=True)
class Described:
    """Description of a dataset in a file.

    Attributes:
        type: ``"text"``, or numpy's name of the type of its numbers.
        shape: numbers of rows, columns, ….
        attributes: attributes of the dataset by name.
        whole: True where all values are in the file, numbers with a checksum.
    """

    type: str
    shape: tuple[int, ...]
    attributes: Mapping[str, Any]
    whole: bool


def faults(attributes: Mapping[str, Any], datasets: Mapping[str, Described]) -> list[str]:
    """Faults of an archive that are visible before any of its values is read, one sentence each.

    Args:
        attributes: attributes of the root, ``schema_version`` an integer.
        datasets: descriptions of the datasets by path.
    """
    rows = table()
    sentences = [*_of_attributes(attributes), *_of_names(attributes, datasets, rows)]
    declared = {name: dataset for name, dataset in datasets.items() if name in rows}
    for name, dataset in declared.items():
        sentences += _of_dataset(name, dataset, rows[name])
    return [*sentences, *_of_shapes(declared, rows)]


def _of_attributes(attributes: Mapping[str, Any]) -> Iterator[str]:
    version = attributes["schema_version"]
    expected = {name: row for name, row in ATTRIBUTES.items() if row.since <= version}
    for name in sorted(attributes.keys() - expected.keys()):
        yield f"attribute {name!r}: no archive has one of that name"
    for name, row in expected.items():
        if name not in attributes:
            yield f"attribute {name}: missing, expected {row.expected}"
        elif not row.fits(attributes[name]):
            yield f"attribute {name}: found {short(attributes[name])}, expected {row.expected}"


def _of_names(
    attributes: Mapping[str, Any], datasets: Mapping[str, Described], rows: Mapping[str, Quantity]
) -> Iterator[str]:
    for name in sorted(datasets.keys() - rows.keys()):
        yield (
            f"dataset {name!r}: not in the table of quantities; is it registered by a file of yours (-x)?"
        )
    listed = {row.path for row in _ALWAYS}
    for name in datasets.keys() & rows.keys():
        listed |= {row.path for over in rows[name].over for row in _POSITIONS.get(over, ())}
    if "datasets" in attributes and ATTRIBUTES["datasets"].fits(attributes["datasets"]):
        listed |= set(json.loads(attributes["datasets"]))
        for name in sorted(datasets.keys() & rows.keys() - listed):
            yield f"{name}: not in the attribute datasets, which lists all"
    for name in sorted(listed - datasets.keys()):
        yield f"{name!r}: missing"


def _of_dataset(name: str, dataset: Described, row: Quantity) -> Iterator[str]:
    if dataset.type != row.type:
        yield f"{name}: found {dataset.type}, expected {row.type}"
    if not dataset.whole:
        yield f"{name}: found no checksum or not all of its values in the file, expected both"
    units = dataset.attributes.get("units")
    if not isinstance(units, str) or units != row.unit:
        yield f"{name}: found units {short(units)}, expected {row.unit!r}"
    for other in sorted(dataset.attributes.keys() ^ {"units", "long_name"}):
        there = "found an attribute" if other in dataset.attributes else "expected the attribute"
        yield f"{name}: {there} {other!r}, expected units and long_name"


def _of_shapes(datasets: Mapping[str, Described], rows: Mapping[str, Quantity]) -> Iterator[str]:
    """Faults of shapes: a dimension has the same size in all datasets, that in most of them."""
    sizes: dict[str, Counter[int]] = {}
    fitting = {
        name: dataset for name, dataset in datasets.items() if len(dataset.shape) == len(rows[name].over)
    }
    for name, dataset in fitting.items():
        for dimension, size in zip(rows[name].over, dataset.shape):
            sizes.setdefault(dimension, Counter())[size] += 1
    most = {dimension: counter.most_common(1)[0][0] for dimension, counter in sizes.items()}
    most |= {dimension: int(dimension) for dimension in most if dimension.isdecimal()}
    for name, dataset in datasets.items():
        over = rows[name].over
        words = " × ".join(over) or "a single one"
        expected = tuple(most.get(dimension, 1) for dimension in over)
        if runs.LINE in over:  # numbers of lines differ between datasets
            expected = dataset.shape if name in fitting else (0,)
        elif 0 in expected:
            yield f"{name}: found no {over[expected.index(0)]}, expected some"
        if dataset.shape != expected:
            yield f"{name}: found shape {dataset.shape}, expected {expected}: {words}"


def faults_of_values(data: Mapping[str, Any], attributes: Mapping[str, Any]) -> list[str]:
    """Faults of the values of datasets, one sentence each.

    Args:
        data: datasets by path, of any states; the positions on the surface and the failures among them.
        attributes: attributes of the root, without faults.
    """
    rows = table()
    sentences = [fault for name, values in data.items() for fault in _out_of_range(values, rows[name])]
    excused = _reports_failures(data, attributes)
    return sentences + [
        f"{name}: found a number that is not finite, expected none"
        for name in not_finite(dict(data))
        if not (excused and rows[name].solved)
    ]


def _out_of_range(values: Any, row: Quantity) -> Iterator[str]:
    if row.range != Range() and (finite := values[np.isfinite(values)]).size:
        outside = [x for x in (finite.min().item(), finite.max().item()) if x not in row.range]
        if outside:
            yield f"{row.path}: found {outside[0]:g}, expected numbers {row.range}"


def _reports_failures(data: Mapping[str, Any], attributes: Mapping[str, Any]) -> bool:
    """True where the archive itself reports failed states or values that are not finite."""
    comparisons = json.loads(attributes["comparisons"])
    return len(data.get(runs.FAILURES.path, ())) > 0 or bool(comparisons.get(RULES[FINITE].text))


def faults_between(data: Mapping[str, Any], attributes: Mapping[str, Any]) -> Iterator[str]:
    """Faults where one dataset does not fit another, one sentence each.

    Args:
        data: datasets by path, of all states.
        attributes: attributes of the root, without faults.
    """
    digest = hashlib.sha256(data[runs.SCENE.path].encode()).hexdigest()
    if digest != attributes["scene_sha256"]:
        yield f"{runs.SCENE.path}: found a text of the hash {digest}, expected that of scene_sha256"
    loops = len(data[runs.LOOP_F.path])
    if data[runs.LOOP_OF_STATE.path].max() >= loops:
        yield f"{runs.LOOP_OF_STATE.path}: found a row beyond the {loops} of {runs.LOOP_F.path}"
    speeds, of_states = data.get(runs.RECORD["c"].path), data[states.SPEED.path]
    if speeds is not None and not np.array_equal(np.unique(speeds), np.unique(of_states)):
        yield f"{runs.RECORD['c'].path}: found other speeds than in {states.SPEED.path}"
    shape, points = data.get(stresses.MAP.path), data.get(stresses.INSIDE_X.path, ())
    if shape is not None and np.prod(shape, dtype=float) > len(points):
        yield f"{stresses.MAP.path}: found a grid of {shape} points, expected at most {len(points)}"
