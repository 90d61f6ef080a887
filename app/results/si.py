"""Quantities of archives in SI: stresses in Pa instead of over N/(2a), lengths in m instead of over a,
speeds in m/s."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import Quantity, swept
from galinx.postprocess.quantities.states import CENTRE, FRICTION, HALF_WIDTH, LOAD, SPEED, VELOCITY
from galinx.postprocess.quantities.stresses import INSIDE_X, INSIDE_Y, SURFACE_X
from galinx.postprocess.tables import LENGTHS, Scaled, Scaling, as_archived

from ..scene.scene import Scene

_OVER_HALF_WIDTH = {row.path for row in (SURFACE_X, INSIDE_X, INSIDE_Y, *LENGTHS)}
#: Ends of names of places along X: under contacts with free ends they count from the punch's axis.
_ALONG_X = ("X_over_a", "pressure_position")


def scaling(scene: Scene | None, data: Mapping[str, Any]) -> Scaling:
    """Scaling of quantities to the SI units of a scene, or as archived where none is given.

    Args:
        scene: of the archive; None for quantities as archived.
        data: datasets of the archive by path, with the contacts of states where these differ.
    """
    if scene is None:
        return as_archived
    return lambda row, name: in_si(row, name, scene, data)


def stress_of_states(data: Mapping[str, Any], scene: Scene) -> NDArray[np.float64]:
    """N/(2a) [Pa] of every state of an archive, (states, 1)."""
    load = data.get(LOAD.path, np.full(len(data[FRICTION.path]), scene.punch.load))
    ends = contacts_of_states(data)
    half_width = ends[0] if ends else data.get(swept.HALF_WIDTH.path, scene.body.half_width)
    return (load / (2.0 * half_width))[:, None]


def contacts_of_states(data: Mapping[str, Any]) -> tuple[NDArray, NDArray] | None:
    """Half-width and middle [m] of every state's contact, where they are archived."""
    for h, m in zip(HALF_WIDTH.values(), CENTRE.values()):
        if h.path in data and m.path in data:
            return data[h.path], data[m.path]
    return None


def drawn_in_si(data: Mapping[str, Any], scene: Scene) -> dict[str, Any]:
    """Attributes of :class:`galinx.app.pictures.choice.Choice` for figures in SI: ``unit``, and ``ends``
    where every state has its own."""
    ends = contacts_of_states(data)
    if not ends and len(scene.punch.loads) == 1 and not scene.variants:
        return {"unit": 1e-6 * scene.body.stress}
    return {
        "unit": 1e-6 * stress_of_states(data, scene)[:, 0],
        "ends": (1e3 * ends[0], 1e3 * ends[1]) if ends else None,
    }


def in_si(row: Quantity, name: str, scene: Scene, data: Mapping[str, Any]) -> Scaled | None:
    """A quantity in SI; dimensionless ones that are over no length, stress or speed stay.

    Args:
        row: in the table of quantities.
        name: its name as archived.
        scene: of the archive.
        data: datasets of the archive by path.

    Returns:
        The column's name, unit and factor; None for a quantity that equals another one in SI.
    """
    over = row.path in _OVER_HALF_WIDTH
    if over or row.unit == "N/(2a)":
        ends = contacts_of_states(data) or scene.body.shared_ends
        if ends is None:
            return as_archived(row, name)  # no contact is archived
        half_width, middle = data.get(swept.HALF_WIDTH.path, ends[0]), ends[1]
        if not over:
            return Scaled(name, "Pa", data.get(LOAD.path, scene.punch.load) / (2.0 * half_width))
        middle = middle if row.path.endswith(_ALONG_X) else 0.0
        return Scaled(name.removesuffix("_over_a"), "m", half_width, middle)
    if row is SPEED:
        return Scaled("speed", "m/s", data.get(swept.WAVE_SPEED.path, scene.solid.c_s))
    return None if row is VELOCITY else as_archived(row, name)
