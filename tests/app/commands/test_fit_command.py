"""Measured friction becomes a section of a scene."""

import numpy as np
import pytest
from support import called

from galinx.app.scene.read import parse

REST = '[solid]\nmaterial = "steel"\n[motion]\nc = 0.1\n[output]\nquantities = ["friction"]\n'


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    d = np.linspace(0.0, 0.1, 80)
    noise = 1e-3 * np.random.default_rng(2).standard_normal(len(d))
    rows = [f"{x:.6g},{f:.6g}" for x, f in zip(d, 0.4 * (1.0 - np.exp(-55.0 * d)) + noise)]
    (tmp_path / "slip.csv").write_text("\n".join(["slip [mm],f", *rows]) + "\n", encoding="utf-8")
    t = np.linspace(0.0, 2.0, 81)
    X = 1.0 - np.abs(1.0 - t)
    f = np.where(t <= 1.0, 0.3, -0.3)
    rows = [f"{a:g},7,{b:.9g},{c:g}" for a, b, c in zip(t, 50.0 * X, f)]
    (tmp_path / "motion.csv").write_text("\n".join(["time [s],n,position [um],f [1]", *rows]))
    return tmp_path


def test_a_fitted_section_is_one_of_a_scene_and_is_drawn(here, capsys):
    assert called("fit", "dahl", "slip.csv", "--fix", "delta=1") == 0
    section = (here / "fit" / "friction.toml").read_text(encoding="utf-8")
    assert section in capsys.readouterr().out and "delta = 1.0  # dimensionless, not fitted" in section
    given = parse(section + REST).friction.parameters
    assert given["mu_c"][0] == pytest.approx(0.4, abs=2e-3)
    assert given["sigma0_over_load"][0] == pytest.approx(2.2e4, rel=1e-2)
    assert (here / "fit" / "fit.pdf").stat().st_size > 1000
    assert called("fit", "dahl", "slip.csv") == 0  # made again


@pytest.mark.parametrize(
    "law, more",
    [
        ("coulomb", ()), ("maxwell_slip", ("--rows", "2")), ("table", ("--rows", "4")),
        ("bouc_wen", ("--start", "exponent=1")),
        ("lugre", ("--speed", "1 mm/s", "--fix", "mu_s=0.5", "--fix", "stribeck_velocity=1 mm/s",
                   "--fix", "sigma1_over_load=0", "--fix", "sigma2_over_load=0",
                   "--fix", "stribeck_exponent=2")),
        ("rate_and_state", ("--speed", "1 mm/s", "--fix", "evolution=slip", "--fix", "a=0.01")),
    ],
)  # fmt: skip
def test_sections_of_every_kind_are_read_by_scenes(here, law, more):
    assert called("fit", law, "slip.csv", *more) == 0
    section = (here / "fit" / "friction.toml").read_text(encoding="utf-8")
    assert parse(section + REST).friction.count == 1


SCENE = """# my scene
[friction]   # of the rig
model = "bouc_wen"  # guessed
mu_c = [0.2, 0.3]  # from a book
pre_sliding = "0.2 mm"  # measured
yield_displacement = "20 um"

[solid]
material = "steel"  # 42CrMo4
[motion]
c = 0.1
[output]
quantities = ["friction"]
"""


def test_a_law_goes_into_a_scene_that_stays_as_it_was_written(here, capsys):
    (here / "scene.toml").write_text(SCENE, encoding="utf-8")
    words = ("fit", "slip.csv", "--model", "dahl", "--fix", "delta=1", "--into", "scene.toml")
    assert called(*words, "-o", "new.toml") == 0
    assert (here / "scene.toml").read_text(encoding="utf-8") == SCENE
    new = (here / "new.toml").read_text(encoding="utf-8")
    assert called(*words) == 0
    assert (here / "scene.toml").read_text(encoding="utf-8") == new
    assert "next: ./run.sh run scene.toml" in capsys.readouterr().out.replace(
        "galinx run", "./run.sh run"
    )
    assert new.partition("[solid]")[2] == SCENE.partition("[solid]")[2]
    assert "# my scene" in new and 'pre_sliding = "0.2 mm"  # measured' in new
    assert "from a book" not in new and "yield_displacement" not in new and "guessed" not in new
    assert "delta = 1.0  # dimensionless, not fitted" in new
    friction = parse(new).friction
    assert friction.pre_sliding == 2e-4 and friction.parameters["mu_c"][0] == pytest.approx(0.4, abs=2e-3)


@pytest.mark.parametrize(
    "words, said",
    [
        (("dhal", "slip.csv"), "did you mean dahl?"),
        (("dahl", "none.csv"), "cannot read none.csv"),
        (("stribeck", "slip.csv"), "give --speed, as in --speed '1 mm/s'"),
        (("dahl", "motion.csv", "--speed", "1 m/s"), "but the table tells the time"),
        (("dahl", "slip.csv", "--fix", "mu=1"), "fix or start: found 'mu', expected one of mu_c, sigma0"),
        (("dahl", "slip.csv", "--fix", "mu_c=-1"), "mu_c: found -1, expected > 0"),
        (("dahl", "slip.csv", "--fix", "mu_c=1 m"), "mu_c: found '1 m'"),
        (("dahl", "slip.csv", "--fix", "delta"), "--fix delta: expected KEY=VALUE"),
        (
            ("dahl", "slip.csv", "--fix", "delta=1", "--start", "delta=2"),
            "--fix and --start delta exclude",
        ),
        (("device.h5",), "device.h5 is no text file, expected a table of numbers"),
        (("dahl", "few.csv"), "2 samples in motion for 3 parameters, expected more"),
    ],
)
def test_faults_of_measurements_are_told(here, capsys, words, said):
    (here / "few.csv").write_text("slip,f\n0,0\n1,1\n2,1\n", encoding="utf-8")
    (here / "device.h5").write_bytes(b"\x89HDF\r\n\x1a\n\0\xff")
    assert called("fit", *words) == 2
    assert said in capsys.readouterr().err
    assert not (here / "fit").exists() or not list((here / "fit").iterdir())
