"""A far boundary that follows the forces at the contact."""

import numpy as np
import pytest
from mpi4py import MPI
from support import space_on

from galinx.meshes import MESHES
from galinx.meshes.rings import Refinement
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.recovery import chebyshev, from_moments
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.fem.traction import LoadedHalfPlane
from galinx.solvers.solids.isotropic import MovingFrame

C, G = 0.6, 0.66
KIND = MESHES["confocal"]


def error(R, terms):
    """Relative error of K_I with a far boundary at R that follows some moments."""
    count = 3
    widths = ((np.arccosh(R) - np.pi / 2.0) / count,) * count
    mesh = distribute(KIND.build(Refinement(9, 0.35, 2, widths)), MPI.COMM_SELF)
    space, response = Space(*mesh, KIND.chart, 8, terms=terms), MovingFrame(2.0, C)
    punch = SlidingPunch(space, response)
    moments = chebyshev(space.chart.surface_position(space.contact.s))
    local = FlatPunch(response, np.array([G]))
    pressure = from_moments(punch.states(G).tested(moments), local.α, local.β)
    punch.destroy()
    return np.abs(pressure.K_I / local.K_I[:, None] - 1.0).max()


@pytest.mark.parametrize(
    "terms, R", [(0, (30.0, 90.0)), (1, (30.0, 90.0)), (2, (10.0, 30.0)), (3, (8.0, 24.0))]
)
def test_the_error_falls_with_one_power_more_than_moments_are_followed(terms, R):
    near, far = (error(one, terms) for one in R)
    rate = np.log(near / far) / np.log(R[1] / R[0])
    assert rate == pytest.approx(terms + 1, abs=0.35)


def test_loads_that_are_put_in_have_it_too():
    """A pressure's slope along the surface right of it does not know where the mesh ends."""
    response, seen = MovingFrame(2.0, C), []
    for widths in ((2.0,), (1.0, 2.0, 2.0)):
        space = space_on("confocal", Refinement(8, 0.35, 2, widths), 8)
        loaded = LoadedHalfPlane(space, response)
        loaded.load(lambda left, right: -right)  # it leans
        X = space.chart.surface_position(space.contact.s)
        there = space.contact.dofs(1)
        seen.append(np.array([field.getValues(there) for field in loaded.fields]))
        assert loaded.resultants[0] == pytest.approx(-2.0, rel=1e-12)
        loaded.destroy()
    assert len(X) == seen[0].shape[1]
    np.testing.assert_allclose(seen[0], seen[1], rtol=0.0, atol=1e-8 * np.abs(seen[1]).max())
