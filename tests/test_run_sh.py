"""The script that starts everything: where it cannot, and where the current folder is in its way."""

import os
import subprocess
import sys

import pytest
from support import HOME, SCENE, clean_environment

#: Files that a user may have for reasons of their own, named like rooms and libraries of the program.
NAMESAKES = (
    "app", "meshes", "solvers", "numpy", "mpi4py", "click", "h5py", "socket", "json", "resource",
)  # fmt: skip


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
        ("::", ("plan", SCENE)),  # empty entries mean the current folder
        (":/nowhere", ("plan", SCENE)),
        (None, ("-n", "2", "run", SCENE, "--set", 'solve.methods=["closed_form"]')),
    ],
    ids=["plan ::", "plan :/nowhere", "two ranks"],
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


def test_the_script_is_found_through_links_and_in_spite_of_cdpath(tmp_path):
    (tmp_path / "galinx").symlink_to(HOME / "run.sh")
    (tmp_path / "tree").symlink_to(HOME)
    environment = clean_environment() | {"CDPATH": f"{tmp_path}:{HOME.parent}"}
    for script in ("./galinx", "tree/run.sh"):
        done = subprocess.run(
            [script, "plan", str(SCENE)], cwd=tmp_path, env=environment,
            capture_output=True, text=True, timeout=60,
        )  # fmt: skip
        assert done.returncode == 0 and done.stdout.startswith("do    friction") and not done.stderr


@pytest.fixture
def mpirun_that_tells(tmp_path):
    """A Python with an mpirun beside it that starts nothing, and says what it was told."""
    scripts = {
        "python": f'exec {sys.executable} "$@"',
        "mpirun": 'echo "$2 ${OMPI_MCA_rmaps_base_oversubscribe:-a core each}"; exit 5',
    }
    for name, text in scripts.items():
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    return tmp_path / "python"


def test_ranks_share_cores_only_where_there_are_too_few(mpirun_that_tells):
    cores = len(os.sched_getaffinity(0))
    environment = clean_environment() | {"GALINX_PYTHON": str(mpirun_that_tells), "OMP_NUM_THREADS": "1"}
    environment.pop("OMPI_MCA_rmaps_base_oversubscribe")
    for ranks, told in ((cores, "a core each"), (cores + 1, "1")):
        done = subprocess.run(
            [str(HOME / "run.sh"), "-n", str(ranks), "plan", str(SCENE)], env=environment,
            capture_output=True, text=True, timeout=60,
        )  # fmt: skip
        assert done.returncode == 3
        assert done.stdout == f"{ranks} {told}\n"
        assert done.stderr.startswith("error: ranks could not be started, or were killed")
