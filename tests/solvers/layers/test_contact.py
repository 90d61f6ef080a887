"""Punches on layered and graded half-planes by the singular integral equation."""

import mpmath as mp
import numpy as np
import pytest
from layers_cases import COAT, SUBSTRATE, converged_pressure, equation
from layers_reference import plane_strain, punch
from support import THOROUGH

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.edges import weights_hilbert
from galinx.solvers.contact.ends import Punch
from galinx.solvers.contact.equation import (
    UNIFORM,
    Equation,
    Jacobi,
)
from galinx.solvers.contact.on_layers import LayersUnderPunch, weights_between
from galinx.solvers.contact.pressure import Expansion
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.profiles.punches import Flat
from galinx.solvers.solids.isotropic import Isotropic

#: V², and α, K_I left, K_I right, σ_YY(0) over N/a, found in 30 and 50 digits with 24 to 36 nodes by the
#: reference.
EXAMPLE = {
    0.2: (-0.46191902660637, 0.46957498690109, 0.44068899120707, -0.17306141207014),
    1e-6: (-0.46377887035456, 0.44527894507991, 0.42102580318078, -0.19463531965638),
}
ENDS, MIDDLE = np.array([-1.0, 1.0]), np.zeros(1)


def read(pressure):
    return np.array([pressure.α, *(-0.5 * pressure.series(ENDS)), *(0.5 * pressure.series(MIDDLE))])


@pytest.mark.parametrize("V2", EXAMPLE)
def test_the_example_to_all_digits(V2):
    one = converged_pressure(equation(Layered((Layer(1.0, COAT),), SUBSTRATE), V2, -0.4), 1e-11)
    assert np.abs(read(one.pressure) - EXAMPLE[V2]).max() <= 2e-12


@pytest.mark.skipif(not THOROUGH, reason="a minute")
@pytest.mark.parametrize("V2", EXAMPLE)
def test_the_reference_finds_the_example(V2):
    layers = [(mp.mpf(1), plane_strain("7.5", "0.3"), mp.mpf("1.2"))]
    exact = punch(layers, (plane_strain("2.5", "0.25"), mp.mpf(1)), repr(V2), "-0.4", 36)
    assert np.abs(np.array(exact, dtype=float) - EXAMPLE[V2]).max() <= 1e-13


def test_the_reference_finds_it_roughly():
    layers = [(mp.mpf(1), plane_strain("7.5", "0.3"), mp.mpf("1.2"))]
    exact = punch(layers, (plane_strain("2.5", "0.25"), mp.mpf(1)), "0.2", "-0.4", 12, 20, 8, 10)
    assert np.abs(np.array(exact, dtype=float) - EXAMPLE[0.2]).max() <= 1e-5


@pytest.mark.parametrize("V2", EXAMPLE)
def test_panels_find_the_example_too(V2):
    """A second discretisation, with nothing of Jacobi's polynomials in it."""
    one = equation(Layered((Layer(1.0, COAT),), SUBSTRATE), V2, -0.4).pressure(0.7)
    assert np.abs(read(one) - EXAMPLE[V2]).max() <= 1e-10


@pytest.mark.parametrize("g", [-0.9, 0.0, 0.4])
def test_layers_of_one_solid_are_the_half_plane(g):
    solid = Layered((Layer(0.3, COAT), Layer(0.2, COAT), Layer(1.5, COAT)), COAT)
    one = converged_pressure(equation(solid, 0.9, g), 1e-11).pressure
    exact = FlatPunch(COAT.response(0.9**0.5 / COAT.c_s), g)
    assert np.abs(-0.5 * one.series(ENDS) - exact.K_I).max() <= 1e-12


def test_a_thick_layer_is_the_coating_alone():
    """What the substrate does falls like a/H."""
    off = []
    for H in (10.0, 100.0):
        one = converged_pressure(
            equation(Layered((Layer(H, COAT),), SUBSTRATE), 0.2, -0.4), 1e-11
        ).pressure
        exact = FlatPunch(COAT.response(0.2**0.5 / COAT.c_s), -0.4)
        off.append(np.abs(-0.5 * one.series(ENDS) / exact.K_I - 1.0).max())
    assert off[0] <= 0.05 and 9.0 < off[0] / off[1] < 12.0


def test_graded_layer_is_the_limit_of_uniform_ones():
    bottom = Isotropic(2.5, 0.25, 1.0)
    graded = Layer(1.0, COAT, bottom)
    exact = read(
        converged_pressure(
            equation(Layered((graded,), bottom), 0.2, -0.4, tolerance=1e-10), 1e-8
        ).pressure
    )
    off = []
    for count in (4, 8, 16) + (32,) * THOROUGH:
        middles = (np.arange(count) + 0.5) / count
        layers = tuple(Layer(1.0 / count, graded.at(float(s))) for s in middles)
        one = converged_pressure(
            equation(Layered(layers, bottom), 0.2, -0.4, tolerance=1e-9), 1e-6
        ).pressure
        # The exponents are those of the uppermost solid, so the middle is looked at.
        off.append(abs(read(one)[3] / exact[3] - 1.0))
    rates = np.log2(np.array(off[:-1]) / off[1:])
    assert off[-1] < 1e-3 and rates.min() > 1.8


def test_graded_solid_that_does_not_change_is_uniform():
    almost = Isotropic(7.5 * (1.0 + 1e-9), 0.3, 1.2)
    one = converged_pressure(
        equation(Layered((Layer(1.0, COAT, almost),), COAT), 0.2, -0.4, tolerance=1e-10), 1e-8
    )
    exact = FlatPunch(COAT.response(0.2**0.5 / COAT.c_s), -0.4)
    assert np.abs(-0.5 * one.pressure.series(ENDS) - exact.K_I).max() <= 1e-8


def test_sharp_punch_with_a_profile():
    """On layers of one solid as without layers."""
    solid = Layered((Layer(0.5, COAT),), COAT)

    def slope(r):
        return 0.3 * np.asarray(r) + 0.1

    one = converged_pressure(equation(solid, 0.2, -0.4, slope), 1e-11).pressure
    exact = Equation(COAT.response(0.2**0.5 / COAT.c_s), UNIFORM, -0.4, slope).pressure(40)
    assert np.abs(-0.5 * one.series(ENDS) - exact.K_I).max() <= 1e-10


@pytest.mark.parametrize("H", [0.1, *(0.01,) * THOROUGH])
def test_thin_coatings_tend_to_the_substrate(H):
    """The middle of the contact sees the substrate the more the thinner the coating."""
    solid = Layered((Layer(H, COAT),), SUBSTRATE)
    one = converged_pressure(equation(solid, 0.2, 0.0, tolerance=1e-8), 1e-5).pressure
    exact = FlatPunch(SUBSTRATE.response(0.2**0.5), 0.0)
    r = np.linspace(-0.5, 0.5, 5)
    σ = (1.0 - r) ** one.α * (1.0 + r) ** one.β * one.series(r)
    assert np.abs(σ / exact.σ_YY(r) - 1.0).max() <= 2.0 * H


def test_frictions_between_are_interpolated_within_the_tolerance():
    solid = Layered((Layer(1.0, COAT),), SUBSTRATE)
    response = solid.response(0.3)
    speed = LayersUnderPunch(response, response.stack(1.0), 1e-8, Punch(Flat(1.0), 1.0, 1.0))
    g = np.linspace(-1.0, 1.0, 301)
    solved, left = speed.solved(g)
    assert len(solved) < 40 and left <= 1e-8
    weights = weights_between(np.array([contact.g for contact in solved]), g)
    ends = weights @ [contact.pressure.series(ENDS) for contact in solved]
    for i in (3, 150):
        exact = converged_pressure(
            equation(solid, (0.3 * COAT.c_s) ** 2, float(g[i])), 1e-11
        ).pressure.series(ENDS)
        assert np.abs(ends[i] / exact - 1.0).max() <= 1e-8


@pytest.mark.parametrize("terms, limit", [(20, 1e-10), (60, 1e-10), (150, 1e-10), (300, 1e-9)])
def test_what_is_left_of_the_hilbert_transform_keeps_its_digits_beside_the_punch(terms, limit):
    """Many polynomials grow fast beyond the edges: how far they are taken there depends on how many.

    SciPy's rule of 600 points keeps nine digits.
    """
    c = np.exp(-0.4 * np.arange(terms)) + 1e-15
    pressure = Expansion(-0.45, -0.55, c, Jacobi(-0.45, -0.55))
    X = np.array([-1.3, -1.1, -1.05, -1.001, 1.0002, 1.02, 1.1, 1.4])
    known = np.abs(X) <= pressure.near
    whole = pressure.rest(X, pressure.near)
    weights = weights_hilbert(-0.45, -0.55, X)
    whole[known] += pressure.series(X[known]) * weights[known]
    fine = pressure.points(1e-3)
    exact = (fine[1] / (fine[0] - X[:, None])).sum(axis=1) / np.pi
    assert known.any()
    assert np.abs(whole - exact).max() <= limit * np.abs(exact).max()
