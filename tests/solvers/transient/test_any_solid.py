"""Starts from rest on solids of every kind by both methods."""

import numpy as np
import pytest
from random_solids import isotropic_as, random_solid
from started import THOROUGH, ByFiniteElements, by_integral_equation

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import smooth


def test_isotropic_solid_may_be_given_as_any_other():
    """At an angle, too; roots of shear and pressure waves stay apart or meet alike."""
    solid = Isotropic(1.0, 0.3, 1.0)
    known = by_integral_equation(solid, 0.5, -0.4, 4.0, 10)
    for kind in ("orthotropic", "anisotropic"):
        found = by_integral_equation(isotropic_as(kind, solid, 33.0), 0.5, -0.4, 4.0, 10)
        for name in ("v0", "load", "K_left", "K_right"):
            np.testing.assert_allclose(getattr(found, name), getattr(known, name), atol=1e-8)


def differences(solid, share, g, end, steps, **mesh):
    """Of v₀, centre, and K_I at both ends, over the largest, at a share of the speed limit."""
    c = share * solid.limit()
    started, exact = ByFiniteElements(solid, c, end, steps, **mesh), FlatPunch(solid.response(c), g)
    run = started.run(g, lambda t: smooth(t, 3.0))
    found = started.told(run, exact.α, exact.β)
    expected = by_integral_equation(solid, c, g, end, steps, terms=24)
    size = max(np.abs(expected.K_left).max(), np.abs(expected.K_right).max())
    return [
        np.abs(run.v0 - expected.v0).max() / np.abs(expected.v0).max(),
        np.abs((found.centre - expected.centre) * expected.load).max(),
        np.abs(found.K_left - expected.K_left).max() / size,
        np.abs(found.K_right - expected.K_right).max() / size,
    ]


def test_both_methods_agree_on_a_rotated_solid():
    assert max(differences(random_solid(1), 0.6, -0.4, 3.0, 20)) < 5e-4


@THOROUGH
@pytest.mark.parametrize("seed", range(8))
def test_both_methods_agree_on_random_solids(seed):
    """What is left is K_I of the finite elements at strongly singular ends."""
    rng = np.random.default_rng(seed)
    share, g = rng.uniform(0.0, 0.85), rng.uniform(-0.7, 0.7)
    found = differences(random_solid(seed), share, g, 5.0, 60, degree=9)
    assert max(found[:2]) < 3e-4 and max(found[2:]) < 3e-3
