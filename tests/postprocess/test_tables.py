"""Tables: the same row everywhere; what they leave out, as rounding and loops of a steady motion."""

import csv

import numpy as np
import pytest
from support import computed, here

from galinx.app.results.csv import pieces
from galinx.postprocess.quantities import validity
from galinx.postprocess.tables import limits_sheet, loops_sheet, sliders_sheet, states_sheet

SCENE = """
solid.material = "steel"
punch.profile = "parabolic"
punch.radius = "5 mm"
punch.load = "100 N/mm"
friction.mu = 0.0
motion.speed = "1 m/s"
solve.methods = ["closed_form"]
"""


def test_the_tension_that_frictionless_contact_has_by_rounding_is_none():
    result = computed(SCENE)
    for tension, shown in ((0.0, "0 MPa"), (4e-9, "0 MPa"), (4e-5, "0.03808 MPa at X = -262.6 µm")):
        result.data["states/closed_form/sigma_XX_max"][:] = tension
        rows = dict(states_sheet(result.data, result.units(), width=80).rows)
        assert rows["largest tension σ_XX"] == shown
        plain = dict(states_sheet(result.data, result.units(dimensionless=True), width=80).rows)
        assert (plain["largest tension σ_XX"] == "0 N/(2a)") is (shown == "0 MPa")


def test_a_stress_that_is_none_has_no_place_beside_others():
    result = computed(SCENE, {"friction.mu": [0.0, 0.2]})
    rows = states_sheet(result.data, result.units(), width=80).rows
    tension = [row[0] for row in rows].index("largest tension σ_XX [MPa]")
    assert [rows[tension][1], rows[tension + 1][1]] == ["0", ""]
    assert rows[tension][2] != "0" and rows[tension + 1][2] != ""


@pytest.mark.parametrize("method, tension, none", [("fem", 2e-7, True), ("fem", 2e-6, False),
                                                  ("closed_form", 2e-7, False)])  # fmt: skip
def test_finite_elements_round_tenfold(method, tension, none):
    data, units = computed(SCENE).data, computed(SCENE).units()
    data = {path.replace("closed_form", method): values for path, values in data.items()}
    data[f"states/{method}/sigma_XX_max"] = np.array([tension])
    shown = dict(states_sheet(data, units, width=80).rows)["largest tension σ_XX"]
    assert (shown == "0 MPa") is none


def test_a_tilted_punch_that_yields_under_any_load_says_so():
    punch = {"punch.tilt": 0.01, "punch.load": "400 N/mm", "solid.yield_strength": "300 MPa"}
    asked = {"output.quantities": ["sif", "yield"], "solve.methods": ["closed_form"]}
    (told,) = (c for c in computed("tables4_5", punch | asked).table() if c.head == "yields")
    assert {*told.texts()} == {"yes, under any load"}


def test_a_wedge_with_a_strength_yields_under_any_load_whether_asked_or_not():
    wedge = {"punch.profile": "wedge", "punch.radius": None, "punch.slope": 0.02, "solid.material": None}
    solid = {"solid.E": "210 GPa", "solid.nu": 0.3, "solid.rho": 7800.0}
    for strength, said in (("600 MPa", ["yes, under any load"]), (None, [])):
        table = computed(SCENE, wedge | solid | {"solid.yield_strength": strength}).table()
        assert [text for c in table if c.head == "yields" for text in c.texts()] == said


def test_limits_that_are_the_same_in_all_states_stand_once():
    result = computed("coating", {"friction.mu_c": {"from": 0.1, "to": 0.2, "number": 9}})
    for width in (0, 80):
        sheet = limits_sheet(result.data, result.units(), width)
        assert "the same in all" in sheet.title and len(sheet.rows) == 3
        assert [row[1] for row in sheet.rows[1:]] == ["1", "1"]


def test_a_reach_that_is_rounding_is_not_shown():
    result = computed("tables4_5", {"solve.methods": ["closed_form"], "output.quantities": ["sif"]})
    paths = [row.path for row in validity.SLIP_REVERSED]
    for reach, shown in ((1e-9, False), (1e-3, True)):
        changed = dict.fromkeys(paths, np.full(len(result.data["states/f"]), reach))
        sheet = limits_sheet({**result.data, **changed}, result.units(), 80)
        assert ("slip reversed" in str(sheet)) == shown


def test_only_strokes_have_a_friction_loop(tmp_path):
    for strokes, loops in ((None, False), (["forward"], True)):
        archive = tmp_path / f"{loops}.h5"
        computed(SCENE, {"friction.mu": 0.2, "motion.strokes": strokes}).save(archive)
        shown = here("show", archive)
        assert shown.returncode == 0 and ("Friction loops" in shown.stdout) is loops


def test_a_loop_has_a_speed_where_its_law_depends_on_it():
    moving = {"motion.speed": [1.0, 900.0], "motion.strokes": ["forward"], "friction.mu": None}
    stribeck = {"friction.model": "stribeck", "friction.mu_s": 0.3, "friction.stribeck_velocity": 1.0}
    for law, loops in (({}, 1), (stribeck, 2)):
        result = computed(SCENE, moving | {"friction.mu_c": 0.2} | law)
        sheet = loops_sheet(result.data, result.units())
        assert len(sheet.rows) == loops and ("speed [m/s]" in sheet.columns) is (loops == 2)


def test_the_resultant_of_a_prescribed_pressure_stands_beside_the_load():
    """A pressure of any resultant is given over N/(2a), and the load at first yield is N."""
    pressure = {"solve.mode": "traction", "punch.profile": None, "punch.radius": None, "friction.mu": 0.2}
    for top, resultant in ((-1.5, "112.5 N/mm"), (-4.0 / 3.0, None)):
        rows = [[-1, 0], [-0.5, top], [0.5, top], [1, 0]]
        result = computed(
            SCENE, pressure | {"solve.pressure": rows, "output.quantities": ["surface", "yield"]}
        )
        sheet = states_sheet(result.data, result.units(), width=80)
        assert dict(sheet.rows).get("resultant of the pressure") == resultant
        said = any(note.startswith("load at first yield: N;") for note in sheet.notes)
        assert said == (resultant is not None)


def test_sliders_have_their_loads_and_laws_in_tables(tmp_path):
    slider = {"mass": 1.0, "stiffness": 1e3, "drive_speed": 1e-3, "duration": 1.0}
    changes = {f"slider.{key}": value for key, value in slider.items()}
    changes |= {"friction.mu_c": [0.5, 1.0], "punch.load": [1.0, 5.0]}
    result = computed("slider", changes)
    sheet = sliders_sheet(result.data, result.units())
    assert sheet.columns[:4] == ["law", "load [N/m]", "μ_C", "motion"]
    assert [row[1:3] for row in sheet.rows] == [["1", "0.5"], ["1", "1"], ["5", "0.5"], ["5", "1"]]
    result.save(tmp_path / "sliders.h5")
    rows = [*csv.DictReader("".join(pieces(tmp_path / "sliders.h5", "slider")).splitlines())]
    of_laws = {(row["law"], row["load [N/m]"], row["mu_c [1]"]) for row in rows}
    assert of_laws == {("0", "1", "0.5"), ("1", "1", "1"), ("2", "5", "0.5"), ("3", "5", "1")}


def test_lengths_over_a_say_which_a_that_is():
    """In a sweep half-widths are over that of the first contact, all else over that of each."""
    punch = {"profile": "parabolic", "radius": [0.01, 0.02], "load": 1e5}
    result = computed(SCENE, {"punch": punch, "output.quantities": ["sif", "yield"]})
    plain, dimensionless = (states_sheet(result.data, result.units(of)) for of in (False, True))
    assert not [note for note in plain.notes if "half-width" in note]
    a = result.units().contact.half_width
    assert f"half-width, centre: a = {a:.4g} m, that of the first contact at rest without friction" in (
        dimensionless.notes
    )
    assert "depth of yield/a" in {row[0] for row in dimensionless.rows} | set(dimensionless.columns)
