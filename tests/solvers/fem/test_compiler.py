"""The compiler of forms on machines that are not as they should be."""

import os
import random
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI
from support import FEW_DEGREES, HOME, SCENE, THOROUGH, clean_environment, command, space_on

from galinx.meshes.rings import Refinement
from galinx.postprocess.hdf5 import archive
from galinx.solvers.errors import CompilerError
from galinx.solvers.fem.versions import compiling

#: Bits that are flipped in what is kept of a form, and in forms that are compiled, which takes seconds
#: each; GALINX_THOROUGH=1 asks for as many as a release does.
FLIPS, COMPILED = (5000, 500) if THOROUGH else (100, 2)


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
    """Files that are found for a form, and what is said; where there are none FFCx's are made."""
    said = []
    with compiling(MPI.COMM_SELF, what, said.append) as options:
        folder = Path(options["cache_dir"])
        found = sorted(path.name for path in folder.iterdir())
        if not found:
            for name in ("form.c", "form.o", "form.c.cached"):
                (folder / name).write_text(name, encoding="utf-8")
            (folder / "form.so").write_bytes(bytes(range(256)) * 40)
    return found, said


def kept_in(cache):
    """The folders of forms that are kept."""
    return sorted(path for path in cache.glob("galinx/forms/*") if "." not in path.name)


def fifo(path):
    path.unlink()
    os.mkfifo(path)


def exchanged(path, change):
    path.write_bytes(change(path.read_bytes()))


DAMAGES = {
    "cut": lambda folder: exchanged(folder / "form.so", lambda data: data[: len(data) // 2]),
    "empty": lambda folder: exchanged(folder / "form.so", lambda data: b""),
    "zeros": lambda folder: exchanged(
        folder / "form.so", lambda data: data[:99] + bytes(200) + data[299:]
    ),
    "lost": lambda folder: (folder / "form.so").unlink(),
    "unreadable": lambda folder: fifo(folder / "form.so"),
    "no source": lambda folder: (folder / "form.c").unlink(),
    "no object": lambda folder: (folder / "form.o").unlink(),
    "not ready": lambda folder: (folder / "form.c.cached").unlink(),
    "another file": lambda folder: (folder / "other.so").write_bytes(b""),
    "no digest": lambda folder: (folder / "digest").unlink(),
    "digest cut": lambda folder: exchanged(folder / "digest", lambda data: data[:-1]),
    "digest unreadable": lambda folder: fifo(folder / "digest"),
    "only a file": lambda folder: (folder.rename(folder.with_suffix(".x")), folder.write_bytes(b"")),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_form_is_compiled_again_once(cache, damage):
    assert compiled() == ([], [])
    whole, said = compiled()
    assert "form.so" in whole and not said
    DAMAGES[damage](*kept_in(cache))
    found, (said,) = compiled()
    assert not found and "is damaged; it is compiled again" in said
    assert compiled() == (whole, [])


def test_a_form_with_a_flipped_bit_is_given_to_nobody(cache):
    compiled()
    chance, (kept,) = random.Random(4), kept_in(cache)
    whole = {path.name: path.read_bytes() for path in kept.iterdir()}
    for _ in range(FLIPS):
        path = chance.choice(sorted(path for path in kept.iterdir() if path.stat().st_size))
        data, bit = bytearray(whole[path.name]), chance.randrange(8 * len(whole[path.name]))
        data[bit // 8] ^= 1 << bit % 8
        path.write_bytes(data)
        found, (said,) = compiled()
        assert not found and "is damaged; it is compiled again" in said
        assert {path.name: path.read_bytes() for path in kept.iterdir()} == whole


def test_forms_that_changed_places_are_damaged(cache):
    compiled("one"), compiled("two")
    one, two = kept_in(cache)
    one.rename(cache / "one"), two.rename(one), (cache / "one").rename(two)
    for what in ("one", "two"):
        found, said = compiled(what)
        assert not found and "is damaged" in said[0]


def test_a_run_with_damaged_caches(cache, compiles):
    """Loading half a library ends the program with SIGBUS, an empty one is refused for ever."""
    first = command("run", SCENE, "-o", cache / "one.h5", *FEW_DEGREES)
    assert first.returncode == 0 and "damaged" not in first.stderr
    half, empty, *_ = sorted(cache.rglob("*.so"), key=lambda path: path.stat().st_size)
    os.truncate(half, half.stat().st_size // 2), os.truncate(empty, 0)
    (mesh,) = cache.rglob("*.mesh")
    exchanged(mesh, lambda data: data[:-99] + bytes([data[-99] ^ 64]) + data[-98:])
    second = command("run", SCENE, "-o", cache / "two.h5", *FEW_DEGREES)
    assert second.returncode == 0, second.stderr
    assert second.stderr.count("warning: the compiled form in ") == 2
    assert second.stderr.count("warning: the mesh kept in ") == 1
    v0, again = (archive.read(cache / f"{name}.h5")[0]["states/fem/v0"] for name in ("one", "two"))
    np.testing.assert_array_equal(v0, again)


def test_nobody_waits_for_what_a_killed_run_left(cache):
    """FFCx alone would wait ten seconds for a source that is not compiled, and then give up."""
    compiled()
    (kept,) = kept_in(cache)
    ruin = kept.rename(kept.with_suffix(".killed"))
    (ruin / "form.c.cached").unlink()
    assert compiled() == ([], []) and compiled()[0]


def test_no_compiler(cache, compiles):
    tools = cache / "bin"
    tools.mkdir()
    for name in ("bash", "env", "nproc", "dirname", "sed", "grep", "dpkg-query", "id", "cat", "readlink"):
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
        assert compiled() == ([], []) and "form.so" in compiled()[0]
        other.send_signal(signal.SIGCONT)
        other.communicate("")
    assert "form.so" in compiled()[0] and len(list(cache.glob("galinx/forms/*"))) == 1


def test_an_unknown_failure_keeps_its_words(cache):
    words = pytest.raises(CompilerError, match="compiling a form failed: something else")
    with words, compiling(MPI.COMM_SELF, "form"):
        raise RuntimeError("something else")
    assert not kept_in(cache)
