"""Computed tables beside the printed ones."""

from dataclasses import replace
from io import StringIO

import numpy as np
import pytest

from galinx.app.console import new_console, print_sheet
from galinx.app.study.published import (
    FAST,
    dimensions_sheet,
    frame_sheet,
    friction_sheet,
    intensity_rows,
    not_as_printed,
    speed_rows,
    table1_rows,
    table3,
)
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.solids.isotropic import Isotropic

T302 = Isotropic(193e9, 0.25, 7860.0)


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
        assert [round(diff, 2) for diff in row.diff_of_printed] == [row.diff_percent[0]] * 3
        np.testing.assert_allclose(row.diff_percent[1:], row.diff_percent[0], atol=0.015)
        assert row.agrees


def test_the_studys_arithmetic_gives_its_differences(published):
    """Its own printed K_I, and no other number."""
    for name in ("table4", "table5"):
        rows = published[name]["rows"]
        for (_, _, first, diff), (_, _, second, same) in zip(rows[::2], rows[1::2]):
            assert round(100 * abs(first - second) / first, 2) == diff == same


def test_a_wrong_difference_or_intensity_does_not_agree(tables_run):
    row, *_ = intensity_rows("table4", tables_run.data)
    assert row.agrees
    assert not replace(row, K_I=(0.3160, *row.K_I[1:])).agrees
    assert not replace(row, K_I=(*row.K_I[:3], row.K_I[3] + 1e-4)).agrees
    assert not replace(row, diff_percent=(1.64, *row.diff_percent[1:])).agrees
    assert not replace(row, diff_of_printed=(*row.diff_of_printed[:2], 1.66)).agrees


def test_table_3_by_the_text_of_the_study():
    rows = speed_rows(T302, 1e-4)
    c, V, time = rows["HS"]
    assert c == FAST and round(V, 1) == 1880.4 and f"{time:.3e}" == "5.318e-08"
    assert rows["SS"] == pytest.approx((4.786e-7, 1.5e-3, 0.06667), rel=1e-4)
    assert "1880.4  " in printed(table3(T302, 1e-4)) and "5.318e-08" in printed(table3(T302, 1e-4))


def test_what_is_not_as_printed_is_counted(monkeypatch):
    assert not_as_printed(T302, 1e-4) == 0
    assert not_as_printed(Isotropic(193e9, 0.25, 7900.0), 1e-4) == 3  # V at high speed, and both times
    assert not_as_printed(T302, 1.01e-4) == 1  # the time at slow speed is printed, the other follows
    monkeypatch.setattr("galinx.app.study.published.Dahl", lambda μ, λ, δ: Dahl(1.001 * μ, λ, δ))
    assert not_as_printed(T302, 1e-4) > 0


def test_distances_over_which_friction_develops():
    """0.018, 0.055, 0.092 and 0.129 mm for μ_C = 0.1, 0.3, 0.5, 0.7."""
    laws = [Dahl(μ, 25000.0, 1.0) for μ in (0.1, 0.3, 0.5, 0.7)]
    rows = friction_sheet(laws, 1e-4).rows
    assert [row[-1] for row in rows] == ["0.018", "0.055", "0.092", "0.129"]


def test_constants_of_the_moving_frame():
    """At rest 1 and (κ - 1)/(κ + 1); at speed by the Rayleigh function as it is written."""
    slow, fast = ([float(cell) for cell in row[1:]] for row in frame_sheet(T302).rows)
    assert slow == pytest.approx([1.0, 1 / 3, 1.0, 1 / 3], abs=1e-6)
    β_s, β_d, e = np.sqrt(1 - 0.36), np.sqrt(1 - 0.12), 2 - 0.36
    n, q, m = np.array([0.36 * β_d, e - 2 * β_s * β_d, 0.36 * β_s]) / (4 * β_s * β_d - e * e)
    assert fast == pytest.approx([4 * n / 3, 4 * q / 3, 4 * m / 3, 4 * q / 3], abs=1e-6)


def test_intensities_with_dimensions_are_the_limits_of_the_pressure(tables_run):
    """-σ_YY 2^-β (a - X)^-α at 1e-9 a from X = a, in MPa and mm, of a punch of another size."""
    N, a = 1e5, 2e-3
    rows = dimensions_sheet(tables_run.data, N, a).rows
    assert len(rows) == 12
    for row, g in zip(rows, tables_run.data["states/g"]):
        c = float(row[0].split()[1])
        punch, d = FlatPunch(T302.response(c), g), 1e-9
        near = -1e-6 * N / (2 * a) * np.array(
            [punch.traction(d, 2.0 - d), punch.traction(2.0 - d, d)]
        )  # fmt: skip
        limits = near * [2.0**-punch.α * (2 * d) ** -punch.β, 2.0**-punch.β * (2 * d) ** -punch.α]
        assert [float(cell) for cell in row[4:]] == pytest.approx(limits, abs=6e-5)


def printed(sheet):
    text = StringIO()
    print_sheet(new_console(text), sheet)
    return text.getvalue()
