"""Pressure at kinks: limits of values a little farther away, and from nodal forces of a known one."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from galinx.solvers.approximation import lagrange
from galinx.solvers.contact.recovery import (
    FARTHER,
    ContactFacets,
    KinkedPressure,
    error_at_kink,
    farthest_at_kink,
    towards_kink,
)

#: A chart in which surface coordinates are positions.
AS_DRAWN = SimpleNamespace(
    surface_position=lambda s: s, surface_coordinate=lambda r: r, surface_stretch=np.ones_like
)


def facets(kink, rings):
    """Ends of facets graded towards a kink and both ends of the contact."""
    towards = 0.3 ** np.arange(rings)
    halves = [(at, (low + high) / 2.0) for low, high in pairwise([-1.0, kink, 1.0]) for at in (low, high)]
    return np.unique(
        [-1.0, kink, 1.0, *(x for at, middle in halves for x in at + (middle - at) * towards)]
    )


def nodes_and_forces(ends, degree, σ_YY):
    """Nodes on facets between ``ends``, and consistent forces there."""
    t, w = np.polynomial.legendre.leggauss(60)
    basis = lagrange(np.linspace(0.0, 1.0, degree + 1), (t + 1.0) / 2.0)[0]
    sizes = np.diff(ends)
    s = np.append((ends[:-1, None] + sizes[:, None] * np.arange(degree) / degree).ravel(), 1.0)
    forces = np.zeros(len(s))
    for i, (start, size) in enumerate(zip(ends, sizes)):
        nodes = slice(i * degree, (i + 1) * degree + 1)
        forces[nodes] += basis.T @ (σ_YY(start + size * (t + 1.0) / 2.0) * w) * size / 2.0
    return s, forces


def test_a_product_with_a_function_has_the_nodal_forces_of_the_product():
    ends, degree = facets(0.3, 4), 5
    s, forces = nodes_and_forces(ends, degree, lambda r: r**5 - 2.0)
    _, expected = nodes_and_forces(ends, degree, lambda r: (1.0 + r**3) * (r**5 - 2.0))
    found = ContactFacets(s, degree, AS_DRAWN).product(lambda r: 1.0 + r**3) @ forces
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("degree", [6, 9])
@pytest.mark.parametrize("rings", [4, 5, 6])
@pytest.mark.parametrize("kink", [0.0, -0.55, 0.8])
@pytest.mark.parametrize("lean", [0.0, 1.0])
def test_the_error_of_innermost_cells_is_in_that_of_limits_at_kinks(kink, rings, degree, lean):
    """It hardly falls with the degree, and may be of one sign on both sides of the kink."""

    def σ_YY(r):
        d = np.abs(r - kink)
        side = (1.0 - lean) + lean * np.sign(r - kink)
        return np.sqrt(1.0 - r**2) * (side * d * np.log(np.maximum(d, 1e-300)) - 2.0)

    s, forces = nodes_and_forces(facets(kink, rings), degree, σ_YY)
    pressure = KinkedPressure(s, degree, AS_DRAWN, forces, np.array([kink]), (0.5, 0.5), 1.0, 1e-3)
    exact = -2.0 * np.sqrt(1.0 - kink**2)
    beside = pressure.σ_YY(kink + np.array([-1e-12, 0.0, 1e-12]))
    error = max(np.abs(beside - exact).max(), abs(pressure.at_kink(0) - exact))
    cell = pressure.cells_beside(pressure.kinks)[0]
    # Not more than a tenth of what the pressure changes by over such a cell.
    assert 1e-8 < error <= pressure.left_at_kinks <= 0.1 * cell * np.abs(np.log(cell))


@pytest.mark.parametrize("power", [2.0, 2.05, 2.5])
@pytest.mark.parametrize("rings", [9, 12])
def test_at_the_kink_of_a_smoother_punch_rounding_of_small_cells_does_not_show(power, rings):
    """|X|^k, k > 2: the pressure leaves its value there with d^(k - 1), with d² log d for k = 3."""
    rng, kink, degree = np.random.default_rng(1), 0.1, 9

    def σ_YY(r):
        d = np.maximum(np.abs(r - kink), 1e-300)
        return -np.sqrt(1.0 - r**2) * (1.0 + d**power * (np.log(d) if power == 2.0 else 1.0))

    s, forces = nodes_and_forces(facets(kink, rings), degree, σ_YY)
    forces = forces + 1e-14 * rng.uniform(-1.0, 1.0, len(forces))
    pressure = KinkedPressure(s, degree, AS_DRAWN, forces, np.array([kink]), (0.5, 0.5), power, 1e-9)
    exact = -np.sqrt(1.0 - kink**2)
    cells = KinkedPressure(s, degree, AS_DRAWN, forces, np.array([kink]), (0.5, 0.5), 0.0, 1e-9)
    errors = [abs(each.at_kink(0) - exact) for each in (cells, pressure)]
    assert errors[1] <= min(1e-9, 0.2 * errors[0]) and pressure.left_at_kinks <= 1e-8
    np.testing.assert_allclose(pressure.σ_YY(np.array([kink])), exact, rtol=1e-9)


def test_the_largest_pressure_of_a_punch_whose_kinks_are_beside_the_contact():
    s, forces = nodes_and_forces(np.linspace(-1.0, 1.0, 9), 8, lambda r: (r**2 - 1.0) * (1.0 + 0.1 * r))
    pressure = KinkedPressure(s, 8, AS_DRAWN, forces, np.empty(0), (1.0, 1.0), exponent=1.0)
    place = (np.sqrt(103.0) - 10.0) / 3.0
    highest = (1.0 - place**2) * (1.0 + 0.1 * place)
    np.testing.assert_allclose(np.ravel(pressure.largest()), [highest, place], rtol=1e-8)


@pytest.mark.parametrize("kink", [0.3, -0.6])
def test_the_largest_pressure_beside_a_kink(kink):
    """Next to the kink it rises with an infinite slope to a place a hundredth away."""

    def σ_YY(r):
        d = (r - kink) / 4.0
        return -np.sqrt(1.0 - r**2) * (2.0 - d * np.log(np.maximum(np.abs(d), 1e-300)))

    s, forces = nodes_and_forces(facets(kink, 12), 9, σ_YY)
    pressure = KinkedPressure(s, 9, AS_DRAWN, forces, np.array([kink]), (0.5, 0.5), 1.0, 1e-8)
    r = np.linspace(-1.0, 1.0, 400_001)
    (value,), (place,) = pressure.largest()
    assert value == pytest.approx(-σ_YY(r).min(), rel=1e-7)
    assert place == pytest.approx(r[σ_YY(r).argmin()], abs=1e-3)


@pytest.mark.parametrize("seed", range(20))
def test_the_largest_pressure_may_be_on_either_side_of_a_node_of_two_facets(seed):
    """Both facets have their own place of the node, a rounding apart, and their own value there."""
    rng = np.random.default_rng(seed)
    top = 0.25 + rng.uniform(-5e-3, 5e-3)
    lean = 2.0 * top / (1.0 - 3.0 * top**2)

    def position(s):
        ends = np.reshape(s, (-1, 9)) if np.size(s) % 9 == 0 else np.reshape(s, (-1, 1))
        return (ends - 1e-15 * (np.arange(ends.shape[1]) == 8)).reshape(np.shape(s))

    chart = SimpleNamespace(**vars(AS_DRAWN) | {"surface_position": position})
    s, forces = nodes_and_forces(np.linspace(-1.0, 1.0, 9), 8, lambda r: (r**2 - 1.0) * (1.0 + lean * r))
    forces *= 1.0 + 1e-6 * rng.uniform(-1.0, 1.0, len(forces))
    pressure = KinkedPressure(s, 8, chart, forces, np.empty(0), (1.0, 1.0))
    p = -pressure.σ_YY(np.linspace(-0.99, 0.99, 200001))
    assert pressure.largest()[0] >= p.max() - 1e-8


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
    # The error goes with the cube of the distance.
    assert farthest_at_kink(8e-9) == pytest.approx(2.0 * farthest_at_kink(1e-9))


def test_two_limits_that_differ_are_wrong_by_half_of_that():
    limits = np.array([1.0, 3.0])
    assert error_at_kink(limits, limits) == 1.0


def under_a_kink(r, kink):
    """Pressure with two free ends and d log d next to a kink, where it is -2√(1 - kink²)."""
    d = np.abs(r - kink)
    return -np.sqrt(1.0 - r**2) * (2.0 + (r - kink) * np.log(np.maximum(d, 1e-300)))


@pytest.mark.parametrize("kink", [0.88, -0.88])
def test_a_limit_at_a_kink_near_an_end_is_as_good_from_the_far_side(kink):
    s, forces = nodes_and_forces(facets(kink, 16), 8, lambda r: under_a_kink(r, kink))
    pressure = KinkedPressure(s, 8, AS_DRAWN, forces, np.array([kink]), (0.5, 0.5), 1.0, 1e-8)
    exact = -2.0 * np.sqrt(1.0 - kink**2)
    assert pressure.at_kink(0) == pytest.approx(exact, abs=1e-8)
    assert abs(pressure.at_kink(0) - exact) <= pressure.left_at_kinks <= 1e-8
    for beside, left in (
        (kink + np.array([-1e-6, 1e-6]), 1e-8),
        (np.array([-1.0, 1.0]) * (1.0 - 1e-6), 1e-5),
    ):
        np.testing.assert_allclose(pressure.σ_YY(beside)[0], under_a_kink(beside, kink), rtol=left)


def test_samples_beside_a_kink_reach_over_its_cell_and_no_nearer_neighbour():
    """Each side by itself: two of the long cells on the left, 0.02 of the short way to the end."""
    ends = facets(0.8, 5)
    s, forces = nodes_and_forces(ends, 5, lambda r: -np.sqrt(1.0 - r**2))
    pressure = KinkedPressure(s, 5, AS_DRAWN, forces, np.array([0.8]), (0.5, 0.5), 1.0, 1e-3)
    left, right = (pressure._series(0, side).samples.max() for side in (-1.0, 1.0))
    cell = np.diff(ends)[np.flatnonzero(ends == 0.8)[0] - 1]
    assert left == pytest.approx(2.0 * cell, rel=0.02) and right == pytest.approx(0.02 * 0.2, rel=0.02)
