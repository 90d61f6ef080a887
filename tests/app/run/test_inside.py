"""Stresses inside, against the potentials."""

import numpy as np
import pytest
from support import THOROUGH, computed


def random_points(count, seed):
    """Points within 5 a of the punch's middle, at least 0.01 a deep."""
    random = np.random.default_rng(seed)
    R, φ = 5.0 * np.sqrt(random.random(count)), -np.pi * random.random(count)
    return np.column_stack([R * np.cos(φ), np.minimum(R * np.sin(φ), -0.01)])


def with_points(points):
    """Changes to a scene that ask for stresses at points."""
    return {"output.quantities": ["sif", "interior"], "output.points": np.asarray(points).tolist()}


@pytest.mark.parametrize(
    "tolerance, limit, speeds",
    [
        (1e-6, 1e-4, [0.0, 4.786e-7, 0.6, 0.9] if THOROUGH else [4.786e-7, 0.9]),
        (1e-7, 2e-6, [0.6]),
        *([(1e-9, 2e-6, [4.786e-7, 0.9])] if THOROUGH else []),
    ],
)
def test_stresses_inside_are_those_of_the_potentials(tolerance, limit, speeds):
    changes = {"solve.tolerance": tolerance, "motion.c": speeds}
    data = computed("tables4_5", with_points(random_points(200, 7)) | changes).data
    for ij in ("XX", "YY", "XY"):
        fem, exact = (data[f"interior/{method}/sigma_{ij}"] for method in ("fem", "closed_form"))
        assert fem.shape == (6 * len(speeds), 200)
        error = np.abs(fem - exact).max(axis=1) / np.abs(exact).max(axis=1)
        assert error.max() <= limit


def test_incompressible_solids_have_stresses_inside_in_closed_form_only():
    points = with_points([[0.0, -1.0], [0.9, -0.1]])
    both = ["closed_form", "fem"]
    data, near = (
        computed("tables4_5", points | {"solid.nu": ν, "solve.methods": both, "motion.c": 0.0}).data
        for ν in (0.5, 0.4999999)
    )
    assert "states/fem/K_I_left" in data and not any(path.startswith("interior/fem") for path in data)
    for ij in ("XX", "YY", "XY"):
        name = f"interior/closed_form/sigma_{ij}"
        np.testing.assert_allclose(data[name], near[name], rtol=1e-5, atol=1e-7)
