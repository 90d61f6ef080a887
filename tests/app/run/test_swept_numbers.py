"""Lists of numbers of solid, layers and punch: each state is that of a scene of its own."""

import numpy as np
import pytest
from support import THOROUGH, computed, scene_of

from galinx.app.results import check
from galinx.app.results.result import load
from galinx.app.scene.changes import from_words
from galinx.postprocess.quantities import states, stresses, swept
from galinx.postprocess.quantities.layers import INTERFACE_EXTREMES
from galinx.postprocess.tables import parameters
from galinx.solvers.parameters import parameters as model_parameters
from galinx.solvers.profiles import PROFILES
from galinx.solvers.solids import SOLIDS

FLAT = {
    "solid": {"E": "200 GPa", "nu": 0.3, "rho": 7800}, "friction": {"mu": [0.1, 0.3]},
    "punch": {"half_width": "1 mm", "load": ["50 N/mm", "100 N/mm"]}, "output": None,
    "motion": {"speed": ["100 m/s", "1000 m/s"]}, "solve": {"methods": ["closed_form"]},
}  # fmt: skip
COATED = {
    "solid": {"material": "BK7"}, "friction": {"mu": 0.2}, "motion": {"speed": "1 m/s"},
    "layer": [{"thickness": "20 um", "E": "450 GPa", "nu": 0.25, "rho": 5220}], "output": None,
    "punch": {"profile": "parabolic", "radius": "5 mm", "load": "100 N/mm"},
    "solve": {"methods": ["sie"], "tolerance": 1e-4},
}  # fmt: skip


def swept_by(scene, *words):
    return computed("tables4_5", scene | from_words(words))


def alone(scene, result, state):
    """Values of a state's swept numbers, and the result of a scene with these alone."""
    names = [path for path in parameters(result.data) if "." in path]
    values = {path.partition("/")[2]: float(result.data[path][state]) for path in names}
    return values, computed("tables4_5", scene | values)


def test_every_state_is_that_of_a_scene_with_single_numbers():
    half_widths = "punch.half_width={from=1e-3, to=2e-3, number=2}"
    result = swept_by(FLAT, "solid.E=[100, 200, 400] GPa", half_widths)
    variants, count = len(result.scene.variants), len(result.data[states.SPEED.path])
    each = count // variants
    assert (variants, each) == (6, 8)
    for first in range(0, count, each):
        values, single = alone(FLAT, result, first)
        rows = slice(first, first + each)
        for path, expected in single.data.items():
            if path.startswith(("states/", "surface/closed_form")):
                held = result.data[path][rows]
                same = np.array_equal(held, expected, equal_nan=expected.dtype.kind == "f")
                assert same, (path, values)
        half_width = single.scene.body.half_width
        assert (result.data[swept.HALF_WIDTH.path][rows] == half_width).all()
        assert (result.data[swept.WAVE_SPEED.path][rows] == single.scene.solid.c_s).all()


def test_a_list_of_one_number_is_that_number():
    scene = scene_of("start_from_rest", {"punch.half_width": ["1 mm"], "solid.E": ["200 GPa"]})
    assert not scene.variants and scene.body.half_width == 1e-3


def test_a_number_of_one_variant_that_is_changed_is_a_fault(tmp_path):
    result = swept_by(FLAT, "solid.nu=[0.2, 0.3]")
    result.save(tmp_path / "whole.h5")
    assert check.faults(tmp_path / "whole.h5") == []
    assert load(tmp_path / "whole.h5").scene.variants[1].half_plane.solid.ν == 0.3
    result.data["states/closed_form/K_I_left"][-1] *= 1.1
    result.save(tmp_path / "swept.h5")
    faults = check.faults(tmp_path / "swept.h5")
    assert any("with solid.nu = 0.3: states/closed_form/K_I_left is not what" in text for text in faults)


SHARP = {"punch": {"half_width": "1 mm", "load": "10 N/mm"}, "motion": {"c": 0.2}}


@pytest.mark.parametrize("scene, thin", [(COATED, 10), *[(COATED | SHARP, 20)] * THOROUGH])
def test_thicknesses_of_a_layer(scene, thin):
    """Largest stresses at interfaces do not depend on which places they are sampled at."""
    result = swept_by(scene, f"layer[0].thickness=[{thin}, {2 * thin}] um")
    unit, depths = swept.interface_depths(result.data)
    assert unit == "m" and np.allclose(depths, [[thin * 1e-6], [2e-6 * thin]], rtol=1e-12)
    _, single = alone(scene, result, 1)
    rows = [*INTERFACE_EXTREMES["sie"], *[states.HALF_WIDTH["sie"]] * ("profile" in scene["punch"])]
    for row in rows:
        held, expected = result.data[row.path][1], single.data[row.path][0]
        # The positions along interfaces are those of both thicknesses.
        assert np.allclose(held, expected, rtol=1e-6, atol=1e-4 * ("_X" in row.path)), row.path


@pytest.mark.parametrize("method", ["closed_form", "fem"])
def test_a_tilt_through_zero_is_that_of_each_punch(method):
    solve = {"solve": {"methods": [method], "tolerance": 1e-4}}
    result = swept_by(FLAT | solve, "punch.tilt=['-1e-5 deg', '0 deg', '1e-5 deg']")
    assert result.verdict == "PASS" and len(result.data[states.SPEED.path]) == 24
    for first in (0, 8, 16):  # 8 states of each tilt
        _, single = alone(FLAT | solve, result, first)
        a = single.scene.body.half_width
        for row in (states.K_I_LEFT, states.K_I_RIGHT, stresses.PRESSURE, stresses.IN_PLANE):
            path = row[method].path
            held, expected = result.data[path][first : first + 8], single.data[path]
            size = np.nanmax(np.abs(expected), axis=-1, keepdims=True)
            assert np.allclose(held / size, expected / size, rtol=0.0, atol=1e-4, equal_nan=True), path
        assert np.allclose(result.data[states.HALF_WIDTH[method].path], a, rtol=1e-12)


ROUND = {
    "solid": {"material": "aluminium"}, "friction": {"mu": 0.3}, "motion": {"speed": "1 m/s"},
    "output": None, "solve": {"methods": ["closed_form"], "tolerance": 1e-3},
    "punch": {"profile": "parabolic", "radius": "5 mm", "load": "100 N/mm"},
}  # fmt: skip
SHOULDERS = ROUND | {
    "punch": {
        "profile": "rounded_flat", "flat_half_width": "1 um", "radius": "5 mm", "load": "100 N/mm",
    }
}  # fmt: skip
#: An elastic punch of the same constants: both bodies have the same largest stress.
PAIR = ROUND | {"punch.solid": {"material": "aluminium", "yield_strength": "300 MPa"}}


@pytest.mark.parametrize(
    "scene, words",
    [
        (SHOULDERS, ["solid.yield_strength=[100, 900] MPa"]),
        (PAIR, ["solid.yield_strength=[200, 400] MPa"]),
        (PAIR, ["punch.solid.yield_strength=[200, 400] MPa", "solid.yield_strength=300 MPa"]),
    ],
)
def test_a_swept_strength_is_that_of_each_state(scene, words):
    result = swept_by(scene, *words)
    told = {column.name: column for column in result.table() if column.name.startswith("yields")}
    each = [[*map(str, column.values)] for column in told.values()]
    for state in (0, 1):
        _, single = alone(scene | from_words(words), result, state)
        own = {column.name: str(column.values[0]) for column in single.table()}
        assert {name: own[name] for name in told} == dict(zip(told, (texts[state] for texts in each)))
    assert any(texts[0] != texts[1] for texts in each)


@pytest.mark.parametrize("kinds", [PROFILES, SOLIDS], ids=["profiles", "solids"])
def test_a_key_of_several_kinds_has_one_name_for_all(kinds):
    """Columns have one description a key: what one kind alone means stands behind a comma."""
    names = {}
    for kind in kinds.values():
        for described in model_parameters(kind).values():
            names.setdefault(described.key, set()).add(described.about.partition(",")[0])
    assert {key: of for key, of in names.items() if len(of) > 1} == {}
    columns = swept.columns(tuple(SOLIDS.values()), tuple(PROFILES.values()))
    assert columns["states/punch.radius"].about == "radius R, punch.radius of the scene"
