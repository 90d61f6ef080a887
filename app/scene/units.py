"""Numbers with units: texts such as "193 GPa" become SI numbers, rarer units by pint's table."""

import sys
from functools import lru_cache
from math import isfinite
from typing import Any

from galinx.app.scene.excerpt import excerpt
from galinx.app.scene.metric import in_units
from galinx.app.scene.quantity import Quantity, Units, quantity, units


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
        raise ValueError(f"found {excerpt(value)}, expected {wanted}")
    try:
        number = _parsed(value, unit, wanted) if isinstance(value, str) else float(value)
    except OverflowError:
        number = float("inf")
    if not isfinite(number):
        raise ValueError(f"found {excerpt(value)}, expected {wanted} that is finite")
    return number


def _parsed(text: str, unit: str, wanted: str) -> float:
    try:
        given = quantity(text)
    except ValueError:
        form = ": a number, then units with * / ^ between them" if unit else ""
        raise ValueError(f"found {excerpt(text)}, expected {wanted}{form}") from None
    metric = in_units(given, units(unit))
    try:
        return _by_pint(given, units(unit)) if metric is None else metric
    except ValueError as error:
        raise ValueError(f"found {excerpt(text)} {error}, expected {wanted}") from None


def _by_pint(given: Quantity, wanted: Units) -> float:
    """A quantity in other units, by pint's table; of pint's parser, which evaluates, nothing is used.

    Raises:
        ValueError: a unit is unknown, or what they measure differs; angles, counts and bits are no
            numbers.
    """
    table, one, other = _registry(), _container(given.units), _container(wanted)
    try:
        if table.get_root_units(one)[1] == table.get_root_units(other)[1]:
            return float(table.Quantity(given.number, one).to(other).magnitude)
    except _pint().errors.PintError:
        raise ValueError("with units that have no zero and cannot be multiplied") from None
    dimension = table.get_dimensionality(one)
    counted = f"in {table.get_root_units(one)[1]}" if given.units else "without a unit"
    raise ValueError(f"of dimension {dimension}" if dimension else counted)


def _container(product: Units) -> Any:
    """pint's own form of a product of units.

    Raises:
        ValueError: one is unknown.
    """
    exponents: dict[str, int] = {}
    for name, exponent in product:
        try:
            known = _registry().get_name(name)
        except _pint().UndefinedUnitError:
            raise ValueError(f"with the unknown unit {excerpt(name)}") from None
        exponents[known] = exponents.get(known, 0) + exponent
    return _pint().util.UnitsContainer(exponents)
