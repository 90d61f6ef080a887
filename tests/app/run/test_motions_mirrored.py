"""The mirror image of a motion in time, in other units, is the mirror image of its answer.

A stroke turned round on the mirror image of a solid, with moduli, density, half-width and load of another
size: every dimensionless dataset of a motion has to be the same from the other side. Both methods would
agree on a motion that goes the wrong way, so that their agreement cannot see it.
"""

import numpy as np
import pytest
from combined import SOLID, UNITS, Case
from support import THOROUGH, here, scene_of

import galinx
from galinx.app.plan import over_time
from galinx.postprocess.quantities.over_time import START
from galinx.postprocess.quantities.quantity import QUANTITIES

#: Datasets that change their sign in a mirror, and how names of ends do.
ODD = (
    "g", "ratio", "direction", "centre_of_pressure", "steady_centre", "steady_centres", "sigma_XY",
)  # fmt: skip
ENDS = {"left": "right", "right": "left"}
#: Datasets along X, and their places.
ALONG = ("time/surface/", "time/sie/sigma_YY")
CONSTANT = {"friction": "constant"}


def scene(kind, strokes, way=1, time=CONSTANT, methods=("sie",), sign="physical", length=0.25):
    """A scene; ``way`` = -1: the mirror image, in other units."""
    case = Case(kind, "flat", (), methods, mirrored=way < 0, scaled=way < 0)
    size, modulus = (UNITS[unit] if way < 0 else 1.0 for unit in ("m", "Pa"))
    a = 1e-3 * size
    return scene_of("study_in_time", {
        "solid": case.of(SOLID[kind]), "punch": {"half_width": a, "load": 1e4 * modulus * size},
        "friction": {"model": "dahl", "mu_c": 0.5, "sigma0_over_load": 0.5 / (length * a),
                     "pre_sliding": length * a, "sign": sign},
        "motion": {"c": 0.4, "strokes": strokes, "X_over_L": [0.5]},
        "time": time and {"end": 0.3, "step": 0.1} | time,
        "solve": {"methods": list(methods), "tolerance": 1e-2},
        "output": {"quantities": ["friction", "time"] if time else ["friction"]},
    })  # fmt: skip


def run(folder, name, scene):
    """The named motion's datasets, from an archive that a run has written and ``check`` accepts."""
    (folder / f"{name}.toml").write_text(scene.text, encoding="utf-8")
    archive = folder / f"{name}.h5"
    done = here("run", folder / f"{name}.toml", "-o", archive)
    assert done.returncode in (0, 1), done.stdout + done.stderr  # 1: an estimate above the tolerance
    checked = here("check", archive)
    assert checked.returncode == 0, checked.stdout + checked.stderr
    data = galinx.load(archive).data
    order = np.argsort(np.abs(data["time/g"]))  # starts are archived by friction with its sign
    return {
        path: values[order] if QUANTITIES[path].over[0] == START else values
        for path, values in data.items()
        if path.startswith("time/")
    }


def from_the_other_side(data):
    """All datasets of a motion as its mirror image has them."""
    turned = {}
    for path, values in data.items():
        name = path.rpartition("/")[2]
        end = name.rpartition("_")[2]
        if end in ENDS:
            path = path.removesuffix(end) + ENDS[end]
        if name == "X_over_a":
            values = -values[::-1]
        elif path.startswith(ALONG) and name.startswith("sigma_"):
            values = values[..., ::-1]
        turned[path] = -values if name in ODD else values
    return turned


def alike(one, other, accuracy):
    """Two motions, each dataset over its largest."""
    assert one.keys() == other.keys() and len(one) > 10
    for path, values in one.items():
        size = np.nanmax(np.abs(values), initial=0.0)
        if path.endswith("estimate"):
            size = 1.0  # a difference of what is compared here
        np.testing.assert_array_equal(np.isnan(values), np.isnan(other[path]), err_msg=path)
        atol = accuracy * size + 1e-12
        np.testing.assert_allclose(other[path], values, rtol=0.0, atol=atol, err_msg=path)


@pytest.fixture(autouse=True)
def _coarse(monkeypatch):
    """Finite elements of any degree have a mirror image: low ones, whose estimates are too large."""
    monkeypatch.setattr(over_time, "_HIGHEST", 3)


STARTS = {
    "rest": CONSTANT | {"load_ramp": 0.8, "every": 0.4},
    "steady": CONSTANT | {"start": "steady", "load": [[0, 1], [2, 0.5]]},
    "law": {"friction": "law", "load_ramp": 0.6, "end": 0.5},
    "law from steady motion": {"friction": "law", "start": "steady"},
}
THERE, BACK = ["forward"], ["backward"]


@pytest.mark.parametrize("kind", ["orthotropic", *["anisotropic", "cubic"] * THOROUGH])
def test_any_solid(kind, tmp_path):
    """By the integral equation; fibres by finite elements, too."""
    methods = ("sie", "fem") if kind == "orthotropic" else ("sie",)
    time = CONSTANT | {"load_ramp": 2.0}
    forward = run(tmp_path, "forward", scene(kind, THERE, 1, time, methods))
    backward = run(tmp_path, "backward", scene(kind, BACK, -1, time, methods))
    alike(forward, from_the_other_side(backward), 1e-8)


#: Starts whose turns are computed every day, and the sign of the mirror image's friction: by the study's
#: Eq 25, too, friction holds the punch back, which goes towards -X. The others take minutes.
_OFTEN = [("steady", "eq25"), ("law", "physical")]


@pytest.mark.parametrize(
    "time, sign",
    [(name, sign) for name in STARTS for sign in ("eq25", "physical")] if THOROUGH else _OFTEN,
)
def test_a_turn(time, sign, tmp_path):
    """By its law the second stroke goes back in time; constant friction is that of each stroke.

    Each by one method alone: both agree in test_over_time.py.
    """
    methods = ("fem",) if STARTS[time]["friction"] == "law" else ("sie",)
    forward = scene("isotropic", THERE + BACK, 1, STARTS[time], methods, "physical", 0.12)
    strokes = BACK + THERE if sign == "physical" else THERE + BACK
    backward = scene("isotropic", strokes, -1, STARTS[time], methods, sign, 0.12)
    forward, backward = run(tmp_path, "forward", forward), run(tmp_path, "backward", backward)
    alike(forward, from_the_other_side(backward), 1e-8)
    assert (forward["time/dissipated"][:, -1] > 0.0).all()


#: All but one that no motion in time is computed of.
KINDS = [kind for kind in SOLID if kind != "nearly incompressible"]


@pytest.mark.parametrize("kind", KINDS if THOROUGH else ("anisotropic",))
def test_response(kind, tmp_path):
    """Over moduli and frequencies of both units a load that oscillates meets the same stiffness."""
    found = []
    for name, strokes, way in (("forward", THERE, 1), ("backward", BACK, -1)):
        (tmp_path / f"{name}.toml").write_text(scene(kind, strokes, way, None).text, encoding="utf-8")
        words = "-o", tmp_path / f"{name}.png", "--points", "3"
        done = here("response", tmp_path / f"{name}.toml", *words)
        assert done.returncode == 0, done.stderr
        rows = [line.split() for line in done.stdout.splitlines() if line[:1].isdigit()]
        found.append(np.array(rows, dtype=float) / [1, 1, *[UNITS["Pa"] if way < 0 else 1.0] * 2, 1, 1])
    assert len(found[0]) == 3
    np.testing.assert_allclose(found[0][:, [0, 2, 3, 5]], found[1][:, [0, 2, 3, 5]], rtol=2e-5)
