"""The largest stresses below a pressure, and how deep it makes the solid yield: Hertz's line contact."""

from itertools import pairwise

import numpy as np
import pytest
from loaded import LoadedHalfPlane, yield_of
from scipy.optimize import brentq

from galinx.solvers.contact.prescribed_pressure import LinearPressure
from galinx.solvers.contact.solution import make_contact
from galinx.solvers.contact.stresses import Turns, von_mises
from galinx.solvers.contact.yielding import InSolid, Levels, Peak, depth_of_yield, peak
from galinx.solvers.profiles.punches import Flat
from galinx.solvers.solids import Isotropic

SOLID = Isotropic(210e9, 0.3, 7850.0)
AT_REST = SOLID.response(0.0)


class Hertz:
    """Φ of σ_YY = -√(1 - X²): z - √(z² - 1)."""

    def at(self, z):
        return z - np.sqrt(z - 1.0) * np.sqrt(z + 1.0)

    def change(self, z, step, share):
        assert share == 0.0
        return step * (1.0 - z / (np.sqrt(z - 1.0) * np.sqrt(z + 1.0)))


def hertz(g):
    """Stresses of Hertz's pressure with σ_XY = g σ_YY at rest."""

    def stresses(points):
        X, Y = np.moveaxis(points, -1, 0)
        σ_YY = -np.sqrt(np.maximum(1.0 - X**2, 0.0))
        H = X - np.sign(X) * np.sqrt(np.maximum(X**2 - 1.0, 0.0))
        on = [AT_REST.σ_XX(AT_REST.q * σ_YY + AT_REST.m * g * H, σ_YY, 0.0), σ_YY + 0.0 * g, g * σ_YY]
        return np.where(Y == 0.0, on, AT_REST.inside(Hertz(), g, X, np.where(Y == 0.0, -1.0, Y)))

    return stresses


def of_pressure(pressure, g, strength=1.0, stresses=None):
    """Yield below a pressure at rest; the strength is over N/(2a)."""
    g = np.asarray(g, dtype=float)
    exact = LoadedHalfPlane(AT_REST, g[:, None], pressure)
    body = make_contact(SOLID, Flat(1e-3), 2e6, pressure, strength * 1e9)
    field = stresses or (lambda points: exact.stresses(points[..., 0], points[..., 1]))
    return yield_of(body, field, AT_REST, g)


def linear(pieces):
    X = -np.cos(np.pi * np.arange(pieces + 1) / pieces)
    X[[0, -1]] = -1.0, 1.0
    return LinearPressure(X, -np.sqrt(1.0 - X**2))


def of_hertz(g, strength=1.0):
    return of_pressure(linear(40), g, strength, hertz(np.asarray(g, dtype=float)[:, None]))


def test_first_yield_with_friction_comes_to_the_surface():
    found = of_hertz([0.0, 0.1, 0.2, 0.3, 0.4, 0.5]).shear
    np.testing.assert_allclose(1.0 / found.value, [3.330, 3.281, 3.135, 2.900, 2.500, 2.000], atol=1e-3)
    assert (found.Y[:4] < -0.3).all() and (found.Y[4:] == 0.0).all()


@pytest.mark.parametrize("strength", [0.5574, 0.4, 0.2])
def test_without_friction_the_zone_is_deepest_in_the_middle(strength):
    def over(Y):
        σ = hertz(0.0)(np.array([0.0, Y]))
        return von_mises(*σ, SOLID.σ_ZZ(*σ)) - strength

    expected = -brentq(over, -8.0, -0.70429)
    np.testing.assert_allclose(of_hertz([0.0], strength).depth, expected, rtol=1e-6)


def test_what_no_solid_carries_has_no_depth():
    assert np.isnan(of_hertz([0.0, 0.5], strength=1e-2).depth).all()


@pytest.mark.parametrize("where, width", [(-0.9, 1e-3), (0.37, 1e-5)])
def test_a_spike_is_found_however_narrow(where, width):
    knots = np.array([-1.0, where - width, where, where + width, 1.0])
    found = of_pressure(LinearPressure(knots, np.array([0.0, -0.1, -3.0, -0.1, 0.0])), [0.0, 0.2])
    alone = LinearPressure(np.array([-1.0, 0.0, 1.0]), np.array([0.0, -2.9, 0.0]))
    single = of_pressure(alone, [0.0, 0.2])
    np.testing.assert_allclose(found.shear.value, single.shear.value, rtol=5e-2)
    assert (np.abs(found.shear.X - where) <= 2.0 * width).all()
    assert (-2.0 * width <= found.shear.Y).all()


def test_a_jump_has_an_infinite_stress_with_friction_alone():
    found = of_pressure(LinearPressure(np.array([-1.0, 1.0]), np.array([-1.0, -1.0])), [0.0, 0.3])
    assert np.isfinite(found.von_mises.value).tolist() == [True, False]
    assert found.first_load[0] > 0.0 and found.first_load[1] == 0.0
    # A strip of even pressure: the largest shear is p/π, on the circle over it.
    np.testing.assert_allclose(found.shear.value[0], 1.0 / np.pi, rtol=1e-6)
    np.testing.assert_allclose(found.shear.X[0] ** 2 + found.shear.Y[0] ** 2, 1.0, rtol=1e-3)


def test_an_island_on_another_side_is_found():
    """Two bumps, of which the right one carries a little more."""
    knots = np.array([-1.0, -0.8, -0.6, 0.5, 0.75, 1.0])
    values = np.array([0.0, -1.0, 0.0, 0.0, -1.001, 0.0])
    for flip in (1, -1):
        pressure = LinearPressure(flip * knots[::flip], values[::flip])
        assert flip * of_pressure(pressure, [0.0]).von_mises.X[0] > 0.5


def test_a_peak_just_beyond_the_nearest_places_beside_a_turn_is_found():
    """Of shear stress, at 1.3 of the distance nearer than which fields are not accurate, and at it."""
    for share in (1.0, 1.3):
        nearest = 1e-3

        def stresses(points, place=share * nearest):
            d = np.hypot(points[..., 0] - 0.4, points[..., 1])
            τ = np.exp(-((np.log(np.maximum(d, 1e-9) / place) / 0.1) ** 2))
            return np.array([0.0 * τ, 0.0 * τ, τ])

        turns = Turns(np.array([[0.4]]), np.zeros((3, 1, 1)))
        body = make_contact(SOLID, Flat(1e-3), 2e6, linear(4), 1e9)
        solid = InSolid(AT_REST, np.zeros(1), None, 1e-3, stresses, turns, nearest)
        assert body.strength(solid).shear.value == pytest.approx(1.0, rel=1e-3)


def test_the_surface_is_sampled_between_all_knots_and_far_beside_them():
    knots = np.array([-1.0, -0.2, 0.1, 1.0])
    places = Levels(knots).places
    X = places[places[:, 1] == 0.0, 0]
    for low, high in pairwise(knots):
        between = X[(low < X) & (high > X)]
        np.testing.assert_allclose(between, low + (high - low) * np.array([0.25, 0.5, 0.75]), rtol=1e-12)
    assert (X.min(), X.max()) == pytest.approx((-11.0, 11.0)) and np.all(np.diff(X) > 0.0)


def test_turns_that_are_named_several_times_change_nothing():
    """States with fewer turns than others name one again and again; the depth was 2e-4 too small."""

    def stress(points):
        assert np.abs(points[..., 0]).max() <= 31.1  # meshes end somewhere
        return 4.0 / np.hypot(points[..., 0] - 0.87, points[..., 1] - 1e-3)

    def depth(turns):
        return depth_of_yield(stress, Peak(*np.array([[4e3], [0.87], [0.0]])), np.array([turns]))

    few = [-1.0, -0.13, 1.0]
    for turns in (few, [*few, -1.0, -1.0, -1.0], [*few, 1.0 + 1e-15, 1.0 - 1e-15, 1.0 + 2e-15]):
        assert depth(turns) == pytest.approx(3.999, rel=1e-7)


def test_places_that_are_named_several_times_take_no_start_from_others():
    """Nine copies of the highest place left no start for the place beside the highest stress."""

    def stress(points):
        X, Y = points[..., 0], points[..., 1]
        near, far = (X - 0.03) ** 2 + (Y + 1.0) ** 2, (X - 5.0) ** 2 + (Y + 1.0) ** 2
        return np.exp(-40.0 * near) + 0.9 * np.exp(-far)

    places = np.array([[[0.1, -1.0], *[[5.0, -1.0]] * 9]])
    found = peak(stress, places, np.full(10, 0.1), stress(places))
    assert found.value == pytest.approx(1.0, rel=1e-6)
