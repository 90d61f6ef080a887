"""Scenes with an elastic punch: what the punch bears, by both methods."""

import json

import numpy as np
import pytest
from support import of_sections

from galinx.app.results.result import compute, template


def test_a_scene_says_which_body_yields_first():
    changes = {"motion.c": [0.0, 0.8], "output.quantities": ["yield"], "solve.methods": ["closed_form"]}
    result = compute(template("elastic_punch", changes))
    columns = {column.name: column.texts() for column in result.table()}
    assert columns["yields_first"] == ["punch", "plate"]
    names = [*columns]
    assert names[names.index("yields") + 1] == "punch_yields"
    first = result.data["states/closed_form/punch_first_yield_load"]
    assert [text[:2] for text in columns["punch_yields"]] == ["ye" if N <= 5e4 else "no" for N in first]
    own = "punch_von_mises", "punch_von_mises_Y", "punch_first_yield_load"
    assert {f"closed_form_{name}" for name in own} <= columns.keys()
    assert json.loads(result.attributes["solid"])["punch yield_strength"] == 235e6
    assert (result.data["states/closed_form/punch_von_mises_Y_over_a"] >= 0.0).all()


@pytest.mark.parametrize("profile", ["parabolic", "flat"])
def test_stresses_below_the_pressure_of_finite_elements_are_those_of_the_closed_form(profile):
    punch = {"parabolic": {}, "flat": {"punch.radius": None, "punch.half_width": "0.2 mm"}}[profile]
    output = {"output.points": [[0.2, -0.3], [-1.1, -0.05], [0.0, -4.0]], "solve.tolerance": 1e-4}
    quantities = ["interior", *["yield"] * (profile == "parabolic")]
    changes = {"motion.c": [0.4], "output.quantities": quantities, "punch.profile": profile}
    result = compute(template("elastic_punch", changes | punch | output))
    assert result.verdict == "PASS"
    assert (
        result.comparisons["stresses in the elastic punch, relative to themselves or the largest"] < 1e-6
    )
    for name in ("punch_von_mises", "punch_sigma_XY"):
        of_fem, exact = (result.data[f"interior/{of}/{name}"] for of in ("fem", "closed_form"))
        np.testing.assert_allclose(of_fem, exact, rtol=1e-5)
    if profile == "parabolic":
        loads = (result.data[f"states/{of}/punch_first_yield_load"] for of in ("fem", "closed_form"))
        np.testing.assert_allclose(*loads, rtol=1e-5)


STEEL = {"material": "steel", "speed": "300 m/s"}
#: Punches, and what a contact of each has of the bodies' stresses.
PUNCHES = {
    "parabolic": ({"radius": "20 mm"}, ["surface", "yield", "interior"]),
    "power": ({"exponent": 3, "coefficient": 1000.0}, ["surface"]),
    "flat": ({"half_width": "0.2 mm"}, ["surface"]), "wedge": ({"slope": 0.01}, ["surface"]),
}  # fmt: skip


def pressed(method, quantities, solid=STEEL, layers=(), **punch):
    """Result of a punch on aluminium with layers."""
    output = {"quantities": quantities}
    if "interior" in quantities:
        output["points"] = [[0.2, -0.3], [0.0, -4.0]]
    return compute(of_sections(
        solid={"material": "aluminium"}, layer=[*layers] or None,
        punch={"load": "50 N/mm"} | punch | ({"solid": solid} if solid else {}),
        friction={"mu": 0.3}, motion={"c": 0.5}, solve={"methods": [method]}, output=output,
    ))  # fmt: skip


@pytest.mark.parametrize("profile", PUNCHES)
def test_a_layer_of_the_plates_own_solid_changes_nothing(profile):
    keys, quantities = PUNCHES[profile]
    layer = {"material": "aluminium", "thickness": "0.2 mm"}
    layered = pressed("sie", quantities, layers=[layer], profile=profile, **keys)
    uniform = pressed("closed_form", quantities, profile=profile, **keys)
    assert layered.verdict == uniform.verdict == "PASS"
    names = ["surface/M/sigma_XX", "states/M/K_I_left" if profile == "flat" else "states/M/half_width"]
    if "yield" in quantities:
        of_punch = "sigma_XX", "sigma_YY", "sigma_XY", "von_mises"
        names += ["states/M/largest_pressure", "states/M/punch_von_mises", "states/M/von_mises",
                  *(f"interior/M/punch_{name}" for name in of_punch)]  # fmt: skip
    X = layered.data["surface/X_over_a"]
    for name in names:
        one, other = (
            of.data[name.replace("/M/", f"/{method}/")]
            for of, method in ((layered, "sie"), (uniform, "closed_form"))
        )
        if name.startswith("surface") and profile == "wedge":  # next to the tip it is infinite
            one, other = (σ[:, np.abs(X) > 0.03] for σ in (one, other))
        np.testing.assert_allclose(one, other, rtol=1e-5, atol=1e-5, err_msg=name)


def test_a_stiff_punch_over_layers_is_a_rigid_one():
    """What is left is the quotient of the moduli."""
    stiff, rigid = (
        pressed("sie", ["surface"], solid, [{"material": "TiN", "thickness": "20 µm"}],
                profile="parabolic", radius="20 mm").data
        for solid in ({"E": 2e18, "nu": 0.3, "rho": 7800.0}, None)
    )  # fmt: skip
    for name in ("states/sie/half_width", "states/sie/largest_pressure", "surface/sie/sigma_XX"):
        np.testing.assert_allclose(stiff[name], rigid[name], rtol=1e-6, atol=1e-6, err_msg=name)


def test_stresses_in_the_plane_of_a_crystal_need_none_out_of_it():
    crystal = {
        "kind": "anisotropic", "rho": 1600, "stiffness": [4e10, 1.2e10, 1.5e10, 1.6e10, 6e9, 1.3e10],
    }  # fmt: skip
    alone, known = (
        pressed("closed_form", ["interior"], crystal | of, profile="parabolic", radius="20 mm").data
        for of in ({}, {"stiffness_Z": [1e10, 1e10, 1e9]})
    )
    for name in ("sigma_XX", "sigma_YY", "sigma_XY"):
        path = f"interior/closed_form/punch_{name}"
        np.testing.assert_array_equal(alone[path], known[path])
    assert {*known} - {*alone} == {"interior/closed_form/punch_von_mises"}


@pytest.mark.parametrize("steel, aluminium", [(0.0, 1500.0), (500.0, 1000.0)])
def test_thresholds_of_flutter_are_exchanged_where_the_bodies_are(steel, aluminium):
    """Turned upside down, a pair is the same; slip to X, of the one plate, is slip to -X of the other."""
    moving = {"steel": steel, "aluminium": aluminium}
    thresholds, warnings = {}, {}
    for plate, punch, sign in (("aluminium", "steel", "physical"), ("steel", "aluminium", "eq25")):
        result = compute(of_sections(
            solid={"material": plate}, motion={"speed": f"{moving[plate]} m/s"},
            punch={"profile": "parabolic", "radius": "20 mm", "load": "100 N/mm",
                   "solid": {"material": punch, "speed": f"{moving[punch]} m/s"}},
            friction={"mu": 0.2, "sign": sign}, solve={"methods": ["closed_form"]},
        ))  # fmt: skip
        signs = "positive", "negative"
        thresholds[plate] = [result.data[f"states/flutter_{of}"][0] for of in signs]
        given = json.loads(result.attributes["warnings"])
        warnings[plate] = [text for text in given if "flutter" in text]
    assert thresholds["steel"] == pytest.approx(thresholds["aluminium"][::-1], abs=1e-8)
    assert max(thresholds["steel"]) > 0.3 > 0.2 > min(thresholds["steel"])
    assert not warnings["steel"] and not warnings["aluminium"]
