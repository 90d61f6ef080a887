"""Stresses along the surface of some of an archive's states.

Stresses along the interfaces of layers of some of an archive's states.

Maps of stresses inside of some of an archive's states.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.figures.maps import Map, maps_figure
from galinx.postprocess.figures.style import COLUMN, PAGE, folded, looks, number, plain
from galinx.postprocess.figures.surface import (
    Column,
    Curve,
    Interface,
    Place,
    Row,
    Stress,
    interfaces_figure,
    surface_figure,
)
from galinx.postprocess.quantities import layers, stresses
from galinx.postprocess.quantities.layers import ALONG_X, INTERFACE_DEPTH, INTERFACE_DEPTH_IN_M
from galinx.postprocess.quantities.quantity import ALONG, INSIDE, INTERFACE, METHODS, POINT, STATE
from galinx.postprocess.quantities.states import FRICTION, POSITION
from galinx.postprocess.quantities.stresses import IN_PLANE, PRESSURE, SURFACE_X
from galinx.postprocess.stresses import maximum_shear, von_mises
from galinx.solvers.layers.layered import Layered

from ..scene.scene import Scene
from .choice import Choice, Drawing, by_method, one_of, there
from .friction import Loops
from .state_labels import C, N, Told, few, not_shown, spread

#: Curves that can be told apart in a panel, columns of a page, and the least width for one [in].
_CURVES, _COLUMNS, _LEAST = 6, 3, 2.3

#: Names of the stresses that are shown unasked, and what axes call them.
SHOWN = {
    next(iter(rows.values())).path.rpartition("/")[2]: label
    for rows, label in (
        (PRESSURE, ("contact stress", r"\sigma_{YY}")),
        (IN_PLANE, ("in-plane stress", r"\sigma_{XX}")),
    )
}


def quantities(data: dict[str, Any], method: str = "") -> list[str]:
    """Names of what an archive has along the surface."""
    return list(by_method(data, (STATE, POINT), method))


def stresses_of(data: dict[str, Any], choice: Choice) -> list[Stress]:
    """What is drawn, by method."""
    known = by_method(data, (STATE, POINT), choice.method)
    wanted = choice.quantities or [name for name in SHOWN if name in known]
    return [
        Stress(
            choice.label(*SHOWN[name])
            if name in SHOWN
            else choice.called(next(iter(known[name].values()))),
            {method: choice.scale(row) * data[row.path] for method, row in known[name].items()},
        )
        for name in (one_of("quantity", name, known) for name in wanted)
    ]


def surface(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """A column for each speed, or else for each value of what varies most slowly."""
    loops = Loops(data, scene)
    told, width = loops.told, choice.size.width if choice.size else PAGE
    same = scene.body.alike and N in told.parameters and not choice.states and not choice.in_si
    some = told.where(told.all, **{N: told.values(N)[0]}) if same else told.all
    groups = _groups(told, some, choice.states, width)
    # Curves of one name look the same in all columns.
    columns = [
        column(data, loops, title, shown, names, told.looks(shown, names))
        for title, shown, names in groups
    ]
    shown = [state for _, some, _ in groups for state in some]
    fixed = [name for name in told.parameters if name not in told.varied(shown)]
    varied = [name for name in told.varied() if name in fixed]
    figure = surface_figure(
        data[SURFACE_X.path], stresses_of(data, choice), columns, choice.size, choice.ends
    )
    caption = "Stresses along the surface, under the punch (grey) and beside it"
    if choice.ends is not None:
        caption += "; positions are from the punch's axis."
    elif scene.body.found:
        caption += "; lengths are over each state's own half-width, from the middle of its contact."
    else:
        caption += "." if scene.solve.own_pressure else ": at its edges they grow without bound."
    if same:
        caption += " Over N/(2a) they are the same under every load."
    if any(axis.child_axes for axis in figure.axes):
        caption += " Insets show where on the friction loop each curve sits."
    if varied:
        caption += f" All at {told.text(shown[0], varied)}."
    missing = not_shown(told, shown, "--figure surface --states", choice.states)
    return Drawing("surface", caption, figure, left_out=missing)


def column(
    data: dict[str, Any], loops: Loops, title: str, some: Sequence[int], names: Sequence[str], looks: Any
) -> Column:
    """States as curves of a column, named by some parameters, and where on its loop each sits."""
    curves = [Curve(i, loops.told.label(i, names), look) for i, look in zip(some, looks)]
    places = [
        Place(loop, float(data[POSITION.path][i]), float(data[FRICTION.path][i]))
        for i, loop in zip(some, loops.of_all(some))
    ]
    return Column(title, curves, places)


def _groups(
    told: Told, some: NDArray, wanted: Sequence[int], width: float
) -> list[tuple[str, list[int], list[str]]]:
    """Title, states and what tells them apart, by column; of some states, or of those that are wanted."""
    some = np.array(wanted) if wanted else some
    varied = told.varied(some)
    most = max(1, min(_COLUMNS, int(width / _LEAST)))
    by = varied[0] if len(varied) > 1 or C in varied else ""
    if by and wanted and len(told.distinct(by, some)) > most:
        by = ""
    if not by:
        names, shown = (varied, some) if wanted else few(told, varied, some, _CURVES)
        return [("", shown.tolist(), names)]
    groups = []
    values = told.distinct(by, some)
    for value in spread(values, most) if most > 1 else values[-1:]:
        group, names = told.where(some, **{by: value}), [name for name in varied if name != by]
        if not wanted:
            names, group = few(told, names, group, _CURVES)
        groups.append((told.label(int(group[0]), [by]), told.ordered(group).tolist(), names))
    return groups


#: Curves that can be told apart in a panel, and the least width of a column [in].
_INTERFACE_CURVES, _LEAST_INTERFACE = 4, 2.2

#: What axes call stresses, and which of them share one: both sides of an interface.
_AT_INTERFACES = {
    ("sigma_YY",): ("normal traction", r"\sigma_{YY}"),
    ("sigma_XY",): ("shear traction", r"\sigma_{XY}"),
    ("sigma_XX_above", "sigma_XX_below"): ("in-plane stress", r"\sigma_{XX}"),
}


def interface_quantities(data: dict[str, Any], method: str = "") -> list[str]:
    """Names of what an archive has along interfaces."""
    return list(by_method(data, (STATE, INTERFACE, ALONG), method))


def has_interfaces(data: dict[str, Any], choice: Choice) -> bool:
    """Does an archive hold what is wanted?"""
    known = interface_quantities(data, choice.method)
    return bool(known) and set(choice.quantities) <= set(known)


def interfaces(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """A column for each interface, or for some of many."""
    told, width = Told(data, scene), choice.size.width if choice.size else PAGE
    some = np.array(choice.states) if choice.states else told.all
    names = told.varied(some)
    if not choice.states:
        names, some = few(told, names, some, _INTERFACE_CURVES)
    some = told.ordered(some)
    shown = looks(len(some), len(names) == 1 and told.numeric(names[0]))
    curves = [Curve(i, told.label(i, names), look) for i, look in zip(some.tolist(), shown)]
    depths, reach, unit = _depths(data, scene)
    columns = [
        Interface(i, float(reach[i]), f"$Y = {number(-depths[i])}\\,{unit}$")
        for i in spread(range(len(depths)), max(1, int(width / _LEAST_INTERFACE)))
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
    for names, label in _AT_INTERFACES.items():
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


#: Name and symbol of what maps show unasked.
_MAPS = {
    "sigma_XX": ("in-plane stress", r"\sigma_{XX}"),
    "sigma_YY": ("normal stress", r"\sigma_{YY}"),
    "sigma_XY": ("shear stress", r"\sigma_{XY}"),
    "von_mises": ("von Mises", r"\sigma_{\mathrm{vM}}"),
    "max_shear": ("largest shear", r"\tau_{\mathrm{max}}"),
}
#: Columns of states on a page, and the least width for one with its difference [in].
_STATES, _LEAST_MAP = 2, 1.6


class Fields:
    """Stresses inside on the grid of an archive.

    Args:
        data, scene: the archive's.
        choice: what is wanted.
    """

    def __init__(self, data: dict[str, Any], scene: Scene, choice: Choice) -> None:
        self._data, self._scene, self._choice = data, scene, choice
        method = choice.method
        self._shape = tuple(data[stresses.MAP.path].tolist())
        self._known = by_method(data, (STATE, INSIDE), method)
        self.methods = [name for name in METHODS if any(name in rows for rows in self._known.values())]

    @property
    def names(self) -> list[str]:
        """Of all there is."""
        return list(dict.fromkeys([*self._known, *(name for name in _MAPS if self._of_components(name))]))

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depths over a of the lower faces of layers."""
        body, solid = self._scene.body, self._scene.solid
        if body.found:  # over every state's own half-width they are elsewhere
            return ()
        return tuple((solid.depths / body.half_width).tolist()) if isinstance(solid, Layered) else ()

    def grid(self) -> tuple[NDArray, NDArray]:
        """Positions over a along both axes."""
        X, Y = (self._on_grid(self._data[row.path]) for row in (stresses.INSIDE_X, stresses.INSIDE_Y))
        return X[0], Y[:, 0]

    def values(self, name: str, method: str, state: int) -> NDArray:
        """One quantity of a state, (rows, columns)."""
        if name in self._known:
            row = self._known[name][method]
            return self._choice.scale_of(row, state) * self._on_grid(self._data[row.path][state])
        XX, YY, XY = (
            self._choice.scale_of(row, state) * self._on_grid(self._data[row.path][state])
            for row in (stresses.STRESSES_INSIDE | layers.STRESSES_INSIDE)[method]
        )
        if name == "max_shear":
            return maximum_shear(XX, YY, XY)
        return von_mises(XX, YY, XY, self._scene.solid.σ_ZZ(XX, YY, XY))

    def label(self, name: str, alone: bool) -> str:
        """Of its colours."""
        if name not in _MAPS:
            return self._choice.called(next(iter(self._known[name].values())))
        called, symbol = _MAPS[name]
        return self._choice.label(called, symbol, " " if alone else "\n")

    def _of_components(self, name: str) -> bool:
        return (
            name not in self._known and len({"sigma_XX", "sigma_YY", "sigma_XY"} & set(self._known)) == 3
        )

    def _on_grid(self, values: NDArray) -> NDArray:
        return values[: np.prod(self._shape)].reshape(self._shape)


def has_map(data: dict[str, Any], method: str = "") -> bool:
    """Does an archive hold a map of stresses?"""
    return there(data, stresses.MAP) and bool(by_method(data, (STATE, INSIDE), method))


def inside(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Stresses inside at the slowest and the fastest speed, and how far both methods are apart."""
    fields, told = Fields(data, scene, choice), Told(data, scene)
    X, Y = fields.grid()
    names = [one_of("quantity", name, fields.names) for name in choice.quantities]
    names = names or [name for name in _MAPS if name in fields.names]
    some = list(choice.states) or _states(told)
    alone = len(names) == len(some) == 1
    apart = told.varied(some) or ([C] if C in told.varied() or alone else [])
    width = choice.size.width if choice.size else COLUMN if len(some) == 1 else PAGE
    shown, differences = _maps(fields, names, some)
    largest = max((float(np.abs(off).max()) for off in differences), default=0.0)
    columns = 2 * len(some)
    if len(names) == 1 or width < columns * _LEAST_MAP:
        differences, columns = [], len(some)
    titles = [folded(told.label(i, apart), int((width - 1.0) / columns / 0.062)) for i in some]
    figure = maps_figure(X, Y, shown, titles, differences, choice.size, choice.frames(some))
    caption = _caption(told, some, fields, largest)
    how = f"--figure inside --states{'' if alone else ', single maps with --quantity'}"
    return Drawing("inside", caption, figure, True, not_shown(told, some, how, choice.states))


def _maps(fields: Fields, names: list[str], some: list[int]) -> tuple[list[Map], list[NDArray]]:
    """What is mapped, and where both methods are known their differences over the largest values."""
    shown, differences = [], []
    for name in names:
        values, *others = (
            np.array([fields.values(name, method, i) for i in some]) for method in fields.methods
        )
        label = fields.label(name, len(names) == 1)
        shown.append(Map(label, values, bool(values.min() < 0.0), fields.interfaces))
        differences += [(other - values) / np.abs(values).max() for other in others]
    return shown, differences


def _caption(told: Told, some: list[int], fields: Fields, largest: float) -> str:
    fixed = [name for name in told.parameters if name not in told.varied(some)]
    method = METHODS[fields.methods[0]]
    text = (
        f"Stresses inside below the punch (black bar), {method}, at {told.text(some[0], fixed)}. They "
        "spread from the edges; beyond an arrow at the end of a bar its colours are clipped."
    )
    if fields.interfaces:
        text += " Dashed lines are the interfaces."
    if largest:
        text += (
            f" Finite elements differ by at most {plain(f'${number(largest, 2)}$')} of the largest value."
        )
    return text


def _states(told: Told) -> list[int]:
    """The first and the last of what varies most slowly, others at one of their values."""
    varied = told.varied()
    some = told.where(told.all, **told.fixed(varied[1:], told.all))
    return sorted({int(some[0]), int(some[-1])})[:_STATES]
