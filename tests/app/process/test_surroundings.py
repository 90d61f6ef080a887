"""What a command meets before it can do anything: closed streams, encodings, limits, variables."""

import stat
import sys

import pytest
from support import HOME, SCENE, finished, here

from galinx.postprocess.hdf5 import archive

#: A run that needs no finite elements.
RUN = ("run", str(SCENE), "-o", "x.h5", "--set", 'solve.methods=["closed_form"]')
PLAN = ("plan", str(SCENE))
on_ranks = pytest.mark.parametrize("count", [(), ("-n", "2")], ids=["alone", "two ranks"])


def galinx(folder, *arguments, shell='"$@"', **options):
    """``./run.sh ARGUMENTS`` as a line of bash starts it, with other variables; its output as bytes."""
    words = ["bash", "-c", shell, "bash", HOME / "run.sh", *arguments]
    return finished(words, cwd=folder, text=False, **options)


def is_refused(done, status, *words):
    """Did a command end with a status and one message of one line?"""
    said = done.stderr.decode()
    assert done.returncode == status, said
    assert said.startswith("error: ") and said.count("\n") == 1 and not done.stdout, said
    for word in words:
        assert word in said


@pytest.mark.parametrize("closed", ["<&- >&- 2>&-", "2>&-"])  # bash hands its script on as stream 2
def test_closed_streams_are_the_null_device(tmp_path, closed):
    done = galinx(tmp_path, *RUN, shell=f'"$@" {closed}')
    assert (done.returncode, done.stderr) == (0, b"")
    assert (b"archive: x.h5" in done.stdout) == (closed == "2>&-")
    assert archive.read(tmp_path / "x.h5")[1]["verdict"] == "PASS"
    assert galinx(tmp_path, "plan", "no.toml", shell='"$@" 2>&-').returncode == 2


@pytest.mark.parametrize("words", [PLAN, ("plan", "--help")])
def test_what_cannot_be_written_is_named(tmp_path, words):
    done = galinx(tmp_path, *words, shell='"$@" >/dev/full')
    is_refused(done, 3, "cannot write the output: No space left on device; make room")


def test_a_summary_that_cannot_be_written_costs_no_archive(tmp_path):
    is_refused(galinx(tmp_path, *RUN, shell='"$@" >/dev/full'), 3, "cannot write the output")
    assert archive.read(tmp_path / "x.h5")[1]["verdict"] == "PASS"
    done = galinx(tmp_path, "show", "x.h5", shell='"$@" | head -c 5')
    assert len(done.stdout) == 5
    assert all(line.startswith(b"warning: ") for line in done.stderr.splitlines())


@pytest.mark.parametrize("count, encoding", [(("-n", "2"), "ascii"), ((), "latin-1")])
def test_what_an_encoding_lacks_is_replaced(tmp_path, count, encoding):
    assert here(*RUN, cwd=tmp_path).returncode == 0
    done = galinx(tmp_path, *count, "show", "x.h5", PYTHONIOENCODING=encoding)
    assert done.returncode == 0 and b"Error" not in done.stderr
    assert "?_XX [MPa]" in done.stdout.decode(encoding)


def test_a_scene_for_several_ranks_is_a_file(tmp_path):
    done = galinx(tmp_path, "-n", "2", "plan", "/dev/stdin", given=SCENE.read_bytes())
    is_refused(done, 2, "only one of several ranks could read /dev/stdin; expected a file")


@pytest.mark.parametrize(
    "variables",
    [
        {"PMI_RANK": "1", "PMI_SIZE": "4", "OMPI_COMM_WORLD_SIZE": "2", "OMPI_COMM_WORLD_RANK": "1"},
        {"PMI_RANK": "many", "PMI_SIZE": ""},
    ],
    ids=["MPICH and Open MPI", "nonsense"],
)
def test_what_another_mpirun_left_is_no_rank(tmp_path, variables):
    scripts = [HOME / "run.sh"], [sys.executable, "-m", "galinx"]  # which asks MPI
    for start in scripts:
        done = finished([*start, *PLAN], tmp_path, text=False, **variables)
        assert done.returncode == 0 and done.stdout.startswith(b"do    friction"), done.stderr


@pytest.mark.parametrize("megabytes", [30, 400])
def test_little_address_space_is_refused(tmp_path, megabytes):
    done = galinx(tmp_path, *RUN, shell=f'ulimit -v {megabytes}000; "$@"')
    is_refused(done, 3, "the address space is limited", "ulimit -v")
    assert not list(tmp_path.iterdir())


def test_a_python_that_optimises_too_much_is_refused(tmp_path):
    is_refused(galinx(tmp_path, *RUN, PYTHONOPTIMIZE="2"), 3, "unset PYTHONOPTIMIZE")
    assert galinx(tmp_path, *RUN, PYTHONOPTIMIZE="1").returncode == 0


def test_warnings_of_libraries_are_no_errors(tmp_path):
    assert galinx(tmp_path, *RUN, PYTHONWARNINGS="error").returncode == 0
    done = galinx(tmp_path, "plot", "x.h5", "--figure", "surface", PYTHONWARNINGS="error")
    assert done.returncode == 0 and not done.stderr


def test_without_a_home_one_is_asked_for(stranger):
    done = galinx("/", *PLAN, shell=f'{" ".join(stranger)} "$@"', without=("HOME",))
    is_refused(done, 3, "user 4321 has no entry in passwd", "set HOME")


@on_ranks
def test_a_python_that_cannot_run_galinx_is_refused(tmp_path, count):
    done = galinx(tmp_path, *count, *PLAN, GALINX_PYTHON="/nowhere/python")
    is_refused(done, 3, "GALINX_PYTHON is /nowhere/python", "3.11")
    bare = tmp_path / "python"  # without the folders that packages are in
    bare.write_text(f'#!/bin/sh\nexec {sys.executable} -S "$@"\n', encoding="utf-8")
    bare.chmod(bare.stat().st_mode | stat.S_IXUSR)
    done = galinx(tmp_path, *count, *PLAN, GALINX_PYTHON=str(bare))
    is_refused(done, 3, "click is not installed for", "docs/install.md")
