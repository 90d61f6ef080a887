"""Commands that look at archives."""

import json
import shutil
from pathlib import Path

import pytest
from support import command
from tampering import opened

from galinx.postprocess.hdf5 import seal


def test_show_as_json(archive):
    shown = json.loads(command("show", archive, "--json").stdout)
    assert shown["verdict"] == "PASS" and len(shown["states"]) == 12
    first = shown["states"][0]
    assert first["motion"] == "FM1" and first["closed_form"]["K_I"] == pytest.approx(0.3160757828331318)
    assert first["fem"]["K_I_left"] == pytest.approx(first["closed_form"]["K_I"], rel=1e-6)


def test_show_fits_a_terminal(archive):
    shown = command("show", archive)
    assert shown.returncode == 0 and "…" not in shown.stdout and "\x1b" not in shown.stdout
    assert max(map(len, shown.stdout.splitlines())) <= 80


@pytest.mark.parametrize("columns", [40, 60, 200])
def test_a_narrow_terminal_has_the_table_in_parts(archive, columns):
    """Nothing is cut: every column is there once, those that states are called by in every part."""
    shown = command("show", archive, COLUMNS=str(columns)).stdout
    table = shown.partition("the same in all")[0]
    assert max(map(len, table.splitlines())) <= columns and "…" not in shown
    heads = [line.split() for line in shown.splitlines() if line.startswith(" state")]
    assert (len(heads) > 1) == (columns < 80)
    told = [word for head in heads for word in head if word not in ("state", "(m)")]
    assert told == ["c", "X/L", "f", "K_I", "error", "estimate", "v₀", "α", "β"]
    assert shown.count(" 11 FM2 ") == len(heads) and "μ_C = 0.7" in shown


def test_plot(archive, tmp_path):
    done = command("plot", archive, "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    for name in ("friction", "surface"):
        assert (tmp_path / f"{archive.stem}_{name}.png").stat().st_size > 10_000
        assert (tmp_path / f"{archive.stem}_{name}.pdf").read_bytes().startswith(b"%PDF")


def test_check_tells_damage_from_contradictions(archive, tmp_path):
    whole = Path(shutil.copy(archive, tmp_path))
    done = command("check", whole)
    assert done.returncode == 0 and "is whole" in done.stdout
    with opened(whole, sealed=False) as file:
        file.attrs["verdict"] = "FAIL"
    done = command("check", whole)
    assert done.returncode == 2 and "damaged" in done.stderr
    seal.put(whole)
    done = command("check", whole)
    assert done.returncode == 1 and "fault: verdict says FAIL" in done.stdout
    assert "faults: 1" in done.stdout
