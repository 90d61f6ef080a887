"""Any uniform solid in scenes: the block says what it costs, and solids ask for what σ_ZZ needs."""

import json

import numpy as np
from support import computed, section_of

from galinx.solvers.solids.plane import Orthotropic

CLOSED = {"methods": ["closed_form"]}
#: Stiffness [Pa] of fibres askew to the surface.
SKEW = [40e9, 12e9, 15e9, 16e9, 6e9, 13e9]

FRICTION = {"mu_c": 0.6, "sigma0_over_load": 6e4}


def result_of(solid, share, tolerance, quantities=("sif",), **more):
    """The result of a scene of an orthotropic or anisotropic solid at a share of its limit."""
    return computed(changes={
        "solid": section_of(solid), "friction": FRICTION, "punch": None,
        "motion": {"c": float(share * solid.limit()), "X_over_L": [0.1, 0.7]},
        "solve": {"tolerance": tolerance}, "output": {"quantities": list(quantities)},
    } | more)  # fmt: skip


def test_the_block_is_smaller_for_a_solid_stiff_across_its_depth_and_says_so():
    upright = Orthotropic(14e9, 1e9, 1e9, 0.3, 0.3, 0.4, 0.5e9, 1500.0, 90.0)
    data = result_of(upright, 0.3, 1e-2, **{"solve.mesh": "box"}).data
    error, estimate = data["states/fem/true_error"], data["states/fem/estimate"]
    assert error.max() > 0.01 and np.all(error <= estimate) and np.all(estimate <= 10.0 * error)


def test_von_mises_asks_for_what_σ_ZZ_needs():
    """Of fibres askew to the surface it is known, or is not; constants that are lists are archived."""
    scene = {
        "solid": {"kind": "anisotropic", "rho": 1600, "stiffness": SKEW}, "solve": CLOSED,
        "output": {"quantities": ["interior"], "points": [[0, -0.5]]},
        "friction": FRICTION, "motion": {"c": 0.3}, "punch": None,
    }  # fmt: skip
    for more, known in (({}, False), ({"solid.stiffness_Z": [1e9, 2e9, 0.0]}, True)):
        result = computed(changes=scene | more)
        assert ("interior/closed_form/von_mises" in result.data) == known
        assert "interior/closed_form/sigma_1" in result.data
        assert json.loads(result.attributes["solid"])["stiffness"] == SKEW
