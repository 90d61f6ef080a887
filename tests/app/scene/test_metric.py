"""Metric units, against pint, which knows all units."""

import random

import pytest

from galinx.app.scene import units
from galinx.app.scene.units import _UNITS, in_units, quantity
from galinx.app.scene.units import units as units_of


def in_unit(text, unit):
    return in_units(quantity(text), units_of(unit))


def products(count):
    """Random numbers with products of metric units."""
    choose, names = (
        random.Random(5),
        [name for name in _UNITS if name not in ("μm", "%")],
    )  # not every pint has them
    for _ in range(count):
        number = f"{choose.uniform(0.1, 1000.0):.6g}" + choose.choice(["", "e3", "e-7"])
        text = f"{number} " + choose.choice(["", "1/"]) + choose.choice(names)
        for _ in range(choose.randint(0, 1)):
            text += choose.choice(["*", "/", " / ", " * "]) + choose.choice(names)
            text += choose.choice(["", "", "^2", "**3", "**-1"])
        yield text


def test_products_of_metric_units_are_those_of_pint():
    pint = units._registry()
    for text in products(400):
        wanted = pint.Quantity(text).to_base_units()
        unit = f"{wanted.units:~}".replace(" ", "").replace("**", "^")
        assert in_unit(text, unit) == pytest.approx(wanted.magnitude, rel=1e-13), text


def test_decimal_numbers_stay_what_they_are():
    for text, unit, wanted in (
        ("0.1 mm", "m", 1e-4), ("193 GPa", "Pa", 193e9), ("55.3 N/mm", "N/m", 55.3e3),
        ("25000 1/m", "1/m", 25000.0), ("7.86 g/mm^3", "kg/m^3", 7.86e6), ("1.5 mm/s", "m/s", 1.5e-3),
        ("3 μm", "m", 3e-6),
    ):  # fmt: skip
        assert in_unit(text, unit) == wanted


@pytest.mark.parametrize("text", ["1 inch", "1 N", "1 m*s/m", "1", "1 deg", "1 m/foo"])
def test_what_is_not_metric_or_of_another_dimension_is_left_to_pint(text):
    assert in_unit(text, "m") is None
