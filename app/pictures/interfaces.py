"""Stresses along the interfaces of layers of some of an archive's states."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.pictures.choice import Choice, one_of
from galinx.app.pictures.drawing import Drawing, by_method
from galinx.app.pictures.told import Told, few, not_shown, spread
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.interfaces import Interface, Row, interfaces_figure
from galinx.postprocess.figures.style import PAGE, looks
from galinx.postprocess.figures.surface import Curve
from galinx.postprocess.figures.typeset import number
from galinx.postprocess.quantities.quantity import ALONG, INTERFACE, METHODS, STATE
from galinx.postprocess.quantities.strata import ALONG_X, INTERFACE_DEPTH, INTERFACE_DEPTH_IN_M

#: Curves that can be told apart in a panel, and the least width of a column [in].
_CURVES, _LEAST = 4, 2.2

#: What axes call stresses, and which of them share one: both sides of an interface.
_SHOWN = {
    ("sigma_YY",): ("normal traction", r"\sigma_{YY}"),
    ("sigma_XY",): ("shear traction", r"\sigma_{XY}"),
    ("sigma_XX_above", "sigma_XX_below"): ("in-plane stress", r"\sigma_{XX}"),
}


def quantities(data: dict[str, Any], method: str = "") -> list[str]:
    """Names of what an archive has along interfaces."""
    return list(by_method(data, (STATE, INTERFACE, ALONG), method))


def has(data: dict[str, Any], choice: Choice) -> bool:
    """Does an archive hold what is wanted?"""
    known = quantities(data, choice.method)
    return bool(known) and set(choice.quantities) <= set(known)


def interfaces(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """A column for each interface, or for some of many."""
    told, width = Told(data, scene), choice.size.width if choice.size else PAGE
    some = np.array(choice.states) if choice.states else told.all
    names = told.varied(some)
    if not choice.states:
        names, some = few(told, names, some, _CURVES)
    some = told.ordered(some)
    shown = looks(len(some), len(names) == 1 and told.numeric(names[0]))
    curves = [Curve(i, told.label(i, names), look) for i, look in zip(some.tolist(), shown)]
    depths, reach, unit = _depths(data, scene)
    columns = [
        Interface(i, float(reach[i]), f"$Y = {number(-depths[i])}\\,{unit}$")
        for i in spread(range(len(depths)), max(1, int(width / _LEAST)))
    ]
    figure = interfaces_figure(
        data[ALONG_X.path],
        _rows(data, choice),
        columns,
        curves,
        choice.size,
        choice.frames(some.tolist()),
    )
    caption = (
        "Stresses along the interfaces, under the punch (grey) and beside it: tractions, which both "
        "sides share, and in-plane stress, which jumps."
    )
    if len(columns) < len(depths):
        caption += f" {len(columns)} of {len(depths)} interfaces are shown; a wider --size shows more."
    fixed = [name for name in told.varied() if name not in told.varied(some)]
    if fixed:
        caption += f" All at {told.text(int(some[0]), fixed)}."
    missing = not_shown(told, some.tolist(), "--figure interfaces --states", choice.states)
    return Drawing("interfaces", caption, figure, left_out=missing)


def _depths(data: dict[str, Any], scene: Scene) -> tuple[NDArray, NDArray, str]:
    """Depths of interfaces as titles tell them, over a half-width, and the unit of titles."""
    if INTERFACE_DEPTH.path in data:
        return data[INTERFACE_DEPTH.path], data[INTERFACE_DEPTH.path], "a"
    depths = data[INTERFACE_DEPTH_IN_M.path]
    return 1e3 * depths, depths / scene.body.half_width, r"\mathrm{mm}"


def _rows(data: dict[str, Any], choice: Choice) -> list[Row]:
    """What is drawn, by side and method."""
    known = by_method(data, (STATE, INTERFACE, ALONG), choice.method)
    wanted = [one_of("quantity", name, known) for name in choice.quantities] or list(known)
    found = []
    for names, label in _SHOWN.items():
        sides = [
            {
                method: choice.scale(rows[method])[..., None] * data[rows[method].path]
                for method in METHODS
                if method in rows
            }
            for rows in (known[name] for name in names if name in wanted)
        ]
        if sides:
            found.append(Row(choice.label(*label), sides))
    return found
