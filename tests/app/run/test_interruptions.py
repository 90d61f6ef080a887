"""What happens to finished work when the machine, another run or the user interferes."""

import json
import os
import random
import signal
import subprocess
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from support import HOME, clean_environment, command, computed

from galinx import template
from galinx.postprocess.hdf5 import archive
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.punch import SlidingPunch

#: Moments at which a run is killed; GALINX_THOROUGH=1 asks for as many as a release does.
KILLS = 20 if os.environ.get("GALINX_THOROUGH") else 4

#: A sweep of 6 speeds with two parts each: of 1000 states, and of the other 20.
SWEEP = {
    "motion.c": [round(0.14 * n, 2) for n in range(6)],
    "motion.X_over_L": [round(n / 339, 6) for n in range(340)],
    "solve.tolerance": 1e-4,
}


@pytest.fixture(scope="module")
def sweep(tmp_path_factory):
    """The scene of a sweep, what its undisturbed archive has, and that archive."""
    folder = tmp_path_factory.mktemp("sweep")
    scene, target = folder / "sweep.toml", folder / "whole.h5"
    scene.write_text(template("tables4_5", SWEEP).text, encoding="utf-8")
    assert command("run", scene, "-o", target).returncode == 0
    return scene, contents(target), target


def contents(path):
    """Datasets and attributes of an archive, but for date and times, and what a full cache skipped."""
    data, attributes = archive.read(path)
    del data["run/seconds"], data["run/steps"], data["run/skipped"]
    del attributes["created"], attributes["versions"]  # gmsh is met where no mesh is kept
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


def test_killed_at_any_moment_and_resumed_gives_the_same_archive(sweep, tmp_path):
    scene, whole, _ = sweep
    moments = random.Random(3)
    resumed = 0
    for n in range(KILLS):
        target = tmp_path / f"{n}.h5"
        with started("run", scene, "-o", target) as process:
            time.sleep(moments.uniform(0.2, 2.2))
            os.killpg(process.pid, signal.SIGKILL)
        if not target.exists():
            resumed += 1
            done = command("run", scene, "-o", target, "--resume")
            assert done.returncode == 0, done.stderr
        same(contents(target), whole)
        assert not list(tmp_path.glob(".*"))
    assert resumed


def test_sigterm_keeps_what_is_finished(sweep, tmp_path):
    scene, whole, _ = sweep
    target = tmp_path / "out.h5"
    with started("run", scene, "-o", target) as process:
        wait_for_parts(tmp_path, 3)
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=30)
    assert process.returncode == 3
    assert "interrupted; " in errors and "go on with --resume" in errors and "Traceback" not in errors
    refused = command("run", scene, "-o", target)
    assert refused.returncode == 3 and "an interrupted run left" in refused.stderr
    first, _, third, *_ = sorted(tmp_path.glob(".*.work/*.part"))  # of 1000 states each
    first.rename(tmp_path / "first"), third.rename(first), (tmp_path / "first").rename(third)
    done = command("run", scene, "-o", target, "--resume")
    assert done.returncode == 0 and "kept parts that are damaged: 2; computed again" in done.stderr
    same(contents(target), whole)


def test_a_killed_rank_ends_the_job_and_the_rest_is_resumed(sweep, tmp_path):
    scene, *_ = sweep
    target = tmp_path / "out.h5"
    with started("-n", "2", "run", scene, "-o", target) as process:
        wait_for_parts(tmp_path, 2)
        found = subprocess.run(["pgrep", "-f", f"galinx run {scene}"], capture_output=True, text=True)
        (second,) = [pid for pid in found.stdout.split() if rank_of(pid) == "1"]
        os.kill(int(second), signal.SIGKILL)
        killed = time.monotonic()
        process.communicate(timeout=30)
        assert time.monotonic() - killed < 5.0
    assert process.returncode != 0 and not target.exists()
    done = command("-n", "2", "run", scene, "-o", target, "--resume")
    assert done.returncode == 0, done.stderr
    assert command("check", target).returncode == 0


def rank_of(pid):
    try:
        environment = Path(f"/proc/{pid}/environ").read_text(encoding="utf-8").split("\0")
    except OSError:
        return None
    names = ("OMPI_COMM_WORLD_RANK=", "PMI_RANK=")
    return next((e.split("=")[1] for e in environment if e.startswith(names)), None)


def test_two_runs_do_not_write_the_same_archive(sweep, tmp_path):
    scene, whole, _ = sweep
    target = tmp_path / "out.h5"
    with started("run", scene, "-o", target) as process:
        wait_for_parts(tmp_path)
        second = command("run", scene, "-o", target)
        process.communicate(timeout=60)
    assert second.returncode == 3 and "another run is writing" in second.stderr
    assert process.returncode == 0
    same(contents(target), whole)


def test_a_speed_that_cannot_be_solved_does_not_end_the_sweep(tables_run, monkeypatch, tmp_path):
    true, refused, whole = SlidingPunch.__init__, {0.6}, tables_run.data

    def punch(self, space, response, *rest):
        if response.c in refused:
            raise SolveError("provoked")
        true(self, space, response, *rest)

    monkeypatch.setattr(SlidingPunch, "__init__", punch)
    computed().save(tmp_path / "out.h5")
    data, attributes = archive.read(tmp_path / "out.h5")
    assert attributes["verdict"] == "FAIL" and list(data["run/failures"]) == ["c = 0.6: provoked"]
    assert "not solved, c = 0.6: provoked" in json.loads(attributes["verdict_reasons"])
    np.testing.assert_array_equal(data["states/fem/v0"][:6], whole["states/fem/v0"][:6])
    assert np.isnan(data["states/fem/v0"][6:]).all()
    np.testing.assert_array_equal(data["states/closed_form/K_I"], whole["states/closed_form/K_I"])
    assert command("check", tmp_path / "out.h5").returncode == 0
    refused.add(4.786e-7)
    with pytest.raises(SolveError, match=r"c = 4.786e-07: provoked"):
        computed()


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
    done = command("run", scene, "-o", target, "--overwrite")
    assert done.returncode == 3 and "Traceback" not in done.stderr
    assert "No space left on device" in done.stderr and " are free" in done.stderr
    assert target.read_bytes() == b"an earlier archive"
    assert not list(tiny_disk.rglob("*.partial"))
    subprocess.run(["mount", "-o", "remount,size=1g", str(tiny_disk)], check=True)
    assert command("run", scene, "-o", target, "--overwrite", "--resume").returncode == 0
    same(contents(target), whole)


def test_a_full_disk_for_a_field(sweep, tiny_disk):
    *_, archive = sweep
    subprocess.run(["mount", "-o", "remount,size=100k", str(tiny_disk)], check=True)
    done = command("fields", archive, "-o", tiny_disk / "state.hdf")
    assert done.returncode == 3 and "Traceback" not in done.stderr
    assert "No space left on device; it needs" in done.stderr and " are free" in done.stderr
    assert not list(tiny_disk.iterdir())


def test_a_folder_that_cannot_be_written(sweep, tiny_disk):
    scene, *_ = sweep
    subprocess.run(["mount", "-o", "remount,ro", str(tiny_disk)], check=True)
    done = command("run", scene, "-o", tiny_disk / "out.h5")
    assert done.returncode == 3 and "Read-only file system" in done.stderr
