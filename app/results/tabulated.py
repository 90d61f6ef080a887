"""Tables and curves of an archive as the scripts of a page read them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.apart import parameters
from galinx.postprocess.figures.typeset import plain
from galinx.postprocess.quantities import Quantity, of_states, stresses, table
from galinx.postprocess.quantities import strata as layers
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, METHODS, SIE, STATE, TEXT
from galinx.postprocess.scaling import Scaling, as_archived
from galinx.texts import counted

#: Most cells of the table, and numbers of the curves: a page stays below 5 MB.
_CELLS, _NUMBERS = 60_000, 250_000

#: Digits that are shown; errors have fewer.
_DIGITS, _OF_ERRORS = 6, 2


def states_table(data: dict[str, Any], scaling: Scaling = as_archived) -> dict[str, Any]:
    """Every state with all that has one value a state: what differs between states first.

    Args:
        data: datasets by path.
        scaling: how quantities are told.
    """
    apart = parameters(data)
    others = [
        row
        for path, row in table().items()
        if of_states(path)
        and path in data
        and row.over == (STATE,)
        and path not in apart
        and scaling(row, "")
    ]
    rows = [*apart.values(), *others]
    constant = [row for row in apart.values() if len(np.unique(data[row.path])) == 1]
    shown = [row for row in rows if row not in constant]
    count = len(data[rows[0].path])
    kept = min(count, _CELLS // (len(shown) + 1))
    columns = [{"head": "state", "name": "state", "csv": "state", "about": "number", "digits": None}]
    columns += [_column(row, scaling) for row in shown]
    cells = [
        list(range(kept)),
        *(_plain(_told(row, data[row.path][:kept], scaling), 12) for row in shown),
    ]
    same = ", ".join(f"{_head(row)} = {data[row.path][0]:g}" for row in constant if row.type != TEXT)
    note = f"{counted(count, 'state')}; click on a head to sort."
    note += f" The same in all: {same}." * bool(same)
    if kept < count:
        note += f" The first {kept} are here; the command csv writes all."
    heads = [{"head": column["head"], "about": column["about"]} for column in columns]
    return {"columns": heads, "note": note, "data": {"columns": columns, "rows": list(zip(*cells))}}


def curves(data: dict[str, Any], scaling: Scaling = as_archived) -> dict[str, Any] | None:
    """Stresses on the surface of states, by method and quantity; None where there are none.

    Args:
        data: datasets by path.
        scaling: how quantities are told.
    """
    known = {
        "σ_XX": stresses.IN_PLANE | layers.IN_PLANE, "σ_YY": stresses.PRESSURE | layers.PRESSURE
    }  # fmt: skip
    methods = [m for m in METHODS if all(rows[m].path in data for rows in known.values())]
    if not methods:
        return None
    X = data[stresses.SURFACE_X.path]
    order, apart = np.argsort(X, kind="stable"), parameters(data)
    count = len(data[next(iter(apart))])
    most = max(_NUMBERS // (len(X) * len(methods) * len(known)), 1)
    some = np.unique(np.linspace(0, count - 1, min(count, most)).astype(int))
    told = scaling(known["σ_XX"][methods[0]], "")
    in_units = told is not None and told.unit == "Pa"
    factors = 1e-6 * told.factor * np.ones(count) if told and in_units else np.ones(count)
    values = [
        [
            [_plain(factors[i] * data[rows[method].path][i][order], 5) for i in some.tolist()]
            for rows in known.values()
        ]
        for method in methods
    ]
    varied = [row for row in apart.values() if len(np.unique(data[row.path])) > 1]
    names = [
        ", ".join([str(i), *(_value(row, data[row.path][i]) for row in varied)]) for i in some.tolist()
    ]
    note = "In MPa." if in_units else "Over N/(2a)."
    note += f" {len(some)} of {count} states." * (len(some) < count)
    return {
        "note": note,
        "data": {
            "unit": "[MPa]" if in_units else "/ (N/2a)",
            "X": _plain(X[order], 9), "states": names, "quantities": list(known),
            "methods": [METHODS[method] for method in methods], "values": values,
        },
    }  # fmt: skip


def _told(row: Quantity, values: NDArray, scaling: Scaling) -> NDArray:
    told = scaling(row, "")
    return values if told is None else told.of(values, slice(len(values)))


def _column(row: Quantity, scaling: Scaling) -> dict[str, Any]:
    name = row.path.partition("/")[2].replace("/", "_")
    told = scaling(row, name) or as_archived(row, name)
    head = _head(row)
    if told.name != name:
        head = told.name if row.symbol else head.replace(" over a", "")
    unit = "" if told.unit in ("1", "none") else f" [{told.unit}]"
    error = "error" in row.path or "estimate" in row.path
    digits = None if row.type == TEXT else _OF_ERRORS if error else _DIGITS
    return {
        "head": head + unit,
        "name": told.name,
        "csv": told.name + unit,
        "about": row.about,
        "digits": digits,
    }


def _head(row: Quantity) -> str:
    """A column's head: the symbol, or the name with its method."""
    if row.symbol:
        return f"${row.symbol}$"
    method, _, name = row.path.partition("/")[2].rpartition("/")
    called = {"v0": "v_0", "alpha": "α", "beta": "β"}.get(
        name, name.replace("_", " ").replace("K I", "K_I")
    )
    return called + {CLOSED_FORM: ", exact", SIE: ", SIE", FEM: ", FE"}.get(method, "")


def _value(row: Quantity, value: Any) -> str:
    return str(value) if row.type == TEXT else plain(f"${row.symbol}$ = {value:.4g}")


def _plain(values: NDArray, digits: int) -> list[Any]:
    """Numbers with so many digits, None for NaN; texts stay."""
    if values.dtype.kind in "OSU":
        return [str(value) for value in values.tolist()]
    return [None if value != value else float(f"{value:.{digits}g}") for value in values.tolist()]
