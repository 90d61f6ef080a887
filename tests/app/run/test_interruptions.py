"""What happens to finished work when the machine, another run or the user interferes."""

import json
import os
import random
import re
import signal
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest
from support import HOME, THOROUGH, clean_environment, command, computed, finished, here

from galinx import template
from galinx.app.results import check
from galinx.postprocess.hdf5 import archive
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.punch import SlidingPunch

#: GALINX_THOROUGH=1 asks for as many kills and signals as a release does.
#: What a run says that was stopped or killed: rank 0 of its finished states where it can, run.sh of a
#: rank that is gone, and so may MPI.
SAID = re.compile(
    r"(\[.*\n|warning: .*\n)*(?=.)"
    r"(error: interrupted; (\d+ finished states are kept, go on with --resume"
    r"|nothing was (finished|written))\n)?"
    r"(error: ranks could not be started, or were killed .*; a run goes on with --resume\n)?"
)

#: A sweep of 4 speeds with two parts each: of 1000 states, and of the other 20.
SWEEP = {
    "motion.c": [0.0, 0.2, 0.4, 0.6],
    "motion.X_over_L": [round(n / 339, 6) for n in range(340)],
    "solve.tolerance": 1e-2,
    "output.quantities": ["friction", "sif"],
}


@pytest.fixture(scope="module")
def sweep(tmp_path_factory):
    """The scene of a sweep, what its undisturbed archive has, and that archive."""
    folder = tmp_path_factory.mktemp("sweep")
    scene, target = folder / "sweep.toml", folder / "whole.h5"
    scene.write_text(template("tables4_5", SWEEP).text, encoding="utf-8")
    assert here("run", scene, "-o", target).returncode == 0
    return scene, contents(target), target


@pytest.fixture(scope="module")
def on_two_ranks(sweep, tmp_path_factory):
    """What the sweep's archive has when two ranks made it."""
    target = tmp_path_factory.mktemp("two") / "whole.h5"
    assert command("-n", 2, "run", sweep[0], "-o", target).returncode == 0
    return contents(target)


def contents(path):
    """Datasets and attributes of an archive, but for date and times, and what a full cache skipped."""
    data, attributes = archive.read(path)
    del data["run/seconds"], data["run/steps"], data["run/skipped"]
    del attributes["created"], attributes["versions"]
    return data, attributes


def same(one, other):
    assert one[1] == other[1]
    assert one[0].keys() == other[0].keys()
    for name, values in one[0].items():
        np.testing.assert_array_equal(values, other[0][name], err_msg=name)


@contextmanager
def started(*arguments):
    """A command that runs while the block does; its whole process group ends with it."""
    process = subprocess.Popen(
        [str(HOME / "run.sh"), *map(str, arguments)], env=clean_environment(), text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
        # Tests that run in the background ignore SIGINT, and what is ignored stays ignored.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    try:
        yield process
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def wait_for_parts(folder, count=1):
    deadline = time.monotonic() + 60.0
    while len(list(folder.glob(".*.work/*.part"))) < count:
        assert time.monotonic() < deadline
        time.sleep(0.005)


def processes(target):
    """Processes of the command that writes ``target``: ``galinx``, ``mpirun``, ranks ``0`` and ``1``."""
    found = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_text(encoding="utf-8").split("\0")
            variables = (folder / "environ").read_text(encoding="utf-8").split("\0")
        except (OSError, UnicodeDecodeError):
            continue
        if str(target) in words and re.search("python|mpirun", words[0]):
            ranks = ("OMPI_COMM_WORLD_RANK=", "PMI_RANK=")
            rank = next((text.split("=")[1] for text in variables if text.startswith(ranks)), None)
            found["mpirun" if "mpirun" in words[0] else rank or "galinx"] = int(folder.name)
    return found


#: Number of ranks, who of them is hit, by which signal, after how many parts.
HITS = [
    (1, "galinx", signal.SIGHUP, 1), (1, "galinx", signal.SIGKILL, 3), (2, "mpirun", signal.SIGKILL, 2),
    (2, "1", signal.SIGINT, 2), (2, "0", signal.SIGKILL, 2),
]  # fmt: skip
if THOROUGH:
    draw = random.Random(3)
    hit = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)
    HITS += [(1, "galinx", draw.choice(hit), draw.randrange(-3, 7)) for _ in range(60)]
    HITS += [
        (2, draw.choice(("galinx", "mpirun", "0", "1")), draw.choice(hit), draw.randrange(-3, 7))
        for _ in range(140)
    ]


@pytest.mark.parametrize("count, who, number, parts", HITS)
def test_whoever_is_hit_the_run_ends_in_order_and_is_resumed(
    sweep, on_two_ranks, tmp_path, count, who, number, parts
):
    scene, whole, _ = sweep
    target, ranks = tmp_path / "out.h5", ("-n", count) if count > 1 else ()
    with started(*ranks, "run", scene, "-o", target) as process:
        if parts > 0:
            wait_for_parts(tmp_path, parts)
        else:  # in the middle of its start
            time.sleep(random.Random(parts).uniform(0.0, 1.5))
        with suppress(KeyError, ProcessLookupError):  # it may not be there yet, or be done
            os.kill(processes(target)[who], number)
        _, errors = process.communicate(timeout=60)
    deadline = time.monotonic() + 30.0
    while processes(target):  # those that a killed one leaves behind
        assert time.monotonic() < deadline
        time.sleep(0.05)
    if who == "galinx" and number == signal.SIGKILL and process.returncode:
        assert process.returncode == -signal.SIGKILL and not errors
    elif process.returncode:
        assert process.returncode == 3 and re.fullmatch(SAID, errors), errors
    else:
        # It was done before the signal came, and tells what it tells of its scene.
        assert target.exists() and all(line.startswith("warning: ") for line in errors.splitlines())
    if resumed := not target.exists():
        done = (command if ranks else here)(*ranks, "run", scene, "-o", target, "--resume")
        assert done.returncode == 0, done.stderr
    same(contents(target), whole if count == 1 else on_two_ranks)
    if resumed or not process.returncode:  # or it was killed when it was about to clear up
        assert not list(tmp_path.glob(".*"))


def test_a_run_is_locked_and_when_it_is_stopped_keeps_what_is_finished(sweep, tmp_path):
    scene, whole, _ = sweep
    target = tmp_path / "out.h5"
    with started("run", scene, "-o", target) as process:
        wait_for_parts(tmp_path, 3)
        process.send_signal(signal.SIGSTOP)
        second = here("run", scene, "-o", target)
        assert second.returncode == 3 and "another run is writing" in second.stderr
        process.send_signal(signal.SIGTERM)
        process.send_signal(signal.SIGCONT)
        _, errors = process.communicate(timeout=30)
    assert process.returncode == 3
    assert "interrupted; " in errors and "go on with --resume" in errors and "Traceback" not in errors
    refused = here("run", scene, "-o", target)
    assert refused.returncode == 3 and "an interrupted run left" in refused.stderr
    first, _, third, *_ = sorted(tmp_path.glob(".*.work/*.part"))  # of 1000 states each
    first.rename(tmp_path / "first"), third.rename(first), (tmp_path / "first").rename(third)
    done = here("run", scene, "-o", target, "--resume")
    assert done.returncode == 0 and "kept parts that are damaged: 2; computed again" in done.stderr
    same(contents(target), whole)


@pytest.mark.parametrize("ranks", [(), ("-n", "2")])
def test_commands_that_keep_nothing_stop_in_order(tmp_path, ranks):
    with started(*ranks, "paper", "-o", tmp_path / "out", "-v") as process:
        assert process.stderr.readline()  # it has begun to work
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 3
    assert errors.endswith("error: interrupted; nothing was written\n") and "Traceback" not in errors
    assert not list((tmp_path / "out").glob("[!.]*"))


def test_archives_that_were_finished_are_named(tmp_path):
    with started("paper", "-o", tmp_path) as process:
        while not (tmp_path / "study.h5").exists():
            assert process.poll() is None
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    written = [path.name for path in tmp_path.glob("[!.]*")]
    assert "error: interrupted; written is " in errors and errors.endswith(" alone\n")
    assert all(name in errors for name in written) and process.returncode == 3


def test_what_is_ignored_already_stays_ignored(tmp_path):
    script = (
        "import signal; from galinx.app import process; process.listen()\n"
        "print([signal.getsignal(number) == signal.SIG_IGN for number in process.SIGNALS])"
    )
    shell = ("env", "--default-signal=INT,TERM", "bash", "-c", "trap '' HUP; exec \"$@\"", "bash")
    done = finished([*shell, sys.executable, "-c", script])
    assert done.stdout == "[False, False, True]\n", done.stderr


def test_a_speed_that_cannot_be_solved_does_not_end_the_sweep(tables_run, monkeypatch, tmp_path):
    true, refused, whole = SlidingPunch.__init__, {0.6}, tables_run.data

    def punch(self, space, response, *rest, **named):
        if response.c in refused:
            raise SolveError("provoked")
        true(self, space, response, *rest, **named)

    monkeypatch.setattr(SlidingPunch, "__init__", punch)
    computed().save(tmp_path / "out.h5")
    data, attributes = archive.read(tmp_path / "out.h5")
    assert attributes["verdict"] == "FAIL" and list(data["run/failures"]) == ["c = 0.6: provoked"]
    assert "not solved, c = 0.6: provoked" in json.loads(attributes["verdict_reasons"])
    np.testing.assert_array_equal(data["states/fem/v0"][:6], whole["states/fem/v0"][:6])
    assert np.isnan(data["states/fem/v0"][6:]).all()
    np.testing.assert_array_equal(data["states/closed_form/K_I"], whole["states/closed_form/K_I"])
    monkeypatch.setattr(check, "_ROWS", 3)  # some of only those that could not be solved
    assert check.faults(tmp_path / "out.h5") == []
    refused.add(4.786e-7)  # every speed: the closed form's answers are left
    alone = computed()
    assert alone.verdict == "FAIL" and len(alone.data["run/failures"]) == 2
    np.testing.assert_array_equal(alone.data["states/closed_form/K_I"], whole["states/closed_form/K_I"])
    assert {column.path for column in alone.table()} >= {"states/closed_form/K_I_left"}
    with pytest.raises(SolveError, match=r"c = 4.786e-07: provoked"):
        computed(changes={"solve.methods": ["fem"]})


@pytest.fixture
def tiny_disk(tmp_path):
    """A file system of a megabyte."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=1m", "none", str(folder)]
    if os.getuid() or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("needs root and mount")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_a_full_disk(sweep, tiny_disk):
    scene, whole, _ = sweep
    target = tiny_disk / "out.h5"
    target.write_bytes(b"an earlier archive")
    done = here("run", scene, "-o", target, "--overwrite")
    assert done.returncode == 3 and "Traceback" not in done.stderr
    assert "No space left on device" in done.stderr and " are free" in done.stderr
    assert target.read_bytes() == b"an earlier archive"
    assert not list(tiny_disk.rglob("*.partial"))
    subprocess.run(["mount", "-o", "remount,size=1g", str(tiny_disk)], check=True)
    assert here("run", scene, "-o", target, "--overwrite", "--resume").returncode == 0
    same(contents(target), whole)


def test_a_folder_that_cannot_be_written(sweep, tiny_disk):
    scene, *_ = sweep
    subprocess.run(["mount", "-o", "remount,ro", str(tiny_disk)], check=True)
    done = here("run", scene, "-o", tiny_disk / "out.h5")
    assert done.returncode == 3 and "Read-only file system" in done.stderr
