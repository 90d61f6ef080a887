"""What measures the program is careful with files, as the program is."""

import importlib
import re
import sys

import pytest
from support import HOME, command

from galinx import template
from galinx.app.plan.plan import make_plan


def test_each_case_can_be_computed(monkeypatch):
    monkeypatch.syspath_prepend(HOME / "benchmarks")
    measure = importlib.import_module("measure")
    for case in measure.CASES + measure.OTHERS:
        make_plan(template(case.scene, case.changes))


@pytest.fixture
def accuracy(monkeypatch):
    monkeypatch.syspath_prepend(HOME / "benchmarks")
    return importlib.import_module("accuracy")


def test_every_table_has_its_place_on_the_page_and_is_put_there(accuracy, tmp_path, monkeypatch, capsys):
    page = accuracy.PAGE.read_text(encoding="utf-8")
    places = re.findall(
        r"<!-- ./run.sh bench accuracy (\w+) -->\n\n[|-] .*?\n\n<!-- end -->", page, re.DOTALL
    )
    assert sorted(places) == sorted(accuracy.TABLES)
    (tmp_path / "page.md").write_text(page, encoding="utf-8")
    monkeypatch.setattr(accuracy, "PAGE", tmp_path / "page.md")
    monkeypatch.setitem(accuracy.TABLES, "others", lambda: "| another |")
    monkeypatch.setattr(sys, "argv", ["accuracy.py", "others"])
    accuracy.main()
    written, marker = (tmp_path / "page.md").read_text(encoding="utf-8"), "accuracy others -->\n\n"
    before, after = page.split(marker)[0] + marker, page.split(marker)[1].partition("\n\n<!-- end -->")
    assert written == before + "| another |" + "".join(after[1:])
    with pytest.raises(ValueError, match="no table nothing"):
        accuracy.put(page, "nothing", "")
    monkeypatch.setattr(sys, "argv", ["accuracy.py", "nothing"])
    with pytest.raises(SystemExit):
        accuracy.main()
    assert "expected one of scenes" in capsys.readouterr().err


def test_the_page_has_the_accuracy_of_tables_4_and_5(accuracy, tables_run, monkeypatch):
    """Errors are those of a run within a factor of three; below 1e-11 no digit of them lasts."""
    monkeypatch.setattr(accuracy.galinx, "compute", lambda _: tables_run)
    page = accuracy.PAGE.read_text(encoding="utf-8")
    (row,) = re.findall(r"^\| (`tables4_5` \| 1e-6 .*) \|$", page, re.MULTILINE)
    printed, computed = row.split(" | "), accuracy.row_of("tables4_5", accuracy.COMPARED)
    assert printed[:2] == computed[:2] and len(printed) == len(computed) == 9
    for old, new in zip(map(float, printed[2:]), map(float, computed[2:])):
        assert max(old, new) < max(1e-11, 3.0 * min(old, new))


@pytest.mark.parametrize(
    "words", ["bench", "bench accuracy", "bench assemblers", "bench big", "bench scaling", "stress"]
)
def test_every_benchmark_starts_by_its_command(words):
    done = command(*words.split(), "--help")
    assert done.returncode == 0 and "usage" in done.stdout.lower(), done.stderr
