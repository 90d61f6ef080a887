import numpy as np
import pytest
import sympy as sp

from galinx.solvers.sie import collocation, potentials
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame, Solid


def punch_of(entry, g):
    solid = Solid(193e9, float(entry["nu"]), 7860.0, entry["plane"])
    return FlatPunch(MovingFrame(solid.κ, float(entry["c"])), float(g))


def test_states_of_the_references(references):
    for state in references["states"]:
        punch = punch_of(state, state["f"])
        found = [punch.α, punch.β, punch.K_I]
        wanted = [float(state[name]) for name in ("alpha", "beta", "K_I")]
        np.testing.assert_allclose(found, wanted, rtol=1e-12)


def test_surface_stresses_of_the_references(references):
    for entry in references["surface"]:
        punch, X = punch_of(entry, entry["g"]), float(entry["X/a"])
        wanted = float(entry["sigma_XX"])
        assert punch.σ_XX(X) == pytest.approx(wanted, rel=1e-12, abs=1e-15)
        if "sigma_YY" in entry:
            assert punch.σ_YY(X) == pytest.approx(float(entry["sigma_YY"]), rel=1e-12)


def test_interior_stresses_of_the_references(references):
    for entry in references["interior"]:
        found = potentials.stresses(punch_of(entry, entry["g"]), float(entry["X/a"]), float(entry["Y/a"]))
        wanted = np.array([float(entry[f"sigma_{ij}"]) for ij in ("XX", "YY", "XY")])
        np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-12 * np.abs(wanted).max())


@pytest.mark.parametrize("c", [0.0, 4.786e-7, 0.6])
def test_interior_field_meets_the_surface(c):
    punch = FlatPunch(MovingFrame(2.0, c), -0.66)
    X = np.array([-2.0, -0.5, 0.0, 0.7, 1.5])
    σ_XX, σ_YY, σ_XY = potentials.stresses(punch, X, np.full_like(X, -1e-9))
    np.testing.assert_allclose(σ_XX, punch.σ_XX(X), atol=1e-7)
    np.testing.assert_allclose(σ_YY, punch.σ_YY(X), atol=1e-7)
    np.testing.assert_allclose(σ_XY, -0.66 * punch.σ_YY(X), atol=1e-7)


def test_pressure_carries_the_load_and_leaves_the_punch_flat():
    punch = FlatPunch(MovingFrame(2.0, 0.6), 0.66)
    r = np.linspace(-0.95, 0.95, 11)
    slope = punch.frame.n * punch.hilbert(r) - punch.frame.q * punch.g * punch.σ_YY(r)
    np.testing.assert_allclose(slope, 0.0, atol=1e-14)
    t, w = np.polynomial.legendre.leggauss(60)
    τ = (t + 1.0) / 2.0  # distance = τ^8 takes the singular ends away
    total = sum(
        np.sum(w / 2.0 * 8.0 * τ**7 * punch.σ_YY_by_distance(*ends))
        for ends in ((τ**8, 2.0 - τ**8), (2.0 - τ**8, τ**8))
    )
    assert total == pytest.approx(-2.0, rel=1e-12)


@pytest.mark.parametrize("c", [0.0, 4.786e-7, 0.6, 0.9])
@pytest.mark.parametrize("g", [0.0, 0.66, -2.0])
def test_collocation_finds_the_same_coefficients(c, g):
    punch = FlatPunch(MovingFrame(2.0, c), g)
    found = collocation.solve(punch.frame, g, 12)
    assert (found.α, found.β) == pytest.approx((punch.α, punch.β), abs=1e-14)
    assert found.c[0] == pytest.approx(-2.0 * punch.K_I, rel=1e-13)
    np.testing.assert_allclose(found.c[1:], 0.0, atol=1e-12)


def test_collocation_of_a_tilted_punch_has_the_known_second_coefficient():
    # c = 0, g = 0, μ v,X = t: σ_YY √(1-r²) = -2/π + t r/n, from H[r/√(1-r²)] = 1.
    frame, tilt = MovingFrame(2.0, 0.0), 0.1
    found = collocation.solve(frame, 0.0, 8, lambda r: np.full_like(r, tilt))
    r = np.linspace(-0.9, 0.9, 7)
    np.testing.assert_allclose(
        found.σ_YY(r) * np.sqrt(1.0 - r**2), -2.0 / np.pi + tilt * r / frame.n, atol=1e-12
    )


def test_symbolic_proof_that_the_field_solves_the_moving_frame_equations():
    """Eqs 15-16 inside and the tractions on Y = 0, for potentials that span all decaying ones.

    Any potential analytic below the surface is a superposition of A exp(-i p z), p > 0; A = 1 and
    A = i stand for all, the field being real-linear in A.
    """
    X, Y = sp.symbols("X Y", real=True)
    p, β_s, β_d = sp.symbols("p beta_s beta_d", positive=True)
    g = sp.Symbol("g", real=True)
    c2 = 1 - β_s**2
    k = (1 - β_d**2) / c2
    κ = (1 + k) / (1 - k)
    e, r = 1 + β_s**2, (4 * β_s * β_d - (1 + β_s**2) ** 2) / c2
    n, q = β_d / r, (e - 2 * β_s * β_d) / (r * c2)
    for A in (1, sp.I):
        parts = {}
        for name, β in (("s", β_s), ("d", β_d)):
            wave = sp.exp(p * β * Y)
            real, imaginary = (
                (sp.cos(p * X), -sp.sin(p * X)) if A == 1 else (sp.sin(p * X), sp.cos(p * X))
            )
            parts[name] = (-imaginary * wave, real * wave)
        s_s, h_s = parts["s"]
        s, h = ((parts["d"][i] - parts["s"][i]) / c2 for i in (0, 1))
        u_X = (e * s + β_s * g * (2 * h + h_s)) / r + q * s_s
        v_Y = (
            -(β_d**2) * e * s
            + β_d * (β_d - 2 * (1 - k) / (β_d + β_s)) * s_s
            + β_s * g * ((2 * k - 1) * h_s - 2 * β_d**2 * h)
        ) / r
        σ_XY = g * (4 * β_s * β_d * s / r + s_s) - 2 * β_d * e * h / r
        K, λ = (κ + 1) / (κ - 1), (3 - κ) / (κ - 1)
        σ_YY = K * v_Y + λ * u_X
        identities = [
            # Eq 15 differentiated in X, Eq 16 in Y, and σ_XY = u,Y + v,X in X and Y.
            (K - c2) * sp.diff(u_X, X, 2) + 2 / (κ - 1) * sp.diff(v_Y, X, 2) + sp.diff(u_X, Y, 2),
            β_s**2 * sp.diff(v_Y, X, 2) + 2 / (κ - 1) * sp.diff(u_X, Y, 2) + K * sp.diff(v_Y, Y, 2),
            sp.diff(σ_XY, X, Y) - sp.diff(u_X, Y, 2) - sp.diff(v_Y, X, 2),
            (σ_YY - s_s).subs(Y, 0),
            (σ_XY - g * s_s).subs(Y, 0),
            # v,X on the surface, through v,XY integrated from -∞ where the field vanishes.
            (sp.diff(_integral(v_Y, Y, p, β_s, β_d), X) - (n * h_s - q * g * s_s)).subs(Y, 0),
        ]
        for identity in identities:
            assert sp.simplify(sp.together(identity)) == 0


def _integral(expression, Y, p, β_s, β_d):
    """∫ from -∞ of a combination of exp(p β_s Y) and exp(p β_d Y)."""
    waves = [sp.exp(p * β * Y) for β in (β_s, β_d)]
    expanded = sp.expand(expression)
    return sum(expanded.coeff(w) * w / (p * β) for w, β in zip(waves, (β_s, β_d)))
