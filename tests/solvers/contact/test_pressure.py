import numpy as np
import pytest
from scipy.integrate import newton_cotes
from scipy.special import roots_jacobi

from galinx.meshes import MESHES
from galinx.solvers.contact import recovery as pressure
from galinx.solvers.contact.equation import Jacobi
from galinx.solvers.contact.panels import Panels
from galinx.solvers.contact.pressure import NEXT_TO_TIP, Expansion, off_tips

α = np.array([-0.5, -0.42, -0.7])
β = -1.0 - α


def test_a_pressure_is_found_from_its_moments():
    """(1 - r)^α (1 + r)^β (2 + r³) and its values at the ends."""
    for i in range(len(α)):
        with np.errstate(invalid="ignore"):
            t, w = roots_jacobi(20, α[i], β[i])
        moments = (w * (2.0 + t**3)) @ pressure.chebyshev(t)
        found = pressure.from_moments(moments[None], α[i : i + 1], β[i : i + 1])
        r = np.array([-2.0, -0.9, 0.1, 0.999])
        wanted = (1.0 - r[1:]) ** α[i] * (1.0 + r[1:]) ** β[i] * (2.0 + r[1:] ** 3)
        σ_YY = found.σ_YY(r)
        assert σ_YY[0, 0] == 0.0
        np.testing.assert_allclose(σ_YY[0, 1:], wanted, rtol=1e-12)
        np.testing.assert_allclose(found.K_I, [[-0.5, -1.5]], rtol=1e-12)


def test_fitted_exponents():
    d = np.geomspace(1e-6, 1e-3, 8)
    σ = np.array([-3.0 * d**-0.43, d**-0.6, np.linspace(-1.0, 1.0, 8)])
    found = pressure.fitted_exponent(d, σ)
    np.testing.assert_allclose(found[:2], [-0.43, -0.6], rtol=1e-12)
    assert np.isnan(found[2])


def test_a_pressure_is_recovered_from_its_nodal_forces():
    """-1/√(1 - r²) is a constant of the confocal chart's surface coordinate, so its forces are exact."""
    degree, facets, chart = 4, 60, MESHES["confocal"].chart
    s = np.linspace(-np.pi / 2.0, np.pi / 2.0, facets * degree + 1)
    forces = np.zeros_like(s)
    for first in range(0, len(s) - 1, degree):
        forces[first : first + degree + 1] -= newton_cotes(degree)[0] * (s[1] - s[0])
    r = np.array([-1.5, -0.8, 0.0, 0.33, 0.9, 1.2])
    maps = pressure.ContactRecovery(s, degree, chart, r, farthest=1e-2)
    inside = np.abs(r) < 1.0
    found = forces @ maps.raw
    assert np.isnan(found[~inside]).all()
    np.testing.assert_allclose(found[inside], -1.0 / np.sqrt(1.0 - r[inside] ** 2), rtol=1e-11)
    # ∫ T_k/√(1 - r²) dr is π for k = 0 and else 0; nodes interpolate T_k = cos(kθ).
    np.testing.assert_allclose(forces @ pressure.chebyshev(np.sin(s)), [-np.pi] + 8 * [0.0], atol=1e-9)
    for d, to_σ in maps.edges:
        np.testing.assert_allclose(forces @ to_σ, -1.0 / np.sqrt(d * (2.0 - d)), rtol=1e-9)
    # Both ends are looked at alike.
    np.testing.assert_allclose(*(np.sort(d) for d, _ in maps.edges), rtol=1e-12)
    # The second term of the pressure at an edge bends d^(-1/2) by a quarter of the distance.
    np.testing.assert_allclose(maps.exponents(forces[None]), [[-0.5, -0.5]], atol=1e-2 / 4.0)


def test_rounding_of_the_smallest_cells_positions_stays_there():
    """They have a few digits only; facets of 1e-11 a beside the edges tell nothing of the others."""
    ends = np.array([-1.0, -1.0 + 1e-11, -1.0 + 1e-5, -0.5, 0.5, 1.0 - 1e-5, 1.0 - 1e-11, 1.0])
    nodes = (1.0 - np.cos(np.pi * np.arange(5) / 4.0)) / 2.0
    inner = ends[:-1, None] + np.diff(ends)[:, None] * nodes[:-1]
    s = np.append(inner.ravel(), 1.0)
    moved = s.copy()
    moved[1:4] = np.nextafter(moved[1:4], 1.0)
    chart, r = MESHES["graded"].chart, np.array([-0.9, 0.0, 0.7])
    one, other = (pressure.ContactRecovery(positions, 4, chart, r).raw for positions in (s, moved))
    np.testing.assert_allclose(other, one, rtol=1e-9, atol=1e-9 * np.abs(one).max())


@pytest.mark.parametrize("exponents", [(0.5, 0.5), (0.3, 0.7)])
def test_slopes_next_to_free_ends_are_continued_and_what_is_left_of_an_intensity_is_taken_away(exponents):
    """Of two series in the distance from either end, on both sides, and an intensity of the elements."""

    def slopes(X, left_over):
        end = (X > 0.0).astype(int)
        d, a = np.abs(np.abs(X) - 1.0), np.array(exponents)[end]
        series = 1.0 + 2.0 * d - 3.0 * d**2 + d**a * (4.0 - (1.0 + end) * d) + end
        return series + left_over * d ** (a - 1.0)

    X = np.array([-1.08, -1.0 - 1e-6, -1.0 + 1e-7, -0.93, -0.5, 0.4, 0.95, 1.0 - 1e-8, 1.0 + 1e-5, 1.03])
    places, to_slopes = pressure.slopes_towards_ends(X, (2.0, 2.0), exponents)
    assert (np.abs(np.abs(places[len(X) :]) - 1.0) > 1e-5).all()
    far = np.abs(np.abs(X) - 1.0) > 0.1
    expected = np.where(far, slopes(X, 0.01), slopes(X, 0.0))
    np.testing.assert_allclose(to_slopes @ slopes(places, 0.01), expected, rtol=1e-7)


def test_places_at_a_tip_are_moved_off_it_on_their_own_side():
    """Where friction leans on one side, so does the pressure."""
    tip, d = 0.3, NEXT_TO_TIP
    r = np.array([-1.0, tip - 2.0 * d, tip - 0.5 * d, tip + 0.1 * d, tip + 3.0 * d, 0.9])
    moved = np.array([-1.0, tip - 2.0 * d, tip - d, tip + d, tip + 3.0 * d, 0.9])
    np.testing.assert_allclose(off_tips(r, (tip,)), moved, rtol=0.0, atol=1e-15)


@pytest.mark.parametrize("functions", [Jacobi(0.5, 0.5), Panels(0.5, 0.5, 1.0, rough=False)])
@pytest.mark.parametrize("length", [3e-4, 1e-2, 0.3])
def test_kernels_of_thin_films_are_integrated_however_few_functions_the_pressure_has(functions, length):
    """∫ ℓ √(1 - t²)/((r - t)² + ℓ²) dt = Im π (√(z² - 1) - z) at z = r + iℓ."""
    c = np.ones_like(functions.t) if isinstance(functions, Panels) else np.array([1.0, 0.0])
    r = np.array([-1.3, -1.0, -0.999, -0.2, 0.077, 0.5, 1.01])
    pressure = Expansion(0.5, 0.5, c, functions)
    found = pressure.integral(lambda x: (length / (x**2 + length**2))[..., None], r, length)
    z = r + 1j * length
    wanted = np.pi * (np.sqrt(z - 1.0) * np.sqrt(z + 1.0) - z).imag
    np.testing.assert_allclose(found[:, 0], wanted, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("length", [0.01, 0.1, 1.0])
@pytest.mark.parametrize("kinks", [(), (-0.9, 0.3)])
def test_kernels_with_a_logarithm_are_integrated_wherever_the_place_is(kinks, length):
    """∫ log(z - t) T₃/√(1 - t²) dt = -(π/3) (z - √(z² - 1))³, over a short length less that of z + iℓ."""
    panels = Panels(-0.5, -0.5, 0.35, kinks, length=length)
    at_ends = panels.ends[2:-2:3]
    x = np.concatenate([panels.x[::19], at_ends + 1e-14, at_ends - 1e-7])
    x = x[np.abs(x) < 10.0]  # nearer to the contact's ends the weight beyond the panels is felt

    def kernel(s):
        return ((np.log(np.abs(s)) - np.log(s**2 + length**2) / 2.0) / length)[..., None]

    def integral(z):
        return -np.pi / 3.0 * ((z - np.sqrt(z - 1.0) * np.sqrt(z + 1.0)) ** 3).real

    s = np.tanh(x / 2.0)
    found = panels.rows(kernel, x)[..., 0] @ (4.0 * panels.t**3 - 3.0 * panels.t)
    wanted = (integral(s + 0.0j) - integral(s + 1j * length)) / length
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=1e-11)
