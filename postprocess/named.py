"""Archives as named arrays."""

from typing import Any

import xarray

from galinx.postprocess.quantities import FIELDS

#: What tells states apart: coordinates, in the order of an archive.
PARAMETERS = ("c", "mu_c", "sigma0_over_load", "delta", "motion", "X_over_L")

_COORDINATES = {
    "surface/X_over_a": ("X_over_a", ("X_over_a",)),
    "interior/X_over_a": ("inside_X_over_a", ("point",)),
    "interior/Y_over_a": ("inside_Y_over_a", ("point",)),
}
_SECOND = {"states": (), "surface": ("X_over_a",), "interior": ("point",)}


def dataset(data: dict[str, Any], attributes: dict[str, Any]) -> xarray.Dataset:
    """Arrays over ``state``, and ``X_over_a`` or ``point``; paths become names, without ``states``.

    Args:
        data: datasets by path.
        attributes: of the archive's root.
    """
    variables, coordinates = {}, {}
    for path, values in data.items():
        section, *rest = path.split("/")
        if section not in _SECOND or path == "interior/map":
            continue
        about = dict(zip(("units", "long_name"), FIELDS[path]))
        if path in _COORDINATES:
            name, dims = _COORDINATES[path]
            coordinates[name] = (dims, values, about)
        elif section == "states" and rest[-1] in PARAMETERS and len(rest) == 1:
            coordinates[rest[0]] = (("state",), values, about)
        else:
            name = "_".join(rest if section == "states" else (section, *rest))
            variables[name] = (("state", *_SECOND[section]), values, about)
    kept = {name: attributes[name] for name in ("title", "version", "verdict")}
    return xarray.Dataset(variables, coordinates, kept)


def over_parameters(states: xarray.Dataset) -> xarray.Dataset:
    """The arrays over ``c``, ``mu_c``, ``sigma0_over_load``, ``delta``, ``motion`` and ``X_over_L``."""
    return states.set_index(state=PARAMETERS).unstack("state")
