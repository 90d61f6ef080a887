"""Pressures over layers, read off the moments that functions of a stretched variable have with them."""

import numpy as np
import pytest
from layers_cases import converged_pressure

from galinx.meshes.layered import steepness
from galinx.solvers.contact.equation import Equation
from galinx.solvers.contact.panels import Panels
from galinx.solvers.contact.recovery import Stretch, from_moments
from galinx.solvers.layers.kernel import Kernel
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids.isotropic import Isotropic

#: Young's modulus in GPa, Poisson's ratio, density in 1000 kg/m³.
SOFT, HARD = Isotropic(100.0, 0.2, 4.0), Isotropic(1000.0, 0.35, 7.0)
ENDS = np.array([-1.0, 1.0])


@pytest.fixture(scope="module")
def pressure():
    """By the integral equation, of a layer whose modulus is ten times as large at its lower face."""
    response = Layered((Layer(0.2, SOFT, HARD),), HARD).response(0.45)
    kernel = Kernel(response.stack(1.0), 1e-8)
    return converged_pressure(Equation(response, kernel, -0.5, np.zeros_like), 1e-7).pressure


def read(pressure, stretch, count):
    """The same from its moments."""
    panels = Panels(pressure.α, pressure.β, 0.03)
    forces = panels.weights * pressure.series(panels.t)
    moments = stretch.values(panels.t, count + stretch.of_ends).T @ forces
    return from_moments(moments[None], np.array([pressure.α]), np.array([pressure.β]), stretch)


@pytest.mark.parametrize(("count", "error"), [(20, 4e-5), (24, 2e-6), (28, 1e-6)])
def test_moments_give_the_intensities_of_a_steeply_graded_solid(pressure, count, error):
    again = read(pressure, Stretch(0.36, graded=True), count)
    exact = -0.5 * pressure.series(ENDS)
    off = np.abs(again.K_I[0] / exact - 1.0).max()
    assert off <= error
    assert off <= again.unresolved[0]


HALF = np.array([-0.5])


def of_flat_punch(stretch, polynomials, middle=0.0, half_width=1.0):
    """The pressure that has a flat punch's moments, by Gauss and Chebyshev's rule in its own contact."""
    nodes = np.cos(np.pi * (np.arange(16000) + 0.5) / 16000)
    f = stretch.values(middle + half_width * nodes, polynomials + stretch.of_ends)
    return from_moments(f.mean(axis=0)[None], HALF, HALF, stretch)


@pytest.mark.parametrize(("graded", "polynomials"), [(False, 12), (False, 20), (True, 6)])
def test_a_contact_that_ends_elsewhere_changes_the_pressure_at_its_ends_by_the_steepness(
    graded, polynomials
):
    """Read by the same functions, which know nothing of where it ends."""
    stretch, length, r = Stretch(0.8, graded), 1e-6, np.linspace(-1.0, 1.0, 7)
    whole = of_flat_punch(stretch, polynomials)
    assert whole.series(r) == pytest.approx(1.0 / np.pi, rel=1e-6)
    shorter = of_flat_punch(stretch, polynomials, -0.5 * length, 1.0 - 0.5 * length)
    right = np.abs(shorter.series(r) - whole.series(r))[0]
    moved = (right + right[::-1]).max() * np.pi / length / steepness(polynomials, stretch.h)
    if graded:
        assert 1.0 < moved < 400.0
    else:
        assert moved == pytest.approx(1.0, rel=0.1)
