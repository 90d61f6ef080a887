"""Layers in time: symbols in many digits, layers that are none, echoes at their time, both methods."""

import mpmath as mp
import numpy as np
import pytest
from layers_reference import admittance, plane_strain
from mpi4py import MPI

from galinx.meshes.charts import Physical
from galinx.meshes.rings import TAGS
from galinx.meshes.waves import Reached
from galinx.postprocess.over_time import contact_numbers
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.in_time import SlidingInTime
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import Way, smooth
from galinx.solvers.transient.line_load import Echoes, UniformLayers
from galinx.solvers.transient.punch import StartingPunch

ONE, COAT, SOFT = Isotropic(2.5, 0.25, 1.0), Isotropic(7.5, 0.3, 1.2), Isotropic(1.5, 0.1, 0.7)
STACK = Layered((Layer(0.7, COAT), Layer(0.4, SOFT)), ONE)
#: The same for the reference.
DIGITS = [(7.5, 0.3, 1.2), (1.5, 0.1, 0.7), (2.5, 0.25, 1.0)]


def sheets(solid):
    return UniformLayers.of(solid.response(0.0))


def random_points(count):
    """k, s with Re s > 0, and c, seeded."""
    rng = np.random.default_rng(5)
    for _ in range(count):
        s = complex(10.0 ** rng.uniform(-1.0, 1.0), 10.0 ** rng.uniform(-1.0, 1.3) * rng.choice([-1, 1]))
        yield -(10.0 ** rng.uniform(-1.0, 0.8)), s, rng.uniform(-0.55, 0.55)


def test_symbol_of_layers_is_that_of_many_digits():
    mp.mp.dps = 40
    of = [(plane_strain(E, ν), ρ) for E, ν, ρ in DIGITS]
    layers = [(H, *one) for H, one in zip((0.7, 0.4), of)]
    for k, s, c in random_points(12):
        C = c + 1j * s / k
        V2 = mp.mpmathify(C) ** 2 * STACK.μ / STACK.ρ
        exact = admittance(layers, of[-1], V2, mp.mpf(k)) - admittance([], of[0], V2, mp.mpf(k))
        exact = np.array((exact * STACK.μ).tolist(), dtype=complex)
        found = sheets(STACK).change(np.array([k]), np.array([C]))[0]
        np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-13)


def test_echoes_are_the_transform_of_their_symbol():
    """By the trapezoidal rule along the whole axis of k."""
    c, s, x = 0.3, 1.5 + 4.0j, np.array([0.05, 0.4, 1.7])
    κ = np.linspace(-80.0, 80.0, 16000)  # an even number: none at 0, where a formula divides
    found = Echoes(sheets(STACK), c)(x, s)
    left, of = κ < 0.0, np.empty((len(κ), 2, 2), dtype=complex)
    of[left] = sheets(STACK).change(κ[left], c + 1j * s / κ[left])
    # Fields of k > 0 are the conjugates of those of -k and the conjugate of s.
    other = -κ[~left]
    of[~left] = np.conj(sheets(STACK).change(other, c + 1j * np.conj(s) / other))
    values = of[:, ::-1, ::-1].reshape(-1, 4).T / (1j * κ)
    expected = values @ np.exp(1j * np.outer(κ, x)) * (κ[1] - κ[0]) / (2.0 * np.pi)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-8 * np.abs(expected).max())


def started(solid, c, end=4.0, steps=8, g=-0.4, terms=8):
    response = solid.response(c)
    return StartingPunch(response, solid.limit(), end, steps, terms).course(g, lambda t: smooth(t, 3.0))


def test_layers_of_the_substrate_are_no_layers():
    alone, layers = started(ONE, 0.5), started(Layered((Layer(0.6, ONE), Layer(0.5, ONE)), ONE), 0.5)
    for name in ("v0", "centre", "K_left", "K_right", "work_of_friction", "σ_XX_left"):
        np.testing.assert_allclose(getattr(layers, name), getattr(alone, name), rtol=1e-10, atol=1e-10)


def test_a_layer_is_all_there_is_until_its_echo_comes_back():
    H, c_d = 2.0, np.sqrt(3.0)
    alone, coated = started(ONE, 0.5, steps=16), started(Layered((Layer(H, ONE),), COAT), 0.5, steps=16)
    off = np.abs(coated.v0 - alone.v0) / np.abs(alone.v0[-1])
    # Steps of 1/4 let it be felt a little earlier.
    assert off[alone.t < 2.0 * H / c_d - 1.0].max() < 1e-6
    assert off[-1] > 1e-2


def test_finite_elements_agree_over_layers():
    c, g, end, steps, degree = 0.3, -0.4, 3.0, 18, 6
    response = STACK.response(c)
    fast = sheets(STACK).fastest
    mesh = Reached(1.0 + fast * end / 2.0, fast * end / 2.0, 1.0, 0.15, 1e-4, depths=(0.7, 1.1)).drawn()
    space = Space(*distribute(mesh, MPI.COMM_SELF), TAGS, Physical(), degree, STACK.form)
    motion = Motion(space, response)
    solver = SlidingInTime(motion)
    run = solver.run([Way(1, end, steps)], lambda t: g, lambda t: float(smooth(t, 2.0)))
    by_sie = StartingPunch(response, STACK.limit(), end, steps, 16).course(g, lambda t: smooth(t, 2.0))
    steady = FlatPunch(response, g)  # its exponents alone
    found = contact_numbers(motion.X, run.forces, steady.α, steady.β, degree)
    np.testing.assert_allclose(run.v0, by_sie.v0, atol=1e-4 * by_sie.v0[-1])
    lean = by_sie.centre * by_sie.load
    np.testing.assert_allclose(found.centre * found.load, lean, atol=2e-3 * np.abs(lean).max())
    for K, other in ((found.K_left, by_sie.K_left), (found.K_right, by_sie.K_right)):
        np.testing.assert_allclose(K, other, atol=1e-3 * np.abs(by_sie.K_left).max())
    np.testing.assert_allclose(run.energy + run.absorbed, run.work, atol=1e-5 * run.work.max())
    solver.destroy()


def test_waves_pass_where_the_mesh_has_an_interface_of_equal_solids():
    """Finite elements of a stack of one solid are those of the solid, on one mesh."""
    c, end, steps, degree = 0.5, 2.0, 10, 5
    mesh = Reached(4.0, 3.0, 1.0, 0.3, 1e-2, depths=(0.5, 1.2)).drawn()
    assert {-0.5, -1.2} <= set(np.round(mesh.points[:, 1], 12).tolist())
    runs = []
    for solid, response in (
        (ONE, ONE.response(c)),
        (stack := Layered((Layer(0.5, ONE), Layer(0.7, ONE)), ONE), stack.response(c)),
    ):
        space = Space(*distribute(mesh, MPI.COMM_SELF), TAGS, Physical(), degree, solid.form)
        solver = SlidingInTime(Motion(space, response))
        runs.append(
            solver.run([Way(1, end, steps)], lambda t: -0.4, lambda t: float(smooth(t, 2.0))).forces
        )
        solver.destroy()
    np.testing.assert_allclose(runs[1], runs[0], atol=1e-10 * np.abs(runs[0]).max())


def test_a_graded_layer_is_refused():
    graded = Layered((Layer(1.0, ONE, bottom=COAT),), COAT)
    with pytest.raises(ValueError, match="graded"):
        UniformLayers.of(graded.response(0.3))
