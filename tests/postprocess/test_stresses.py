"""Stresses of displacement gradients, and what is measured of a stress."""

import numpy as np
import pytest

from galinx.postprocess import stresses
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import MovingFrame, Solid


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("ν", [-0.3, 0.0, 0.25, 0.4])
def test_stresses_of_gradients_are_those_of_known_states(ν, plane):
    """Over μ: a rotation has none, a shear γ has γ, and a bar pulled by ε has E'ε and nothing across.

    In plane strain it contracts by ν/(1 - ν) and E' = E/(1 - ν²), in plane stress by ν and E' = E.
    """
    κ = Solid(1.0, ν, 1.0, plane).κ
    rotation, shear = np.array([[0.0, -1.0], [1.0, 0.0]]), np.array([[0.0, 0.3], [0.4, 0.0]])
    np.testing.assert_array_equal(stresses.stresses_inside(κ, rotation), np.zeros(3))
    np.testing.assert_allclose(stresses.stresses_inside(κ, shear), [0.0, 0.0, 0.7], rtol=1e-15)
    contraction = ν / (1.0 - ν) if plane == "strain" else ν
    pulled = 2.0 * (1.0 + ν) / (1.0 - ν**2 if plane == "strain" else 1.0)
    along_X, along_Y = np.diag([1.0, -contraction]), np.diag([-contraction, 1.0])
    found = stresses.stresses_inside(κ, np.array([along_X, along_Y]))
    np.testing.assert_allclose(found, [[pulled, 0.0], [0.0, pulled], [0.0, 0.0]], rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("κ", [1.0, 2.0, 2.6])
def test_the_surface_stress_of_an_exact_strain_is_that_of_eq_32(κ):
    """u,X = q σ_YY + m H[σ_XY] of the closed form, beside and under the punch."""
    punch, X = FlatPunch(MovingFrame(κ, 0.6), -0.66), np.array([-2.0, -0.9, 0.1, 0.7, 1.3])
    frame, σ_YY = punch.frame, punch.σ_YY(X)
    u_X = frame.q * σ_YY + frame.m * punch.g * punch.hilbert(X)
    beside_free = np.where(np.abs(X) < 1.0, σ_YY, np.nan)
    found = stresses.σ_XX_on_surface(κ, u_X, beside_free)
    np.testing.assert_allclose(found, punch.σ_XX(X), rtol=1e-13)


def test_flatness_compares_slopes_under_the_punch_with_those_beside_it():
    X = np.array([-1.5, -1.05, -0.95, -0.5, 0.9, 1.1])
    v_X = np.array([[4.0, 99.0, 99.0, -1.0, 0.5, -2.0], [2.0, 0.0, 0.0, 0.0, -1.0, 0.0]])
    np.testing.assert_array_equal(stresses.flatness(X, v_X), [0.25, 0.5])


def test_stress_measures_follow_from_principal_stresses():
    random = np.random.default_rng(5)
    XX, YY, XY = random.normal(size=(3, 200))
    for plane in ("strain", "stress"):
        ZZ = stresses.σ_ZZ(0.3, plane, XX, YY)
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
