"""Columns of sweeps over numbers that fix the problem: the swept numbers, and what changes with them."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact import AT_INTERFACES
from galinx.solvers.parameters import Parameter, Range, parameters

from . import layers
from .quantity import INTERFACE, QUANTITIES, STATE, Quantity

#: Most layers of a scene.
MOST_LAYERS = 10

_POSITIVE = Range(above=0.0)

#: What an archive has once, and a sweep for every state if its variants differ in it.
HALF_WIDTH = Quantity(
    "states/half_width", "m", "half-width of the contact, where it is given and states differ in it",
    (STATE,), range=_POSITIVE,
)  # fmt: skip
WAVE_SPEED = Quantity(
    "states/c_s", "m/s", "wave speed to which c refers, where states differ in it", (STATE,),
    range=_POSITIVE,
)  # fmt: skip
INTERFACE_DEPTHS = Quantity(
    "interfaces/depth_of_states", "m", "depths of the interfaces, where states differ in them",
    (STATE, INTERFACE), asked_by=AT_INTERFACES, range=_POSITIVE,
)  # fmt: skip

QUANTITIES.add_all(globals())


def interface_depths(data: Mapping[str, Any]) -> tuple[str, NDArray[np.float64]]:
    """Depths of interfaces of every state, (states or 1, interfaces), and their unit: "m", or "1" over a.

    Args:
        data: datasets of an archive with stresses at interfaces, by path.
    """
    if INTERFACE_DEPTHS.path in data:
        return "m", data[INTERFACE_DEPTHS.path]
    unit = next(unit for unit, row in layers.DEPTHS.items() if row.path in data)
    return unit, data[layers.DEPTHS[unit].path][None]


def columns(solids: tuple[type, ...], profiles: tuple[type, ...]) -> dict[str, Quantity]:
    """Columns by path of all numbers of these kinds that scenes sweep beside speeds, loads and laws.

    Their names are the keys of scenes, as ``states/solid.E``, and have a dot, unlike all others.
    """
    rows: dict[str, Quantity] = {}
    for key, symbol, parameter in _keys(solids, profiles):
        path = f"states/{key}"
        # Beyond a comma it is said of one kind alone, of several that have the key.
        about = f"{parameter.about.partition(',')[0]}, {key} of the scene"
        rows[path] = Quantity(path, parameter.unit or "1", about, (STATE,), symbol=symbol)
    return rows


def _keys(solids: tuple[type, ...], profiles: tuple[type, ...]) -> Iterator[tuple[str, str, Parameter]]:
    """Key in a scene, symbol and description of each number."""
    strength = Parameter("yield_strength", "uniaxial yield strength", "Pa", r"\sigma_Y")
    thickness = Parameter("thickness", "thickness", "m", "h")
    exponent = Parameter("exponent", "exponent of the grading", "", "k")
    length = Parameter("pre_sliding", "pre-sliding displacement L", "m", "L")
    constants = {p.key: p for kind in solids for p in parameters(kind).values() if _single(p)}
    constants["yield_strength"] = strength
    speed = Parameter("speed", "speed of the punch's solid over the contact", "m/s", "V")
    for key, p in (constants | {"speed": speed}).items():
        yield f"punch.solid.{key}", f"{p.symbol or key}'", p
    for key, p in constants.items():
        yield f"solid.{key}", p.symbol or key, p
    for i in range(MOST_LAYERS):
        for key, p in (constants | {"thickness": thickness, "exponent": exponent}).items():
            symbol = f"h_{i + 1}" if p is thickness else f"{p.symbol or key}^{{({i + 1})}}"
            yield f"layer[{i}].{key}", symbol, p
    for p in (p for kind in profiles for p in parameters(kind).values() if _single(p)):
        yield f"punch.{p.key}", p.symbol or p.key, p
    yield "friction.pre_sliding", "L", length


def _single(parameter: Parameter) -> bool:
    return parameter.single and not parameter.options
