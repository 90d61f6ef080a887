"""Small scenes that together name all that scenes can: where only code moves, archives stay.

They are run with two checkouts, and every dataset of one archive is compared with that of the other. Here
it is seen to that nothing new is missing among them.
"""

import tomllib
from functools import reduce
from pathlib import Path

import pytest

from galinx.app.plan.plan import make_plan
from galinx.app.scene.read import read
from galinx.app.scene.sections import SECTIONS, schema
from galinx.postprocess.quantities import QUANTITIES

SCENES = {path.stem: path for path in sorted(Path(__file__).parent.glob("*.toml"))}
TREES = {name: tomllib.loads(path.read_text(encoding="utf-8")) for name, path in SCENES.items()}
#: Scenes that are planned in a moment, and whose solutions give every quantity.
PLANNED = (
    "along", "along_a_cylinder", "coating", "cylinder", "elastic_punch", "elastic_punch_on_coating",
    "flat", "own_pressure", "pressure_on_coating", "speeds_of_a_cylinder", "steady", "third_power",
    "tilted_on_coating", "yield_along",
)  # fmt: skip
#: Known solids are constants, and no code of their own.
CONSTANTS = ("solid.material", "layer.material")


def texts(value):
    """All texts in a value."""
    if isinstance(value, list):
        return {text for entry in value for text in texts(entry)}
    return {value} if isinstance(value, str) else set()


def options(known):
    """All texts that a schema lets a value, or an entry of it, be one of."""
    nested = [*known.get("anyOf", []), known.get("items", {})]
    return texts(known.get("enum")) | {text for entry in nested if entry for text in options(entry)}


def properties(name):
    """Keys of a section with their schemas."""
    section = schema()
    for part in name.split("."):
        section = section["properties"][part]
        section = section.get("items", section)
    own = set() if name != "punch.solid" else properties("solid").keys()  # read by one reader
    return {key: known for key, known in section["properties"].items() if key not in own}


def values(section):
    """Values in all scenes by key of a section."""
    given = {}
    for tree in TREES.values():
        tables = reduce(lambda table, part: table.get(part, {}), section.split("."), tree)
        for table in tables if isinstance(tables, list) else [tables]:
            for key, value in table.items():
                given.setdefault(key, []).append(value)
    return given


@pytest.mark.parametrize("name", SCENES)
def test_it_is_a_scene(name):
    assert read(SCENES[name]).title


@pytest.mark.parametrize("section", SECTIONS)
def test_every_key_and_every_option_of_it_is_in_a_scene(section):
    given, known = values(section), properties(section)
    assert not known.keys() - given.keys()
    missing = {
        key: lacking
        for key, entry in known.items()
        if f"{section}.{key}" not in CONSTANTS
        and (lacking := options(entry) - texts(given[key]) - texts(entry.get("default")))
    }
    assert not missing


def test_every_quantity_of_a_solution_is_planned():
    planned = {quantity.path for name in PLANNED for quantity in make_plan(read(SCENES[name])).quantities}
    assert not {path for path, known in QUANTITIES.items() if known.solved} - planned
