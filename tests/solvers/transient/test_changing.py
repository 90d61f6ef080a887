"""Friction that changes in time: the integral equation against what is known, and finite elements."""

import numpy as np
import pytest
from random_solids import random_solid
from scipy.interpolate import make_interp_spline
from started import THOROUGH, ByFiniteElements

from galinx.postprocess.over_time import contact_numbers
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import smooth
from galinx.solvers.transient.march import FrictionInterpolation, Radau
from galinx.solvers.transient.punch import PLACES, StartingPunch
from galinx.solvers.transient.transform import Basis, Transformed

SOLID = Isotropic(1.0, 0.25, 1.0)


def load(t):
    return smooth(t, 3.0)


def punch(solid, c, end, steps, terms=16):
    return StartingPunch(solid.response(c), solid.limit(), end, steps, terms)


@pytest.fixture(scope="module")
def at_speed():
    return punch(SOLID, 0.6, 4.0, 20)


def test_pressures_of_all_frictions_lie_between_those_of_a_few():
    response = random_solid(1).response(0.1)
    between, X = FrictionInterpolation(response, -0.9, 0.2, 24), np.cos(np.linspace(0.05, 3.1, 50))
    for g in (-0.9, -0.31, 0.2):
        found = np.tensordot(between.shares(g), [one.pressure(X) for one in between.bases], 1)
        exact = Basis(response, g, 24).pressure(X)
        np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-9 * np.abs(exact).max())
    assert 5 < len(between.bases) < 16
    assert len(FrictionInterpolation(response, 0.3, 0.3, 24).bases) == 1


def test_friction_that_stays_is_a_special_case(at_speed):
    """Marched through, and at once in the transform; what comes round in that is left."""
    scheme = Radau(4.0, 20)
    at_once = Transformed(SOLID.response(0.6), SOLID.limit(), scheme.s, 16)
    basis, marched = at_once.basis(-0.4), at_speed.course(-0.4, load)
    (answers,) = at_once.answers(basis)
    solved = scheme.answered(answers[..., None], load(scheme.times)[..., None])
    σ_YY, v0 = solved[:, :-1] @ basis.pressure(PLACES).T, solved[:, -1]
    for found, known in ((marched.v0, v0), (marched.σ_YY, σ_YY)):
        np.testing.assert_allclose(found, known, rtol=0.0, atol=1e-10 * np.abs(known).max())


def test_steady_motion_goes_on(at_speed):
    found = at_speed.course(lambda t: -0.4 + 0.0 * t, lambda t: 1.0 + 0.0 * t, steady=True)
    steady = FlatPunch(SOLID.response(0.6), -0.4)
    np.testing.assert_allclose(found.v0, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.centre, steady.β - steady.α, rtol=1e-10)
    np.testing.assert_allclose(found.K_left, steady.K_I, rtol=1e-10)
    np.testing.assert_allclose(found.K_right, steady.K_I, rtol=1e-10)
    np.testing.assert_allclose(found.work_of_friction, 0.0, atol=1e-12)


def transformed_by_a_ladder(solid, c, g0, g1, s, λ, ramp, rungs, terms):
    """Of v₀ and the pressure's first moment where g = g0 + g1 e^(-λt), without any steps in time.

    Laplace's transform of e^(-λt) σ is that of σ at s + λ, so that each s asks for the next; far away the
    load has hardly any. All pressures have the exponents of the middle.
    """
    response = solid.response(c)
    at = s + λ * np.arange(rungs)
    t, w = np.polynomial.legendre.leggauss(60)
    t, w = (t + 1.0) * ramp / 2.0, w * ramp / 2.0
    loads = np.exp(-np.multiply.outer(at, t)) @ (w * smooth(t, ramp)) + np.exp(-at * ramp) / at
    whole = Transformed(response, solid.limit(), at.astype(complex), terms)
    basis = Basis(response, g0 + g1 / 2.0, terms)
    by_g = [Basis(response, g, terms) for g in (0.0, 1.0)]
    for one in by_g:
        one.pressure = basis.pressure  # the same pressures under another friction
    A, both = (whole.sinking(one, basis.tests).real for one in by_g)
    B, known = both - A, np.zeros(terms)
    for n in range(rungs - 1, -1, -1):
        matrix, right = np.zeros((terms + 1, terms + 1)), np.zeros(terms + 1)
        matrix[:-1, :-1] = A[n] + g0 * B[n]
        matrix[0, -1], matrix[-1, 0] = basis.tests.integral, basis.pressure.integral
        right[:-1], right[-1] = -g1 * B[n] @ known, -2.0 * loads[n]
        x = np.linalg.solve(matrix, right)
        known = x[:-1]
    return x[-1], known @ basis.moments[:, 1]


def transformed(t, s, values):
    """∫ e^(-st) values dt from rest at t = 0."""
    curve = make_interp_spline(np.append(0.0, t), np.append(0.0, values), 5)
    x, w = np.polynomial.legendre.leggauss(200)
    x, w = (x + 1.0) * t[-1] / 2.0, w * t[-1] / 2.0
    return (w * np.exp(-s * x)) @ curve(x)


def test_a_ladder_of_transforms_says_the_same():
    """Friction 0.1 + 0.5 (1 - e^(-1.3t)) leaves at s = 3 what is over by t = 6."""
    g0, g1, λ, s = -0.6, 0.5, 1.3, 3.0
    found = punch(SOLID, 0.6, 6.0, 40).course(lambda t: g0 + g1 * np.exp(-λ * t), load)
    moment = -2.0 * found.load * found.centre
    v0, first = transformed_by_a_ladder(SOLID, 0.6, g0, g1, s, λ, 3.0, 24, 20)
    _, other = transformed_by_a_ladder(SOLID, 0.6, g0, 0.0, s, λ, 3.0, 1, 20)
    assert abs(transformed(found.t, s, found.v0) / v0 - 1.0) < 1e-4
    assert abs(transformed(found.t, s, moment) / first - 1.0) < 1e-4
    assert abs(other / first - 1.0) > 0.05


def differences(solid, c, g, end, steps, **mesh):
    """Of v₀, centre, and K_I at both ends, over the largest, where friction changes; of the energy."""
    started, found = ByFiniteElements(solid, c, end, steps, **mesh), punch(solid, c, end, steps, 24)
    run, expected = started.run(g, load), found.course(g, load)
    by_time = [FlatPunch(started.response, g(t)) for t in run.t]
    read = [
        contact_numbers(started.motion.X, run.forces[n : n + 1], one.α, one.β, started.degree)
        for n, one in enumerate(by_time)
    ]
    K = max(np.abs(expected.K_left).max(), np.abs(expected.K_right).max())
    centre = np.array([one.centre[0] for one in read]) - expected.centre
    work = expected.work_of_load + expected.work_of_friction
    return [
        np.abs(run.v0 - expected.v0).max() / np.abs(expected.v0).max(),
        np.abs(centre * expected.load).max() / np.abs(expected.centre * expected.load).max(),
        np.abs([one.K_left[0] for one in read] - expected.K_left).max() / K,
        np.abs([one.K_right[0] for one in read] - expected.K_right).max() / K,
        np.abs(work - run.energy).max() / np.abs(work).max(),
    ]


def test_finite_elements_agree_where_friction_changes():
    found = differences(SOLID, 0.6, lambda t: -0.6 * (1.0 - np.exp(-t)), 3.0, 20)
    assert found[0] < 3e-5 and max(found[1:4]) < 1e-3 and found[4] < 1e-4


@THOROUGH
@pytest.mark.parametrize("seed", range(6))
def test_finite_elements_agree_on_random_solids_where_friction_changes(seed):
    rng, solid = np.random.default_rng(seed), random_solid(seed)
    c, (one, other) = rng.uniform(0.0, 0.8) * solid.limit(), rng.uniform(-0.7, 0.7, 2)
    found = differences(solid, c, lambda t: one + other * np.sin(t), 4.0, 50, degree=9)
    assert found[0] < 1e-4 and max(found[1:4]) < 3e-3 and found[4] < 3e-4
