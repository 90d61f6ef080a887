"""Starts from rest in scenes: archived, judged, drawn; what has no answer is refused."""

import json
import re

import numpy as np
import pytest
from support import command, computed

import galinx
from galinx.app.errors import BadInput
from galinx.app.plan.plan import make_plan
from galinx.app.results.check import faults

QUICK = {"time.end": 3.0, "time.load_ramp": 2.0, "solve.tolerance": 1e-2}


def test_a_start_is_archived_judged_and_drawn(tmp_path):
    changes = [f"--set={key}={value}" for key, value in QUICK.items()]
    done = command("run", "scenes/start_from_rest.toml", "-o", tmp_path / "s.h5", *changes)
    assert done.returncode == 0, done.stdout + done.stderr
    assert faults(tmp_path / "s.h5") == []
    result = galinx.load(tmp_path / "s.h5")
    data = result.data
    assert data["time/t"][-1] == 3.0
    assert data["time/load"][-1] == 1.0
    assert data["time/fem/K_I_left"].shape == (1, len(data["time/t"]))
    size = np.abs(data["time/sie/v0"]).max()
    np.testing.assert_allclose(data["time/fem/v0"], data["time/sie/v0"], atol=1e-3 * size)
    np.testing.assert_allclose(data["time/fem/work"][:, -1], data["time/fem/energy"][:, -1], rtol=1e-4)
    # At first the pressure leans ahead, in steady motion behind.
    assert data["time/fem/centre_of_pressure"][0, -1] > 0.0 > data["time/steady_centre"][0]
    # Both methods tell alike how far it is from steady, at the end and by 1/t from there on.
    assert data["time/fem/off_steady"][0] == pytest.approx(data["time/sie/off_steady"][0], rel=0.02)
    # Its integral is the load; near the ends a rule of Gauss and Chebyshev knows roots alone.
    X, σ = data["time/X_over_a"], data["time/sie/sigma_YY"][0]
    resultant = -(σ * np.sqrt(1.0 - X**2)).sum(axis=-1) * np.pi / len(X)
    np.testing.assert_allclose(resultant / 2.0, data["time/load"], atol=0.03)
    np.testing.assert_allclose(
        data["time/sie/work_of_load"] + data["time/sie/work_of_friction"],
        data["time/fem/energy"],
        atol=1e-3,
    )
    ten, one, tenth = data["time/fem/steady_within"][0]
    assert tenth > one > ten > 3.0
    assert result.attributes["verdict"] == "PASS"
    assert len(json.loads(result.attributes["comparisons"])) == 2
    assert [drawing.name for drawing in result.drawings()] == ["friction", "time", "pressures"]
    words = ["--figure", "film", "--format", "gif", "-o", tmp_path / "film.gif"]
    assert command("plot", tmp_path / "s.h5", *words).returncode == 0
    assert (tmp_path / "film.gif").read_bytes()[:4] == b"GIF8"
    shown = command("show", tmp_path / "s.h5").stdout
    assert "Starts from rest" in shown


def test_a_step_may_be_given_and_states_of_one_friction_start_once():
    more = {"motion.strokes": ["forward", "forward"], "time.step": 0.25, "solve.methods": ["sie"]}
    result = computed("start_from_rest", QUICK | more)
    data = result.data
    assert [drawing.name for drawing in result.drawings()] == ["friction", "time", "pressures"]
    assert len(data["states/f"]) == 2
    assert data["time/sie/v0"].shape == (1, 6)
    assert "time/fem/v0" not in data


def test_fibres_start_by_both_methods():
    """At an angle no solid is its own mirror image: without friction the pressure leans."""
    fibres = {"kind": "orthotropic", "E1": "140 GPa", "E2": "10 GPa", "E3": "10 GPa", "nu12": 0.3,
              "nu13": 0.3, "nu23": 0.45, "G12": "5 GPa", "rho": "1600 kg/m^3", "angle": 30.0}  # fmt: skip
    solid = {f"solid.{key}": value for key, value in fibres.items()} | {"solid.E": None, "solid.nu": None}
    more = {"friction.mu_c": 1e-9, "motion.c": 0.3, "time.end": 2.0}
    result = computed("start_from_rest", QUICK | solid | more)
    data = result.data
    size = np.abs(data["time/sie/v0"]).max()
    np.testing.assert_allclose(data["time/fem/v0"], data["time/sie/v0"], atol=1e-3 * size)
    assert np.abs(data["time/fem/centre_of_pressure"][0, -1]) > 1e-2
    assert result.attributes["verdict"] == "PASS"


@pytest.mark.parametrize(
    "changes, said",
    [
        ({"solve.tolerance": 1e-7}, "found 1e-07, expected 1e-05 to 0.01"),
        ({"solve.methods": ["closed_form"]}, "neither fem nor sie"),
        ({"motion.c": 0.95}, "is not below the Rayleigh speed"),
        ({"time.end": 200.0}, "unknowns"),
        ({"solid.nu": 0.495}, "ν is not near 1/2"),
        ({"friction.mu_c": [0.01 * i for i in range(1, 30)]}, "expected at most 24"),
        ({"output.quantities": ["friction"]}, "go together"),
        ({"time.step": "coarse"}, "time.step"),
    ],
)
def test_what_has_no_answer_is_refused(changes, said):
    with pytest.raises(BadInput, match=re.escape(said)):
        make_plan(galinx.template("start_from_rest", changes))


def test_a_plan_tells_starts():
    done = command("plan", "scenes/start_from_rest.toml")
    assert "integral equation in time: 1 starts from rest" in done.stdout
    assert "finite elements in time" in done.stdout
