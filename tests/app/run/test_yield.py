"""Yield by both methods, from a scene to its archive; nothing of it unless it is asked for.

Of layers by dense sampling, and where they are of the solid below by what is known of that.
"""

import json

import numpy as np
import pytest
from support import THOROUGH, computed

from galinx.postprocess.quantities import layers as of_layers
from galinx.postprocess.quantities import stresses, yielding
from galinx.postprocess.quantities.states import HALF_WIDTH

#: Of the scene's states, the two with most and least friction; T302 yields at 205 MPa.
CHANGES = {
    "solid.material": "T302", "output.quantities": ["sif", "yield"], "solve.tolerance": 1e-5,
    "motion.c": 0.6, "motion.strokes": ["forward"],
}  # fmt: skip
OWN = {"solve.mode": "traction", "solve.pressure": [[-1, 0], [-0.5, -1], [0.2, -1.4], [1, 0]]}


@pytest.fixture(scope="module", params=["contact", "traction"])
def of_punch(request):
    return computed("tables4_5", CHANGES | {"solve.mode": request.param})


@pytest.fixture(scope="module")
def of_pressure():
    return computed("tables4_5", CHANGES | OWN | {"punch.load": "500 kN/m"})


def test_finite_elements_find_the_zone_at_the_edges_from_their_own_fields(of_punch):
    data = of_punch.data
    assert of_punch.verdict == "PASS", of_punch.attributes["verdict_reasons"]
    for name in ("yield_reach_left", "yield_reach_right", "yield_depth"):
        fem, exact = (data[f"states/{method}/{name}"] for method in ("fem", "closed_form"))
        np.testing.assert_allclose(fem, exact, rtol=1e-5)
        assert (fem != exact).all() and (exact > 1e-3).all()
    assert (data["states/fem/estimate_yield"] > 0.0).all()
    reasons = " ".join(json.loads(of_punch.attributes["verdict_reasons"]))
    assert "estimated error of stresses from which yield is computed" in reasons
    assert "distance from the edges within which yield is passed" in reasons


def test_sharp_edges_are_said_to_yield_at_any_load(of_punch):
    assert any("any load makes these yield" in text for text in of_punch.data["run/skipped"])
    assert not any("first_yield_load" in name or "von_mises" in name for name in of_punch.data)


def test_finite_elements_find_the_largest_stresses_below_a_pressure(of_pressure):
    data = of_pressure.data
    assert of_pressure.verdict == "PASS", of_pressure.attributes["verdict_reasons"]
    for name in ("von_mises", "max_shear", "first_yield_load", "yield_depth"):
        fem, exact = (data[f"states/{method}/{name}"] for method in ("fem", "closed_form"))
        np.testing.assert_allclose(fem, exact, rtol=1e-5)
    assert (data["states/fem/von_mises"] != data["states/closed_form/von_mises"]).all()
    load = 205e6 * 2e-3 / data["states/closed_form/von_mises"]  # by hand: N/(2a) times the largest
    np.testing.assert_allclose(data["states/closed_form/first_yield_load"], load, rtol=1e-12)
    assert not any("yield_reach" in name for name in data)


@pytest.mark.parametrize(
    "punch",
    [{"profile": "parabolic", "radius": 0.02}, {"profile": "power", "exponent": 3.0, "coefficient": 1e3}],
    ids=["parabola", "cube"],
)
def test_under_the_load_of_first_yield_the_largest_stress_is_the_strength(punch):
    """The contact grows with the load, each by a power of its own."""
    scene = CHANGES | {f"punch.{key}": value for key, value in punch.items()} | {
        "punch.half_width": None, "solve.methods": ["closed_form"], "motion.X_over_L": [0.7],
    }  # fmt: skip
    load = float(computed("tables4_5", scene).data["states/closed_form/first_yield_load"][0])
    data = computed("tables4_5", scene | {"punch.load": load}).data
    h, largest = (data[f"states/closed_form/{name}"] for name in ("half_width", "von_mises"))
    np.testing.assert_allclose(largest * load / (2.0 * h), 205e6, rtol=1e-6)


#: Zones that end between the places where stresses are sampled, of another branch, or a spot apart.
DEEP = {
    "two zones": ({"punch.profile": "parabolic", "punch.radius": 5e-3, "friction.mu": 0.7}, 1200),
    "a spot": ({
        "punch.profile": "parabolic", "punch.radius": 5e-3, "friction.mu": 0.3,
        "punch.solid": {"material": "aluminium"},
    }, 384),
    "beside a kink": ({
        "punch.profile": "rounded_flat", "punch.flat_half_width": 1e-4, "punch.radius": 5e-3,
        "friction.mu": 0.6,
    }, 600),
    "a pressure": (OWN | {"friction.mu": 0.6}, 45),
}  # fmt: skip


@pytest.mark.parametrize(("changes", "strength"), DEEP.values(), ids=DEEP)
def test_no_deeper_place_yields_and_the_deepest_does(changes, strength):
    scene = {
        "solid": {"material": "steel", "yield_strength": f"{strength} MPa"}, "motion": {"speed": "1 m/s"},
        "punch.load": "100 N/mm", "friction": {}, "solve.methods": ["closed_form"],
        "output.quantities": ["friction", "sif", "interior", "yield"],
        "output.map": {"X": [-1.5, 1.5, 151], "Y": [-0.8, -0.005, 160]},
    } | changes  # fmt: skip
    if "punch.radius" in changes:
        scene["punch.half_width"] = None
    data = computed("tables4_5", scene).data
    depth = data[yielding.DEPTH["closed_form"].path][0]
    half_width = data.get(HALF_WIDTH["closed_form"].path, [1e-3])[0]
    mises = next(row for row in stresses.INVARIANTS_INSIDE["closed_form"] if "von_mises" in row.path)
    over = data[mises.path][0] * 1e5 / (2.0 * half_width) / (strength * 1e6)
    Y = data[stresses.INSIDE_Y.path]
    assert 0.03 < depth < 0.7
    assert over[-depth - 1e-9 > Y].max() < 1.0
    assert over[(depth * 0.9 < -Y) & (depth > -Y)].max() > 0.99


@pytest.mark.filterwarnings("error")
def test_at_rest_an_incompressible_surface_is_not_strained_and_nothing_overflows():
    changes = {"solid.nu": 0.5, "motion.c": 0.0, "solve.methods": ["closed_form"]}
    data = computed("tables4_5", CHANGES | changes).data
    assert not data["states/closed_form/slip_reversed_left"].any()


STEEL = {"E": "210 GPa", "nu": 0.3, "rho": 7850}
TIN = {"E": "450 GPa", "nu": 0.25, "rho": 5220, "yield_strength": "4 GPa"}
LINE = {
    "solid": STEEL | {"yield_strength": "600 MPa"}, "friction": {"mu": [0.05, 0.2, 0.5]},
    "punch": {"profile": "parabolic", "radius": "5 mm", "load": "100 N/mm"},
    "motion": {"speed": "800 m/s"}, "output": None,
}  # fmt: skip


def coated(layer, thickness, changes=None):
    layers = [layer | {"thickness": thickness}]
    return computed("coating", LINE | {"solve": {"methods": ["sie"]}, "layer": layers} | (changes or {}))


@pytest.mark.parametrize("thickness", ["4 um", *["300 um"] * THOROUGH])
def test_layers_of_the_solid_itself_are_a_uniform_solid(thickness):
    layered = coated(STEEL, thickness).data
    exact = computed("coating", LINE | {"layer": None, "solve": {"methods": ["closed_form"]}}).data
    for rows, tolerance in (
        (yielding.VON_MISES, 2e-5), (yielding.VON_MISES_X, 2e-2), (yielding.VON_MISES_Y, 2e-2),
    ):  # fmt: skip
        held, expected = layered[rows["sie"].path], exact[rows["closed_form"].path]
        assert np.allclose(held, expected, rtol=0.0, atol=tolerance), rows["sie"].path


@pytest.mark.parametrize("thickness", ["5 um", *["100 um"] * THOROUGH])
def test_no_sample_is_larger_and_some_come_near(thickness):
    changes = {
        "solve.tolerance": 1e-5,
        "friction": {"mu": [0.05, 0.5]},
        "output.quantities": ["friction", "sif", "surface", "interfaces", "interior", "yield"],
        "output.map": {"X": [-2, 2, 41], "Y": [-3, -0.05, 60]},
    }
    data = coated(TIN, thickness, changes).data
    depth = data[of_layers.INTERFACE_DEPTH_IN_M.path][0] / data[HALF_WIDTH["sie"].path]
    Y = data[stresses.INSIDE_Y.path]
    mises = next(row for row in stresses.INVARIANTS_INSIDE["sie"] if "von_mises" in row.path)
    inside, held = data[mises.path], data[yielding.OF_LAYERS["sie"].path]
    for state, H in enumerate(depth):
        below = Y < -H
        assert inside[state, below].max() <= held[state, 1] * (1.0 + 1e-5)
        assert inside[state, ~below].max(initial=0.0) <= held[state, 0] * (1.0 + 1e-5)
        if data[yielding.OF_LAYERS_Y["sie"].path][state, 1] < -H - 0.05:
            assert inside[state, below].max() >= 0.995 * held[state, 1]
    whole = held.max(axis=1)
    assert np.array_equal(data[yielding.VON_MISES["sie"].path], whole)
    unit = 1e5 / (2.0 * data[HALF_WIDTH["sie"].path])
    share = held * unit[:, None] / np.array([4e9, 600e6])
    assert np.allclose(data[yielding.OVER_STRENGTH["sie"].path], share, rtol=1e-12)


def test_a_thin_layer_is_sampled_between_its_middle_and_both_faces():
    """It bends near the speed limit: there it bears less in its middle and at its faces than between."""
    layers = [
        {"thickness": 1e-4, "E": 5e10, "nu": 0.33, "rho": 4500},
        {"thickness": 4e-5, "E": 4e11, "nu": 0.22, "rho": 5000},
    ]
    points = np.column_stack([np.full(26, -0.82), np.linspace(-0.5, -0.4, 26)]).tolist()
    data = computed("coating", {
        "solid": {"E": 2e11, "nu": 0.3, "rho": 7850}, "layer": layers, "motion": {"speed": 1902.0},
        "punch": {"profile": "parabolic", "radius": 0.02, "load": 2e5}, "friction": {"mu": 0.0},
        "solve": {"methods": ["sie"], "tolerance": 1e-4},
        "output": {"quantities": ["sif", "yield", "interior"], "points": points},
    }).data  # fmt: skip
    largest = data["interior/sie/von_mises"][0].max()
    assert largest <= data["layers/sie/von_mises"][0, 1] <= 1.0001 * largest
    assert 1.002 * data["interior/sie/von_mises"][0, [0, -1]].max() < largest


def test_points_beside_an_interface_keep_their_layer_on_a_mesh_for_a_contact_near_by():
    """The half-width of the mesh is off by less than the tolerance; a depth of that would be too much."""
    scene = {
        "solid": {"E": 1e10, "nu": 0.3, "rho": 2000.0}, "friction": {"mu": 0.3}, "motion": {"c": 0.1},
        "layer": [{"E": 1e11, "nu": 0.3, "rho": 2000.0, "thickness": 2e-3}],
        "punch": {"profile": "parabolic", "radius": 0.05, "load": 5e4},
        "output": {"quantities": ["sif", "yield"]},
    }  # fmt: skip
    fem, sie = (
        computed(changes=scene | {"solve": {"methods": [name], "tolerance": tolerance}}).data[
            f"layers/{name}/von_mises"
        ]
        for name, tolerance in (("fem", 1e-2), ("sie", 1e-5))
    )
    np.testing.assert_allclose(fem, sie, rtol=1e-2)
