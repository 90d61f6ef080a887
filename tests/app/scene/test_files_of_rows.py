"""Tables of a scene in files of comma-separated values: what is read, and a message for each fault."""

import pytest

from galinx.app.errors import BadInput
from galinx.app.scene.read import parse, read

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
        ("X [mm],P [MPa]\n0,1\n", r"line 1, p: found .1 MPa. of dimension"),
        ("X [mm,P [µm]\n0,1\n", r"line 1: found 'X \[mm', expected as in X \[mm\]"),
        (b"X,P\n0,\xff\n", "is not UTF-8"),
        ("", "at least 1 rows of 2 numbers"),
        ("0,1\n1,0\n2,3\n3,3\n", "not convex at X = 2 m"),
    ],
)
def test_faults_of_a_file_are_told(tmp_path, csv, message):
    with pytest.raises(BadInput, match=message):
        read(scene_beside(tmp_path, csv))
