"""The compiler of forms on machines that are not as they should be."""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest
from mpi4py import MPI
from support import SCENE, clean_environment, command, space_on

from galinx.meshes.rings import Refinement
from galinx.solvers.errors import CompilerError
from galinx.solvers.fem.versions import compiling


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path


@pytest.fixture(scope="module")
def compiles(tmp_path_factory):
    """For what dolfinx has to compile: newer ones compile nothing of an element."""
    folder = tmp_path_factory.mktemp("compiles")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(folder))
        space_on("confocal", Refinement(2, 0.35, 1, (3.0,)), 1)
    if not list(folder.rglob("*.so")):
        pytest.skip("this dolfinx compiles nothing")


def compiled(what="form"):
    """Files that are found for a form; where there are none FFCx's are made."""
    with compiling(MPI.COMM_SELF, what) as options:
        folder = Path(options["cache_dir"])
        found = sorted(path.name for path in folder.iterdir())
        if not found:
            for name in ("form.c", "form.o", "form.c.cached"):
                (folder / name).write_text(name, encoding="utf-8")
            (folder / "form.so").write_bytes(bytes(range(256)) * 40)
    return found


def kept_in(cache):
    """The folders of forms that are kept."""
    return sorted(path for path in cache.glob("galinx/forms/*") if "." not in path.name)


def test_a_form_is_compiled_once(cache):
    assert compiled() == [] and "form.so" in compiled()
    assert compiled("another") == [] and len(kept_in(cache)) == 2


def test_nobody_waits_for_what_a_killed_run_left(cache):
    """FFCx alone would wait ten seconds for a source that is not compiled, and then give up."""
    compiled()
    (kept,) = kept_in(cache)
    ruin = kept.rename(kept.with_suffix(".killed"))
    (ruin / "form.c.cached").unlink()
    assert compiled() == [] and compiled()


def test_no_compiler(cache, compiles):
    tools = cache / "bin"
    tools.mkdir()
    for name in ("bash", "env", "nproc", "dirname", "sed", "grep", "dpkg-query", "id", "cat", "readlink"):
        for folder in ("/bin", "/usr/bin"):
            if os.path.exists(f"{folder}/{name}") and not (tools / name).exists():
                (tools / name).symlink_to(f"{folder}/{name}")
    done = command("run", SCENE, "-o", cache / "out.h5", PATH=str(tools))
    assert done.returncode == 3 and "there is no C compiler" in done.stderr
    assert "Traceback" not in done.stderr and not (cache / "out.h5").exists()


@pytest.mark.parametrize("ranks", [[], ["-n", "2"]])
def test_a_cache_that_cannot_be_written(cache, compiles, ranks):
    (cache / "galinx").write_text("a file where the folder should be", encoding="utf-8")
    done = command(*ranks, "run", SCENE, "-o", cache / "out.h5")
    assert done.returncode == 3 and "cannot be written" in done.stderr and "XDG_CACHE_HOME" in done.stderr
    assert done.stderr.count("error: ") == 1 and "Traceback" not in done.stderr


@contextmanager
def compiling_elsewhere():
    """Another process that has begun to compile the form; it is killed after the block."""
    script = (
        "import sys; from mpi4py import MPI; from galinx.solvers.fem.versions import compiling\n"
        "with compiling(MPI.COMM_SELF, 'form') as options:\n"
        "    open(options['cache_dir'] + '/theirs.so', 'x')\n"
        "    print('in', flush=True); sys.stdin.read()\n"
    )
    other = subprocess.Popen(
        [sys.executable, "-c", script], env=clean_environment(), text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip
    try:
        assert other.stdout.readline() == "in\n"
        yield other
    finally:
        other.kill()
        other.communicate()


def test_nobody_waits_for_another_process(cache):
    """Both compile the form, even where one was stopped, and what is whole first is kept."""
    with compiling_elsewhere() as other:
        other.send_signal(signal.SIGSTOP)
        assert compiled() == [] and "form.so" in compiled()
        other.send_signal(signal.SIGCONT)
        other.communicate("")
    assert "form.so" in compiled() and len(list(cache.glob("galinx/forms/*"))) == 1


def test_an_unknown_failure_keeps_its_words(cache):
    words = pytest.raises(CompilerError, match="compiling a form failed: something else")
    with words, compiling(MPI.COMM_SELF, "form"):
        raise RuntimeError("something else")
    assert not kept_in(cache)
