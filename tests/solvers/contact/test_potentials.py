from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from isotropic_field import field
from loaded import punch_of, under

from galinx.solvers.contact.closed_form import contacts
from galinx.solvers.contact.recovery import on_panels
from galinx.solvers.friction.along import constant
from galinx.solvers.profiles.punches import Flat, Parabolic
from galinx.solvers.solids.half_plane import mean_and_difference
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame


def test_interior_stresses_of_the_references(references):
    for entry in references["interior"]:
        found = under(punch_of(entry, entry["g"])).inside(float(entry["X/a"]), float(entry["Y/a"]))
        wanted = np.array([float(entry[f"sigma_{ij}"]) for ij in ("XX", "YY", "XY")])
        np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-12 * np.abs(wanted).max())


@pytest.mark.parametrize("profile", [Flat(1.0), Flat(1.0, 0.9), Flat(1.0, -0.9), Parabolic(1.0)])
def test_stresses_below_a_pressure_that_is_known_on_the_surface_alone(profile):
    """Its smooth factor at points of a rule has the field of its potential; also at free ends."""
    response, g = Isotropic(1.0, 0.3, 1.0).response(0.3), np.array([-0.4])
    exact = contacts(response, g, profile, 0.5)
    (group,) = exact.groups
    below = replace(group, pressure=on_panels(group.pressure, 0, group.α[0], group.β[0], constant(0.0)))
    X, depths = [-3.0, -2.0, -1.2, -0.999, 0.2, 0.99, 1.01, 1.5], [0.0, 1e-9, 1e-3, 0.02, 0.5]
    points = np.array([(x, -depth) for x in X for depth in depths])
    expected = exact.stresses(*points.T)[:, 0]
    found = below.stresses(*points.T[:, None])[:, 0]
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-9 * np.abs(expected).max())


class SymbolicFrame(MovingFrame):
    """The code's own constants over symbols: c² = 1 - β_s², k = (1 - β_d²)/c², κ = (1 + k)/(1 - k)."""

    β_s, β_d = sp.symbols("β_s β_d", positive=True)
    k = (1 - β_d**2) / (1 - β_s**2)

    def __init__(self):
        vars(self).update(c=sp.sqrt(1 - self.β_s**2), κ=sp.cancel((1 + self.k) / (1 - self.k)))


def exactly(expression):
    """The same with floating-point constants as the integers they are."""
    return sp.together(sp.nsimplify(expression, rational=True))


def vanishes(expression):
    """Is the numerator of a rational expression 0, multiplied out?"""
    return sp.expand(sp.numer(sp.together(expression))) == 0


def amplitudes(σ, symbols, c2):
    """What a stress has of -Im and Re of the shear wave (first row) and of the dilatational one."""
    s_s, h_s, s, h = (exactly(σ.subs({one: int(one == other) for one in symbols})) for other in symbols)
    return sp.Matrix([[s_s - s / c2, h_s - h / c2], [s / c2, h / c2]])


def test_symbolic_proof_that_the_field_solves_the_moving_frame_equations():
    """Eqs 15-16 inside and the relations of the surface, for potentials that span all decaying ones.

    Any potential analytic below the surface is a superposition of Φ = A exp(-i p z), p > 0; here p = 1,
    lengths being free. With s = -Im Φ and h = Re Φ, s,X = h and h,X = -s, and Y multiplies by β; what
    vanishes for every A has no s and no h.
    """
    frame, g = SymbolicFrame(), sp.Symbol("g")
    symbols = sp.symbols("s_s h_s s h")
    c2, κ, β = 1 - frame.β_s**2, frame.κ, sp.diag(frame.β_s, frame.β_d)
    n, q, m = (exactly(constant) for constant in (frame.n, frame.q, frame.m))
    σ_XX, σ_YY, σ_XY = (amplitudes(σ, symbols, c2) for σ in field(frame, g, *symbols))
    K, λ, coupling = (κ + 1) / (κ - 1), (3 - κ) / (κ - 1), 2 / (κ - 1)
    # Hooke's law, Eqs 6-7, solved for the strains.
    u_X, v_Y = ((K * a - λ * b) / (K**2 - λ**2) for a, b in ((σ_XX, σ_YY), (σ_YY, σ_XX)))
    by_X, at_surface = sp.Matrix([[0, 1], [-1, 0]]), sp.ones(1, 2)
    s, h = sp.Matrix([[1, 0]]), sp.Matrix([[0, 1]])  # of σ_YY on the surface, and its Hilbert transform
    v_X = β.inv() * v_Y * by_X  # v,XY integrated from -∞, where the field vanishes
    identities = {
        "Eq 15, by X": (K - c2) * u_X * by_X**2 + coupling * v_Y * by_X**2 + β**2 * u_X,
        "Eq 16, by Y": (1 - c2) * v_Y * by_X**2 + coupling * β**2 * u_X + K * β**2 * v_Y,
        "σ_XY = u,Y + v,X, by X and Y": β * σ_XY * by_X - β**2 * u_X - v_Y * by_X**2,
        "σ_YY on Y = 0": at_surface * σ_YY - s,
        "σ_XY on Y = 0": at_surface * σ_XY - g * s,
        "v,X = n H[σ_YY] - q σ_XY": at_surface * v_X - (n * h - q * g * s),
        "u,X = q σ_YY + m H[σ_XY]": at_surface * u_X - (q * s + m * g * h),
    }
    for name, identity in identities.items():
        assert all(map(vanishes, identity)), name


def test_the_moving_frame_turns_eqs_9_to_12_into_eqs_15_and_16():
    """Balance of momentum and Hooke's law in x, y and t, for a field that travels: u(x - Vt, y)."""
    x, y, t = sp.symbols("x y t", real=True)
    μ, ρ, κ, V = sp.symbols("μ ρ κ V", positive=True)
    X, c2, K, coupling = x - V * t, V**2 * ρ / μ, (κ + 1) / (κ - 1), 2 / (κ - 1)
    u, v = (sp.Function(name)(X, y) for name in "uv")
    λ_div = (3 - κ) / (κ - 1) * (u.diff(x) + v.diff(y))
    σ_xx, σ_yy = (μ * (2 * strain + λ_div) for strain in (u.diff(x), v.diff(y)))
    σ_xy = μ * (u.diff(y) + v.diff(x))
    by_momentum = [
        σ_xx.diff(x) + σ_xy.diff(y) - ρ * u.diff(t, 2),
        σ_xy.diff(x) + σ_yy.diff(y) - ρ * v.diff(t, 2),
    ]
    eqs_15_and_16 = [
        (K - c2) * u.diff(x, 2) + coupling * v.diff(x, y) + u.diff(y, 2),
        (1 - c2) * v.diff(x, 2) + coupling * u.diff(x, y) + K * v.diff(y, 2),
    ]
    for momentum, equation in zip(by_momentum, eqs_15_and_16):
        assert sp.simplify(momentum - μ * equation) == 0


@pytest.mark.parametrize("distance", [1e-9, 1e-6, 1e-2])
@pytest.mark.parametrize("apart", [1e-9, 1e-3])
def test_divided_differences_keep_their_digits_next_to_edges(distance, apart):
    """Places about a point have no rounding, which is large beside their distance from an edge."""
    punch = punch_of({"nu": 0.25, "c": 0.3, "plane": "strain"}, -0.6)
    with mp.workdps(50):
        α, β = mp.mpf(float(punch.α)), mp.mpf(float(punch.β))
        for angle in (-1e-4, -0.3, -1.5, -2.8):
            z = complex(1.0 + distance * np.exp(1j * angle))
            δ = complex(apart * distance * np.exp(0.4j))
            found = mean_and_difference(punch, np.array([z]), np.array([δ**2]))[:, 0]
            one, other = (
                2 / mp.pi * mp.exp(α * mp.log(at - 1) + β * mp.log(at + 1))
                for at in (mp.mpc(z) + mp.mpc(δ), mp.mpc(z) - mp.mpc(δ))
            )
            exact = np.array([complex((one + other) / 2), complex((one - other) / (2 * mp.mpc(δ)))])
            assert np.abs(found / exact - 1.0).max() <= 1e-12
