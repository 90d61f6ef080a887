"""Friction laws in scenes: states, loops, what strokes take, contact; motions of all kinds."""

import json

import numpy as np
import pytest
import random_laws as random
from support import here, of_sections

import galinx
from galinx.app.results.check import faults
from galinx.solvers.friction import LAWS, FrictionLaw
from galinx.solvers.friction.motion import Partial, friction_along
from galinx.solvers.parameters import build_model

MOTION = {"speed": 2e-3, "strokes": ["forward", {"to": 0.2}, {"to": 0.6}, {"to": 0.2}, {"to": 1.0}]}

#: Parameters of the law by that name.
RATE_AND_STATE = {
    "reference_friction": 0.6, "reference_speed": 1e-6, "a": 0.01, "b": 0.015, "critical_slip": 1e-7,
}  # fmt: skip


def scene(model, friction, motion=MOTION, quantities=("friction",), **sections):
    return of_sections(
        solid={"material": "steel"}, punch={"load": 2e4}, motion=motion,
        friction={"model": model} | json.loads(json.dumps(friction)),
        solve={"methods": ["closed_form"]}, output={"quantities": list(quantities)}, **sections,
    )  # fmt: skip


@pytest.mark.parametrize("name", sorted(LAWS))
def test_every_law_goes_from_the_scene_to_the_contact(name, tmp_path):
    parameters = random.parameters(name, np.random.default_rng(5))
    result = galinx.compute(scene(name, parameters, quantities=("friction", "sif")))
    law = build_model(LAWS[name], parameters)
    strokes = ["forward", Partial(0.2), Partial(0.6), Partial(0.2), Partial(1.0)]
    known = friction_along(law, strokes, 1e-4, (0.2, 0.8), 2e-3)
    f = np.concatenate([stroke.f for stroke in known])
    data = result.data
    assert [*data["states/motion"]] == ["FM1", "FM1", "BM1", "BM1", "FM2", "BM2", "FM3", "FM3"]
    np.testing.assert_allclose(data["states/f"], f, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(data["states/g"], -f, rtol=0.0, atol=1e-10)
    inner = np.concatenate([stroke.z for stroke in known])
    np.testing.assert_allclose(data["states/inner_state"], inner, rtol=0.0, atol=1e-10)
    assert result.dataset.inner_state.dims == ("state", "inner")
    cot = 1.0 / np.tan(np.pi * data["states/alpha"])
    response = result.scene.solid.response(data["states/c"][0])
    np.testing.assert_allclose(cot, -f * response.q / response.n, rtol=0.0, atol=1e-9)
    assert data["loops/f"].shape == (1, 505) and data["loops/dissipated"].shape == (1, 5)


@pytest.mark.parametrize("name", sorted(LAWS))
def test_loops_and_what_strokes_take_are_those_of_the_drawn_friction(name):
    data = galinx.compute(scene(name, random.parameters(name, np.random.default_rng(6)))).data
    X, f = data["loops/X_over_L"].reshape(5, -1), data["loops/f"].reshape(5, -1)
    N, L = 2e4, 1e-4
    work = N * L * (0.5 * (f[:, 1:] + f[:, :-1]) * np.diff(X)).sum(axis=1)
    np.testing.assert_allclose(data["loops/dissipated"][0], work, rtol=2e-2, atol=1e-4 * N * L)
    assert data["loops/cycle_dissipated"][0] == pytest.approx(data["loops/dissipated"][0, 1:].sum())
    against = N * (np.sign(np.diff(X)[:, :1]) * f).max(axis=1)
    np.testing.assert_allclose(data["loops/breakaway"][0], against, rtol=3e-2, atol=1e-9 * N)
    assert (data["loops/breakaway"][0] >= against * (1.0 - 1e-12) - 1e-9 * N).all()
    slope = N / L * (f[:, 1] - f[:, 0]) / (X[:, 1] - X[:, 0])
    tangent = data["loops/tangent_stiffness"][0]
    np.testing.assert_allclose(tangent, slope, rtol=0.3, atol=2e-2 * N / L)


def test_strokes_may_have_speeds_and_rests_of_their_own():
    strokes = [{"to": 0.5}, {"to": 1, "speed": 1e-5}, {"to": 0.5, "rest": 0}, {"to": 1, "rest": 90}]
    motion = {"speed": 1e-6, "X_over_L": [0.5, 1], "rest": 5, "strokes": strokes}
    data = galinx.compute(scene("rate_and_state", RATE_AND_STATE, motion)).data
    steady = 0.6 + (0.01 - 0.015) * np.log(10.0)
    np.testing.assert_allclose(data["states/speed"], [1e-6, 1e-5, 1e-5, 1e-6, 1e-6, 1e-6, 1e-6])
    at_start = data["loops/f"].reshape(4, -1)[:, 0]
    aged = 0.6 + 0.01 * np.log(10.0) + 0.015 * np.log(1.0 + 5.0 * 1e-6 / 1e-7)
    before = 0.1  # ϑ after steady sliding at the higher speed
    rested = 0.6 + 0.015 * np.log(1.0 + 90.0 * 1e-6 / 1e-7)
    wanted = [0.6, aged, -(0.6 + 0.015 * np.log(before)), rested]
    np.testing.assert_allclose(at_start, wanted, rtol=1e-12)
    assert data["states/f"][2] == pytest.approx(steady, rel=1e-12)


def test_a_slider_is_archived_and_drawn_for_every_law(tmp_path):
    slider = {"mass": 2, "stiffness": "8 N/m^2", "drive_speed": "0.1 m/s", "duration": "20 s"}
    given = "coulomb", {"mu_c": [2e-5, 4e-5]}, {"speed": 2e-3}, ("friction", "slider")
    (tmp_path / "s.toml").write_text(scene(*given, slider=slider).text, encoding="utf-8")
    done = here("run", "s.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert faults(tmp_path / "s.h5") == []
    result = galinx.load(tmp_path / "s.h5")
    data = result.data
    np.testing.assert_allclose(data["slider/period"], np.pi, rtol=1e-7)
    np.testing.assert_allclose(data["slider/slip_per_cycle"], 0.1 * np.pi, rtol=1e-7)
    np.testing.assert_allclose(data["slider/peak_velocity"], 0.2, rtol=1e-6)
    for row, μ in enumerate((2e-5, 4e-5)):
        later = np.maximum(data["slider/time"] - μ * 2e4 / 0.8, 0.0)
        wanted = 0.1 * (1.0 - np.cos(2.0 * later))
        np.testing.assert_allclose(data["slider/velocity"][row], wanted, rtol=0.0, atol=1e-9)
    assert [drawing.name for drawing in result.drawings()] == ["slider"]


def test_few_loops_are_integrated(monkeypatch):
    from galinx.app.plan import states

    law = {"mu_c": [0.3, 0.4, 0.5], "mu_s": 0.5, "stribeck_velocity": 1e-3, "sigma0_over_load": 2e4}
    for name in ("exact", "work"):  # as a law of one's own that has no formula
        monkeypatch.setattr(LAWS["elasto_plastic"], name, getattr(FrictionLaw, name))
    monkeypatch.setattr(states, "INTEGRATED_LOOPS", 2)
    data = galinx.compute(scene("elasto_plastic", law)).data
    assert data["loops/f"].shape == (2, 505)
    assert sorted(set(data["loops/of_state"])) == [-1, 0, 1]
