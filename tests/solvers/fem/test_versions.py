"""The same numbers on one stored mesh whatever version of dolfinx and PETSc is installed."""

import numpy as np
import pytest
from mpi4py import MPI
from support import HOME

from galinx.meshes import MESHES
from galinx.meshes.rings import TAGS, QuadMesh
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.recovery import chebyshev, from_moments
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.isotropic import MovingFrame

STORED = HOME / "tests" / "reference" / "stored_mesh.npz"

#: K_I left and right by speed, at g = -0.66, degree 7: computed with dolfinx 0.5.2, PETSc 3.18.
K_I = {
    0.0: (0.310875642856849, 0.31087564941324647),
    0.6: (0.3071673365145585, 0.30716732795350055),
    0.9: (0.29300068970450716, 0.2930010414270236),
}


@pytest.mark.parametrize("c", K_I)
def test_the_stored_mesh_has_the_same_intensities(c):
    with np.load(STORED) as file:
        edges = {tag: file[str(tag)] for tag in TAGS.values()}
        mesh = QuadMesh(file["points"], file["cells"], edges)
    chart = MESHES["confocal"].chart
    space = Space(*distribute(mesh, MPI.COMM_SELF), chart, 7)
    punch = SlidingPunch(space, MovingFrame(2.0, c))
    moments = chebyshev(chart.surface_position(space.contact.s))
    local = FlatPunch(MovingFrame(2.0, c), np.array([-0.66]))
    found = from_moments(punch.states(-0.66).normal @ moments, local.α, local.β).K_I[0]
    punch.destroy()
    np.testing.assert_allclose(found, K_I[c], rtol=1e-9)
