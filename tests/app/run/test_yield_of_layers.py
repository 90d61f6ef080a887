"""Largest von Mises stress of layers and the solid below: by uniform solids, and by dense sampling."""

import numpy as np
import pytest

from galinx.app.results.result import compute
from galinx.app.scene.changes import changed
from galinx.app.scene.read import parse
from galinx.postprocess.quantities import layers, stresses, yielding
from galinx.postprocess.quantities.states import HALF_WIDTH

STEEL = 'E = "210 GPa"\nnu = 0.3\nrho = 7850\n'
SCENE = f"""
[solid]
{STEEL}
yield_strength = "600 MPa"
[[layer]]
thickness = "20 um"
{{layer}}
[punch]
profile = "parabolic"
radius = "5 mm"
load = "100 N/mm"
[friction]
mu = [0.05, 0.2, 0.5]
[motion]
speed = "800 m/s"
[solve]
methods = ["sie"]
"""
TIN = 'E = "450 GPa"\nnu = 0.25\nrho = 5220\nyield_strength = "4 GPa"\n'


@pytest.mark.parametrize("thickness", ["4 um", "30 um", "300 um"])
def test_layers_of_the_solid_itself_are_a_uniform_solid(thickness):
    text = changed(SCENE.format(layer=STEEL), {"layer[0].thickness": thickness})
    uniform = text.replace(text[text.index("[[layer]]") : text.index("[punch]")], "")
    layered, exact = compute(parse(text)).data, compute(
        parse(changed(uniform, {"solve.methods": ["closed_form"]}))
    ).data  # fmt: skip
    for rows, tolerance in (
        (yielding.VON_MISES, 2e-5), (yielding.VON_MISES_X, 2e-2), (yielding.VON_MISES_Y, 2e-2),
    ):  # fmt: skip
        held, expected = layered[rows["sie"].path], exact[rows["closed_form"].path]
        assert np.allclose(held, expected, rtol=0.0, atol=tolerance), rows["sie"].path


@pytest.mark.parametrize("thickness", ["5 um", "100 um"])
def test_no_sample_is_larger_and_some_come_near(thickness):
    changes = {
        "layer[0].thickness": thickness,
        "solve.tolerance": 1e-5,
        "output.quantities": ["friction", "sif", "surface", "interfaces", "interior", "yield"],
        "output.map": {"X": [-2, 2, 81], "Y": [-3, -0.05, 60]},
    }
    result = compute(parse(changed(SCENE.format(layer=TIN), changes)))
    data = result.data
    depth = data[layers.INTERFACE_DEPTH_IN_M.path][0] / data[HALF_WIDTH["sie"].path]
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
