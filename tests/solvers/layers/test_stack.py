"""Layered and graded half-planes: stiffness, stresses inside and at interfaces, speeds of waves."""

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from layers_cases import COAT, SUBSTRATE, constants, converged_pressure, equation, random_stack
from layers_reference import admittance, graded_admittance, system
from loaded import under
from random_solids import orthotropic
from scipy.linalg import expm
from support import THOROUGH

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.errors import SolveError
from galinx.solvers.layers.kernel import Kernel, Level, transform
from galinx.solvers.layers.layered import Layer, Layered, dispersion, weakest
from galinx.solvers.layers.stiffness import inverse, least
from galinx.solvers.solids.isotropic import Isotropic


def in_digits(solid, c):
    """Layers, substrate and V² of the reference."""
    layers = [(mp.mpf(one.thickness), constants(one.solid), mp.mpf(one.solid.ρ)) for one in solid.layers]
    return layers, (constants(solid.substrate), mp.mpf(solid.substrate.ρ)), mp.mpf(c * solid.c_s) ** 2


@pytest.mark.parametrize("seed", range(30 if THOROUGH else 4))
def test_stiffness_of_random_stacks_is_that_of_the_reference(seed):
    solid, c = random_stack(seed)
    stack = solid.response(c).stack(1.0)
    k = 10.0 ** np.random.default_rng(seed).uniform(-1.5, 0.7, 2) / np.min(
        [one.H for one in stack.layers]
    )
    found = solid.μ**-1 * 1j * inverse(stack.stiffness(k))
    mp.mp.dps = 60 + int(3.0 * max(k) * stack.depths[-1])
    for one, number in zip(found, k.tolist()):
        exact = np.array(admittance(*in_digits(solid, c), mp.mpf(number)).tolist(), dtype=complex)
        assert np.abs(one - exact).max() <= 3e-12 * np.abs(exact).max()


@pytest.mark.parametrize(("grading", "exponent"), [("linear", 1.0), ("exponential", 1.0), ("power", 2.5)])
def test_graded_layers_are_those_of_the_reference(grading, exponent):
    bottom = Isotropic(2.0, 0.2, 1.0)
    layer = Layer(0.8, COAT, bottom, grading, exponent)
    solid = Layered((layer,), bottom)
    c = 0.4 * solid.limit()

    def properties(depth):
        share = (depth / 0.8) ** exponent
        one = layer.at(share)
        return constants(one), one.ρ

    mp.mp.dps = 20
    k = np.array([0.5, 2.0, 4.0])
    found = 1j * inverse(solid.response(c).stack(1.0).stiffness(k)) / solid.μ
    for one, number in zip(found, k.tolist()):
        exact = graded_admittance(properties, 0.8, (c * solid.c_s) ** 2, number)
        assert np.abs(one - exact).max() <= 1e-9 * np.abs(exact).max()


def test_a_power_of_the_depth_that_is_no_whole_number_leaves_no_error_of_the_kernel():
    """Next to 0 its kernel goes with a power of the distance, which no polynomial follows."""
    bottom = Isotropic(2.0, 0.2, 1.0)
    stack = Layered((Layer(0.8, COAT, bottom, "power", 1.5),), bottom).response(0.2).stack(1.0)
    kernel = Kernel(stack, 1e-8)
    assert kernel.error < 1e-7
    near = 10.0 ** np.array([-7.0, -6.0, -5.0, -4.0])
    rise = np.abs(kernel(near) - kernel(np.array([1e-12])))[:, 3]
    assert np.diff(np.log10(rise)) == pytest.approx(0.5, abs=0.02)  # 1.5 less 1


@pytest.mark.parametrize("power", [1.0, 1.02, 1.5])
def test_waves_much_shorter_than_a_graded_top_feel_the_power_of_the_depth(power):
    """Their stiffness goes to its limit, and the kernel is that of the layer in two parts."""
    bottom = Isotropic(2.0, 0.2, 1.0)
    stack = Layered((Layer(0.8, COAT, bottom, "power", power),), bottom).response(0.2).stack(1.0)
    top, k = stack.layers[0], 1e5
    δ = k**power * stack.excess(np.array([k]))[0]
    np.testing.assert_allclose(top.first_order(), δ, rtol=0, atol=1e-4 * np.abs(δ).max())
    parts = replace(stack, layers=top.cut(0.3))
    x = np.array([-2.0, -0.3, -1e-3, 1e-6, 1e-3, 0.7])
    np.testing.assert_allclose(Kernel(stack, 1e-6)(x), Kernel(parts, 1e-6)(x), rtol=0, atol=1e-5)


def test_speed_limit_of_uniform_half_planes_and_of_soft_layers_inside():
    same = Layered((Layer(0.3, COAT), Layer(2.0, COAT)), COAT)
    assert same.limit() == pytest.approx(COAT.limit(), rel=1e-12)
    hard = Layered((Layer(1.0, COAT),), SUBSTRATE)
    assert hard.limit() * COAT.c_s == pytest.approx(SUBSTRATE.limit() * SUBSTRATE.c_s, rel=1e-12)
    # The slowest wave is one along the substrate by itself.
    below = hard.response(0.9 * hard.limit())
    assert (below.margin, below.left_below) == pytest.approx((0.19, 0.19), rel=1e-12)
    soft = Layered((Layer(1.0, SUBSTRATE),), COAT)
    assert soft.limit() == pytest.approx(SUBSTRATE.limit(), rel=1e-12)
    # Short waves in a soft layer inside run with its own shear speed.
    inside = Layered((Layer(1.0, COAT), Layer(0.5, SUBSTRATE)), COAT)
    assert inside.limit() * COAT.c_s == pytest.approx(SUBSTRATE.c_s, rel=1e-9)


def test_speed_limit_of_an_incompressible_graded_layer_is_the_limit_of_others():
    """Slices of it, held on top, are much stiffer than waves longer than all layers have digits for."""

    def limit(ν):
        top, bottom = (Isotropic(E, ν, 1.0) for E in (1.0, 2.0))
        stiff = Layer(11.0, Isotropic(50.0, 0.3, 1.5))
        return Layered((Layer(1.0, top, bottom), stiff), Isotropic(20.0, 0.33, 0.5)).limit()

    assert limit(0.5) == pytest.approx(limit(0.5 - 1e-7), rel=1e-6)
    assert limit(0.5) == pytest.approx(Isotropic(1.0, 0.5, 1.0).limit(), rel=1e-9)


def test_speed_limit_where_stiffness_vanishes_within_its_own_error():
    """A wave's stiffness by itself is 1e-9 there, that among other waves -1e-10."""
    top, bottom = Isotropic(200.0, 0.3, 5.0), Isotropic(100.0, 0.3, 4.0)
    linear, limit = (
        Layered((Layer(1.0, top, bottom, "power", power),), Isotropic(70.0, 0.3, 2.7)).limit()
        for power in (1.0, 1.1)
    )
    assert linear < limit < (1.0 + 5e-4) * linear


def test_speed_limit_at_a_wavenumber_inside_is_found():
    """Of a heavy plate on a light solid of the same wave speed."""
    light = Isotropic(1.0, 0.3, 1.0)
    solid = Layered((Layer(1.0, light), Layer(0.5, Isotropic(5.0, 0.3, 12.0))), light)
    limit = solid.limit()
    ends = min(solid.surface.limit(), solid.substrate.limit() * solid.substrate.c_s / solid.c_s)
    assert limit < 0.99 * ends
    below, above = (weakest(solid.response(c).stack(1.0)) for c in (0.9999 * limit, 1.0001 * limit))
    assert below[0] > 0.0 > above[0]
    assert 0.05 < below[1] < 20.0
    # By brute force: the smallest stiffness over many wavenumbers, in the reference's digits.
    mp.mp.dps = 40
    for c, sign in ((0.9995 * limit, 1.0), (1.0005 * limit, -1.0)):
        Y = admittance(*in_digits(solid, c), mp.mpf(below[1]))
        Z = np.linalg.inv(np.array((-1j * Y).tolist(), dtype=complex))
        assert sign * np.linalg.eigvalsh(Z)[0] > 0.0
    # No wave is slower, and the slowest is one of that speed.
    slowest = np.nanmin(curve(solid, np.geomspace(1.0, 6.0, 41)))
    assert slowest == pytest.approx(limit, rel=1e-4) and slowest >= limit * (1.0 - 1e-7)


def test_the_smaller_eigenvalue_of_any_sign_is_that_of_lapack():
    rng = np.random.default_rng(1)
    Z = rng.normal(size=(200, 2, 2)) + 1j * rng.normal(size=(200, 2, 2))
    Z = Z + Z.conj().swapaxes(1, 2) + rng.uniform(-6.0, 6.0, 200)[:, None, None] * np.eye(2)
    wanted = np.linalg.eigvalsh(Z)
    assert (wanted > 0.0).all(axis=1).any() and (wanted < 0.0).all(axis=1).any()
    np.testing.assert_allclose(least(Z), wanted[:, 0], rtol=1e-13, atol=1e-13)
    assert np.isnan(least(Z[:1] * np.nan))


def test_layers_with_a_fault_say_so():
    with pytest.raises(ValueError, match="one sign"):
        Layer(1.0, Isotropic(1.0, 0.3, 1.0), Isotropic(1.0, -0.1, 1.0), "exponential")
    with pytest.raises(ValueError, match="same kind"):
        Layer(1.0, COAT, orthotropic(np.random.default_rng(0)))
    with pytest.raises(ValueError, match="wavenumbers > 0"):
        Layered((Layer(1.0, COAT, SUBSTRATE),), SUBSTRATE).response(0.1).stack(1.0).excess(np.zeros(1))


def test_fourier_integrals_are_exact():
    x = np.array([0.0, 1e-9, 0.3, -2.0, 40.0])
    found = transform(lambda k: np.stack([np.exp(-k), 1j * k * np.exp(-2.0 * k)], axis=-1), 0.2, 1e-13)
    exact = np.stack([1.0 / (1.0 + x**2), -4.0 * x / (4.0 + x**2) ** 2], axis=-1) / np.pi
    assert np.abs(found(x) - exact).max() <= 1e-13
    with pytest.raises(SolveError, match="smooth"):
        transform(lambda k: np.ones((len(k), 1), dtype=complex), 0.2, 1e-13)


@pytest.mark.parametrize("E", [*[1.2] * THOROUGH, 6.0])
def test_a_graded_layer_is_no_faster_than_its_slowest_face(E):
    """Waves much shorter than the layer run along its softer face, here inside, with its shear speed."""
    soft, hard = Isotropic(E, 0.3, 1.0), Isotropic(20.0, 0.3, 1.0)
    solid = Layered((Layer(0.5, hard), Layer(1.0, soft, Isotropic(2.0 * E, 0.3, 1.0))), hard)
    limit = solid.limit() * solid.c_s / soft.c_s
    assert 1.0 - 2e-3 < limit < 1.0
    assert weakest(solid.response(0.9999 * solid.limit()).stack(1.0))[0] > 0.0


def test_layers_of_one_solid_have_its_constants():
    names = ("c11", "c12", "c22", "c66", "c", "ρ")
    alone = COAT.response(0.4).constants(names)
    assert len(alone) == 1
    for each in Layered((Layer(0.3, COAT),), COAT).response(0.4).constants(names):
        np.testing.assert_allclose(each, alone[0], rtol=1e-12)


X = np.linspace(-3.0, 3.0, 25)


@pytest.mark.parametrize("depth", [0.02, 0.3, 0.5, 0.7, 2.0])
def test_layers_of_one_solid_have_the_field_of_the_half_plane(depth):
    solid = Layered((Layer(0.3, COAT), Layer(0.4, COAT)), COAT)
    one = equation(solid, 0.9, -0.4)
    pressure = converged_pressure(one, 1e-10).pressure
    exact = under(FlatPunch(COAT.response(0.9**0.5 / COAT.c_s), -0.4)).inside(X, -depth + 0.0 * X)
    level = Level(one.kernel.stack, depth, 4.0, 1e-9)
    u_X, σ_YY, σ_XY = level.read(*pressure.points(depth), -0.4, X)
    σ_XX = level.media[1].response.σ_XX(u_X, σ_YY, σ_XY)
    assert np.abs(np.array([σ_XX, σ_YY, σ_XY]) - exact).max() <= 1e-9 * np.abs(exact).max()


def test_depths_inside_a_graded_layer_are_interfaces_of_its_parts():
    """Fields are kept for all depths, but for the last layers alone; of others they are found again."""
    stack = Layered((Layer(0.3, COAT, SUBSTRATE),), SUBSTRATE).response(0.3).stack(1.0)
    k, depths = np.geomspace(0.1, 200.0, 24), (0.01, 0.1, 0.29)
    inside = [Level(stack, depth, 4.0, 1e-9)._of(k) for depth in depths]
    for depth, rows in zip(depths, inside):
        parts = replace(stack, layers=stack.layers[0].cut(depth))
        at_interface = Level(parts, depth, 4.0, 1e-9)._of(k)
        np.testing.assert_allclose(rows, at_interface, rtol=0, atol=1e-9 * np.abs(rows).max())
    assert "_kept" not in vars(stack)
    np.testing.assert_array_equal(Level(stack, depths[1], 4.0, 1e-9)._of(k), inside[1])


@pytest.mark.parametrize("graded", [False, True])
def test_field_is_that_of_the_reference(graded):
    """At some wavenumbers, at an interface and inside the substrate."""
    middle = Layer(0.4, SUBSTRATE, COAT) if graded else Layer(0.4, SUBSTRATE)
    solid = Layered((Layer(0.3, COAT), middle), COAT)
    c = 0.5 * solid.limit()
    stack, V2 = solid.response(c).stack(1.0), mp.mpf(c * solid.c_s) ** 2
    mp.mp.dps = 40
    for k in (0.5, 3.0):
        tops = (
            [layer_system(middle.at(s), V2, k) for s in (np.arange(200) + 0.5) / 200] if graded else None
        )
        exact = carried(solid, V2, mp.mpf(k), tops)
        for depth, rows in exact.items():
            level = Level(stack, depth, 4.0, 1e-9)
            got = level._of(np.array([k]))[0]
            off = np.abs(got - rows).max() / np.abs(rows).max()
            assert off <= (2e-5 if graded else 1e-12)


def layer_system(solid, V2, k):
    return system(constants(solid), mp.mpf(solid.ρ), V2, mp.mpf(k))


def carried(solid, V2, k, slices):
    """u,X, σ_YY, σ_XY by σ_XY and σ_YY on top, at the lower interface and 0.5 below it, (6,) each."""
    below = layer_system(solid.substrate, V2, k)
    values, vectors = mp.eig(below)
    chosen = [n for n in range(4) if mp.re(values[n]) > 0]
    field = mp.matrix([[vectors[row, n] for n in chosen] for row in range(4)])
    deep = mp.expm(below * -0.5) * field
    top = field
    middle = solid.layers[1]
    if slices is None:
        top = mp.expm(layer_system(middle.solid, V2, k) * middle.thickness) * top
    else:
        step = middle.thickness / len(slices)
        of_slices = [expm(np.array(one.tolist(), dtype=complex) * step) for one in slices]
        top = mp.matrix(np.linalg.multi_dot(of_slices).tolist()) * top
    top = mp.expm(layer_system(solid.layers[0].solid, V2, k) * solid.layers[0].thickness) * top
    by_top = top[2:, :] ** -1
    μ, found = mp.mpf(solid.μ), {}
    for depth, one in ((0.7, field), (1.2, deep)):
        here = one * by_top
        rows = [mp.mpc(0, 1) * k * here[0, :] * μ, here[3, :], here[2, :]]
        found[depth] = np.array([complex(row[j]) for row in rows for j in range(2)])
    return found


def curve(solid, k):
    return dispersion(lambda c: solid.response(c).stack(1.0), 1.0, k, 1e-8)


def test_stiff_coatings_make_waves_faster_until_none_is_left():
    """Beyond the shear speed of the substrate the wave would leak."""
    solid = Layered((Layer(1.0, COAT),), SUBSTRATE)
    found = curve(solid, np.geomspace(0.03, 30.0, 9)) * COAT.c_s
    known = found[np.isfinite(found)]
    assert 2 <= len(known) < 9 and np.all(np.diff(known) > 0.0)
    assert SUBSTRATE.limit() < known[0] < known[-1] < SUBSTRATE.c_s
