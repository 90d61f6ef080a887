"""Given tractions in time against the exact surface motion of Lamb's problem."""

from math import ceil

import numpy as np
import pytest
from lamb_reference import Lamb
from mpi4py import MPI
from scipy.integrate import quad
from scipy.sparse import identity, kron
from scipy.sparse.linalg import splu
from support import THOROUGH

from galinx.meshes.charts import Physical
from galinx.meshes.rings import tagged
from galinx.meshes.waves import Reached
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.in_time import after_step, γ
from galinx.solvers.fem.space import Space, consistent_forces, distribute
from galinx.solvers.solids.isotropic import Isotropic, rayleigh_speed
from galinx.solvers.transient.history import smooth

SOLID, FAST = Isotropic(1.0, 0.25, 1.0), 3.0**0.5


def even(half_width, depth, size):
    """A rectangle of cells of at most a size, none of which crosses X = -a or X = a."""

    def cut(first, last):
        return np.linspace(first, last, ceil((last - first) / size) + 1)

    beside = cut(1.0, half_width)
    X, Y = np.concatenate([-beside[:0:-1], cut(-1.0, 1.0), beside[1:]]), cut(-depth, 0.0)
    (X0, Y0), (X1, Y1) = np.meshgrid(X[:-1], Y[:-1]), np.meshgrid(X[1:], Y[1:])
    return tagged(np.array([[X0, Y0], [X1, Y0], [X1, Y1], [X0, Y1]]).reshape(4, 2, -1).transpose(2, 0, 1))


def motion_under(motion, h, steps, load):
    """X of the surface's nodes and their u, v after steps from rest, under shares of a pressure of 1.

    M ü - 2c B u̇ + K u = load f, by the matrices and stages of sliding punches.
    """
    space, held = motion.space, np.concatenate([2 * motion.far, 2 * motion.far + 1])
    free = np.setdiff1d(np.arange(motion.size), held)

    def factor(A):
        solve, x = splu(A.tocsr()[free][:, free].tocsc()).solve, np.zeros(motion.size)

        def solved(b):
            x[free] = solve(b[free])
            return x.copy()

        return solved

    (facets, s), f = space.surface_facets(("contact",)), np.zeros(motion.size)
    ends = space.contact.s[[0, -1]]
    forces = consistent_forces(s, space.chart, ends, lambda left, right: -np.ones_like(left), ())
    np.add.at(f, 2 * facets.ravel() + 1, forces.ravel())
    carried = motion.M - 2.0 * motion.response.c * γ * h * motion.B
    by_stage = factor(kron(carried, identity(2)) + (γ * h) ** 2 * motion.K)

    def stage(u, w, at):
        return by_stage(motion.momentum(w) + γ * h * (load(at) * f - motion.stiffness(u)))

    state = (
        np.zeros(motion.size),
        np.zeros(motion.size),
        factor(kron(motion.M, identity(2)))(f * load(0.0)),
    )
    nodes = np.unique(np.concatenate([space.nodes_on(part) for part in ("contact", "free surface")]))
    nodes, found = nodes[np.argsort(space.coordinates[nodes, 0])], []
    for n in range(steps):
        state = after_step(state, h, n * h, stage)
        found.append(state[0].reshape(-1, 2)[nodes])
    return space.coordinates[nodes, 0], np.array(found)


def found_and_expected(mesh, c, end, steps, degree, ramp):
    """u, v on the surface within 2 a by both, (2, times, nodes, 2), over the largest of all."""
    space = Space(*distribute(mesh, MPI.COMM_SELF), Physical(), degree)
    load = (lambda t: float(smooth(t, ramp))) if ramp else lambda t: 1.0
    X, found = motion_under(Motion(space, SOLID.response(c)), end / steps, steps, load)
    history = ((lambda t: smooth(t, ramp)), (0.0, ramp)) if ramp else None
    near = np.flatnonzero(np.abs(X) < 2.0)[::7]
    exact, last = Lamb(FAST), range(steps // 4 - 1, steps, steps // 4)
    expected = [exact.strip(X[near], (n + 1) * end / steps, c, history)[::-1].T for n in last]
    return np.array([found[list(last)][:, near], expected]) / np.abs(expected).max()


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
    found, expected = found_and_expected(even(2.5, 1.3, 0.25), 0.0, 1.0, 80, 6, 0.0)
    assert np.sqrt(((found - expected) ** 2).mean()) < 1e-3


@pytest.mark.skipif(not THOROUGH, reason="takes minutes: GALINX_THOROUGH=1")
@pytest.mark.parametrize("c", [0.0, 0.5])
def test_suddenly_loaded_strip_everywhere(c):
    mesh = even((FAST + c) / 2.0 + 1.8, 1.3, 0.1)
    found, expected = found_and_expected(mesh, c, 1.0, 250, 8, 0.0)
    assert np.abs(found - expected).max() < 1e-3
