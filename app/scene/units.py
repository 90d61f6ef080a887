"""Numbers with units: texts such as "193 GPa" become SI numbers, rarer units by pint's table.

A quantity in a scene is a number and units with ``*``, ``/`` and ``^`` between them. It is parsed, never
evaluated; any other text is refused. The metric units that most scenes use have a table here, because
loading pint takes longer than a friction loop.
"""

import re
import sys
from contextlib import suppress
from functools import lru_cache
from math import isfinite
from typing import Any

from ..errors import excerpt, meant

#: Most characters of a quantity.
LONGEST = 200

_SUPERSCRIPTS = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"
_PLAIN = str.maketrans(_SUPERSCRIPTS, "-0123456789")

_NUMBER = re.compile(r"\s*([-+]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?|(?:nan|inf)\b))")
#: Number with a decimal comma.
_COMMA = re.compile(r"\s*[-+]?[0-9]+,[0-9]+")
#: Beginning of a product of units that starts with a divisor, as ``1/m``.
_ONE = re.compile(r"\s*1\s*(?=/)")
_FACTOR = re.compile(
    rf"\s*([*/]?)\s*(%|[^\W\d{_SUPERSCRIPTS}][^\W{_SUPERSCRIPTS}]*?)"
    rf"(?:\s*(?:\*\*|\^)\s*([-+]?[0-9])(?![.\w])|(⁻?[{_SUPERSCRIPTS[1:]}]|(?<![\d_])[234](?!\w))|(?!\w))"
)

#: Names of units with their exponents, in the order in which they are written.
Units = tuple[tuple[str, int], ...]


class _NoQuantity(ValueError):
    """A text is no quantity."""


def quantity(text: str) -> tuple[float, Units]:
    """Number and units of a quantity, as ``25000 1/m`` or ``7.86 g/mm^3``; none where dimensionless.

    Raises:
        ValueError: the text is no quantity.
    """
    head = _NUMBER.match(text) if len(text) <= LONGEST else None
    if not head:
        raise _NoQuantity("no number")
    return float(head[1]), units(text[head.end() :])


def units(text: str) -> Units:
    """Read a product of powers of units; exponents have one digit.

    Raises:
        ValueError: the text is no quantity.
    """
    factors: list[tuple[str, int]] = []
    numerator = _ONE.match(text)
    at, end = numerator.end() if numerator else 0, len(text.rstrip())
    while at < end:
        factor = _FACTOR.match(text, at)
        # Only what comes first needs no sign.
        if not factor or (bool(factors) != bool(factor[1]) and factor[1] != "/"):
            raise _NoQuantity("no product of units")
        sign = -1 if factor[1] == "/" else 1
        factors.append((factor[2], sign * int((factor[3] or factor[4] or "1").translate(_PLAIN))))
        at = factor.end()
    return tuple(factors)


#: Power of ten and dimension (length, mass, time) of a unit by its name.
_UNITS = {
    "m": (0, (1, 0, 0)), "km": (3, (1, 0, 0)), "cm": (-2, (1, 0, 0)), "mm": (-3, (1, 0, 0)),
    "µm": (-6, (1, 0, 0)), "μm": (-6, (1, 0, 0)), "um": (-6, (1, 0, 0)), "nm": (-9, (1, 0, 0)),
    "kg": (0, (0, 1, 0)), "g": (-3, (0, 1, 0)), "s": (0, (0, 0, 1)), "ms": (-3, (0, 0, 1)),
    "µs": (-6, (0, 0, 1)), "μs": (-6, (0, 0, 1)), "us": (-6, (0, 0, 1)),
    "N": (0, (1, 1, -2)), "mN": (-3, (1, 1, -2)), "kN": (3, (1, 1, -2)), "MN": (6, (1, 1, -2)),
    "Pa": (0, (-1, 1, -2)), "kPa": (3, (-1, 1, -2)), "MPa": (6, (-1, 1, -2)), "GPa": (9, (-1, 1, -2)),
    "%": (-2, (0, 0, 0)), "percent": (-2, (0, 0, 0)),  # not every pint has them
}  # fmt: skip


def in_units(number: float, given: Units, target: Units) -> float | None:
    """A number of given units in others; None where a unit is not in the table, or dimensions differ.

    Factors are powers of ten and are divided by where they are below one, so that "0.1 mm" is the float
    that 1e-4 is.

    Raises:
        OverflowError: the factor is no floating-point number.
    """
    power, dimension = 0, [0, 0, 0]
    for units, sign in ((given, 1), (target, -1)):
        for name, exponent in units:
            if name not in _UNITS:
                return None
            ten, kind = _UNITS[name]
            power += sign * ten * exponent
            dimension = [a + sign * exponent * b for a, b in zip(dimension, kind)]
    if any(dimension):
        return None
    return _shifted(number, power)


def _shifted(number: float, power: int) -> float:
    """A number times a power of ten; divided by one below one, see :func:`in_units`."""
    return number * 10.0**power if power >= 0 else number / 10.0**-power


def in_si(value: Any) -> Any:
    """Numbers in SI of a value, or of a list's or a table's, as TOML gives them; all else unchanged."""
    if isinstance(value, dict):
        return {key: in_si(of) for key, of in value.items()}
    if isinstance(value, list):
        return [in_si(of) for of in value]
    if isinstance(value, str):
        with suppress(ValueError, OverflowError, KeyError):
            number, given = quantity(value)
            return _shifted(number, sum(_UNITS[name][0] * exponent for name, exponent in given))
    return value


@lru_cache(maxsize=1)
def _registry() -> Any:
    """Units of pint, which only scenes with rarer units pay for.

    The array libraries that pint looks for take longer to import than everything else that a friction
    loop needs, and are hidden from it.
    """
    modules: dict[str, Any] = sys.modules
    hidden = [name for name in ("pandas", "xarray", "dask") if name not in modules]
    modules.update(dict.fromkeys(hidden))  # None: Python takes the module for missing
    try:
        import pint
    finally:
        for name in hidden:
            del modules[name]
    return pint.UnitRegistry()


#: Measures that people give for one another, with their units.
_MEASURES = {
    "a force": "N", "a force per depth": "N/m", "a pressure": "Pa", "a length": "m", "a time": "s",
    "a speed": "m/s", "a mass": "kg", "a density": "kg/m^3",
}  # fmt: skip


def to_si(value: Any, unit: str, shown: str = "") -> float:
    """A number in SI, or a string with a unit, as a number in ``unit``.

    Args:
        value: a number or a text, as TOML gives it.
        unit: the SI unit expected, "" for dimensionless.
        shown: what a message shows in place of the value, as the unit of a column without its 1.

    Raises:
        ValueError: not a number, not finite, an unknown unit or one of the wrong dimension.
    """
    expected = f"a number in {unit} or a string with a unit" if unit else "a dimensionless number"

    def fault(why: str = "", form: str = "") -> ValueError:
        return ValueError(f"found {excerpt(shown or value)}{why}, expected {expected}{form}")

    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise fault()
    try:
        if isinstance(value, str):
            (number, given), target = quantity(value), units(unit)
            metric = in_units(number, given, target)
            if metric is None and (measure := _measure(given)):
                if unit == "N/m":
                    expected = "a force per depth, such as 100 N/mm"
                raise ValueError(f"({measure})")
            number = _by_pint(number, given, target) if metric is None else metric
        else:
            number = float(value)
    except OverflowError:
        number = float("inf")
    except _NoQuantity:
        form = ": a number, then units with * / ^ between them" if unit else ""
        comma = "; decimals have a point, as in 0.37" if _COMMA.match(str(value)) else ""
        raise fault(form=form + comma) from None
    except ValueError as error:
        raise fault(f" {error}") from None
    if not isfinite(number):
        raise fault(form=" that is finite")
    return number


def _measure(given: Units) -> str:
    """Name of the measure that has these units, "" where it is none of ``_MEASURES``."""
    own = (name for name, of in _MEASURES.items() if in_units(1.0, given, units(of)) is not None)
    return next(own, "")


def _by_pint(number: float, given: Units, target: Units) -> float:
    """A number of given units in others, by pint's table, without pint's parser, which evaluates.

    Raises:
        ValueError: a unit is unknown, or dimensions differ; angles, counts and bits are no numbers.
    """
    table, products = _registry(), []
    import pint  # found by _registry

    for units in (given, target):
        exponents: dict[str, int] = {}
        for name, exponent in units:
            try:
                of_pint = table.get_name(name)
            except pint.UndefinedUnitError:
                if _UNITS.get(name, (0, ()))[1] == (0, 0, 0):
                    raise ValueError(f"with {name}, which dimensionless numbers have") from None
                hint = meant(name, _UNITS).removeprefix("; ")
                why = f"with the unknown unit {excerpt(name)}" + f" ({hint})" * bool(hint)
                raise ValueError(why) from None
            exponents[of_pint] = exponents.get(of_pint, 0) + exponent
        products.append(pint.util.UnitsContainer(exponents))
    source, goal = products
    try:
        if table.get_root_units(source)[1] == table.get_root_units(goal)[1]:
            return float(table.Quantity(number, source).to(goal).magnitude)
    except pint.errors.PintError:
        raise ValueError("with units that have no zero and cannot be multiplied") from None
    dimension = table.get_dimensionality(source)
    counted = f"in {table.get_root_units(source)[1]}" if given else "without a unit"
    raise ValueError(f"of dimension {dimension}" if dimension else counted)
