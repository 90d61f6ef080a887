"""Scenes that name a solid, are changed from outside, or ask for a map."""

import json

import numpy as np
import pytest
from conftest import HOME, command

from galinx.app.errors import BadInput
from galinx.app.plan.states import solid_of
from galinx.app.scene.changes import changed, from_words
from galinx.app.scene.materials import LIBRARY
from galinx.app.scene.scene import parse, read
from galinx.app.scene.templates import templates

SCENE = HOME / "scenes" / "tables4_5.toml"


def test_a_change_stands_in_the_text_and_comments_stay():
    text = SCENE.read_text(encoding="utf-8")
    result = changed(text, {"friction.mu_c": [0.3, 0.5], "solve.tolerance": 1e-4})
    assert "mu_c = [0.3, 0.5]" in result and "tolerance = 0.0001" in result
    assert result.count("#") == text.count("#") and "# σ₀ l/N" in result
    assert parse(result).friction.mu_c == (0.3, 0.5)


def test_words_are_toml_values_or_texts():
    changes = from_words(
        ["friction.mu_c=[0.3, 0.5]", "solid.E=70 GPa", "title=Two words", "motion.c=0.1"]
    )
    assert changes == {
        "friction.mu_c": [0.3, 0.5], "solid.E": "70 GPa", "title": "Two words", "motion.c": 0.1
    }  # fmt: skip


@pytest.mark.parametrize("word", ["friction.mu_c", "=0.5", " =1"])
def test_words_without_key_or_value_are_refused(word):
    with pytest.raises(BadInput, match=r"section\.key=value"):
        from_words([word])


@pytest.mark.parametrize("key", ["friction", "a.b.c", "mu_c"])
def test_keys_name_section_and_key(key):
    with pytest.raises(BadInput, match="cannot be changed"):
        read(SCENE, {key: 1.0})


def test_a_change_that_makes_no_sense_is_refused_like_any_scene():
    with pytest.raises(BadInput, match="did you mean mu_c"):
        read(SCENE, {"friction.mu_cc": 0.5})


def test_the_archive_holds_the_changed_scene(tmp_path):
    done = command("run", SCENE, "-o", tmp_path / "a.h5", "--set", "friction.mu_c=0.25", "--set",
                   'solve.methods=["closed_form"]', cwd=tmp_path)  # fmt: skip
    assert done.returncode == 0, done.stderr
    shown = json.loads(command("show", tmp_path / "a.h5", "--json").stdout)
    assert {state["mu_c"] for state in shown["states"]} == {0.25}
    from galinx.postprocess.hdf5.archive import read as read_archive

    data, _ = read_archive(tmp_path / "a.h5")
    assert "mu_c = 0.25" in data["scene/text"]


def test_a_known_solid_gives_its_constants_and_the_scene_may_differ():
    scene = parse(templates()["fig5"].text)
    assert (scene.solid.E, scene.solid.nu, scene.solid.rho) == (193e9, 0.25, 7860.0)
    scene = parse(changed(templates()["fig5"].text, {"solid.material": "PMMA", "solid.nu": 0.33}))
    assert (scene.solid.E, scene.solid.nu, scene.solid.rho) == (3.3e9, 0.33, 1190.0)


def test_another_solid_replaces_the_constants_of_the_old_one():
    text = changed(templates()["own_material"].text, {"solid.material": "steel", "solid.rho": 8000})
    solid = parse(text).solid
    assert (solid.E, solid.nu, solid.rho) == (210e9, 0.3, 8000.0)


def test_without_constants_a_solid_may_be_named():
    with pytest.raises(BadInput, match=r"or solid\.material"):
        parse("[friction]\nmu_c = 0.5\nsigma0_over_load = 1e4\n[motion]\nc = 0.1\n")
    with pytest.raises(BadInput, match="unobtainium"):
        parse(changed(templates()["fig5"].text, {"solid.material": "unobtainium"}))


@pytest.mark.parametrize("name", LIBRARY)
def test_every_known_solid_is_one(name):
    solid = solid_of(parse(changed(templates()["fig5"].text, {"solid.material": name})))
    assert LIBRARY[name].source and 500.0 < solid.c_s < 5000.0


def test_a_map_lists_its_points_by_rows_before_the_single_ones():
    text = changed(
        templates()["inside"].text,
        {"output.map": {"X": [-1, 1, 3], "Y": [-2, -1, 2]}, "output.points": [[5.0, -5.0]]},
    )
    assert np.array_equal(
        parse(text).output.inside,
        [(-1, -2), (0, -2), (1, -2), (-1, -1), (0, -1), (1, -1), (5, -5)],
    )


@pytest.mark.parametrize(
    "value, message",
    [
        ([1], "X = "),
        ({"X": [-1, 1, 3]}, "X = "),
        ({"X": [-1, 1], "Y": [-2, -1, 2]}, "from, to, number"),
        ({"X": [1, -1, 3], "Y": [-2, -1, 2]}, "from < to"),
        ({"X": [-1, 1, 3], "Y": [-2, 0, 2]}, "Y/a < 0"),
        ({"X": [-1, 1, 2.5], "Y": [-2, -1, 2]}, "from < to"),
    ],
)
def test_maps_that_are_none_are_refused(value, message):
    with pytest.raises(BadInput, match=message):
        parse(changed(templates()["inside"].text, {"output.map": value}))


def test_init_writes_a_scene_once(tmp_path):
    assert command("init", "own_material", "-o", "mine.toml", cwd=tmp_path).returncode == 0
    scene = read(tmp_path / "mine.toml")
    assert scene.solid.E == 3.3e9 and "#:schema" not in scene.text
    before = (tmp_path / "mine.toml").read_bytes()
    again = command("init", "tables4_5", "-o", "mine.toml", cwd=tmp_path)
    assert again.returncode == 2 and "exists" in again.stderr
    assert (tmp_path / "mine.toml").read_bytes() == before
    unknown = command("init", "fig99", cwd=tmp_path)
    assert unknown.returncode == 2 and "own_material" in unknown.stderr
    listed = command("init", cwd=tmp_path).stdout
    assert all(name in listed for name in templates())
