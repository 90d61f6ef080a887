"""A pressure of the user's own, put in piece by piece, against its exact solution."""

import numpy as np
import pytest
from support import THOROUGH, computed, here

from galinx.solvers.contact.edges import from_edge
from galinx.solvers.fem.traction import LinearLoads
from galinx.solvers.solids import Isotropic

TRIANGLE = [[-1, 0], [0.3, -2], [1, 0]]
SPIKE = [[-1, -1], [0.301, -1], [0.302, -50], [0.303, -1], [1, -1]]
HUMP = [[-1, -1], [0, -1], [0.05, -4], [0.1, -1], [1, -1]]
#: The first is at a knot of the surface grid and of the hump; the last far away.
POINTS = [[0.0, -1e-9], [0.3, -0.2], [0.302, -1e-3], [-1.0, -1e-7], [18.8, -1.8]]
ONE = {
    "solve.mode": "traction", "motion.c": 0.0, "motion.strokes": ["forward"], "motion.X_over_L": 0.8,
    "friction.mu_c": 0.5, "friction.sigma0_over_load": 25000.0,
    "output.quantities": ["sif", "surface", "interior"], "output.points": POINTS,
}  # fmt: skip


def put_in(pressure, changes=None):
    return computed("traction", ONE | {"solve.pressure": pressure} | (changes or {}))


def errors(data):
    """Of forces; of σ_XX over its size or its largest away from the ends; inside, over the largest."""
    force = data["states/fem/normal_force"] / data["states/closed_form/normal_force"] - 1.0
    found, exact = (data[f"surface/{method}/sigma_XX"] for method in ("fem", "closed_form"))
    away = from_edge(data["surface/X_over_a"]) >= 1e-2
    size = np.maximum(np.abs(exact), np.abs(exact[:, away]).max(axis=1, keepdims=True))
    inside = [0.0]
    if "interior/fem/sigma_XX" in data:
        in_fem, in_exact = (
            np.array([data[f"interior/{method}/sigma_{ij}"] for ij in ("XX", "YY", "XY")])
            for method in ("fem", "closed_form")
        )
        inside = np.abs(in_fem - in_exact).max(axis=(0, 2)) / np.abs(in_exact).max(axis=(0, 2))
    return np.abs(force).max(), (np.abs(found - exact) / size).max(), np.max(inside)


def within_tolerance_and_estimate(result, tolerance):
    data = result.data
    force, in_plane, inside = errors(data)
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    assert force <= 1e-12
    assert in_plane <= data["states/fem/estimate_sigma_XX"].max() <= tolerance
    if "interior/fem/sigma_XX" in data:
        assert inside <= data["states/fem/estimate_inside"].max() <= tolerance


#: Pressures with their usual tolerances.
PRESSURES = {"triangle": (TRIANGLE, 1e-6), "spike": (SPIKE, 1e-9), "hump": (HUMP, 1e-3)}
KEPT = {f"{name}-{tolerance:g}": (pressure, tolerance)
        for name, (pressure, usual) in PRESSURES.items()
        for tolerance in ((1e-3, 1e-6, 1e-9) if THOROUGH else (usual,))}  # fmt: skip


@pytest.mark.parametrize("pressure, tolerance", KEPT.values(), ids=KEPT)
def test_every_tolerance_is_kept(pressure, tolerance):
    result = put_in(pressure, {"solve.tolerance": tolerance})
    within_tolerance_and_estimate(result, tolerance)
    X, σ = np.array(pressure).T
    exact = 55.3e3 * (np.diff(X) * (σ[1:] + σ[:-1])).sum() / 4.0
    np.testing.assert_allclose(result.data["states/fem/normal_force"], exact, rtol=1e-12)
    np.testing.assert_allclose(
        result.data["states/fem/tangential_force"], exact * result.data["states/g"], rtol=1e-12
    )


def random_scene(rng):
    knots = rng.uniform(-0.99, 0.99, rng.integers(0, 30))
    knots[::2] = np.round(knots[::2] / 0.04) * 0.04  # where the surface is looked at
    knots = np.concatenate([knots, knots[:1] + 10.0 ** rng.uniform(-6.0, -1.0, min(len(knots), 1))])
    knots = np.unique(np.clip(knots, -0.99, 0.99))
    knots = np.concatenate([[-1.0], knots[np.diff(knots, prepend=-1.0) >= 1e-6], [1.0]])
    values = -(10.0 ** rng.uniform(-1.0, 2.0, len(knots)))
    values[[0, -1]] *= rng.integers(0, 2, 2)
    values[rng.integers(len(knots))] = -1.0
    solid = Isotropic(193e9, rng.uniform(-0.9, 0.5), 7860.0, rng.choice(["strain", "stress"]))
    points = np.column_stack([rng.choice(knots, 5), -(10.0 ** rng.uniform(-12.0, 0.5, 5))])
    changes = {
        "solve.pressure": np.column_stack([knots, values]).tolist(),
        "solve.tolerance": float(10.0 ** rng.uniform(-6.0, -3.0)),
        "solid.nu": float(solid.ν), "solid.plane": str(solid.plane),
        "motion.c": float(rng.uniform(0.0, 0.98) * solid.limit()),
        "friction.mu_c": float(rng.uniform(0.0, 1.2)), "friction.sigma0_over_load": 1e7,
        "motion.strokes": [str(rng.choice(["forward", "backward"]))],
    }  # fmt: skip
    if solid.nearly_incompressible:
        return changes | {"output.quantities": ["sif", "surface"], "output.points": None}
    return changes | {"output.points": points.tolist()}


@pytest.mark.parametrize("seed", range(6 if THOROUGH else 3))
def test_random_pressures_keep_their_tolerance(seed):
    changes = random_scene(np.random.default_rng(seed))
    result = computed("traction", ONE | changes)
    within_tolerance_and_estimate(result, changes["solve.tolerance"])


def test_what_is_wrong_fails(monkeypatch, tmp_path):
    true = LinearLoads.gradients
    monkeypatch.setattr(LinearLoads, "gradients", lambda self, points: 1.01 * true(self, points))
    result = put_in(HUMP, {"solve.tolerance": 1e-3})
    assert result.verdict == "FAIL"
    assert errors(result.data)[1] == pytest.approx(0.01, rel=0.1)
    result.save(tmp_path / "a.h5")
    assert here("check", tmp_path / "a.h5").returncode == 0
