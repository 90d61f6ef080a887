"""Ends of contacts from moments of weights that are known: the conditions of a uniform half-plane."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from galinx.solvers.contact.ends import SHAPES, EndConditions
from galinx.solvers.errors import SolveError
from galinx.solvers.profiles.punches import Parabolic, Power, RoundedFlat, Table, Wedge

#: a + b = 1, exponents of the pressure at the right and the left end.
A = 0.37
#: Load over that of a slope of one, and the unit of heights [m].
SIZE, UNIT = 2.3, 1e-5


def integral(f, a=A):
    """∫ f (1 - s)^-a (1 + s)^-b ds."""
    b = 1.0 - a
    left = quad(lambda s: f(s) * (1.0 - s) ** -a, -1.0, 0.0, weight="alg", wvar=(-b, 0.0), epsabs=1e-13)[
        0
    ]
    return (
        left
        + quad(lambda s: f(s) * (1.0 + s) ** -b, 0.0, 1.0, weight="alg", wvar=(0.0, -a), epsabs=1e-13)[0]
    )


def conditions(mixed=((1.0, 0.4), (-0.7, 0.9))):
    """Two independent mixtures of ∫ f/w = 0 and ∫ s f/w = SIZE, as two intensities are."""
    T = [np.polynomial.chebyshev.Chebyshev.basis(k) for k in range(SHAPES)]
    moments = np.array([[integral(t), integral(lambda s, t=t: s * t(s))] for t in T]).T
    mixed = np.array(mixed)
    return EndConditions(A - 1.0, -A, mixed @ moments, mixed @ [0.0, SIZE])


@pytest.mark.parametrize(
    "profile",
    [
        Parabolic(0.02), Wedge(0.005), Power(3.0, 1e3), Power(1.3, 0.02), RoundedFlat(1e-4, 0.02),
        Table(((-2e-3, 20e-6), (-1e-3, 6e-6), (0.0, 0.0), (1e-3, 3e-6), (2e-3, 15e-6))),
    ],
)  # fmt: skip
def test_ends_meet_both_conditions(profile):
    m, h = conditions().solve(profile, UNIT)
    kinks = [(x - m) / h for x in getattr(profile, "kinks", ()) if abs(x - m) < h]

    def slope(s):
        return float(h * profile.slope(np.array([m + h * s]))[0]) / UNIT

    def whole(f):
        """∫ f/w by the substitution x = log((1 - s)/(1 + s))."""
        b = 1.0 - A
        x = sorted(np.log((1.0 - k) / (1.0 + k)) for k in kinks)
        places = [-80.0, *x, 80.0]
        return sum(
            quad(
                lambda x: f(-np.tanh(x / 2.0)) * np.exp(b * x) / (1.0 + np.exp(x)),
                p,
                q,
                limit=400,
                epsabs=1e-11,
            )[0]
            for p, q in pairwise(places)
        )

    assert abs(whole(slope)) < 2e-8 * whole(lambda s: abs(slope(s)))
    assert whole(lambda s: s * slope(s)) == pytest.approx(SIZE, rel=2e-8)
    again = conditions(((0.2, 1.0), (0.9, -0.1))).solve(profile, UNIT, (1.3 * m, 0.8 * h))
    np.testing.assert_allclose(again, (m, h), rtol=1e-9)


def test_a_table_that_is_too_narrow_says_so():
    profile = Table(((-2e-4, 1e-6), (0.0, 0.0), (2e-4, 1e-6)))
    with pytest.raises(SolveError, match=r"but the punch is known from -0\.0002 m to 0\.0002 m only"):
        conditions().solve(profile, UNIT)
