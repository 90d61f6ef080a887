"""Two elastic bodies: Fourier's fields in both, quadrature of the singular equation, and limits."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from stroh import admittances

from galinx.solvers.contact.closed_form import FlatPunch, contacts
from galinx.solvers.profiles import PROFILES
from galinx.solvers.solids import SOLIDS, Isotropic
from galinx.solvers.solids.pair import Pair

STEEL = Isotropic(210e9, 0.29, 7850.0)
POLYMER = Isotropic(3e9, 0.38, 1200.0)


def _fibres(seed: int) -> object:
    random = np.random.default_rng(seed)
    E1, E2, G12 = random.uniform(5e9, 100e9, 3)
    return SOLIDS["orthotropic"](
        max(E1, E2), min(E1, E2), 5e9, 0.3, 0.3, 0.3, 0.2 * G12 + 2e9, 1600.0, random.uniform(-90, 90)
    )


def _displacement(solid, V, t, below):
    """Displacement over 1/k of the surface of a body under tractions (σ_XY, σ_YY) e^(ikX) on Y = 0.

    Waves e^(ik(X + pY)) that decay downwards below the surface, and upwards above it.
    """
    C = solid.response(0.0).C[np.triu_indices(3)]
    (Y,) = admittances(C, np.array([solid.ρ * V**2 / solid.μ]), -1.0 if below else 1.0)
    return Y @ t / (1j * solid.μ)


@pytest.mark.parametrize("seed", range(6))
def test_the_gap_between_two_surfaces_is_that_of_waves_in_both_bodies(seed):
    """Roots that meet cost eigenvectors digits: solids here have none that do."""
    random = np.random.default_rng(seed)
    plate, punch = _fibres(seed), _fibres(100 + seed)
    c, other, g = 0.6 * plate.limit() * random.uniform(), 0.6 * random.uniform(), random.uniform(-1, 1)
    speed = other * punch.limit() * punch.c_s
    pair = Pair(plate, punch, speed).response(c)
    t = np.array([g, 1.0])
    slope = 1j * (
        _displacement(plate, c * plate.c_s, t, True) - _displacement(punch, speed, t, False)
    )[1]  # fmt: skip
    by_constants = (1j * (pair.n + g * pair.n12) - g * pair.q) / plate.μ  # H[e^(ikX)] = i e^(ikX)
    assert abs(slope - by_constants) < 1e-10 * abs(slope)


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_coupling_at_rest_is_dundurs_constant(plane):
    first, second = replace(STEEL, plane=plane), replace(POLYMER, plane=plane)
    (κ1, μ1), (κ2, μ2) = ((s.κ, s.μ) for s in (first, second))
    β = (μ2 * (κ1 - 1.0) - μ1 * (κ2 - 1.0)) / (μ2 * (κ1 + 1.0) + μ1 * (κ2 + 1.0))
    pair = Pair(first, second, 0.0).response(0.0)
    assert pair.q / pair.n == pytest.approx(β, rel=1e-12)
    assert 1.0 / np.tan(pi * FlatPunch(pair, -0.3).α) == pytest.approx(-0.3 * β, rel=1e-12)


def test_hertz_with_the_contact_modulus_of_both_bodies():
    R, N = 10e-3, 1e5
    modulus = 1.0 / sum((1.0 - s.ν**2) / s.E for s in (STEEL, POLYMER))
    pair = Pair(STEEL, POLYMER, 0.0).response(0.0)
    contact = contacts(pair, np.zeros(1), PROFILES["parabolic"](R), N / STEEL.μ)
    assert contact.of("half_width")[0] == pytest.approx(np.sqrt(4.0 * N * R / (pi * modulus)), rel=1e-12)
