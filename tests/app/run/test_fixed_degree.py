"""Meshes cut finely at a fixed degree."""

import numpy as np
import pytest
from support import THOROUGH, computed

from galinx.solvers.fem.linear import LIMIT, available


def cut(degree, cuts, c, solver="auto"):
    """Datasets of a scene with one speed, at a fixed degree."""
    changes = {"solve.degree": degree, "solve.cuts": cuts, "solve.solver": solver}
    return computed("tables4_5", changes | {"motion.c": c, "motion.X_over_L": 0.8}).data


def test_the_error_falls_at_twice_the_rate_of_the_energy_norm():
    """K_I is a moment of the contact forces: h^(2p) at degree p = 2."""
    each = [cut(2, cuts, 0.6) for cuts in (1, 2, 5, 10)]
    coarse, fine = (data["states/fem/true_error"] for data in each[2:])
    assert np.all(coarse / fine > 0.8 * 2**4)
    cells = np.ravel([data["run/fem/cells"] for data in each])
    np.testing.assert_array_equal(cells / cells[0], [1.0, 4.0, 25.0, 100.0])


@pytest.mark.parametrize(
    "degree, cuts", [(3, 1), (2, 9), *([(4, 4), (3, 4), (2, 16)] if THOROUGH else [])]
)
def test_the_estimate_covers_the_true_error(degree, cuts):
    data = cut(degree, cuts, 0.9)
    ratio = data["states/fem/estimate"] / data["states/fem/true_error"]
    assert np.all((ratio >= 1.0) & (ratio <= 100.0))
    assert list(data["run/fem/factorisations"]) == [2]
    assert "run/fem/change_by_degree" not in data


@pytest.mark.parametrize(
    "mesh, degree, cuts, c",
    [
        ("confocal", 10, 1, 0.6), ("confocal", 12, 1, 0.6), ("confocal", 12, 1, 0.9),
        ("confocal", 8, 2, 0.6), ("graded", 11, 1, 0.91),
    ],
)  # fmt: skip
def test_what_innermost_cells_leave_is_in_the_estimate(mesh, degree, cuts, c):
    """It falls with the degree's fourth power only, so that the next degree shows little of it."""
    changes = {"solve.mesh": mesh, "solve.degree": degree, "solve.cuts": cuts, "solve.tolerance": 1e-4}
    # Nothing else is left without friction; with much of it innermost cells would be smaller.
    changes |= {"motion.c": c, "friction.mu_c": 1e-4, "output.quantities": ["sif"]}
    data = computed("tables4_5", changes).data
    true, estimate = (data[f"states/fem/{name}"] for name in ("true_error", "estimate"))
    assert np.all(true > 1e-11) and np.all(true <= estimate)


def test_splines_of_friction_along_the_contact_do_with_every_degree():
    """At the degree 1 there were none, and a traceback."""
    changes = {"friction": {"along": [[-1.0, 0.5], [1.0, 0.2]]}, "output.quantities": ["sif"]}
    changes |= {"motion": {"c": 0.4}, "solve.methods": ["fem"], "solve.degree": 1}
    data = computed("tables4_5", changes).data
    assert 1e-3 < data["states/fem/estimate"].max() < np.inf


#: Cells are halved so often where multigrids are tried; steps hardly depend on it.
HALVED = 4 if THOROUGH else 1


@pytest.fixture(scope="module")
def direct():
    return cut(2, HALVED, 0.6, "direct")


@pytest.mark.parametrize("solver", available())
def test_multigrid_gives_what_a_factor_gives(direct, solver):
    iterative = cut(2, HALVED, 0.6, solver)
    for side in ("left", "right"):
        name = f"states/fem/K_I_{side}"
        np.testing.assert_allclose(iterative[name], direct[name], rtol=1e-9)
    assert not direct["run/fem/iterations"].any()
    assert np.all(np.isin(iterative["run/fem/iterations"], np.arange(1, LIMIT)))
