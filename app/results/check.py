"""Does an archive say what its own scene and numbers say? Asked of one that fits the schema."""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from galinx import __version__
from galinx.app.plan.judged_over_time import IN_TIME
from galinx.app.plan.plan import make_plan
from galinx.app.plan.states import enumerate_states, order
from galinx.app.plan.task import Plan
from galinx.app.results import recomputed
from galinx.app.run.judge import Judge
from galinx.app.run.told import of_scene
from galinx.app.scene import read as scenes
from galinx.app.scene.scene import Scene
from galinx.postprocess import compare
from galinx.postprocess.finite import not_finite
from galinx.postprocess.hdf5 import reader
from galinx.postprocess.quantities import runs, table
from galinx.postprocess.quantities.quantity import NEVER, STATE
from galinx.postprocess.quantities.states import LOAD, SPEED
from galinx.postprocess.schema import VERSION

#: States looked at together.
_ROWS = 1000

#: Within what numbers that are computed again are the same on any machine.
_SAME = 1e-9


def faults(path: Path) -> list[str]:
    """What is wrong with an archive, one sentence each; every byte of it is read.

    Raises:
        UnreadableArchive: no archive, a damaged one, or one that does not fit the schema.
        BadInput: its scene has a fault.
    """
    with reader.opened(path) as archive:
        scene = scenes.parse(archive.data[runs.SCENE.path], "the scene of the archive")
        found = [*_of_states(archive, scene)]
        if archive.attributes["version"] == __version__:  # other versions plan and tell otherwise
            plan = make_plan(scene)
            found += _of_plan(archive, scene, plan)
            if not found:
                found += recomputed.faults(archive, scene, plan)
        return [*found, *_of_numbers(archive), *_of_verdict(archive, scene)]


def _of_states(archive: reader.Archive, scene: Scene) -> Iterator[str]:
    """Friction is followed once more."""
    data, older = archive.data, archive.attributes["schema_version"] < VERSION
    count, found = len(order(scene)), len(data[SPEED.path])
    if count != found:
        yield f"it holds {found} states, its scene has {count}"
        return
    states = enumerate_states(scene)
    for name, values in states.datasets.items():
        if name not in data:
            if not older:  # whose layout has fewer
                yield f"{name} is missing, its scene has it"
        elif not _same(data[name], values):
            yield f"{name} holds something else than its scene gives"


def _same(found: Any, expected: Any) -> bool:
    if np.shape(found) != np.shape(expected):
        return False
    if np.asarray(expected).dtype.kind != "f":
        return bool((found == expected).all())
    size = np.nanmax(np.abs(expected), initial=0.0)
    return np.allclose(found, expected, rtol=_SAME, atol=_SAME * size, equal_nan=True)


def _of_plan(archive: reader.Archive, scene: Scene, plan: Plan) -> Iterator[str]:
    """What the same program would archive of the scene."""
    attributes, data = archive.attributes, archive.data
    given = of_scene(scene) | {"rules": json.dumps(sorted(plan.rules))}
    for name, value in given.items():
        if name in attributes and attributes[name] != value:  # older layouts have fewer
            found = np.asarray(attributes[name]).item()  # as Python writes it
            yield f"{name} says {found!r}, its scene gives {value!r}"
    for name, positions in plan.positions.items():
        if not _same(data.get(name), positions):
            yield f"{name} holds other positions than its scene gives"
    known, asked = table(), {quantity.path for quantity in plan.quantities}
    held = {name for name in archive.names if known[name].solved}
    yield from (f"{name} is missing, its scene asks for it" for name in sorted(asked - held))
    yield from (f"{name} is not what its scene asks for" for name in sorted(held - asked))


def _of_numbers(archive: reader.Archive) -> Iterator[str]:
    """Every number is read: finite, in balance, and what was said of it."""
    rules = json.loads(archive.attributes["rules"])
    failures = archive.data.get(runs.FAILURES.path, ())
    worst: dict[str, float] = {}
    for start in range(0, len(archive.data[SPEED.path]), _ROWS):
        rows = _solved(archive.rows(slice(start, start + _ROWS)), failures)
        if not len(rows[SPEED.path]):
            continue
        yield from (f"{name} is not finite in states {start} ..." for name in not_finite(rows))
        yield from _otherwise(rows, start)
        load = rows.get(LOAD.path, archive.attributes["load"])
        for comparison in compare.comparisons(rows, load, rules):
            worst[comparison.text] = float(np.max([worst.get(comparison.text, 0.0), comparison.value]))
            yield from _out_of_balance(comparison, start)
    for comparison in compare.comparisons(archive.data, archive.attributes["load"], IN_TIME & {*rules}):
        worst[comparison.text] = comparison.value
    told = json.loads(archive.attributes["comparisons"])
    if told.keys() != worst.keys() or any(
        not np.isclose(worst[text], told[text], rtol=_SAME, atol=0.0, equal_nan=True) for text in told
    ):
        yield f"its numbers give {worst}, its comparisons say {told}"


def _solved(rows: dict[str, Any], failures: Sequence[str]) -> dict[str, Any]:
    """The states that a solution was found for."""
    known, c = table(), rows[SPEED.path]
    failed = [x for x in np.unique(c) if any(text.startswith(f"c = {x:g}: ") for text in failures)]
    bad = np.isin(c, failed) & np.any(
        [
            ~np.isfinite(values)
            for name, values in rows.items()
            if known[name].solved and known[name].over == (STATE,) and known[name].nan_allowed == NEVER
        ],
        axis=0,
    )
    return {
        name: values[~bad] if known[name].over[:1] == (STATE,) else values
        for name, values in rows.items()
    }


def _otherwise(data: dict[str, Any], start: int) -> Iterator[str]:
    """What was computed from other datasets."""
    for name, row in table().items():
        if row.of_data is None or any(path not in data for path in (name, *row.needs)):
            continue
        if not np.allclose(data[name], row.of_data(data), rtol=_SAME, atol=1e-15, equal_nan=True):
            yield f"{name} is not what {', '.join(row.needs)} give in states {start} ..."


def _out_of_balance(comparison: compare.Comparison, start: int) -> Iterator[str]:
    """Forces that do not balance are a fault, whatever the verdict."""
    limit = compare.BALANCE.limit
    assert limit is not None
    if comparison.text == compare.BALANCE.text and not comparison.value <= limit:
        value = f"{comparison.value:.1e}, at most {limit:g}"
        yield f"{comparison.text} in states {start} ...: {value}"


def _of_verdict(archive: reader.Archive, scene: Scene) -> Iterator[str]:
    """The comparisons that it tells are judged once more."""
    attributes = archive.attributes
    rules = {
        compare.RULES[name].text: name
        for name in json.loads(attributes["rules"])
        if name in compare.RULES
    }
    judge = Judge(scene, rules.values())
    told = json.loads(attributes["comparisons"])
    judge.see([compare.Comparison(rules[text], text, told[text]) for text in told if text in rules])
    judge.failures = list(archive.data.get(runs.FAILURES.path, ()))
    verdict, reasons = judge.verdict()
    if attributes["verdict"] != verdict:
        yield f"verdict says {attributes['verdict']}, its comparisons give {verdict}"
    if json.loads(attributes["verdict_reasons"]) != reasons:
        yield f"verdict_reasons says {attributes['verdict_reasons']}, its comparisons give {reasons}"
