"""What measures the program is careful with files, as the program is."""

import importlib
import math
import os
import re
import sys

import h5py
import pytest
from support import HOME

from galinx import template
from galinx.app.plan.plan import make_plan
from galinx.postprocess.errors import Occupied


@pytest.fixture
def measure(monkeypatch):
    monkeypatch.syspath_prepend(HOME / "benchmarks")
    return importlib.import_module("measure")


@pytest.fixture
def bench(measure, tmp_path, monkeypatch):
    """``./run.sh bench -o FOLDER``, which measures nothing."""
    found = measure.Figures("1 state", 1, 2, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0)
    monkeypatch.setattr(measure, "CASES", measure.CASES[:1])
    monkeypatch.setattr(measure, "OTHERS", [])
    monkeypatch.setattr(measure, "run", lambda *_: found)
    monkeypatch.setattr(measure, "without_start", lambda: [])
    monkeypatch.setattr(measure, "steps", lambda _: "steps\n")
    monkeypatch.setattr(sys, "argv", ["measure.py", "-o", str(tmp_path / "out")])
    return measure.main


def test_figures_are_written_whole(bench, tmp_path, monkeypatch):
    synchronised, synchronise = [], os.fsync
    monkeypatch.setattr(os, "fsync", lambda handle: synchronised.append(synchronise(handle)))
    for _ in range(2):  # what is there is made again
        bench()
    folder = tmp_path / "out"
    assert sorted(os.listdir(folder)) == ["benchmark.h5", "error_against_time.png", "table.md"]
    assert len(synchronised) == 2 * 2 * 3  # each file, and its name
    assert "| 1 state | 1 | 2 | 3.00 | 4.00 | 5 | 6.0e+00 |" in (folder / "table.md").read_text("utf-8")
    assert (folder / "error_against_time.png").read_bytes().startswith(b"\x89PNG")
    with h5py.File(folder / "benchmark.h5") as file:
        assert file["wall"][0] == 3.0 and file["wall"].attrs["units"] == "s"


def test_what_cannot_be_replaced_is_found_before_the_work(bench, tmp_path, monkeypatch):
    (tmp_path / "out").mkdir()
    os.mkfifo(tmp_path / "out" / "benchmark.h5")
    monkeypatch.setattr(sys.modules["measure"], "run", None)
    with pytest.raises(Occupied, match="is a FIFO"):
        bench()


@pytest.fixture
def energy(monkeypatch):
    monkeypatch.syspath_prepend(HOME / "benchmarks")
    return importlib.import_module("energy")


def test_energy_is_that_of_all_packages(energy, tmp_path):
    for package, start in (("intel-rapl:0", 100), ("intel-rapl:1", 9_000_000), ("intel-rapl:0:0", 7)):
        (tmp_path / package).mkdir()
        (tmp_path / package / "energy_uj").write_text(f"{start}\n")
        (tmp_path / package / "max_energy_range_uj").write_text("10000000\n")
    before = energy.counters(tmp_path)
    (tmp_path / "intel-rapl:0" / "energy_uj").write_text("2000100\n")
    (tmp_path / "intel-rapl:1" / "energy_uj").write_text("500000\n")  # went round
    assert energy.joules(before, energy.counters(tmp_path)) == pytest.approx(2.0 + 1.5, rel=1e-15)


def test_where_the_machine_tells_no_energy_none_is_told(energy, tmp_path):
    assert energy.counters(tmp_path) == {}
    assert math.isnan(energy.joules({}, {}))


def test_each_case_can_be_computed(measure):
    for case in measure.CASES + measure.OTHERS:
        make_plan(template(case.scene, case.changes))


@pytest.fixture
def accuracy(monkeypatch):
    monkeypatch.syspath_prepend(HOME / "benchmarks")
    return importlib.import_module("accuracy")


def test_every_table_has_its_place_on_the_page_and_is_put_there(accuracy, tmp_path, monkeypatch, capsys):
    page = accuracy.PAGE.read_text(encoding="utf-8")
    places = re.findall(
        r"<!-- ./run.sh bench accuracy (\w+) -->\n\n\| .*?\n\n<!-- end -->", page, re.DOTALL
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


def test_output_of_other_commands_becomes_tables(accuracy, tmp_path):
    printed = "\n".join(
        f"seed {seed}, {kind}: 9 s, pressure {p:.1e}, K_I {K:.1e} of 4.0e-07, "
        f"sigma_XX {σ:.1e} of 9.0e-07, interfaces 1.2e-07 of 9.3e-07"
        for seed, kind, p, K, σ in (
            (0, "uniform", 3e-7, 1e-7, 5.5e-8), (1, "uniform", 2e-7, 1.4e-7, 1e-8),
            (0, "graded", 2.9e-7, 1e-10, 6e-8),
        )
    )  # fmt: skip
    table = accuracy.of_stacks(printed).splitlines()
    assert table[2] == "| uniform | 2 | 3e-7 | 1.4e-7 (4e-7) | 5.5e-8 (9e-7) | 1.2e-7 (9.3e-7) |"
    assert table[3] == "| some graded | 1 | 2.9e-7 | 1e-10 (4e-7) | 6e-8 (9e-7) | 1.2e-7 (9.3e-7) |"
    with h5py.File(tmp_path / "stress.h5", "w") as file:
        for name, texts in {
            "random": [
                "holds: estimates over true errors: box 1.03 to 7.0, median 3.1; of K_I alone 3.2, up to "
                "9.0; of stresses at least 1.2; fixed degree 2.00 to 5.0, median 3.0; of K_I alone 4.0, "
                "up to 8.0",
                "FAILS: median 11.0, allowed 10",
            ],
            "speed": ["holds: true error at most 0.40 of its estimate, allowed 1"],
        }.items():  # fmt: skip
            file[f"{name}/verdicts"] = texts
            file[f"{name}/verdicts"].attrs["long_name"] = f"about {name}"
    rows = accuracy.of_archive(tmp_path / "stress.h5").splitlines()
    assert "| speed | about speed | true error at most 0.40 of its estimate, allowed 1 |" in rows
    assert "| random | about random | FAILS: median 11.0, allowed 10 |" in rows
    assert rows[-2:] == [
        "| box | 1.03 to 7.0, median 3.1; of K_I alone 3.2, up to 9.0; of stresses at least 1.2 |",
        "| fixed degree | 2.00 to 5.0, median 3.0; of K_I alone 4.0, up to 8.0 |",
    ]


def test_numbers_of_tables_are_short(accuracy):
    assert [accuracy.short(x) for x in (None, 1e-6, 2.76e-11, 0.04)] == ["–", "1e-6", "2.8e-11", "4e-2"]
