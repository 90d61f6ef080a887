import numpy as np
import pytest

from galinx.solvers.sie import collocation
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame


@pytest.mark.parametrize("c", [0.0, 4.786e-7, 0.6, 0.9])
@pytest.mark.parametrize("g", [0.0, 0.66, -2.0])
def test_collocation_finds_the_same_coefficients(c, g):
    punch = FlatPunch(MovingFrame(2.0, c), g)
    found = collocation.solve(punch.frame, g, 12)
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
