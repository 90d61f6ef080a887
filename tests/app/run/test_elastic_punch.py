"""Scenes with an elastic punch: both methods on random pairs, mirror images, and what is refused."""

import numpy as np
import pytest
from support import THOROUGH

import galinx
from galinx.app.errors import BadInput
from galinx.app.scene.read import parse

SCENE = """
[solid]
{plate}
[punch]
{punch}
load = "50 N/mm"
[punch.solid]
{solid}
speed = {speed}
[friction]
mu = {mu}
sign = "{sign}"
[motion]
c = {c}
[solve]
methods = {methods}
tolerance = 1e-6
[output]
quantities = ["friction", "sif", "surface"]
"""
PUNCHES = (
    'profile = "flat"\nhalf_width = "1 mm"',
    'profile = "flat"\nhalf_width = "1 mm"\ntilt = "0.05 deg"',
    'profile = "parabolic"\nradius = "20 mm"',
    'profile = "power"\nexponent = 4\ncoefficient = 1e6',
)
SIMPLE = dict(
    plate="E = 70e9\nnu = 0.33\nrho = 2700", punch=PUNCHES[2], solid="E = 3e9\nnu = 0.38\nrho = 1200",
    speed=0.0, mu=0.3, c=0.3, methods='["closed_form"]', sign="physical",
)  # fmt: skip


def _solid(random):
    E = 10 ** random.uniform(9.5, 11.5)
    if random.uniform() < 0.5:
        return f"E = {E}\nnu = {random.uniform(0.05, 0.45)}\nrho = 2700"
    return (
        f'kind = "orthotropic"\nE1 = {E}\nE2 = {E * random.uniform(0.2, 1.0)}\nE3 = {0.3 * E}\n'
        f"nu12 = 0.2\nnu13 = 0.2\nnu23 = 0.2\nG12 = {E * random.uniform(0.1, 0.4)}\nrho = 1600\n"
        f"angle = {random.uniform(-90.0, 90.0)}"
    )


def _limit(solid):
    of = parse(SCENE.format(**SIMPLE | {"plate": solid})).half_plane.solid
    return of.limit(), of.limit() * of.c_s


@pytest.mark.parametrize("seed", range(20 if THOROUGH else 3))
def test_both_methods_on_random_pairs_at_speed(seed):
    """The verdict compares them with the tolerance, and estimates with the differences.

    With hardly any friction the highest σ_XX is that of a free end, under a rigid punch to 1e-6 too.
    """
    random = np.random.default_rng(seed)
    plate, solid = _solid(random), _solid(random)
    values = {
        "plate": plate, "solid": solid, "punch": PUNCHES[seed % 4], "mu": random.uniform(0.1, 0.8),
        "c": random.uniform(0.0, 0.8) * _limit(plate)[0],
        "speed": random.choice([0.0, 0.7]) * random.uniform() * _limit(solid)[1],
        "methods": '["closed_form", "fem"]', "sign": "physical",
    }  # fmt: skip
    result = galinx.compute(parse(SCENE.format(**values)))
    assert result.verdict == "PASS", result.attributes
    assert np.all(result.data["states/fem/true_error"] <= result.data["states/fem/estimate"])


@pytest.mark.parametrize(
    "changes, says",
    [
        ({"speed": 2000.0}, "expected less than 894.03"),
        ({"solid": 'E = 3e9\nnu = 0.38\nrho = 1200\nplane = "stress"'}, "punch.solid.plane"),
        ({"plate": 'material = "steel"\n[[layer]]\nthickness = 1e-3\nmaterial = "TiN"'}, "layer"),
        ({"methods": '["fem"]\nmode = "traction"'}, "solve.mode"),
        ({"solid": "nu = 0.38\nrho = 1200"}, "punch.solid.E: missing"),
    ],
)
def test_what_is_refused(changes, says):
    with pytest.raises(BadInput, match=says):
        parse(SCENE.format(**SIMPLE | changes))


def test_a_plate_beyond_its_limit_is_refused():
    with pytest.raises(BadInput, match="along the plate's surface"):
        galinx.compute(parse(SCENE.format(**SIMPLE | {"c": 0.95})))
