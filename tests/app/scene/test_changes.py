"""Values of a scene: changed from outside, given as lists and ranges, and read from files of rows."""

import re
import tomllib

import numpy as np
import pytest
from support import SCENE, scene_of

from galinx.app.errors import BadInput
from galinx.app.scene.changes import changed, differences, from_words
from galinx.app.scene.read import parse, read
from galinx.app.scene.values import Numbers
from galinx.solvers.parameters import Range


def test_a_change_stands_in_the_text_and_comments_stay():
    text = SCENE.read_text(encoding="utf-8")
    result = changed(text, {"friction.mu_c": [0.3, 0.5], "solve.tolerance": 1e-4})
    assert "mu_c = [0.3, 0.5]" in result and "tolerance = 0.0001" in result
    assert result.count("#") == text.count("#") and "# σ₀ l/N" in result
    assert parse(result).friction.parameters["mu_c"] == (0.3, 0.5)


DOTTED = """\
solid.material = "steel"
punch.profile = "parabolic"
punch.radius = "5 mm"
{}punch.load = "100 N/mm"
friction.mu = 0.15
motion.speed = "1 m/s"
"""
PARTS = {
    "punch.solid.material": "aluminium", "punch.solid.yield_strength": "50 MPa",
    "solve.tolerance": 1e-4, "output.quantities": ["sif"], "title": "A",
}  # fmt: skip


@pytest.mark.parametrize("there", ["", "punch.solid.nu = 0.3\n", 'punch.solid = {material = "steel"}\n'])
def test_parts_that_are_missing_stand_below_dotted_keys(there):
    scene = parse(changed(DOTTED.format(there), PARTS))
    assert scene.solid.punch_strength == 50e6 and scene.punch.load == 1e5
    assert scene.solve.tolerance == 1e-4 and scene.title == "A" and scene.punch.profile.radius == 5e-3


@pytest.mark.parametrize(
    "value, read",
    [
        (np.linspace(0.0, 0.3, 3), (0.0, 0.15, 0.3)),
        (np.float64(0.3), (0.3,)),
        ({"from": 0.0, "to": np.float64(0.3), "number": np.int64(3)}, (0.0, 0.15, 0.3)),
    ],
)
def test_values_may_be_of_numpy(value, read):
    assert parse(changed(DOTTED.format(""), {"friction.mu": value})).friction.parameters["mu_c"] == read


@pytest.mark.parametrize("key", ["friction", "a.b.c", "mu_c"])
def test_keys_name_section_and_key(key):
    with pytest.raises(BadInput, match="cannot be changed"):
        read(SCENE, {key: 1.0})


@pytest.mark.parametrize(
    "word, message",
    [
        ("solid.E=" + "9" * 5000, "thousands of digits"),
        ("solve.degree=" + "9" * 400, "found a whole number of about 400 digits, expected >= 1, <= 12"),
        ("motion.c=" + "[" * 3000 + "]" * 3000, "motion.c"),
        ("friction.mu_c=[{a = 1}]", "mu_c .*: found {'a': 1}, expected"),
        ("title.x=1", "found 'title' without keys"),
        (
            "friction.mu={from=0.1, to=1, number=3, spacing=log}",
            "expected a range as in TOML, its texts in",
        ),
        ("title=" + "a" * 100_000, "100000 characters"),
        ("title=\udcff", "UTF-8"),
        ("x" * 5000 + ".y=1", "no such section"),
        ("solid." + "x" * 5000 + "=1", "no such key"),
        ("solid.E=1 Pa*9**9**9", "a number, then units"),
    ],
    ids=lambda text: text[:12],
)
def test_what_is_long_deep_or_a_table_is_refused_with_a_short_message(word, message):
    with pytest.raises(BadInput, match=message) as caught:
        read(SCENE, {"title": ""} | from_words([word]))
    assert len(str(caught.value)) < 600


def test_keys_are_taken_away():
    changes = from_words(["motion.speed={from = '1 mm/s', to = 1, number = 3}"], ["motion.c", "title"])
    scene = read(SCENE, changes)
    assert scene.motion.c is None and scene.motion.speed == (0.001, 0.5005, 1.0) and scene.title == ""


@pytest.mark.parametrize(
    "key, message",
    [
        ("motion.cc", "found no key 'motion.cc' to take away; did you mean motion.c?"),
        ("motion.speed", "found no key 'motion.speed' to take away"),
        ("titel", "did you mean title"),
        ("motion", "did you mean motion.c"),
        ("\udcff", "valid: title, "),
    ],
)
def test_only_what_is_there_is_taken_away(key, message):
    with pytest.raises(BadInput, match=message.replace("?", r"\?")):
        read(SCENE, from_words([], [key]))


def test_a_key_is_set_or_taken_away():
    with pytest.raises(BadInput, match=r"--set and --unset motion\.c exclude each other"):
        from_words(["motion.c=0.1"], ["motion.c"])


def test_another_law_replaces_the_parameters_of_the_old_one():
    text = changed(SCENE.read_text("utf-8"), {"friction.model": "coulomb"})
    friction = parse(text).friction
    assert [*friction.parameters] == ["mu_c"] and friction.pre_sliding == 1e-4


def numbers(text, unit="", **bounds):
    return Numbers(unit, Range(**bounds))(tomllib.loads(f"x = {text}")["x"])


@pytest.mark.parametrize(
    "text, expected",
    [
        ("{from = 0, to = 0.9, number = 10}", (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)),
        ("{from = 0.7, to = 0.1, number = 3}", (0.7, 0.4, 0.1)),
        ("{from = 0.1, to = 0.7, number = 2}", (0.1, 0.7)),
        ('{from = 1e-4, to = 1, number = 5, spacing = "log"}', (1e-4, 1e-3, 1e-2, 0.1, 1.0)),
        ('{from = 8, to = 1, number = 4, spacing = "log"}', (8.0, 4.0, 2.0, 1.0)),
        ('{from = 0, to = 1, number = 3, spacing = "linear"}', (0.0, 0.5, 1.0)),
    ],
)
def test_a_range_is_what_a_list_would_be(text, expected):
    assert numbers(text) == expected


@pytest.mark.parametrize("spacing", ["linear", "log"])
def test_ends_are_exact_and_numbers_in_order(spacing):
    first, last = 1.0 / 3.0, 5e-324
    found = numbers(f'{{from = {first!r}, to = {last!r}, number = 1000, spacing = "{spacing}"}}')
    assert len(found) == 1000 and (found[0], found[-1]) == (first, last)
    assert list(found) == sorted(set(found), reverse=True)


@pytest.mark.parametrize(
    "text, message",
    [
        ("{from = 0, to = 0.9, number = 1}", "number: found 1, expected >= 2"),
        ("{from = 0, to = 0.9, number = 1_000_001}", "<= 1e+06"),
        ("{from = 0, to = 0.9, number = 2.5}", "number: found 2.5, expected a whole number"),
        ('{from = 0, to = 0.9, number = 3, spacing = "log"}', "from 0 to 0.9 with spacing"),
        ('{from = 1, to = 2, number = 3, spacing = "even"}', "spacing: found 'even', expected linear or"),
        ("{form = 0, to = 0.9, number = 3}", "found the key 'form' in a range; did you mean from?"),
        ("{from = 0, to = 0.9}", "found a range without number, expected {from = "),
        ("{}", "found a range without from"),
        ("{from = 0.5, to = 0.5, number = 3}", "expected two different ends"),
        ("{from = [0], to = 0.5, number = 3}", "from: found [0], expected a dimensionless number"),
        ("{from = 0, to = '3 mm', number = 3}", "to: found '3 mm'"),
        ("{from = 0, to = 1.0, number = 3}", "to: found 1, expected >= 0, < 1"),
        ("[{from = 0, to = 0.5, number = 3}]", "expected a dimensionless number"),
    ],
)
def test_a_wrong_range_says_what_is_wrong(text, message):
    bounds = {"at_least": 0.0, "below": 1.0} if "spacing" not in text or "log" in text else {}
    with pytest.raises(ValueError, match=re.escape(message)):
        numbers(text, **bounds)


PUNCH = '[punch]\nprofile = "table"\nshape = {shape}  # measured\nload = 5e4\n'
FRICTION = "[friction]\nmu_c = 0.3\nsigma0_over_load = 6e4\n"
REST = '[solid]\nmaterial = "steel"\n[motion]\nc = 0.4\n[output]\nquantities = ["sif"]\n'
ROWS = '[["-2 mm", "20 µm"], ["-1 mm", "6 µm"], [0, 0], ["1 mm", "3 µm"], ["2 mm", "15 µm"]]'
BESIDE = PUNCH.format(shape='"punch.csv"') + FRICTION + REST
CSV = "X [mm], P [µm]\n-2,20\n-1,6\n\n0,0\n1,3\n2,15\n"


def scene_beside(folder, csv, text=BESIDE, name="punch.csv"):
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    if csv is not None:
        (folder / name).write_bytes(csv if isinstance(csv, bytes) else csv.encode())
    return folder / "scene.toml"


@pytest.mark.parametrize(
    "csv",
    [
        CSV,
        "\ufeff" + CSV.replace("\n", "\r\n"),
        "X(m),P(m)\n-2e-3,20e-6\n-1e-3,6e-6\n0,0\n1e-3,3e-6\n2e-3,15e-6",
        "-2e-3,20e-6\n-1e-3,6e-6\n0,0\n1e-3,3e-6\n2e-3,15e-6\n",
        "# measured\n"
        + CSV.replace(",", ";")
        .replace("[mm]", "[µm]")
        .replace("0,0", "0;0")
        .replace("-2;", "-2000,0;")
        .replace("-1;", "-1000;")
        .replace("\n1;", "\n1000;")
        .replace("\n2;", "\n2000;"),
    ],
)
def test_a_file_is_as_good_as_its_rows(tmp_path, csv):
    found = read(scene_beside(tmp_path, csv))
    written = parse(PUNCH.format(shape=ROWS) + FRICTION + REST).punch.profile
    for row, wanted in zip(found.punch.profile.shape, written.shape, strict=True):
        assert row == pytest.approx(wanted, rel=1e-15)


def test_the_scene_keeps_the_numbers(tmp_path):
    path = scene_beside(tmp_path, CSV)
    scene = read(path, {"friction.mu_c": 0.4})
    (tmp_path / "punch.csv").unlink()
    again = parse(scene.text)
    assert again.punch == scene.punch and len(again.punch.profile.shape) == 5
    assert "punch.csv" not in scene.text and "# measured" in scene.text
    with pytest.raises(BadInput, match=r"cannot read .*punch.csv: No such file"):
        read(path)


def test_points_pressures_and_depths_may_be_in_files(tmp_path):
    layer = '[[layer]]\nproperties = "depths.csv"\n'
    solve = '[solve]\nmode = "traction"\npressure = "pressure.csv"\n'
    text = REST.replace('["sif"]', '["interior"]\npoints = "points.csv"')
    (tmp_path / "depths.csv").write_text("0,1e9,0.3,1e3\n2e-3,2e9,0.3,1e3\n", encoding="utf-8")
    (tmp_path / "pressure.csv").write_text("X,p\n-1,0\n0,-2\n1,0\n", encoding="utf-8")
    scene = read(
        scene_beside(tmp_path, "X,Y\n0,-0.5\n1,-2\n", FRICTION + layer + solve + text, "points.csv")
    )
    assert scene.output.points == ((0.0, -0.5), (1.0, -2.0)) and scene.solve.pressure[1] == (0.0, -2.0)
    assert scene.layers[0].thickness == 2e-3


@pytest.mark.parametrize(
    "csv, message",
    [
        (None, r"scene\.toml, punch.shape: cannot read .*punch.csv"),
        ("X [mm],P [µm]\n0,1\n1,2,3\n", r"punch.csv, line 3: found 3 columns, '1,2,3', expected 2"),
        ("X [mm]\n0\n", "line 1: found 1 columns"),
        ("X [mm],P [µm]\n0,1\n\n1,o\n", "line 4, p: found 'o', expected a finite number"),
        ("0,1\n1,inf\n", "line 2: found 'inf', expected a finite number"),
        ("X [mm],P [MPa]\n0,1\n", r"line 1, p: found .MPa. .a pressure., expected"),
        ("X [mm,P [µm]\n0,1\n", r"line 1: found 'X \[mm', expected as in X \[mm\]"),
        (b"X,P\n0,\xff\n", "is not UTF-8"),
        ("", "at least 1 rows of 2 numbers"),
        ("0,1\n1,0\n2,3\n3,3\n", "not convex at X = 2 m"),
    ],
)
def test_faults_of_a_file_are_told(tmp_path, csv, message):
    with pytest.raises(BadInput, match=message):
        read(scene_beside(tmp_path, csv))


@pytest.mark.parametrize("spacing, middle", [("", 11e-3), (', spacing = "log"', 40e-6**0.5)])
def test_one_unit_for_a_list_or_a_range(spacing, middle):
    words = f"punch.radius={{from=2, to=20, number=3{spacing}}} mm", "punch.load=[50, 100] N/mm"
    changed_scene = scene_of("cylinder", from_words(words))
    radii = {variant.punch.profile.radius for variant in changed_scene.variants}
    assert sorted(radii) == pytest.approx([2e-3, middle, 20e-3])
    assert changed_scene.punch.loads == (50e3, 100e3)
    apart = scene_of("cylinder", from_words(["punch.load=[50 N/mm, 0.1 kN/mm]", "solve.methods=[sie]"]))
    assert apart.punch.loads == (50e3, 100e3) and apart.solve.methods == ("sie",)
    with pytest.raises(BadInput, match=r"punch\.load .*found '\[50, 100 N/mm\]'"):
        scene_of("cylinder", from_words(["punch.load=[50, 100 N/mm]"]))
    for word in ("{from=2, to} mm", "{1, 2} mm", "{} mm"):
        with pytest.raises(BadInput, match=r"punch\.radius"):
            scene_of("cylinder", from_words([f"punch.radius={word}"]))


def test_scenes_differ_in_numbers_whatever_their_units_are():
    scenes = (
        '[solid]\nE = "200 GPa"\nnu = 0.3\n[[layer]]\nto = {E = "70 GPa"}\n[punch]\nradius = ["5 mm"]\n',
        "[solid]\nE = 2e11\n[[layer]]\nto = {E = 7e10, nu = 0.3}\n[punch]\nradius = [0.005]\n",
    )
    assert differences(scenes) == {
        "solid.nu": ["0.3", "–"], "layer[0].to": ['{E = "70 GPa"}', "{E = 70000000000.0, nu = 0.3}"],
    }  # fmt: skip
