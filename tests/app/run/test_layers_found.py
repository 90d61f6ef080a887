"""Contacts over layers whose ends are found: the integral equation, finite elements, archives."""

import json
import os
import sys
from dataclasses import replace
from pathlib import Path
from time import process_time

import numpy as np
import pytest

import galinx
from galinx.app.scene.read import parse
from galinx.postprocess import scale
from galinx.solvers.layers.contact import Equation
from galinx.solvers.layers.found import SHAPES, FoundSpeed, Parabola
from galinx.solvers.profiles.parabolic import Parabolic

sys.path.insert(0, str(Path(__file__).parents[2] / "solvers" / "layers"))
from test_layers import COAT, SCENE
from test_layers_fem import scene_of
from test_stack import random_stack

THOROUGH = bool(os.environ.get("GALINX_THOROUGH"))
PUNCH = '[punch]\nprofile = "parabolic"\nradius = "20 mm"\nload = {load}\n'
PARTS = ("sigma_YY", "sigma_XY", "sigma_XX_above", "sigma_XX_below")


def scene(layers=COAT, mu=0.4, tolerance=1e-6, methods=("sie",), quantities=("sif",), load=1e5, more=""):
    text = SCENE.format(
        layers=layers, mu=mu, tolerance=tolerance, methods=json.dumps(list(methods)),
        quantities=json.dumps(list(quantities)),
    )  # fmt: skip
    return parse(text.replace("[friction]", PUNCH.format(load=load) + "[friction]") + more)


def random_scene(seed, graded, quantities=("sif",), tolerance=1e-6):
    """A random stack under a cylinder whose contact has the half-width 1 m at rest without friction."""
    solid, c = random_stack(seed, graded)
    f = np.random.default_rng(2000 + seed).uniform(-1.0, 1.0)
    base = scene_of(solid, c, f, quantities, tolerance)
    load, response = 1e-3, solid.response(0.0)
    speed = FoundSpeed(response, response.stack(1.0), np.zeros_like, 1e-4)
    parts = Equation(response, speed.kernel, 0.0, np.zeros_like).parts(
        0.5 if speed.kernel.rough else 60, SHAPES, (-2.0, 0.0, 0.0)
    )
    _, _, off = Parabola(1.0, load / solid.μ).balanced(parts.ends, 1.0)
    profile = Parabolic(float(np.exp(off)))
    return replace(base, punch=replace(base.punch, profile=profile, loads=(load,)))


def apart(data):
    """Relative differences of both methods, by the estimate's name."""
    h = data["states/sie/half_width"]
    found = {
        "": max(
            float((np.abs(data[f"states/fem/{name}"] - data[f"states/sie/{name}"]) / h).max())
            for name in ("half_width", "centre")
        )
    }
    if "surface/fem/sigma_XX" in data:
        σ = [data[f"surface/{by}/sigma_XX"] for by in ("fem", "sie")]
        size = scale.of_in_plane(σ[1], data["surface/X_over_a"])
        found["_sigma_XX"] = float((np.abs(σ[0] - σ[1]) / size).max())
    if "interfaces/fem/sigma_YY" in data:
        both = [np.array([data[f"interfaces/{by}/{name}"] for name in PARTS]) for by in ("fem", "sie")]
        found["_interfaces"] = float((np.abs(both[0] - both[1]) / scale.of_interfaces(both[1])).max())
    return found


@pytest.mark.parametrize(
    ("seed", "graded"),
    [(seed, graded) for seed in range(15) for graded in (False, True)] if THOROUGH else [(7, False)],
)
def test_random_stacks(seed, graded):
    """Ends and, with all of it, the surface and interfaces: within the tolerance and the estimates."""
    start = process_time()
    quantities = ("sif", "surface", "interfaces") if THOROUGH else ("sif",)
    data = galinx.compute(random_scene(seed, graded, quantities)).data
    row = [f"seed {seed}, {'graded' if graded else 'uniform'}: {process_time() - start:.0f} s"]
    found = apart(data)
    estimates = {
        what: [data[f"states/{by}/estimate{what}"][0] for by in ("fem", "sie")] for what in found
    }
    for what, difference in found.items():
        row.append(f"{what.strip('_') or 'ends'} {difference:.1e} of {estimates[what][0]:.1e}")
    print(", ".join(row))
    for what, difference in found.items():
        assert difference <= sum(estimates[what])
        assert difference <= 1e-6
        assert estimates[what][0] <= 1e-6
