"""Starts from rest by both methods against what is known, and against each other."""

import numpy as np
import pytest
from mpi4py import MPI

from galinx.meshes.charts import Physical
from galinx.meshes.rings import TAGS
from galinx.meshes.waves import Reached
from galinx.postprocess.over_time import contact_numbers
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.fem.dynamic import Damping, Motion, of_both
from galinx.solvers.fem.in_time import SlidingInTime
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import Way, smooth
from galinx.solvers.transient.punch import StartingPunch


def solid(ν=0.25):
    return Isotropic(1.0, ν, 1.0)


def integral_equation(ν, c, g, end, steps, ramp=3.0, terms=16):
    response = solid(ν).response(c)
    punch = StartingPunch(response, solid(ν).limit(), end, steps, terms)
    return punch.course(g, lambda t: smooth(t, ramp))


class Started:
    """Finite elements of one speed."""

    def __init__(self, ν, c, end, steps, degree=7, innermost=1e-5):
        self.degree = degree
        self.response, self.end, self.steps = solid(ν).response(c), end, steps
        fast, T = self.response.k**-0.5, end * (1.0 + 16.0 / steps)
        mesh = Reached(
            1.0 + T * (fast**2 - c**2) / (2.0 * fast), fast * T / 2.0, 2.0, 0.15, innermost
        ).drawn()
        space = Space(*distribute(mesh, MPI.COMM_SELF), TAGS, Physical(), degree)
        self.motion = Motion(space, self.response)
        self.solver = SlidingInTime(self.motion)

    def run(self, g, ramp=3.0, steps=None, directions=(1,), load=None, steady=False):
        law = g if callable(g) else lambda t: g
        many = (steps or self.steps) // len(directions)
        phases = [Way(way, self.end / len(directions), many) for way in directions]
        return self.solver.run(phases, law, load or (lambda t: float(smooth(t, ramp))), steady)

    def told(self, run, g):
        exact = FlatPunch(self.response, g)
        return contact_numbers(self.motion.X, run.forces, exact.α, exact.β, self.degree)


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
    assert np.abs(found.centre).max() < 1e-12
    np.testing.assert_allclose(found.K_left, found.K_right, rtol=0.0, atol=1e-11)
    run = Started(0.3, 0.0, 2.0, 10, degree=4, innermost=1e-2)
    forces = run.run(0.0).forces
    assert np.abs(forces - forces[:, ::-1]).max() < 1e-12 * np.abs(forces).max()


def test_integral_equation_knows_the_mirror_image():
    """What moves the other way with friction reversed is the same from the other side."""
    forward = integral_equation(0.25, 0.5, -0.6, 4.0, 20)
    punch = StartingPunch(solid().response(0.5), solid().limit(), 4.0, 20, 16, way=-1)
    backward = punch.course(0.6, lambda t: smooth(t, 3.0))
    np.testing.assert_allclose(backward.v0, forward.v0, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose((backward.centre + forward.centre) * forward.load, 0.0, atol=1e-12)
    np.testing.assert_allclose(backward.K_left, forward.K_right, rtol=0.0, atol=1e-12)


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
    assert off(run.energy + run.absorbed, run.work) < 1e-5


def test_scheme_converges():
    """The same mesh, steps of a half and a quarter: of order four where the load is smooth enough.

    The ramp's third derivative jumps, so that somewhat less is seen of two halvings.
    """
    started, v0 = Started(0.25, 0.6, 2.0, 20, degree=6, innermost=1e-2), {}
    for steps in (5, 20, 80):
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


@pytest.fixture(scope="module")
def small():
    """Few cells, up to t = 2."""
    return Started(0.25, 0.5, 2.0, 10, degree=5, innermost=1e-2)


def test_steady_motion_goes_on(small):
    """Where nothing changes; and friction that does makes it change."""
    run = small.run(-0.4, load=lambda t: 1.0, steady=True)
    size = np.abs(run.forces).max()
    np.testing.assert_allclose(run.forces, np.tile(run.forces[0], (10, 1)), atol=1e-9 * size)
    assert np.abs(run.v0).max() < 1e-9
    assert np.abs([run.work, run.energy, run.absorbed]).max() < 1e-9
    other = small.run(lambda t: -0.4 * (1.0 - t / 2.0), load=lambda t: 1.0, steady=True)
    assert np.abs(other.forces[-1] - run.forces[-1]).max() > 1e-2 * size


def test_the_way_back_is_the_mirror_image(small):
    there, back = small.run(-0.4), small.run(0.4, directions=(-1,))
    size = np.abs(there.forces).max()
    np.testing.assert_allclose(back.forces[:, ::-1], there.forces, rtol=0.0, atol=1e-12 * size)
    np.testing.assert_allclose(back.v0, there.v0, atol=1e-12)
    assert np.abs(there.forces - there.forces[:, ::-1]).max() > 1e-2 * size


def test_the_solid_goes_on_where_the_punch_turns_round():
    """Its velocity, u̇ - c u,X, stays, so its kinetic energy does, as far as cells tell u,X at edges."""
    started = Started(0.25, 0.5, 2.0, 10, degree=7, innermost=1e-4)
    solver, motion = started.solver, started.motion
    rest = StillAt(started, 0.0)
    state = solver._steady(-0.3, 1.0)
    kinetic = [rest.kinetic(state, 0.5)]
    solver._turn(state, -2, -0.3, 1.0)
    kinetic.append(rest.kinetic(state, -0.5))
    assert kinetic[1] == pytest.approx(kinetic[0], rel=2e-3)
    assert rest.kinetic(state, 0.5) > 2.0 * kinetic[0]
    jump = state.w.copy()
    solver._turn(state, 2, -0.3, 1.0)
    assert np.abs(state.w).max() < 1e-9 * np.abs(jump).max()
    # Under the punch it moves as one, and far away it is held.
    assert np.ptp(jump[2 * motion.contact + 1]) < 1e-12
    assert not jump[2 * motion.far].any()


class StillAt:
    """Kinetic energy in the frame of the solid, from the forms of two speeds."""

    def __init__(self, started, c):
        self.motion = started.motion
        space, response = started.motion.space, started.response
        still = Motion(space, solid().response(c))
        # K holds -c² ∫ u,X·w,X.
        self.slopes = (still.K - self.motion.K) / response.c**2

    def kinetic(self, state, c):
        w, u, motion = state.w, state.u, self.motion
        carried = w @ of_both(motion.M, w) - 2.0 * c * w @ of_both(motion.B, u)
        return (carried + c**2 * u @ (self.slopes @ u)) / 2.0


def test_friction_that_changes_turns_and_loses_no_energy(small):
    """Work is energy and what is absorbed, but for the jump where the punch turns round."""
    run = small.run(lambda t: -0.4 * np.sin(3.0 * t), directions=(1, -1), steps=40)
    gained = np.diff(run.energy + run.absorbed - run.work)
    apart = np.delete(gained, 19)
    assert np.abs(apart).max() < 1e-4 * np.abs(run.work).max()


def test_what_cells_hold_is_not_damped(small):
    """Polynomials of a low degree are left alone in every cell, and higher ones lose energy far away."""
    space = small.motion.space
    D = Damping(space).matrices
    assert np.linalg.eigvalsh(D).min() > -1e-9 * D.max()
    assert (np.abs(D).max(axis=(1, 2)) > 0.0).any() and (np.abs(D).max(axis=(1, 2)) == 0.0).any()
    X, Y = space.coordinates.T[:2]
    low, high = X**2 - X * Y, np.cos(4.0 * X) * np.sin(3.0 * Y)
    D = small.motion.D
    assert abs(low @ D @ low) < 1e-9 * (low @ small.motion.M @ low)
    assert high @ D @ high > 1e-3 * (high @ small.motion.M @ high)
