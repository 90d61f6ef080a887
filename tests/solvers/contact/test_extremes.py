"""Largest values of functions and sampled curves of which the largest is known."""

from types import SimpleNamespace

import numpy as np
import pytest

from galinx.solvers.contact import stresses
from galinx.solvers.contact.extremes import (
    ALONG,
    FEWER,
    FINER,
    between,
    extreme,
    highest,
    largest,
    settled,
    tops,
)
from galinx.solvers.contact.stresses import at_and_between
from galinx.solvers.solids.isotropic import Isotropic


@pytest.mark.parametrize("place", [-0.9, 0.0, 0.37, 0.999])
def test_the_largest_between_two_roots_of_the_distance(place):
    """(1 - r)^a (1 + r)^b is largest at (b - a)/(a + b)."""
    a, b = 1.0 - place, 1.0 + place
    function = lambda r: (1.0 - r) ** a * (1.0 + r) ** b  # noqa: E731
    value, at = largest(function, [*between(np.array([-1.0, 1.0]), FINER)], ends=False)
    assert value == pytest.approx(function(place), rel=1e-11) and at == pytest.approx(place, abs=1e-9)


@pytest.mark.parametrize("slope", [-9.0, -3.0, 0.0, 0.5])
def test_the_largest_beside_a_kink_where_the_slope_is_infinite(slope):
    """s d - d log d is largest at the distance d = exp(s - 1), however near that is."""
    kink, d = 0.2, np.exp(slope - 1.0)
    function = lambda r: (r - kink) * (slope - np.log(np.abs(r - kink)))  # noqa: E731
    value, at = largest(function, [*between(np.array([-1.0, kink, 1.0]), FINER)], ends=False)
    assert value == pytest.approx(d, rel=1e-9) and at == pytest.approx(kink + d, abs=1e-8)


@pytest.mark.parametrize("place", [-2.2, -0.6, 0.37, 1.7])
def test_curves_along_the_surface_are_highest_under_the_punch_or_beside_it(place):
    X, none = np.linspace(-3.0, 3.0, 241), np.empty((1, 0))
    turns = stresses.Turns(none, np.empty((3, 1, 0)), None)
    value, at = highest(*stresses.on_surface(X, np.exp(-((X - place) ** 2))[None], turns))
    assert value[0] == pytest.approx(1.0, abs=1e-6) and at[0] == pytest.approx(place, abs=1e-3)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("place", [-0.9, 0.0, 0.37, 0.769])
def test_the_stress_between_turns_is_highest_between_its_samples(place, sign):
    """(1 - X)^(2 - 2p) (1 + X)^(2 + 2p) is largest at p, over one interval and beside a turn."""
    a, b = 2.0 - 2.0 * place, 2.0 + 2.0 * place
    top = (1.0 - place) ** a * (1.0 + place) ** b
    stress = lambda X: sign * (1.0 - X)[None] ** a * (1.0 + X)[None] ** b / top  # noqa: E731
    for inner in ([], [(place - 1.0) / 2.0], [0.95]):
        _, found = at_and_between(np.array([-1.0, *inner, 1.0]), stress)
        at, value = found[:, 0 if sign > 0.0 else 1, 0]
        assert value == pytest.approx(sign, rel=3e-8) and at == pytest.approx(place, abs=1e-5)
    # What is not known next to a turn does not count.
    wrong = lambda X: stress(X) + sign * 9.0 * ((X > -1.0) & (X < -1.0 + 1e-4))  # noqa: E731
    _, found = at_and_between(np.array([-1.0, 1.0]), wrong, nearest=1e-3)
    assert found[:, 0 if sign > 0.0 else 1, 0] == pytest.approx(np.array([place, sign]), abs=1e-5)


@pytest.mark.parametrize("free", [0, 1])
def test_at_a_free_end_stress_is_the_limit_of_that_outside(free):
    d, side, exponents = np.geomspace(1e-7, 1e-4, 30), (-1.0, 1.0)[free], np.array([-0.4, -0.4])
    exponents[free] = 0.6
    outside = SimpleNamespace(X=np.sort(side * (1.0 + d)))
    σ_XX = 3.0 - 2.0 * (np.abs(outside.X) - 1.0) ** 0.6
    local = SimpleNamespace(β=exponents[:1], α=exponents[1:])
    turns = stresses.turns_at_ends(SimpleNamespace(places=outside, σ_XX=σ_XX[None]), local)
    np.testing.assert_array_equal(turns.X, [[-1.0, 1.0]])
    expected = np.where(np.arange(2) == free, 3.0, np.nan)
    np.testing.assert_allclose(turns.σ[0, 0], expected, rtol=1e-9)


def test_flatness_compares_slopes_under_the_punch_with_those_beside_it():
    X = np.array([-1.5, -1.05, -0.95, -0.5, 0.9, 1.1])
    v_X = np.array([[4.0, 99.0, 99.0, -1.0, 0.5, -2.0], [2.0, 0.0, 0.0, 0.0, -1.0, 0.0]])
    surface = stresses.Surface(stresses.Places(X, np.empty((0, 2))), v_X, v_X, v_X=v_X)
    np.testing.assert_array_equal(stresses.flatness(surface), [0.25, 0.5])


def test_stress_measures_follow_from_principal_stresses():
    random = np.random.default_rng(5)
    XX, YY, XY = random.normal(size=(3, 200))
    for plane in ("strain", "stress"):
        ZZ = Isotropic(1.0, 0.3, 1.0, plane).σ_ZZ(XX, YY, XY)
        tensor = np.zeros((200, 3, 3))
        tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 2, 2] = XX, YY, ZZ
        tensor[:, 0, 1] = tensor[:, 1, 0] = XY
        deviator = np.linalg.eigvalsh(
            tensor - np.trace(tensor, axis1=1, axis2=2)[:, None, None] * np.eye(3) / 3
        )
        expected = np.sqrt(1.5 * (deviator**2).sum(axis=1))
        np.testing.assert_allclose(stresses.von_mises(XX, YY, XY, ZZ), expected, rtol=1e-12)
        # Hooke's law: no strain, or no stress, out of the plane.
        held = ZZ - 0.3 * (XX + YY) if plane == "strain" else ZZ
        np.testing.assert_allclose(held, 0.0, atol=1e-15)
        low, high = np.linalg.eigvalsh(tensor[:, :2, :2]).T
        np.testing.assert_allclose(stresses.maximum_shear(XX, YY, XY), (high - low) / 2.0, rtol=1e-12)
        np.testing.assert_allclose(stresses.principal(XX, YY, XY), [high, low], atol=1e-12)


def test_no_polynomial_goes_through_samples_of_two_pieces():
    u = np.linspace(-1.0, 1.0, 41)
    curve = np.where(u < 0.0, 1.0 - (u + 0.12) ** 2, -5.0 + u)[None]
    heights, places = tops(u, curve, (u >= 0.0)[None].astype(int))
    height, place = highest(heights, places)
    assert height[0] == pytest.approx(1.0, abs=1e-12) and place[0] == pytest.approx(-0.12, abs=1e-9)


@pytest.mark.parametrize("copies", [2, 3, 5])
def test_positions_that_coincide_by_rounding_are_one(copies):
    """Of three that do two were left, through which no polynomial goes: kinks at round places."""
    X = 0.31 * np.arange(-12.0, 13.0)
    X = np.sort(np.append(X, X[16] + 2.3e-16 * np.arange(1.0, copies)))

    def function(x):
        return np.cosh((x - 1.13) / 1.5)[None] ** -2.0

    for value, place in (extreme(function(X), X, 1.0, n) for n in (ALONG, FEWER)):
        assert abs(value[0] - 1.0) < 1e-4 and abs(place[0] - 1.13) < 0.01
    ends = np.array([[extreme(function(X), X, 1.0, n) for n in (ALONG, FEWER)]])
    best = settled(function, X, function(X), np.swapaxes(ends, 1, 2), 1e-8)
    np.testing.assert_allclose(best[0, :, 0], [1.0, 1.13], rtol=1e-8)


@pytest.mark.parametrize("width", [0.6, 0.5])
def test_what_samples_do_not_settle_the_function_does(width):
    """Peaks that are hardly wider than samples are apart; two all but tie."""
    X = 0.31 * np.arange(-12.0, 13.0)

    def function(x):
        one, other = (np.cosh((x - at) / width) ** -2.0 for at in (-1.0, 1.13))
        return np.array([one + 1.0001 * other, -one - 1.0002 * other])

    values, places = function(X), np.linspace(1.1, 1.2, 100001)
    ends = np.array([[extreme(values, X, s, n) for n in (ALONG, FEWER)] for s in (1.0, -1.0)])
    best = settled(function, X, values, np.swapaxes(ends, 1, 2), 1e-8)
    for end, curve, sign in ((0, 0, 1.0), (1, 1, -1.0)):
        exact = (sign * function(places)[curve]).max()
        assert abs(sign * best[end, 0, curve] - exact) < 1e-8 * exact
        assert abs(best[end, 1, curve] - 1.13) < 0.01
        assert abs(ends[end, 0, 0, curve] - best[end, 0, curve]) > 1e-7
