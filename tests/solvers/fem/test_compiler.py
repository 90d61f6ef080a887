"""The compiler of forms on machines that are not as they should be."""

import os
import subprocess
import sys
import threading
import time

import pytest
from mpi4py import MPI
from support import FEW_DEGREES, HOME, SCENE, clean_environment, command

from galinx.solvers.errors import CompilerError
from galinx.solvers.fem.compiler import compiling


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path


def test_stubs_of_a_killed_run_are_swept(cache):
    """FFCx alone would wait ten seconds for each and then give up."""
    assert command("run", SCENE, "-o", cache / "one.h5", *FEW_DEGREES).returncode == 0
    compiled = list((cache / "galinx").rglob("*.c.cached"))
    assert compiled
    for ready in compiled:  # as they are left by SIGKILL in the compiler
        ready.unlink()
        ready.with_suffix("").write_text("", encoding="utf-8")
    started = time.monotonic()
    done = command("run", SCENE, "-o", cache / "two.h5", *FEW_DEGREES)
    assert done.returncode == 0, done.stderr
    assert time.monotonic() - started < 10.0


def test_no_compiler(cache, monkeypatch):
    tools = cache / "bin"
    tools.mkdir()
    for name in ("bash", "dirname", "sed", "grep", "dpkg-query", "id", "cat", "readlink"):
        for folder in ("/bin", "/usr/bin"):
            if os.path.exists(f"{folder}/{name}") and not (tools / name).exists():
                (tools / name).symlink_to(f"{folder}/{name}")
    done = subprocess.run(
        [str(HOME / "run.sh"), "run", str(SCENE), "-o", str(cache / "out.h5")],
        env=clean_environment() | {"PATH": str(tools)}, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 3 and "there is no C compiler" in done.stderr
    assert "Traceback" not in done.stderr and not (cache / "out.h5").exists()


@pytest.mark.parametrize("ranks", [[], ["-n", "2"]])
def test_a_cache_that_cannot_be_written(cache, ranks):
    (cache / "galinx").write_text("a file where the folder should be", encoding="utf-8")
    done = command(*ranks, "run", SCENE, "-o", cache / "out.h5")
    assert done.returncode == 3 and "cannot be written" in done.stderr and "XDG_CACHE_HOME" in done.stderr
    assert done.stderr.count("error: ") == 1 and "Traceback" not in done.stderr


def test_two_processes_do_not_compile_at_once(cache):
    script = (
        "import sys, time; from mpi4py import MPI; from galinx.solvers.fem.compiler import compiling\n"
        "with compiling(MPI.COMM_SELF): print('in', flush=True); sys.stdin.read()\n"
    )
    environment = clean_environment() | {"PYTHONPATH": str(HOME)}
    other = subprocess.Popen(
        [sys.executable, "-c", script], env=environment, text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip
    assert other.stdout.readline() == "in\n"
    entered = threading.Event()

    def enter():
        with compiling(MPI.COMM_SELF):
            entered.set()

    waiting = threading.Thread(target=enter)
    waiting.start()
    assert not entered.wait(0.3)
    other.communicate("")
    assert entered.wait(10.0)
    waiting.join()


def test_an_unknown_failure_keeps_its_words(cache):
    words = pytest.raises(CompilerError, match="compiling a form failed: something else")
    with words, compiling(MPI.COMM_SELF):
        raise RuntimeError("something else")
