"""Condensed matrices of cells."""

import numpy as np
import pytest
from support import computed, space_on

from galinx.meshes.rings import Refinement
from galinx.solvers.contact import stresses
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame


@pytest.mark.parametrize("form, ν", [("isotropic", 0.25), ("nearly incompressible", 0.499)])
@pytest.mark.parametrize("mesh", ["confocal", "graded"])
def test_a_translation_needs_no_force(mesh, form, ν):
    """Not even the last digits of one: near the Rayleigh speed the body moves far before it deforms."""
    space = space_on(mesh, Refinement(4, 0.3, 2, (1.0, 1.0)), 8, form=form)
    response = MovingFrame(2.0, 0.9) if ν == 0.25 else Isotropic(1.0, ν, 1.0).response(0.9)
    S = space.condensed(response, np.arange(space.cells))
    nodes = len(space.kernel.outer)
    for i in range(2):
        motion = np.zeros(S.shape[1])
        motion[i : 2 * nodes : 2] = 1.0
        force = S @ motion
        # Little more than what summing a row's numbers leaves; without care it is 3 to 50 times as much.
        assert np.abs(force).max() <= 2.0 * np.finfo(float).eps * np.abs(S).sum(axis=2).max()


def test_stresses_next_to_the_rayleigh_speed_keep_their_digits():
    """At 0.99989 c_R; where translations are left with forces of rounding, 1e-4 of σ_XX is lost."""
    data = computed("tables4_5", {"motion.c": 0.9193, "motion.X_over_L": [0.4, 0.8]}).data
    found, exact = (data[f"surface/{method}/sigma_XX"] for method in ("fem", "closed_form"))
    off = np.abs(found - exact) / stresses.of_in_plane(exact, data["surface/X_over_a"])
    assert off.max() <= 2e-5
