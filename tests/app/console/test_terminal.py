"""What commands say: 80 columns, colours on terminals only, as much as was asked for."""

import os
import pty
import re
import subprocess

import pytest
from support import HOME, SCENE, clean_environment, command, finished, here, widest

from galinx.app.console import Progress

CLOSED = ("--set", 'solve.methods=["closed_form"]')
#: Strokes that many waves cross: nothing is warned about.
SLOW = ("--set", "motion.c=[1e-6, 2e-6]")


def on_a_terminal(*arguments, cwd, **environment):
    """Output of ``./run.sh ARGUMENTS`` on a terminal of 80 columns."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [str(HOME / "run.sh"), *map(str, arguments)], cwd=cwd, stdout=theirs, stderr=theirs,
        stdin=subprocess.DEVNULL,
        env=clean_environment() | {"TERM": "xterm-256color", "COLUMNS": "80"} | environment,
    )  # fmt: skip
    os.close(theirs)
    said = b""
    while True:
        try:
            found = os.read(ours, 65536)
        except OSError:  # Linux's way to say that nobody is at the other end
            break
        if not found:
            break
        said += found
    os.close(ours)
    assert process.wait(60) == 0, said
    return said.decode()


@pytest.mark.parametrize(
    "arguments", [("check",), ("plan", SCENE), ("init",), ("materials",)], ids=lambda a: a[0]
)
def test_output_fits_80_columns_without_colours(archive, arguments):
    where = (archive.name,) if arguments == ("check",) else ()
    done = here(*arguments, *where, cwd=archive.parent, COLUMNS="80")
    assert done.returncode == 0 and widest(done.stdout) <= 80 and "\x1b" not in done.stdout


def test_colours_on_a_terminal_unless_unwanted(archive, tmp_path):
    assert "\x1b[1;32mverdict: PASS" in on_a_terminal("show", archive, cwd=tmp_path)
    assert "\x1b" not in on_a_terminal("show", archive, cwd=tmp_path, NO_COLOR="1")
    # mpirun's ranks see a terminal even where there is none.
    assert "\x1b" not in command("-n", "2", "show", archive).stdout


def test_progress_is_drawn_on_a_terminal_unless_quiet(tmp_path):
    said = on_a_terminal("run", SCENE, "-o", "a.h5", "--set", "solve.tolerance=1e-2", cwd=tmp_path)
    assert "finite elements at c = 0.6 (2 of 2)" in said and "%" in said
    assert on_a_terminal("run", SCENE, "-o", "b.h5", "--quiet", *CLOSED, *SLOW, cwd=tmp_path) == ""


def test_verbose_and_log_tell_every_step(tmp_path):
    run = ("run", SCENE, "-o", "a.h5", "-v", "--log", "steps.txt", *SLOW, "--set",
           "solve.tolerance=1e-2")  # fmt: skip
    done = command("-n", "2", *run, cwd=tmp_path)
    steps = [line for line in done.stderr.splitlines() if line]
    for expected in ("mesh: confocal", "12 of 12 states", "verdict: PASS; archive: a.h5"):
        assert steps.count(expected) == 1
    logged = (tmp_path / "steps.txt").read_text(encoding="utf-8").splitlines()
    assert [line.split(" ", 2)[2] for line in logged] == steps
    assert all(re.match(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d,\d{3} ", line) for line in logged)


def test_a_reader_that_goes_away_ends_the_output_quietly(archive):
    # More output than a pipe holds, so that the program meets the closed end.
    line = f"{HOME / 'run.sh'} show {archive} --json | head -c 10; echo ${{PIPESTATUS[0]}}"
    done = finished(["bash", "-c", line])
    assert done.stderr == "" and done.stdout.endswith(("0\n", "141\n"))


def test_warnings_are_heard_however_quiet_the_run_is(capsys, tmp_path):
    for n, options in enumerate(({}, {"quiet": True}, {"verbose": True})):
        with Progress(**options, log=tmp_path / f"{n}.log") as progress:
            progress.warn("a mesh is damaged")
        assert capsys.readouterr().err == "warning: a mesh is damaged\n"
        assert "warning: a mesh is damaged" in (tmp_path / f"{n}.log").read_text(encoding="utf-8")
