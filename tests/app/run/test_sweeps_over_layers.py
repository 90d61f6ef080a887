"""Many speeds over layers, of which finite elements solve few: all against the integral equation."""

from dataclasses import replace

import numpy as np
import pytest
from agreement import check
from layers_cases import random_stack
from support import THOROUGH
from test_layers_fem import scene_of

import galinx
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids.isotropic import Isotropic

HARD, SOFT = Isotropic(7.5, 0.3, 1.2), Isotropic(2.5, 0.25, 1.0)
ALL = ("sif", "surface", "interfaces")


def sweep(solid, c, f, quantities, tolerance):
    """Speeds over c_s under frictions of both directions."""
    one = scene_of(solid, 0.0, f, quantities, tolerance)
    motion = replace(one.motion, c=tuple(c.tolist()), strokes=("forward", "backward"))
    return galinx.compute(replace(one, motion=motion))


@pytest.mark.parametrize(
    ("top", "below", "tolerance", "quantities"),
    [(HARD, SOFT, 1e-4, ("sif",)), (SOFT, HARD, 1e-2, ("sif", "surface"))],
    ids=["hard on soft", "soft on hard"],
)
def test_a_dozen_speeds_tell_all_up_to_the_limit(top, below, tolerance, quantities):
    solid = Layered((Layer(0.7, top),), below)
    c = np.linspace(0.0, 0.98, 24) * solid.limit()
    data = sweep(solid, c, 0.4, quantities, tolerance).data
    # Eleven for the fit, and two that measure its error at the ends of the sweep.
    assert np.count_nonzero(data["run/fem/factorisations"]) <= 13
    check(data, tolerance)


@pytest.mark.skipif(not THOROUGH, reason="half an hour")
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("graded", [False, True])
def test_all_speeds_of_random_stacks(seed, graded):
    rng, (solid, _) = np.random.default_rng(300 + seed), random_stack(seed, graded)
    c = np.sort(rng.uniform(0.0, rng.uniform(0.5, 0.98), 24)) * solid.limit()
    tolerance = 10.0 ** rng.uniform(-6.0, -3.0)
    data = sweep(solid, c, rng.uniform(0.1, 1.0), ALL, tolerance).data
    print(seed, graded, f"{tolerance:.0e}", np.count_nonzero(data["run/fem/factorisations"]), "solved")
    check(data, tolerance)
