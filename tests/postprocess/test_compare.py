import json

import numpy as np
import pytest

from galinx.postprocess import compare

X = np.array([-1.5, -0.5, 0.0, 0.5, 1.5])
EXACT = np.array([[2.0, -1.0, -1.0, -1.0, 4.0]])
INSIDE = np.array([[-0.5, 0.2]])
METHODS = ("closed_form", "fem")
PRESSURE = np.array([[np.nan, -1.0, -2.0, -1.0, np.nan]])


def archive(**changes):
    data = {
        "states/g": np.array([0.5]),
        "states/alpha": np.array([-0.4]),
        "states/beta": np.array([-0.6]),
        "states/closed_form/K_I_left": np.array([0.3]),
        "states/closed_form/K_I_right": np.array([0.3]),
        "states/fem/normal_force": np.array([-10.0]),
        "states/fem/tangential_force": np.array([-5.0]),
        "states/fem/K_I_left": np.array([0.3]),
        "states/fem/K_I_right": np.array([0.3]),
        "states/fem/alpha": np.array([-0.4]),
        "states/fem/beta": np.array([-0.6]),
        "states/fem/estimate": np.array([0.0]),
        "states/fem/slope_under_punch": np.array([0.0]),
        "surface/X_over_a": X,
        "surface/closed_form/sigma_XX": EXACT,
        "surface/closed_form/sigma_YY": PRESSURE,
        "surface/fem/sigma_XX": EXACT,
        "surface/fem/sigma_YY": PRESSURE,
        "surface/fem/sigma_YY_raw": PRESSURE,
        "states/fem/estimate_sigma_XX": np.array([0.0]),
        "states/fem/estimate_inside": np.array([0.0]),
        "interior/X_over_a": np.array([0.0, 3.0]),
        "interior/Y_over_a": np.array([-1.0, -1.0]),
        **{f"interior/{method}/sigma_{ij}": INSIDE for method in METHODS for ij in ("XX", "YY", "XY")},
    } | changes
    return compare.comparisons(data, 10.0, compare.RULES)


def test_what_agrees_is_zero():
    found = archive()
    assert len(found) == 10 and max(found.values()) == 0.0


@pytest.mark.parametrize(
    "path, value, name, wanted",
    [
        ("states/fem/normal_force", [-10.1], "force balance", 0.01),
        ("states/fem/tangential_force", [5.0], "force balance", 1.0),
        ("states/fem/K_I_left", [0.27], "K_I", 0.1),
        ("states/fem/K_I_right", [0.33], "K_I", 0.1),
        ("states/fem/estimate", [0.1, 0.0], "estimate", 0.1),
        ("states/fem/estimate_sigma_XX", [0.1], "estimate of sigma_XX", 0.1),
        ("states/fem/estimate_inside", [0.1], "estimate inside", 0.1),
        ("states/fem/alpha", [-0.38], "exponents", 0.02),
        ("states/fem/beta", [-0.62], "exponents", 0.02),
        ("states/fem/slope_under_punch", [0.1], "slope under the punch", 0.1),
        ("surface/fem/sigma_YY", [[np.nan, -1.0, -2.2, -1.0, np.nan]], "sigma_YY", 0.1),
        ("interior/fem/sigma_XY", [[-0.5, 0.25]], "stresses inside", 0.1),
        ("surface/fem/sigma_XX", [[2.4, -1.0, -1.0, -1.0, 4.0]], "sigma_XX", 0.1),
    ],
)
def test_what_disagrees_is_measured(path, value, name, wanted):
    found = archive(**{path: np.array(value)})
    assert found[name] == pytest.approx(wanted)
    assert sum(found.values()) == pytest.approx(wanted)


def both(path, value):
    """The same dataset of both methods."""
    return {path.format(method): value for method in METHODS}


#: A wedge's state: its pressure is infinite at the tip, 0.
FOUND_ENDS = (
    {"states/closed_form/largest_pressure": [np.nan], "states/fem/largest_pressure": [np.nan]}
    | both("states/{}/half_width", [2e-3]) | both("states/{}/centre", [1e-3])
)  # fmt: skip
#: A larger stress at X = 0, which is the tip, and another place for that one.
AT_TIP = FOUND_ENDS | both("surface/{}/sigma_YY", [[np.nan, -1.0, -9.0, -1.0, np.nan]]) | {
    "surface/fem/sigma_XX": EXACT + 0.4 * (X == 0.0)
}  # fmt: skip
NEXT_TO_END = AT_TIP | {"surface/X_over_a": np.where(X == 0.0, 0.99, X)}
LARGEST = both("states/{}/von_mises", [4.0]) | both("states/{}/max_shear", [2.5])
GIVEN = {"states/closed_form/normal_force": [-8.0]}
#: Of two interfaces, each over the largest along it.
_SIZES = {"sigma_YY": 2.0, "sigma_XY": 1.0, "sigma_XX_above": 4.0, "sigma_XX_below": 0.5}
_ALONG = np.array([[[0.1, -1.0, 0.3], [0.01, 0.02, -0.1]]])
INTERFACES = {
    f"interfaces/{by}/{name}": top * _ALONG for by in ("fem", "sie") for name, top in _SIZES.items()
}


def at_interface(name):
    """One in-plane stress at the lower interface is off by 0.01."""
    path = f"interfaces/fem/sigma_XX_{name}"
    return INTERFACES | {path: INTERFACES[path] + [[[0.0, 0.0, 0.0], [0.0, 0.01, 0.0]]]}


def largest_over_layers(fem):
    """Of two states; a stress that one method does not know is no agreement."""
    return {"states/fem/von_mises": [4.0, fem], "states/sie/von_mises": [4.0, 4.0]}


@pytest.mark.parametrize(
    "changes, name, wanted",
    [
        # Where the pressure is small a tenth of the mean is its size.
        ({f"surface/{by}/sigma_YY": [[np.nan, -1.0, σ, -1.0, np.nan]]
          for by, σ in zip(METHODS, (-0.02, -0.04))}, "sigma_YY", 0.2),
        (FOUND_ENDS, "sigma_YY of found ends", 0.0),
        (FOUND_ENDS | {"surface/fem/sigma_YY": [[np.nan, -1.0, -9.0, -1.0, np.nan]]},
         "sigma_YY of found ends", 0.0),
        (FOUND_ENDS | {"surface/fem/sigma_YY": [[np.nan, -1.2, -2.0, -1.0, np.nan]]},
         "sigma_YY of found ends", 0.2),
        (AT_TIP, "sigma_XX", 0.0),
        (NEXT_TO_END, "sigma_XX", 0.1),
        (FOUND_ENDS | {"states/fem/half_width": [1.9e-3]}, "ends", 0.05),
        (FOUND_ENDS | {"states/fem/centre": [1.1e-3]}, "ends", 0.05),
        (LARGEST, "largest stresses", 0.0),
        (LARGEST | {"states/fem/von_mises": [3.0]}, "largest stresses", 0.25),
        (LARGEST | {"states/fem/max_shear": [3.0]}, "largest stresses", 0.2),
        (largest_over_layers(4.0), "largest stresses over layers", 0.0),
        (largest_over_layers(3.0), "largest stresses over layers", 0.25),
        (largest_over_layers(np.nan), "largest stresses over layers", np.nan),
        # Nodal forces against the resultant of a pressure that is put in.
        (GIVEN | {"states/fem/normal_force": [-8.0], "states/fem/tangential_force": [-4.0]},
         "resultant", 0.0),
        (GIVEN | {"states/fem/normal_force": [-9.0], "states/fem/tangential_force": [-4.0]},
         "resultant", 0.1),
        (GIVEN | {"states/fem/normal_force": [-8.0], "states/fem/tangential_force": [-3.0]},
         "resultant", 0.1),
        (at_interface("above"), "stresses at interfaces", 0.025),
        # There the traction is larger than the in-plane stress.
        (at_interface("below"), "stresses at interfaces", 0.05),
    ],
)  # fmt: skip
def test_each_rule_has_its_measure(changes, name, wanted):
    found = archive(**{path: np.array(value) for path, value in changes.items()})
    assert found[name] == pytest.approx(wanted, nan_ok=True)


def test_a_formula_has_tension_by_rounding_and_nodal_forces_have_it_or_not():
    found = archive(**{f"states/{method}/tension": np.array([1e-13]) for method in ("fem", "sie")})
    assert found["tension"] == 1e-13 and found.get("tension, sie") is None


#: Rules whose limit is another than the tolerance, with it at tolerances of 1e-6 and 1e-3.
LIMITS = {
    "force balance": (1e-9, 1e-9), "resultant": (1e-9, 1e-9), "resultant over layers": (1e-9, 1e-9),
    "finite": (0.0, 0.0), "tension": (0.0, 0.0),
    "residual": (1e-8, 1e-8), "residual inside": (1e-8, 1e-8),
    "residual of finite elements": (1e-5, 1e-2), "slope under the punch": (1e-5, 1e-2),
    "sigma_YY of found ends": (1e-5, 1e-2), "sigma_YY of found ends over layers": (1e-5, 1e-2),
    "exponents": (None, None), "ends over time": (None, None),
}  # fmt: skip


@pytest.mark.parametrize("name", compare.RULES)
def test_a_rule_allows_the_tolerance_or_what_is_said_of_it(name):
    for tolerance, wanted in zip((1e-6, 1e-3), LIMITS.get(name, (1e-6, 1e-3))):
        assert compare.RULES[name].allowed(tolerance) == pytest.approx(wanted, rel=1e-12)


def test_failures_are_told_by_how_much_they_exceed_their_limits():
    """The worst first, and the tolerance that would accept it, where one would."""
    rules = compare.RULES
    told = {
        rules[name].text: value for name, value in (("K_I", 4e-6), ("estimate", 3e-5), ("residual", 2e-6))
    }
    reasons = [
        f"{text}: {value:.1e}, at most {1e-8 if 'closed form' in text else 1e-6:.0e}"
        for text, value in told.items()
    ]
    attributes = {"comparisons": json.dumps(told), "verdict_reasons": json.dumps(reasons)}
    attributes |= {"verdict": "FAIL", "load": 1.0}
    data = {"states/c": np.array([0.1, 0.2]), "states/f": np.array([0.3, 0.3])}
    data |= {"states/fem/estimate": np.array([1e-9, 3e-5])}
    residual, first, second, last = compare.failed(data, attributes)
    assert "2e-06, 200 times what is wanted, 1e-08" in residual
    text = rules["estimate"].text
    assert first.startswith(f"{text}: 3e-05, 30 times what is wanted, 1e-06, in state 1 (c = ")
    assert "4e-06, 4 times" in second
    assert "solve.tolerance=1e-07 may pass" in last and "accepts" not in last  # a residual has its own
    fixed = rules["residual"].text
    less = {name: json.dumps([r for r in json.loads(attributes[name]) if not r.startswith(fixed)])
            for name in ("verdict_reasons",)}  # fmt: skip
    *_, last = compare.failed(data, attributes | less)
    assert last.endswith("; 1e-04 accepts it")
    for scene, warnings, told in (
        ("degree = 4", "", "leave solve.degree away"),
        ('mesh = "uniform"', "", "leave solve.mesh away"),
        ('mesh = "confocal"', "1e-05 would remain on any cells", "no finer solve.tolerance"),
    ):
        of_scene = {"scene/text": f"[solve]\n{scene}", **data}
        *_, last = compare.failed(of_scene, attributes | less | {"warnings": json.dumps([warnings])})
        assert told in last and last.endswith("; 1e-04 accepts it")
    *_, last = compare.failed(data, attributes | {"verdict_reasons": json.dumps(reasons[-1:])})
    assert "no solve.tolerance changes this" in last
    assert compare.failed({}, attributes | {"verdict": "PASS"}) == []
    told = compare.checked({}, attributes)
    assert "agree to 4e-06, estimated error 3e-05, residual 2e-06, wanted 1e-06" in told


def test_the_worst_state_is_measured_under_its_own_load():
    text = compare.RULES["force balance"].text
    data = {
        "states/c": np.array([0.1, 0.2]), "states/f": np.zeros(2), "states/g": np.zeros(2),
        "states/load": np.array([10.0, 20.0]), "states/fem/normal_force": np.array([-10.0, -19.0]),
        "states/fem/tangential_force": np.zeros(2),
    }  # fmt: skip
    attributes = {"comparisons": json.dumps({text: 0.05}), "verdict": "FAIL", "load": 10.0}
    attributes["verdict_reasons"] = json.dumps([f"{text}: 5.0e-02, at most 1e-09"])
    assert "in state 1 (c = 0.2, f = 0)" in compare.failed(data, attributes)[0]


def depths(exact, fem, **others):
    data = {f"states/{by}/yield_depth": np.array([d]) for by, d in (("closed_form", exact), ("fem", fem))}
    others = {f"states/{path}": np.array([value]) for path, value in others.items()}
    return compare.comparisons(data | others, 10.0, ["depth of yield"]).get("depth of yield")


def test_a_depth_of_yield_is_judged_as_a_stress():
    assert compare.RULES["depth of yield"].allowed(1e-3) == 1e-3
    # Stresses fall like the root of the distance from both edges.
    edges = {"fem/yield_reach_left": 0.1, "alpha": -0.5, "beta": -0.5}
    assert depths(0.04, 0.04 * 1.02, **edges) == pytest.approx(1.02**0.5 - 1.0)
    # σ = 1.2 - 0.8 (d - 0.5)² at depths d passes 1 at d = 1.
    below = {"closed_form/first_yield_load": 10.0 / 1.2, "closed_form/von_mises_Y_over_a": -0.5}
    assert 0.002 < depths(1.0, 1.01, **below) < 0.008
    assert depths(0.0, 0.0, **below) == 0.0
    # By one method it just does not yield: what is off is the stress above the strength, not the depth.
    below["closed_form/first_yield_load"] = 10.0 / 1.0001
    assert depths(0.5, 0.0, **below) == pytest.approx(np.log(1.0001), rel=1e-9)
    # Beside a jump of the pressure any load makes yield, and zones are minute.
    below["closed_form/first_yield_load"] = 0.0
    assert depths(0.0, 2e-6, **below) == pytest.approx(2e-6) and depths(0.5, 0.4, **below) > 0.05
    assert depths(np.nan, np.nan) is None
    assert depths(1.0, 1.02) == pytest.approx((0.02 / 1.02) ** 2)
