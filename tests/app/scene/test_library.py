"""Solids that a scene can name."""

import pytest

from galinx import template
from galinx.app.errors import BadInput
from galinx.app.scene.library import LIBRARY
from galinx.app.scene.read import parse


def test_a_known_solid_gives_its_constants_and_the_scene_may_differ():
    scene = template("fig5")
    assert (scene.solid.E, scene.solid.ν, scene.solid.ρ) == (193e9, 0.25, 7860.0)
    scene = template("fig5", {"solid.material": "PMMA", "solid.nu": 0.33})
    assert (scene.solid.E, scene.solid.ν, scene.solid.ρ) == (3.3e9, 0.33, 1190.0)


def test_another_solid_replaces_the_constants_of_the_old_one():
    solid = template("own_material", {"solid.material": "steel", "solid.rho": 8000}).solid
    assert (solid.E, solid.ν, solid.ρ) == (210e9, 0.3, 8000.0)


def test_without_constants_a_solid_may_be_named():
    with pytest.raises(BadInput, match=r"or solid\.material"):
        parse("[friction]\nmu_c = 0.5\nsigma0_over_load = 1e4\n[motion]\nc = 0.1\n")
    with pytest.raises(BadInput, match="unobtainium"):
        template("fig5", {"solid.material": "unobtainium"})


@pytest.mark.parametrize("name", LIBRARY)
def test_every_known_solid_is_one(name):
    solid = template("fig5", {"solid.material": name}).solid
    soft, hard = {"rubber": (20.0, 35.0), "PTFE": (250.0, 350.0)}, ("DLC", "Al2O3", "Si3N4")
    slow, fast = soft.get(name, (500.0, 7500.0 if name in hard else 6000.0))
    assert LIBRARY[name].source and slow < solid.c_s < fast


def test_another_kind_of_solid_replaces_the_constants_of_the_old_one():
    changes = {"solid.kind": "cubic", "solid.c11": "165.7 GPa", "solid.c12": "63.9 GPa"}
    solid = template("fig5", changes | {"solid.c44": "79.6 GPa", "solid.rho": 2330}).solid
    assert (solid.c11, solid.ρ, solid.angle) == (165.7e9, 2330.0, 0.0)
