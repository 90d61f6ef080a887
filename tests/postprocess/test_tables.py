"""What tables say of states, loops and sliders."""

import numpy as np
import pytest
from support import computed

from galinx.postprocess.tables import LIMIT, inner_sheet, loops_sheet, sliders_sheet, states_sheet

CLOSED_FORM = {"solve.methods": ["closed_form"]}


def cells(sheet, head):
    column = list(sheet.columns).index(head)
    return [row[column] for row in sheet.rows]


def test_contacts_whose_ends_are_found_have_their_half_width_and_no_intensity():
    data = computed("cylinder", CLOSED_FORM | {"motion.c": [0.0, 0.6]}).data
    sheet = states_sheet(data, "")
    assert not any(head.startswith("K") for head in sheet.columns)
    for head, name in (("a (m)", "half_width"), ("centre (m)", "centre")):
        np.testing.assert_allclose(
            np.array(cells(sheet, head), dtype=float), data[f"states/closed_form/{name}"], rtol=1e-4
        )
    flat = states_sheet(computed("tables4_5", CLOSED_FORM).data, "")
    assert "K_I" in flat.columns and "a (m)" not in flat.columns


def test_loops_tell_what_they_take_by_what_tells_them_apart():
    laws = {"friction.mu_c": [0.3, 0.7], "output.quantities": ["friction"]}
    data = computed("tables4_5", laws).data
    sheet = loops_sheet(data)
    assert cells(sheet, "loop") == ["0", "1"] and cells(sheet, "μ_C") == ["0.3", "0.7"]
    work = np.array(cells(sheet, "work (J/m)"), dtype=float)
    np.testing.assert_allclose(work, data["loops/dissipated"].sum(axis=1), rtol=1e-4)
    np.testing.assert_allclose(
        np.array(cells(sheet, "breakaway (N/m)"), dtype=float),
        data["loops/breakaway"].max(axis=1),
        rtol=1e-4,
    )


def test_of_many_loops_the_first_are_told():
    many = {"friction.mu_c": np.linspace(0.1, 0.9, LIMIT + 5).tolist(), "output.quantities": ["friction"]}
    assert len(loops_sheet(computed("tables4_5", many).data).rows) == LIMIT


def test_sliders_tell_their_stick_slip():
    data = computed("slider", {"slider.duration": 15.0}).data
    (row,) = sliders_sheet(data).rows
    assert row[1] == "stick-slip"
    assert float(row[2]) == pytest.approx(data["slider/period"][0], rel=1e-5)
    assert not sliders_sheet(computed("tables4_5", {"output.quantities": ["friction"]}).data).rows


def test_what_a_law_remembers_is_told_but_where_that_is_f():
    data = computed("minor_loops", {}).data
    sheet, z = inner_sheet(data), data["states/inner_state"]
    assert len(sheet.rows) == len(z) and z.shape[1] == 3
    for n in range(3):
        np.testing.assert_allclose(np.array(cells(sheet, f"z{n + 1}"), float), z[:, n], rtol=1e-5)
    dahl = computed("tables4_5", {"output.quantities": ["friction"]}).data
    assert not inner_sheet(dahl).rows


def test_loops_of_several_loads_say_which_is_theirs():
    loads = {"output.quantities": ["friction"], "punch.load": [2e3, 4e3]}
    data = computed("tables4_5", loads).data
    assert "N = 2000 N/m" in loops_sheet(data).notes[0]
    half = computed("tables4_5", loads | {"punch.load": 1e3}).data
    np.testing.assert_allclose(data["loops/dissipated"], 2.0 * half["loops/dissipated"], rtol=1e-14)
    assert "N (N/m)" in states_sheet(data, "").columns
