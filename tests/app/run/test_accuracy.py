"""Scenes against their closed form, from rest to near the Rayleigh speed, on the surface and inside."""

import numpy as np
import pytest
from support import THOROUGH, computed

from galinx.postprocess import compare
from galinx.solvers.solids import Isotropic

#: One state of scenes/tables4_5.toml at each speed, or at one.
SINGLE = {"motion.strokes": ["forward"], "motion.X_over_L": 0.8}
ONE_SPEED = SINGLE | {"motion.c": 0.6}


def disagreement(result):
    """Value of every comparison by name."""
    return compare.comparisons(result.data, result.scene.punch.load, compare.RULES)


def test_accuracy_at_the_default_tolerance(tables_run):
    found = disagreement(tables_run)
    assert found["K_I"] <= 1e-6
    assert found["sigma_YY"] <= 1e-5 and found["sigma_XX"] <= 1e-4
    assert found["exponents"] <= 2e-4
    assert tables_run.verdict == "PASS"


def test_forces_balance(tables_run):
    data = tables_run.data
    np.testing.assert_allclose(data["states/fem/normal_force"], -55.3e3, rtol=1e-9)
    np.testing.assert_allclose(data["states/fem/tangential_force"], -55.3e3 * data["states/g"], rtol=1e-9)


@pytest.mark.parametrize(
    "tolerance, c", [(1e-9, 0.0), *[(1e-9, 0.9), (1e-3, 0.0)] * THOROUGH, (1e-3, 0.9)]
)
def test_the_tolerance_is_reached_and_the_estimate_honest(c, tolerance):
    changes = {"motion.c": c, "solve.tolerance": tolerance, "friction.mu_c": 1.0}
    data = computed("tables4_5", changes | {"output.quantities": ["sif"]}).data
    true, estimate = data["states/fem/true_error"].max(), data["states/fem/estimate"].max()
    assert true <= tolerance and estimate <= tolerance
    assert true <= estimate


@pytest.mark.parametrize("nu", [-0.9, *[0.4999] * THOROUGH, 0.5])
def test_no_solid_locks(nu):
    result = computed("tables4_5", SINGLE | {"solid.nu": nu})
    found = disagreement(result)
    assert result.verdict == "PASS"
    assert found["K_I"] <= 1e-6 and found["sigma_XX"] <= 1e-5


def test_the_two_signs_of_friction_are_mirror_images(tables_run):
    physical = tables_run.data
    printed = computed("tables4_5", {"friction.sign": "eq25"}).data
    np.testing.assert_array_equal(printed["states/g"], -physical["states/g"])
    np.testing.assert_allclose(
        printed["states/fem/K_I_left"], physical["states/fem/K_I_right"], rtol=1e-9
    )
    np.testing.assert_allclose(
        printed["surface/fem/sigma_XX"], physical["surface/fem/sigma_XX"][:, ::-1], rtol=1e-5, atol=1e-7
    )


def test_pressure_and_tension_lead_at_the_trailing_end(tables_run):
    """Physical sign, forward: both the stronger singularity and the tension are at X = -a."""
    data = tables_run.data
    X = data["surface/X_over_a"]
    behind, ahead = np.argmin(np.abs(X + 1.05)), np.argmin(np.abs(X - 1.05))
    for i in np.flatnonzero(data["states/f"] > 0.0):
        assert data["states/fem/beta"][i] < data["states/fem/alpha"][i]
        assert data["surface/fem/sigma_XX"][i, behind] > 0.0 > data["surface/fem/sigma_XX"][i, ahead]


def test_a_pressure_that_pulls_fails():
    result = computed("traction", ONE_SPEED | {"solve.pressure": [[-1, -2], [0, 1], [1, -2]]})
    assert result.verdict == "FAIL"
    told = "tension under the punch, over N/(2a): 1.0e+00, at most 0"
    assert told in result.attributes["verdict_reasons"]


_IN_PLANE = ("X_over_a", "fem/sigma_XX", "closed_form/sigma_XX")


@pytest.mark.parametrize("ν", [-0.9, 0.45, 0.48, 0.5] if THOROUGH else [-0.9, 0.48])
def test_next_to_the_rayleigh_speed_the_measured_error_decides(ν):
    """At 0.9995 c_R residuals are up to 1e-7 of the forces, which says nothing of K_I."""
    c = 0.9995 * Isotropic(1.0, ν, 1.0).limit()
    changes = {"solid.nu": ν, "motion.c": c, "friction.mu_c": 0.5, "motion.strokes": ["forward"]}
    result = computed("tables4_5", changes | {"output.quantities": ["sif"]})
    true, estimate = (result.data[f"states/fem/{name}"] for name in ("true_error", "estimate"))
    assert result.verdict == "PASS" and (true <= estimate).all()
    data = computed("tables4_5", changes).data
    X, found, exact = (data[f"surface/{name}"] for name in _IN_PLANE)
    off = np.abs(1.0 - np.abs(X)) >= 1e-2
    assert np.abs(found - exact)[:, off].max() <= 1e-6 * np.abs(exact)[:, off].max()


@pytest.mark.parametrize(
    ("ν", "c", "g", "tolerance"),
    [
        (-0.5, 0.6, 1.1, 3e-3),
        *([(0.234, 0.0, 0.65, 8e-3), (0.4, 0.0, 1.0, 5e-3), (-0.8, 0.0, 1.2, 5e-3)] if THOROUGH else []),
    ],
)
def test_what_few_moments_leave_at_the_far_boundary_is_in_the_estimate(ν, c, g, tolerance):
    """Cells better than the tolerance leave the boundary's part, which no level sees."""
    result = computed("tables4_5", SINGLE | {
        "solid": {"E": 1e9, "nu": ν, "rho": 1e3, "plane": "stress"}, "friction": {"mu": g},
        "motion.c": c, "solve.tolerance": tolerance, "solve.degree": 8, "solve.cuts": 2,
        "output.quantities": ["sif"],
    })  # fmt: skip
    (true,), (estimate,) = (result.data[f"states/fem/{name}"] for name in ("true_error", "estimate"))
    assert 1e-7 < true <= estimate / 1.5


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
        *([(1e-7, 2e-6, [0.6]), (1e-9, 2e-6, [4.786e-7, 0.9])] if THOROUGH else []),
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
