"""Starts from rest of any solid by both methods."""

import os

import pytest
from mpi4py import MPI

from galinx.meshes.charts import Physical
from galinx.meshes.rings import TAGS
from galinx.meshes.waves import Reached
from galinx.postprocess.over_time import contact_numbers
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.in_time import SlidingInTime
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.admittance import Admittance
from galinx.solvers.transient.history import Way, smooth
from galinx.solvers.transient.punch import StartingPunch

#: Of what takes longer than the ordinary tests may.
THOROUGH = pytest.mark.skipif("GALINX_THOROUGH" not in os.environ, reason="takes long: GALINX_THOROUGH=1")


def by_integral_equation(solid, c, g, end, steps, ramp=3.0, terms=16):
    punch = StartingPunch(solid.response(c), solid.limit(), end, steps, terms)
    return punch.course(g, lambda t: smooth(t, ramp))


class ByFiniteElements:
    """Of one speed."""

    def __init__(self, solid, c, end, steps, degree=7, innermost=1e-5):
        self.response, self.end, self.steps, self.degree = solid.response(c), end, steps, degree
        fast, T = Admittance.of(self.response).fastest, end * (1.0 + 16.0 / steps)
        width, depth = 1.0 + T * (fast**2 - c**2) / (2.0 * fast), fast * T / 2.0
        mesh = Reached(width, depth, 2.0, 0.15, innermost).drawn()
        space = Space(*distribute(mesh, MPI.COMM_SELF), TAGS, Physical(), degree, solid.form)
        self.motion = Motion(space, self.response)
        self.solver = SlidingInTime(self.motion)

    def run(self, g, load):
        way = Way(1, self.end, self.steps)
        law = g if callable(g) else lambda t: g
        return self.solver.run([way], law, lambda t: float(load(t)))

    def told(self, run, α, β):
        return contact_numbers(self.motion.X, run.forces, α, β, self.degree)
