"""Commands that begin and compute: what they write, refuse and leave undone."""

import sys

import h5py
import numpy as np
from support import HOME, SCENE, command, finished, here


def test_one_and_two_ranks_agree(archives):
    with h5py.File(archives[0]) as one, h5py.File(archives[1]) as two:
        for name in ("K_I_left", "K_I_right", "normal_force", "tangential_force", "v0"):
            a, b = (file[f"states/fem/{name}"][()] for file in (one, two))
            np.testing.assert_allclose(b, a, rtol=1e-9)
        a, b = (file["surface/fem/sigma_XX"][()] for file in (one, two))
        np.testing.assert_allclose(b, a, rtol=1e-6, atol=1e-8)


def test_an_archive_is_not_overwritten_unasked(archive):
    before = archive.read_bytes()
    done = here("run", SCENE, "-o", archive)
    assert done.returncode == 2 and "--overwrite" in done.stderr
    assert archive.read_bytes() == before


#: Libraries that take longer to import than a friction loop takes.
SLOW = (
    "dolfinx", "petsc4py", "mpi4py", "matplotlib", "pandas", "scipy.integrate",
    "scipy.interpolate",
)  # fmt: skip


def test_friction_alone_imports_nothing_slow(tmp_path):
    script = (
        "import sys\nfrom click.testing import CliRunner\nfrom galinx.app.cli import cli\n"
        f"done = CliRunner().invoke(cli, ['run', {str(HOME / 'scenes' / 'fig6.toml')!r}, '-o', "
        f"{str(tmp_path / 'loops.h5')!r}], standalone_mode=False)\n"
        "assert done.exception is None, done.exception\n"
        f"print([name for name in {SLOW} if name in sys.modules])"
    )
    done = finished([sys.executable, "-c", script])
    assert done.stdout.strip() == "[]", done.stderr


def test_a_verdict_has_its_status(tmp_path):
    pulls = "solve.pressure=[[-1, -2], [0, 1], [1, -2]]", 'solve.methods=["closed_form"]'
    words = [HOME / "scenes" / "traction.toml", *(f"--set={change}" for change in pulls)]
    done = command("-n", 2, "run", *words, "-o", tmp_path / "a.h5")
    assert done.returncode == 1 and "verdict: FAIL" in done.stdout
    assert "the punch would have to pull" in done.stderr
    assert all(line.startswith("warning: ") for line in done.stderr.splitlines())  # none is mpirun's
    silent = ["run", "-q", "--overwrite", *words, "-o", "a.h5"], ["csv", "a.h5"], ["plot", "a.h5"]
    for done in (here(*each, cwd=tmp_path) for each in silent):
        assert "verdict" not in done.stdout
        assert done.stderr.startswith("FAIL of a.h5: tension under the punch")


def test_the_schema_is_what_the_command_prints():
    assert here("schema").stdout == (HOME / "scenes" / "scene.schema.json").read_text(encoding="utf-8")
