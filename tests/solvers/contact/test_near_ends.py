"""Limits at kinks, from values a little farther away."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from galinx.solvers.approximation import lagrange
from galinx.solvers.contact.recovery import (
    FARTHER,
    KinkedPressure,
    error_at_kink,
    farthest_at_kink,
    towards_kink,
)

GAP = 0.7


def limit(values, exponent, farthest, farther=1.0):
    series = towards_kink(GAP, exponent, farthest, farther)
    return series.limit(values(series.samples))


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


def test_two_limits_that_differ_are_wrong_by_half_of_that():
    limits = np.array([1.0, 3.0])
    assert error_at_kink(limits, limits) == 1.0


def under_a_kink(r, kink):
    """Pressure with two free ends and d log d next to a kink, where it is -2√(1 - kink²)."""
    d = np.abs(r - kink)
    return -np.sqrt(1.0 - r**2) * (2.0 + (r - kink) * np.log(np.maximum(d, 1e-300)))


def nodal_forces(kink, degree):
    """Nodes of facets graded towards a kink and both ends, and the pressure's consistent forces there."""
    places = [-1.0, kink, 1.0]
    towards = 0.3 ** np.arange(16)
    halves = [(a, b, (a + b) / 2.0) for a, b in pairwise(places)]
    edges = [x for a, b, m in halves for x in (*(a + (m - a) * towards), *(b - (b - m) * towards))]
    edges = np.unique([*places, *edges])
    t, w = np.polynomial.legendre.leggauss(40)
    basis = lagrange(np.linspace(0.0, 1.0, degree + 1), (t + 1.0) / 2.0)[0]
    s = np.append((edges[:-1, None] + np.diff(edges)[:, None] * np.arange(degree) / degree).ravel(), 1.0)
    forces = np.zeros(len(s))
    for i, (low, high) in enumerate(pairwise(edges)):
        r = (low + high) / 2.0 + (high - low) / 2.0 * t
        forces[i * degree : (i + 1) * degree + 1] += (
            basis.T @ (under_a_kink(r, kink) * w) * (high - low) / 2.0
        )
    return s, forces


@pytest.mark.parametrize("kink", [0.88, -0.88])
def test_a_limit_at_a_kink_near_an_end_is_as_good_from_the_far_side(kink):
    chart = SimpleNamespace(
        surface_position=lambda s: s, surface_coordinate=lambda r: r, surface_stretch=np.ones_like
    )
    s, forces = nodal_forces(kink, 8)
    pressure = KinkedPressure(s, 8, chart, forces, np.array([kink]), (0.5, 0.5), 1.0, 1e-8)
    exact = -2.0 * np.sqrt(1.0 - kink**2)
    assert pressure.at_kink(0) == pytest.approx(exact, abs=1e-8)
    assert abs(pressure.at_kink(0) - exact) <= pressure.left_at_kinks <= 1e-8
