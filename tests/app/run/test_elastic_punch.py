"""Scenes with an elastic punch: both methods on random pairs."""

import numpy as np
import pytest
from support import THOROUGH, computed, scene_of

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


@pytest.mark.parametrize("seed", range(20 if THOROUGH else 3))
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
