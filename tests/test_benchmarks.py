"""What measures the program is careful with files, as the program is."""

import importlib
import math
import os
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
