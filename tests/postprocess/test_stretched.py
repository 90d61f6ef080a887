"""Pressures from moments over solids that are graded from the surface on."""

import numpy as np
import pytest

from galinx.postprocess.pressure import Stretch
from galinx.postprocess.pressure import stretched_from_moments as from_moments
from galinx.solvers.layers.contact import Equation, found
from galinx.solvers.layers.kernel import Kernel
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.layers.panelled import Panels
from galinx.solvers.solids.isotropic import Isotropic

#: Young's modulus in GPa, Poisson's ratio, density in 1000 kg/m³.
SOFT, HARD = Isotropic(100.0, 0.2, 4.0), Isotropic(1000.0, 0.35, 7.0)
ENDS = np.array([-1.0, 1.0])


@pytest.fixture(scope="module")
def pressure():
    """By the integral equation, of a layer whose modulus is ten times as large at its lower face."""
    response = Layered((Layer(0.2, SOFT, HARD),), HARD).response(0.45)
    kernel = Kernel(response.stack(1.0), 1e-9)
    return found(Equation(response, kernel, -0.5, np.zeros_like), 1e-8).pressure


def read(pressure, stretch, count):
    """The same from its moments."""
    panels = Panels(pressure.α, pressure.β, 0.03)
    forces = panels.weights * pressure.series(panels.t)
    moments = stretch.functions(panels.t, count).T @ forces
    return from_moments(moments[None], np.array([pressure.α]), np.array([pressure.β]), stretch)


@pytest.mark.parametrize(("count", "error"), [(20, 4e-5), (24, 2e-6), (28, 1e-6)])
def test_moments_give_the_intensities_of_a_steeply_graded_solid(pressure, count, error):
    again = read(pressure, Stretch(0.36, graded=True), count)
    exact = -0.5 * pressure.series(ENDS)
    off = np.abs(again.K_I[0] / exact - 1.0).max()
    assert off <= error
    assert off <= again.unresolved[0]


def test_functions_are_orthonormal_and_the_same_wherever_they_are_asked_for(pressure):
    stretch = Stretch(0.36, graded=True)
    rule = Panels(-0.5, -0.5, 0.3 * 0.36)
    f = stretch.functions(rule.t, 28)
    assert np.abs((f * rule.weights[:, None]).T @ f - np.eye(f.shape[1])).max() <= 1e-9
    finer = Panels(-0.5, -0.5, 0.02)
    f = stretch.functions(finer.t, 28)
    assert np.abs((f * finer.weights[:, None]).T @ f - np.eye(f.shape[1])).max() <= 1e-6
