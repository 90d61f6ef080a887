"""Integral equation without layers: sharp punches of any profile on a uniform half-plane."""

import numpy as np
import pytest
from scipy.special import eval_jacobi

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.equation import UNIFORM, Equation, jacobi
from galinx.solvers.solids.isotropic import MovingFrame


def test_polynomials_of_any_weight_are_those_of_jacobi():
    r = np.linspace(-1.0, 1.0, 9)
    for α, β in ((-0.5, -0.5), (-0.7, 0.45), (0.3, 0.9)):
        found = np.array([eval_jacobi(n, α, β, r) for n in range(7)])
        np.testing.assert_allclose(jacobi(7, α, β, r).T, found, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("c", [0.0, 4.786e-7, 0.6, 0.9])
@pytest.mark.parametrize("g", [0.0, 0.66, -2.0])
def test_a_flat_punch_has_one_coefficient(c, g):
    punch = FlatPunch(MovingFrame(2.0, c), g)
    pressure = Equation(punch.response, UNIFORM, g, np.zeros_like).pressure(12)
    assert (pressure.α, pressure.β) == pytest.approx((punch.α, punch.β), abs=1e-14)
    assert pressure.c[0] == pytest.approx(-2.0 * punch.K_I, rel=1e-13)
    np.testing.assert_allclose(pressure.c[1:], 0.0, atol=1e-12)
    np.testing.assert_allclose(pressure.K_I, punch.K_I, rtol=1e-12)


def test_the_transform_of_a_pressure_is_that_of_the_pressure():
    """Under the punch it solves the equation; beside it, it is the integral itself."""
    frame, g = MovingFrame(2.2, 0.6), -0.5
    pressure = Equation(frame, UNIFORM, g, np.sin).pressure(30)
    r = np.array([-0.999, -0.5, 0.0, 0.7, 0.9999])
    left = frame.n * pressure.hilbert(r) - frame.q * g * pressure.σ_YY(r)
    np.testing.assert_allclose(left, np.sin(r), atol=1e-11)
    t, w = np.polynomial.legendre.leggauss(400)
    for r in (-4.0, -1.3, -1.05, 1.005, 1.02, 1.2, 9.0):
        # Over each half in τ with distance τ⁸ from its edge, where the pressure grows like a root.
        τ = (t + 1.0) / 2.0
        d, stretch = τ**8, 8.0 * τ**7 / 2.0
        by_halves = [
            np.sum(w * stretch * d**α * (2.0 - d) ** (-1.0 - α) * pressure.series(s) / (s - r))
            for α, s in ((pressure.α, 1.0 - d), (pressure.β, d - 1.0))
        ]
        assert pressure.hilbert(np.array([r]))[0] == pytest.approx(sum(by_halves) / np.pi, rel=1e-9)
