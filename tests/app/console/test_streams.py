"""What commands a terminal never reaches it."""

import io
import json
import logging
import re
import sys

import pytest
from support import called

from galinx.app.console import (
    bare,
    new_console,
    plain,
    plain_streams,
    print_sheet,
    print_verdict,
)
from galinx.postprocess.tables import Sheet

#: ESC, C1, the other controls, what turns the direction of writing, and bytes that are not UTF-8.
EVIL = "\x1b[31m\x9b31m\x07\r\x7f\u202e\u2066\u200f\udcff"
SHOWN = r"\u001b[31m\u009b31m\u0007\u000d\u007f\u202e\u2066\u200f\udcff"


def is_plain(text):
    return not re.search(
        "[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069\ud800-\udfff]", text
    )


def test_control_characters_are_written_out_and_the_rest_stays():
    assert plain(EVIL) == SHOWN and is_plain(SHOWN)
    assert plain("σ_XX = 3 µm\tT302\nνέα 中 🙂") == "σ_XX = 3 µm\tT302\nνέα 中 🙂"


def test_whoever_prints_prints_plain_text(capsys):
    with plain_streams():
        print(EVIL, "out")
        print(EVIL, "err", file=sys.stderr)
        sys.stdout.writelines([EVIL, "\n"])
        logging.StreamHandler(sys.stderr).emit(logging.makeLogRecord({"msg": EVIL}))
        assert bare(sys.stdout) is not sys.stdout and bare(bare(sys.stdout)) is bare(sys.stdout)
    out, err = capsys.readouterr()
    assert out == f"{SHOWN} out\n{SHOWN}\n" and err == f"{SHOWN} err\n{SHOWN}\n"


@pytest.mark.parametrize("colours", [False, True])
def test_tables_and_verdicts_have_no_colours_but_their_own(colours, monkeypatch):
    monkeypatch.setenv("TERM", "xterm-256color")
    text = io.StringIO()
    console = new_console(text, colours)
    print_sheet(console, Sheet(f"t {EVIL}", [f"c {EVIL}", "d"], [[f"r {EVIL}", "1"]], [f"n {EVIL}"]))
    told = {f"k {EVIL}": 1.0}
    attributes = {"comparisons": json.dumps(told), "verdict_reasons": json.dumps([f"w {EVIL}"])}
    print_verdict(console, {}, attributes | {"verdict": f"v {EVIL}"}, verbose=True)
    said = text.getvalue()
    assert is_plain(re.sub("\x1b\\[[0-9;]*m", "", said) if colours else said)
    for first in "tcrnkwv":
        assert f"{first} {SHOWN}" in said


@pytest.mark.parametrize(
    "arguments",
    [
        ("run", f"{EVIL}.toml"), ("plan", EVIL), ("show", EVIL), ("report", EVIL), ("check", EVIL),
        (EVIL,), (f"--{EVIL}",), ("init", EVIL), ("-x", EVIL, "init"), ("fields", EVIL, "--state", EVIL),
        ("run", "scene.toml", "--set", f"{EVIL}=1"), ("run", "scene.toml", "--set", f"title={EVIL}"),
    ],
    ids=lambda words: words[0][:4].strip("\x1b"),
)  # fmt: skip
def test_messages_are_plain(arguments, monkeypatch, capsys, tmp_path):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text("[solid]\n'a\x9b\u202e' = '\u2066'\n", encoding="utf-8")
    assert called(*arguments) == 2
    out, err = capsys.readouterr()
    assert "error: " in err and is_plain(out + err)
