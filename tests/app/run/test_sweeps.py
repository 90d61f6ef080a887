"""Many speeds of which few are solved: against speeds that are solved by themselves, and exact ones."""

import numpy as np
import pytest
from agreement import differences, of_method
from random_solids import random_solid
from support import THOROUGH, scene_of, section_of

import galinx
from galinx.postprocess.tables import solved_speeds
from galinx.solvers.solids import Isotropic
from galinx.solvers.solids.plane import Orthotropic

ISOTROPIC = Isotropic(E=70e9, ν=0.25, ρ=2700.0)
#: Frictions of both signs, more than are sampled themselves.
FRICTION = {"mu_c": [0.3, 0.8], "sigma0_over_load": 2e4}
SIF = {"output.quantities": ["sif"]}
EVERY = {"solve.sweep": "every"}


def scene(solid, c, tolerance, *more):
    """A scene of many speeds, with the changes ``more``."""
    changes = {
        "solid": section_of(solid), "punch": None, "friction": FRICTION,
        "solve": {"tolerance": tolerance},
        "motion": {"c": np.asarray(c).tolist(), "strokes": ["forward", "backward"],
                   "X_over_L": [0.2, 0.6, 0.95]},
        "output": {"quantities": ["sif", "surface"]},
    }  # fmt: skip
    for one in more:
        changes |= one
    return scene_of(changes=changes)


def of_speeds(*given):
    return galinx.compute(scene(*given))


def of_fem(data, speeds):
    """Datasets of finite elements at some of the speeds, in their order."""
    rows = np.argsort(data["states/c"], kind="stable")
    rows = rows[np.isin(data["states/c"][rows], speeds)]
    found = of_method(data, "fem") | {"states/g": data["states/g"]}
    return {path: values[rows] for path, values in found.items() if not path.startswith("run/")}


def check(result, other, tolerance):
    """A sweep is what speeds solved by themselves are, and says how good it is."""
    speeds = np.unique(other.data["states/c"])
    one, alone = (of_fem(each.data, speeds) for each in (result, other))
    np.testing.assert_array_equal(one["states/g"], alone["states/g"])
    for what, off in differences(one, alone, other.data).items():
        assert off.max() <= tolerance, what
        assert np.all(off <= one[f"states/estimate{what}"] + alone[f"states/estimate{what}"]), what
    assert np.all(result.data["states/fem/true_error"] <= result.data["states/fem/estimate"])
    assert result.verdict == "PASS"


def solved(result):
    """Speeds that were solved, and the others; what the archive says of them agrees."""
    data = result.data
    of_speed = dict(zip(data["run/fem/c"].tolist(), data["run/fem/factorisations"].tolist()))
    fitted = data["states/fem/fitted"].tolist()
    told = {c: one == 0.0 for c, one in zip(data["states/c"].tolist(), fitted)}
    assert {c: count > 0 for c, count in of_speed.items()} == told
    both = [sorted(c for c, one in told.items() if one is which) for which in (True, False)]
    assert f"{len(both[0])} of {len(told)} speeds" in solved_speeds(data)
    return both


@pytest.mark.parametrize(
    ("solid", "punch", "tolerance"),
    [
        *[(ISOTROPIC, None, 1e-4), *[(random_solid(seed), None, 1e-3) for seed in (3, 5)]] * THOROUGH,
        (ISOTROPIC, {"profile": "parabolic", "radius": 0.1, "load": [1e4, 7e4]}, 1e-3),
        (ISOTROPIC, {"tilt": 2e-4, "load": [1e4, 5e4, 2e5]}, 1e-3),
    ],
)
def test_a_sweep_is_what_its_speeds_are_by_themselves(solid, punch, tolerance):
    c = np.random.default_rng(7).permutation(np.linspace(0.0, 0.85, 24)) * solid.limit()
    result = of_speeds(solid, c, tolerance, {"punch": punch})
    once, told = solved(result)
    assert len(once) <= 12
    alone = [told[i] for i in np.linspace(0, len(told) - 1, 3).astype(int)]
    other = of_speeds(solid, alone, tolerance, {"punch": punch})
    assert "states/fem/fitted" not in other.data
    check(result, other, tolerance)


def test_a_law_whose_friction_follows_the_speed():
    c = np.linspace(0.05, 0.8, 20)
    law = {"friction": {"model": "stribeck", "mu_c": 0.3, "mu_s": 0.9, "stribeck_velocity": 900.0}} | SIF
    result = of_speeds(ISOTROPIC, c, 1e-4, law)
    _, told = solved(result)
    assert len(np.unique(result.data["states/g"])) == 40
    check(result, of_speeds(ISOTROPIC, told[::4], 1e-4, law), 1e-4)


@pytest.fixture
def work_done(monkeypatch):
    """Degrees that are solved with, as long as the test runs."""
    from galinx.solvers.fem.contact import PunchLevel

    degrees, init = [], PunchLevel.__init__

    def counted(self, work, task, space, g, fitted=None, recovery=None):
        init(self, work, task, space, g, fitted, recovery)
        degrees.extend([space.degree] * (fitted is None))

    monkeypatch.setattr(PunchLevel, "__init__", counted)
    return degrees


def test_what_no_fit_tells_well_enough_is_solved(monkeypatch, work_done):
    """And what was solved in vain, with the work as the fourth power of the degree, is little."""
    from galinx.solvers.fem import sweep

    monkeypatch.setattr(sweep, "FIT", 1e-12)
    c = np.linspace(0.0, 0.8, 16)
    result = of_speeds(ISOTROPIC, c, 1e-2, SIF)
    assert np.all(result.data["run/fem/factorisations"] > 0)
    assert not result.data["states/fem/fitted"].any() and result.verdict == "PASS"
    spent = np.sum(np.array(work_done) ** 4)
    work_done.clear()
    every = of_speeds(ISOTROPIC, c, 1e-2, SIF, EVERY)
    assert spent <= 1.1 * np.sum(np.array(work_done) ** 4)
    check(result, every, 1e-2)


@pytest.mark.skipif(not THOROUGH, reason="minutes: with GALINX_THOROUGH=1")
def test_speeds_that_ask_for_different_degrees_cost_little_more_than_each_by_itself(work_done):
    """The fastest of them asks for two degrees more than the others, at which all of a fit are solved."""
    solid = Orthotropic(0.755e9, 5.85e9, 3.67e9, 0.066, -0.18, 0.1, 0.252e9, 1.67e3, 45.0, "stress")
    c = np.linspace(0.0, 0.97, 16) * solid.limit()
    work = []
    for sweep in ("auto", "every"):
        result = of_speeds(solid, c, 1e-4, SIF, {"solve.sweep": sweep})
        assert result.verdict == "PASS"
        work.append(np.sum(np.array(work_done) ** 4))
        work_done.clear()
    assert work[0] <= 1.1 * work[1]


@pytest.mark.skipif(not THOROUGH, reason="minutes: with GALINX_THOROUGH=1")
def test_all_of_256_speeds_at_once():
    c = np.linspace(0.0, 0.98, 256) * ISOTROPIC.limit()
    many = {"friction": {"mu_c": [0.1, 0.3, 0.5, 0.8, 1.2], "sigma0_over_load": [5e3, 2e4]}}
    result = of_speeds(ISOTROPIC, c, 1e-6, many)
    assert len(solved(result)[0]) <= 14
    check(result, of_speeds(ISOTROPIC, c, 1e-6, many, EVERY), 1e-6)


@pytest.mark.parametrize("seed", range(12) if THOROUGH else [6])
def test_all_speeds_of_random_solids(seed):
    """Of some, the one of seed 6 among them, a speed asks for a higher degree than those before."""
    rng, solid = np.random.default_rng(seed), random_solid(seed)
    c = np.sort(rng.uniform(0.0, rng.uniform(0.5, 0.95), 32)) * solid.limit()
    tolerance = 10.0 ** rng.uniform(-6.0, -3.0)
    result = of_speeds(solid, c, tolerance)
    each = c if THOROUGH else c[::-8]
    check(result, of_speeds(solid, each, tolerance, EVERY), tolerance)
