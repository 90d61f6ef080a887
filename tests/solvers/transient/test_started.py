"""Starts from rest by both methods against what is known, and against each other."""

import numpy as np
import pytest
from random_solids import random_solid
from starts import SOLID, ByFiniteElements, by_integral_equation
from support import THOROUGH

from galinx.meshes.waves import Reached
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import smooth
from galinx.solvers.transient.late_time import approach
from galinx.solvers.transient.line_load import UniformLayers
from galinx.solvers.transient.punch import BESIDE

ONE, COAT, SOFT = Isotropic(2.5, 0.25, 1.0), Isotropic(7.5, 0.3, 1.2), Isotropic(1.5, 0.1, 0.7)
STACK = Layered((Layer(0.7, COAT), Layer(0.4, SOFT)), ONE)


def differences(solid, c, g, end, steps, ramp=3.0, terms=24, **mesh):
    """Of v₀, centre, K_I, energy and work over their largest, of energy and work, and of the centre."""
    started = ByFiniteElements(solid, c, end, steps, **mesh)
    run = started.run(g, lambda t: smooth(t, ramp))
    found, expected = started.told(run, g), by_integral_equation(solid, c, g, end, steps, ramp, terms)
    np.testing.assert_allclose(found.load, expected.load, atol=1e-10)
    K = max(np.abs(expected.K_left).max(), np.abs(expected.K_right).max())
    lean, work = expected.centre * expected.load, expected.work_of_load + expected.work_of_friction
    return [
        np.abs(run.v0 - expected.v0).max() / np.abs(expected.v0).max(),
        np.abs(found.centre * expected.load - lean).max() / np.abs(lean).max(),
        max(np.abs(found.K_left - expected.K_left).max(), np.abs(found.K_right - expected.K_right).max())
        / K,
        np.abs(work - run.energy - run.absorbed).max() / np.abs(work).max(),
        np.abs(run.energy + run.absorbed - run.work).max() / np.abs(run.work).max(),
        np.abs(found.centre * expected.load - lean).max(),
    ]


def over_layers(end):
    fast = UniformLayers.of(STACK.response(0.0)).fastest
    return Reached(1.0 + fast * end / 2.0, fast * end / 2.0, 1.0, 0.15, 1e-4, depths=(0.7, 1.1))


ROTATED = random_solid(1)
BOTH = {
    "changing friction": (
        (SOLID, 0.6, lambda t: -0.6 * (1.0 - np.exp(-t)), 2.0, 10, 2.0, 16), {},
        (3e-5, 1e-3, 1e-3, 1e-4, 1e-5)),
    "rotated": ((ROTATED, 0.6 * ROTATED.limit(), -0.4, 2.0, 10, 2.0, 16), {},
                (5e-4, 5e-4, 5e-4, 1e-4, 1e-5)),
    "layers": (
        (STACK, 0.3, -0.4, 2.0, 14, 2.0, 16), {"degree": 6, "mesh": over_layers(2.0)},
        (1e-4, 2e-3, 1e-3, 1e-4, 1e-5)),
}  # fmt: skip


@pytest.mark.parametrize("name", BOTH)
def test_both_methods_agree(name):
    """They know nothing of each other; load and friction give what moves and is strained."""
    start, options, limits = BOTH[name]
    found = differences(*start, **options)
    assert (np.array(found[:5]) < limits).all(), found


@pytest.mark.skipif(not THOROUGH, reason="takes long: GALINX_THOROUGH=1")
@pytest.mark.parametrize(
    "changes, seed", [*((False, n) for n in range(8)), *((True, n) for n in range(6))]
)
def test_both_methods_agree_on_random_solids(changes, seed):
    """What is left is K_I of the finite elements at strongly singular ends."""
    rng, solid = np.random.default_rng(seed), random_solid(seed)
    c, drawn = rng.uniform(0.0, 0.8) * solid.limit(), rng.uniform(-0.7, 0.7, 2)
    one, other = drawn * min(1.0, 0.6 * min(solid.flutter(c)))  # beyond flutter nothing is well posed
    g, end, steps = (lambda t: one + other * np.sin(t), 4.0, 50) if changes else (one, 5.0, 60)
    found = differences(solid, c, g, end, steps, degree=9)
    assert found[0] < (1e-4 if changes else 3e-4) and found[2] < 3e-3
    assert found[1] < 3e-3 and found[3] < 3e-4 if changes else found[5] < 3e-4


def test_integral_equation_knows_the_mirror_image():
    """What moves the other way with friction reversed is the same from the other side."""
    forward = by_integral_equation(SOLID, 0.5, -0.6, 2.0, 4)
    backward = by_integral_equation(SOLID, 0.5, 0.6, 2.0, 4, way=-1)
    np.testing.assert_allclose(backward.v0, forward.v0, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose((backward.centre + forward.centre) * forward.load, 0.0, atol=1e-12)
    np.testing.assert_allclose(backward.K_left, forward.K_right, rtol=0.0, atol=1e-12)


def test_quadrature_has_its_order():
    """Steps of a half leave a 2⁵th at least, up to what K_I and rounding leave."""
    best, coarse, fine = (by_integral_equation(SOLID, 0.6, -0.4, 2.0, n, 2.0, 12).v0 for n in (12, 3, 6))
    errors = [np.abs(one - best[k - 1 :: k]).max() for one, k in ((coarse, 4), (fine, 2))]
    assert errors[0] / errors[1] > 2.0**3.5


def test_scheme_of_finite_elements_converges():
    """The same mesh, steps of a half and a quarter: of order four where the load is smooth enough.

    The ramp's third derivative jumps, so that somewhat less is seen of two halvings.
    """
    started = ByFiniteElements(SOLID, 0.6, 2.0, 20, degree=6, innermost=1e-2)
    v0 = {n: started.run(-0.4, lambda t: smooth(t, 2.0), n).v0 for n in (5, 20, 80)}
    coarse, fine = (np.abs(v0[n] - v0[80][80 // n - 1 :: 80 // n]).max() for n in (5, 20))
    assert coarse / fine > 2.0**5


@pytest.fixture(scope="module")
def small():
    """Few cells, up to t = 2."""
    return ByFiniteElements(SOLID, 0.5, 2.0, 10, degree=5, innermost=1e-2)


def test_steady_motion_goes_on(small):
    """Where nothing changes; and friction that does makes it change."""
    run = small.run(-0.4, lambda t: 1.0, steady=True)
    size = np.abs(run.forces).max()
    np.testing.assert_allclose(run.forces, np.tile(run.forces[0], (10, 1)), atol=1e-9 * size)
    assert np.abs(run.v0).max() < 1e-9
    assert np.abs([run.work, run.energy, run.absorbed]).max() < 1e-9
    other = small.run(lambda t: -0.4 * (1.0 - t / 2.0), lambda t: 1.0, steady=True)
    assert np.abs(other.forces[-1] - run.forces[-1]).max() > 1e-2 * size


def test_the_way_back_is_the_mirror_image(small):
    there, back = small.run(-0.4), small.run(0.4, directions=(-1,))
    size = np.abs(there.forces).max()
    np.testing.assert_allclose(back.forces[:, ::-1], there.forces, rtol=0.0, atol=1e-12 * size)
    np.testing.assert_allclose(back.v0, there.v0, atol=1e-12)
    assert np.abs(there.forces - there.forces[:, ::-1]).max() > 1e-2 * size


def test_what_cells_hold_is_not_damped(small):
    """Polynomials of a low degree are left alone in every cell, and higher ones lose energy."""
    space = small.motion.space
    _, rates = small.motion._damping
    assert len(rates) == space.cells and (rates >= 0.0).all()
    X, Y = space.coordinates.T[:2]
    low, high = X**2 - X * Y, np.cos(4.0 * X) * np.sin(3.0 * Y)
    D, M = small.motion.D, small.motion.M
    assert abs(low @ D @ low) < 1e-9 * (low @ M @ low)
    assert high @ D @ high > 1e-3 * (high @ M @ high)


@pytest.mark.parametrize("solid, g", [*[(SOLID, -0.4)] * THOROUGH, (random_solid(2), 0.4)])
def test_what_is_left_falls_like_1_over_t(solid, g):
    """The first term of a series with t log t in the next: two times tell it without most of that."""
    c = 0.5 * solid.limit()
    steady, told, left = FlatPunch(solid.response(c), g), approach(solid, c, g), []
    sides = steady.σ_XX(np.array([-1.0 - BESIDE, 1.0 + BESIDE]))
    for end in (30.0, 60.0):
        found = by_integral_equation(solid, c, g, end, 18, 4.0, 10)
        ratios = found.K_left[-1] / steady.K_I - 1.0, found.K_right[-1] / steady.K_I - 1.0
        beside = np.array([found.σ_XX_left[-1], found.σ_XX_right[-1]]) - sides
        left.append(np.array([found.centre[-1] - (steady.β - steady.α), *ratios, *beside]))
    # Since the load was half.
    found = 2.0 * left[1][:3] * 58.0 - left[0][:3] * 28.0
    np.testing.assert_allclose(found, [told.centre, told.K_left, told.K_right], rtol=0.05)
    assert np.abs(2.0 * left[1] - left[0])[3:].max() < 5e-3 * np.abs(sides).max()
    t, slowest = told.within(0.01), max(map(abs, (told.centre, told.K_left, told.K_right)))
    assert slowest / t + told.at_rest / t**2 == pytest.approx(0.01, rel=1e-12)


def test_at_rest_it_falls_like_the_square():
    told, found = approach(SOLID, 0.0, 0.0), by_integral_equation(SOLID, 0.0, 0.0, 20.0, 24, 4.0, 12)
    assert told.centre == told.K_left == told.K_right == 0.0
    left = np.array([found.K_left[-1], found.K_right[-1]]) / FlatPunch(SOLID.response(0.0), 0.0).K_I - 1.0
    np.testing.assert_allclose(left * 18.0**2, told.at_rest, rtol=0.05)
    assert told.within(0.01) == pytest.approx((100.0 * told.at_rest) ** 0.5)


def test_a_graded_layer_is_refused():
    graded = Layered((Layer(1.0, ONE, bottom=COAT),), COAT)
    with pytest.raises(ValueError, match="graded"):
        UniformLayers.of(graded.response(0.3))
