"""Commands that look at archives."""

import json
import re
import shutil
from pathlib import Path

import pytest
from support import here
from tampering import opened

from galinx.app.commands.look import plot
from galinx.app.errors import BadInput
from galinx.app.figures.archive import FIGURES
from galinx.app.results.result import numbers
from galinx.postprocess.hdf5 import archive as seal


def test_show_as_json(archive):
    shown = json.loads(here("show", archive, "--json").stdout)
    assert shown["verdict"] == "PASS" and len(shown["states"]) == 12
    first = shown["states"][0]
    assert first["motion"] == "FM1" and "K_I" not in first["closed_form"]
    assert first["fem"]["K_I_left"] == pytest.approx(first["closed_form"]["K_I_left"], rel=1e-6)
    assert shown["units"]["fem"]["K_I_left"] == "MPa·m^(-β)"
    plain = json.loads(here("show", archive, "--json", "--dimensionless").stdout)["states"][0]
    assert plain["closed_form"]["K_I"] == pytest.approx(0.3160757828331318)


@pytest.mark.parametrize("columns", [40, 60, 200])
def test_a_narrow_terminal_has_the_table_in_parts(archive, columns):
    """Nothing is cut: every column is there once, those that states are called by in every part."""
    shown = here("show", archive, COLUMNS=str(columns)).stdout
    table = shown.partition("the same in all")[0]
    assert max(map(len, table.splitlines())) <= columns and "…" not in shown
    parts = len(re.findall(r"^ *─+ *$", table, re.M))
    assert (parts > 2) == (columns < 80)
    words = re.sub(r"\s+", " ", table)
    for head in ("stroke", "speed", "X/L", "K_I,", "indentation"):
        assert words.count(f" {head}") >= 1, head
    assert len(re.findall(r"^ 11 ", table, re.M)) == parts
    assert "μ_C = 0.7" in re.sub(r"\s+", " ", shown)


def test_help_names_every_figure():
    assert set(FIGURES) == set(re.findall(r"\w+", plot.params[2].help.partition(";")[0]))


@pytest.mark.parametrize(
    "text, found", [("3", [3]), ("0,4,2", [0, 4, 2]), ("0-2, 1,5 - 5", [0, 1, 2, 5]), ("7-7", [7])]
)
def test_states_are_named_by_numbers_and_ranges(text, found):
    assert numbers(text) == found


@pytest.mark.parametrize("text", ["", "a", "1,,2", "-1", "3-1", "1.5", "0-99999999", "1-2-3"])
def test_what_names_no_states_is_refused(text):
    with pytest.raises(BadInput, match=r"^--states: found "):
        numbers(text)


def test_check_tells_damage_from_contradictions(archive, tmp_path):
    whole = Path(shutil.copy(archive, tmp_path))
    done = here("check", whole)
    assert done.returncode == 0 and "is whole" in done.stdout
    with opened(whole, sealed=False) as file:
        file.attrs["verdict"] = "FAIL"
    done = here("check", whole)
    assert done.returncode == 2 and "damaged" in done.stderr
    seal.put(whole)
    done = here("check", whole)
    assert done.returncode == 1 and "fault: verdict says FAIL" in done.stdout
    assert "faults: 1" in done.stdout
