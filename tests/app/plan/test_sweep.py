"""Which speeds are fitted, and in which variable."""

import numpy as np
import pytest
from random_solids import random_solid

from galinx.solvers.contact.fem_plan import LEAST, swept, variable
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids import Isotropic

ISOTROPIC = Isotropic(E=1.0, ν=0.25, ρ=1.0)


def responses(solid, count, most=0.95):
    return [solid.response(c) for c in np.linspace(0.0, most * solid.limit(), count)]


def test_few_speeds_are_solved_each_and_many_on_demand():
    g = np.linspace(-0.5, 0.3, 40)
    assert swept("auto", responses(ISOTROPIC, LEAST - 1), g) is None
    assert swept("every", responses(ISOTROPIC, 100), g) is None
    assert swept("auto", 100 * responses(ISOTROPIC, 2), g) is None  # the same over and over
    sweep = swept("auto", responses(ISOTROPIC, LEAST), g)
    assert len(sweep.z) == LEAST and sweep.g.tolist() == [-0.5, 0.3] and not sweep.few


def test_few_frictions_are_sampled_themselves():
    sweep = swept("auto", responses(ISOTROPIC, LEAST), np.array([0.2, -0.3, 0.2, 0.0]))
    assert sweep.few and sweep.g.tolist() == [-0.3, 0.0, 0.2]


@pytest.mark.parametrize("seed", range(12))
def test_the_variable_tells_speeds_of_any_solid_apart(seed):
    solid = random_solid(seed)
    for most in (0.99, 0.3, 1e-3, 1e-7):
        z = variable(responses(solid, 50, most))
        assert np.all(np.diff(z) > 0.0)


@pytest.mark.parametrize("top", [ISOTROPIC, Isotropic(E=4.0, ν=0.3, ρ=1.5)])
def test_over_layers_it_is_the_logarithm_of_the_distance_to_the_limit(top):
    solid = Layered((Layer(0.5, top),), Isotropic(E=2.0, ν=0.2, ρ=1.0))
    share = np.linspace(0.0, 0.99, 50)
    z = variable([solid.response(c) for c in share * solid.limit()])
    np.testing.assert_allclose(z, -np.log1p(-(share**2)), rtol=1e-9)
