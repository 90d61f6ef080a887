"""The mirror image of a motion in time, in other units, is the mirror image of its answer.

A stroke turned round on the mirror image of a solid, with moduli, density, half-width and load of another
size: every dimensionless dataset of a motion has to be the same from the other side. Both methods would
agree on a motion that goes the wrong way, so that their agreement cannot see it.
"""

import numpy as np
import pytest
from support import THOROUGH, here

import galinx
from galinx.postprocess.quantities.over_time import START
from galinx.postprocess.quantities.quantity import QUANTITIES
from galinx.solvers.solids import SOLIDS

#: Constants of a solid of each kind and of its mirror image; moduli in GPa.
FIBRES = {"E1": 140.0, "E2": 10.0, "E3": 10.0, "G12": 5.0}, {"nu12": 0.3, "nu13": 0.3, "nu23": 0.45}
SAMPLES = {
    "isotropic": lambda way, scale: {"E": scale * 200.0, "nu": 0.3},
    "orthotropic": lambda way, scale: (
        {key: scale * value for key, value in FIBRES[0].items()} | FIBRES[1] | {"angle": way * 30.0}
    ),
    "cubic": lambda way, scale: {
        "c11": scale * 165.0, "c12": scale * 64.0, "c44": scale * 79.0, "angle": way * 25.0,
    },
    "anisotropic": lambda way, scale: {
        "stiffness": [scale * one for one in (60.0, 20.0, way * 9.0, 30.0, way * 4.0, 15.0)],
    },
}  # fmt: skip
#: Datasets that change their sign in a mirror, and how names of ends do.
ODD = (
    "g", "ratio", "direction", "centre_of_pressure", "steady_centre", "steady_centres", "sigma_XY",
)  # fmt: skip
ENDS = {"left": "right", "right": "left"}
#: Datasets along X, and their places.
ALONG = ("time/surface/", "time/sie/sigma_YY")


def scene(kind, strokes, way=1, time='friction = "constant"', methods='"sie"', sign="physical", end=0.9):
    """The text of a scene; ``way`` = -1: the mirror image, in other units."""
    scale, size = (1.0, 1.0) if way > 0 else (7.3, 0.11)
    constants = "\n".join(
        f"{key} = {_with_unit(key, value)}" for key, value in SAMPLES[kind](way, scale).items()
    )
    return f"""title = "A motion and its mirror image"
[solid]
kind = "{kind}"
{constants}
rho = "{2000.0 * 3.1 ** (way < 0)} kg/m^3"
[punch]
half_width = "{size} mm"
load = "{scale * size} kN/m"
[friction]
model = "dahl"
mu_c = 0.5
sigma0_over_load = "{2000.0 / size} 1/m"
pre_sliding = "{0.25 * size} mm"
sign = "{sign}"
[motion]
c = 0.4
strokes = {strokes}
X_over_L = [0.5]
[time]
end = {end}
{time}
[solve]
methods = [{methods}]
tolerance = 1e-2
[output]
quantities = ["friction", "time"]
"""


def _with_unit(key, value):
    if isinstance(value, list):
        return "[" + ", ".join(f'"{one} GPa"' for one in value) + "]"
    plain = key == "angle" or key.startswith("nu")
    return value if plain else f'"{value} GPa"'


def run(folder, name, text):
    """The named motion's datasets, from an archive that a run has written and ``check`` accepts."""
    (folder / f"{name}.toml").write_text(text)
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


def test_every_solid_has_a_mirror_image():
    assert set(SAMPLES) == set(SOLIDS)


STARTS = {
    "rest": 'friction = "constant"\nload_ramp = 0.8\nevery = 0.4',
    "steady": 'friction = "constant"\nstart = "steady"\nload = [[0, 1], [0.8, 0.5]]',
    "law": 'friction = "law"\nload_ramp = 0.6',
    "law from steady motion": 'friction = "law"\nstart = "steady"',
}
THERE, BACK = '["forward"]', '["backward"]'


@pytest.mark.parametrize("kind", [kind for kind in SAMPLES if kind != "isotropic"])
def test_any_solid(kind, tmp_path):
    """By the integral equation; fibres by finite elements, too."""
    methods = '"sie", "fem"' if kind == "orthotropic" else '"sie"'
    time = 'friction = "constant"\nload_ramp = 0.8'
    forward = run(tmp_path, "forward", scene(kind, THERE, 1, time, methods, end=0.5))
    backward = run(tmp_path, "backward", scene(kind, BACK, -1, time, methods, end=0.5))
    alike(forward, from_the_other_side(backward), 1e-8)


#: Starts whose turns are computed every day; the others take minutes.
_OFTEN = ("steady", "law")


@pytest.mark.parametrize("time", [name for name in STARTS if THOROUGH or name in _OFTEN])
def test_a_turn(time, tmp_path):
    """By its law the second stroke goes back in time; constant friction is that of each stroke.

    Each by one method alone: what the law does by the integral equation is below, constant friction by
    finite elements above, and both agree in test_over_time.py.
    """
    there, back = '["forward", "backward"]', '["backward", "forward"]'
    method = '"fem"' if STARTS[time].startswith('friction = "law"') else '"sie"'
    forward = run(tmp_path, "forward", scene("isotropic", there, 1, STARTS[time], method))
    backward = run(tmp_path, "backward", scene("isotropic", back, -1, STARTS[time], method))
    alike(forward, from_the_other_side(backward), 1e-8)
    assert (forward["time/dissipated"][:, -1] > 0.0).all()


def test_the_other_sign_of_friction_is_the_mirror_image(tmp_path):
    """The study's Eq 25, too, is a punch that friction holds back: towards -X."""
    one = run(tmp_path, "one", scene("isotropic", THERE, 1, STARTS["law"], end=0.5))
    other = run(tmp_path, "other", scene("isotropic", THERE, 1, STARTS["law"], end=0.5, sign="eq25"))
    alike(one, from_the_other_side(other), 1e-9)
    assert (other["time/direction"] == -1.0).all() and other["time/dissipated"][0, -1] > 0.0


@pytest.mark.parametrize("kind", SAMPLES if THOROUGH else ("isotropic", "anisotropic"))
def test_response(kind, tmp_path):
    """Over moduli and frequencies of both units a load that oscillates meets the same stiffness."""
    found = []
    for name, strokes, way in (("forward", THERE, 1), ("backward", BACK, -1)):
        text = scene(kind, strokes, way)
        text = text[: text.index("[time]")] + text[text.index("[solve]") :]
        (tmp_path / f"{name}.toml").write_text(text)
        changes = ["--set", 'output.quantities=["friction"]', "--points", "3"]
        done = here("response", tmp_path / f"{name}.toml", "-o", tmp_path / f"{name}.png", *changes)
        assert done.returncode == 0, done.stderr
        rows = [line.split() for line in done.stdout.splitlines() if line[:1].isdigit()]
        found.append(np.array(rows, dtype=float) / [1, 1, *[7.3 ** (way < 0)] * 2, 1, 1])
    assert len(found[0]) == 3
    np.testing.assert_allclose(found[0][:, [0, 2, 3, 5]], found[1][:, [0, 2, 3, 5]], rtol=2e-5)
