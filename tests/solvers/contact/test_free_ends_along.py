"""Free ends with friction that varies along the contact: the equation against 15 digits; symmetries.

Reference: with S = -sin πα, Z = (1 - t) e^E, E(t) = ⨍ α(s)/(s - t) ds, the pressure that vanishes at both
ends under a slope f is τ = N̂ σ = cos(πα) S f - S Z (1/π) ⨍ S f/(Z (s - t)) ds, with ∫ S f/Z dt = 0 and
∫ t S f/Z dt = -∫ τ dt (Gakhov, Boundary value problems, §47).
"""

from itertools import pairwise, starmap

import numpy as np
import pytest
from random_solids import random_solid

from galinx.solvers.contact.closed_form import contacts
from galinx.solvers.contact.equation import under_punch
from galinx.solvers.contact.solution import make_contact
from galinx.solvers.friction.along import advected, tabulated
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.profiles.punches import Flat, Parabolic, Wedge
from galinx.solvers.solids.isotropic import Isotropic

ISOTROPIC, LOAD, CYLINDER = Isotropic(2.5e9, 0.3, 1000.0), 1e4, Parabolic(0.1)
WEDGE = Wedge(0.01)
PLACES = np.array([-0.999, -0.3, 0.6, 0.95])


def solved(solid, friction, profile=CYLINDER, c=0.4, tolerance=1e-7):
    """The contact by the integral equation, with lengths over its half-width at rest, and its body."""
    body = make_contact(solid, profile, LOAD, along={friction.mean: friction})
    response = body.response(c * solid.limit())
    return under_punch(body, response, tolerance).contact(friction.mean), body, response


def rule(first, last):
    """Double exponential rule between two places: distances from X = -a and from X = a, and weights."""
    u = np.arange(-5.0, 5.0001, 1.0 / 32.0)
    half, steep = (last - first) / 2.0, np.pi * np.sinh(u)
    from_first, to_last = (2.0 * half / (1.0 + np.exp(sign * steep)) for sign in (-1.0, 1.0))
    weights = half / 32.0 * np.pi / 2.0 * np.cosh(u) / np.cosh(steep / 2.0) ** 2
    return 1.0 + first + from_first, 1.0 - last + to_last, weights


def reference(response, g, f, tip=()):
    """∫ S f/Z dt, ∫ t S f/Z dt and τ at places, of the slope f, which jumps at the tips."""
    # Bristles give way within a short distance from X = a, towards which panels are graded.
    x, w = np.polynomial.legendre.leggauss(16)
    ends = np.append(2.0 * 0.5 ** np.arange(50.0), 0.0)
    half = (ends[:-1] - ends[1:])[:, None] / 2.0
    ahead, w = (ends[1:, None] + half * (1.0 + x)).ravel(), (half * w).ravel()

    def α(right):
        of = g(right)
        return -0.5 - np.arctan(of * response.q / (response.n + of * response.n12)) / np.pi

    def Z_and_F(left, right):
        t = np.where(left < right, left - 1.0, 1.0 - right)
        at, apart = α(right), right[:, None] - ahead
        E = ((α(ahead) - at[:, None]) / np.where(apart == 0.0, np.inf, apart)) @ w
        Z = right ** (1.0 + at) * left**-at * np.exp(E)
        return t, at, Z, -np.sin(np.pi * at) * f(t) / Z

    def τ(X):
        (t,), (at,), (Z,), (F,) = Z_and_F(*np.array([[1.0 + X], [1.0 - X]]))
        H = F * np.log((1.0 - t) / (1.0 + t))
        for left, right, weights in starmap(rule, pairwise(sorted([-1.0, *tip, X, 1.0]))):
            beside, _, _, of = Z_and_F(left, right)
            H += ((of - F) / np.where(beside == t, np.inf, beside - t)) @ weights
        S = -np.sin(np.pi * at)
        return np.cos(np.pi * at) * S * f(t) - S * Z * H / np.pi

    each = starmap(rule, pairwise([-1.0, *tip, 1.0]))
    left, right, weights = (np.concatenate(of) for of in zip(*each))
    t, _, _, F = Z_and_F(left, right)
    return F @ weights, (t * F) @ weights, np.array([τ(X) for X in PLACES])


def of_dahl(μ, stiffness, a):
    """g of bristles that enter at X = a, by the distance from there."""
    return lambda right: μ * np.expm1(-stiffness / μ * a * right)


@pytest.mark.parametrize(
    "profile, seed, stiffness", [(CYLINDER, 0, 3000.0), (CYLINDER, 2, 1000.0), (WEDGE, 0, 300.0)]
)
def test_punch_with_advected_dahl_against_15_digits(profile, seed, stiffness):
    """That of a wedge has a tip, next to which the pressure is infinite."""
    solid = random_solid(seed) if seed else ISOTROPIC
    half_width = make_contact(solid, profile, LOAD).half_width
    friction = advected(Dahl(0.6, stiffness, 1.0), 1, 1.0, half_width, -1.0)
    contact, body, response = solved(solid, friction, profile)
    m, h = contact.centre * half_width, contact.half_width * half_width

    def slope(t):  # μ v,X over N/(2h) is 2 h P'/(N/μ)
        return 2.0 * h * profile.slope(m + h * t) / body.compression

    tip = (-m / h,) if profile is WEDGE else ()
    balance, load, τ = reference(response, of_dahl(0.6, stiffness, h), slope, tip)
    assert abs(balance) < 1e-8
    if not seed:
        assert load == pytest.approx(2.0 * response.n, rel=1e-8)
    own = response.n + friction.at(h)(PLACES) * response.n12
    np.testing.assert_allclose(own * contact.pressure.σ_YY(PLACES), τ, rtol=1e-7)


@pytest.mark.parametrize("layers", [False, True])
def test_ends_beside_a_step_of_friction_are_free_on_the_coarsest_panels(layers):
    """The rule of their balance has panels that end at kinks of friction, as the pressure's."""
    friction = tabulated([(-1, 0.1), (0.33, 0.1), (0.34, 0.9), (1, 0.9)], -1.0)
    solid = Layered((Layer(0.02, Isotropic(5e9, 0.3, 1000.0)),), ISOTROPIC) if layers else ISOTROPIC
    body = make_contact(solid, CYLINDER, LOAD, along={friction.mean: friction})
    under = under_punch(body, body.response(0.3 * solid.limit()), 1e-4)
    assert under._between_free_ends(friction.mean, 1.0, 1.4).change < 1e-8


@pytest.mark.parametrize("profile", [CYLINDER, WEDGE])
@pytest.mark.parametrize("seed", [0, 2])
def test_constant_friction_is_one_number(profile, seed):
    solid = random_solid(seed) if seed else ISOTROPIC
    friction = tabulated([(-1, 0.5), (0.3, 0.5), (1, 0.5)], -1.0)
    contact, body, response = solved(solid, friction, profile)
    one = contacts(response, np.array([-0.5]), profile, body.compression)
    unit = body.half_width
    assert contact.half_width * unit == pytest.approx(one.of("half_width")[0], rel=1e-10)
    assert contact.centre * unit == pytest.approx(one.of("centre")[0], rel=1e-9)
    expected = one.groups[0].pressure.σ_YY(PLACES)
    np.testing.assert_allclose(contact.pressure.σ_YY(PLACES), np.ravel(expected), atol=5e-9)


@pytest.mark.parametrize("profile, thickness", [(Flat(2e-3), 1e-3), (CYLINDER, 1e-3), (CYLINDER, 2e-5)])
def test_constant_friction_over_layers_is_one_number(profile, thickness):
    """The contact is some seventy times as wide as the thinnest layer is thick."""
    solid = Layered((Layer(thickness, Isotropic(7.5e9, 0.3, 1200.0)),), ISOTROPIC)
    friction = tabulated([(-1, 0.4), (1, 0.4)], -1.0)
    contact, _, response = solved(solid, friction, profile)
    one = under_punch(make_contact(solid, profile, LOAD), response, 1e-7).contact(-0.4)
    assert contact.half_width == pytest.approx(one.half_width, rel=1e-9)
    assert contact.centre == pytest.approx(one.centre, abs=1e-9)
    np.testing.assert_allclose(contact.pressure.σ_YY(PLACES), one.pressure.σ_YY(PLACES), atol=2e-8)


@pytest.mark.parametrize("profile", [Flat(2e-3), CYLINDER])
def test_no_traction_acts_next_to_the_surface_beside_the_contact(profile):
    """Exponents whose sum is no whole number need logarithms that are continuous across it there."""
    friction = tabulated([(-1, 0.2), (1, 0.5)], -1.0)
    contact, _, response = solved(ISOTROPIC, friction, profile, tolerance=1e-3)
    X, depths = np.meshgrid([-1.3, -1.01, 1.01, 1.3], np.geomspace(1e-9, 1e-4, 6))
    _, σ_YY, σ_XY = contact.pressure.inside(response, 0.0, X.ravel(), -depths.ravel())
    by_depth = np.array([σ_YY, σ_XY]).reshape(2, *X.shape) / depths
    np.testing.assert_allclose(by_depth, np.broadcast_to(by_depth[:, -2:-1], by_depth.shape), rtol=0.1)
