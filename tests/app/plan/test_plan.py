"""What is planned of a scene, skipped, warned of and refused; which state is which; speeds of a fit."""

from itertools import pairwise

import numpy as np
import pytest
from random_solids import random_solid
from support import of_sections

from galinx import template
from galinx.app.errors import BadInput
from galinx.app.plan.plan import lines, make_plan
from galinx.app.plan.states import Order, enumerate_states
from galinx.solvers.contact.fem_plan import LEAST, swept, variable
from galinx.solvers.solids import Isotropic

CLOSED = {"solve.methods": ["closed_form"], "output.quantities": ["friction", "sif"]}
WEDGE = {"punch.profile": "wedge", "punch.half_width": None, "punch.slope": 0.005}


def test_starts_come_in_the_order_of_the_states():
    """They were sorted by σ_XY/σ_YY: the first start was the last state."""
    motion = {"motion.c": 0.4, "motion.speed": None, "friction.mu_c": [0.2, 0.5, 0.1]}
    in_time = {"time.end": 2.0, "output.quantities": ["time"], "solve.tolerance": 1e-3}
    starts = make_plan(template("coating", motion | in_time)).starts
    assert [drive.constant for drive in starts.drives[0.4]] == [-0.2, -0.5, -0.1]


@pytest.mark.parametrize(
    "end, every, step",
    [(4, 0.5, None), (4, 0.5, 0.1), (4, 0.5, 0.03), (4, 0.5, 1.0), (1, 0.3, None), (10, 4.0, None)],
)
def test_the_surface_is_given_at_the_times_asked_for_at_any_step(end, every, step):
    """Steps of 0.1 gave it at 0.4, 1, 1.6, 2 and so on: only after two steps, of which 0.5 has five."""
    in_time = {"time.end": end, "time.every": every, "time.step": step, "output.quantities": ["time"]}
    starts = make_plan(template("start_from_rest", in_time)).starts
    expected = every * np.arange(1, int(end / every + 1e-9) + 1)
    assert starts.times()[starts.outputs - 1] == pytest.approx(expected, rel=1e-12)
    assert starts.end == pytest.approx(end, rel=1e-12)


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"friction.mu_c": 40}, "friction.mu_c = 40 is unusual, usual is 0.0001 to 10"),
        ({"punch.half_width": 1}, "punch.half_width = 1 m is unusual, usual is 1e-09 to 0.5"),
        (
            {"punch.load": "1.55e9 N/m"},
            "mean pressure N/(2a) = 7.75e+11 Pa is 10 times the shear modulus",
        ),
    ],
)
def test_what_is_unusual_is_warned_of(changes, message):
    (warning,) = make_plan(template("tables4_5", CLOSED | changes)).warnings
    assert message in warning


def test_what_is_unusual_of_layers_is_warned_of():
    solids = {"solid.rho": 7.8, "layer[0].yield_strength": 600.0, "layer[0].thickness": 1000.0}
    changes = {"solve.methods": ["sie"], "solid.material": "steel"} | solids
    warnings = " ".join(make_plan(template("coating", changes)).warnings)
    for key in ("solid.rho", "layer[0].yield_strength", "layer[0].thickness"):
        assert f"{key} = " in warnings


def test_a_punch_that_rolls_past_the_plate_slips_backward():
    rolling = {"motion.c": None, "motion.speed": [1000.0, 2000.0], "punch.solid.speed": 1200.0}
    (warning,) = make_plan(template("elastic_punch", CLOSED | rolling)).warnings
    assert warning.startswith("punch.solid.speed = 1200 m/s is above the speed over the plate, 1000 m/s")
    for other in ({"punch.solid.speed": 1000.0}, {"friction.sign": "eq25"}, {"friction.mu": 0.0}):
        assert not make_plan(template("elastic_punch", CLOSED | rolling | other)).warnings


@pytest.mark.parametrize("end, warned", [(3.2, True), (0.5, False)])
def test_friction_too_fast_for_finite_elements_in_time_is_warned_of(end, warned):
    """After a turn the friction of this law changes by λ c a 2^δ = 2.1 within 1 a/c_s at first."""
    law = {"mu_c": 0.5, "sigma0_over_load": 3000.0, "delta": 0.5, "pre_sliding": 1e-3}
    motion = {"c": 0.5, "strokes": ["backward", {"to": 0.4}, "backward"], "X_over_L": [0.5]}
    time = {"end": end, "friction": "law", "start": "steady"}
    scene = of_sections(
        solid={"E": 200e9, "nu": 0.25, "rho": 7800.0}, punch={"half_width": 1e-3, "load": 55300.0},
        friction=law, motion=motion, time=time, solve={"methods": ["fem"], "tolerance": 1e-3},
        output={"quantities": ["time"]},
    )  # fmt: skip
    warnings = [text for text in make_plan(scene).warnings if "friction changes by 2.1" in text]
    assert len(warnings) == warned


def test_keys_of_finite_elements_that_solve_nothing_are_warned_of():
    (warning,) = make_plan(
        template("tables4_5", CLOSED | {"solve.degree": 4, "solve.sweep": "every"})
    ).warnings
    assert warning.startswith("solve.degree, solve.sweep: without effect")


def test_the_plan_skips_what_is_not_asked_for():
    friction = make_plan(template("tables4_5", {"output.quantities": ["friction"]}))
    assert not (friction.fem or friction.methods or friction.quantities)
    closed = make_plan(template("tables4_5", {"solve.methods": ["closed_form"]}))
    assert closed.methods == ("closed_form",) and closed.fem is None
    assert not any(quantity.method == "fem" for quantity in closed.quantities)
    assert any("mesh and finite elements" in text for text in closed.skipped)
    scene = template("tables4_5", {"output.quantities": ["friction", "sif"]})
    assert not make_plan(scene).asks("surface")
    assert not any("surface" in text for text in lines(make_plan(scene)))
    graded = make_plan(template("tables4_5", WEDGE | {"solve.mesh": "graded"}))
    assert any("such a contact needs meshes of its own" in text for text in graded.skipped)
    steep = make_plan(template("tables4_5", WEDGE | {"punch.slope": 1.5}))
    assert any("punch.slope = 1.5" in text for text in steep.warnings)


def test_the_closed_form_beyond_the_rayleigh_speed_is_formal():
    scene = template("tables4_5", {"motion.c": 0.95, "solve.methods": ["closed_form"]})
    assert any("formal" in warning for warning in make_plan(scene).warnings)


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"motion.c": 0.918}, "within 1 % of the Rayleigh speed c_R = 0.919402"),
        ({"solve.mesh": "box"}, "boundary of the box mesh alone costs about 0.01"),
    ],
)
def test_what_will_cost_accuracy_is_warned_of(changes, message):
    (warning,) = make_plan(template("tables4_5", changes)).warnings
    assert message in warning


@pytest.mark.parametrize("sign, ratio", [("physical", -1.0), ("eq25", 1.0)])
def test_the_sign_of_friction_is_that_of_the_traction(sign, ratio):
    """A punch that goes forward drags the surface along: σ_XY has the sign of -σ_YY f."""
    states = enumerate_states(template("tables4_5", {"friction.sign": sign}))
    f = states.columns["f"]
    assert (f > 0.0).any() and (f < 0.0).any()
    assert list(states.g) == list(ratio * f)


def test_every_state_lies_on_its_archived_loop():
    changes = {"friction.mu_c": [0.3, 0.7], "motion.X_over_L": [0.0, 0.5, 1.0]}
    states = enumerate_states(template("tables4_5", changes))
    loops, travel, loop = (states.others[f"loops/{name}"] for name in ("f", "X_over_L", "of_state"))
    assert loops.shape == (2, 3 * 101) and len(travel) == 303
    for i in range(len(states)):
        stroke = ["FM1", "BM1", "FM2"].index(states.columns["motion"][i])
        here = slice(101 * stroke, 101 * (stroke + 1))
        at = np.argmin(np.abs(travel[here] - states.columns["X_over_L"][i]))
        f = loops[loop[i], here][at]
        assert f == pytest.approx(states.columns["f"][i], rel=1e-14)


def test_of_thousands_of_speeds_few_are_looked_at_and_named(monkeypatch):
    asked, response = [], Isotropic.response
    monkeypatch.setattr(Isotropic, "response", lambda self, c: asked.append(c) or response(self, c))
    speeds = np.random.default_rng(0).permutation(np.linspace(0.0, 0.999, 5000)).tolist()
    scene = template("tables4_5", CLOSED | {"motion.c": speeds})
    formal, near = make_plan(scene).warnings
    assert len(asked) < 100
    assert formal.startswith("c = 0.919464, 0.919664, ") and ", … 0.999 (399 in all) is not" in formal
    assert near.startswith("c = 0.910") and "within 1 %" in near and len(formal + near) < 500
    with pytest.raises(BadInput, match=r"\(399 in all\) is not below") as caught:
        make_plan(template("tables4_5", {"motion.c": speeds}))
    assert len(str(caught.value)) < 500


@pytest.mark.parametrize("seed", range(40))
def test_every_state_has_its_speed_and_its_load(seed):
    rng = np.random.default_rng(seed)
    speeds, loads, laws, places = rng.integers(1, 5, 4).tolist()
    own = rng.choice(
        [np.nan, 0.5, 0.6, 0.1], places, p=rng.choice([[1.0, 0, 0, 0], [0.4, 0.2, 0.2, 0.2]])
    )
    given = tuple((0.1 * np.arange(1, speeds + 1)).tolist())
    N = tuple(rng.permutation(np.arange(1.0, loads + 1)).tolist())
    order = Order(given, N, laws, own)
    expected = [
        (c if np.isnan(at) else at, load)
        for c in given for load in N for _ in range(laws) for at in own
    ]  # fmt: skip
    assert len(order) == len(expected)
    assert list(zip(order.c, np.array(N)[order.numbers[1]])) == expected
    # Every state is in one run of one speed, and each speed is met first in this order.
    assert order.speeds == tuple(dict.fromkeys(c for c, _ in expected))
    seen = []
    for c, runs in zip(order.speeds, order.runs(), strict=True):
        rows = [row for run in runs for row in range(run.start, run.stop)]
        assert rows == sorted(rows) and {expected[row][0] for row in rows} == {c}
        assert all(after.start > before.stop for before, after in pairwise(runs))
        seen += rows
    assert sorted(seen) == list(range(len(order)))


ISOTROPIC = Isotropic(E=1.0, ν=0.25, ρ=1.0)


def responses(solid, count, most=0.95):
    return [solid.response(c) for c in np.linspace(0.0, most * solid.limit(), count)]


def test_few_speeds_are_solved_each_and_many_on_demand():
    g = np.linspace(-0.5, 0.3, 40)
    assert swept("auto", responses(ISOTROPIC, LEAST - 1), g) is None
    assert swept("every", responses(ISOTROPIC, 100), g) is None
    assert swept("auto", 100 * responses(ISOTROPIC, 2), g) is None  # the same over and over
    sweep = swept("auto", responses(ISOTROPIC, LEAST), g)
    assert len(sweep.z) == LEAST and sweep.g.tolist() == [-0.5, 0.3] and not sweep.few


@pytest.mark.parametrize("seed", range(12))
def test_the_variable_tells_speeds_of_any_solid_apart(seed):
    solid = random_solid(seed)
    for most in (0.99, 0.3, 1e-3, 1e-7):
        z = variable(responses(solid, 50, most))
        assert np.all(np.diff(z) > 0.0)
