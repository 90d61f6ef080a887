"""Commands that look at archives."""

import json
import re
import shutil
from pathlib import Path

import pytest
from support import computed, here
from tampering import opened

from galinx.app.commands import options
from galinx.app.errors import BadInput
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


@pytest.mark.parametrize(
    "text, found", [("3", [3]), ("0,4,2", [0, 4, 2]), ("0-2, 1,5 - 5", [0, 1, 2, 5]), ("7-7", [7])]
)
def test_states_are_named_by_numbers_and_ranges(text, found):
    assert options.numbers(text) == found


@pytest.mark.parametrize("text", ["", "a", "1,,2", "-1", "3-1", "1.5", "0-99999999", "1-2-3"])
def test_what_names_no_states_is_refused(text):
    with pytest.raises(BadInput, match=r"^--states: found "):
        options.numbers(text)


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


OWN = {
    "solid.material": "T302", "solve.methods": ["closed_form"], "solve.mode": "traction", "motion.c": 0.3,
    "solve.pressure": [[-1, 0], [0, -2], [1, 0]], "output.quantities": ["surface", "yield"],
}  # fmt: skip


def test_in_si_show_tells_yield_speeds_and_lengths(tmp_path):
    result = computed("tables4_5", OWN)
    result.save(tmp_path / "a.h5")
    unit, a = 55.3e3 / 2e-3, 1e-3
    plain, si = (
        here("show", tmp_path / "a.h5", *options).stdout for options in (("--dimensionless",), ())
    )
    largest = result.data["states/closed_form/von_mises"]
    assert re.search(rf"largest von Mises \[N/\(2a\)\] +{largest[0]:.4g} ", plain)
    assert re.search(rf"largest von Mises \[MPa\] +{re.escape(f'{1e-6 * unit * largest[0]:.4g}')} ", si)
    depth = result.data["states/closed_form/von_mises_Y_over_a"]
    assert re.search(rf"at Y \[mm\] +{re.escape(f'{1e3 * a * depth[0]:.4g}')} ", si)
    assert "speed = 940.197 m/s" in si and "waves that cross the contact in a stroke" in si
    shown = json.loads(here("show", tmp_path / "a.h5", "--json").stdout)
    first, units = shown["states"][0], shown["units"]
    assert units["closed_form"]["von_mises"] == "MPa" and units["closed_form"]["von_mises_Y"] == "mm"
    assert first["closed_form"]["von_mises"] == pytest.approx(1e-6 * unit * largest[0], rel=1e-14)
    assert first["speed"] == pytest.approx(result.data["states/speed"][0]) and "c" not in first
    assert units["speed"] == "m/s"
