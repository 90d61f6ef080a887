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
from conftest import HOME, clean_environment, command, mpirun, run_scene

from galinx.postprocess.errors import LeftOver
from galinx.postprocess.hdf5 import archive
from galinx.postprocess.journal import Journal, Part

#: Moments at which a run is killed; GALINX_THOROUGH=1 asks for as many as a release does.
KILLS = 20 if os.environ.get("GALINX_THOROUGH") else 4

#: A sweep of 12 speeds with two parts each.
SWEEP = (
    (HOME / "scenes" / "tables4_5.toml")
    .read_text(encoding="utf-8")
    .replace("c = [4.786e-7, 0.6]", f"c = {[round(0.07 * n, 2) for n in range(12)]}")
    .replace("X_over_L = [0.2, 0.8]", f"X_over_L = {[round(n / 399, 6) for n in range(400)]}")
    .replace("tolerance = 1e-6", "tolerance = 1e-4")
)


@pytest.fixture(scope="module")
def sweep(tmp_path_factory):
    """The scene of a sweep, and its archive as undisturbed."""
    folder = tmp_path_factory.mktemp("sweep")
    scene, target = folder / "sweep.toml", folder / "whole.h5"
    scene.write_text(SWEEP, encoding="utf-8")
    assert command("run", scene, "-o", target).returncode == 0
    return scene, contents(target)


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
    while len(list(folder.glob(".*.work/*-*.npz"))) < count:
        assert time.monotonic() < deadline
        time.sleep(0.005)


def test_killed_at_any_moment_and_resumed_gives_the_same_archive(sweep, tmp_path):
    scene, whole = sweep
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
    scene, whole = sweep
    target = tmp_path / "out.h5"
    with started("run", scene, "-o", target) as process:
        wait_for_parts(tmp_path, 3)
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=30)
    assert process.returncode == 3
    assert "interrupted; " in errors and "go on with --resume" in errors and "Traceback" not in errors
    refused = command("run", scene, "-o", target)
    assert refused.returncode == 3 and "an interrupted run left" in refused.stderr
    files = {path.name for path in tmp_path.glob(".*.work/*-*.npz")}
    assert len(files) >= 3
    done = command("run", scene, "-o", target, "--resume")
    assert done.returncode == 0
    same(contents(target), whole)


def test_a_killed_rank_ends_the_job_and_the_rest_is_resumed(sweep, tmp_path):
    scene, _ = sweep
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
    scene, whole = sweep
    target = tmp_path / "out.h5"
    with started("run", scene, "-o", target) as process:
        wait_for_parts(tmp_path)
        second = command("run", scene, "-o", target)
        process.communicate(timeout=60)
    assert second.returncode == 3 and "another run is writing" in second.stderr
    assert process.returncode == 0
    same(contents(target), whole)


def part(start, stop, value=1.0):
    return Part(slice(start, stop), {"states/f": np.full(stop - start, value)}, [], None)


def interrupted(target, key="key"):
    """Leave what a killed run leaves: two parts and a half-written archive."""
    with pytest.raises(KeyboardInterrupt), Journal(target, key) as journal:
        journal.keep(part(0, 3))
        journal.keep(part(3, 5))
        (journal.folder / ".out.h5.1.partial").write_bytes(b"half")
        raise KeyboardInterrupt
    return journal.folder


def test_parts_of_another_scene_are_refused(tmp_path):
    target = tmp_path / "out.h5"
    interrupted(target)
    with pytest.raises(LeftOver, match="belongs to another scene"), Journal(target, "other", resume=True):
        pass
    with pytest.raises(LeftOver, match="left 5 finished states"), Journal(target, "key"):
        pass
    with Journal(target, "key", resume=True) as journal:
        assert [(p.rows, p.data["states/f"].tolist()) for p in journal.parts()] == [
            (slice(0, 3), [1.0] * 3), (slice(3, 5), [1.0] * 2),
        ]  # fmt: skip
        assert not list(journal.folder.glob(".*"))
        journal.complete()
    assert not list(tmp_path.iterdir())


def test_a_new_start_gives_parts_up(tmp_path):
    target = tmp_path / "out.h5"
    interrupted(target)
    with Journal(target, "key", overwrite=True) as journal:
        assert journal.states == 0


def test_a_damaged_part_is_computed_again(tmp_path):
    target = tmp_path / "out.h5"
    folder = interrupted(target)
    first = sorted(folder.glob("*-*.npz"))[0]
    data = bytearray(first.read_bytes())
    data[data.index(np.ones(3).tobytes()) + 7] ^= 1
    first.write_bytes(data)
    with Journal(target, "key", resume=True) as journal:
        assert [p.rows for p in journal.parts()] == [slice(3, 5)]


def test_a_speed_that_cannot_be_solved_does_not_end_the_sweep(monkeypatch, tmp_path):
    from galinx.app.run import contact_mode
    from galinx.app.run.compute import compute
    from galinx.app.scene.scene import parse
    from galinx.solvers.errors import SolveError

    true = contact_mode.SlidingPunch

    def punch(space, κ, c, *rest):
        if c == 0.6:
            raise SolveError("provoked")
        return true(space, κ, c, *rest)

    whole, _ = run_scene("tables4_5")
    monkeypatch.setattr(contact_mode, "SlidingPunch", punch)
    scene = parse((HOME / "scenes" / "tables4_5.toml").read_text(encoding="utf-8"))
    with archive.Writer(tmp_path / "out.h5") as writer:
        writer.finish(compute(scene, writer))
    data, attributes = archive.read(tmp_path / "out.h5")
    assert attributes["verdict"] == "FAIL" and list(data["run/failures"]) == ["c = 0.6: provoked"]
    assert "not solved, c = 0.6: provoked" in json.loads(attributes["verdict_reasons"])
    np.testing.assert_array_equal(data["states/fem/v0"][:6], whole["states/fem/v0"][:6])
    assert np.isnan(data["states/fem/v0"][6:]).all()
    np.testing.assert_array_equal(data["states/closed_form/K_I"], whole["states/closed_form/K_I"])
    assert command("check", tmp_path / "out.h5").returncode == 0
    monkeypatch.setattr(contact_mode, "SlidingPunch", lambda *_: punch(*_[:2], 0.6, "direct"))
    with pytest.raises(SolveError, match=r"c = 4.786e-07: provoked"):
        compute(scene)


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
    scene, whole = sweep
    target = tiny_disk / "out.h5"
    target.write_bytes(b"an earlier archive")
    done = command("run", scene, "-o", target, "--overwrite")
    assert done.returncode == 3 and "Traceback" not in done.stderr
    assert "No space left on device" in done.stderr and "MB are free" in done.stderr
    assert target.read_bytes() == b"an earlier archive"
    assert not list(tiny_disk.rglob("*.partial"))
    subprocess.run(["mount", "-o", "remount,size=1g", str(tiny_disk)], check=True)
    assert command("run", scene, "-o", target, "--overwrite", "--resume").returncode == 0
    same(contents(target), whole)


def test_a_full_disk_for_a_field(sweep, tiny_disk, tmp_path):
    scene, _ = sweep
    archive = tmp_path / "out.h5"
    assert command("run", scene, "-o", archive).returncode == 0
    subprocess.run(["mount", "-o", "remount,size=100k", str(tiny_disk)], check=True)
    done = command("fields", archive, "-o", tiny_disk / "state.hdf")
    assert done.returncode == 3 and "Traceback" not in done.stderr
    assert "No space left on device; it needs" in done.stderr and "MB are free" in done.stderr
    assert not list(tiny_disk.iterdir())


def test_a_folder_that_cannot_be_written(sweep, tiny_disk):
    scene, _ = sweep
    subprocess.run(["mount", "-o", "remount,ro", str(tiny_disk)], check=True)
    done = command("run", scene, "-o", tiny_disk / "out.h5")
    assert done.returncode == 3 and "Read-only file system" in done.stderr


def test_more_ranks_than_cells():
    script = (
        "from mpi4py import MPI\n"
        "from solvers.fem.distributed import distribute\n"
        "from meshes.halfplane import MESHES\n"
        "from meshes.rings import TAGS, Refinement\n"
        "from solvers.fem.punch import SlidingPunch\n"
        "from solvers.fem.space import Space\n"
        "import numpy as np\n"
        "from solvers.fem.interior import InteriorGradients\n"
        "kind, v0 = MESHES['confocal'], []\n"
        "for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):\n"
        "    piece = kind.build(Refinement(0, 0.3, 1, (2.0,)), 1, comm.rank, comm.size)\n"
        "    mesh = distribute(piece, comm)\n"
        "    space = Space(*mesh, TAGS, kind.chart, 4)\n"
        "    punch = SlidingPunch(space, 2.0, 0.5)\n"
        "    state = punch.states(0.5)\n"
        "    inside = InteriorGradients(space, 2.0, 0.5, punch.fields, np.array([[0.1, -0.5]]))\n"
        "    v0.append((state.v0[0], *inside.of(state.weights).ravel()))\n"
        "    punch.destroy()\n"
        "assert space.cells == 4 < MPI.COMM_WORLD.size\n"
        "np.testing.assert_allclose(v0[1], v0[0], rtol=1e-9)\n"
    )
    done = subprocess.run(
        mpirun(6, "-m", "mpi4py", "-c", script), env=clean_environment(),
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
