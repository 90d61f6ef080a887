"""Motions of a punch in time by both methods, of any solid."""

from functools import cache
from types import SimpleNamespace

import numpy as np
from mpi4py import MPI

from galinx.meshes.charts import Physical
from galinx.meshes.waves import Reached
from galinx.postprocess.over_time import contact_numbers
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.in_time import SlidingInTime
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.admittance import Admittance
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.transient.history import Way, smooth
from galinx.solvers.transient.punch import StartingPunch

SOLID = Isotropic(1.0, 0.25, 1.0)


@cache
def by_integral_equation(solid, c, g, end, steps, ramp=3.0, terms=16, **options):
    """Course of a start from rest at the speed c under friction g, a number or a function of time."""
    punch = StartingPunch(solid.response(c), solid.limit(), end, steps, terms, **options)
    return punch.course(g, lambda t: smooth(t, ramp))


def motion(solid, c, mesh, degree=4, sharp=False):
    """Equations of motion of a solid on a mesh."""
    space = Space(*distribute(mesh.drawn(), MPI.COMM_SELF), Physical(), degree, solid.form)
    return Motion(space, solid.response(c), sharp)


class ByFiniteElements:
    """Starts from rest at one speed, on a mesh as large as waves come back from within ``end``."""

    def __init__(self, solid, c, end, steps, degree=7, innermost=1e-5, mesh=None):
        self.response, self.end, self.steps, self.degree = solid.response(c), end, steps, degree
        if mesh is None:
            fast, T = Admittance.of(self.response).fastest, end * (1.0 + 16.0 / steps)
            width = 1.0 + T * (fast**2 - c**2) / (2.0 * fast)
            mesh = Reached(width, fast * T / 2.0, 2.0, 0.15, innermost)
        self.motion = motion(solid, c, mesh, degree)
        self.solver = SlidingInTime(self.motion)

    def run(self, g, load=lambda t: smooth(t, 3.0), steps=None, directions=(1,), steady=False):
        law, many = (g if callable(g) else lambda t: g), (steps or self.steps) // len(directions)
        ways = [Way(way, self.end / len(directions), many) for way in directions]
        return self.solver.run(ways, law, lambda t: float(load(t)), steady)

    def told(self, run, g):
        """Load, centre and K_I at all times, by the exponents of the friction at each."""
        by_time = []
        for n, t in enumerate(run.t):
            exact = FlatPunch(self.response, g(t) if callable(g) else g)
            at = self.motion.X, run.forces[n : n + 1], exact.α, exact.β, self.degree
            by_time.append(contact_numbers(*at))
        centre, K_left, K_right, _ = np.concatenate(by_time, axis=1)
        load = -run.forces.sum(axis=1) / 2.0
        return SimpleNamespace(load=load, centre=centre, K_left=K_left, K_right=K_right)
