"""Metric units that most scenes use; to read all that pint knows takes longer than a friction loop."""

from galinx.app.scene.quantity import Quantity, Units

#: Power of ten and dimension (length, mass, time) of a unit by its name.
_UNITS = {
    "m": (0, (1, 0, 0)), "km": (3, (1, 0, 0)), "mm": (-3, (1, 0, 0)),
    "µm": (-6, (1, 0, 0)), "μm": (-6, (1, 0, 0)), "um": (-6, (1, 0, 0)), "nm": (-9, (1, 0, 0)),
    "kg": (0, (0, 1, 0)), "g": (-3, (0, 1, 0)), "s": (0, (0, 0, 1)), "ms": (-3, (0, 0, 1)),
    "N": (0, (1, 1, -2)), "mN": (-3, (1, 1, -2)), "kN": (3, (1, 1, -2)), "MN": (6, (1, 1, -2)),
    "Pa": (0, (-1, 1, -2)), "kPa": (3, (-1, 1, -2)), "MPa": (6, (-1, 1, -2)), "GPa": (9, (-1, 1, -2)),
    "%": (-2, (0, 0, 0)),  # not every pint has it
}  # fmt: skip


def in_units(given: Quantity, wanted: Units) -> float | None:
    """A quantity's number in other units; None where a unit is not in the table, or dimensions differ.

    Factors are powers of ten and are divided by where they are below one, so that "0.1 mm" is the float
    that 1e-4 is.

    Raises:
        OverflowError: the factor is no floating-point number.
    """
    one, other = _product(given.units), _product(wanted)
    if one is None or other is None or one[1] != other[1]:
        return None
    power = one[0] - other[0]
    return given.number * 10.0**power if power >= 0 else given.number / 10.0**-power


def _product(units: Units) -> tuple[int, tuple[int, ...]] | None:
    """Power of ten and dimension of a product of units; None where one is not in the table."""
    power = 0
    dimension: tuple[int, ...] = (0, 0, 0)
    for name, exponent in units:
        if name not in _UNITS:
            return None
        ten, kind = _UNITS[name]
        power += ten * exponent
        dimension = tuple(a + b * exponent for a, b in zip(dimension, kind))
    return power, dimension
