"""Solids that a scene can name."""

import pytest

from galinx import template
from galinx.app.scene.library import LIBRARY


def test_a_known_solid_gives_its_constants_and_the_scene_may_differ():
    scene = template("fig5")
    assert (scene.solid.E, scene.solid.ν, scene.solid.ρ) == (193e9, 0.25, 7860.0)
    scene = template("fig5", {"solid.material": "PMMA", "solid.nu": 0.33})
    assert (scene.solid.E, scene.solid.ν, scene.solid.ρ) == (3.3e9, 0.33, 1190.0)


def test_another_solid_replaces_the_constants_of_the_old_one():
    solid = template("own_material", {"solid.material": "steel", "solid.rho": 8000}).solid
    assert (solid.E, solid.ν, solid.ρ) == (210e9, 0.3, 8000.0)


@pytest.mark.parametrize("name", LIBRARY)
def test_every_known_solid_is_one(name):
    solid = template("fig5", {"solid.material": name}).solid
    soft, hard = {"rubber": (20.0, 35.0), "PTFE": (250.0, 350.0)}, ("DLC", "Al2O3", "Si3N4")
    slow, fast = soft.get(name, (500.0, 7500.0 if name in hard else 6000.0))
    assert LIBRARY[name].source and slow < solid.c_s < fast
