"""Where answers do not hold: zones at the edges, against values by hand; what is said of them."""

import json

import numpy as np
import pytest
from scipy.optimize import brentq
from support import computed, of_sections

import galinx
from galinx.postprocess.over_time import from_steady, times_near_steady
from galinx.postprocess.validity import Steady, Validity
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids import Isotropic
from galinx.solvers.transient.late_time import approach

SOLID = Isotropic(193e9, 0.25, 7860.0)
CLOSED = {"solve.methods": ["closed_form"]}


def along_surface(punch, X):
    """u,X on the surface from σ_XX by Hooke's law, not from the pressure."""
    κ, σ_YY = punch.response.κ, np.where(np.abs(X) < 1.0, punch.σ_YY(X), 0.0)
    return (punch.σ_XX(X) - (3.0 - κ) / (κ + 1.0) * σ_YY) * (κ + 1.0) / 8.0


@pytest.mark.parametrize("c, g", [(0.0, 0.0), (0.0, 0.7), (0.6, -0.5), (0.9, 0.3)])
@pytest.mark.parametrize("strain", [0.5, 5.0, 1e3])
def test_within_the_zones_the_surface_is_pressed_together_more(c, g, strain):
    punch = FlatPunch(SOLID.response(c), g)
    left, right = punch.compressed_within(strain)
    least = punch.α - punch.β  # where the pressure is least
    for end, width in ((-1.0, left), (1.0, right)):
        if -along_surface(punch, least) >= strain:
            np.testing.assert_allclose(width, abs(end - least), rtol=1e-12)
        elif width > 1e-6:  # nearer, X has not its digits
            there = along_surface(punch, end - np.sign(end) * width)
            np.testing.assert_allclose(-there, strain, rtol=1e-8)
    assert left > 0.0 and right > 0.0


@pytest.mark.parametrize(
    "ν, c, g",
    [(0.5, 0.0, 0.7), (0.25, 0.9, -0.4), (0.3, 0.93, 0.4), (0.45, 0.3, 0.0), (0.25, 0.5, 1000.0)],
)
@pytest.mark.parametrize("strain", [0.02, 0.5, 50.0])
def test_outside_the_zones_of_large_strain_the_surface_is_strained_less(ν, c, g, strain):
    """Under the punch and beside it, beyond the Rayleigh speed, too; on the border it is that strain."""
    punch = FlatPunch(Isotropic(1.0, ν, 1.0).response(c), g)
    for sign, d in zip((-1.0, 1.0), punch.strained_within(strain)):
        end, other = (punch.α, punch.β)[:: int(sign)]
        least = 2.0 * end / (end + other)  # distance of the least pressure
        largest = []
        for side in (1.0, -1.0):
            X = sign * (1.0 + side * d * np.array([1.0, 1.0 + 1e-6, 1.3]))
            if side < 0.0 and d * 1.3 >= least:
                continue
            u_X = np.abs(along_surface(punch, X))
            assert (u_X[1:] <= strain * (1.0 + 1e-9)).all()
            largest.append(u_X[0])
        assert max(largest) == pytest.approx(strain, rel=1e-6) or d >= 0.7 * least


def test_states_have_their_speed_and_their_wave_crossings():
    data = computed("tables4_5", CLOSED | {"motion.c": [0.0, 0.3, 0.6]}).data
    c, L, a = data["states/c"], 1e-4, 1e-3
    np.testing.assert_allclose(data["states/speed"], c * np.sqrt(193e9 / 2.5 / 7860.0), rtol=1e-14)
    assert np.isnan(data["states/wave_crossings"][c == 0.0]).all()
    moving = c > 0.0
    np.testing.assert_allclose(data["states/wave_crossings"][moving], L / (2 * a * c[moving]), rtol=1e-14)


def test_wave_crossings_are_of_the_contact_of_each_state():
    """At 0.9 c_s it is three times as wide as at rest; where there is none there are no crossings."""
    shape = [[-0.002, 4e-5], [0, 0], [0.002, 4e-5]]
    punch = {"profile": "table", "shape": shape, "load": ["20 N/mm", "1200 N/mm"]}
    data = computed("tables4_5", CLOSED | {"punch": punch, "motion.c": [0.1, 0.9]}).data
    a, c = data["states/closed_form/half_width"], data["states/c"]
    found, widths = data["states/wave_crossings"], [a[c == at][0] for at in (0.9, 0.1)]
    assert widths[0] / widths[1] > 2.0 and 0 < np.isnan(a).sum() < len(a)
    np.testing.assert_allclose(found, 1e-4 / (2.0 * a * c), rtol=1e-14)


def told(changes):
    return json.loads(computed("tables4_5", CLOSED | changes).attributes["warnings"])


def test_the_studys_fast_strokes_are_warned_about_and_its_slow_ones_are_not():
    (warning,) = told({})
    assert "crosses the contact 0.083 times at the least, and less than 30 times in 6 states" in warning
    assert not told({"motion.c": 4.786e-7}) and not told({"motion.c": 0.0})


@pytest.mark.parametrize("method", ["closed_form", "sie"])
def test_a_load_that_no_linear_solid_carries_is_told(method):
    soft = {
        "motion.c": 0.0, "solid.E": "1 MPa", "punch.load": "500 N/m", "solve.methods": [method],
        "motion.strokes": ["forward"], "solve.tolerance": 1e-2,
    }  # fmt: skip
    usual, slip, strain = told(soft)
    data = computed("tables4_5", CLOSED | soft).data
    widest = max(data[f"states/closed_form/slip_reversed_{side}"].max() for side in ("left", "right"))
    assert slip.startswith(f"slip has turned round up to {widest:.3g} a from an edge, beyond 0.01 a in")
    assert "strains are beyond 5 % up to" in strain and "mean pressure" in usual


def test_the_zones_are_those_of_the_load():
    """1 + u,X with the load's own size: twice the load at the same place, half the strain."""
    data = computed("tables4_5", CLOSED | {"motion.c": 0.0, "friction.mu_c": 1e-9}).data
    ε = 55.3e3 / 2e-3 / (193e9 / 2.5)
    q = SOLID.response(0.0).q
    width = 1.0 - brentq(lambda X: ε * q * 2.0 / np.pi / np.sqrt(1.0 - X**2) - 0.05, 0.9, 1.0 - 1e-9)
    np.testing.assert_allclose(data["states/closed_form/large_strain_left"], width, rtol=1e-4)


def test_tension_and_its_place_are_told():
    pressure = [[-1, 0], [0, -2], [0.52, 0.25], [1, 0]]  # a knot where the surface has a place
    result = computed(
        "tables4_5",
        CLOSED | {"motion.c": 0.0, "solve.mode": "traction", "solve.pressure": pressure},
    )
    data = result.data
    np.testing.assert_allclose(data["states/closed_form/tension"], 0.25, rtol=1e-2)
    np.testing.assert_allclose(data["states/closed_form/tension_X_over_a"], 0.52, atol=0.02)
    (warning,) = json.loads(result.attributes["warnings"])
    assert warning.startswith("the punch would have to pull, by up to 0.25 N/(2a), at X/a = 0.5")


@pytest.mark.parametrize(
    "crossings, said", [(2.9, "does not reach; "), (3.1, "comes near only towards its end; ")]
)
def test_a_stroke_that_outlasts_the_start_is_not_said_to_miss_steady_motion(crossings, said):
    validity = Validity(Steady(lambda c, g: 6.0, 1e-6))
    validity.see(
        {
            "states/c": np.array([0.01]),
            "states/g": np.zeros(1),
            "states/wave_crossings": np.array([crossings]),
        }
    )
    (text,) = validity.words()
    assert f"a limit that such a stroke {said}from rest it takes 6 a/c_s" in text


#: Solid, its angle, thresholds of the positive and the negative direction (None: above 2), and whether
#: waves grow under a friction of either sign.
FLUTTER = [
    ("carbon-epoxy", 90, (0.37191991, 0.37191991), {0.36: (False, False), 0.38: (True, True)}),
    ("copper", 30, (0.46258727, None), {0.5: (False, True)}),
    ("copper", -30, (None, 0.46258727), {0.5: (True, False)}),
]


@pytest.mark.parametrize("material, angle, thresholds, flutters", FLUTTER)
def test_the_threshold_of_flutter_is_that_of_the_solid_and_of_the_sign(
    material, angle, thresholds, flutters
):
    """Carbon fibres across the motion bear a third of the friction that isotropic solids do."""
    for μ, of_signs in flutters.items():
        for sign, flutter in zip(("physical", "eq25"), of_signs):
            changes = {
                "solid.material": material, "solid.angle": f"{angle} deg", "motion.c": 0.0,
                "friction.model": "coulomb", "friction.mu_c": μ, "friction.sign": sign,
                "motion.strokes": ["forward"],
            }  # fmt: skip
            result = computed("tables4_5", CLOSED | changes)
            for side, expected in zip(("positive", "negative"), thresholds):
                found = result.data[f"states/flutter_{side}"][0]
                assert found == pytest.approx(expected, abs=1e-8) if expected else found > 2.0
            warnings = json.loads(result.attributes["warnings"])
            assert any("flutter" in text for text in warnings) == flutter


def test_friction_along_the_contact_flutters_where_it_is_largest():
    """Short waves feel the friction of their place: 1.8 at one end, the mean is below the threshold 1."""
    scene = of_sections(
        solid={"material": "steel"}, friction={"along": [[-1, 0.1], [1, 1.8]]}, motion={"c": 0.6},
        output={"quantities": ["surface"]}, solve={"methods": ["closed_form"]},
    )  # fmt: skip
    result = galinx.compute(scene)
    assert result.data["states/g_largest"].tolist() == [-1.8]
    (warning,) = (text for text in json.loads(result.attributes["warnings"]) if "flutter" in text)
    assert warning.startswith("|σ_XY/σ_YY| is up to 1.8, not below the flutter threshold, 1, in 1 state")


def test_strokes_are_held_against_the_time_that_steady_motion_takes():
    """The study's fast stroke lasts a thousandth of it; one of 40 crossings at 0.9 c_s is too short."""
    result = computed("tables4_5", CLOSED | {"motion.c": 0.6})
    (warning,) = (text for text in json.loads(result.attributes["warnings"]) if "1 %" in text)
    solid, g = result.scene.solid, np.abs(result.data["states/g"]).max()
    assert f"takes {approach(solid, 0.6, -g).within(0.01):.3g} a/c_s" in warning
    assert "the stroke lasts 0.167 a/c_s" in warning
    steady = Steady(lambda c, g: 100.0 * c, 1e-6)
    fast, slow = Validity(steady), Validity(steady)
    fast.see({"states/wave_crossings": np.array([40.0, 1e6]), "states/c": np.array([0.9, 0.1]),
              "states/g": np.zeros(2)})  # fmt: skip
    slow.see({"states/wave_crossings": np.array([40.0]), "states/c": np.array([0.7]),
              "states/g": np.zeros(1)})  # fmt: skip
    assert [*fast.words()] == [
        "the steady state is reported, but from rest it takes 90 a/c_s (90 µs) to come within 1 % of "
        "it, at c = 0.9, and the stroke lasts 80 a/c_s (80 µs)"
    ]
    assert [*slow.words()] == []


def test_times_are_found_between_steps_and_told_like_1_over_t_beyond():
    t = np.linspace(0.1, 40.0, 400)
    load = np.clip(t / 2.0, 0.0, 1.0)  # as if it came on at once at t = 1
    off = np.array([2.0 / np.maximum(t - 1.0, 0.1), 0.05 * np.exp(-t)])
    found = times_near_steady(t, load, off)
    np.testing.assert_allclose(found[0], [21.0, 201.0, 2001.0], rtol=1e-3)
    np.testing.assert_allclose(found[1], [t[0], np.log(5.0), np.log(50.0)], rtol=1e-2)


def test_what_does_not_fall_like_1_over_t_yet_is_not_told():
    """Short of its steady lean, past it, or on the way through it: nothing is known of later times."""
    t = np.linspace(0.1, 8.0, 80)
    load = np.clip(t / 3.0, 0.0, 1.0)
    off = np.array([0.6 - 0.02 * t, 0.3 + 0.0 * t, 0.5 - t / 25.0])
    assert np.isnan(times_near_steady(t, load, off)).all()


def test_steady_motion_is_that_under_the_last_load():
    """Half of N is left: with half of K_I motion is steady, and times are from when it had come on."""
    data = {
        "time/steady_K_I": np.array([0.3]), "time/steady_centre": np.array([-0.1]),
        "time/sie/K_I_left": np.array([[0.3, 0.15]]), "time/sie/K_I_right": np.array([[0.33, 0.165]]),
        "time/sie/centre_of_pressure": np.array([[-0.1, -0.1]]), "time/load": np.array([1.0, 0.5]),
    }  # fmt: skip
    np.testing.assert_allclose(from_steady(data, "sie"), [[1.2, 0.1]], rtol=1e-12)
    t = np.linspace(0.01, 40.0, 4000)
    load = np.where(t < 2.0, 0.0, np.where(t < 4.0, 1.0, 0.5))
    off = 1.0 / np.maximum(t, 0.1)[None]  # (1 × 2 - 0.5 × 4)/0.5 = 0: as if it came on then
    np.testing.assert_allclose(times_near_steady(t, load, off)[0, 1], 100.0, rtol=2e-3)
