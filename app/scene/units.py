"""Numbers with units: strings such as "193 GPa" become SI numbers through pint."""

import re
import sys
from functools import lru_cache
from math import isfinite
from typing import Any

from galinx.app.scene.metric import in_unit

#: A number, then a unit. pint alone would multiply what stands side by side: "0.5.5" is no 0.25.
_FORM = re.compile(
    r"\s*[-+]?(\d+\.?\d*|\.\d+|nan|inf)([eE][-+]?\d+)?\s*(1\s*/\s*)?([^\W\d]|%|$).*", re.DOTALL
)


@lru_cache(maxsize=1)
def _registry() -> Any:
    return _pint().UnitRegistry()


def _pint() -> Any:
    """pint, which only scenes with rarer units pay for, without array libraries that it looks for.

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
    metric = in_unit(text, unit)
    if metric is not None:
        return metric

    import tokenize

    pint = _pint()
    try:
        quantity = _registry().Quantity(text)
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
