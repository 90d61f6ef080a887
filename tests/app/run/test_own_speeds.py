"""Strokes with speeds of their own, and motions point by point, in contact scenes."""

import numpy as np
import pytest
from support import computed, interrupted

import galinx
from galinx.app.plan import plan as planning
from galinx.app.plan.plan import make_plan
from galinx.app.run import flow
from galinx.app.run.flow import Memory, compute
from galinx.postprocess.journal import Journal

#: The second stroke is the faster one; a law that knows the speed remembers it.
STROKES = [{"to": 0.8}, {"to": 0.2, "speed": "1800 m/s"}, {"to": 1.0}]
SCENE = {
    "motion.c": None, "motion.speed": ["1000 m/s", "400 m/s"], "motion.strokes": STROKES,
    "motion.X_over_L": [0.3, 0.7], "output.quantities": ["sif", "surface"],
    "friction.model": "lugre", "friction.mu_c": [0.3, 0.6], "friction.mu_s": 0.7, "friction.delta": None,
    "friction.stribeck_velocity": "900 m/s", "friction.sigma1_over_load": 1e-6,
}  # fmt: skip
CLOSED = {"solve.methods": ["closed_form"]}


@pytest.fixture(scope="module")
def run():
    return computed("tables4_5", SCENE)


def test_every_state_is_that_of_its_strokes_speed(run):
    """f and g as of friction alone, and the contact that of a flat punch with these at that speed."""
    assert run.verdict == "PASS", run.attributes["verdict_reasons"]
    friction = computed("tables4_5", SCENE | {"output.quantities": ["friction"], "solve.methods": []})
    for path, values in friction.data.items():
        if path.startswith(("states/", "loops/")):
            np.testing.assert_array_equal(run.data[path], values, err_msg=path)
    V, motion = run.data["states/speed"], run.data["states/motion"]
    assert (V[motion == "BM1"] == 1800.0).all()
    assert set(V[motion != "BM1"]) == {1000.0, 400.0} and len(V) == 24
    solid = run.scene.solid
    for i, (c, g) in enumerate(zip(run.data["states/c"], run.data["states/g"])):
        response = solid.response(c)
        cot = g * response.q / (response.n + g * response.n12)
        K = np.sin(np.arctan2(1.0, cot)) / np.pi
        assert run.data["states/fem/K_I_right"][i] == pytest.approx(K, rel=1e-6)
        assert run.data["states/closed_form/K_I_left"][i] == pytest.approx(K, rel=1e-12)


def test_few_states_at_a_time_are_the_same_and_are_gone_on_with(run, tmp_path, monkeypatch):
    """Runs of a speed are cut and put together, and a run that was stopped goes on."""
    scene = galinx.template("tables4_5", SCENE | CLOSED)
    expected = Memory()
    compute(scene, expected)
    monkeypatch.setattr(planning, "CHUNK_NUMBERS", 3 * make_plan(scene).numbers)
    interrupted(scene, tmp_path / "a.h5", 8)
    found = Memory()
    with Journal(tmp_path / "a.h5", "key", resume=True) as journal:
        assert 0 < journal.states < 24
        told = compute(scene, found, None, journal)
    for path, values in expected.items():
        if path.endswith("residual"):  # what rounding leaves, which depends on what is summed together
            np.testing.assert_allclose(found[path], values, atol=1e-12, err_msg=path)
        elif path.startswith(("states/", "surface/")):
            np.testing.assert_array_equal(found[path], values, err_msg=path)
    assert told["comparisons"] == compute(scene, Memory())["comparisons"]


def test_a_path_has_the_speed_of_each_piece():
    """Equal speeds but for rounding are one; a position that stays is a rest."""
    path = [[0.0, 0.0], [1e-7, 3e-5], [2e-7, 6e-5], [3e-7, 6e-5], [4e-7, 9e-5], [6e-7, 5e-5]]
    changes = {
        "motion.c": None, "motion.strokes": None, "motion.X_over_L": None, "motion.path": path,
        "output.quantities": ["sif"], "solve.tolerance": 1e-3,
    }  # fmt: skip
    result = computed("tables4_5", changes)
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    data = result.data
    np.testing.assert_allclose(data["states/speed"], [300, 300, 300, 200], rtol=1e-12)
    np.testing.assert_allclose(data["states/X_over_L"], [0.3, 0.6, 0.9, 0.5], rtol=1e-12)
    assert data["states/motion"].tolist() == ["FM1", "FM2", "FM3", "BM1"]
    assert len(data["run/fem/c"]) == 2
    assert np.sign(data["states/f"][:3]).tolist() == [1, 1, 1]


class Counting(Memory):
    """Counts what is written."""

    writes = 0

    def write(self, name, rows, values):
        self.writes += name == "states/alpha"
        super().write(name, rows, values)


def test_parts_of_many_speeds_are_written_and_kept_together(tmp_path, monkeypatch):
    """As many as wait for one another, and nothing of the results depends on that."""
    many = {"motion.c": np.linspace(0.0, 0.9, 30).tolist(), "output.quantities": ["sif", "surface"]}
    scene = galinx.template("tables4_5", CLOSED | many)
    alone, together = Counting(), Counting()
    monkeypatch.setattr(flow, "_PATIENCE", -1.0)
    compute(scene, alone)
    monkeypatch.setattr(flow, "_PATIENCE", 1e9)
    with Journal(tmp_path / "a.h5", "key") as journal:
        compute(scene, together, None, journal)
        assert journal.states == 6 * 30
    assert (alone.writes, together.writes) == (30, 1)  # 1 000 states at once
    for path, values in alone.items():
        if path.endswith("residual"):  # what rounding leaves, which depends on what is summed together
            np.testing.assert_allclose(together[path], values, atol=1e-11, err_msg=path)
        elif path != "run/seconds":
            np.testing.assert_array_equal(together[path], values, err_msg=path)
