"""Any uniform solid: the closed form against Stroh's eigenvectors in 90 digits, and against isotropic."""

import numpy as np
import pytest
from loaded import under
from random_solids import isotropic_as, random_solid, stiffness

from galinx.solvers.contact import stresses
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.half_plane import Roots
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.solids.plane import Anisotropic, Cubic, Orthotropic, along_axes, rotated

pytest.importorskip("mpmath")
from stroh import Punch, Stroh

SHARES = (0.0, 5e-7, 0.6, 0.99)
BESIDE = np.array([-30.0, -1.5, -1.00001, 1.0001, 1.2, 3.0])
ACROSS = np.array([-0.9999, -0.5, 0.0, 0.7, 0.99])


def relative(found, wanted):
    """Largest difference over the largest number."""
    wanted = np.array(wanted, dtype=float)
    return np.abs(found - wanted).max() / np.abs(wanted).max()


def off(found, wanted, X, Y):
    """Largest error of stresses inside, over what errors of these are relative to."""
    found, wanted = (np.reshape(σ, (3, -1, len(X))) for σ in (found, wanted))
    return (np.abs(found - wanted) / stresses.of_inside(wanted, X, Y)).max()


@pytest.mark.parametrize("seed", range(40))
def test_closed_form_is_that_of_eigenvectors(seed):
    solid, rng = random_solid(seed), np.random.default_rng(seed)
    share = SHARES[seed // 4 % len(SHARES)]
    response, g = solid.response(share * solid.limit()), rng.uniform(-1.0, 1.0)
    reference = Stroh(stiffness(response), response.c)
    punch, exact = FlatPunch(response, g), Punch(reference, g)
    constants = [response.n, response.m, response.n12, response.q]
    assert relative(constants, reference.surface) <= 1e-12
    assert punch.α == pytest.approx(float(exact.α), rel=1e-12)
    np.testing.assert_allclose(punch.σ_YY(ACROSS), [float(exact.σ_YY(x)) for x in ACROSS], rtol=1e-12)
    on_surface = np.array([[float(σ) for σ in exact.stresses(x, 0.0)] for x in (*BESIDE, *ACROSS)]).T
    found = punch.σ_XX(np.array([*BESIDE, *ACROSS]))
    assert (np.abs(found - on_surface[0]) / np.abs(on_surface).max(axis=0)).max() <= 1e-12
    X, Y = rng.uniform(-2.0, 2.0, 5), -(10.0 ** rng.uniform(-6.0, 2.0, 5))
    wanted = np.array([[float(σ) for σ in exact.stresses(x, y)] for x, y in zip(X, Y)]).T
    assert off(under(punch).inside(X, Y), wanted, X, Y) <= 1e-12


def test_the_reference_integrates_its_pressure():
    """The eigenvectors' Cauchy integral and load are those of its pressure, by quadrature."""
    import mpmath as mp

    punch = Punch(Stroh([3.0, 1.0, 0.2, 2.0, -0.1, 1.0], 0.5), -0.4)
    mp.mp.dps = 25
    z = mp.mpc(0.3, -0.7)
    load = mp.quad(punch.σ_YY, [-1, 0, 1])
    integral = mp.quad(lambda t: punch.σ_YY(t) / (t - z), [-1, 0, 1])
    assert float(load) == pytest.approx(-2.0, rel=1e-9)
    assert complex(integral) == pytest.approx(complex(punch.cauchy(z)), rel=1e-9)


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("kind", ["orthotropic", "cubic", "anisotropic"])
@pytest.mark.parametrize("share", [0.0, 5e-7, 0.6, 0.99])
def test_an_isotropic_solid_is_one_however_it_is_given(kind, plane, share):
    known = Isotropic(193e9, 0.25, 7860.0, plane)
    solid = isotropic_as(kind, known, 37.0)
    assert solid.limit() == pytest.approx(known.limit(), rel=1e-13)
    assert solid.c_s == pytest.approx(known.c_s, rel=1e-14)
    c, g = share * known.limit(), np.array([[-0.66], [0.0], [0.3]])
    found, wanted = (FlatPunch(one.response(c), g) for one in (solid, known))
    X, Y = np.array([-2.0, -1.001, -0.3, 0.8, 1.2]), np.array([-1e-4, -0.01, -0.5, -2.0, -70.0])
    np.testing.assert_allclose(found.α, wanted.α, rtol=1e-12)
    np.testing.assert_allclose(found.σ_XX(X), wanted.σ_XX(X), rtol=1e-12, atol=1e-13)
    σ = under(wanted).inside(X, Y)
    assert off(under(found).inside(X, Y), σ, X, Y) <= 1e-12
    np.testing.assert_allclose(solid.σ_ZZ(*σ), known.σ_ZZ(*σ), rtol=1e-12, atol=1e-12)
    assert found.response.contraction == pytest.approx(wanted.response.contraction, rel=1e-7)


@pytest.mark.parametrize("seed", range(4))
def test_below_the_limit_the_surface_stands_and_beyond_it_does_not(seed):
    solid = random_solid(seed)
    assert solid.response(0.0).margin == 1.0
    margins = [solid.response(share * solid.limit()).margin for share in (0.3, 0.6, 0.9, 1.0 - 1e-9)]
    assert margins == sorted(margins, reverse=True) and 0.0 < margins[-1] < 1e-6
    try:
        assert solid.response(solid.limit() * (1.0 + 1e-9)).margin < 0.0
    except ValueError as error:  # a wave inside is hardly faster
        assert "waves in the solid" in str(error)


def test_beyond_the_slowest_wave_inside_there_is_no_response():
    solid = Orthotropic(10.0, 1.0, 1.0, 0.3, 0.3, 0.3, 0.3, 1.0, 45.0)
    with pytest.raises(ValueError, match="below that of all waves"):
        solid.response(0.999)


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, -135.0, 400.0])
def test_a_turned_solid_answers_a_turned_strain(angle):
    rng = np.random.default_rng(7)
    root = rng.normal(size=(3, 3))
    C, φ = root @ root.T, np.deg2rad(angle)
    R = np.array([[np.cos(φ), np.sin(φ)], [-np.sin(φ), np.cos(φ)]])  # to the solid's axes
    ε = np.array([[0.3, -0.2], [-0.2, 0.7]])
    own = R @ ε @ R.T
    σ = C @ [own[0, 0], own[1, 1], 2.0 * own[0, 1]]
    wanted = R.T @ np.array([[σ[0], σ[2]], [σ[2], σ[1]]]) @ R
    found = rotated(C, angle) @ [ε[0, 0], ε[1, 1], 2.0 * ε[0, 1]]
    np.testing.assert_allclose(found, [wanted[0, 0], wanted[1, 1], wanted[0, 1]], rtol=1e-12)
    for right in (0.0, 90.0, 180.0, 270.0):  # no rounding makes a solid without symmetry of it
        assert rotated(np.diag([5.0, 1.0, 2.0]), right)[0, 2] == 0.0


@pytest.mark.parametrize("angle", [0.0, 25.0, 90.0])
def test_orthotropic_solids_do_not_stretch_along_Z_in_plane_strain(angle):
    """Hooke's law in the solid's axes, from the definition of its constants."""
    solid = Orthotropic(14.0, 1.0, 0.8, 0.3, 0.25, 0.4, 0.5, 1.0, angle)
    rng, φ = np.random.default_rng(3), np.deg2rad(angle)
    R = np.array([[np.cos(φ), np.sin(φ)], [-np.sin(φ), np.cos(φ)]])
    XX, YY, XY = rng.normal(size=3)
    σ = R @ np.array([[XX, XY], [XY, YY]]) @ R.T
    σ_1, σ_2, σ_3 = σ[0, 0], σ[1, 1], float(solid.σ_ZZ(XX, YY, XY))
    assert σ_3 / 0.8 - 0.25 / 14.0 * σ_1 - 0.4 / 1.0 * σ_2 == pytest.approx(0.0, abs=1e-14)
    ε_1 = σ_1 / 14.0 - 0.3 / 14.0 * σ_2 - 0.25 / 14.0 * σ_3
    ε_2 = σ_2 / 1.0 - 0.3 / 14.0 * σ_1 - 0.4 / 1.0 * σ_3
    γ = σ[0, 1] / 0.5
    own = np.array([[ε_1, γ / 2.0], [γ / 2.0, ε_2]])
    ε = R.T @ own @ R
    found = solid.stiffness @ [ε[0, 0], ε[1, 1], 2.0 * ε[0, 1]]
    np.testing.assert_allclose(found, [XX, YY, XY], rtol=1e-12)
    sheet = Orthotropic(14.0, 1.0, 0.8, 0.3, 0.25, 0.4, 0.5, 1.0, angle, "stress")
    assert sheet.σ_ZZ(XX, YY, XY) == 0.0
    assert 1.0 / np.linalg.inv(rotated(sheet.stiffness, -angle))[0, 0] == pytest.approx(14.0, rel=1e-13)


def test_σ_ZZ_of_anisotropic_solids_needs_its_constants():
    C = (3.0, 1.0, 0.2, 2.0, -0.1, 1.0)
    assert np.isnan(Anisotropic(C, 1.0).σ_ZZ(1.0, 2.0, 3.0))
    assert Anisotropic(C, 1.0, (), "stress").σ_ZZ(1.0, 2.0, 3.0) == 0.0
    solid = Anisotropic(C, 1.0, (0.5, 0.7, 0.1))
    σ = solid.stiffness @ [0.1, 0.2, 0.3]
    assert solid.σ_ZZ(*σ) == pytest.approx(0.5 * 0.1 + 0.7 * 0.2 + 0.1 * 0.3, rel=1e-14)


BAD = [
    (lambda: Orthotropic(1.0, 10.0, 1.0, 0.5, 0.3, 0.3, 0.3, 1.0), "nu12² E2/E1"),
    (lambda: Orthotropic(1.0, 1.0, 10.0, 0.3, 0.5, 0.3, 0.3, 1.0), "nu13² E3/E1"),
    (lambda: Orthotropic(1.0, 1.0, 10.0, 0.3, 0.3, 0.5, 0.3, 1.0), "nu23² E3/E2"),
    (lambda: Orthotropic(1.0, 1.0, 1.0, 0.6, 0.6, 0.6, 0.3, 1.0), "2 nu12 nu13 nu23"),
    (lambda: Orthotropic(1.0, 1.0, 1.0, 0.3, 0.3, 0.3, -0.3, 1.0), "G12"),
    (lambda: Cubic(1.0, 1.1, 0.3, 1.0), r"\(c12/c11\)²"),
    (lambda: Cubic(1.0, -0.6, 0.3, 1.0), "1 \\+ 2 c12/c11"),
    (lambda: Cubic(1.0, 0.5, 0.0, 1.0), "c44"),
    (lambda: Anisotropic((3.0, 1.0, 0.2, 2.0, -0.1, -1.0), 1.0), "c66 = -1"),
    (lambda: Anisotropic((3.0, 2.5, 0.2, 2.0, -0.1, 1.0), 1.0), r"c12²/\(c11 c22\)"),
    (lambda: Anisotropic((3.0, 1.0, 1.8, 2.0, -0.1, 1.0), 1.0), r"c16²/\(c11 c66\)"),
    (lambda: Anisotropic((3.0, 1.0, 0.2, 2.0, 1.5, 1.0), 1.0), r"c26²/\(c22 c66\)"),
    (lambda: Anisotropic((1.0, 0.8, 0.8, 1.0, -0.8, 1.0), 1.0), "determinant"),
    (lambda: Anisotropic((1.0, 0.8), 1.0), "6 finite numbers"),
    (lambda: Anisotropic((3.0, 1.0, float("nan"), 2.0, 0.0, 1.0), 1.0), "6 finite numbers"),
]


@pytest.mark.parametrize(("made", "told"), BAD)
def test_impossible_solids_are_refused(made, told):
    with pytest.raises(ValueError, match=told) as found:
        made()
    assert "expected" in str(found.value)


@pytest.mark.parametrize("angle", [30.0, -150.0, 3990.0, 1e308])
def test_stresses_along_axes_of_any_angle(angle):
    """Those of a tensor turned by it, of which half a turn more makes no difference."""
    σ = np.array([2.0, -0.5, 0.7])
    φ = np.radians(angle % 180.0)
    axes = np.array([[np.cos(φ), np.sin(φ)], [-np.sin(φ), np.cos(φ)]])
    turned = axes @ np.array([[σ[0], σ[2]], [σ[2], σ[1]]]) @ axes.T
    np.testing.assert_allclose(along_axes(*σ, angle), np.diag(turned), atol=1e-12)


@pytest.mark.parametrize("shift, stretch", [(0.0, 1.0), (-3.0, 1.0), (0.7, 20.0)])
def test_roots_are_as_far_apart_as_in_the_hyperbolic_plane(shift, stretch):
    """A vertical line's length is a logarithm, and translations and stretches change no distance."""

    def roots(p, other):
        p, other = shift + stretch * p, shift + stretch * other
        return Roots(p + other, p * other)

    pair = roots(0.5j, 4.0j)
    assert pair.apart == pytest.approx(np.log(8.0), rel=1e-12)
    assert pair.midpoint == pytest.approx(shift + stretch * 2.0**0.5 * 1j, rel=1e-12)
    # Points of the unit circle are on one line, of which i is the middle.
    pair, half = (roots(0.6 + 0.8j, other) for other in (-0.6 + 0.8j, 1j))
    assert pair.apart == pytest.approx(2.0 * half.apart, rel=1e-7)
    assert pair.midpoint == pytest.approx(shift + stretch * 1j, rel=1e-12)
