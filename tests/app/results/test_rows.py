"""Hertz's contact read off a result: one row a state, against formulas of its own."""

import csv

import numpy as np
import pytest
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


def hertz(solid):
    """Half-width [m], largest pressure [Pa], and largest von Mises stress without friction [Pa]."""
    E, ν = solid.E, solid.ν
    b = np.sqrt(4.0 * N * R * (1.0 - ν**2) / (np.pi * E))
    p0 = 2.0 * N / (np.pi * b)
    z = np.linspace(0.0, 3.0, 30_001)
    root = np.sqrt(1.0 + z**2)
    σ_X, σ_Y = -p0 * ((1.0 + 2.0 * z**2) / root - 2.0 * z), -p0 / root
    σ_Z = ν * (σ_X + σ_Y)
    mises = np.sqrt(0.5 * ((σ_X - σ_Y) ** 2 + (σ_Y - σ_Z) ** 2 + (σ_Z - σ_X) ** 2))
    return b, p0, mises.max()


def test_without_friction_every_number_is_hertz_to_a_per_cent():
    still = computed("tables4_5", SCENE | {"friction.mu_c": 1e-4, "punch.load": 0.5 * N})
    row = {column.head: column for column in still.table() if not column.place}
    b, p0, mises = (value * np.sqrt(0.5) for value in hertz(still.scene.half_plane.solid))
    for head, expected in (
        ("half-width", 1e6 * b), ("peak pressure", 1e-6 * p0), ("largest von Mises", 1e-6 * mises),
        ("load at first yield", 0.5e-3 * N * (YIELD / mises) ** 2),
    ):  # fmt: skip
        assert row[head].values[0] == pytest.approx(expected, rel=1e-2), head
    share = 100.0 * (mises / YIELD) ** 2
    assert row["yields"].values[0].startswith("no, ")
    assert float(row["yields"].values[0][4:-2]) == pytest.approx(share, rel=2e-2)


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
