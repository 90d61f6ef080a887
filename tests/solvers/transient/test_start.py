"""Starts from rest by both methods against what is known, and against each other."""

import os

import numpy as np
import pytest
from mpi4py import MPI

from galinx.meshes.charts import Physical
from galinx.meshes.reached import Reached
from galinx.meshes.rings import TAGS
from galinx.postprocess.over_time import told
from galinx.solvers.fem.distributed import distribute
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.start import StartFromRest
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.punch import StartingPunch, smooth


def solid(ν=0.25):
    return Isotropic(1.0, ν, 1.0)


def integral_equation(ν, c, g, end, steps, ramp=3.0, terms=16):
    response = solid(ν).response(c)
    punch = StartingPunch(response, solid(ν).limit(), end, steps, terms)
    return punch.course(g, lambda t: smooth(t, ramp))


class Started:
    """Finite elements of one speed."""

    def __init__(self, ν, c, end, steps, degree=7, innermost=1e-5):
        self.response, self.end, self.steps = solid(ν).response(c), end, steps
        fast, T = self.response.k**-0.5, end * (1.0 + 16.0 / steps)
        mesh = Reached(1.0 + T * (fast**2 - c**2) / (2.0 * fast), fast * T / 2.0, 2.0, innermost).drawn()
        space = Space(*distribute(mesh, MPI.COMM_SELF), TAGS, Physical(), degree)
        self.motion = Motion(space, self.response)
        self.solver = StartFromRest(self.motion, end / steps)

    def run(self, g, ramp=3.0, steps=None):
        law = g if callable(g) else lambda t: g
        return self.solver.run(steps or self.steps, law, lambda t: float(smooth(t, ramp)))

    def told(self, run, g):
        exact = FlatPunch(self.response, g)
        return told(self.motion.X, run.forces, exact.α, exact.β)


@pytest.fixture(scope="module")
def at_speed():
    """At c = 0.6 up to t = 4, 0.2 a step."""
    return Started(0.25, 0.6, 4.0, 20)


def off(found, expected, share=1.0):
    return np.abs((found - expected) * share).max() / np.abs(expected * share).max()


def test_early_pressure_is_that_of_a_plane_wave():
    """p = ρ c_d v̇₀ where no wave from the ends has come, so that v₀ = (c_s/c_d) ∫ load dt + O(t²)."""
    slow, ratios = solid().response(0.0).k, []
    for end in (0.02, 0.04):
        found = integral_equation(0.25, 0.0, 0.0, end, 10, ramp=end, terms=24)
        # Half of the end is ∫ load dt over the ramp.
        ratios.append(found.v0[-1] / (slow**0.5 * end / 2.0))
    assert abs(2.0 * ratios[0] - ratios[1] - 1.0) < 1e-3
    assert abs(ratios[1] - 1.0) < 0.02


def test_frictionless_start_at_rest_is_symmetric(at_speed):
    found = integral_equation(0.3, 0.0, 0.0, 4.0, 20)
    assert np.abs(found.centre).max() < 1e-8
    np.testing.assert_allclose(found.K_left, found.K_right, atol=1e-8)
    run = Started(0.3, 0.0, 2.0, 10, degree=4, innermost=1e-2)
    forces = run.run(0.0).forces
    np.testing.assert_allclose(forces, forces[:, ::-1], atol=1e-10 * np.abs(forces).max())


def test_integral_equation_knows_the_mirror_image():
    """What moves the other way with friction reversed is the same from the other side."""
    response = solid().response(0.5)

    class Backwards:
        c, n, q, n12 = -response.c, response.n, response.q, 0.0
        c11, c12, c16, c22, c26 = response.c11, response.c12, 0.0, response.c22, 0.0
        σ_XX = response.σ_XX

    forward = integral_equation(0.25, 0.5, -0.6, 4.0, 20)
    punch = StartingPunch(Backwards, solid().limit(), 4.0, 20, 16)
    backward = punch.course(0.6, lambda t: smooth(t, 3.0))
    np.testing.assert_allclose(backward.v0, forward.v0, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(backward.centre * forward.load, -forward.centre * forward.load, atol=1e-11)
    np.testing.assert_allclose(backward.K_left, forward.K_right, atol=1e-11)


def test_quadrature_has_its_order():
    """Steps of a half leave a 2⁵th at least, up to what K_I and rounding leave."""
    best = integral_equation(0.25, 0.6, -0.4, 4.0, 40)
    coarse, fine = (integral_equation(0.25, 0.6, -0.4, 4.0, n) for n in (5, 10))
    errors = [np.abs(one.v0 - best.v0[k - 1 :: k]).max() for one, k in ((coarse, 8), (fine, 4))]
    assert errors[0] / errors[1] > 2.0**3.5


def test_finite_elements_agree_with_the_integral_equation(at_speed):
    run = at_speed.run(-0.4)
    found, expected = at_speed.told(run, -0.4), integral_equation(0.25, 0.6, -0.4, 4.0, 20, terms=24)
    np.testing.assert_allclose(found.load, expected.load, atol=1e-10)
    assert off(run.v0, expected.v0) < 3e-5
    assert off(found.centre, expected.centre, expected.load) < 5e-4
    assert off(found.K_left, expected.K_left) < 1e-3
    assert off(found.K_right, expected.K_right) < 1e-3


def test_energy_is_the_work(at_speed):
    run = at_speed.run(lambda t: -0.4 * np.sin(t))  # friction that changes in time
    assert off(run.energy, run.work) < 1e-5


def test_scheme_converges():
    """The same mesh, steps of a half and a quarter: of order four where the load is smooth enough.

    The ramp's third derivative jumps, so that somewhat less is seen of two halvings.
    """
    started, v0 = Started(0.25, 0.6, 2.0, 20, degree=6, innermost=1e-2), {}
    for steps in (5, 20, 80):
        started.solver = StartFromRest(started.motion, 2.0 / steps)
        v0[steps] = started.run(-0.4, 2.0, steps).v0
    coarse, fine = (np.abs(v0[n] - v0[80][80 // n - 1 :: 80 // n]).max() for n in (5, 20))
    assert coarse / fine > 2.0**5


def test_start_becomes_steady():
    """K_I and centre come to the steady state's like 1/t."""
    ends = (30.0, 60.0)
    steady = FlatPunch(solid().response(0.3), -0.3)
    left = []
    for end in ends:
        found = integral_equation(0.25, 0.3, -0.3, end, round(end / 1.0))
        left.append(found.centre[-1] - (steady.β - steady.α))
    assert abs(2.0 * left[1] - left[0]) < 1e-3
    assert 0.3 < left[1] / left[0] < 0.7


@pytest.mark.skipif("GALINX_THOROUGH" not in os.environ, reason="takes minutes: GALINX_THOROUGH=1")
@pytest.mark.parametrize("seed", range(6))
def test_random_starts_agree(seed):
    random = np.random.default_rng(seed)
    ν, g, ramp = random.uniform(0.0, 0.4), random.uniform(-0.8, 0.8), random.uniform(2.0, 5.0)
    c = random.uniform(0.0, 0.9) * solid(ν).limit()
    started = Started(ν, c, 20.0, 180, degree=9, innermost=1e-6)
    run = started.run(g, ramp)
    found, expected = started.told(run, g), integral_equation(ν, c, g, 20.0, 180, ramp, terms=24)
    assert off(run.v0, expected.v0) < 1e-4
    assert np.abs((found.centre - expected.centre) * expected.load).max() < 1e-4
    for one, other in ((found.K_left, expected.K_left), (found.K_right, expected.K_right)):
        assert off(one, other) < 1e-4
