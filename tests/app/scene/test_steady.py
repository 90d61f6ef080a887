"""Scenes of steady sliding: without strokes a law without memory has one state at each speed."""

import numpy as np
import pytest

from galinx import template
from galinx.app.errors import BadInput
from galinx.app.results.result import compute
from galinx.app.scene.read import parse
from galinx.app.scene.scene import oddities
from galinx.postprocess.quantities import states, validity, yielding

CYLINDER = """
[solid]
material = "BK7"
[punch]
profile = "parabolic"
radius = "5 mm"
load = "100 N/mm"
[friction]
mu = 0.15
[motion]
speed = "1 m/s"
"""


def test_mu_alone_is_coulombs_law():
    scene = parse(CYLINDER)
    given = parse(CYLINDER.replace("mu = 0.15", 'model = "coulomb"\nmu_c = 0.15'))
    assert scene.friction == given.friction and scene.steady and given.steady


def test_a_scene_without_strokes_is_one_state_at_each_speed_and_asks_for_what_the_solid_bears():
    scene = parse(
        CYLINDER.replace('"1 m/s"', '["1 m/s", "2 m/s"]') + '[solve]\nmethods = ["closed_form"]'
    )
    result = compute(scene)
    assert len(result.data[states.SPEED.path]) == 2
    assert not [text for text in result.attributes["warnings"] if "stroke" in text]
    assert np.isnan(result.data[validity.CROSSINGS.path]).all()
    assert result.data[yielding.VON_MISES["closed_form"].path].shape == (2,)
    assert yielding.FIRST_LOAD["closed_form"].path not in result.data  # without a yield strength


def test_two_names_of_a_number_are_one_too_many():
    with pytest.raises(BadInput, match=r"1 fault:\s+friction: mu and mu_c exclude each other"):
        parse(CYLINDER.replace("mu = 0.15", "mu = 0.15\nmu_c = 0.15"))


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("mu = 0.15", "mu = 0,15", "found 0,15 in line 9, expected a decimal point, as in 0.15"),
        ('"5 mm"', "5 mm", 'found 5 mm in line 6, expected quotes around a number and unit, "5 mm"'),
        ('"1 m/s"', "1 m/s # fast", "found 1 m/s in line 11, expected quotes"),
        ('"5 mm"', '"5,5 mm"', "decimals have a point"),
        ("mu = 0.15", "mu = 0.15\ndelta = 1", 'no such key of model = "coulomb"; dahl has it'),
    ],
)
def test_messages_say_what_to_write(old, new, message):
    with pytest.raises(BadInput) as raised:
        parse(CYLINDER.replace(old, new))
    assert message in str(raised.value)


def test_a_steep_punch_is_warned_about():
    steep = 'profile = "table"\nshape = [[-1, 1], [0, 0], [1, 1]]'
    scene = parse(CYLINDER.replace('profile = "parabolic"\nradius = "5 mm"', steep))
    assert any("slopes are up to 1," in text for text in oddities(scene))


def test_a_contact_as_wide_as_its_cylinder_is_warned_about():
    """Slopes under the contact are half-width over radius."""
    changes = {"punch.radius": "5 mm", "solid.E": "2 MPa", "solid.nu": 0.4}
    narrow, wide = (template("cylinder", changes | {"punch.load": load}) for load in ("1 N/m", "1e4 N/m"))
    a = wide.body.half_width
    assert a > 1e-3 and any(f"slopes of {a / 5e-3:.2g}, " in text for text in oddities(wide))
    assert not any("slopes of" in text for text in oddities(narrow))
