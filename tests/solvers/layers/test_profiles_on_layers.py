"""Contacts of every profile over layers: on layers of one solid, and by what the equation itself says."""

from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from layers_cases import COAT, SUBSTRATE, constants
from layers_reference import admittance
from support import THOROUGH

from galinx.solvers.contact.contacts import contacts
from galinx.solvers.contact.ends import Punch
from galinx.solvers.contact.on_layers import LayersUnderPunch
from galinx.solvers.contact.solution import make_contact
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.profiles import PROFILES

COATED = Layered((Layer(1.0, COAT),), SUBSTRATE)
SAME = Layered((Layer(1.0, SUBSTRATE), Layer(0.3, SUBSTRATE)), SUBSTRATE)
LOAD = 0.02  # N/μ [m]

flat, parabolic, wedge, power, rounded, table = (
    PROFILES[name] for name in ("flat", "parabolic", "wedge", "power", "rounded_flat", "table")
)
PUNCHES = {
    "wedge": wedge(0.01),
    "cusp": power(1.3, 0.01),
    "cube": power(3.0, 0.1),
    "2.5": power(2.5, 0.1),
    "parabola": parabolic(1.0),
    "rounded": rounded(0.5, 2.0),
    "table": table(tuple((x, 0.01 * (x**2 + 0.05 * x**3 + abs(x))) for x in range(-3, 4))),
    "touching": flat(1.0, 0.05),
    "lifted": flat(1.0, -1.0),
}  # fmt: skip


def found(solid, profile, g, share=0.5, tolerance=1e-8, load=LOAD):
    """The contact, its response, and the length that its lengths are over."""
    response = solid.response(share * solid.limit())
    unit = float(contacts(solid.response(0.0), np.zeros(1), profile, load).of("half_width")[0])
    punch = Punch(profile, unit, load)
    speed = LayersUnderPunch(response, response.stack(unit), tolerance, punch)
    return speed.contact(g), response, unit


def pressure(contact, r):
    """σ_YY over N/(2h)."""
    p = contact.pressure
    return (1.0 - r) ** p.α * (1.0 + r) ** p.β * p.series(r)


@pytest.mark.parametrize("name", PUNCHES)
@pytest.mark.parametrize("g", [0.0, -0.7] if THOROUGH else [-0.7])
def test_on_layers_of_one_solid_it_is_that_of_the_half_plane(name, g):
    profile = PUNCHES[name]
    for share in (0.0, 0.8) if THOROUGH else (0.8,):
        one, _, unit = found(SAME, profile, g, share)
        exact = contacts(SUBSTRATE.response(share * SUBSTRATE.limit()), np.array([g]), profile, LOAD)
        h, m, K = (exact.of(what)[0] for what in ("half_width", "centre", "K_I"))
        assert one.half_width * unit == pytest.approx(h, rel=1e-12)
        assert one.centre * unit == pytest.approx(m, abs=1e-12 * h)
        r = np.linspace(-0.999, 0.999, 41) + 1e-4
        σ = exact.on_surface(r)[1][0]
        assert np.abs(pressure(one, r) - σ).max() <= 1e-10 * np.abs(σ).max()
        ends = -0.5 * one.pressure.series(np.array([-1.0, 1.0]))
        assert np.where(one.pressure.free, 0.0, ends) == pytest.approx(np.asarray(K).ravel(), abs=1e-10)


class Equation:
    """What a pressure has to obey, by transforms of the reference."""

    def __init__(self, solid, V2, g, h, profile, m):
        with mp.workdps(25):
            layers = [
                (mp.mpf(one.thickness / h), constants(one.solid), mp.mpf(one.solid.ρ))
                for one in solid.layers
            ]
            below = constants(solid.substrate), mp.mpf(solid.substrate.ρ)
            top = admittance([], layers[0][1:], V2, mp.mpf(1))
            x, w = np.polynomial.legendre.leggauss(16)
            ends = np.concatenate([[0.0], 2.0 ** np.arange(-6.0, 5.0)]) / float(layers[0][0])
            self.k = ((ends[1:] + ends[:-1])[:, None] / 2 + np.diff(ends)[:, None] / 2 * x).ravel()
            weights = (np.diff(ends)[:, None] / 2 * w).ravel() / np.pi
            Δ = [admittance(layers, below, V2, mp.mpf(k)) - top for k in self.k.tolist()]
            self.of_k = np.array([complex(d[1, 1] + g * d[1, 0]) for d in Δ]) * weights
        self.n, self.Q = float(mp.im(top[1, 1]) + g * mp.im(top[1, 0])), float(-mp.re(top[1, 0]) * g)
        self.slope = lambda r: np.asarray(profile.slope(m + h * r))

    def kernel(self, x):
        return np.real(np.exp(1j * np.multiply.outer(x, self.k)) @ self.of_k)

    def off(self, σ, r, kinks):
        """What is left of the equation at r, and the size of its slope."""
        near = 0.5 * min(abs(r - one) for one in [-1.0, 1.0, *kinks])
        t, w = _rule(sorted([-1.0, *kinks, r - near, r + near, 1.0]))
        beside = np.abs(t - r) > near
        x, y = np.polynomial.legendre.leggauss(40)
        u, v = near * (x + 1.0) / 2.0, near * y / 2.0
        both = np.stack([σ(r + u), σ(r - u)])
        cauchy = w[beside] @ (σ(t[beside]) / (t[beside] - r)) + v @ ((both[0] - both[1]) / u)
        bent = w[beside] @ (σ(t[beside]) * self.kernel(r - t[beside]))
        bent += v @ (both[0] * self.kernel(-u) + both[1] * self.kernel(u))
        left = self.n / np.pi * cauchy - self.Q * σ(np.array([r]))[0] + bent
        return float(left - self.slope(np.array([r]))[0]), float(np.abs(self.slope(t)).max())


def _rule(places):
    """Gauss's rule between places, on panels that get shorter towards each."""
    x, w = np.polynomial.legendre.leggauss(20)
    steps = np.append(0.0, 0.3 ** np.arange(24, -1, -1.0)) / 2.0
    unit = np.concatenate([steps, 1.0 - steps[-2::-1]])
    ends = np.concatenate([low + (high - low) * unit for low, high in pairwise(places)])
    half, middle = np.diff(ends) / 2.0, (ends[1:] + ends[:-1]) / 2.0
    t, weights = (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()
    inside = (half[:, None] > 0.0) & (np.abs(t.reshape(-1, 20)) < 1.0)
    return t[inside.ravel()], weights[inside.ravel()]


@pytest.mark.parametrize("name", list(PUNCHES) if THOROUGH else ["wedge", "lifted"])
@pytest.mark.parametrize("g", [0.9, -0.6] if THOROUGH else [-0.6])
def test_the_equation_of_the_reference_holds(name, g):
    """With its load, and no intensity at free ends: the punch, the layers and the kink all told."""
    profile = PUNCHES[name]
    one, response, unit = found(COATED, profile, g)
    h, m = one.half_width * unit, one.centre * unit
    stress = LOAD * COATED.μ / (2.0 * h)

    def σ(t):
        return stress * pressure(one, t)

    t, w = _rule(sorted([-1.0, *_kinks(profile, m, h), 1.0]))
    # Nearer to a tip than 1e-6 the pressure is told as at that distance; towards an edge this rule ends.
    told = 1e-5 if one.pressure.tips or not all(one.pressure.free) else 1e-7
    assert h * (w @ σ(t)) == pytest.approx(-LOAD * COATED.μ, rel=told)
    assert one.pressure.points(0.3)[1].sum() == pytest.approx(-2.0, rel=1e-8)
    for side, free in zip((-1.0, 1.0), one.pressure.free):
        near, nearer = np.abs(σ(side * (1.0 - np.array([1e-6, 1e-8]))))
        assert nearer < 0.3 * near if free else nearer > 3.0 * near
    equation = Equation(COATED, (response.c * COATED.c_s) ** 2, g, h, profile, m)
    for r in (-0.83, -0.31, 0.17, 0.69):
        off, size = equation.off(σ, r, _kinks(profile, m, h))
        assert abs(off) <= told * size


def _kinks(profile, m, h):
    at = [(x - m) / h for x in getattr(profile, "kinks", ())]
    return [x for x in at if abs(x) < 1.0]


def test_an_edge_lifts_off_beyond_the_tilt_that_leaves_it_no_intensity():
    """Between two tilts: the contact begins to shrink, and the exponents say so."""
    response = COATED.response(0.5 * COATED.limit())
    free, sizes = [], []
    tilts = (0.2, 0.3, 0.4, 0.5, 0.6)
    for tilt in tilts:
        one, _, unit = found(COATED, flat(1.0, tilt), -0.4)
        free.append(one.pressure.free[1])
        sizes.append(one.half_width * unit)
        body = make_contact(COATED, flat(1.0, tilt), LOAD * COATED.μ)
        local = body.local_exponents(response, np.array([-0.4]))
        assert (local.α[0] > 0.0) == one.pressure.free[1] and local.β[0] < 0.0
        assert one.centre * unit == pytest.approx(sizes[-1] - 1.0)
    assert not free[0] and free[-1] and sorted(free) == free
    assert np.all(np.diff(sizes) <= 1e-12) and sizes[0] == pytest.approx(1.0) and sizes[-1] < 0.9


@pytest.mark.skipif(not THOROUGH, reason="half a minute")
def test_over_a_graded_top_rules_know_of_kinks():
    """Whatever they are fine enough for, what they add up to is the load."""
    graded = Layered((Layer(1.0, COAT, bottom=SUBSTRATE),), SUBSTRATE)
    one, _, _ = found(graded, wedge(0.01), -0.6, tolerance=1e-6)
    for finest in (3.0, 0.1):
        assert one.pressure.points(finest)[1].sum() == pytest.approx(-2.0, rel=1e-8)
