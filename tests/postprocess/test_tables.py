"""What tables say of states, loops and sliders."""

import numpy as np
import pytest
from support import computed, kept

from galinx.postprocess.tables import loops_sheet, sliders_sheet, states_sheet


def cells(sheet, head):
    column = list(sheet.columns).index(head)
    return [row[column] for row in sheet.rows]


def test_contacts_whose_ends_are_found_have_their_half_width_and_no_intensity():
    result = kept("cylinder")
    data, sheet = result.data, states_sheet(result.data, result.units())
    assert not any(head.startswith("K") for head in sheet.columns)
    for head, name in (("half-width [µm]", "half_width"), ("centre [µm]", "centre")):
        expected = 1e6 * data[f"states/closed_form/{name}"]
        found = np.array(cells(sheet, head), dtype=float)
        np.testing.assert_allclose(found, expected, rtol=1e-3, atol=0.01)
    result = kept("flat")
    flat = states_sheet(result.data, result.units())
    assert "K_I, left [MPa·m^(-β)]" in flat.columns
    assert not any(head.startswith(("half-width", "peak")) for head in flat.columns)
    assert "half-width = 1 mm" in flat.notes[0]


def test_loops_tell_what_they_take_by_what_tells_them_apart():
    laws = {"friction.mu_c": [0.3, 0.7], "output.quantities": ["friction"]}
    result = computed("tables4_5", laws)
    data, sheet = result.data, loops_sheet(result.data, result.units())
    assert cells(sheet, "loop") == ["0", "1"] and cells(sheet, "μ_C") == ["0.3", "0.7"]
    work = np.array(cells(sheet, "work [J/m]"), dtype=float)
    np.testing.assert_allclose(work, data["loops/dissipated"].sum(axis=1), rtol=1e-4)
    np.testing.assert_allclose(
        np.array(cells(sheet, "breakaway force [N/mm]"), dtype=float),
        1e-3 * data["loops/breakaway"].max(axis=1),
        rtol=1e-4,
    )


def test_sliders_tell_their_stick_slip():
    result = kept("slider")
    data = result.data
    (row,) = sliders_sheet(data, result.units()).rows
    assert row[1] == "stick-slip"
    assert float(row[2]) == pytest.approx(data["slider/period"][0], rel=1e-5)
    other = computed("tables4_5", {"output.quantities": ["friction"]})
    assert not sliders_sheet(other.data, other.units()).rows
