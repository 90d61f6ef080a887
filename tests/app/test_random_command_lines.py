"""Random command lines end with the documented status, and one message where that is 2.

GALINX_THOROUGH=1 tries as many as a release does.
"""

import os
import random

import pytest
from support import SCENE, THOROUGH, at_most, called

from galinx.app.cli import cli

LINES = 1000 if THOROUGH else 40

#: A scene that is computed in a moment.
QUICK = """title = "quick"
solid = {material = "T302"}
friction = {mu_c = 0.7, sigma0_over_load = 25000.0}
motion = {c = [0.0, 0.6]}
solve = {methods = ["closed_form"]}
output = {quantities = ["sif"]}
"""

#: Arguments by command: good ones, and good options; commands that take long are only called wrongly.
GOOD = {
    "run": (["quick.toml"], [["-q"], ["-v"], ["--set", "friction.mu_c=0.5"], ["--set", "title=x"]]),
    "plan": (
        ["quick.toml", "tables.toml"],
        [["--set", "motion.c={from = 0.1, to = 0.2, number = 3}"], ["--unset", "title"]],
    ),
    "show": (["quick.h5"], [["--json"]]),
    "check": (["quick.h5"], []),
    "report": (["quick.h5"], []),
    "init": (["table1", "own_material"], []),
    "materials": ([], []),
    "schema": ([], []),
    "csv": (["quick.h5"], [["--states"], ["--dimensionless"]]),
    "compare": (None, []),
    "dispersion": (None, []),
    "response": (None, []),
    "plot": (None, []),
    "fields": (None, []),
    "fit": (None, []),
    "paper": (None, []),
}
BAD_FILES = [
    "missing.toml", "folder", "bad.toml", "empty.toml", "latin.toml", "nested.toml", "digits.toml", "",
    ".", "/", "no/such/file", "quick.toml/x", "-", "quick", "\x1b[31m", "\udcff.toml", "x" * 300,
    "~", "*",
]  # fmt: skip
BAD_OPTIONS = [
    ["--nonsense"], ["-z"], ["--set"], ["--set", "x"], ["--set", "=1"], ["--set", "friction.mu_cc=1"],
    ["--set", "motion.c=" + "[" * 3000], ["--set", "solid.E=1 Pa*9**9**9"], ["-o"], ["--state", "x"],
    ["--extent", "x"], ["-q", "-v"], ["--overwrite=1"], ["-n"], ["--json=1"], ["extra", "more"],
    ["--set", "motion.c=30 deg"], ["--unset"], ["--unset", "motion.cc"], ["--surface"],
    ["--dimensionless=1"],
]  # fmt: skip
#: For what is to be written.
BAD_PLACES = [["-o", "folder"], ["-o", "no/such/folder/x"]]


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with good and bad files."""
    folder = tmp_path_factory.mktemp("lines")
    (folder / "folder").mkdir()
    texts = {
        "quick": QUICK, "bad": "[solid]\nE = 1\n", "empty": "", "nested": "x = " + "[" * 3000,
        "digits": "title = " + "9" * 5000, "tables": SCENE.read_text(encoding="utf-8"),
    }  # fmt: skip
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    (folder / "latin.toml").write_bytes(b"title = '\xe9'\n")
    return folder


@pytest.fixture
def said(place, monkeypatch, capsys):
    """Calls the command line there; its status and what it says."""
    monkeypatch.chdir(place)

    def call(words):
        with at_most():
            return (called(*words), *capsys.readouterr())

    return call


def line(choose):
    """Words of a command line, and whether they are good."""
    name = choose.choice([*GOOD, "", "rnu", "./quick.toml", "\x1b", "--set"])
    if name not in GOOD:
        return [name, "quick.toml"], False
    files, options = GOOD[name]
    good = files is not None and choose.random() < 0.4
    words = [choose.choice(files)] if files else []
    words += [word for option in options if choose.random() < 0.3 for word in option]
    if name in ("run", "report", "init"):
        ending = {"run": "h5", "report": "html", "init": "toml"}[name]
        words += ["-o", f"{choose.randrange(10**9)}.{ending}"]
    if not good:
        bad = choose.choice(BAD_OPTIONS + BAD_PLACES * (name == "run"))
        words = [choose.choice(BAD_FILES)] if files != [] and choose.random() < 0.5 else [*words, *bad]
    return [name, *words], good and not {"-q", "-v"} <= {*words}


def test_commands_are_those_that_are_tried():
    assert {*GOOD} == {*cli.commands}


@pytest.mark.parametrize("name", [name for name, (files, _) in GOOD.items() if files != []])
def test_a_command_refuses_what_is_no_file_for_it(name, said):
    for word in BAD_FILES:
        status, _, err = said([name, word])
        assert status == 2 and err.count("error: ") == 1, (name, word, status, err)


@pytest.mark.parametrize("n", range(LINES))
def test_a_command_line_ends_with_its_status(n, said):
    if not os.path.exists("quick.h5"):
        assert said(["run", "quick.toml", "-q"])[0] == 0
    words, good = line(random.Random(n))
    status, _, err = said(words)
    assert "Traceback" not in err and "internal failure" not in err, (words, err)
    assert status == (0 if good else 2), (words, status, err)
    assert err.count("error: ") == (0 if good else 1), (words, err)
