"""Numbers with units: strings such as "193 GPa" become SI numbers through pint."""

import re
import sys
from functools import lru_cache
from math import isfinite
from typing import Any

#: A number, then a unit. pint alone would multiply what stands side by side: "0.5.5" is no 0.25.
_FORM = re.compile(
    r"\s*[-+]?(\d+\.?\d*|\.\d+|nan|inf)([eE][-+]?\d+)?\s*(1\s*/\s*)?([^\W\d]|%|$).*", re.DOTALL
)


#: What the units that most scenes use are made of, as pint defines them: all that it knows would take
#: longer to read than a friction loop to compute.
_COMMON = """
giga- = 1e9 = G-
mega- = 1e6 = M-
kilo- = 1e3 = k-
milli- = 1e-3 = m-
micro- = 1e-6 = µ- = μ-
meter = [length] = m
second = [time] = s
gram = [mass] = g
newton = kilogram * meter / second ** 2 = N
pascal = newton / meter ** 2 = Pa
"""
_COMMON_NAMES = frozenset(
    ("m", "mm", "µm", "μm", "km", "s", "ms", "kg", "g", "N", "mN", "kN", "MN", "Pa", "kPa", "MPa", "GPa")
)

#: Names of units in a text; an exponent's e belongs to its number.
_NAMES = re.compile(r"(?<![\w.])[^\W\d]\w*")


@lru_cache(maxsize=2)
def _registry(common: bool) -> Any:
    """pint's registry of all units, or of those that most scenes use."""
    if not common:
        return _pint().UnitRegistry()
    registry = _pint().UnitRegistry(None)
    registry.load_definitions(_COMMON.strip().splitlines())
    return registry


def _pint() -> Any:
    """pint, which only scenes with units pay for, without array libraries that it looks for.

    Those take longer to import than everything else that a friction loop needs.
    """
    modules: dict[str, Any] = sys.modules
    hidden = [name for name in ("pandas", "xarray", "dask") if name not in modules]
    modules.update(dict.fromkeys(hidden))  # None: Python takes the module for missing
    try:
        import pint
    finally:
        for name in hidden:
            del modules[name]
    return pint


def to_si(value: Any, unit: str) -> float:
    """A number in SI, or a string with a unit, as a number in ``unit``.

    Args:
        value: what the scene says.
        unit: the SI unit expected, "" for dimensionless.

    Raises:
        ValueError: not a number, not finite, an unknown unit or one of the wrong dimension.
    """
    wanted = f"a number in {unit} or a string with a unit" if unit else "a dimensionless number"
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise ValueError(f"found {value!r}, expected {wanted}")
    if isinstance(value, str):
        value = _parse(value, unit, wanted)
    try:
        value = float(value)
    except OverflowError:
        value = float("inf")
    if not isfinite(value):
        raise ValueError(f"found {value!r}, expected {wanted} that is finite")
    return value


def _parse(text: str, unit: str, wanted: str) -> float:
    if not _FORM.fullmatch(text):
        raise ValueError(f"found {text!r}, expected {wanted}")

    import tokenize

    pint = _pint()
    try:
        names = _NAMES.findall(text) + _NAMES.findall(unit)
        quantity = _registry(_COMMON_NAMES.issuperset(names)).Quantity(text)
        if not unit and not quantity.unitless and quantity.dimensionless:
            return float(quantity.to("").magnitude)
        return float(quantity.to(unit).magnitude)
    except pint.DimensionalityError as error:
        raise ValueError(
            f"found {text!r} of dimension {error.dim1 or error.units1}, expected {wanted}"
        ) from None
    except (pint.UndefinedUnitError, pint.DefinitionSyntaxError) as error:
        raise ValueError(f"found {text!r} ({error}), expected {wanted}") from None
    except (ValueError, TypeError, AttributeError, AssertionError, ArithmeticError,
            RecursionError, SyntaxError, KeyError, tokenize.TokenError):  # fmt: skip
        # pint evaluates the text and lets through whatever its tokeniser raises.
        raise ValueError(f"found {text!r}, expected {wanted}") from None
