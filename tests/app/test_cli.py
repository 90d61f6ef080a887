"""What every command has in common: help, one message for a failure, one status."""

import time

import pytest
from support import SCENE, command, finished, here, mpirun, widest

from galinx.app.cli import cli

BAD = [
    (("run", "missing.toml"), "cannot read missing.toml"),
    (("frobnicate",), "No such command 'frobnicate'; "),
    (("show", "bad.toml"), "bad.toml is a scene or another text, expected an archive"),
    (("run", "bad.toml"), "solid.nu"),
    (("shwo",), "No such command 'shwo'; did you mean show?"),
    (("init", "tabel1"), "init tabel1: no such scene; did you mean table1?"),
    (("init", "quite something else"), "no such scene; valid: along, box, "),
    (("paper", "-o", "figures.pdf"), "ends with .pdf, expected a folder"),
    (("run", "bad.toml", "-o", "x.csv"), "ends with .csv, expected an archive's, as x.h5"),
    (("./bad.toml",), "No such command"),
]


@pytest.mark.parametrize(
    "ranks, arguments, message", [((), *row) for row in BAD] + [(("-n", "2"), *row) for row in BAD[:2]]
)
def test_bad_input_ends_with_one_message(tmp_path, ranks, arguments, message):
    (tmp_path / "bad.toml").write_text("[solid]\nE = 1e9\nrho = 1000\n", encoding="utf-8")
    done = command(*ranks, *arguments, cwd=tmp_path) if ranks else here(*arguments, cwd=tmp_path)
    assert done.returncode == 2 and "Traceback" not in done.stderr
    assert done.stderr.count("error: ") == 1 and message in done.stderr


@pytest.mark.parametrize("count", ["two", "0", "2.0", "", "5000", 20 * "9"])
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
    done = finished(mpirun(2, "-c", script), cwd=tmp_path)
    assert done.returncode == 3 and "provoked" in done.stderr
    raised = float(done.stdout.split("raised at ")[1].split()[0])
    assert time.time() - raised < 5.0
    assert not (tmp_path / "never.h5").exists()


@pytest.mark.parametrize(
    "text, message",
    [
        ("import sys\nsys.exit(5)", "SystemExit: 5, line 2"),
        ("import sys\n\nsys.exit()", "SystemExit, line 3"),
        ("raise KeyboardInterrupt", "KeyboardInterrupt, line 1"),
        (
            "import galinx\ngalinx.QUANTITIES.register('x/y', 3)",
            "found 3, expected an instance of Quantity",
        ),
        ("import galinx\n\ngalinx.nothing", "has no attribute 'nothing', line 3"),
        ("def f():\n    1 / 0\nf()", "ZeroDivisionError: division by zero, line 2"),
        ("def f(:", "SyntaxError: invalid syntax (mine.py, line 1)"),
    ],
)
def test_a_file_of_ones_own_that_fails_is_named_with_its_line(tmp_path, text, message):
    (tmp_path / "mine.py").write_text(text, encoding="utf-8")
    done = here("-x", "mine.py", "plan", SCENE, cwd=tmp_path)
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert done.stderr.startswith("error: mine.py fails: ") and message in done.stderr


@pytest.mark.parametrize("name", ["", *cli.commands])
def test_help(name):
    done = here(*filter(None, [name]), "--help")
    assert done.returncode == 0 and "Usage" in done.stdout
    assert widest(done.stdout) <= 80
    assert not name or "Example: ./run.sh" in done.stdout
