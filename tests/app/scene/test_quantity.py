"""Quantities: what is one, what is none, and what units are worth, against pint, which knows all."""

import random
from math import pi

import pytest

from galinx.app.scene import units
from galinx.app.scene.units import _UNITS, LONGEST, in_units, quantity, to_si
from galinx.app.scene.units import units as units_of


@pytest.mark.parametrize(
    "text, number, units",
    [
        ("7.86 g/mm^3", 7.86, (("g", 1), ("mm", -3))),
        ("25000 1/m", 25000.0, (("m", -1),)),
        ("-.5e3GPa", -500.0, (("GPa", 1),)),
        ("1 kg * m ** -3", 1.0, (("kg", 1), ("m", -3))),
        ("7860 kg/m³", 7860.0, (("kg", 1), ("m", -3))),
        ("3 m⁻²", 3.0, (("m", -2),)),
        ("7.8 g/cm3", 7.8, (("g", 1), ("cm", -3))),
        ("1 kg*m/s2*mm4/m2", 1.0, (("kg", 1), ("m", 1), ("s", -2), ("mm", 4), ("m", -2))),
        ("1 m_3/cm23", 1.0, (("m_3", 1), ("cm23", -1))),
        ("5%", 5.0, (("%", 1),)),
        (" 2 ", 2.0, ()),
    ],
)
def test_a_quantity_is_a_number_and_a_product_of_units(text, number, units):
    assert quantity(text) == (number, units)


@pytest.mark.parametrize(
    "text",
    [
        "", "Pa", "2 3 GPa", "0.5.5", "1 Pa(", "1 (Pa)", "1 Pa*9**9**9", "1 Pa**9**9", "1 Pa**99",
        "1 Pa^2.5", "2**9 Pa", "2*3 Pa", "2*Pa", "1 Pa Pa", "1 Pa/", "1 Pa//Pa", "1 1/1/m", "1 Pa**",
        "1 [length]", "1 Pa;Pa", "1 Pa.real", "1 Pa^⁻", "1 " + "m*" * LONGEST + "m", "9" * (LONGEST + 1),
    ],
)  # fmt: skip
def test_what_is_no_quantity_is_refused_and_not_evaluated(text):
    with pytest.raises(ValueError):
        quantity(text)
    with pytest.raises(ValueError, match=r"found .*, expected a number in Pa"):
        to_si(text, "Pa")


@pytest.mark.parametrize(
    "text, unit, wanted",
    [
        ("5 %", "", 0.05), ("5 percent", "", 0.05), ("2 mm/m", "", 0.002), ("3 inch/ft", "", 0.25),
        ("3 inch", "m", 0.0762),
        ("2 psi", "Pa", 13789.514586336), ("1 lb/inch^3", "kg/m^3", 27679.904710203),
        ("1 Å", "m", 1e-10), ("180 deg", "rad", pi), ("3 kg/m³", "kg/m^3", 3.0),
    ],
)  # fmt: skip
def test_units_are_worth(text, unit, wanted):
    assert to_si(text, unit) == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize(
    "text, unit, found",
    [
        ("30 deg", "", "in radian"), ("3 count", "", "in count"), ("2 bit", "", "in bit"),
        ("2 byte/m", "1/m", "1 / "), ("1 mm", "Pa", "(a length)"), ("1 lb", "", "mass"),
        ("1 GPz", "Pa", "unknown unit 'GPz'"),
        ("7 %", "m/s", "with %, which dimensionless numbers have"), ("1 degC*m", "K*m", "no zero"),
        ("1 None", "Pa", "unknown"), ("3", "Pa", "without a unit"),
        ("1 " + "a" * 190, "m", r"unknown unit 'a+\.\.\.a+'"),
    ],
)  # fmt: skip
def test_what_measures_something_else_is_refused(text, unit, found):
    with pytest.raises(ValueError, match=found):
        to_si(text, unit)


@pytest.mark.parametrize(
    "text", ["1e999 m", "nan mm", "inf m", "1 km^9/m^9*" + "km^9/m^9*" * 13 + "km", "1 Ym^9/m^9*Ym^9/m^8"]
)
def test_numbers_are_finite(text):
    with pytest.raises(ValueError, match="that is finite"):
        to_si(text, "m")


def in_unit(text, unit):
    return in_units(*quantity(text), units_of(unit))


def products(count):
    """Random numbers with products of metric units."""
    choose, names = (
        random.Random(5),
        [name for name in _UNITS if name not in ("μm", "μs", "%", "percent")],
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
        ("3 μm", "m", 3e-6), ("7 μs", "s", 7e-6), ("7.86 g/cm^3", "kg/m^3", 7860.0),
    ):  # fmt: skip
        assert in_unit(text, unit) == wanted
