"""Displacement gradients at points inside."""

import numpy as np
import pytest
from support import space_on

from galinx.meshes.rings import Refinement
from galinx.solvers.errors import MeshError
from galinx.solvers.fem.interior import InteriorGradients
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.solids.isotropic import MovingFrame


def test_a_point_outside_the_mesh_is_named():
    space = space_on("graded", Refinement(4, 0.5, 2, (1.0,) * 3), 2)
    punch = SlidingPunch(space, MovingFrame(2.0, 0.0))
    with pytest.raises(MeshError, match="X/a = 0, Y/a = -1e\\+06 lies outside"):
        InteriorGradients(
            space, MovingFrame(2.0, 0.0), punch.fields, np.array([[0.0, -1.0], [0.0, -1e6]])
        )
    punch.destroy()
