"""Is an archive whole, and does it say what its numbers say?"""

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np

from galinx.postprocess import compare
from galinx.postprocess.hdf5 import archive
from galinx.postprocess.quantities import FIELDS

#: States looked at together.
_ROWS = 1000

#: Where NaN is an answer: outside the contact, and where no exponent can be fitted.
_MAY_BE_NAN = ("sigma_YY", "sigma_YY_raw", "fem/alpha", "fem/beta")


def faults(path: Path, balance: float) -> list[str]:
    """What is wrong with an archive, one sentence each; every byte of it is read.

    Args:
        path: the archive.
        balance: largest imbalance of nodal forces, over N.

    Raises:
        UnreadableArchive: a checksum fails, or it is no archive at all.
    """
    data, attributes = archive.read(path, stresses=False)
    found = []
    if not attributes.get("complete"):
        found.append("it does not say that it is complete")
    if hashlib.sha256(data["scene/text"].encode()).hexdigest() != attributes["scene_sha256"]:
        found.append("scene/text has another hash than scene_sha256 says")
    states = len(data["states/g"])
    found += _layout(path, states)
    worst: dict[str, float] = {}
    failed = data.get("run/failures", [])
    for start in range(0, states, _ROWS):
        rows = archive.read_rows(path, slice(start, start + _ROWS))
        found += _not_finite(rows, start, bool(len(failed)))
        for comparison in compare.comparisons(_solved(rows), attributes["load"]):
            worst[comparison.text] = max(worst.get(comparison.text, 0.0), comparison.value)
            if comparison.name == compare.BALANCE and not comparison.value <= balance:
                value = f"{comparison.value:.1e}, at most {balance:g}"
                found.append(f"{comparison.text} in states {start} ...: {value}")
    told = json.loads(attributes["comparisons"])
    if told.keys() != worst.keys() or any(
        not np.isclose(worst[text], told[text], rtol=1e-9) for text in told
    ):
        found.append(f"its numbers give {worst}, its comparisons say {told}")
    return found


def _layout(path: Path, states: int) -> list[str]:
    found = []
    for name, (unit, shape) in archive.described(path).items():
        if name not in FIELDS:
            found.append(f"{name} is not in the table of datasets")
        elif unit != FIELDS[name][0]:
            found.append(f"{name} has the unit {unit!r}, expected {FIELDS[name][0]!r}")
        elif name.startswith("states/") and shape != (states,):
            found.append(f"{name} has the shape {shape}, expected {states} states")
    return found


def _not_finite(rows: dict[str, Any], start: int, failures: bool) -> list[str]:
    """Datasets with a NaN or an infinity that is not an answer."""
    found = []
    for name, values in rows.items():
        if np.asarray(values).dtype.kind != "f" or (failures and "/fem/" in name):
            continue
        bad = np.isinf(values) if name.endswith(_MAY_BE_NAN) else ~np.isfinite(values)
        if name.startswith("surface/") and name.endswith(_MAY_BE_NAN):
            bad = bad | (np.isnan(values) & (np.abs(rows["surface/X_over_a"]) < 1.0))
        if bad.any():
            found.append(f"{name} is not finite in states {start} ...")
    return found


def _solved(rows: dict[str, Any]) -> dict[str, Any]:
    """The states whose speed could be solved."""
    force = rows.get("states/fem/normal_force")
    if force is None or np.isfinite(force).all():
        return rows
    good, count = np.isfinite(force), len(force)
    return {
        name: values[good] if np.shape(values)[:1] == (count,) else values
        for name, values in rows.items()
    }
