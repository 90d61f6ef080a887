"""Commands that compute: what they write, refuse and leave undone."""

import json
import re
import subprocess
import sys
import time

import h5py
import numpy as np
import pytest
from support import FEW_DEGREES, HOME, SCENE, THOROUGH, clean_environment, command, here

from galinx import load


def test_one_and_two_ranks_agree(archives):
    with h5py.File(archives[0].path) as one, h5py.File(archives[1].path) as two:
        for name in ("K_I_left", "K_I_right", "normal_force", "tangential_force", "v0"):
            a, b = (file[f"states/fem/{name}"][()] for file in (one, two))
            np.testing.assert_allclose(b, a, rtol=1e-9)
        a, b = (file["surface/fem/sigma_XX"][()] for file in (one, two))
        np.testing.assert_allclose(b, a, rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize("scene", ["tables4_5", "traction"] if THOROUGH else ["tables4_5"])
def test_more_ranks_than_speeds_agree_with_one(tmp_path, scene):
    """They share a mesh of so few cells that not every rank has a node of the far boundary."""
    values = []
    for run, ranks in ((here, ()), (command, ("-n", 3))):
        path = tmp_path / f"{len(ranks)}.h5"
        done = run(*ranks, "run", f"scenes/{scene}.toml", "-o", path, *FEW_DEGREES)
        assert done.returncode == 0, done.stderr
        with h5py.File(path) as file:
            values.append(file["surface/fem/sigma_XX"][()])
    np.testing.assert_allclose(values[1], values[0], rtol=1e-9, atol=1e-9 * np.abs(values[0]).max())


def test_archive_layout(archive):
    with h5py.File(archive) as file:
        assert file["scene/text"].asstr()[()] == SCENE.read_text(encoding="utf-8")
        states, points = len(file["states/f"]), len(file["surface/X_over_a"])
        assert states == 12
        for method in ("closed_form", "fem"):
            for stress in ("sigma_YY", "sigma_XX"):
                assert file[f"surface/{method}/{stress}"].shape == (states, points)
        X = file["surface/X_over_a"][()]
        assert X.min() == -5.0 and X.max() == 5.0 and not np.any(np.abs(X) == 1.0)
        assert np.isnan(file["surface/fem/sigma_YY"][()][:, np.abs(X) > 1.0]).all()
        assert np.isfinite(file["surface/fem/sigma_XX"][()]).all()
        for key in ("program", "version", "schema_version", "created", "complete", "scene_sha256"):
            assert key in file.attrs

        def described(name, item):
            if isinstance(item, h5py.Dataset):
                assert item.attrs["units"] and item.attrs["long_name"], name

        file.visititems(described)


def test_an_archive_is_not_overwritten_unasked(archive):
    before = archive.read_bytes()
    done = here("run", SCENE, "-o", archive)
    assert done.returncode == 2 and "--overwrite" in done.stderr
    assert archive.read_bytes() == before


#: Libraries that take longer to import than a friction loop takes.
SLOW = (
    "dolfinx", "petsc4py", "mpi4py", "matplotlib", "pandas", "scipy.integrate",
    "scipy.interpolate",
)  # fmt: skip


def test_friction_alone_imports_nothing_slow(tmp_path):
    script = (
        "import sys\nfrom click.testing import CliRunner\nfrom galinx.app.cli import cli\n"
        f"done = CliRunner().invoke(cli, ['run', {str(HOME / 'scenes' / 'fig6.toml')!r}, '-o', "
        f"{str(tmp_path / 'loops.h5')!r}], standalone_mode=False)\n"
        "assert done.exception is None, done.exception\n"
        f"print([name for name in {SLOW} if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=HOME, env=clean_environment(), capture_output=True, text=True
    )
    assert done.stdout.strip() == "[]", done.stderr


def test_plan_computes_nothing(tmp_path):
    done = here("plan", SCENE, cwd=tmp_path)
    said = " ".join(done.stdout.split())  # lines are folded
    assert done.returncode == 0 and "one factorisation" in said and not list(tmp_path.iterdir())


def test_the_time_that_is_told_is_all_that_went_by(tmp_path):
    """Python's own start included, before the program's first line; here it takes two seconds."""
    tmp_path.joinpath("sitecustomize.py").write_text("import time\n\ntime.sleep(2.0)\n")
    started = time.monotonic()
    words = ("run", SCENE, "-o", tmp_path / "out.h5", "--set", 'solve.methods=["closed_form"]')
    done = command(*words, PYTHONPATH=str(tmp_path))
    wall = time.monotonic() - started
    told = float(re.search(r"^time: (\S+) s", done.stdout, re.MULTILINE)[1])
    assert 2.0 < told < wall + 0.02


@pytest.mark.parametrize("ranks", [(), ("-n", "2")])
def test_a_verdict_has_its_status(tmp_path, ranks):
    scene, target = HOME / "scenes" / "box.toml", tmp_path / "box.h5"
    run = command if ranks else here
    done = run(*ranks, "run", scene, "-o", target, "--set", "solve.tolerance=1e-3")
    assert done.returncode == 1 and "verdict: FAIL" in done.stdout
    assert "outer boundary" in done.stderr
    assert all(line.startswith("warning: ") for line in done.stderr.splitlines())  # none is mpirun's


def test_the_archive_holds_the_changed_scene(tmp_path):
    done = here("run", SCENE, "-o", tmp_path / "a.h5", "--set", "friction.mu_c=0.25", "--set",
                'solve.methods=["closed_form"]', cwd=tmp_path)  # fmt: skip
    assert done.returncode == 0, done.stderr
    shown = json.loads(here("show", tmp_path / "a.h5", "--json").stdout)
    assert {state["mu_c"] for state in shown["states"]} == {0.25}
    assert "mu_c = 0.25" in load(tmp_path / "a.h5").data["scene/text"]


def test_a_second_run_compiles_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    listings = []
    for _ in range(2):
        done = command("run", SCENE, "-o", tmp_path / "out.h5", "--overwrite", *FEW_DEGREES)
        assert done.returncode == 0, done.stderr
        files = (tmp_path / "galinx").rglob("*")
        listings.append({path: path.stat().st_mtime_ns for path in files if path.is_file()})
    assert listings[0] == listings[1]
