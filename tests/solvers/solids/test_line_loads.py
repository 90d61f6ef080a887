"""Displacements far from loads: equations, resultants, moments; at rest, at speed, in oblique solids."""

import numpy as np
import pytest
from scipy.integrate import trapezoid

from galinx.solvers.solids.half_plane import DATUM
from galinx.solvers.solids.isotropic import MovingFrame
from galinx.solvers.solids.plane import Orthotropic

OBLIQUE = Orthotropic(14e9, 1e9, 1e9, 0.3, 0.3, 0.4, 0.5e9, 1500.0, 40.0)
RESPONSES = [
    pytest.param(MovingFrame(2.0, 0.0), id="at rest"),
    pytest.param(MovingFrame(2.0, 0.6), id="at speed"),
    pytest.param(MovingFrame(1.0, 0.9), id="incompressible"),
    pytest.param(OBLIQUE.response(0.7 * OBLIQUE.limit()), id="oblique"),
]


@pytest.mark.parametrize("response", [one for one in RESPONSES if one.id != "incompressible"])
def test_line_loads_balance_and_solve_the_equations(response):
    """Their displacements answer the tractions of a moving line load on the surface, and no others."""
    h = 1e-4
    X, Y = np.array([[2.0, -1.0], [-3.0, -0.5], [0.4, -2.0]]).T

    def u(x, y):
        return response.far(x, y)[0]

    def stresses(x, y):
        along = (u(x + h, y) - u(x - h, y)) / (2.0 * h)
        across = (u(x, y + h) - u(x, y - h)) / (2.0 * h)
        return response.stresses(np.moveaxis(np.stack([along, across], axis=-1), 1, 2))

    # Equation of motion along X and Y, ρV² over μ times the second derivative along X.
    step = 1e-2
    σ_X = (stresses(X + step, Y) - stresses(X - step, Y)) / (2.0 * step)
    σ_Y = (stresses(X, Y + step) - stresses(X, Y - step)) / (2.0 * step)
    bent = (u(X - step, Y) - 2.0 * u(X, Y) + u(X + step, Y)) / step**2
    size = np.abs(np.stack([σ_X, σ_Y])).max()
    assert np.abs(σ_X[0] + σ_Y[2] - response.c**2 * bent[:, 0]).max() <= 2e-3 * size
    assert np.abs(σ_X[2] + σ_Y[1] - response.c**2 * bent[:, 1]).max() <= 2e-3 * size
    # All of the load passes through a line below.
    x = np.tan(np.linspace(-1.57, 1.57, 20001))
    through = stresses(x, np.full_like(x, -1.0))
    resultants = trapezoid(through[[1, 2]], x, axis=-1)
    assert np.abs(resultants - [[1.0, 0.0], [0.0, 1.0]]).max() <= 5e-3


@pytest.mark.parametrize("response", RESPONSES)
def test_moments_are_those_of_line_loads_side_by_side(response):
    """Some of these at |s| < 1 look from r = 8 like their moments, but for what the ninth does."""
    s, t = np.array([-0.9, -0.2, 0.3, 0.8]), np.array([[1.0, -0.4, 0.2, 0.7], [0.3, 0.5, -1.0, 0.1]])
    angle = np.linspace(-np.pi, 0.0, 13)
    p = response.contraction  # a circle of the plane midway
    Y = 8.0 * np.sin(angle) / p.imag
    X = 8.0 * np.cos(angle) - p.real * Y
    wanted = sum(np.tensordot(t[:, i], response.far(X - s[i], Y)[0], 1) for i in range(len(s)))
    found = response.far(X, Y, terms=9)
    moments = np.array([[np.sum(one * s**n) for one in t] for n in range(9)])
    left = np.abs(np.einsum("ij,ijkn->kn", moments, found) - wanted).max()
    nearest = 8.0 * np.exp(-response.spread / 2.0)
    assert left <= 10.0 * np.abs(found[0]).max() * nearest**-9


@pytest.mark.parametrize("response", RESPONSES)
def test_the_datum_does_not_move(response):
    """The mean of both sides of the surface there."""
    there = response.far(np.array([-DATUM, DATUM]), np.zeros(2))[0].mean(axis=-1)
    np.testing.assert_allclose(there, 0.0, atol=1e-13)
