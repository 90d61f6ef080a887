"""Scenes with an elastic punch: both methods on random pairs; what the punch bears."""

import json

import numpy as np
import pytest
from support import THOROUGH, computed, scene_of

from galinx.app.errors import BadInput
from galinx.app.results.result import compute, template

PUNCHES = (
    {"profile": "flat", "half_width": "1 mm"},
    {"profile": "flat", "half_width": "1 mm", "tilt": "0.05 deg"},
    {"profile": "parabolic", "radius": "20 mm"},
    {"profile": "power", "exponent": 4, "coefficient": 1e6},
)


def _solid(random):
    E = float(10 ** random.uniform(9.5, 11.5))
    if random.uniform() < 0.5:
        return {"E": E, "nu": random.uniform(0.05, 0.45), "rho": 2700}
    return {
        "kind": "orthotropic", "E1": E, "E2": E * random.uniform(0.2, 1.0), "E3": 0.3 * E, "nu12": 0.2,
        "nu13": 0.2, "nu23": 0.2, "G12": E * random.uniform(0.1, 0.4), "rho": 1600,
        "angle": random.uniform(-90.0, 90.0),
    }  # fmt: skip


def _limit(solid):
    of = scene_of("slider", {"solid": solid}).half_plane.solid
    return of.limit(), of.limit() * of.c_s


@pytest.mark.parametrize("seed", range(20) if THOROUGH else [1])
def test_both_methods_on_random_pairs_at_speed(seed):
    """The verdict compares them with the tolerance, and estimates with the differences.

    With hardly any friction the highest σ_XX is that of a free end, under a rigid punch to 1e-6 too.
    """
    random = np.random.default_rng(seed)
    plate, solid = _solid(random), _solid(random)
    friction, c = {"mu": random.uniform(0.1, 0.8)}, random.uniform(0.0, 0.8) * _limit(plate)[0]
    speed = random.choice([0.0, 0.7]) * random.uniform() * _limit(solid)[1]
    punch = PUNCHES[seed % 4] | {"load": "50 N/mm", "solid": solid | {"speed": float(speed)}}
    result = computed("tables4_5", {
        "solid": plate, "punch": punch, "friction": friction, "motion": {"c": float(c)},
    })  # fmt: skip
    assert result.verdict == "PASS", result.attributes
    assert np.all(result.data["states/fem/true_error"] <= result.data["states/fem/estimate"])


@pytest.mark.parametrize("seed", range(20) if THOROUGH else [2, 3])
def test_friction_along_the_contact_by_both_methods(seed):
    random = np.random.default_rng(seed)
    plate, solid, advected = _solid(random), _solid(random), bool(seed % 2)
    friction = {"along": [[-1, random.uniform(0.0, 0.7)], [1, random.uniform(0.0, 0.7)]]}
    if advected:
        friction = {"model": "dahl", "mu_c": random.uniform(0.1, 0.7), "state": "advected"}
        friction["sigma0_over_load"] = 10.0 ** random.uniform(2.5, 4.0)
    speed = 0.0 if advected else random.choice([0.0, 0.5]) * _limit(solid)[1]
    punch = PUNCHES[2 * (seed // 2 % 2)] | {"load": "50 N/mm", "solid": solid | {"speed": float(speed)}}
    c = float(random.uniform(0.0, 0.7) * _limit(plate)[0])
    result = computed("tables4_5", {
        "solid": plate, "punch": punch, "friction": friction, "motion": {"c": c},
        "solve": None, "output": None,
    })  # fmt: skip
    assert result.verdict == "PASS", result.attributes
    # Stresses in the punch have the opposite friction, which only a number has.
    assert not [name for name in result.data if "punch" in name.split("/")[-1]]
    methods = sorted({name.split("/")[1] for name in result.data if name.endswith("/resultant_ratio")})
    one, other = (result.data[f"states/{method}/resultant_ratio"] for method in methods)
    np.testing.assert_allclose(one, other, rtol=1e-6)


def test_what_rolls_carries_bristles_along():
    punch = PUNCHES[2] | {"load": "50 N/mm", "solid": {"material": "steel", "speed": "10 m/s"}}
    friction = {"model": "dahl", "mu_c": 0.3, "state": "advected", "sigma0_over_load": 1000}
    with pytest.raises(BadInput, match="bristles that a rolling punch carries along, too"):
        computed("tables4_5", {"punch": punch, "friction": friction, "motion": {"c": 0.1}})


def test_a_scene_says_which_body_yields_first():
    changes = {"motion.c": [0.0, 0.8], "output.quantities": ["yield"], "solve.methods": ["closed_form"]}
    result = compute(template("elastic_punch", changes))
    columns = {column.name: column.texts() for column in result.table()}
    assert columns["yields_first"] == ["punch", "plate"]
    own = "punch_von_mises", "punch_von_mises_Y", "punch_first_yield_load"
    assert {f"closed_form_{name}" for name in own} <= columns.keys()
    assert json.loads(result.attributes["solid"])["punch yield_strength"] == 235e6
    assert (result.data["states/closed_form/punch_von_mises_Y_over_a"] >= 0.0).all()


@pytest.mark.parametrize("profile", ["parabolic", "flat"])
def test_stresses_below_the_pressure_of_finite_elements_are_those_of_the_closed_form(profile):
    punch = {"parabolic": {}, "flat": {"punch.radius": None, "punch.half_width": "0.2 mm"}}[profile]
    output = {"output.points": [[0.2, -0.3], [-1.1, -0.05], [0.0, -4.0]], "solve.tolerance": 1e-4}
    quantities = ["interior", *["yield"] * (profile == "parabolic")]
    changes = {"motion.c": [0.4], "output.quantities": quantities, "punch.profile": profile}
    result = compute(template("elastic_punch", changes | punch | output))
    assert result.verdict == "PASS"
    assert (
        result.comparisons["stresses in the elastic punch, relative to themselves or the largest"] < 1e-6
    )
    for name in ("punch_von_mises", "punch_sigma_XY"):
        of_fem, exact = (result.data[f"interior/{of}/{name}"] for of in ("fem", "closed_form"))
        np.testing.assert_allclose(of_fem, exact, rtol=1e-5)
    if profile == "parabolic":
        loads = (result.data[f"states/{of}/punch_first_yield_load"] for of in ("fem", "closed_form"))
        np.testing.assert_allclose(*loads, rtol=1e-5)
