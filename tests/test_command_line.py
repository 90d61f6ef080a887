import json
import os
import subprocess
import sys
import time

import h5py
import numpy as np
import pytest
from conftest import HOME, clean_environment, command, mpirun

from galinx.app.cli import cli

SCENE = HOME / "scenes" / "tables4_5.toml"


@pytest.fixture(scope="module")
def archives(tmp_path_factory):
    """The same scene on one and on two ranks."""
    folder = tmp_path_factory.mktemp("archives")
    paths = []
    for ranks in ((), ("-n", "2")):
        path = folder / f"{len(ranks)}.h5"
        done = command(*ranks, "run", SCENE, "-o", path)
        assert done.returncode == 0, done.stderr
        assert "verdict: PASS" in done.stdout
        paths.append(path)
    return paths


def test_one_and_two_ranks_agree(archives):
    with h5py.File(archives[0]) as one, h5py.File(archives[1]) as two:
        for name in ("K_I_left", "K_I_right", "normal_force", "tangential_force", "v0"):
            a, b = (file[f"states/fem/{name}"][()] for file in (one, two))
            np.testing.assert_allclose(b, a, rtol=1e-9)
        a, b = (file["surface/fem/sigma_XX"][()] for file in (one, two))
        np.testing.assert_allclose(b, a, rtol=1e-6, atol=1e-8)


def test_archive_layout(archives):
    with h5py.File(archives[0]) as file:
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


def test_show_as_json(archives):
    shown = json.loads(command("show", archives[0], "--json").stdout)
    assert shown["verdict"] == "PASS" and len(shown["states"]) == 12
    first = shown["states"][0]
    assert first["motion"] == "FM1" and first["closed_form"]["K_I"] == pytest.approx(0.3160757828331318)
    assert first["fem"]["K_I_left"] == pytest.approx(first["closed_form"]["K_I"], rel=1e-6)


def test_show_fits_a_terminal(archives):
    shown = command("show", archives[0])
    assert shown.returncode == 0 and "…" not in shown.stdout and "\x1b" not in shown.stdout
    assert max(map(len, shown.stdout.splitlines())) <= 80


def test_plot(archives, tmp_path):
    done = command("plot", archives[0], "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    for name in ("0_friction", "0_surface"):
        assert (tmp_path / f"{name}.png").stat().st_size > 10_000
        assert (tmp_path / f"{name}.pdf").read_bytes().startswith(b"%PDF")


def test_an_archive_is_not_overwritten_unasked(archives):
    before = archives[0].read_bytes()
    done = command("run", SCENE, "-o", archives[0])
    assert done.returncode == 2 and "--overwrite" in done.stderr
    assert archives[0].read_bytes() == before


def test_friction_alone_imports_no_finite_elements(tmp_path):
    script = (
        "import sys\nfrom click.testing import CliRunner\nfrom galinx.app.cli import cli\n"
        f"done = CliRunner().invoke(cli, ['run', {str(HOME / 'scenes' / 'fig6.toml')!r}, '-o', "
        f"{str(tmp_path / 'loops.h5')!r}], standalone_mode=False)\n"
        "assert done.exception is None, done.exception\n"
        "print([m for m in ('dolfinx', 'gmsh', 'petsc4py', 'mpi4py', 'matplotlib') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=HOME, capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr


def test_plan_computes_nothing(tmp_path):
    done = command("plan", SCENE, cwd=tmp_path)
    said = " ".join(done.stdout.split())  # lines are folded
    assert done.returncode == 0 and "one factorisation" in said and not list(tmp_path.iterdir())


def test_a_verdict_has_its_status(tmp_path):
    scene = tmp_path / "box.toml"
    text = (HOME / "scenes" / "box.toml").read_text(encoding="utf-8")
    scene.write_text(text.replace("tolerance = 2e-2", "tolerance = 1e-3"), encoding="utf-8")
    done = command("run", scene, "-o", tmp_path / "box.h5")
    assert done.returncode == 1 and "verdict: FAIL" in done.stdout
    assert "outer boundary" in done.stderr


@pytest.mark.parametrize("ranks", [(), ("-n", "2")])
@pytest.mark.parametrize(
    "arguments, message",
    [
        (("run", "missing.toml"), "cannot read missing.toml"),
        (("run", "bad.toml"), "solid.nu"),
        (("show", "bad.toml"), "damaged"),
        (("frobnicate",), "No such command"),
    ],
)
def test_bad_input_ends_with_one_message(tmp_path, ranks, arguments, message):
    (tmp_path / "bad.toml").write_text("[solid]\nE = 1e9\nrho = 1000\n", encoding="utf-8")
    done = command(*ranks, *arguments, cwd=tmp_path)
    assert done.returncode == 2 and "Traceback" not in done.stderr
    assert done.stderr.count("error: ") == 1 and message in done.stderr


def test_a_number_of_ranks_is_checked():
    done = command("-n", "two", "plan", SCENE)
    assert done.returncode == 2 and "expected a number of ranks" in done.stderr


def test_a_failure_on_one_rank_ends_all(tmp_path):
    script = (
        "import sys, time; from galinx.app.run import compute as module; from galinx.app import ranks\n"
        "true = module.compute\n"
        "def compute(*a):\n"
        "    if ranks.rank() == 1:\n"
        "        print('raised at', time.time(), flush=True)\n"
        "        raise RuntimeError('provoked')\n"
        "    return true(*a)\n"
        "module.compute = compute\n"
        f"sys.argv = ['app', 'run', {str(SCENE)!r}, '-o', 'never.h5']\n"
        "from galinx.app.cli import run_from_shell\nrun_from_shell()\n"
    )
    done = subprocess.run(
        mpirun(2, "-c", script), cwd=tmp_path, env=clean_environment(),
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert done.returncode == 3 and "provoked" in done.stderr
    raised = float(done.stdout.split("raised at ")[1].split()[0])
    assert time.time() - raised < 5.0
    assert not (tmp_path / "never.h5").exists()


@pytest.mark.parametrize("name", ["", *cli.commands])
def test_help(name):
    done = command(*filter(None, [name]), "--help")
    assert done.returncode == 0 and "Usage" in done.stdout
    assert not name or "Example: ./run.sh" in done.stdout


def test_the_study_is_reproduced(tmp_path):
    done = command("-n", "2", "paper", "-o", tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "verdict: PASS" in done.stdout and done.stdout.count(" yes ") == 12
    names = [*(f"fig{n}" for n in (2, 5, 6, 7, 8, 9, 10)), "inside", "mesh"]
    figures = {f"{name}.{kind}" for name in names for kind in ("pdf", "png")}
    assert figures | {"study.h5", "inside.h5", "tables.txt", "report.html"} == {
        p.name for p in tmp_path.iterdir()
    }


def test_without_rights_the_command_for_an_administrator_is_shown(tmp_path):
    for name, text in (("dpkg-query", "exit 1"), ("id", "echo 1000")):
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    path = f"{tmp_path}:{os.environ['PATH']}"
    environment = clean_environment() | {"PATH": path}
    environment.pop("GALINX_PYTHON", None)  # nothing is installed for another Python
    done = subprocess.run(
        [str(HOME / "run.sh"), "plan", str(SCENE)], env=environment,
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert done.returncode == 3
    assert "apt-get install --no-install-recommends python3-dolfinx" in done.stderr
