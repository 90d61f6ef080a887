import numpy as np
import pytest
from fourier_reference import surface_response

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame, rayleigh_speed

mpmath = pytest.importorskip("mpmath")


def test_rayleigh_speed_of_the_references(references):
    for entry in references["rayleigh_speed"]:
        solid = Isotropic(1.0, float(entry["nu"]), 1.0, entry["plane"])
        assert rayleigh_speed(solid.κ) == pytest.approx(float(entry["c_R_over_c_s"]), rel=1e-12)


def test_the_rayleigh_speed_goes_to_zero_with_the_bulk_modulus():
    # Plane stress, ν -> -1: by (2 - c²)² = 4 √(1 - c²) √(1 - k c²), k = (1 - ν)/2, c² -> 1 + ν.
    for ν in (-0.99, -0.999, -0.9999):
        c_R = rayleigh_speed(Isotropic(1.0, ν, 1.0, "stress").κ)
        assert c_R**2 == pytest.approx(1.0 + ν, rel=2.0 * (1.0 + ν))


@pytest.mark.parametrize("c", [0.1, 0.3, 0.6, 0.9])
@pytest.mark.parametrize("κ", [1.2, 2.0, 2.9])
def test_constants_agree_with_the_fourier_solution(κ, c):
    frame = MovingFrame(κ, c)
    found = np.array(surface_response(κ, c))
    # Near the Rayleigh speed both are large and their zero in the denominator is what matters.
    np.testing.assert_allclose(found, [frame.n, frame.q, frame.m], rtol=1e-12 / c**2)


@pytest.mark.parametrize("c", [1e-12, 4.786e-7, 1e-3, 0.6, 0.9, 0.99])
def test_constants_keep_their_digits_at_every_speed(c):
    mpmath.mp.dps = 60
    κ = mpmath.mpf("1.7")
    c_ = mpmath.mpf(c)
    k = (κ - 1) / (κ + 1)
    β_s, β_d = mpmath.sqrt(1 - c_**2), mpmath.sqrt(1 - k * c_**2)
    R = 4 * β_s * β_d - (2 - c_**2) ** 2
    frame = MovingFrame(float(κ), c)
    assert frame.n == pytest.approx(float(β_d * c_**2 / R), rel=2e-14)
    assert frame.m == pytest.approx(float(β_s * c_**2 / R), rel=2e-14)
    q = (2 - c_**2 - 2 * β_s * β_d) / R
    assert frame.q == pytest.approx(float(q), rel=2e-14)


def test_ω_of_the_study_are_those_of_the_fourier_solution():
    """Eqs 31 and 33, at high speed: 4/(κ + 1) times what unit tractions do to slope and strain."""
    κ = 2.2
    n, q, m = (4.0 / (κ + 1.0) * value for value in surface_response(κ, 0.6))
    assert MovingFrame(κ, 0.6).ω == pytest.approx((n / np.pi, q, m / np.pi, q), rel=1e-11)


def test_material_of_the_study():
    solid = Isotropic(193e9, 0.25, 7860.0)
    assert solid.κ == 2.0
    assert solid.c_s == pytest.approx(3133.99, abs=0.005)
    assert Isotropic(193e9, 0.25, 7860.0, "stress").κ == pytest.approx(2.2)


@pytest.mark.parametrize(
    "arguments", [(0.0, 0.25, 1.0), (1.0, 0.51, 1.0), (1.0, -1.0, 1.0), (1.0, 0.3, float("nan"))]
)
def test_impossible_materials_are_refused(arguments):
    with pytest.raises(ValueError, match="expected"):
        Isotropic(*arguments)


@pytest.mark.parametrize("c", [-0.1, 1.0, float("nan")])
def test_impossible_speeds_are_refused(c):
    with pytest.raises(ValueError, match="subsonic"):
        MovingFrame(2.0, c)


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("ν", [-0.3, 0.0, 0.25, 0.4])
def test_stresses_of_gradients_are_those_of_known_states(ν, plane):
    """Over μ: a rotation has none, a shear γ has γ, and a bar pulled by ε has E'ε and nothing across.

    In plane strain it contracts by ν/(1 - ν) and E' = E/(1 - ν²), in plane stress by ν and E' = E.
    """
    stresses = Isotropic(1.0, ν, 1.0, plane).response(0.3).stresses
    rotation, shear = np.array([[0.0, -1.0], [1.0, 0.0]]), np.array([[0.0, 0.3], [0.4, 0.0]])
    np.testing.assert_array_equal(stresses(rotation), np.zeros(3))
    np.testing.assert_allclose(stresses(shear), [0.0, 0.0, 0.7], rtol=1e-15)
    contraction = ν / (1.0 - ν) if plane == "strain" else ν
    pulled = 2.0 * (1.0 + ν) / (1.0 - ν**2 if plane == "strain" else 1.0)
    along_X, along_Y = np.diag([1.0, -contraction]), np.diag([-contraction, 1.0])
    found = stresses(np.array([along_X, along_Y]))
    np.testing.assert_allclose(found, [[pulled, 0.0], [0.0, pulled], [0.0, 0.0]], rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("κ", [1.0, 2.0, 2.6])
def test_the_surface_stress_of_an_exact_strain_is_that_of_eq_32(κ):
    """u,X = q σ_YY + m H[σ_XY] of the closed form, beside and under the punch."""
    punch, X = FlatPunch(MovingFrame(κ, 0.6), -0.66), np.array([-2.0, -0.9, 0.1, 0.7, 1.3])
    frame, σ_YY = punch.response, punch.σ_YY(X)
    u_X = frame.q * σ_YY + frame.m * punch.g * punch.hilbert(X)
    found = frame.σ_XX(u_X, σ_YY, punch.g * σ_YY)
    # Eq 32 as the study has it.
    own = (3.0 - κ) / (κ + 1.0) + 8.0 * frame.q / (κ + 1.0)
    wanted = own * σ_YY + 8.0 * frame.m / (κ + 1.0) * punch.g * punch.hilbert(X)
    np.testing.assert_allclose(found, wanted, rtol=1e-13)
    np.testing.assert_allclose(punch.σ_XX(X), wanted, rtol=1e-13)
