"""Friction that varies along the contact: closed form against a quadrature of its own in 30 digits."""

from dataclasses import replace
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from random_solids import random_solid
from support import THOROUGH

from galinx.solvers.contact.along import FlatAlong, Splines
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.equation import UNIFORM, Equation
from galinx.solvers.contact.solution import make_contact
from galinx.solvers.friction.along import advected, tabulated
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.elasto_plastic import ElastoPlastic
from galinx.solvers.friction.maxwell_slip import MaxwellSlip
from galinx.solvers.profiles.punches import Flat
from galinx.solvers.solids.isotropic import Isotropic

PLACES = np.array([-0.999999, -0.93, -0.4, 0.01, 0.35, 0.8, 0.9999])
ISOTROPIC = Isotropic(2.5e9, 0.3, 1000.0)


def reference(response, g, breaks, X, digits=30):
    """σ_YY/σ_YY(0) in many digits: sin(πα)/(N̂ (1 + X)) exp ⨍ α(t)/(t - X) dt."""
    with mp.workdps(digits):
        n, q, n12 = (mp.mpf(float(value)) for value in (response.n, response.q, response.n12))

        def α(t):
            return -mp.mpf(1) / 2 - mp.atan(g(t) * q / (n + g(t) * n12)) / mp.pi

        def shape(x):
            x = mp.mpf(float(x))
            at = α(x)
            pieces = sorted({mp.mpf(-1), *map(mp.mpf, breaks), x, mp.mpf(1)})
            E = mp.quad(lambda t: (α(t) - at) / (t - x) if t != x else mp.mpf(0), pieces)
            E += at * mp.log((1 - x) / (1 + x))
            return mp.sin(mp.pi * at) / (n + g(x) * n12) / (1 + x) * mp.exp(E)

        middle = shape(0.0)
        return np.array([float(shape(x) / middle) for x in X])


def linear(rows):
    """g = -f linear between rows, in the precision of the place."""

    def g(t):
        for (x0, f0), (x1, f1) in pairwise(rows):
            if t <= x1:
                share = (t - mp.mpf(x0)) / (mp.mpf(x1) - mp.mpf(x0))
                return -(mp.mpf(f0) + share * (mp.mpf(f1) - mp.mpf(f0)))
        return -mp.mpf(rows[-1][1])

    return g


@pytest.mark.parametrize("seed", range(4))
def test_closed_form_against_a_quadrature_in_30_digits(seed):
    rng = np.random.default_rng(seed)
    solid = random_solid(seed) if seed else ISOTROPIC
    response = solid.response(rng.uniform(0.0, 0.8) * solid.limit())
    inner = np.sort(rng.uniform(-0.9, 0.9, rng.integers(0, 4))).tolist()
    rows = list(zip([-1.0, *inner, 1.0], rng.uniform(0.0, 0.9, len(inner) + 2).tolist()))
    pressure = FlatAlong(response, tabulated(rows, -1.0))
    found = pressure.σ_YY(PLACES) / pressure.σ_YY(np.zeros(1))
    np.testing.assert_allclose(found, reference(response, linear(rows), inner, PLACES), rtol=1e-9)


@pytest.mark.parametrize("room", [1e-3, 1e-6])
def test_the_pressure_at_an_end_with_a_kink_next_to_it(room):
    """K_I was that of a place 1e-13 beside the end: off by 6e-6 where a kink is 1e-6 from it."""
    rows, response = [(-1.0, 0.5), (1.0 - room, 0.5), (1.0, 0.0)], ISOTROPIC.response(0.5)
    g = linear(rows)
    with mp.workdps(30):
        n, q = mp.mpf(response.n), mp.mpf(response.q)
        assert not response.n12

        def α(t):
            return -mp.mpf(1) / 2 - mp.atan(g(t) * q / n) / mp.pi

        def shape(x):
            """Pressure but for its logarithms of distances, which are 0 in the middle."""
            at, places = α(x), sorted({-1, mp.mpf(rows[1][0]), x, 1})
            E = mp.quad(lambda t: (α(t) - at) / (t - x) if t != x else mp.mpf(0), places)
            return mp.sin(mp.pi * at) * mp.exp(E)

        right, left = α(mp.mpf(1)), -1 - α(mp.mpf(-1))
        expected = float(shape(mp.mpf(1)) * mp.mpf(2) ** (-1 - right - left) / shape(mp.mpf(0)))
    pressure = FlatAlong(response, tabulated(rows, -1.0))
    ends, middle = np.array([-1.0, 1.0]), np.zeros(1)
    assert pressure.series(ends)[1] / pressure.σ_YY(middle) == pytest.approx(expected, rel=1e-9)
    mirrored = FlatAlong(response, tabulated([(-X, f) for X, f in rows[::-1]], 1.0))
    np.testing.assert_allclose(mirrored.series(ends)[::-1], pressure.series(ends), rtol=1e-12)


@pytest.mark.parametrize("seed", range(20) if THOROUGH else (0, 1, 2))
def test_integral_equation_against_the_closed_form(seed):
    """Two solutions that share no line: values on panels by collocation, and the formula."""
    rng = np.random.default_rng(100 + seed)
    solid = random_solid(seed) if seed else ISOTROPIC
    response = solid.response(rng.uniform(0.0, 0.8) * solid.limit())
    inner = np.sort(rng.uniform(-0.9, 0.9, rng.integers(0, 3))).tolist()
    rows = list(zip([-1.0, *inner, 1.0], rng.uniform(0.0, 0.9, len(inner) + 2).tolist()))
    law = Dahl(rng.uniform(0.1, 0.8), 10.0 ** rng.uniform(2.0, 5.0), 1.0)
    friction = tabulated(rows, -1.0) if seed % 2 else advected(law, 1, 1.0, 1e-3, -1.0)
    exact = FlatAlong(response, friction)
    pressure = Equation(response, UNIFORM, friction, np.zeros_like).pressure(0.7)
    np.testing.assert_allclose(pressure.σ_YY(PLACES), exact.σ_YY(PLACES), rtol=1e-7)
    np.testing.assert_allclose(pressure.K_I, exact.K_I, rtol=1e-7)
    X = np.array([-3.0, -1.01, *PLACES, 1.0001, 2.0])
    for one, other in zip(pressure.transforms(None, X), exact.transforms(None, X)):
        np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-6)
    for name in ("resultant_ratio", "pressure_centre"):
        assert getattr(pressure, name) == pytest.approx(getattr(exact, name), abs=1e-9)


@pytest.mark.parametrize("stiffness", [10.0, 1e3, 1e5])
def test_advected_dahl_against_a_quadrature_in_30_digits(stiffness):
    response, μ, a = ISOTROPIC.response(0.4), 0.7, 1e-3
    along = advected(Dahl(μ, stiffness, 1.0), 1, 1.0, a, -1.0)

    def g(t):  # it enters at X = a, at rest
        return -mp.mpf(μ) * (1 - mp.exp(-mp.mpf(stiffness) / mp.mpf(μ) * mp.mpf(a) * (1 - t)))

    pressure = FlatAlong(response, along)
    found = pressure.σ_YY(PLACES) / pressure.σ_YY(np.zeros(1))
    layer = [1 - s * μ / (stiffness * a) for s in (0.1, 1, 4, 10) if s * μ / (stiffness * a) < 1.5]
    np.testing.assert_allclose(found, reference(response, g, layer, PLACES), rtol=1e-9)
    at_trailing_end = FlatPunch(response, μ * np.expm1(-2.0 * stiffness * a / μ))
    assert pressure.α == -0.5 and pressure.β == pytest.approx(at_trailing_end.β, rel=1e-12)


@pytest.mark.parametrize("f", [0.0, 0.3, 0.9, 20.0])
@pytest.mark.parametrize("seed", [0, 2])
def test_constant_friction_is_one_number(f, seed):
    solid = random_solid(seed) if seed else ISOTROPIC
    response, X = solid.response(0.5 * solid.limit()), np.array([-3.0, -1.01, *PLACES, 1.0001, 2.0])
    one, none = FlatPunch(response, -f), np.where(np.abs(X) < 1.0, 1.0, 0.0)
    contact = make_contact(
        solid, Flat(1e-3), 1.0, along={-f: tabulated([(-1, f), (0.2, f), (1, f)], -1.0)}
    )
    contacts = contact.contacts(response, np.array([-f]))
    σ_XX, σ_YY = contacts.on_surface(X)
    np.testing.assert_allclose(σ_YY[0], np.nan_to_num(one.σ_YY(X)) * none, rtol=1e-12)
    np.testing.assert_allclose(σ_XX[0], one.σ_XX(X), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(contacts.of("K_I")[0], one.K_I, rtol=1e-12)
    pressure = contacts.groups[0].pressure
    assert pressure.resultant_ratio == pytest.approx(-f, abs=1e-12)
    assert pressure.pressure_centre == pytest.approx(one.β - one.α, abs=1e-12)


def test_kinks_of_a_law_are_found_where_its_elements_slip():
    law = MaxwellSlip(((400.0, 0.2), (1000.0, 0.3)))
    along = advected(law, 1, 1.0, 1e-3, -1.0)
    np.testing.assert_allclose(along.kinks, [1.0 - 0.5, 1.0 - 0.3], atol=1e-7)


def test_no_kink_of_a_law_is_missed():
    """At each of 60 random laws: one beside an end of a panel, before its first point, was not seen."""
    rng, a = np.random.default_rng(7), 1e-3
    for _ in range(60):
        k, μ = 10.0 ** rng.uniform(2.5, 4.5, 4), rng.uniform(0.02, 0.2, 4)
        along = advected(MaxwellSlip(np.stack([k, μ], axis=1)), 1, 0.1, a, -1.0)
        off = [np.abs(1.0 - slip / a - along.jumps).min() for slip in μ / k if slip < 2.0 * a]
        assert max(off, default=0.0) < 1e-6


@pytest.mark.parametrize("stiffness", [1e3, 5e3])
def test_a_jump_of_curvature_costs_no_digits(stiffness):
    """Bristles break away where a derivative of friction jumps: rules end there, cells need not."""
    law = ElastoPlastic(μ_C=0.4, μ_S=0.6, v_S=1.0, j=2.0, σ0=stiffness, σ1=0.0, σ2=0.0, r=0.7)
    along, response = advected(law, 1, 0.1, 1e-3, -1.0), ISOTROPIC.response(0.0)
    breakaway = 1.0 - 0.7 * float(law.g(0.1)) / stiffness / 1e-3
    assert not along.kinks
    exact = FlatAlong(response, replace(along, kinks=(breakaway,), weak_kinks=()))
    found = FlatAlong(response, along)
    assert found.resultant_ratio == pytest.approx(exact.resultant_ratio, abs=1e-9)
    np.testing.assert_allclose(found.σ_YY(PLACES), exact.σ_YY(PLACES), rtol=1e-8)


def test_splines_bend_at_kinks_of_friction_alone():
    """At a kink they are continuous only, at another knot their slopes are, too."""
    splines, r = Splines((-1.0, -0.4, 0.3, 1.0), (0.3,), 4), np.linspace(-1.0, 1.0, 201)

    def left_out(curve):
        values = splines.values(r)
        return np.abs(values @ np.linalg.lstsq(values, curve, rcond=None)[0] - curve).max()

    assert left_out(np.abs(r - 0.3)) < 1e-12 < 1e-3 < left_out(np.abs(r + 0.4))


def test_logarithms_of_the_ends_reach_to_the_next_knots():
    """There they are as smooth as the splines, which have what they lack of x log x."""
    knots, degree = (-1.0, -0.9, 0.1, 0.7, 1.0), 4
    r = np.array([-0.999, -0.95, -0.9, 0.0, 0.69, 0.75, 0.99])
    of_ends = Splines(knots, (), degree, logarithms=True).sparse(r).toarray()[:, -2:]
    for own, x in zip(of_ends.T, ((r + 1.0) / 0.1, (1.0 - r) / 0.3)):
        k = np.arange(degree + 1.0, 20000.0)
        rest = ((1.0 - np.minimum(x, 1.0))[:, None] ** k / (k * (k - 1.0))).sum(axis=1)
        np.testing.assert_allclose(own, rest, rtol=1e-3, atol=1e-13)
