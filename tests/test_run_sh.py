"""The script that starts everything: where it cannot, and where the current folder is in its way."""

import os
import subprocess

import pytest
from support import FEW_DEGREES, HOME, SCENE, clean_environment

#: Files that a user may have for reasons of their own, named like rooms and libraries of the program.
NAMESAKES = ("app", "meshes", "solvers", "galinx", "numpy", "mpi4py", "click")


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


@pytest.mark.parametrize(
    "path, arguments",
    [
        (None, ("plan", SCENE)),
        ("::", ("plan", SCENE)),  # empty entries mean the current folder
        (":/nowhere", ("plan", SCENE)),
        (None, ("run", SCENE, *FEW_DEGREES)),
        (None, ("-n", "2", "run", SCENE, *FEW_DEGREES)),
    ],
    ids=["plan", "plan ::", "plan :/nowhere", "run", "two ranks"],
)
def test_files_of_the_current_folder_are_no_libraries(tmp_path, path, arguments):
    for name in NAMESAKES:
        (tmp_path / f"{name}.py").write_text("raise SystemExit('no library')\n", encoding="utf-8")
    environment = clean_environment()
    environment.pop("PYTHONPATH")
    if path:
        environment["PYTHONPATH"] = path
    done = subprocess.run(
        [str(HOME / "run.sh"), *map(str, arguments)], cwd=tmp_path, env=environment,
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert (tmp_path / f"{SCENE.stem}.h5").exists() == ("run" in arguments)
