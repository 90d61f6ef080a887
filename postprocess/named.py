"""Archives as xarray datasets: named arrays over states, positions and parameters."""

from typing import Any

import xarray

from .quantities import Quantity, of_states, table
from .quantities.quantity import ALONG, INNER, INSIDE, INTERFACE, LAYER, POINT, STATE
from .quantities.stresses import INSIDE_X, INSIDE_Y, SURFACE_X
from .tables import parameters

#: Names of dimensions, and of the positions along them.
_DIMENSIONS = {
    STATE: "state", POINT: "X_over_a", INSIDE: "point", INNER: "inner",
    INTERFACE: "interface", ALONG: "along", LAYER: "layer",
}  # fmt: skip
_POSITIONS = {
    SURFACE_X.path: "X_over_a",
    INSIDE_X.path: "inside_X_over_a",
    INSIDE_Y.path: "inside_Y_over_a",
}


def dataset(data: dict[str, Any], attributes: dict[str, Any]) -> xarray.Dataset:
    """Quantities of an archive's states as an xarray dataset over ``state`` and positions.

    Variables are named like the paths of an archive, with ``_`` for ``/`` and without ``states``. The
    parameters that differ between states are coordinates.

    Args:
        data: datasets of the archive by path.
        attributes: attributes of the archive's root.
    """
    rows, apart = table(), parameters(data)
    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = dict.fromkeys(path.rpartition("/")[2] for path in apart)
    for path, values in data.items():
        row = rows.get(path)
        if row is None or not of_states(path) or not _has_names(row):
            continue
        dims = tuple(_DIMENSIONS[dimension] for dimension in row.over)
        about = {"units": row.unit, "long_name": row.about}
        section, *rest = path.split("/")
        if path in _POSITIONS:
            coordinates[_POSITIONS[path]] = (dims, values, about)
        elif path in apart:
            coordinates[rest[0]] = (dims, values, about)
        else:
            name = "_".join(rest if section == "states" else (section, *rest))
            variables[name] = (dims, values, about)
    kept = {name: attributes[name] for name in ("title", "version", "verdict")}
    return xarray.Dataset(variables, coordinates, kept)


def _has_names(row: Quantity) -> bool:
    """True where all dimensions of a quantity have names."""
    return bool(row.over) and set(row.over) <= _DIMENSIONS.keys()


def over_parameters(states: xarray.Dataset) -> xarray.Dataset:
    """Dataset whose ``state`` is unfolded into ``c``, the law's parameters, ``motion`` and ``X_over_L``.

    Args:
        states: dataset over ``state``, see :func:`dataset`.
    """
    apart = [name for name in states.coords if states[name].dims == ("state",)]
    return states.set_index(state=apart).unstack("state")
