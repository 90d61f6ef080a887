"""The yielded zone at the sharp edges of a punch: next to them it is that of a crack."""

import numpy as np
import pytest
from loaded import under, yield_of

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.solution import make_contact
from galinx.solvers.contact.stresses import von_mises
from galinx.solvers.profiles.punches import Flat
from galinx.solvers.solids import Isotropic

SOLID = Isotropic(193e9, 0.25, 7860.0)


def flat(g, c, strength):
    """Yield below flat punches; the strength is over N/(2a)."""
    g, response = np.asarray(g, dtype=float), SOLID.response(c)
    exact = under(FlatPunch(response, g[:, None]))
    body = make_contact(SOLID, Flat(1e-3), 2e6, None, strength * 1e9)
    field = lambda points: exact.stresses(points[..., 0], points[..., 1])  # noqa: E731
    return yield_of(body, field, response, g, FlatPunch(response, g))


@pytest.mark.parametrize("strength", [1e7, 1e3, 150.0])
def test_without_friction_it_is_that_of_a_crack(strength):
    """K²/(2π Y²) cos²(θ/2) [(1 - 2ν)² + 3 sin²(θ/2)] with K = N/√(πa), up to a share of its size."""
    θ = np.linspace(0.0, np.pi, 20_001)
    r = 2.0 / (np.pi * strength) ** 2 * np.cos(θ / 2) ** 2 * (0.25 + 3.0 * np.sin(θ / 2) ** 2)
    found = flat([0.0], 0.0, strength)
    np.testing.assert_allclose(found.reach, [[r.max()] * 2], rtol=1e-7 + 2.0 * r.max())
    np.testing.assert_allclose(found.depth, (r * np.sin(θ)).max(), rtol=1e-7 + 2.0 * r.max())


@pytest.mark.parametrize("g, c", [(0.4, 0.0), (-0.9, 0.6), (0.2, 0.9)])
def test_a_weak_load_is_known_by_its_power(g, c):
    """Across the distance from which on stresses are continued by theirs."""
    strengths = np.array([3e2, 3e4])
    weak, weaker = (flat([g], c, strength) for strength in strengths)
    local = FlatPunch(SOLID.response(c), g)
    for edge, exponent in enumerate((local.β, local.α)):
        ratio = weak.reach[0, edge] / weaker.reach[0, edge]
        np.testing.assert_allclose(ratio ** abs(exponent), 100.0, rtol=2.0 * weak.reach[0, edge])


@pytest.mark.parametrize("g, c, strength", [(0.4, 0.0, 3.0), (-0.3, 0.6, 1.0), (0.6, 0.3, 2.0)])
def test_no_place_of_a_fine_grid_yields_farther(g, c, strength):
    X, Y = np.meshgrid(np.linspace(-2.5, 2.5, 1001), -np.linspace(0.0, 2.5, 501))
    σ = under(FlatPunch(SOLID.response(c), g)).stresses(X, Y)
    passed = von_mises(*σ, SOLID.σ_ZZ(*σ)) >= strength
    found = flat([g], c, strength)
    np.testing.assert_allclose(found.depth, -Y[passed].min(), atol=8e-3)
    assert not passed[:, [0, -1]].any() and not passed[-1].any()
    for edge, side in enumerate((-1, 1)):
        own = passed & (side * X >= 0.0)
        np.testing.assert_allclose(found.reach[0, edge], np.hypot(X[own] - side, Y[own]).max(), atol=8e-3)


def test_what_no_solid_carries_has_no_reach():
    found = flat([0.3, 0.1], 0.0, 1e-3)
    assert np.isnan(found.reach).all() and np.isnan(found.depth).all()
