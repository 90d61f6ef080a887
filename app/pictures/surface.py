"""Stresses of an archive's states: along the surface, along the interfaces of layers, and maps of those
inside."""

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
from galinx.postprocess.quantities.layers import ALONG_X, INTERFACE_DEPTH
from galinx.postprocess.quantities.quantity import ALONG, INSIDE, INTERFACE, METHODS, POINT, STATE
from galinx.postprocess.quantities.states import FRICTION, POSITION
from galinx.postprocess.quantities.stresses import IN_PLANE, PRESSURE, SURFACE_X
from galinx.postprocess.quantities.swept import interface_depths
from galinx.solvers.contact.solution import FREE, ONE_FREE, PRESCRIBED, SHARP
from galinx.solvers.contact.stresses import maximum_shear, von_mises

from ..scene.scene import Scene
from .choice import Choice, Drawing, by_method, has_quantities, require_one_of
from .friction import Loops
from .state_labels import C, N, StateLabels, not_shown, spread, states_for_panel

#: Curves that can be distinguished in a panel, columns of a page, and the least width for one [in].
_CURVES, _COLUMNS, _LEAST = 6, 3, 2.3

#: Names of the stresses that are shown by default, and what axes call them.
SHOWN = {
    next(iter(rows.values())).path.rpartition("/")[2]: label
    for rows, label in (
        (PRESSURE, ("contact stress", r"\sigma_{YY}")),
        (IN_PLANE, ("in-plane stress", r"\sigma_{XX}")),
    )
}


def quantities(data: dict[str, Any], method: str = "") -> list[str]:
    """Names of the stresses that an archive has along the surface."""
    return list(by_method(data, (STATE, POINT), method))


def stresses_of(data: dict[str, Any], choice: Choice) -> list[Stress]:
    """Stresses along the surface by method, the chosen ones or those that are shown by default."""
    available = by_method(data, (STATE, POINT), choice.method)
    names = choice.quantities or [name for name in SHOWN if name in available]
    return [
        Stress(
            choice.label(*SHOWN[name])
            if name in SHOWN
            else choice.called(next(iter(available[name].values()))),
            {method: choice.scale(row) * data[row.path] for method, row in available[name].items()},
        )
        for name in (require_one_of("quantity", name, available) for name in names)
    ]


#: Ends of captions by the ends of the contact.
_ENDS = {SHARP: ": at its edges they grow without bound.", PRESCRIBED: "."} | dict.fromkeys(
    (FREE, ONE_FREE),
    "; lengths are over each state's own half-width, from the middle of its contact.",
)


def surface(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of stresses along the surface: a column for each speed, or else for each value of the
    parameter that varies most slowly."""
    loops = Loops(data, scene)
    labels, width = loops.labels, choice.size.width if choice.size else PAGE
    same = scene.body.alike and N in labels.parameters and not choice.states and not choice.in_si
    states = labels.where(labels.all, **{N: labels.values(N)[0]}) if same else labels.all
    groups = _groups(labels, states, choice.states, width)
    # Curves of one name look the same in all columns.
    columns = [
        column(data, loops, title, shown, names, labels.looks(shown, names))
        for title, shown, names in groups
    ]
    shown = [state for _, states, _ in groups for state in states]
    fixed = [name for name in labels.parameters if name not in labels.varied(shown)]
    varied = [name for name in labels.varied() if name in fixed]
    figure = surface_figure(
        data[SURFACE_X.path], stresses_of(data, choice), columns, choice.size, choice.ends
    )
    caption = "Stresses along the surface, under the punch (grey) and beside it"
    from_axis = "; positions are from the punch's axis."
    caption += _ENDS[scene.body.ends] if choice.ends is None else from_axis
    if same:
        caption += " Over N/(2a) they are the same under every load."
    if any(axis.child_axes for axis in figure.axes):
        caption += " Insets show where on the friction loop each curve sits."
    if varied:
        caption += f" All at {labels.text(shown[0], varied)}."
    missing = not_shown(labels, shown, "--figure surface --states", choice.states)
    return Drawing("surface", caption, figure, left_out=missing)


def column(
    data: dict[str, Any],
    loops: Loops,
    title: str,
    states: Sequence[int],
    names: Sequence[str],
    looks: Any,
) -> Column:
    """Column of the figure: a curve for each state, and the state's place on its friction loop."""
    curves = [Curve(i, loops.labels.label(i, names), look) for i, look in zip(states, looks)]
    places = [
        Place(loop, float(data[POSITION.path][i]), float(data[FRICTION.path][i]))
        for i, loop in zip(states, loops.of_all(states))
    ]
    return Column(title, curves, places)


def _groups(
    labels: StateLabels, states: NDArray, requested: Sequence[int], width: float
) -> list[tuple[str, list[int], list[str]]]:
    """Title, states and parameters that distinguish them, by column."""
    states = np.array(requested) if requested else states
    varied = labels.varied(states)
    most = max(1, min(_COLUMNS, int(width / _LEAST)))
    by = varied[0] if len(varied) > 1 or C in varied else ""
    if by and requested and len(labels.distinct(by, states)) > most:
        by = ""
    if not by:
        names, shown = (
            (varied, states) if requested else states_for_panel(labels, varied, states, _CURVES)
        )
        return [("", shown.tolist(), names)]
    groups = []
    values = labels.distinct(by, states)
    for value in spread(values, most) if most > 1 else values[-1:]:
        group, names = labels.where(states, **{by: value}), [name for name in varied if name != by]
        if not requested:
            names, group = states_for_panel(labels, names, group, _CURVES)
        groups.append((labels.label(int(group[0]), [by]), labels.ordered(group).tolist(), names))
    return groups


#: Curves that can be distinguished in a panel, and the least width of a column [in].
_INTERFACE_CURVES, _LEAST_INTERFACE = 4, 2.2

#: What axes call stresses, and which of them share one: both sides of an interface.
_AT_INTERFACES = {
    ("sigma_YY",): ("normal traction", r"\sigma_{YY}"),
    ("sigma_XY",): ("shear traction", r"\sigma_{XY}"),
    ("sigma_XX_above", "sigma_XX_below"): ("in-plane stress", r"\sigma_{XX}"),
}


def interface_quantities(data: dict[str, Any], method: str = "") -> list[str]:
    """Names of the stresses that an archive has along interfaces."""
    return list(by_method(data, (STATE, INTERFACE, ALONG), method))


def has_interfaces(data: dict[str, Any], choice: Choice) -> bool:
    """Return True if an archive holds the chosen stresses along interfaces."""
    available = interface_quantities(data, choice.method)
    return bool(available) and set(choice.quantities) <= set(available)


def interfaces(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of stresses along interfaces: a column for each interface, or for some of many."""
    labels, width = StateLabels(data, scene), choice.size.width if choice.size else PAGE
    states = np.array(choice.states) if choice.states else labels.all
    names = labels.varied(states)
    if not choice.states:
        names, states = states_for_panel(labels, names, states, _INTERFACE_CURVES)
    states = labels.ordered(states)
    shown = looks(len(states), len(names) == 1 and labels.numeric(names[0]))
    curves = [Curve(i, labels.label(i, names), look) for i, look in zip(states.tolist(), shown)]
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
        choice.frames(states.tolist()),
    )
    caption = (
        "Stresses along the interfaces, under the punch (grey) and beside it: tractions, which both "
        "sides share, and in-plane stress, which jumps."
    )
    if len(columns) < len(depths):
        caption += f" {len(columns)} of {len(depths)} interfaces are shown; a wider --size shows more."
    fixed = [name for name in labels.varied() if name not in labels.varied(states)]
    if fixed:
        caption += f" All at {labels.text(int(states[0]), fixed)}."
    missing = not_shown(labels, states.tolist(), "--figure interfaces --states", choice.states)
    return Drawing("interfaces", caption, figure, left_out=missing)


def _depths(data: dict[str, Any], scene: Scene) -> tuple[NDArray, NDArray, str]:
    """Depths of interfaces as titles show them, their reach over a half-width, and the unit of titles."""
    if INTERFACE_DEPTH.path in data:
        return data[INTERFACE_DEPTH.path], data[INTERFACE_DEPTH.path], "a"
    depths = interface_depths(data)[1][0]
    return 1e3 * depths, depths / scene.body.half_width, r"\mathrm{mm}"


def _rows(data: dict[str, Any], choice: Choice) -> list[Row]:
    """Rows of the figure: stresses by side of the interface and by method."""
    available = by_method(data, (STATE, INTERFACE, ALONG), choice.method)
    chosen = [require_one_of("quantity", name, available) for name in choice.quantities] or list(
        available
    )
    figure_rows = []
    for names, label in _AT_INTERFACES.items():
        sides = [
            {
                method: choice.scale(rows[method])[..., None] * data[rows[method].path]
                for method in METHODS
                if method in rows
            }
            for rows in (available[name] for name in names if name in chosen)
        ]
        if sides:
            figure_rows.append(Row(choice.label(*label), sides))
    return figure_rows


#: Name and symbol of the stresses that maps show by default.
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
        data, scene: datasets by path, and the scene, of an archive.
        choice: method and unit of the stresses.
    """

    def __init__(self, data: dict[str, Any], scene: Scene, choice: Choice) -> None:
        self._data, self._scene, self._choice = data, scene, choice
        method = choice.method
        self._shape = tuple(data[stresses.MAP.path].tolist())
        self._quantities = by_method(data, (STATE, INSIDE), method)
        self.methods = [
            name for name in METHODS if any(name in rows for rows in self._quantities.values())
        ]

    @property
    def names(self) -> list[str]:
        """Names of all stresses inside that can be mapped."""
        return list(
            dict.fromkeys([*self._quantities, *(name for name in _MAPS if self._of_components(name))])
        )

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depths over a of the lower faces of layers; none where every state has its own half-width."""
        unit, depths = self._scene.body.depths
        return tuple(depths.tolist()) * (unit == "1")

    def grid(self) -> tuple[NDArray, NDArray]:
        """Positions over a along both axes."""
        X, Y = (self._on_grid(self._data[row.path]) for row in (stresses.INSIDE_X, stresses.INSIDE_Y))
        return X[0], Y[:, 0]

    def values(self, name: str, method: str, state: int) -> NDArray:
        """One quantity of a state, (rows, columns)."""
        if name in self._quantities:
            row = self._quantities[name][method]
            return self._choice.scale_of(row, state) * self._on_grid(self._data[row.path][state])
        XX, YY, XY = (
            self._choice.scale_of(row, state) * self._on_grid(self._data[row.path][state])
            for row in (stresses.STRESSES_INSIDE | layers.STRESSES_INSIDE)[method]
        )
        if name == "max_shear":
            return maximum_shear(XX, YY, XY)
        return von_mises(XX, YY, XY, self._scene.solid.σ_ZZ(XX, YY, XY))

    def label(self, name: str, alone: bool) -> str:
        """Label of the colour bar of a quantity."""
        if name not in _MAPS:
            return self._choice.called(next(iter(self._quantities[name].values())))
        called, symbol = _MAPS[name]
        return self._choice.label(called, symbol, " " if alone else "\n")

    def _of_components(self, name: str) -> bool:
        return (
            name not in self._quantities
            and len({"sigma_XX", "sigma_YY", "sigma_XY"} & set(self._quantities)) == 3
        )

    def _on_grid(self, values: NDArray) -> NDArray:
        return values[: np.prod(self._shape)].reshape(self._shape)


def has_map(data: dict[str, Any], method: str = "") -> bool:
    """Return True if an archive holds a map of stresses."""
    return has_quantities(data, stresses.MAP) and bool(by_method(data, (STATE, INSIDE), method))


def inside(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of maps of stresses at the slowest and the fastest speed, and of the methods'
    differences."""
    fields, labels = Fields(data, scene, choice), StateLabels(data, scene)
    X, Y = fields.grid()
    names = [require_one_of("quantity", name, fields.names) for name in choice.quantities]
    names = names or [name for name in _MAPS if name in fields.names]
    states = list(choice.states) or _states(labels)
    alone = len(names) == len(states) == 1
    apart = labels.varied(states) or ([C] if C in labels.varied() or alone else [])
    width = choice.size.width if choice.size else COLUMN if len(states) == 1 else PAGE
    shown, differences = _maps(fields, names, states)
    largest = max((float(np.abs(off).max()) for off in differences), default=0.0)
    columns = 2 * len(states)
    if len(names) == 1 or width < columns * _LEAST_MAP:
        differences, columns = [], len(states)
    titles = [folded(labels.label(i, apart), int((width - 1.0) / columns / 0.062)) for i in states]
    figure = maps_figure(X, Y, shown, titles, differences, choice.size, choice.frames(states))
    caption = _caption(labels, states, fields, largest)
    how = f"--figure inside --states{'' if alone else ', single maps with --quantity'}"
    return Drawing("inside", caption, figure, True, not_shown(labels, states, how, choice.states))


def _maps(fields: Fields, names: list[str], states: list[int]) -> tuple[list[Map], list[NDArray]]:
    """Maps of stresses by quantity, and differences of both methods over the quantity's largest value."""
    shown, differences = [], []
    for name in names:
        values, *others = (
            np.array([fields.values(name, method, i) for i in states]) for method in fields.methods
        )
        label = fields.label(name, len(names) == 1)
        shown.append(Map(label, values, bool(values.min() < 0.0), fields.interfaces))
        differences += [(other - values) / np.abs(values).max() for other in others]
    return shown, differences


def _caption(labels: StateLabels, states: list[int], fields: Fields, largest: float) -> str:
    fixed = [name for name in labels.parameters if name not in labels.varied(states)]
    method = METHODS[fields.methods[0]]
    text = (
        f"Stresses inside below the punch (black bar), {method}, at {labels.text(states[0], fixed)}. "
        "They spread from the edges; beyond an arrow at the end of a bar its colours are clipped."
    )
    if fields.interfaces:
        text += " Dashed lines are the interfaces."
    if largest:
        text += (
            f" Finite elements differ by at most {plain(f'${number(largest, 2)}$')} of the largest value."
        )
    return text


def _states(labels: StateLabels) -> list[int]:
    """First and last state of the parameter that varies most slowly, others at one of their values."""
    varied = labels.varied()
    states = labels.where(labels.all, **labels.fixed(varied[1:], labels.all))
    return sorted({int(states[0]), int(states[-1])})[:_STATES]
