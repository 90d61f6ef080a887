"""Computed tables beside the printed ones."""

from io import StringIO

import numpy as np
import pytest
from support import widest

from galinx.app.console.sheets import new_console, print_sheet
from galinx.app.study.published import (
    INTENSITIES,
    intensities,
    intensity_rows,
    table1,
    table1_rows,
    table3,
)
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.solids.isotropic import Isotropic


def test_table_1_to_every_printed_digit_but_its_misprint():
    rows = table1_rows()
    for i, (printed, computed) in enumerate(rows):
        last = i == len(rows) - 1
        assert round(computed[0], 4) == (0.4966 if last else printed[0])
        assert computed[1] == pytest.approx(printed[1], abs=1e-18)
        assert [round(k, 4) for k in computed[2:]] == printed[2:]


def test_table_1_misprint_contradicts_its_own_slope(published):
    """Dahl's law has the last printed rate k1 at a friction of 0.4966, not at the printed one."""
    table = published["table1"]
    law = Dahl(table["mu_c"], table["sigma0_l_over_N"], table["delta_D"])
    for f, _, k1, *_ in table["rows"][:-1]:
        assert law.rate(f, 1) / law.λ == pytest.approx(
            k1, abs=1.5e-4
        )  # both are printed with four digits
    f, _, k1, *_ = table["rows"][-1]
    assert abs(law.rate(f, 1) / law.λ - k1) > 1e-3
    assert law.rate(0.4966, 1) / law.λ == pytest.approx(k1, abs=1.5e-4)


def test_tables_4_and_5_to_every_printed_digit(tables_run):
    data = tables_run.data
    rows = [row for name in ("table4", "table5") for row in intensity_rows(name, data)]
    assert len(rows) == 12
    for row in rows:
        assert [round(K, 4) for K in row.K_I[1:]] == [row.K_I[0]] * 3
        np.testing.assert_allclose(row.diff_percent[1:], row.diff_percent[0], atol=0.015)
        assert row.agrees


def test_the_studys_tables_fit_80_columns(tables_run):
    text = StringIO()
    sheets = [table1(), table3(Isotropic(193e9, 0.25, 7860.0), 1e-4)]
    sheets += [intensities(name, intensity_rows(name, tables_run.data)) for name in INTENSITIES]
    for sheet in sheets:
        print_sheet(new_console(text), sheet)
    said = text.getvalue()
    assert (said.count(" yes "), said.count(" ≤ 0.01 "), said.count(" NO")) == (4, 8, 0)
    assert widest(text.getvalue()) <= 80
