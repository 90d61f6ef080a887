"""Pressure at kinks: limits of values a little farther away, and from nodal forces of a known one."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from galinx.solvers.approximation import lagrange
from galinx.solvers.contact.recovery import KinkedPressure, error_at_kink

#: A chart in which surface coordinates are positions.
AS_DRAWN = SimpleNamespace(
    surface_position=lambda s: s, surface_coordinate=lambda r: r, surface_stretch=np.ones_like
)


def kinked(s, degree, forces, kink, σ_YY, exponent, tolerance):
    """Pressure with a kink from nodal forces, known next to its ends."""
    known = SimpleNamespace(σ_YY=lambda r: σ_YY(r)[None])
    return KinkedPressure(
        s,
        degree,
        AS_DRAWN,
        forces,
        np.array([kink]),
        (0.5, 0.5),
        known,
        np.array([exponent]),
        tolerance,
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
    pressure = kinked(s, degree, forces, kink, σ_YY, 1.0, 1e-3)
    exact = -2.0 * np.sqrt(1.0 - kink**2)
    beside = pressure.σ_YY(kink + np.array([-1e-12, 0.0, 1e-12]))
    error = max(np.abs(beside - exact).max(), abs(pressure.at_kink(0) - exact))
    cell = pressure.cells_beside(pressure.kinks)[0]
    # Not more than a tenth of what the pressure changes by over such a cell.
    assert 1e-8 < error <= pressure.left_at_kinks <= 0.1 * cell * np.abs(np.log(cell))


@pytest.mark.parametrize("right", [0.9, 1.3])
def test_where_one_side_of_a_kink_is_exact_the_mean_of_both_is_off_by_its_error(right):
    limits, exact = np.array([1.0, right]), 1.0
    assert error_at_kink(limits, limits) == pytest.approx(abs(limits.mean() - exact), rel=1e-12)


def test_next_to_both_ends_the_pressure_is_the_one_that_holds_there():
    """Twice that of the nodal forces here, to tell them apart."""
    r = np.array([-1.0 + 1e-3, -0.5, 0.7, 1.0 - 1e-3])
    s, forces = nodes_and_forces(facets(0.3, 6), 9, lambda r: -np.sqrt(1.0 - r**2))
    pressure = kinked(s, 9, forces, 0.3, lambda r: -2.0 * np.sqrt(1.0 - r**2), 1.0, 1e-3)
    found = pressure.σ_YY(r)[0] / -np.sqrt(1.0 - r**2)
    np.testing.assert_allclose(found, [2.0, 1.0, 1.0, 2.0], rtol=1e-5)


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
    pressure = kinked(s, degree, forces, kink, σ_YY, power, 1e-9)
    exact = -np.sqrt(1.0 - kink**2)
    cells = kinked(s, degree, forces, kink, σ_YY, 0.0, 1e-9)
    in_cells = cells.σ_YY(np.array([kink]))[0, 0]
    errors = [abs(each - exact) for each in (in_cells, pressure.at_kink(0))]
    assert errors[1] <= min(1e-9, 0.2 * errors[0]) and pressure.left_at_kinks <= 1e-8
    np.testing.assert_allclose(pressure.σ_YY(np.array([kink])), exact, rtol=1e-9)


@pytest.mark.parametrize("kink", [0.3, -0.6])
def test_the_largest_pressure_beside_a_kink(kink):
    """Next to the kink it rises with an infinite slope to a place a hundredth away."""

    def σ_YY(r):
        d = (r - kink) / 4.0
        return -np.sqrt(1.0 - r**2) * (2.0 - d * np.log(np.maximum(np.abs(d), 1e-300)))

    s, forces = nodes_and_forces(facets(kink, 12), 9, σ_YY)
    pressure = kinked(s, 9, forces, kink, σ_YY, 1.0, 1e-8)
    r = np.linspace(-1.0, 1.0, 400_001)
    (value,), (place,) = pressure.largest()
    assert value == pytest.approx(-σ_YY(r).min(), rel=1e-7)
    assert place == pytest.approx(r[σ_YY(r).argmin()], abs=1e-3)


def under_a_kink(r, kink):
    """Pressure with two free ends and d log d next to a kink, where it is -2√(1 - kink²)."""
    d = np.abs(r - kink)
    return -np.sqrt(1.0 - r**2) * (2.0 + (r - kink) * np.log(np.maximum(d, 1e-300)))


@pytest.mark.parametrize("kink", [0.88, -0.88])
def test_a_limit_at_a_kink_near_an_end_is_as_good_from_the_far_side(kink):
    def σ_YY(r):
        return under_a_kink(r, kink)

    s, forces = nodes_and_forces(facets(kink, 16), 8, σ_YY)
    pressure = kinked(s, 8, forces, kink, σ_YY, 1.0, 1e-8)
    exact = -2.0 * np.sqrt(1.0 - kink**2)
    assert pressure.at_kink(0) == pytest.approx(exact, abs=1e-8)
    assert abs(pressure.at_kink(0) - exact) <= pressure.left_at_kinks <= 1e-8
    beside = kink + np.array([-1e-6, 1e-6])
    np.testing.assert_allclose(pressure.σ_YY(beside)[0], σ_YY(beside), rtol=1e-8)
