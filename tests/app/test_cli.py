"""What every command has in common: help, one message for a failure, one status."""

import subprocess
import time

import pytest
from support import SCENE, clean_environment, command, here, mpirun, widest

from galinx.app.cli import cli


@pytest.mark.parametrize("ranks", [(), ("-n", "2")])
@pytest.mark.parametrize(
    "arguments, message",
    [
        (("run", "missing.toml"), "cannot read missing.toml"),
        (("run", "bad.toml"), "solid.nu"),
        (("show", "bad.toml"), "bad.toml is a scene or another text, expected an archive"),
        (("frobnicate",), "No such command 'frobnicate'; "),
        (("shwo",), "No such command 'shwo'; did you mean show?"),
        (("reprot", "a.h5"), "did you mean report?"),
        (("init", "tabel1"), "init tabel1: no such scene; did you mean table1?"),
        (("init", "quite something else"), "no such scene; valid: box, "),
        (("paper", "-o", "figures.pdf"), "ends with .pdf, expected a folder"),
        (("./bad.toml",), "No such command"),
    ],
)
def test_bad_input_ends_with_one_message(tmp_path, ranks, arguments, message):
    (tmp_path / "bad.toml").write_text("[solid]\nE = 1e9\nrho = 1000\n", encoding="utf-8")
    done = command(*ranks, *arguments, cwd=tmp_path) if ranks else here(*arguments, cwd=tmp_path)
    assert done.returncode == 2 and "Traceback" not in done.stderr
    assert done.stderr.count("error: ") == 1 and message in done.stderr


@pytest.mark.parametrize("count", ["two", "0", "-1", "2.0", "0x2", "", "5000", 20 * "9"])
def test_a_number_of_ranks_is_checked(count):
    done = command("-n", count, "plan", SCENE)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith(f"error: -n {count}: expected a number of ranks up to ")
    assert done.stderr.count("\n") == 1


def test_a_failure_on_one_rank_ends_all(tmp_path):
    script = (
        "import sys, time; from galinx.app.run import flow as module; from galinx.app import ranks\n"
        "true = module.compute\n"
        "def compute(*a):\n"
        "    if ranks.rank() == 1:\n"
        "        print('raised at', time.time(), flush=True)\n"
        "        raise RuntimeError('provoked')\n"
        "    return true(*a)\n"
        "module.compute = compute\n"
        f"sys.argv = ['app', 'run', {str(SCENE)!r}, '-o', 'never.h5']\n"
        "from galinx.app.cli import run_from_shell\nrun_from_shell()\n"
    )
    done = subprocess.run(
        mpirun(2, "-c", script), cwd=tmp_path, env=clean_environment(),
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert done.returncode == 3 and "provoked" in done.stderr
    raised = float(done.stdout.split("raised at ")[1].split()[0])
    assert time.time() - raised < 5.0
    assert not (tmp_path / "never.h5").exists()


@pytest.mark.parametrize("name", ["", *cli.commands])
def test_help(name):
    done = here(*filter(None, [name]), "--help")
    assert done.returncode == 0 and "Usage" in done.stdout
    assert widest(done.stdout) <= 80
    assert not name or "Example: ./run.sh" in done.stdout
