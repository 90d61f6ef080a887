import numpy as np
import pytest

from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.integrate import RK4_STABILITY_LIMIT, runge_kutta


def exact(law, f0, s, d):
    """f after slip d from f0."""
    found = law.exact(np.array([f0]), s, 0.0, np.atleast_1d(d))[:, 0]
    return found if np.ndim(d) else float(found[0])


def by_steps(law, f0, s, length, steps):
    return runge_kutta(law, np.array([f0]), s, 0.0, length, steps)[0][:, 0]


def test_the_rate_is_that_of_the_studys_equation():
    law = Dahl(0.7, 25000.0, 1.5)
    for f, s in ((0.2, 1), (0.2, -1), (-0.6, 1)):
        y = 1.0 - s * f / 0.7
        assert law.rate(np.array([f]), s)[0] == pytest.approx(s * 25000.0 * y**1.5, rel=1e-14)


def test_runge_kutta_converges_with_order_four():
    law, length = Dahl(0.7, 25000.0, 1.5), 1e-4
    end = exact(law, 0.0, 1, length)
    errors = [abs(by_steps(law, 0.0, 1, length, n)[-1] - end) for n in (40, 80, 160)]
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 4.0, atol=0.2)


@pytest.mark.parametrize("f0, s, δ", [(0.0, 1, 1.0), (-0.5, 1, 2.0), (0.3, -1, 1.5)])
def test_the_stability_limit_is_that_of_the_steepest_slope(f0, s, δ):
    """The rate is steepest where a stroke starts; h times its slope there is what the scheme bears."""
    steps, length, ε = 20, 1e-4, 1e-6
    law = Dahl(0.5, 1.0, δ)
    slope = abs(law.rate(f0 + ε, s) - law.rate(f0 - ε, s)) / (2.0 * ε)
    λ = RK4_STABILITY_LIMIT * steps / (length * slope)
    by_steps(Dahl(0.5, 0.999 * λ, δ), f0, s, length, steps)
    with pytest.raises(ValueError, match="exact"):
        by_steps(Dahl(0.5, 1.001 * λ, δ), f0, s, length, steps)


@pytest.mark.parametrize("δ", [0.3, 1.0, 1.0 + 1e-12, 2.5])
@pytest.mark.parametrize("x", [1e-300, 1e-12, 1e-3, 0.7])
def test_small_friction_keeps_its_digits(δ, x):
    """From rest f = μ_C (1 - y), and 1 - y is nearly x = λ d/μ_C where that is small."""
    mpmath = pytest.importorskip("mpmath")
    mpmath.mp.dps = 400
    law, d = Dahl(0.7, 0.7, δ), x
    p, X = 1 - mpmath.mpf(δ), mpmath.mpf(law.λ) * mpmath.mpf(d) / mpmath.mpf(law.μ_C)
    y = mpmath.exp(-X) if p == 0 else (1 - p * X) ** (1 / p)
    wanted = mpmath.mpf(law.μ_C) * (1 - y)
    assert exact(law, 0.0, 1, d) == pytest.approx(float(wanted), rel=1e-14)


@pytest.mark.parametrize("δ", [0.3, 0.8, 1.0 - 1e-13, 1.0, 1.0 + 1e-9, 1.5, 2.5])
@pytest.mark.parametrize("share", [1e-6, 0.5, 0.99])
def test_distance_over_which_friction_develops(δ, share):
    """There the law itself is at that share of μ_C."""
    law = Dahl(0.7, 25000.0, δ)
    f = law.exact(law.rest(), 1, 0.0, np.array([law.distance(share)]))[0, 0]
    assert f == pytest.approx(share * law.μ_C, rel=1e-12)
    if δ == 1.0:
        assert law.distance(share) == pytest.approx(-law.μ_C / law.λ * np.log(1.0 - share), rel=1e-9)
