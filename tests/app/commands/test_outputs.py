"""Whatever a command is told to write to: nothing is lost, nothing half written, nothing hangs.

GALINX_THOROUGH=1 tries every command with everything; the ordinary suite some of them.
"""

import os
import random
import shutil
import socket
import stat
import subprocess
from contextlib import contextmanager, nullcontext
from itertools import product
from pathlib import Path

import pytest
from support import HOME, SCENE, THOROUGH, at_most, clean_environment, full_disk, here

from galinx.app.run import flow
from galinx.postprocess.target import ARCHIVE, FIELDS, LOG, PAGE, PNG, TABLE, Kind

FOREIGN = b"precious"
#: Each command with TARGET for what it is told to write to, and the kind of file that this is.
COMMANDS = {
    "init": (["init", "table1", "-o", "TARGET"], None),
    "run": (["run", "scene.toml", "-o", "TARGET"], None),
    "resume": (["run", "scene.toml", "-o", "TARGET", "--resume", "--quiet"], None),
    "log": (["run", "scene.toml", "-o", "other.h5", "--log", "TARGET"], LOG),
    "report": (["report", "in.h5", "-o", "TARGET"], PAGE),
    "fields": (["fields", "in.h5", "-o", "TARGET"], FIELDS),
    "csv": (["csv", "in.h5", "-o", "TARGET"], TABLE),
    "plot": (["plot", "in.h5", "-o", "TARGET"], None),
    "figure": (["plot", "in.h5", "-o", "."], PNG),
}
INPUTS = ("in.h5", "scene.toml")


def _socket(path):
    server = socket.socket(socket.AF_UNIX)
    server.bind(str(path))
    server.close()


#: What is there, by its name; made of a path and a file of the command's own kind.
THERE = {
    "nothing": lambda path, own: None,
    "empty": lambda path, own: path.touch(),
    "foreign": lambda path, own: path.write_bytes(FOREIGN),
    "hdf5": lambda path, own: path.write_bytes(b"\x89HDF\r\n\x1a\n" + FOREIGN),
    "own": lambda path, own: shutil.copy(own, path),
    "archive": lambda path, own: shutil.copy("in.h5", path),
    "scene": lambda path, own: shutil.copy("scene.toml", path),
    "folder": lambda path, own: (path.mkdir(), (path / "a").write_bytes(FOREIGN)),
    "fifo": lambda path, own: os.mkfifo(path),
    "socket": lambda path, own: _socket(path),
    "device": lambda path, own: path.symlink_to("/dev/full"),
    "dangling": lambda path, own: path.symlink_to("nowhere"),
    "loop": lambda path, own: path.symlink_to(path.name),
    "link": lambda path, own: (Path("there").write_bytes(FOREIGN), path.symlink_to("there")),
    "link to own": lambda path, own: (shutil.copy(own, "there"), path.symlink_to("there")),
    "link to archive": lambda path, own: path.symlink_to("in.h5"),
    "link to scene": lambda path, own: path.symlink_to("scene.toml"),
    "hard archive": lambda path, own: path.hardlink_to("in.h5"),
    "hard scene": lambda path, own: path.hardlink_to("scene.toml"),
}  # fmt: skip
FLAGS = ("", "--overwrite", "full")
#: What no flag allows to write to, and what these do not where the command reads it.
NEVER = ("fifo", "socket", "device", "dangling", "loop")
READ = {
    "link to archive": "in.h5", "hard archive": "in.h5", "link to scene": "scene.toml",
    "hard scene": "scene.toml",
}  # fmt: skip
ALL = [*product(COMMANDS, THERE, FLAGS)]
CHOSEN = ALL if THOROUGH else random.Random(14).sample(ALL, 12)


@pytest.fixture(scope="module")
def made(archive, tmp_path_factory):
    """A folder with the inputs, and a file of each kind."""
    folder = tmp_path_factory.mktemp("made")
    shutil.copy(archive, folder / "in.h5")
    assert here("init", "table1", "-o", "scene.toml", cwd=folder).returncode == 0
    done = here("run", "scene.toml", "-o", "a.h5", "--log", "a.log", cwd=folder)
    assert done.returncode == 0, done.stderr
    for arguments in (
        ("report", "a.h5"),
        ("plot", "a.h5"),
        ("fields", "in.h5", "-o", "a.hdf"),
        ("csv", "a.h5", "-o", "a.csv"),
    ):
        assert here(*arguments, cwd=folder).returncode == 0
    own = {
        ARCHIVE: "a.h5",
        LOG: "a.log",
        PAGE: "a.html",
        PNG: "a_friction.png",
        FIELDS: "a.hdf",
        TABLE: "a.csv",
    }
    return folder, {kind: folder / name for kind, name in own.items()}


def ended(arguments, cwd, full=False):
    """A finished command, which was told once what is wrong if anything was; on a full disk or not."""
    with at_most(100.0), full_disk(20) if full else nullcontext():
        done = here(*arguments, cwd=cwd)
    assert "Traceback" not in done.stderr, done.stderr
    assert done.returncode in (0, 1, 2, 3), done.stderr
    assert done.stderr.count("error: ") == (done.returncode > 1), done.stderr
    return done


def content(folder):
    """What every name in a folder is, and what it holds."""
    found = {}
    for path in folder.rglob("*"):
        kind = stat.S_IFMT(path.lstat().st_mode)
        link = os.readlink(path) if path.is_symlink() else ""
        found[path] = kind, link, path.read_bytes() if stat.S_ISREG(kind) else b""
    return found


@pytest.mark.parametrize("name, there, flag", CHOSEN, ids=lambda value: value or "none")
def test_nothing_is_lost(made, tmp_path, monkeypatch, name, there, flag):
    folder, own = made
    arguments, kind = COMMANDS[name]
    monkeypatch.chdir(tmp_path)
    for one in INPUTS:
        shutil.copy(folder / one, tmp_path)
    target = tmp_path / ("in_friction.png" if name == "figure" else "target")
    THERE[there](target, own[kind or ARCHIVE])
    before = content(tmp_path)
    words = [word.replace("TARGET", target.name) for word in arguments]
    done = ended(words + ["--overwrite"] * (flag == "--overwrite"), tmp_path, flag == "full")
    after = content(tmp_path)
    assert not [path for path in after if path.name.startswith(".")]
    lost = {path.name for path in before if after.get(path) != before[path]}
    unfit = there not in ("nothing", "folder") if name == "plot" else there == "folder"
    if unfit or there in NEVER or READ.get(there) in arguments:
        assert done.returncode == 2
    place = target.resolve() if there != "loop" else target
    if done.returncode or name == "plot":
        assert not lost
    else:
        assert lost <= {place.name}
        assert name == "log" or flag == "--overwrite" or there in ("nothing", "own", "link to own")
        check_made(place, name, kind)
    if flag == "full" and name != "plot" and not there.endswith("own"):
        assert done.returncode > 1 and (name == "log" or there != "nothing" or not target.exists())


def check_made(place, name, kind: Kind | None):
    """Is what a command says it has made there, and whole?"""
    if kind:
        assert kind.of(place)
    elif name in ("run", "resume"):
        assert here("check", place).returncode == 0
    elif name == "init":
        assert place.read_bytes().endswith(b"\n") and here("plan", place).returncode == 0


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
        (("run", "/dev/stdin", "-o", "scene.toml", "--overwrite"), "scene.toml is also"),
        (("paper", "-o", "."), "study.h5 exists and is not an archive of galinx"),
        (("run", "fifo"), "cannot read fifo: it is a FIFO"),
        (("plan", "/dev/zero"), "cannot read /dev/zero: it is a device"),
        (("show", "fifo"), "fifo is not a file"),
        (("check", "/dev/zero"), "is not a file"),
        (("-x", "fifo", "materials"), "cannot read fifo"),
    ],
)
def test_what_is_no_place_is_said(made, tmp_path, words, message):
    for one in INPUTS:
        shutil.copy(made[0] / one, tmp_path)
    (tmp_path / "own.py").write_text("import galinx\n", encoding="utf-8")
    for name in ("study.h5",):
        (tmp_path / name).write_bytes(FOREIGN)
    os.mkfifo(tmp_path / "fifo")
    before = content(tmp_path)
    with (tmp_path / "scene.toml").open() as scene, patch_input(scene):
        done = ended(words, tmp_path)
    assert done.returncode == 2 and message in done.stderr and done.stderr.count("error: ") == 1
    assert content(tmp_path) == before


@pytest.mark.parametrize("scene", ["/dev/stdin", "<(cat)"])
def test_a_scene_may_come_from_a_pipe(made, scene):
    text = (made[0] / "scene.toml").read_text(encoding="utf-8")
    done = subprocess.run(
        ["bash", "-c", f'"{HOME}/run.sh" plan {scene}'], env=clean_environment(), capture_output=True,
        text=True, input=text, timeout=300,
    )  # fmt: skip
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
