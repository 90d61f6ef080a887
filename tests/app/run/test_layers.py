"""Scenes with layers, from the text to the archive."""

import json
from itertools import product

import numpy as np
import pytest
from scipy.integrate import trapezoid
from support import THOROUGH

import galinx
from galinx.app.errors import BadInput
from galinx.app.plan.plan import make_plan
from galinx.app.scene.read import parse
from galinx.solvers.errors import SolveError

SCENE = """
[solid]
E = "2.5 GPa"
nu = 0.25
rho = "1000 kg/m^3"
{layers}
[friction]
model = "coulomb"
mu_c = {mu}
[motion]
speed = "447.21359549995794 m/s"
strokes = ["forward"]
X_over_L = [0.5]
[solve]
tolerance = {tolerance}
methods = {methods}
[output]
quantities = {quantities}
"""
COAT = """
[[layer]]
thickness = "1 mm"
E = "7.5 GPa"
nu = 0.3
rho = "1200 kg/m^3"
"""


def scene(layers=COAT, mu=0.4, tolerance=1e-6, methods=("sie",), quantities=("sif", "surface")):
    found = dict(zip(("methods", "quantities"), map(json.dumps, map(list, (methods, quantities)))))
    return parse(SCENE.format(layers=layers, mu=mu, tolerance=tolerance, **found))


def test_the_example_from_scene_to_archive(tmp_path):
    """Its numbers are those of tests/solvers/layers/test_contact.py."""
    result = galinx.compute(scene(tolerance=1e-9))
    data = result.data
    assert result.verdict == "PASS"
    assert data["states/sie/K_I_left"][0] == pytest.approx(0.46957498690109, rel=1e-10)
    assert data["states/sie/K_I_right"][0] == pytest.approx(0.44068899120707, rel=1e-10)
    assert data["states/sie/estimate"][0] <= 1e-9
    assert data["states/alpha"][0] == pytest.approx(-0.46191902660637, rel=1e-12)
    X, σ = data["surface/X_over_a"], data["surface/sie/sigma_YY"][0]
    middle = np.flatnonzero(X == 0.0)
    assert σ[middle] / 2.0 == pytest.approx(-0.17306141207014, rel=1e-9)
    assert np.isnan(σ[np.abs(X) > 1.0]).all()
    assert data["states/speed"][0] == pytest.approx(447.21359549995794)
    assert data["states/c"][0] == pytest.approx(0.2**0.5 / np.sqrt(7.5 / 2.6 / 1.2))
    assert data["states/speed_limit"][0] == pytest.approx(919.4016867619661, rel=1e-12)
    path = tmp_path / "coated.h5"
    result.save(path)
    again = galinx.load(path)
    assert again.scene.layers == result.scene.layers
    told = json.loads(again.attributes["solid"])
    assert told["layer 1"].startswith("1 mm of E = 7.5 GPa")


GRADED = COAT + 'to = { E = "2.5 GPa", nu = 0.25, rho = "1000 kg/m^3" }\n'
ROWS = """
[[layer]]
properties = [
  [0, "7.5 GPa", 0.3, 1200], ["0.4 mm", "5.5 GPa", 0.28, 1120], ["1 mm", "2.5 GPa", 0.25, 1000],
]
"""


def test_rows_by_depth_are_linear_grading():
    one, other = (galinx.compute(scene(layers=layers)).data for layers in (GRADED, ROWS))
    for path in ("states/sie/K_I_left", "surface/sie/sigma_XX"):
        assert np.abs(one[path] / other[path] - 1.0).max() <= 1e-5
    assert one["states/sie/K_I_left"][0] == pytest.approx(0.505526, rel=1e-5)


@pytest.mark.parametrize(
    ("layers", "told"),
    [
        (COAT.replace("0.3", "0.6"), "layer 1.nu (Poisson's ratio): found 0.6"),
        (COAT.replace('thickness = "1 mm"', ""), "layer 1: missing thickness"),
        (COAT.replace('"1 mm"', "0"), "layer 1.thickness (thickness): found 0, expected > 0"),
        (COAT + 'grading = "power"\n', "grading and exponent need to"),
        (COAT + "to = {}\n", "expected constants"),
        (COAT + "to = { E = -1 }\n", "layer 1.to.E (Young's modulus): found -1"),
        (COAT + 'to = { plane = "stress" }\n', "the same plane"),
        (COAT + "thick = 1\n", "layer 1.thick: no such key"),
        (COAT + 'material = "unobtainium"\n', "layer 1.material"),
        (11 * COAT, "found 11 layers, expected at most 10"),
        ("layer = 3\n", "layer: found 3, expected tables [[layer]]"),
        ("[[layer]]\nproperties = [[0, 1, 0.3, 1]]\n", "at least 2 rows"),
        ("[[layer]]\nproperties = [[0, 1, 0.3, 1], [0, 1, 0.3, 1]]\n", "depths rising from 0"),
        (ROWS + "thickness = 1\n", "properties gives thickness, too"),
    ],
)
def test_layers_with_a_fault_are_told_once(layers, told):
    if layers.startswith("layer"):
        text = layers + SCENE.format(
            layers="", mu=0.4, tolerance=1e-6, methods='["sie"]', quantities='["sif"]'
        )  # fmt: skip
    else:
        text = SCENE.format(
            layers=layers, mu=0.4, tolerance=1e-6, methods='["sie"]', quantities='["sif"]'
        )
    with pytest.raises(BadInput) as error:
        parse(text)
    assert told in str(error.value)
    assert "1 fault:" in str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('["sie"]', '["closed_form"]', 'solve.methods is ["closed_form"]'),
        ('methods = ["sie"]', 'mode = "traction"', 'solve.mode is "traction"'),
        (
            '["sie"]',
            '["fem"]\ndegree = 5',
            "solve.degree is 5, but layers have meshes and degrees of their own",
        ),
        ('["sie"]', '["sie", "fem"]\nmesh = "graded"', 'solve.mesh is "graded", but layers have'),
    ],
)
def test_what_layers_do_not_have_is_refused_in_one_message(old, new, told):
    text = SCENE.format(
        layers=COAT, mu=0.4, tolerance=1e-6, methods='["sie"]', quantities='["sif"]'
    ).replace(old, new)
    with pytest.raises(BadInput) as error:
        make_plan(parse(text))
    assert told in str(error.value) and str(error.value).startswith("layer: ")


def test_too_fast_for_the_layers_is_refused():
    text = SCENE.format(
        layers=COAT, mu=0.4, tolerance=1e-6, methods='["sie"]', quantities='["sif"]'
    ).replace("447.2", "947.2")
    with pytest.raises(BadInput, match=r"speed limit of the layers .* 919.402 m/s"):
        make_plan(parse(text))


@pytest.mark.parametrize("mu", [1e5, 1e16, 1e308])
def test_friction_that_leaves_no_pressure_but_at_an_edge_is_told(mu):
    with pytest.raises(SolveError, match="exponent at an edge is -1"):
        galinx.compute(scene(mu=mu))


def test_interfaces_and_inside():
    """Tractions are continuous, in-plane stress is not, and points at the interface lie above it."""
    text = SCENE.format(
        layers=COAT, mu=0.4, tolerance=1e-7, methods='["sie"]', quantities='["interfaces", "interior"]'
    )
    data = galinx.compute(parse(text + "points = [[0.5, -1.0], [0.5, -1.0001], [-1.2, -0.4]]\n")).data
    X = data["interfaces/X_over_a"]
    assert data["interfaces/depth_over_a"] == pytest.approx([1.0])
    at = np.argmin(np.abs(X - 0.5))
    assert X[at] == 0.5
    for name, other in (
        ("sigma_YY", "sigma_YY"),
        ("sigma_XY", "sigma_XY"),
        ("sigma_XX", "sigma_XX_above"),
    ):
        there = data[f"interior/sie/{name}"][0, :2]
        assert there[0] == pytest.approx(data[f"interfaces/sie/{other}"][0, 0, at], abs=1e-8)
    below = data["interior/sie/sigma_XX"][0, 1]
    assert below == pytest.approx(data["interfaces/sie/sigma_XX_below"][0, 0, at], abs=1e-3)
    shear = data["interfaces/sie/sigma_XY"][0, 0]
    assert data["interfaces/sie/sigma_XY_max"][0, 0] == pytest.approx(shear.max(), rel=1e-3)
    assert data["interfaces/sie/sigma_XY_max"][0, 0] >= shear.max()
    place = data["interfaces/sie/sigma_XY_max_X_over_a"][0, 0]
    assert abs(place - X[shear.argmax()]) <= 0.1
    # Tractions along the interface carry the load but for what lies beyond the positions.
    far = np.abs(trapezoid(data["interfaces/sie/sigma_YY"][0, 0], X) + 2.0)
    assert far <= 0.05


def test_interfaces_without_layers_are_refused():
    with pytest.raises(BadInput, match="expected \\[\\[layer\\]\\]"):
        scene(layers="", quantities=("interfaces",))


@pytest.mark.parametrize(
    "modulus, thickness",
    product(("1 GPa", "450 GPa"), ("2 um", "20 um", "200 um", "2 mm"))
    if THOROUGH
    else [("450 GPa", "20 um"), ("1 GPa", "2 mm")],
)
def test_largest_stresses_along_an_interface_lie_inside_the_window(modulus, thickness):
    """A thin stiff layer has its largest tension six half-widths behind the punch, others farther."""
    data = galinx.compute(
        parse(
            f'[solid]\nmaterial = "steel"\n[[layer]]\nE = "{modulus}"\nnu = 0.25\nrho = "5220 kg/m^3"\n'
            f'thickness = "{thickness}"\n[punch]\nprofile = "flat"\nhalf_width = "0.15 mm"\n'
            'load = "100 N/mm"\n'
            '[friction]\nmodel = "coulomb"\nmu_c = 0.15\n[motion]\nspeed = "100 m/s"\n'
            'strokes = ["forward"]\nX_over_L = [1.0]\n[solve]\nmethods = ["sie"]\n'
            '[output]\nquantities = ["interfaces"]\n'
        )
    ).data
    X = data["interfaces/X_over_a"]
    for side in ("above", "below"):
        σ = data[f"interfaces/sie/sigma_XX_{side}"][0, 0]
        largest = data[f"interfaces/sie/sigma_XX_{side}_max"][0, 0]
        assert largest >= σ.max() * (1.0 - 1e-12)
        assert X[0] < data[f"interfaces/sie/sigma_XX_{side}_max_X_over_a"][0, 0] < X[-1]
        assert max(σ[0], σ[-1]) < 0.9 * largest
