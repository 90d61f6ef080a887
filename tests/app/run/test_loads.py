"""A sweep of loads: every state as under its load alone, and what is alike solved once."""

import re

import numpy as np
import pytest
from support import THOROUGH, computed, interrupted, of_sections, scene_of

import galinx
from galinx.app.errors import BadInput
from galinx.app.plan.plan import Plan, make_plan
from galinx.app.plan.states import enumerate_states
from galinx.app.results.check import faults
from galinx.app.run.flow import Memory, compute
from galinx.postprocess.journal import Journal

LOADS = (2e4, 5.53e4, 3e5)
_SHAPE = [[-2e-3, 1.6e-4], [-1e-3, 4e-5], [0, 0], [5e-4, 5e-6], [2e-3, 8e-5]]
PUNCHES = {
    "flat": {"profile": "flat", "half_width": 1e-3},
    "tilted": {"profile": "flat", "half_width": 1e-3, "tilt": 0.01},
    "parabolic": {"profile": "parabolic", "radius": 0.02},
    "wedge": {"profile": "wedge", "slope": 0.005},
    "power": {"profile": "power", "exponent": 3, "coefficient": 1e4},
    "rounded": {"profile": "rounded_flat", "flat_half_width": 1e-4, "radius": 0.01},
    "table": {"profile": "table", "shape": _SHAPE},
}
#: Stresses everywhere, by one stroke.
ALL = {
    "motion.c": 0.4, "motion.X_over_L": [0.3, 1.0], "motion.strokes": ["forward"], "friction.mu_c": 0.5,
    "output.quantities": ["sif", "surface", "interior"], "output.points": [[0.0, -0.5], [1.0, -0.2]],
}  # fmt: skip
CLOSED = {"solve.methods": ["closed_form"]}
#: What several loads have is what each has, at any degree.
ROUGH = {"solve.tolerance": 1e-4}


def punch(name):
    """Changes of a scene that give it a punch."""
    return {"punch.half_width": None} | {f"punch.{key}": value for key, value in PUNCHES[name].items()}


def of_states(data):
    """Numbers of states by path."""
    found = {
        path: values
        for path, values in data.items()
        if path.startswith(("states/", "surface/", "interior/"))
    }
    return {
        path: values for path, values in found.items()
        if values.dtype.kind == "f" and path not in ("states/load", "surface/X_over_a")
        and not path.startswith(("interior/X_", "interior/Y_"))
    }  # fmt: skip


def same_as_alone(changes, loads=LOADS, digits=1e-12):
    """A scene of several loads has what scenes of these loads have; returns its result and theirs."""
    many = computed("tables4_5", changes | {"punch.load": list(loads)})
    assert many.verdict != "FAIL", many.attributes["verdict_reasons"]
    alone = [computed("tables4_5", changes | {"punch.load": load}) for load in loads]
    for i, (load, one) in enumerate(zip(loads, alone)):
        assert one.verdict != "FAIL", one.attributes["verdict_reasons"]
        expected = of_states(one.data)
        assert expected.keys() == of_states(many.data).keys()
        for path, values in expected.items():
            count = len(values)
            found = many.data[path][i * count : (i + 1) * count]
            size = np.nanmax(np.abs(values), initial=0.0)
            # Errors are of the last digits, measured on samples; the place of a maximum has half of them.
            within = 1e-4 if re.search("estimate|error|position", path) else digits
            if "residual" in path:  # rounding, and nothing of the load
                assert (found <= 1e-9).all() and (values <= 1e-9).all(), path
                continue
            if "estimate" in path:  # shared by all loads: their rounding is that of the worst
                assert (found >= values * (1.0 - within)).all() and (found <= 1.02 * values).all(), path
                continue
            # Reaches and depths are differences of positions near 1.
            least = 64.0 * np.finfo(float).eps if re.search("reach|depth", path) else 0.0
            atol = max(within * size, least)
            np.testing.assert_allclose(found, values, rtol=within, atol=atol, err_msg=path)
        assert (many.data["states/load"][i * count : (i + 1) * count] == load).all()
    return many, alone


@pytest.mark.parametrize(
    "name", ("flat", "tilted", "parabolic", "wedge") if THOROUGH else ("tilted", "parabolic")
)
def test_states_under_several_loads_are_those_under_each(name):
    """By both methods; the tilted punch lifts off at the least load alone."""
    # Ends are found to rounding, and next to these stresses make a thousand times as much of it.
    digits = 1e-8 if name == "wedge" else 1e-12
    many, alone = same_as_alone(ALL | ROUGH | punch(name), LOADS[::2], digits)
    if name == "tilted":
        a = many.data["states/fem/half_width"]
        assert (a[:2] < 0.9e-3).all() and (a[2:] == 1e-3).all()
    # One factor for each of the degrees, whatever the loads.
    for count in ("factorisations", "back_substitutions"):
        assert many.data[f"run/fem/{count}"] == alone[-1].data[f"run/fem/{count}"]


@pytest.mark.parametrize("name", sorted(PUNCHES))
def test_the_integral_equation_has_every_load(name):
    same_as_alone(ALL | punch(name) | CLOSED)


@pytest.mark.parametrize("pressure", ["closed_form", [[-1, -0.5], [0.2, -2.0], [1, -0.5]]])
def test_a_pressure_that_is_put_in_has_every_load(pressure):
    given = {
        "solve.mode": "traction", "solve.pressure": pressure, "solid.yield_strength": "1 GPa",
        "output.quantities": ["surface", "yield"], "output.points": None, "motion.X_over_L": [1.0],
        "solve.tolerance": 1e-3,
    }  # fmt: skip
    same_as_alone(ALL | given, (3e4, 3e6))


def test_loads_are_one_list_of_the_product():
    """Slower than the laws, faster than the speeds; each once."""
    lists = {"punch.load": ["2 N/mm", "1 N/mm", 2e3], "friction.mu_c": [0.3, 0.7], "motion.c": [0.1, 0.2]}
    scene = galinx.template(
        "tables4_5", lists | {"motion.X_over_L": [0.5], "motion.strokes": ["forward"]}
    )
    assert scene.punch.loads == (2e3, 1e3) and scene.punch.load == scene.body.load == 2e3
    columns = enumerate_states(scene).columns
    assert columns["c"].tolist() == [0.1] * 4 + [0.2] * 4
    assert columns["load"].tolist() == [2e3, 2e3, 1e3, 1e3] * 2
    assert columns["mu_c"].tolist() == [0.3, 0.7] * 4
    assert columns["f"].tolist() == columns["f"][:2].tolist() * 4
    plan = make_plan(scene)
    assert [task.runs for task in plan.tasks] == [(slice(0, 4),), (slice(4, 8),)]
    grid = computed("tables4_5", lists | CLOSED).grid
    assert grid.f.dims[:3] == ("c", "load", "mu_c") and not np.isnan(grid.f).any()


def test_archives_of_loads_are_whole_and_a_load_that_was_changed_is_found(tmp_path):
    changes = ALL | punch("flat") | CLOSED | {"punch.load": list(LOADS)}
    result = computed("tables4_5", changes)
    result.save(tmp_path / "a.h5")
    assert not faults(tmp_path / "a.h5")
    result.data["states/load"][0] *= 2.0
    result.save(tmp_path / "b.h5")
    assert any("states/load" in fault for fault in faults(tmp_path / "b.h5"))


@pytest.mark.parametrize("method", ["closed_form", "sie", "fem"])
def test_states_that_are_wider_than_the_punch_leave_the_others_theirs(method):
    """Friction shifts the contact: under 230 N/mm it leaves the punch forward, and does not backward."""
    shape = [[-0.002, 4e-5], [0, 0], [0.002, 5e-5]]
    scene = of_sections(
        solid={"material": "PMMA"}, friction={"mu": 0.3},
        punch={"profile": "table", "shape": shape, "load": ["400 N/mm", "230 N/mm", "50 N/mm"]},
        motion={"c": 0.0, "strokes": ["forward", "backward"], "X_over_L": [0.5]},
        solve={"methods": [method], "tolerance": 1e-3},
    )  # fmt: skip
    result = galinx.compute(scene)
    h, m = (result.data[f"states/{method}/{of}"] for of in ("half_width", "centre"))
    np.testing.assert_array_equal(np.isfinite(h), [False] * 3 + [True] * 3)
    # One parabola under all loads: lengths go with their root. The mirror image of backward is forward.
    np.testing.assert_allclose(h[3:] / 0.8609e-3, [4.6**0.5, 1.0, 1.0], rtol=1e-3)
    np.testing.assert_allclose(m[3:] - -0.1111e-3, np.array([4.6**0.5, -1.0, 1.0]) * 0.0339e-3, rtol=4e-3)
    (failure,) = result.data["run/failures"]
    assert "N = 230000 N/m" in failure or "N = 400000 N/m" in failure


def test_a_run_that_goes_on_knows_which_states_have_no_contact(monkeypatch, tmp_path):
    """Batches with such states are computed again, those of others are kept."""
    shape = [[-3e-4, 9e-7], [0, 0], [3e-4, 1.125e-6]]
    scene = scene_of("tables4_5", CLOSED | {
        "punch": {"profile": "table", "shape": shape, "load": ["270 N/mm", "50 N/mm"]},
        "output.quantities": ["sif"], "motion.c": [0.0, 0.1], "friction.mu_c": [0.1, 0.2, 0.3, 0.6],
    })  # fmt: skip
    monkeypatch.setattr(Plan, "chunk", 6)
    expected = Memory()
    reasons = compute(scene, expected, None)["verdict_reasons"]
    interrupted(scene, tmp_path / "a.h5", 30)
    found = Memory()
    with Journal(tmp_path / "a.h5", "key", resume=True) as journal:
        assert 0 < journal.states < len(expected["states/f"])
        assert compute(scene, found, None, journal)["verdict_reasons"] == reasons
    assert [*found["run/failures"]] == [*expected["run/failures"]] and len(found["run/failures"]) == 2
    h = found["states/closed_form/half_width"]
    np.testing.assert_array_equal(h, expected["states/closed_form/half_width"])
    assert 0 < np.isnan(h).sum() < len(h) / 2


def test_a_load_without_an_answer_leaves_the_others_theirs(tmp_path):
    """The contact of a rounded punch under the middle load ends next to where the flat part does."""
    changes = ALL | punch("rounded") | {
        "output.quantities": ["sif"], "output.points": None, "motion.X_over_L": [1.0],
        "solve.tolerance": 1e-3, "friction.mu_c": 1e-9, "motion.c": 0.0,
    }  # fmt: skip
    narrow = computed("tables4_5", changes | CLOSED | {"punch.load": [1.0, 1e3, 1e5]})
    a = narrow.data["states/closed_form/half_width"]
    assert 1.0 < a[0] / 1e-4 < 1.02 < a[1] / 1e-4
    found = computed("tables4_5", changes | {"punch.load": [1e5, 1.0, 1e3]})
    (failure,) = found.data["run/failures"]
    assert failure.startswith("c = 0: N = 1 N/m: ") and found.verdict == "FAIL"
    h = found.data["states/fem/half_width"]
    np.testing.assert_allclose(h[[0, 2]], a[[2, 1]], rtol=1e-3)
    assert np.isnan(h[1]) and not np.isnan(found.data["states/closed_form/half_width"]).any()
    shown = {column.head: column for column in found.table()}
    np.testing.assert_allclose(shown["half-width"].values, 1e6 * a[[2, 0, 1]], rtol=1e-3)
    assert shown["half-width"].unit == "µm" and np.isfinite(shown["peak pressure"].values).all()
    found.save(tmp_path / "a.h5")
    assert not faults(tmp_path / "a.h5")
    alone = computed("tables4_5", changes | {"punch.load": 1.0})
    assert alone.verdict == "PASS" and "states/fem/half_width" not in alone.data
    assert alone.data["states/closed_form/half_width"] == pytest.approx(a[0], rel=1e-12)
    with pytest.raises(BadInput, match=r"kinks.*closed_form takes it"):
        computed("tables4_5", changes | {"punch.load": 1.0, "solve.methods": ["fem"]})
