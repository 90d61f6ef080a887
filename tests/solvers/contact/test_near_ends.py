"""Limits at kinks, from values a little farther away."""

import numpy as np
import pytest

from galinx.solvers.contact.free_ends import FARTHER, error_at_kink, farthest_at_kink, towards_kink

GAP = 0.7


def limit(values, exponent, farthest, farther=1.0):
    series = towards_kink(GAP, exponent, farthest, farther)
    return series.through(values(series.samples))(np.zeros(1))[0]


@pytest.mark.parametrize("exponent", [0.25, 0.5, 0.9, 1.0])
def test_a_limit_is_that_of_a_smooth_function_and_another_times_a_power_or_a_logarithm(exponent):
    def values(d):
        rest = d**exponent * np.log(d) ** (exponent == 1.0)
        return 2.0 - d + 3.0 * d**2 + (1.5 + d - d**2 * (exponent < 1.0)) * rest

    assert limit(values, exponent, 1e-2) == pytest.approx(2.0, rel=1e-10)


@pytest.mark.parametrize("exponent", [0.25, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("opposite", [1.0, -1.0])
def test_what_a_limit_leaves_out_is_in_its_error(exponent, opposite):
    """Also where both sides are wrong by as much, and do not differ."""

    def varies(d):
        rest = d**exponent * np.log(d) ** (exponent == 1.0)
        return np.exp(4.0 * d) * (np.cos(9.0 * d) + np.sin(5.0 * d + 1.0) * rest) - 1.0

    farthest = farthest_at_kink(1e-6)
    sides = lambda d: 3.0 + varies(d), lambda d: 3.0 + opposite * varies(d)
    usual, farther = (
        np.array([limit(side, exponent, farthest, by) for side in sides]) for by in (1.0, FARTHER)
    )
    true = np.abs(usual - 3.0).max()
    assert 1e-12 < true <= error_at_kink(usual, farther) <= 30.0 * true
