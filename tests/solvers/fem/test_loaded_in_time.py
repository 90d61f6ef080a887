"""Given tractions in time against the exact surface motion of Lamb's problem."""

import numpy as np
import pytest
from lamb_reference import Lamb
from loaded_in_time import Even, LoadedInTime
from mpi4py import MPI
from scipy.integrate import quad
from support import THOROUGH

from galinx.meshes.charts import Physical
from galinx.meshes.rings import TAGS
from galinx.meshes.waves import Reached
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import Isotropic, rayleigh_speed
from galinx.solvers.transient.history import smooth

SOLID, FAST = Isotropic(1.0, 0.25, 1.0), 3.0**0.5


def uniform(left, right):
    return -np.ones_like(left)


def at_once(t):
    return 1.0


def found_and_expected(mesh, c, end, steps, degree, ramp):
    """u, v on the surface within 2 a by both, (2, times, nodes, 2), over the largest of all."""
    space = Space(*distribute(mesh, MPI.COMM_SELF), TAGS, Physical(), degree)
    solver = LoadedInTime(Motion(space, SOLID.response(c)), end / steps)
    run = solver.run(steps, uniform, (lambda t: float(smooth(t, ramp))) if ramp else at_once)
    history = ((lambda t: smooth(t, ramp)), (0.0, ramp)) if ramp else None
    near = np.flatnonzero(np.abs(run.X) < 2.0)[::7]
    exact, last = Lamb(FAST), range(steps // 4 - 1, steps, steps // 4)
    expected = np.array([exact.strip(run.X[near], run.t[n], c, history)[::-1].T for n in last])
    found = run.u[list(last)][:, near]
    return np.array([found, expected]) / np.abs(expected).max()


def reached(c, end, size, innermost):
    """As far as no wave is back within 2 a."""
    return Reached(
        (FAST + c) * end / 2.0 + 2.0, max(FAST * end / 2.0 + 0.5, 2.0), size, 0.0, innermost
    ).drawn()


def test_reference_is_itself_right():
    """Rayleigh's speed, plane waves straight down, integrals by another rule, and what stays at rest."""
    exact = Lamb(FAST)
    assert abs(exact.c_R - rayleigh_speed(2.0)) < 1e-14
    v, u = exact.strip([0.0, 6.0], 0.3)
    assert abs(v[0] + 0.3 / FAST) < 1e-10 and abs(u[0]) < 1e-12 and abs(v[1]) + abs(u[1]) < 1e-12
    by_quad = quad(lambda C: exact.F(C)[0], 0.0, 0.8)[0]
    by_quad += quad(
        lambda C: exact.F(C)[0] * (C - exact.c_R), 0.8, 0.98, weight="cauchy", wvar=exact.c_R
    )[0]
    by_quad += quad(lambda C: exact.F(C)[0], 0.98, 1.5, points=[1.0])[0]
    assert abs(exact.Φ(np.array([1.5]))[0, 0] - by_quad) < 1e-7


@pytest.mark.parametrize("c", [0.5, *(0.0,) * THOROUGH])
def test_strip_that_is_loaded_by_and_by(c):
    found, expected = found_and_expected(reached(c, 2.0, 1.0, 1e-3), c, 2.0, 20, 7, 1.0)
    assert np.abs(found - expected).max() < 1e-3


def test_suddenly_loaded_strip():
    """Waves have corners, so that sizes and steps are small; in the mean over the surface and times."""
    found, expected = found_and_expected(Even(2.5, 1.3, 0.25).drawn(), 0.0, 1.0, 80, 6, 0.0)
    assert np.sqrt(((found - expected) ** 2).mean()) < 1e-3


@pytest.mark.skipif(not THOROUGH, reason="takes minutes: GALINX_THOROUGH=1")
@pytest.mark.parametrize("c", [0.0, 0.5])
def test_suddenly_loaded_strip_everywhere(c):
    mesh = Even((FAST + c) / 2.0 + 1.8, 1.3, 0.1).drawn()
    found, expected = found_and_expected(mesh, c, 1.0, 250, 8, 0.0)
    assert np.abs(found - expected).max() < 1e-3
