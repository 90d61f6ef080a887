"""Table of archived quantities: archives, checks, comparisons, plans and pages follow from it."""

from collections.abc import Mapping
from difflib import get_close_matches
from functools import lru_cache
from typing import Any

import numpy as np

# Each module adds its own quantities; tables have them in this order.
# isort: off
from . import runs, states  # noqa: F401
from . import stresses, validity, yielding  # noqa: F401
from . import over_time, layers, swept  # noqa: F401

# isort: on
from galinx.solvers.friction import LAWS
from galinx.solvers.parameters import parameters
from galinx.solvers.profiles import PROFILES
from galinx.solvers.solids import SOLIDS

from .quantity import (
    ALONG,
    CLOSED_FORM,
    FEM,
    INSIDE,
    LOCAL,
    POINT,
    QUANTITIES,
    SIE,
    STATE,
    TEXT,
    WORDS,
    Quantity,
)

__all__ = ["QUANTITIES", "WORDS", "Quantity", "column", "declared", "preferred", "table"]


def column(name: str) -> str:
    """Path of a column of the states: a parameter of the law, or what else tells states apart."""
    return f"states/{name}"


def table() -> dict[str, Quantity]:
    """Every quantity by its path, parameters of registered laws, solids and profiles among them."""
    kinds = (tuple(registry.values()) for registry in (LAWS, SOLIDS, PROFILES))
    return _of_parameters(*kinds) | QUANTITIES


@lru_cache(maxsize=1)
def _of_parameters(
    laws: tuple[type, ...], solids: tuple[type, ...], profiles: tuple[type, ...]
) -> dict[str, Quantity]:
    """Columns of states by path; made anew only where a kind is registered: archives ask per dataset."""
    of_laws: dict[str, Quantity] = {}
    for key, parameter in (pair for law in laws for pair in parameters(law).items()):
        if parameter.single:
            of_key = of_laws.get(column(key))
            of_laws[column(key)] = Quantity(
                column(key), "none" if parameter.options else parameter.unit or "1", parameter.about,
                (STATE,), symbol=parameter.symbol or key,
                range=of_key.range | parameter.range if of_key else parameter.range,
            )  # fmt: skip
    return of_laws | swept.columns(solids, profiles)


def declared(path: str) -> Quantity:
    """Quantity of a path.

    Raises:
        KeyError: there is none; the message names the nearest.
    """
    rows = table()
    if path not in rows:
        close = get_close_matches(path, rows, 1)
        hint = f"; did you mean {close[0]}?" if close else ""
        raise KeyError(f"{path} is in no row of the table of quantities{hint}")
    return rows[path]


def preferred(data: Mapping[str, Any], rows: Mapping[str, Quantity]) -> Quantity | None:
    """Quantity by the first of finite elements, closed form and integral equation that an archive has;
    None where it has none. A method that solved no state is the last of them."""
    there = [rows[method] for method in (FEM, CLOSED_FORM, SIE, "") if method in rows]
    there = [row for row in there if row.path in data]
    if len(data.get(runs.FAILURES.path, ())):
        there.sort(key=lambda row: bool(np.isnan(data[row.path]).all()))
    return next(iter(there), None)


def of_any_method(data: Mapping[str, Any], rows: Mapping[str, Quantity], row: Quantity) -> Any:
    """Values of a quantity by the preferred method, where it has no solution by another one that has.

    Args:
        data: datasets by path.
        rows: the quantity by method.
        row: that of the preferred one.
    """
    values = data[row.path]
    if not len(data.get(runs.FAILURES.path, ())) or row.type == TEXT:
        return values
    for other in (data[each.path] for each in rows.values() if each.path in data):
        values = np.where(np.isnan(values), other, values)
    return values


def solved_states(data: Mapping[str, Any]) -> Any:
    """True for states that a method solved, (states,); a slice of all where nothing failed."""
    if not len(data.get(runs.FAILURES.path, ())):
        return slice(None)
    rows = (row for path, row in table().items() if row.of and row.over == (STATE,) and path in data)
    numbers = [data[row.path] for row in rows if row.method not in ("", LOCAL) and row.type != TEXT]
    return np.any([np.isfinite(values) for values in numbers], axis=0) if numbers else slice(None)


def of_states(path: str) -> bool:
    """True where a dataset holds values of states, or the positions of some."""
    return path.split("/")[0] in ("states", "surface", "interior", "interfaces", "layers")


def large(path: str) -> bool:
    """True where a dataset holds a value at every point of every state."""
    row = table().get(path)
    return row is not None and STATE in row.over and bool({POINT, INSIDE, ALONG} & set(row.over))
