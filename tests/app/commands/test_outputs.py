"""Whatever a command is told to write to: nothing is lost, nothing half written, nothing hangs."""

import os
import shutil
from contextlib import contextmanager, nullcontext

import pytest
from support import HOME, SCENE, at_most, finished, full_disk, here

from galinx.app.run import flow

FOREIGN = b"precious"
#: Each command with TARGET for what it is told to write to.
COMMANDS = {
    "init": ["init", "table1", "-o", "TARGET"],
    "run": ["run", "scene.toml", "-o", "TARGET"],
    "resume": ["run", "scene.toml", "-o", "TARGET", "--resume", "--quiet"],
    "log": ["run", "scene.toml", "-o", "other.h5", "--log", "TARGET"],
    "report": ["report", "in.h5", "-o", "TARGET"],
    "fields": ["fields", "in.h5", "-o", "TARGET"],
    "csv": ["csv", "in.h5", "-o", "TARGET"],
    "plot": ["plot", "in.h5", "-o", "TARGET"],
    "figure": ["plot", "in.h5", "-o", "."],
}
INPUTS = ("in.h5", "scene.toml")


@pytest.fixture(scope="module")
def inputs(archive, tmp_path_factory):
    """A folder with what commands read."""
    folder = tmp_path_factory.mktemp("made")
    shutil.copy(archive, folder / "in.h5")
    assert here("init", "table1", "-o", "scene.toml", cwd=folder).returncode == 0
    return folder


@pytest.fixture
def place(inputs, tmp_path, monkeypatch):
    """A copy of that folder, which is the current one."""
    for one in INPUTS:
        shutil.copy(inputs / one, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def ended(arguments, cwd, full=False):
    """A finished command, which was told once what is wrong if anything was; on a full disk or not."""
    with at_most(100.0), full_disk(20) if full else nullcontext():
        done = here(*arguments, cwd=cwd)
    assert "Traceback" not in done.stderr, done.stderr
    assert done.returncode in (0, 1, 2, 3), done.stderr
    assert done.stderr.count("error: ") == (done.returncode > 1), done.stderr
    return done


def content(folder):
    """Names in a folder, and what files hold."""
    return {path: path.read_bytes() if path.is_file() else b"" for path in folder.rglob("*")}


def words_of(name):
    """Words of a command that writes to ``target``, and that file."""
    target = "in_friction.png" if name == "figure" else "target"
    return [word.replace("TARGET", target) for word in COMMANDS[name]], target


@pytest.mark.parametrize("name", COMMANDS)
def test_nothing_is_lost(place, name):
    """A file of others is not replaced unasked; what is no file, or read by the command, never."""
    words, target = words_of(name)
    there = [(lambda path: path.write_bytes(FOREIGN), [])]
    if name != "figure":  # which is refused once it is drawn, which takes a second each time
        there.append((os.mkfifo, ["--overwrite"]))
        if words[1] in INPUTS:
            there.append((lambda path: path.hardlink_to(words[1]), ["--overwrite"]))
    for make, flags in there:
        make(place / target)
        before = content(place)
        assert ended(words + flags, place).returncode == 2
        assert content(place) == before
        (place / target).unlink()


@contextmanager
def patch_input(file):
    """A file as this process's standard input in the block."""
    before = os.dup(0)
    os.dup2(file.fileno(), 0)
    try:
        yield
    finally:
        os.dup2(before, 0)
        os.close(before)


@pytest.mark.parametrize(
    "words, message",
    [
        (("run", "scene.toml", "-o", "x.h5", "--log", "x.h5"), "x.h5 is also"),
        (("-x", "own.py", "report", "in.h5", "-o", "own.py", "--overwrite"), "own.py is also"),
        (("-x", "own.py", "run", "scene.toml", "--log", "own.py"), "own.py is also"),
        (("-x", "own.py", "run", "scene.toml", "-o", "own.py", "--overwrite"), "own.py is also"),
        (("run", "/dev/stdin", "-o", "scene.toml", "--overwrite"), "ends with .toml, expected"),
        (("paper", "-o", "."), "study.h5 exists and is not an archive of galinx"),
        (("run", "fifo"), "cannot read fifo: it is a FIFO"),
        (("plan", "/dev/zero"), "cannot read /dev/zero: it is a device"),
        (("show", "fifo"), "fifo is not a file"),
        (("check", "/dev/zero"), "is not a file"),
        (("-x", "fifo", "materials"), "cannot read fifo"),
    ],
)
def test_what_is_no_place_is_said(place, tmp_path, words, message):
    (tmp_path / "own.py").write_text("import galinx\n", encoding="utf-8")
    (tmp_path / "study.h5").write_bytes(FOREIGN)
    os.mkfifo(tmp_path / "fifo")
    before = content(tmp_path)
    with (tmp_path / "scene.toml").open() as scene, patch_input(scene):
        done = ended(words, tmp_path)
    assert done.returncode == 2 and message in done.stderr and done.stderr.count("error: ") == 1
    assert content(tmp_path) == before


@pytest.mark.parametrize("scene", ["/dev/stdin", "<(cat)"])
def test_a_scene_may_come_from_a_pipe(inputs, scene):
    text = (inputs / "scene.toml").read_text(encoding="utf-8")
    done = finished(["bash", "-c", f'"{HOME}/run.sh" plan {scene}'], given=text)
    assert done.returncode == 0 and "friction" in done.stdout, done.stderr


def test_a_file_that_appears_during_a_run_is_kept(tmp_path, monkeypatch):
    """It appears before the archive gets its name; what is computed is kept, too."""
    words = ["run", str(SCENE), "-o", "out.h5", "--set", 'solve.methods=["closed_form"]']
    true = flow.compute

    def appears(*arguments):
        found = true(*arguments)
        (tmp_path / "out.h5").write_bytes(FOREIGN)
        return found

    with monkeypatch.context() as patched:
        patched.setattr(flow, "compute", appears)
        done = ended(words, tmp_path)
    assert done.returncode == 3 and "something appeared there meanwhile" in done.stderr
    assert "12 finished states are kept, go on with --resume" in done.stderr
    assert (tmp_path / "out.h5").read_bytes() == FOREIGN
    (tmp_path / "out.h5").rename(tmp_path / "precious")
    assert ended([*words, "--resume"], tmp_path).returncode == 0
    assert sorted(os.listdir(tmp_path)) == ["out.h5", "precious"]
