"""Rational functions through samples: against what they have to reproduce, and how fast they converge."""

import numpy as np
import pytest

from galinx.solvers.approximation import chebyshev_nodes, fit_rational, leja, polynomial_through


def chosen(z, count, first=0):
    """So many of Leja's points."""
    numbers = [first]
    while len(numbers) < count:
        numbers.append(leja(z, numbers))
    return numbers


def error(z, values, count, noise=0.0):
    """Largest error of a fit through some samples at all, and the largest sum of its shares."""
    some = chosen(z, count)
    shares = fit_rational(z[some], values[some], noise).shares(z)
    return np.abs(shares @ values[some] - values).max(), np.abs(shares).sum(axis=1).max()


def test_polynomials_through_chebyshevs_nodes_are_exact():
    rng = np.random.default_rng(1)
    nodes = chebyshev_nodes(9, -1.2, 0.7)
    polynomial = np.polynomial.Polynomial(rng.normal(size=9))
    z = np.concatenate([rng.uniform(-1.2, 0.7, 50), nodes[:3]])
    through = polynomial_through(nodes)
    shares = through.shares(z)
    np.testing.assert_allclose(shares @ polynomial(nodes), polynomial(z), rtol=0.0, atol=1e-13)
    np.testing.assert_array_equal(shares[-3:], np.eye(9)[:3])
    weights = (-1.0) ** np.arange(9) * np.sin(np.pi * (np.arange(9) + 0.5) / 9)
    ratio = through.weights / weights
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-12)


@pytest.mark.parametrize("seed", range(20))
def test_functions_with_few_poles_in_common_are_told_exactly(seed):
    rng = np.random.default_rng(seed)
    poles, amounts = 1.0 + rng.uniform(0.05, 2.0, 3), rng.normal(size=(3, 40))
    z = np.sort(rng.uniform(-1.0, 1.0, 60))
    values = (1.0 / (z[:, None] - poles)) @ amounts + rng.normal(size=40)
    off, _ = error(z, values, 7)
    assert off <= 1e-9 * np.abs(values).max()


def test_it_converges_faster_than_a_polynomial_beside_a_pole_and_a_branch_point():
    z = np.linspace(0.0, 1.0, 200)
    amounts = np.linspace(0.5, 2.0, 30)
    bend, wave = np.sqrt(1.15 - z)[:, None], np.sin(np.outer(3.0 * z, amounts))
    values = bend * amounts + wave / (1.02 - z[:, None])
    values /= np.abs(values).max()
    errors = np.array([error(z, values, count)[0] for count in (6, 8, 10, 12)])
    some = chosen(z, 12)
    polynomial = polynomial_through(z[some]).shares(z) @ values[some]
    assert errors[-1] < 1e-6 < 1e-3 * np.abs(polynomial - values).max()
    assert np.all(errors[1:] < 0.3 * errors[:-1])


@pytest.mark.parametrize("seed", range(10))
def test_noise_makes_no_poles(seed):
    rng = np.random.default_rng(seed)
    z = np.linspace(0.0, 1.0, 300)
    values = np.exp(np.outer(z, rng.normal(size=50))) + 1e-10 * rng.normal(size=(300, 50))
    off, largest = error(z, values, 13, noise=1e-8)
    assert off <= 1e-7 and largest < 1e3


def test_leja_begins_at_the_ends_and_takes_no_point_twice():
    z = np.array([0.3, 0.0, 1.0, 0.3, 0.5, 1.0 - 1e-13, 0.9])
    numbers = chosen(z, 5, first=2)
    assert numbers[:2] == [2, 1]
    assert sorted(z[numbers].tolist()) == [0.0, 0.3, 0.5, 0.9, 1.0]
    assert leja(z, numbers) is None
    assert leja(np.zeros(4), [0]) is None
