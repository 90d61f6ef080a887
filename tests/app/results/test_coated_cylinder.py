"""A coated cylinder contact as it leaves the program, against a solution of its own."""

import csv
import io

import numpy as np
import pytest
from coated_reference import DrawnCylinder, von_mises
from support import here

SCENE = """\
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
    (tmp_path / "tin.toml").write_text(SCENE)
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
    assert row["von_mises_below_yields [of the yield strength]"] == "yes, 127 %"


def test_a_table_without_friction_has_no_tension_and_no_rounding(tmp_path):
    """σ_XX is less than 0 all along, and largest at the end of what is seen: no tension."""
    (tmp_path / "tin.toml").write_text(SCENE.replace("0.15", "0.0").replace("20 µm", "5 µm"))
    here("run", "tin.toml", "-o", "tin.h5", cwd=tmp_path)
    (row,) = csv.DictReader(io.StringIO(here("csv", "tin.h5", cwd=tmp_path).stdout))
    assert row["sie_sigma_XX_max [MPa]"] == row["sie_sigma_XX_max_X [µm]"] == ""
    assert float(row["interface_shear_X [µm]"]) > 0.0  # that where σ_XY > 0, of two as large
    told = here("show", "tin.h5", cwd=tmp_path).stdout
    assert "von Mises below the layers" in told and "at X = 0 µm, Y = -34.8" in told and "e-1" not in told
