import numpy as np
import pytest
from loaded import punch_of

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.solution import make_contact
from galinx.solvers.profiles.punches import Flat
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame


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


def test_pressure_carries_the_load_and_leaves_the_punch_flat():
    punch = FlatPunch(MovingFrame(2.0, 0.6), 0.66)
    r = np.linspace(-0.95, 0.95, 11)
    slope = punch.response.n * punch.hilbert(r) - punch.response.q * punch.g * punch.σ_YY(r)
    np.testing.assert_allclose(slope, 0.0, atol=1e-14)
    t, w = np.polynomial.legendre.leggauss(60)
    τ = (t + 1.0) / 2.0  # distance = τ^8 takes the singular ends away
    total = sum(
        np.sum(w / 2.0 * 8.0 * τ**7 * punch.traction(*ends))
        for ends in ((τ**8, 2.0 - τ**8), (2.0 - τ**8, τ**8))
    )
    assert total == pytest.approx(-2.0, rel=1e-12)


@pytest.mark.parametrize("g", [0.0, 0.66, -1.5])
def test_intensities_are_the_limits_of_the_pressure_at_both_ends(g):
    """Eqs 56-58: -σ_YY over N/a times (1 - r)^-α (1 + r)^-β, at r = 1 and r = -1, by two routes."""
    punch, d = FlatPunch(MovingFrame(2.0, 0.6), g), 1e-200
    at_right = -punch.traction(2.0, d) / 2.0 * d**-punch.α * 2.0**-punch.β
    at_left = -punch.traction(d, 2.0) / 2.0 * 2.0**-punch.α * d**-punch.β
    assert (at_left, at_right) == pytest.approx((punch.K_I, punch.K_I), rel=1e-12)
    ratio = punch.g * punch.response.q / punch.response.n
    assert np.pi * punch.K_I == pytest.approx(1.0 / np.sqrt(1.0 + ratio**2), rel=1e-14)


@pytest.mark.parametrize("bow", [0.3, -0.2])
def test_a_bowed_punch_of_ones_own_between_sharp_edges(bow):
    """Of the height P = bow X²/2 on |X| <= 1: T₂(r)/√(1 - r²) has the Hilbert transform 2 r."""

    class Bowed(Flat):
        def slope(self, X):
            return bow * np.asarray(X)

    body = make_contact(Isotropic(1.0, 0.25, 1.0), Bowed(1.0), 1.0)
    response = body.response(0.3)
    found = body.contacts(response, np.zeros(1))
    r = np.linspace(-0.9, 0.9, 7)
    # Slopes μ v,X over N/2 are n times the transform of σ_YY.
    share = 2.0 * body.solid.μ * bow / (2.0 * response.n)
    σ_YY = -(2.0 / np.pi - share * (2.0 * r**2 - 1.0)) / np.sqrt(1.0 - r**2)
    np.testing.assert_allclose(found.on_surface(r)[1][0], σ_YY, rtol=1e-10)
    np.testing.assert_allclose(found.of("K_I")[0], 0.5 * (2.0 / np.pi - share), rtol=1e-10)
