"""Contacts read off a result, one row a state: the same everywhere; a coated one by its own solution."""

import csv
import io

import numpy as np
import pytest
from coated_reference import DrawnCylinder, von_mises
from support import computed, here

from galinx.app.results.csv import pieces

#: A cylinder of 5 mm on steel that yields at 600 MPa, 100 N/mm, slow.
R, N, YIELD = 5e-3, 1e5, 600e6
SCENE = {
    "solid.material": "steel", "solid.yield_strength": YIELD, "punch.profile": "parabolic",
    "punch.radius": R,
    "punch.load": N, "punch.half_width": None, "friction.model": "coulomb", "friction.mu_c": 0.15,
    "friction.sigma0_over_load": None, "friction.delta": None, "motion.c": None,
    "motion.speed": "1 m/s", "motion.strokes": ["forward"], "motion.X_over_L": [1.0],
    "solve.methods": ["closed_form"], "output.quantities": ["sif", "surface", "yield"],
}  # fmt: skip


@pytest.fixture(scope="module")
def result():
    return computed("tables4_5", SCENE)


def test_nearly_the_load_of_first_yield_does_not_yield(result):
    """In numbers of the table, which tells the load in N/mm."""
    row = {column.head: column for column in result.table() if not column.place}
    nearly = {"punch.load": 0.999999e3 * row["load at first yield"].values[0]}
    (told,) = (c for c in computed("tables4_5", SCENE | nearly).table() if c.head == "yields")
    assert told.texts() == ["no, 99.9999 %"]


def test_yield_at_sharp_edges_says_where_it_goes_deeper_than_depths_are_sought():
    """Only the last load yields the solid more than 10 a deep, where its depth is not a number.

    By the first it is 2e-7 a deep: less than places have digits, and no 0.
    """
    changes = {
        "punch": {"half_width": 1e-3, "load": [1e3, 1e5, 5e6]}, "friction": {"mu": 0.2},
        "solid.yield_strength": 3e8, "motion.c": 0.3, "motion.strokes": None, "motion.X_over_L": None,
        "solve.methods": ["closed_form"], "output.quantities": ["sif", "yield"],
    }  # fmt: skip
    result = computed("tables4_5", changes)
    (told,) = (column for column in result.table() if column.head == "yields")
    at_edges = "yes, at the sharp edges"
    assert told.texts() == [at_edges, at_edges, f"{at_edges}, deeper than 10 a"]
    archived = result.data["states/closed_form/yield_depth"]
    (depths,) = (column for column in result.table() if column.head == "depth of yield")
    assert 0.0 < archived[0] < 5e-6 and np.isnan(archived[2])
    assert float(depths.texts()[0]) == pytest.approx(archived[0], rel=1e-3)


def test_screen_csv_and_notebook_show_the_same_row(result, tmp_path):
    result.save(tmp_path / "a.h5")
    shown, html = here("show", tmp_path / "a.h5").stdout, result._repr_html_()
    heads, cells = csv.reader("".join(pieces(tmp_path / "a.h5")).splitlines())
    table = dict(zip(heads, cells))
    for column in result.table():
        if column.constant and column.name in ("motion", "X_over_L"):
            continue
        head = column.name if column.unit == "none" else f"{column.name} [{column.unit}]"
        assert head in table, head
        text = column.texts()[0]
        assert text in shown and (text in html or f"{column.head} = {text}" in html), column.head
        if not isinstance(column.values[0], str):
            assert float(table[head]) == pytest.approx(float(column.values[0]), rel=1e-14)


COATED = """\
solid.material = "steel"
solid.yield_strength = "600 MPa"
layer = [{material = "TiN", thickness = "20 µm"}]
punch = {profile = "parabolic", radius = "5 mm", load = "100 N/mm"}
friction.mu = 0.15
motion.speed = "1 m/s"
solve.methods = ["sie"]
"""
STEEL, TIN, THICKNESS = (210e9, 0.3), (450e9, 0.25), 20e-6


def cylinder(coating):
    return DrawnCylinder(coating, STEEL, THICKNESS, 5e-3, 1e5, 0.15, 4e-7, 65536, 70e-6)


def test_the_reference_is_hertz_where_nothing_coats():
    """Half-width, pressure, and the tension 2 f p₀ of Smith and Liu, to which coupling adds some."""
    plain = cylinder(STEEL)
    b = np.sqrt(4.0 * 1e5 * 5e-3 * (1.0 - 0.3**2) / (np.pi * 210e9))
    assert plain.pressure.max() == pytest.approx(2e5 / (np.pi * b), rel=1e-3)
    assert (plain.ends[1] - plain.ends[0]) / 2 == pytest.approx(b, rel=1e-3)
    assert plain.tension_at_trailing_end() == pytest.approx(2 * 0.15 * 2e5 / (np.pi * b), rel=0.04)


def test_the_table_of_a_coated_cylinder_is_right_to_a_thousandth(tmp_path):
    (tmp_path / "tin.toml").write_text(COATED)
    here("run", "tin.toml", "-o", "tin.h5", cwd=tmp_path)
    heads, cells = csv.reader(io.StringIO(here("csv", "tin.h5", cwd=tmp_path).stdout))
    row = dict(zip(heads, cells, strict=True))
    coated = cylinder(TIN)
    near = np.abs(coated.x) < 1e-4
    depths = np.linspace(0.0, 1.0, 21) * THICKNESS
    expected = {
        "sie_half_width [µm]": 1e6 * (coated.ends[1] - coated.ends[0]) / 2,
        "sie_largest_pressure [MPa]": 1e-6 * coated.pressure.max(),
        "sie_sigma_XX_max [MPa]": 1e-6 * coated.tension_at_trailing_end(),
        "sie_sigma_XX_max_X [µm]": 1e6 * coated.ends[0],
        "interface_shear [MPa]": 1e-6 * np.abs(coated.stresses(THICKNESS)[2]).max(),
        "von_mises_1 [MPa]": 1e-6 * max(von_mises(coated.stresses(y), 0.25)[near].max() for y in depths),
        "von_mises_below [MPa]": 1e-6
        * max(von_mises(coated.stresses(THICKNESS + y, True), 0.3)[near].max() for y in depths),
    }
    for head, value in expected.items():
        assert float(row[head]) == pytest.approx(value, rel=1e-3), head
    share = float(row["von_mises_below_yields [of the yield strength]"])
    assert share == pytest.approx(1.27, abs=0.005)


def test_a_table_without_friction_has_no_tension_and_no_rounding(tmp_path):
    """σ_XX is less than 0 all along, and largest at the end of what is seen: no tension."""
    (tmp_path / "tin.toml").write_text(COATED.replace("0.15", "0.0").replace("20 µm", "5 µm"))
    here("run", "tin.toml", "-o", "tin.h5", cwd=tmp_path)
    (row,) = csv.DictReader(io.StringIO(here("csv", "tin.h5", cwd=tmp_path).stdout))
    assert row["sie_sigma_XX_max [MPa]"] == row["sie_sigma_XX_max_X [µm]"] == ""
    assert float(row["interface_shear_X [µm]"]) > 0.0  # that where σ_XY > 0, of two as large
    told = here("show", "tin.h5", cwd=tmp_path).stdout
    assert "von Mises below the layers" in told and "at X = 0 µm, Y = -34.8" in told and "e-1" not in told
