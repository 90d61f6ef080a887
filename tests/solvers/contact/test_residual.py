"""What answers leave of equations they were not computed by: nothing, or what is wrong with them."""

import numpy as np
import pytest
from random_solids import random_solid

from galinx.solvers.contact import residual
from galinx.solvers.contact.closed_form import FlatPunch, contacts
from galinx.solvers.contact.ends import Punch
from galinx.solvers.contact.equation import LayersUnderPunch
from galinx.solvers.layers.kernel import Kernel, Scaled
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.profiles.punches import Flat, Parabolic, Wedge
from galinx.solvers.solids.isotropic import Isotropic

POINTS = np.array([[0.3, -0.01], [-1.5, -0.4], [0.9, -3.0], [4.0, -2.0]])


@pytest.fixture(params=range(4))
def contact(request):
    seed = request.param
    solid = random_solid(seed) if seed else Isotropic(1.0, 0.3, 1.0)
    response, g = solid.response(0.8 * solid.limit()), np.array([-0.5, 0.3])
    profile = Wedge(0.1) if seed == 3 else Parabolic(1.0)
    found = contacts(response, g[:1] if seed == 3 else g, profile, 0.5)
    slope = 2.0 * found.of("half_width")[:, None] / 0.5
    lengths = found.of("centre")[:, None], found.of("half_width")[:, None]
    kinks = found.groups[0].pressure.kinks
    return found, lambda s: slope * profile.slope(lengths[0] + lengths[1] * s), kinks


def left(contact, pressure=None, inside=None):
    found, slope, kinks = contact
    exponents, pressure = (found.of("α"), found.of("β")), pressure or found.groups[0].contact_stress
    response, g = found.groups[0].response, found.of("g")
    ratio = lambda r: g[:, None]  # noqa: E731
    of_pressure = residual.of_pressure(response, g, exponents, slope, pressure, kinks)
    field = inside or found.stresses
    return of_pressure, residual.of_field(response, ratio, exponents, pressure, field, POINTS, kinks)


def test_exact_answers_leave_nothing(contact):
    of_pressure, of_field = left(contact)
    assert of_pressure.max() <= 1e-9 and of_field.max() <= 1e-9


@pytest.mark.parametrize("μ", [10.0, 50.0])
def test_a_load_that_is_nearly_all_at_an_edge_leaves_nothing(μ):
    """Exponents of -0.947 and -0.989: of the first a load of 1e-7 lies within e^-300 of the edge."""
    response, g = Isotropic(1.0, 0.3, 1.0).response(0.9), np.array([-μ])
    punch = FlatPunch(response, -μ)
    exponents = np.array([punch.α]), np.array([punch.β])
    pressure = lambda r: punch.σ_YY(r)[None]  # noqa: E731
    assert residual.of_pressure(response, g, exponents, np.zeros_like, pressure)[0] < 1e-11


@pytest.mark.parametrize("ε", [1e-2, 1e-5])
def test_a_wrong_pressure_is_seen(contact, ε):
    found = contact[0]
    of_pressure, of_field = left(contact, lambda r: found.groups[0].contact_stress(r) * (1.0 + ε * r))
    assert (0.1 * ε <= of_pressure).all() and (of_pressure <= 10.0 * ε).all()
    assert (0.01 * ε <= of_field).all() and (of_field <= 10.0 * ε).all()


@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_a_wrong_field_is_seen_in_any_unit(contact, unit):
    def left_where(wrong):
        def field(X, Y):
            return unit * found.stresses(X, Y) * (1.0 + 1e-5 * wrong(X))

        return left(contact, lambda r: unit * found.groups[0].contact_stress(r), field)[1].min()

    found = contact[0]
    assert left_where(lambda X: X == 0.9) >= 1e-7 and left_where(lambda X: len(X) > 9) >= 1e-6


def test_the_indentation_at_the_left_end_is_that_at_the_right_one():
    """Of a flat punch; its mirror image slides the other way."""
    g, (X, _) = np.array([[-0.5], [0.3]]), residual.places()
    response = Isotropic(1.0, 0.3, 1.0).response(0.3)
    σ_YY = FlatPunch(response, g).σ_YY(X)
    at_left = residual.indentation(response, g, σ_YY, 0.1)
    at_right = residual.indentation(response, -g, σ_YY[:, ::-1], 0.1)
    np.testing.assert_allclose(at_left, at_right, rtol=1e-4)


def test_the_rule_under_the_punch_has_the_integrals_of_even_and_of_infinite_pressures():
    X, weights = residual.places()
    assert weights.sum() == pytest.approx(2.0, rel=1e-10)
    assert (weights / np.sqrt((1.0 - X) * (1.0 + X))).sum() == pytest.approx(np.pi, rel=1e-5)


def layered(graded):
    layer = Layer(0.4, Isotropic(3.0, 0.2, 2.0), Isotropic(1.5, 0.3, 1.0) if graded else None)
    return Layered((layer,), Isotropic(1.0, 0.3, 1.0))


@pytest.mark.parametrize("graded", [False, True], ids=["uniform", "graded"])
def test_over_layers_a_pressure_of_the_equation_leaves_nothing_and_a_wrong_one_its_error(graded):
    solid, g = layered(graded), 0.4
    response = solid.response(0.3 * solid.limit(), 1.0)
    speed = LayersUnderPunch(response, response.stack(1.0), 1e-9, Punch(Flat(1.0), 1.0, 1.0))
    pressure, layers = speed.contact(g).pressure, [Scaled(Kernel(response.stack(1.0), 1e-9), 1.0)]
    ends = np.array([pressure.α]), np.array([pressure.β])

    def σ_YY(r, ε=0.0):
        weight = (1.0 - r) ** pressure.α * (1.0 + r) ** pressure.β
        return (weight * pressure.series(r) * (1.0 + ε * r))[None]

    def left_with(ε):
        wrong = lambda r: σ_YY(r, ε)  # noqa: E731
        return residual.of_pressure(response, np.array([g]), ends, np.zeros_like, wrong, layers=layers)[0]

    assert left_with(0.0) <= 1e-7
    for ε in (1e-2, 1e-4):
        assert 0.1 * ε <= left_with(ε) <= 10.0 * ε
