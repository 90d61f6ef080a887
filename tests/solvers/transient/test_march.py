"""Friction that changes in time, by the integral equation: what is known, what is left, what is seen."""

from itertools import product

import numpy as np
import pytest
from random_solids import random_solid
from starts import SOLID, by_integral_equation
from support import THOROUGH

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.stresses import PLACES
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import smooth
from galinx.solvers.transient.punch import (
    ON_SURFACE,
    AlongSurface,
    FrictionInterpolation,
    Radau,
    Residual,
    StartingPunch,
)
from galinx.solvers.transient.transform import Basis, Transformed


def load(t):
    return smooth(t, 3.0)


@pytest.fixture(scope="module")
def at_once():
    """Response, scheme, basis and answers of a start at c = 0.6 and g = -0.4, in the transform."""
    response, scheme = SOLID.response(0.6), Radau(4.0, 10)
    transformed = Transformed(response, SOLID.limit(), scheme.s, 16)
    basis = transformed.basis(-0.4)
    (answers,) = transformed.answers(basis)
    return response, scheme, basis, scheme.answered(answers[..., None], load(scheme.times)[..., None])


@pytest.fixture(scope="module")
def marching():
    return StartingPunch(SOLID.response(0.6), SOLID.limit(), 4.0, 10, 16)


def test_pressures_of_all_frictions_lie_between_those_of_a_few():
    response = random_solid(1).response(0.1)
    between, X = FrictionInterpolation(response, -0.9, 0.2, 24), np.cos(np.linspace(0.05, 3.1, 50))
    for g in (-0.9, -0.31, 0.2):
        found = np.tensordot(between.shares(g), [one.pressure(X) for one in between.bases], 1)
        exact = Basis(response, g, 24).pressure(X)
        np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-9 * np.abs(exact).max())
    assert 5 < len(between.bases) < 16
    assert len(FrictionInterpolation(response, 0.3, 0.3, 24).bases) == 1


def test_friction_that_stays_is_a_special_case(at_once, marching):
    """Marched through, and at once in the transform; what comes round in that is left."""
    _, _, basis, solved = at_once
    marched = marching.course(-0.4, load)
    σ_YY, v0 = solved[:, :-1] @ basis.pressure(PLACES).T, solved[:, -1]
    for found, known in ((marched.v0, v0), (marched.σ_YY, σ_YY)):
        np.testing.assert_allclose(found, known, rtol=0.0, atol=1e-10 * np.abs(known).max())


def test_steady_motion_goes_on(marching):
    found = marching.course(lambda t: -0.4 + 0.0 * t, lambda t: 1.0 + 0.0 * t, steady=True)
    steady = FlatPunch(SOLID.response(0.6), -0.4)
    np.testing.assert_allclose(found.v0, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.centre, steady.β - steady.α, rtol=1e-10)
    np.testing.assert_allclose([found.K_left, found.K_right], steady.K_I, rtol=1e-10)
    np.testing.assert_allclose(found.work_of_friction, 0.0, atol=1e-12)


def test_the_residual_falls_with_the_steps():
    """Friction that stays is a special case, see above."""

    def g(t):
        return -0.5 * np.sin(0.8 * t)

    coarse, fine = (by_integral_equation(SOLID, 0.6, g, 3.0, n, checked=True).residual for n in (4, 8))
    assert fine < min(coarse / 6.0, 1e-3)


def test_the_residual_shows_a_wrong_number(at_once):
    response, scheme, basis, solved = at_once
    residual = Residual(response, SOLID.limit(), scheme.times[:, -1], 16)
    right = residual.of([basis], solved[:, :-1], solved[:, -1])
    # Of the pressure's polynomials, and the indentation.
    for when, number in product((1, 5, 9), (0, 1, 5, -1)):
        wrong = solved.copy()
        wrong[when, number] += 0.05 * np.abs(solved).max()
        assert residual.of([basis], wrong[:, :-1], wrong[:, -1]) > 5.0 * right


def test_panels_hold_the_waves_of_short_steps():
    """Steps of 0.008 a/c_s ask for these s: the slowest wave turns by 2 000 for each a."""
    solid = Isotropic(200e9, 0.25, 7800.0)
    s = np.array([80.0 + 700.0j, 80.0 + 200.0j][: 2 if THOROUGH else 1])
    found, finer = (
        punch.tested(basis := punch.basis(-0.4), basis.tests)
        for punch in (
            Transformed(solid.response(0.6), solid.limit(), s, 2, *finest) for finest in ((), (5e-3,))
        )
    )
    np.testing.assert_allclose(found, finer, rtol=0.0, atol=1e-6 * np.abs(finer).max())


def strains(solid, c, g, s, X):
    """û,X at places under the pressure of a punch at some s, and that pressure."""
    s, response = np.array(s, dtype=complex), solid.response(c)
    transformed = Transformed(response, solid.limit(), s, 14)
    basis = transformed.basis(g)
    (answers,) = transformed.answers(basis)
    a = answers[:, :-1, None]
    return (AlongSurface(response, solid.limit(), s, X).strains(basis) @ a)[..., 0], basis, a


@pytest.mark.parametrize(("solid", "c", "g"), [(SOLID, 0.6, -0.5), (random_solid(1), 0.2, 0.4)])
def test_strain_at_late_times_is_steady(solid, c, g):
    """What is left falls like s, with its logarithm."""
    steady, X, off = FlatPunch(solid.response(c), g), ON_SURFACE[::4], []
    σ, weight = np.nan_to_num(steady.σ_YY(X)), np.minimum(np.sqrt(np.abs(1.0 - X**2)), 1.0)
    for s in (1e-4, 1e-6):
        u_X = strains(solid, c, g, [s], X)[0][0].real
        off.append(np.abs((solid.response(c).σ_XX(u_X, σ, g * σ) - steady.σ_XX(X)) * weight).max())
    assert off[1] < 3e-4
    assert off[1] < 0.05 * off[0]


def test_more_polynomials_leave_the_indentation():
    """What overlaps of two contacts leave out, short ones most, is not enlarged by steep polynomials."""
    response, g = SOLID.response(0.75), 0.9
    punches = (StartingPunch(response, SOLID.limit(), 2.0, 8, terms) for terms in (32, 48))
    few, many = (punch.course(g, load) for punch in punches)
    assert few.v0[-1] == pytest.approx(many.v0[-1], rel=1e-10)
    # K_I converges with the square of their number.
    assert few.K_right[-1] == pytest.approx(many.K_right[-1], rel=1e-4)


def test_stress_ahead_of_a_fast_punch_converges_with_the_steps():
    """There waves of every step are short: the sum over the contact has to follow all of them."""
    response, stresses = SOLID.response(0.85), []
    for k in (1, 2, 4):
        course = StartingPunch(response, SOLID.limit(), 3.0, 9 * k, 12).course(-0.7, load)
        stresses.append(course.σ_XX_right[k - 1 :: k])
    coarse, fine = (np.abs(σ_XX - stresses[-1]).max() for σ_XX in stresses[:2])
    assert fine < coarse / 5.0 and fine < 1e-4 * np.abs(stresses[-1]).max()


@pytest.mark.parametrize("c, g, ramp", [(0.85, -0.4, 1.0), (0.3, 0.3, 0.5)])
def test_intensities_of_fewer_polynomials_are_within_their_estimate(c, g, ramp):
    courses = [
        StartingPunch(SOLID.response(c), SOLID.limit(), 2.0, 16, terms).course(
            g, lambda t: smooth(t, ramp)
        )
        for terms in (32, 72)
    ]
    few, many = (np.array([course.K_left, course.K_right]) for course in courses)
    off = np.abs(few - many).max() / np.abs(many).max()
    assert courses[1].error_of_K_I < off < courses[0].error_of_K_I < 10.0 * off
