"""The script that starts everything: where it cannot, and where the current folder is in its way."""

import os
import sys

import pytest
from support import HOME, SCENE, command

#: Files that a user may have for reasons of their own, named like rooms and libraries of the program.
NAMESAKES = (
    "app", "meshes", "solvers", "numpy", "mpi4py", "click", "h5py", "socket", "json", "resource",
)  # fmt: skip


def test_without_rights_the_command_for_an_administrator_is_shown(tmp_path):
    for name, text in (("dpkg-query", "exit 1"), ("id", "echo 1000")):
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    path = f"{tmp_path}:{os.environ['PATH']}"
    # Nothing is installed for another Python.
    done = command("plan", SCENE, without=("GALINX_PYTHON",), PATH=path)
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
    variables = {"PYTHONPATH": path} if path else {"without": ("PYTHONPATH",)}
    done = command(*arguments, cwd=tmp_path, **variables)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / f"{SCENE.stem}.h5").exists() == ("run" in arguments)


def test_the_script_is_found_through_links_and_in_spite_of_cdpath(tmp_path):
    (tmp_path / "galinx").symlink_to(HOME / "run.sh")
    (tmp_path / "tree").symlink_to(HOME)
    for script in ("./galinx", "tree/run.sh"):
        done = command("plan", SCENE, script=script, cwd=tmp_path, CDPATH=f"{tmp_path}:{HOME.parent}")
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
    unset, variables = ("OMPI_MCA_rmaps_base_oversubscribe",), {"GALINX_PYTHON": str(mpirun_that_tells)}
    for ranks, told in ((cores, "a core each"), (cores + 1, "1")):
        done = command("-n", ranks, "plan", SCENE, without=unset, OMP_NUM_THREADS="1", **variables)
        assert done.returncode == 3
        assert done.stdout == f"{ranks} {told}\n"
        assert done.stderr.startswith("error: ranks could not be started, or were killed")


def test_an_mpirun_that_ends_at_once_is_no_success(mpirun_that_tells, tmp_path):
    """It may be gone before the script waits for it, as where the machine has other work."""
    late = tmp_path / "late"
    late.write_text("""trap '[ "$BASH_COMMAND" != status=0 ] || sleep 0.3' DEBUG""", encoding="utf-8")
    done = command("-n", 2, "plan", SCENE, GALINX_PYTHON=str(mpirun_that_tells), BASH_ENV=str(late))
    assert done.returncode == 3 and "ranks could not be started" in done.stderr
