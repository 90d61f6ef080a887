"""Contacts over layers whose ends are found: the integral equation, finite elements, archives."""

import json
from dataclasses import replace

import numpy as np
import pytest
from agreement import check
from layers_cases import SUBSTRATE
from support import THOROUGH
from test_layers import COAT, SCENE

import galinx
from galinx.app.errors import BadInput
from galinx.app.plan.plan import make_plan
from galinx.app.results.check import faults
from galinx.app.scene.read import parse
from galinx.solvers.contact.solution import FreeContact

PUNCH = '[punch]\nprofile = "parabolic"\nradius = "20 mm"\nload = {load}\n'


SAME = COAT.replace("7.5", "2.5").replace("0.3", "0.25").replace("1200", "1000")


def scene(layers=COAT, mu=0.4, tolerance=1e-6, methods=("sie",), quantities=("sif",), load=1e5, more=""):
    text = SCENE.format(
        layers=layers, mu=mu, tolerance=tolerance, methods=json.dumps(list(methods)),
        quantities=json.dumps(list(quantities)),
    )  # fmt: skip
    return parse(text.replace("[friction]", PUNCH.format(load=load) + "[friction]") + more)


@pytest.mark.parametrize("mu", [1e-9, 0.4, 1.0] if THOROUGH else [0.4])
@pytest.mark.parametrize("share", [0.0, 0.5, 0.95] if THOROUGH else [0.0, 0.95])
def test_layers_of_one_solid_are_the_half_plane(mu, share):
    """All that is told of a contact is that of the closed form."""
    c = share * SUBSTRATE.limit()
    asked = ("sif", "surface", "interior")
    points = "points = [[0.2, -0.5], [-1.0, -0.3], [0.7, -3.0]]\n"
    layered, plain = (
        galinx.compute(at_speed(scene(layers, mu, 1e-9, (method,), asked, more=points), c)).data
        for layers, method in ((SAME + SAME, "sie"), ("", "closed_form"))
    )
    h = plain["states/closed_form/half_width"][0]
    assert layered["states/sie/half_width"][0] == pytest.approx(h, rel=1e-10)
    assert layered["states/sie/centre"][0] == pytest.approx(
        plain["states/closed_form/centre"][0], abs=1e-10 * h
    )
    for name in ("states/{}/largest_pressure", "surface/{}/sigma_YY", "surface/{}/sigma_XX",
                 "interior/{}/sigma_XX", "interior/{}/sigma_YY", "interior/{}/sigma_XY"):  # fmt: skip
        one, other = (data[name.format(by)] for data, by in ((layered, "sie"), (plain, "closed_form")))
        known = np.isfinite(other)
        assert np.array_equal(known, np.isfinite(one))
        assert np.abs(one - other)[known].max() <= 1e-8 * np.abs(other[known]).max()


def at_speed(scene, c):
    """The scene at a speed over the wave speed."""
    return replace(scene, motion=replace(scene.motion, c=(c,), speed=None))


@pytest.mark.parametrize("mu", [0.3, 0.9] if THOROUGH else [0.9])
def test_between_a_thick_coating_and_a_thin_one(mu):
    """What the other solid does falls with the thickness over the width, and with its inverse."""
    alone = COAT.replace('thickness = "1 mm"\n', "").replace("[[layer]]", "[solid]")
    text = SCENE.replace(SCENE[: SCENE.index("{layers}") + 8], alone)
    coat = parse(
        text.format(mu=mu, tolerance=1e-6, methods='["closed_form"]', quantities='["sif"]').replace(
            "[friction]", PUNCH.format(load=1e5) + "[friction]"
        )
    )
    of_coat = galinx.compute(coat).data["states/closed_form/half_width"][0]
    below = galinx.compute(scene("", mu, methods=("closed_form",))).data["states/closed_form/half_width"][
        0
    ]
    of = {
        H: galinx.compute(scene(COAT.replace("1 mm", f"{H} mm"), mu)).data["states/sie/half_width"][0]
        for H in (0.02, 0.04, 1.0, 30.0, 60.0)
    }
    assert of_coat < of[30.0] < of[1.0] < of[0.04] < of[0.02] < below
    off_thick = [of[H] / of_coat - 1.0 for H in (30.0, 60.0)]
    assert off_thick[0] <= 2e-3 and 1.8 < off_thick[0] / off_thick[1] < 4.5
    off_thin = [1.0 - of[H] / below for H in (0.04, 0.02)]
    assert off_thin[0] <= 0.05 and 1.5 < off_thin[0] / off_thin[1] < 2.1  # H, and H log H


def test_many_frictions_and_loads_are_those_of_each():
    many = np.linspace(0.05, 0.9, 12).tolist()
    loads = [1e5, 1e6]
    asked = ("sif", "surface")
    together = galinx.compute(scene(mu=many, quantities=asked, load=loads)).data
    h = together["states/sie/half_width"].reshape(2, 12)
    # A wider contact sees more of the soft substrate: it grows faster than the root of the load.
    assert np.all(np.diff(np.log(h), axis=0) > 0.5 * np.log(10.0))
    for i, j in ((0, 3), (1, 7)):
        alone = galinx.compute(scene(mu=many[j], quantities=asked, load=loads[i])).data
        row = 12 * i + j
        for path in ("states/sie/half_width", "surface/sie/sigma_XX"):
            off = np.abs(together[path][row] - alone[path][0]).max() / np.abs(alone[path][0]).max()
            assert off <= 1e-6, path


def test_finite_elements_know_nothing_of_the_integral_equation(monkeypatch):
    """But where to begin: from another half-width they find the same."""
    asked = dict(methods=("fem",), tolerance=1e-3)
    one = galinx.compute(scene(**asked)).data
    true = FreeContact._at_rest
    monkeypatch.setattr(FreeContact, "_at_rest", lambda self, load: 1.7 * true(self, load))
    other = galinx.compute(scene(**asked)).data
    for name in ("half_width", "centre"):
        found = one[f"states/fem/{name}"], other[f"states/fem/{name}"]
        assert np.abs(found[0] - found[1]) <= 1e-4 * one["states/fem/half_width"]
        assert (found[0] != found[1]).all()


def test_both_methods_tell_all_of_a_cylinder_and_the_archive_is_whole(tmp_path):
    asked = ("sif", "surface", "interior", "interfaces")
    result = galinx.compute(
        scene(tolerance=1e-3, methods=("sie", "fem"), quantities=asked,
              more="points = [[0.2, -0.5], [-1.0, -1.4]]\n")
    )  # fmt: skip
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    assert {"", "_sigma_XX", "_inside", "_interfaces"} == check(result.data, 1e-3).keys()
    told = " ".join(result.comparisons)
    for text in ("ends of the contact against", "largest contact pressure against", "σ_YY of contacts",
                 "stresses at interfaces against", "stresses inside against"):  # fmt: skip
        assert text in told
    assert result.data["interfaces/depth"] == pytest.approx([1e-3])
    assert "interfaces/depth_over_a" not in result.data
    path = tmp_path / "a.h5"
    result.save(path)
    assert not faults(path)
    again = galinx.load(path)
    again.report(tmp_path / "r.html")
    assert "half-width" in (tmp_path / "r.html").read_text(encoding="utf-8")
    assert any(drawing.name == "interfaces" for drawing in again.drawings(figures=("all",)))


#: Punches other than cylinders, by what a scene says of them.
OTHERS = {
    "wedge": 'profile = "wedge"\nslope = "1 deg"\n',
    "shoulders": 'profile = "rounded_flat"\nflat_half_width = "0.5 mm"\nradius = "20 mm"\n',
    "tilted": 'profile = "flat"\nhalf_width = "1 mm"\ntilt = "4 deg"\n',
    "cusp": 'profile = "power"\nexponent = 1.5\ncoefficient = 0.3\n',
    "quartic": 'profile = "power"\nexponent = 4.0\ncoefficient = 1e7\n',
}


def under(punch, load=2e5, **options):
    """A scene with another punch."""
    base = scene(load=load, **options)
    text = f"[punch]\n{OTHERS[punch]}load = {load}\n"
    plain = SCENE.format(
        layers=COAT, mu=0.4, tolerance=1e-6, methods='["sie"]', quantities='["sif"]'
    )  # fmt: skip
    return replace(base, punch=parse(plain.replace("[friction]", text + "[friction]")).punch)


@pytest.mark.parametrize("punch", OTHERS if THOROUGH else ["wedge", "tilted"])
def test_the_integral_equation_tells_all_of_every_punch(punch):
    """By its own estimates; between the half-planes of both solids."""
    asked = ("sif", "surface", "interior", "interfaces")
    more = "points = [[0.2, -0.5], [-1.0, -1.4]]\n"
    result = galinx.compute(under(punch, quantities=asked, more=more))
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    infinite = np.isnan(result.data["states/sie/largest_pressure"][0])
    assert infinite == (punch in ("wedge", "tilted"))
    α, β = (result.data[f"states/{name}"][0] for name in ("alpha", "beta"))
    assert α + β == pytest.approx(0.0 if punch == "tilted" else 1.0)


def test_finite_elements_say_what_they_do_not_follow():
    with pytest.raises(BadInput, match=r"with a wedge.*solves all punches"):
        galinx.compute(under("wedge", methods=("fem",)))
    plan = make_plan(under("wedge", methods=("sie", "fem")))
    assert plan.methods == ("sie",)
    assert any("smooth punches with two free ends" in text for text in plan.skipped)
