"""The schema that editors check scenes with."""

import tomllib

import pytest
from support import HOME

from galinx.app.scene.sections import schema

jsonschema = pytest.importorskip("jsonschema")


def test_every_scene_of_the_project_follows_the_schema():
    jsonschema.Draft7Validator.check_schema(schema())
    validator = jsonschema.Draft7Validator(schema())
    scenes = sorted((HOME / "scenes").glob("*.toml"))
    assert len(scenes) >= 5
    for path in scenes:
        faults = [
            error.message for error in validator.iter_errors(tomllib.loads(path.read_text("utf-8")))
        ]
        assert not faults, f"{path.name}: {faults}"


@pytest.mark.parametrize(
    "scene",
    [
        {"solid": {"nuu": 0.25}},
        {"sloid": {}},
        {"solve": {"mesh": "round"}},
        {"friction": {"mu_c": True}},
        {"motion": {"c": {"from": 0, "to": 0.9}}},
        {"motion": {"c": {"from": 0, "to": 0.9, "number": 1}}},
        {"motion": {"c": {"from": 0, "to": 0.9, "number": 3, "step": 1}}},
    ],
)
def test_faults_are_against_the_schema(scene):
    whole = tomllib.loads((HOME / "scenes" / "tables4_5.toml").read_text(encoding="utf-8"))
    validator = jsonschema.Draft7Validator(schema())
    ranges = whole | {"motion": {"c": {"from": 0, "to": "0.9", "number": 3, "spacing": "linear"}}}
    assert validator.is_valid(whole) and validator.is_valid(ranges)
    changed = {name: whole.get(name, {}) | keys for name, keys in scene.items()}
    assert not validator.is_valid(whole | changed)
