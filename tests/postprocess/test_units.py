"""Units of a result, over the table of quantities: none without a unit, and SI is what is archived."""

import numpy as np
import pytest
from support import computed, kept

from galinx.postprocess.quantities import table
from galinx.postprocess.quantities.quantity import CONTACT
from galinx.postprocess.units import Units, number, prefixed

#: What units that may stand in a result are in SI, as powers of m, kg and s, and their sizes.
_PASCAL, _METRE, _SECOND = (-1, 1, -2), (1, 0, 0), (0, 0, 1)
SIZES = {
    "kPa": (1e3, _PASCAL), "MPa": (1e6, _PASCAL), "GPa": (1e9, _PASCAL), "Pa": (1.0, _PASCAL),
    "nm": (1e-9, _METRE), "µm": (1e-6, _METRE), "mm": (1e-3, _METRE), "m": (1.0, _METRE),
    "N/m": (1.0, (0, 1, -2)), "N/mm": (1e3, (0, 1, -2)), "kN/mm": (1e6, (0, 1, -2)),
    "nm/s": (1e-9, (1, 0, -1)), "µm/s": (1e-6, (1, 0, -1)), "mm/s": (1e-3, (1, 0, -1)),
    "m/s": (1.0, (1, 0, -1)), "s/m": (1.0, (-1, 0, 1)),
    "1/m": (1.0, (-1, 0, 0)), "1/s": (1.0, (0, 0, -1)),
    "ns": (1e-9, _SECOND), "µs": (1e-6, _SECOND), "ms": (1e-3, _SECOND), "s": (1.0, _SECOND),
    "nJ/m": (1e-9, (1, 1, -2)), "µJ/m": (1e-6, (1, 1, -2)), "mJ/m": (1e-3, (1, 1, -2)),
    "J/m": (1.0, (1, 1, -2)), "kJ/m": (1e3, (1, 1, -2)),
    "N/m²": (1.0, _PASCAL), "kN/m²": (1e3, _PASCAL), "N/mm²": (1e6, _PASCAL), "kN/mm²": (1e9, _PASCAL),
    "kg/m^3": (1.0, (-3, 1, 0)), "deg": (1.0, (0, 0, 0)), "rad": (1.0, (0, 0, 0)),
    "m^(1-k)": (1.0, (0, 0, 0)),
    "1": (1.0, (0, 0, 0)), "none": (1.0, (0, 0, 0)), "a": (1.0, (0, 0, 0)),
}  # fmt: skip

CLOSED = {"solve.methods": ["closed_form"]}
SCENES = (
    "yield", "cylinder", "coating", "slider", "fibres", "shoulders", "from rest", "minor_loops",
    "velocity_steps", "traction",
)  # fmt: skip


def archived(row, contact, h, m, N):
    """What one of an archive's numbers is worth in SI: its factor and its offset, by the row's unit."""
    a, μ, c_s = contact.half_width, contact.solid.μ, contact.solid.c_s
    by_state = row.path.split("/")[0] in ("states", "surface", "interior", "interfaces", "layers")
    a, N = (h, N) if by_state else (a, contact.load)
    units = {
        "N/(2a)": N / (2.0 * a), "a/c_s": a / c_s, "N/(2mu)": N / (2.0 * μ), "N*a": N * a,
        "N^2/(4mu)": N**2 / (4.0 * μ), "N/m^2": 1.0,
    }  # fmt: skip
    if row.unit != "1":
        return units.get(row.unit, 1.0), 0.0
    name = row.path.rpartition("/")[2]
    if name.endswith(
        ("X_over_a", "pressure_position", "pressure_centre", "steady_centre", "steady_centres")
    ):
        return a, m if by_state else 0.0
    if name == "centre_of_pressure":
        return a, 0.0
    lengths = ("_over_a", "yield_depth", "reach_left", "reach_right", "reversed_left", "reversed_right",
               "strain_left", "strain_right")  # fmt: skip
    if name.endswith(lengths):
        return a, 0.0
    if row.path in ("states/c", "time/c", "run/fem/c"):
        return c_s, 0.0
    return (N if row.path == "time/load" else 1.0), 0.0


@pytest.mark.parametrize("name", SCENES)
def test_every_quantity_has_a_unit_and_is_in_si_what_is_archived(name):
    result = kept(name)
    units, contact = result.units(), result.scene.body
    h, m = units.half_width, units.middle
    for path, row in table().items():
        scaled = units(row)
        if scaled is None or "K_I" in path:
            continue
        assert scaled.unit in SIZES and scaled.name, path
        factor, offset = archived(row, contact, h, m, units.load)
        size = SIZES[scaled.unit][0]
        np.testing.assert_allclose(scaled.factor * size, factor, rtol=1e-13, err_msg=path)
        np.testing.assert_allclose(scaled.offset * size, offset, rtol=1e-13, atol=1e-30, err_msg=path)
        if row.unit in SIZES and row.unit != "1":  # what is archived in SI keeps its dimension
            assert SIZES[scaled.unit][1] == SIZES[row.unit][1], path


@pytest.mark.parametrize("dimensionless", [False, True])
@pytest.mark.parametrize("name", SCENES)
def test_every_column_has_a_unit(name, dimensionless):
    for column in kept(name).table(dimensionless):
        known = column.unit in SIZES or column.unit.startswith(("N/(2a)", "of ", "MPa√m", "MPa·m^(-"))
        assert known, column.label


def test_dimensionless_is_as_archived_and_nothing_stands_twice():
    """But lengths of contacts, which are archived in m, and work of friction loops, in J/m."""
    result = kept("cylinder")
    plain, si, a = result.units(dimensionless=True), result.units(), result.scene.body.half_width
    for path, row in table().items():
        scaled = plain(row)
        assert (scaled is None) == (path == "states/speed")
        if scaled:
            kind = CONTACT if row.scale == CONTACT else row.unit
            unit, of_SI = {CONTACT: ("a", a), "J/m": ("N*a", result.scene.punch.load * a)}.get(
                kind, (row.unit, 1.0)
            )
            assert scaled.unit == unit and np.all(scaled.offset == 0.0), path
            assert scaled.factor == pytest.approx(1.0 / of_SI, rel=1e-15), path
    names = [
        scaled.head for path, row in table().items() if path.startswith("states/") and (scaled := si(row))
    ]
    assert len(names) == len(set(names)) and names.count("speed [m/s]") <= 1


def test_a_stress_intensity_factor_is_the_limit_of_the_pressure():
    """(2π s)^(-α) times the pressure at s from the edge, a power whose exponent is the edge's own."""
    result = kept("flat")
    units, data, a = result.units(), result.data, result.scene.body.half_width
    for side, exponents in (("left", data["states/beta"]), ("right", data["states/alpha"])):
        row = table()[f"states/closed_form/K_I_{side}"]
        scaled = units(row)
        K = scaled.of(data[row.path])
        α = data["states/alpha"]
        s = 1e-9
        r = (1.0 - s) if side == "right" else -(1.0 - s)
        weight = s**α * (2.0 - s) ** (-1.0 - α) if side == "right" else (2.0 - s) ** α * s ** (-1.0 - α)
        pressure = 2.0 * np.sin(-np.pi * α) / np.pi * weight * units.stress.factor  # Eq 55
        assert abs(r) < 1.0
        np.testing.assert_allclose(K, pressure * (2.0 * np.pi * s * a) ** -exponents, rtol=1e-8)
        assert scaled.unit == ("MPa·m^(-β)" if side == "left" else "MPa·m^(-α)")
    assert units(table()["states/closed_form/K_I"]) is None  # the ends differ
    still = computed("tables4_5", CLOSED | {"friction.mu_c": 1e-12})
    K = still.units()(table()["states/closed_form/K_I_left"])
    N = 1e-6 * still.scene.punch.load
    assert K.unit == "MPa√m"
    np.testing.assert_allclose(
        K.of(still.data["states/closed_form/K_I_left"]), N / np.sqrt(np.pi * a), rtol=1e-9
    )


@pytest.mark.parametrize(
    "unit, size, expected",
    [
        ("Pa", 9.5e8, "MPa"), ("Pa", 3e10, "GPa"), ("Pa", 4e3, "kPa"), ("m", 5.2e-5, "µm"),
        ("m", 1e-3, "mm"),
        ("N/m", 5.53e4, "N/mm"), ("N/m", 1.0, "N/m"), ("m/s", 500.0, "m/s"), ("s", 3e-6, "µs"),
        ("1/m", 2.5e4, "1/m"),
    ],
)  # fmt: skip
def test_prefixes_are_those_of_engineers(unit, size, expected):
    assert prefixed(unit, size)[0] == expected


@pytest.mark.parametrize(
    "value, text",
    [(1206.14, "1206"), (499.99999999999994, "500"), (0.031254, "0.03125"), (123456.7, "123500"),
     (0.0, "0"), (float("nan"), ""), (-2.5e-7, "-2.5e-07")],
)  # fmt: skip
def test_numbers_have_reasonable_digits(value, text):
    assert number(value) == text


def test_places_far_from_the_axis_choose_the_prefix_of_lengths():
    result = computed("cylinder", CLOSED)
    far = {**result.data, "states/closed_form/centre": np.full(len(result.data["states/f"]), 1e3)}
    for data, unit in ((result.data, result.units().position.unit), (far, "m")):
        assert Units(result.scene.body, data).position.unit == unit
