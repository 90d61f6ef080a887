"""Lists of numbers of solid, layers and punch: each state is that of a scene of its own."""

import numpy as np
import pytest

from galinx.app.errors import BadInput
from galinx.app.results import check
from galinx.app.results.result import compute, load
from galinx.app.scene.changes import changed, from_words
from galinx.app.scene.read import parse
from galinx.postprocess.quantities import states, swept
from galinx.postprocess.quantities.layers import INTERFACE_EXTREMES
from galinx.postprocess.tables import parameters

FLAT = """
[solid]
E = "200 GPa"
nu = 0.3
rho = 7800
[punch]
profile = "flat"
half_width = "1 mm"
load = ["50 N/mm", "100 N/mm"]
[friction]
mu = [0.1, 0.3]
[motion]
speed = ["100 m/s", "1000 m/s"]
[solve]
methods = ["closed_form"]
"""
COATED = """
[solid]
material = "BK7"
[[layer]]
thickness = "20 um"
E = "450 GPa"
nu = 0.25
rho = 5220
[punch]
profile = "parabolic"
radius = "5 mm"
load = "100 N/mm"
[friction]
mu = 0.2
[motion]
speed = "1 m/s"
[solve]
methods = ["sie"]
tolerance = 1e-4
"""


def _alone(text, result, state):
    """Values of a state's swept numbers, and the result of a scene with these alone."""
    names = [path for path in parameters(result.data) if "." in path]
    values = {path.partition("/")[2]: float(result.data[path][state]) for path in names}
    return values, compute(parse(changed(text, values)))


def test_every_state_is_that_of_a_scene_with_single_numbers():
    half_widths = "punch.half_width={from=1e-3, to=2e-3, number=2}"
    scene = parse(changed(FLAT, from_words(["solid.E=[100, 200, 400] GPa", half_widths])))
    result = compute(scene)
    count = len(result.data[states.SPEED.path])
    each = count // len(scene.variants)
    assert (len(scene.variants), each) == (6, 8)
    for first in range(0, count, each):
        values, alone = _alone(FLAT, result, first)
        rows = slice(first, first + each)
        for path, expected in alone.data.items():
            if path.startswith(("states/", "surface/closed_form")):
                held = result.data[path][rows]
                same = np.array_equal(held, expected, equal_nan=expected.dtype.kind == "f")
                assert same, (path, values)
        half_width = alone.scene.body.half_width
        assert (result.data[swept.HALF_WIDTH.path][rows] == half_width).all()
        assert (result.data[swept.WAVE_SPEED.path][rows] == alone.scene.solid.c_s).all()


def test_an_archive_of_a_sweep_is_whole(tmp_path):
    scene = parse(changed(FLAT, from_words(["solid.nu=[0.2, 0.3, 0.4]"])))
    compute(scene).save(tmp_path / "swept.h5")
    assert check.faults(tmp_path / "swept.h5") == []
    assert load(tmp_path / "swept.h5").scene.variants[2].half_plane.solid.ν == 0.4


def test_a_number_of_one_variant_that_is_changed_is_a_fault(tmp_path):
    result = compute(parse(changed(FLAT, from_words(["solid.nu=[0.2, 0.3]"]))))
    result.data["states/closed_form/K_I_left"][-1] *= 1.1
    result.save(tmp_path / "swept.h5")
    faults = check.faults(tmp_path / "swept.h5")
    assert any("with solid.nu = 0.3: states/closed_form/K_I_left is not what" in text for text in faults)


def test_thicknesses_of_a_layer():
    result = compute(parse(changed(COATED, from_words(["layer[0].thickness=[10, 20] um"]))))
    unit, depths = swept.interface_depths(result.data)
    assert unit == "m" and np.allclose(depths, [[10e-6], [20e-6]], rtol=1e-12)
    for state in (0, 1):
        _, alone = _alone(COATED, result, state)
        for row in (states.HALF_WIDTH["sie"], *INTERFACE_EXTREMES["sie"]):
            held, expected = result.data[row.path][state], alone.data[row.path][0]
            # The positions along interfaces are those of both thicknesses.
            assert np.allclose(held, expected, rtol=2e-3, atol=2e-2 * ("_X" in row.path)), row.path


def test_contacts_of_another_kind_are_no_sweep():
    tilts = from_words(["punch.tilt=['0 deg', '0.1 deg']"])
    with pytest.raises(BadInput, match="of another kind"):
        compute(parse(changed(FLAT, tilts)))
