"""Is an archive whole, and does it say what its numbers say?"""

import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from galinx.postprocess import compare
from galinx.postprocess.finite import not_finite
from galinx.postprocess.hdf5 import archive
from galinx.postprocess.quantities import Quantity, table
from galinx.postprocess.quantities.quantity import STATE
from galinx.postprocess.quantities.runs import FAILURES, SCENE
from galinx.postprocess.quantities.states import NORMAL_FORCE, RATIO

#: States looked at together.
_ROWS = 1000


def faults(path: Path) -> list[str]:
    """What is wrong with an archive, one sentence each; every byte of it is read.

    Raises:
        UnreadableArchive: a checksum fails, or it is no archive at all.
    """
    data, attributes = archive.read(path, stresses=False)
    known = table()
    found = []
    if not attributes.get("complete"):
        found.append("it does not say that it is complete")
    if hashlib.sha256(data[SCENE.path].encode()).hexdigest() != attributes["scene_sha256"]:
        found.append(f"{SCENE.path} has another hash than scene_sha256 says")
    states = len(data[RATIO.path])
    found += _layout(path, states, known)
    rules = json.loads(attributes.get("rules", json.dumps(list(compare.RULES))))
    worst: dict[str, float] = {}
    failed = data.get(FAILURES.path, [])
    for start in range(0, states, _ROWS):
        rows = archive.read_rows(path, slice(start, start + _ROWS))
        solved = _solved(rows) if len(failed) else rows
        found += [f"{name} is not finite in states {start} ..." for name in not_finite(solved)]
        for comparison in compare.comparisons(solved, attributes["load"], rules):
            worst[comparison.text] = float(np.max([worst.get(comparison.text, 0.0), comparison.value]))
            found += _out_of_balance(comparison, start)
    told = json.loads(attributes["comparisons"])
    if told.keys() != worst.keys() or any(
        not np.isclose(worst[text], told[text], rtol=1e-9, equal_nan=True) for text in told
    ):
        found.append(f"its numbers give {worst}, its comparisons say {told}")
    return found


def _layout(path: Path, states: int, known: dict[str, Quantity]) -> list[str]:
    found = []
    for name, (unit, shape) in archive.described(path).items():
        if name not in known:
            found.append(
                f"{name} is not in the table of datasets; is it registered by a file of yours (-x)?"
            )
        elif unit != known[name].unit:
            found.append(f"{name} has the unit {unit!r}, expected {known[name].unit!r}")
        elif known[name].over == (STATE,) and shape != (states,):
            found.append(f"{name} has the shape {shape}, expected {states} states")
    return found


def _out_of_balance(comparison: compare.Comparison, start: int) -> Iterator[str]:
    """Forces that do not balance are a fault, whatever the verdict."""
    limit = compare.BALANCE.limit
    assert limit is not None
    if comparison.text == compare.BALANCE.text and not comparison.value <= limit:
        value = f"{comparison.value:.1e}, at most {limit:g}"
        yield f"{comparison.text} in states {start} ...: {value}"


def _solved(rows: dict[str, Any]) -> dict[str, Any]:
    """The states whose speed could be solved."""
    force = rows.get(NORMAL_FORCE.path)
    if force is None or np.isfinite(force).all():
        return rows
    good, count = np.isfinite(force), len(force)
    return {
        name: values[good] if np.shape(values)[:1] == (count,) else values
        for name, values in rows.items()
    }
