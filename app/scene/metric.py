"""Metric units that most scenes use; to read all that pint knows takes longer than a friction loop."""

import re

#: Power of ten and dimension (length, mass, time) of a unit by its name.
_UNITS = {
    "m": (0, (1, 0, 0)), "km": (3, (1, 0, 0)), "mm": (-3, (1, 0, 0)),
    "µm": (-6, (1, 0, 0)), "μm": (-6, (1, 0, 0)), "um": (-6, (1, 0, 0)), "nm": (-9, (1, 0, 0)),
    "kg": (0, (0, 1, 0)), "g": (-3, (0, 1, 0)), "s": (0, (0, 0, 1)), "ms": (-3, (0, 0, 1)),
    "N": (0, (1, 1, -2)), "mN": (-3, (1, 1, -2)), "kN": (3, (1, 1, -2)), "MN": (6, (1, 1, -2)),
    "Pa": (0, (-1, 1, -2)), "kPa": (3, (-1, 1, -2)), "MPa": (6, (-1, 1, -2)), "GPa": (9, (-1, 1, -2)),
}  # fmt: skip

_QUANTITY = re.compile(
    r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(?:1\s*(?=/))?(.*?)\s*", re.DOTALL
)
_FACTOR = re.compile(r"\s*([*/]?)\s*([^\W\d_]+)(?:\s*(?:\*\*|\^)\s*(-?\d))?")


def in_unit(text: str, unit: str) -> float | None:
    """A number with a product of metric units as a number in ``unit``; None for anything else.

    Factors are powers of ten and are divided by where they are below one, so that "0.1 mm" is the float
    that 1e-4 is.
    """
    found = _QUANTITY.fullmatch(text)
    if not found:
        return None
    given, wanted = _product(found[2]), _product(unit)
    if given is None or wanted is None or given[1] != wanted[1]:
        return None
    power = given[0] - wanted[0]
    number = float(found[1])
    return number * 10.0**power if power >= 0 else number / 10.0**-power


def _product(text: str) -> tuple[int, tuple[int, ...]] | None:
    """Power of ten and dimension of a product of units; None where one is not metric."""
    power, at = 0, 0
    dimension: tuple[int, ...] = (0, 0, 0)
    text = re.sub(r"^\s*1\s*(?=/)", "", text)
    while at < len(text):
        factor = _FACTOR.match(text, at)
        if not factor or factor[2] not in _UNITS:
            return None
        if bool(at) != bool(factor[1]) and factor[1] != "/":  # only what comes first needs no sign
            return None
        ten, kind = _UNITS[factor[2]]
        exponent = int(factor[3] or 1) * (-1 if factor[1] == "/" else 1)
        power += ten * exponent
        dimension = tuple(a + b * exponent for a, b in zip(dimension, kind))
        at = factor.end()
    return power, dimension
