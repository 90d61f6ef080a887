"""Scenes against their closed form, from rest to near the Rayleigh speed, on the surface and inside."""

import numpy as np
import pytest
from support import computed, here

from galinx.postprocess import compare
from galinx.solvers.fem.traction import LinearLoads

#: A pressure that is put in, at one state, to a tolerance that is met at once.
ROUGH = {
    "motion.strokes": ["forward"], "motion.X_over_L": 0.8, "motion.c": 0.6, "solve.tolerance": 1e-3,
    "output.quantities": ["sif", "surface"], "output.points": None,
}  # fmt: skip


def test_accuracy_at_the_default_tolerance(tables_run):
    data, load = tables_run.data, tables_run.scene.punch.load
    found = compare.comparisons(data, load, compare.RULES)
    assert found["K_I"] <= 1e-6
    assert found["sigma_YY"] <= 1e-5 and found["sigma_XX"] <= 1e-4
    assert found["exponents"] <= 2e-4
    assert tables_run.verdict == "PASS"


def test_forces_balance(tables_run):
    data = tables_run.data
    np.testing.assert_allclose(data["states/fem/normal_force"], -55.3e3, rtol=1e-9)
    np.testing.assert_allclose(data["states/fem/tangential_force"], -55.3e3 * data["states/g"], rtol=1e-9)


def test_the_two_signs_of_friction_are_mirror_images(tables_run):
    fast = {name: values[6:] for name, values in tables_run.data.items() if len(values) == 12}
    printed = computed("tables4_5", {"friction.sign": "eq25", "motion.c": 0.6}).data
    np.testing.assert_array_equal(printed["states/g"], -fast["states/g"])
    np.testing.assert_allclose(printed["states/fem/K_I_left"], fast["states/fem/K_I_right"], rtol=1e-9)
    mirrored = fast["surface/fem/sigma_XX"][:, ::-1]
    np.testing.assert_allclose(printed["surface/fem/sigma_XX"], mirrored, rtol=1e-5, atol=1e-7)


def test_pressure_and_tension_lead_at_the_trailing_end(tables_run):
    """Physical sign, forward: both the stronger singularity and the tension are at X = -a."""
    data = tables_run.data
    X = data["surface/X_over_a"]
    behind, ahead = np.argmin(np.abs(X + 1.05)), np.argmin(np.abs(X - 1.05))
    for i in np.flatnonzero(data["states/f"] > 0.0):
        assert data["states/fem/beta"][i] < data["states/fem/alpha"][i]
        assert data["surface/fem/sigma_XX"][i, behind] > 0.0 > data["surface/fem/sigma_XX"][i, ahead]


def test_a_pressure_that_pulls_fails():
    result = computed("traction", ROUGH | {"solve.pressure": [[-1, -2], [0, 1], [1, -2]]})
    assert result.verdict == "FAIL"
    told = "tension under the punch, over N/(2a): 1.0e+00, at most 0"
    assert told in result.attributes["verdict_reasons"]


def test_a_wrong_field_of_a_pressure_fails(monkeypatch, tmp_path):
    true = LinearLoads.gradients
    monkeypatch.setattr(LinearLoads, "gradients", lambda self, points: 1.01 * true(self, points))
    hump = [[-1, -1], [0, -1], [0.05, -4], [0.1, -1], [1, -1]]
    result = computed("traction", ROUGH | {"solve.pressure": hump})
    assert result.verdict == "FAIL"
    result.save(tmp_path / "a.h5")
    assert here("check", tmp_path / "a.h5").returncode == 0


def test_incompressible_solids_have_stresses_inside_in_closed_form_only():
    points = {"output.quantities": ["sif", "interior"], "output.points": [[0.0, -1.0], [0.9, -0.1]]}
    rest = points | {"motion.c": 0.0}
    data = computed("tables4_5", rest | {"solid.nu": 0.5, "solve.tolerance": 1e-3}).data
    near = computed("tables4_5", rest | {"solid.nu": 0.4999999, "solve.methods": ["closed_form"]}).data
    assert "states/fem/K_I_left" in data and not any(path.startswith("interior/fem") for path in data)
    for ij in ("XX", "YY", "XY"):
        name = f"interior/closed_form/sigma_{ij}"
        np.testing.assert_allclose(data[name], near[name], rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("method, word", [("sie", "surface"), ("sie", "sif"), ("fem", "sif")])
def test_a_punch_that_pulls_fails_whatever_is_asked_for(method, word):
    """A flat punch on a stiff layer on a soft solid lifts off in its middle."""
    scene = {
        "solid": {"E": 1e10, "nu": 0.3, "rho": 2700.0}, "friction": {"mu": 0.3}, "motion": {"c": 0.1},
        "layer": [{"E": 2.5e11, "nu": 0.1, "rho": 3300.0, "thickness": 6e-4}],
        "punch": {"half_width": 1e-3, "load": 5e4}, "output": {"quantities": [word]},
    }  # fmt: skip
    result = computed(changes=scene | {"solve": {"methods": [method], "tolerance": 1e-3}})
    assert result.data[f"states/{method}/tension"] > 0.1 and result.verdict == "FAIL"
