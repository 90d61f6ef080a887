"""Sweeps: scenes in which numbers that fix the problem are lists or ranges.

Speeds, loads and the parameters of friction laws have several values in any scene, and one solution
serves many of them. A number of a solid, a layer or a punch makes another problem: a scene with several
values of it stands for several scenes, its variants, one for each combination of values.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from math import prod
from typing import Any

from ..errors import listed
from .library import LIBRARY
from .sections import SECTIONS, SWEPT, Key
from .values import Number, Numbers

#: Keys of a range.
_RANGE = {"from", "to", "number"}
#: Most variants of a scene.
MOST = 10_000


@dataclass(frozen=True)
class Sweep:
    """Swept numbers of a scene.

    Attributes:
        values: values in SI by key, as ``"layer[0].thickness"``; the last key changes fastest.
    """

    values: Mapping[str, tuple[float, ...]]

    def __len__(self) -> int:
        return prod(map(len, self.values.values()))

    def __iter__(self) -> Iterator[dict[str, float]]:
        """Values of every variant by key."""
        for values in product(*self.values.values()):
            yield dict(zip(self.values, values))


def read_sweep(tree: Mapping[str, Any], faults: list[str]) -> Sweep:
    """Swept numbers of a scene.

    Args:
        tree: the scene as TOML gives it, with the constants of materials.
        faults: list to which messages are added.
    """
    values: dict[str, tuple[float, ...]] = {}
    for path, key, given in _several(tree):
        try:
            values[path] = tuple(dict.fromkeys(Numbers(key.kind.unit, key.kind.bounds)(given)))  # type: ignore[attr-defined]
        except ValueError as error:
            faults.append(f"{path} ({key.about}): {error}")
    sweep = Sweep(values)
    if len(sweep) > MOST:
        faults.append(f"{listed([*values])}: found {len(sweep)} combinations, expected at most {MOST}")
    if values and (other := [name for name in ("time", "slider") if name in tree]):
        faults.append(
            f"{listed([*values])}: found several values beside [{other[0]}], which is of a single solid "
            "and punch; expected one value each"
        )
    return sweep


def _several(tree: Mapping[str, Any]) -> Iterator[tuple[str, Key, Any]]:
    """Path, key and value of every number that is a list or a range."""
    for name, given in tree.items():
        if name not in SWEPT:
            continue
        single = [(name, given)] if name != "layer" else []
        if name == "layer" and isinstance(given, list):
            single = [(f"layer[{i}]", table) for i, table in enumerate(given)]
        for path, table in single:
            if not isinstance(table, dict):
                continue
            material = LIBRARY.get(table["material"]) if isinstance(table.get("material"), str) else None
            keys = SECTIONS[name].keys(({"kind": material.kind} if material else {}) | table)
            for key, value in table.items():
                several = isinstance(value, list) or (isinstance(value, dict) and value.keys() & _RANGE)
                if several and key in keys and type(keys[key].kind) is Number:
                    yield f"{path}.{key}", keys[key], value


def with_values(tree: dict[str, Any], values: Mapping[str, float]) -> dict[str, Any]:
    """A scene of one value of every swept number."""
    variant = dict(tree)
    for path, value in values.items():
        section, _, key = path.partition(".")
        name, bracket, number = section.partition("[")
        if bracket:
            tables = list(variant[name])
            i = int(number[:-1])
            tables[i] = tables[i] | {key: value}
            variant[name] = tables
        else:
            variant[name] = variant[name] | {key: value}
    return variant


def words(values: Mapping[str, float]) -> str:
    """Values of a variant in words, as ``solid.E = 2e+11``."""
    return ", ".join(f"{key} = {value:g}" for key, value in values.items())
