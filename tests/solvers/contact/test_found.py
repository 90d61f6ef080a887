"""Contacts whose ends are found, against formulas; other profiles in test_inside_any_solid.py."""

import mpmath as mp
import numpy as np
import pytest
from random_solids import random_solid, stiffness
from scipy.integrate import quad
from stroh import Stroh
from support import THOROUGH

from galinx.solvers.contact.closed_form import FlatPunch, contacts
from galinx.solvers.errors import SolveError
from galinx.solvers.profiles import PROFILES
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame

flat, parabolic, rounded, table = (
    PROFILES[name] for name in ("flat", "parabolic", "rounded_flat", "table")
)
LOAD = 1e-7  # N/μ [m]


def exponents(n, q, n12, g):
    """a and b: the flat punch's exponents and one."""
    cot = mp.mpf(g) * q / (n + mp.mpf(g) * n12)
    a = mp.mpf(1) / 2 - mp.atan(cot) / mp.pi
    return a, 1 - a


def parabola(n, q, n12, g, radius, load):
    """Half-width, centre, largest pressure over N/(2h) and its place, by the exact formulas."""
    a, b = exponents(n, q, n12, g)
    N̂ = n + mp.mpf(g) * n12
    h = mp.sqrt(load * radius * N̂ / (2 * mp.pi * a * b))
    p0 = h * mp.sin(mp.pi * a) / (radius * N̂)
    top = (1 - (b - a)) ** a * (1 + (b - a)) ** b
    return h, h * (b - a), p0 * top * 2 * h / load, b - a


def known(seed, c=None):
    """A random solid's response, and n, q, n12 of it by Stroh's eigenvectors."""
    solid, rng = random_solid(seed), np.random.default_rng(100 + seed)
    response = solid.response(float(rng.uniform(0.0, 0.99) * solid.limit()) if c is None else c)
    n, _, n12, q = Stroh(stiffness(response), response.c).surface
    return response, (n, q, n12), float(rng.uniform(-1.2, 1.2))


@pytest.mark.parametrize("seed", range(60) if THOROUGH else range(0, 60, 5))
def test_a_parabola_is_that_of_the_formulas(seed):
    response, constants, g = known(seed)
    found = contacts(response, np.array([g]), parabolic(0.3), LOAD)
    h, m, top, place = parabola(*constants, g, mp.mpf("0.3"), mp.mpf(LOAD))
    value, where = found.largest()
    got = [found.of("half_width")[0], found.of("centre")[0] / h, value[0], where[0]]
    wanted = [float(h), float(m / h), float(top), float(place)]
    np.testing.assert_allclose(np.array(got, dtype=float), wanted, rtol=1e-11, atol=1e-12)
    a, b = exponents(*constants, g)
    r = np.array([-1 + 1e-6, -0.9, -0.2, 0.0, 0.4, 0.99])
    w = [float((1 - mp.mpf(x)) ** a * (1 + mp.mpf(x)) ** b) for x in r]
    peak = float(top / ((1 - place) ** a * (1 + place) ** b))
    np.testing.assert_allclose(found.on_surface(r)[1][0], -peak * np.array(w), rtol=1e-11)


SHAPE = (
    (-2e-3, 9e-6), (-1.1e-3, 3.5e-6), (-0.4e-3, 0.6e-6), (0.1e-3, 0.0), (0.9e-3, 0.7e-6), (1.5e-3, 3e-6),
    (2.5e-3, 11e-6),
)  # fmt: skip


@pytest.mark.parametrize("g", [-0.8, 0.0, 0.5])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_tilted_punch_lifts_off_where_its_intensity_vanishes(g, side):
    response, a = random_solid(1).response(0.2), 1e-3
    local = FlatPunch(response, g)
    share = 1.0 + (local.α if side > 0 else local.β)
    n = response.n + g * response.n12
    threshold = np.degrees(LOAD * n / (2.0 * np.pi * share * a))
    tilts = side * threshold * np.array([0.0, 0.5, 1.0 - 1e-9, 1.0 + 1e-9, 2.0, 20.0])
    found = [contacts(response, np.array([g]), flat(a, tilt), LOAD) for tilt in tilts.tolist()]
    h, m = (np.array([one.of(key)[0] for one in found]) for key in ("half_width", "centre"))
    K = np.array([one.of("K_I")[0] for one in found])
    higher = 1 if side > 0 else 0
    assert K[0] == pytest.approx([local.K_I] * 2, rel=1e-14)
    np.testing.assert_allclose(K[:, higher], K[0, higher] * np.array([1, 0.5, 0, 0, 0, 0]), atol=2e-9)
    np.testing.assert_allclose(h / a, [1, 1, 1, 1, 0.5, 0.05], rtol=1e-8)
    np.testing.assert_allclose(m / a, side * (h / a - 1.0), atol=1e-12)
    r = np.linspace(-0.9, 0.9, 7)
    np.testing.assert_allclose(found[2].on_surface(r)[1], found[3].on_surface(r)[1], rtol=1e-7)
    z = r - 1e-13j
    for one, tilt, width in zip(found, tilts, h):
        Φ = one.groups[0].pressure.at(z)[0]
        wanted = np.radians(tilt) * 2.0 * width / LOAD
        found_slope = n * Φ.real + g * response.q * Φ.imag
        np.testing.assert_allclose(found_slope, wanted, atol=1e-9 * max(wanted.max(), -wanted.min(), 1.0))


@pytest.mark.parametrize("seed", range(40))
def test_far_points_of_a_table_leave_no_step_under_a_kink(seed):
    """A step of the height, however small, is an infinite pressure there."""
    rng = np.random.default_rng(seed)
    X = np.sort(np.append(rng.choice([-1.0, 1.0], 5) * 10.0 ** rng.uniform(-6.0, -3.0, 5), [-0.2, 0.2]))
    punch = table(tuple(zip(X.tolist(), (12.0 * X**2).tolist())))
    at = np.array(punch.kinks)
    before, after = (punch.height(np.nextafter(at, side)) for side in (-np.inf, np.inf))
    np.testing.assert_allclose(before, after, rtol=1e-13)
    slope, heights = punch.slope(at), punch.height(at)
    rises = np.diff(at) * (slope[1:] + slope[:-1]) / 2.0
    np.testing.assert_allclose(np.diff(heights), rises, rtol=1e-12, atol=1e-12 * heights[1:-1].max())


def test_what_has_no_contact_says_so():
    with pytest.raises(SolveError, match="Rayleigh"):
        contacts(MovingFrame(2.0, 0.95), np.zeros(1), parabolic(1.0), LOAD)
    with pytest.raises(SolveError, match=r"known from -0\.002 m to 0.0025 m only"):
        contacts(MovingFrame(2.0, 0.5), np.zeros(1), table(SHAPE), 1e-3)
    for side in (1.0, -1.0):  # at one end alone
        known = sorted((side * X, X**2) for X in (-0.1, 0.0, 0.3, 1.0, 3.0))
        with pytest.raises(SolveError, match="known from"):
            contacts(MovingFrame(2.0, 0.5), np.zeros(1), table(tuple(known)), 1.0)

    class Hollow:
        """A punch of a user's own that is not convex."""

        sharp, kinks = (False, False), ()

        def slope(self, X):
            return -X

        def words(self):
            return "hollow"

    with pytest.raises(SolveError, match="convex"):
        contacts(MovingFrame(2.0, 0.5), np.zeros(1), Hollow(), LOAD)


def moment_of_shoulders(k, a, left, right):
    """∫ s^k |s - end of the flat part| sign(s)/w ds outside a flat part, by QUADPACK."""

    def of_right(s):
        return s**k * (s - right) * (1.0 + s) ** (a - 1.0)

    def of_left(s):
        return s**k * (s - left) * (1.0 - s) ** -a

    exact = {"weight": "alg", "epsabs": 0.0, "epsrel": 1e-12}
    found = quad(of_right, right, 1.0, wvar=(0.0, -a), **exact)[0]
    return found + quad(of_left, -1.0, left, wvar=(a - 1.0, 0.0), **exact)[0]


@pytest.mark.parametrize("b", [1e-6, 1e-4, 3e-3])
@pytest.mark.parametrize("share", [0.01, 0.3, 0.84, 0.985, 0.999])
def test_a_contact_little_wider_than_the_flat_part_is_found(b, share):
    response, R, h, φ = Isotropic(2e11, 0.3, 7850.0).response(0.0), 0.01, b / share, np.arcsin(share)
    # The load of the conditions in closed form, without friction.
    load = h**2 / (response.n * R) * (np.pi / 2.0 - φ - share * np.sqrt(1.0 - share**2))
    all_g = np.array([0.0, -0.8, 0.8])
    found = contacts(response, all_g, rounded(b, R), load)
    assert found.of("half_width")[0] == pytest.approx(h, rel=1e-13)
    assert abs(found.of("centre")[0]) <= 1e-15 * h
    ends = zip(all_g[1:], found.of("centre")[1:], found.of("half_width")[1:])
    for g, m, h in ends:
        a, left, right = 1.0 + float(FlatPunch(response, g).α), (-b - m) / h, (b - m) / h
        assert -1.0 < left < right < 1.0
        lifted, carried = (moment_of_shoulders(k, a, left, right) for k in (0, 1))
        assert abs(lifted) <= 1e-9 * carried
        n = response.n + g * response.n12
        assert h**2 / R * np.sin(np.pi * a) / n * carried == pytest.approx(load, rel=1e-9)
