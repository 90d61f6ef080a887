import numpy as np
import pytest

from galinx.solvers.contact import collocation
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame


@pytest.mark.parametrize("c", [0.0, 4.786e-7, 0.6, 0.9])
@pytest.mark.parametrize("g", [0.0, 0.66, -2.0])
def test_collocation_finds_the_same_coefficients(c, g):
    punch = FlatPunch(MovingFrame(2.0, c), g)
    found = collocation.solve(punch.response, g, 12)
    assert (found.α, found.β) == pytest.approx((punch.α, punch.β), abs=1e-14)
    assert found.c[0] == pytest.approx(-2.0 * punch.K_I, rel=1e-13)
    np.testing.assert_allclose(found.c[1:], 0.0, atol=1e-12)


def test_collocation_of_a_tilted_punch_has_the_known_second_coefficient():
    # c = 0, g = 0, μ v,X = t: σ_YY √(1-r²) = -2/π + t r/n, from H[r/√(1-r²)] = 1.
    frame, tilt = MovingFrame(2.0, 0.0), 0.1
    found = collocation.solve(frame, 0.0, 8, lambda r: np.full_like(r, tilt))
    r = np.linspace(-0.9, 0.9, 7)
    np.testing.assert_allclose(
        found.σ_YY(r) * np.sqrt(1.0 - r**2), -2.0 / np.pi + tilt * r / frame.n, atol=1e-12
    )


def test_the_transform_of_an_expansion_is_that_of_its_pressure():
    """Under the punch it solves the equation; beside it, it is the integral itself."""
    frame, g = MovingFrame(2.2, 0.6), -0.5
    found = collocation.solve(frame, g, 30, np.sin)
    r = np.array([-0.999, -0.5, 0.0, 0.7, 0.9999])
    left = frame.n * found.hilbert(r) - frame.q * g * found.σ_YY(r)
    np.testing.assert_allclose(left, np.sin(r), atol=1e-11)
    t, w = np.polynomial.legendre.leggauss(400)
    for r in (-4.0, -1.3, -1.05, 1.02, 1.2, 9.0):
        # Over each half in τ with distance τ⁸ from its edge, where the pressure grows like a root.
        τ = (t + 1.0) / 2.0
        d, stretch = τ**8, 8.0 * τ**7 / 2.0
        by_halves = [
            np.sum(w * stretch * d**exponent * (2.0 - d) ** (-1.0 - exponent) * found.series(s) / (s - r))
            for exponent, s in ((found.α, 1.0 - d), (found.β, d - 1.0))
        ]
        assert found.hilbert(np.array([r]))[0] == pytest.approx(sum(by_halves) / np.pi, rel=1e-9)
