"""Stresses of an archive's states: along the surface, along the interfaces of layers, and maps of those
inside; and those of several archives, one over the other."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from galinx.postprocess.quantities import Quantity, stresses
from galinx.postprocess.quantities.layers import ALONG_X
from galinx.postprocess.quantities.quantity import (
    ALONG,
    CONTACT,
    INSIDE,
    INTERFACE,
    METHODS,
    POINT,
    STATE,
)
from galinx.postprocess.quantities.states import FRICTION, POSITION
from galinx.postprocess.quantities.stresses import IN_PLANE, PRESSURE, SURFACE_X
from galinx.postprocess.quantities.swept import INTERFACE_DEPTHS, interface_depths
from galinx.solvers.contact.edges import from_edge, under_punch
from galinx.solvers.contact.solution import FREE, ONE_FREE, PRESCRIBED, SHARP
from galinx.solvers.contact.stresses import maximum_shear, von_mises
from galinx.texts import number, plain

from ..errors import BadInput
from .choice import Archive, Drawing, both, explained, named, require_one_of, short_name
from .friction import Loops
from .render import (
    DOTS,
    LINE,
    Curve,
    Map,
    Panel,
    Size,
    TooSmall,
    across,
    handle,
    render,
    spaced,
)
from .states import C, N, StateLabels, not_shown, spread, states_for_panel
from .style import COLUMN, GREY, LINES, PAGE, SMALL, Look, looks

#: Curves that can be told apart in a panel, columns of a page, and the least width for one [in].
_CURVES, _COLUMNS, _LEAST = 6, 3, 2.0
#: Positions shown of a stress all along the surface, and of one under the punch alone [a].
_BESIDE, _UNDER = 2.0, 1.04
#: Distance over a from an edge within which stresses may run out of the picture.
_EDGE = 0.09
#: Columns whose ranges differ more have limits of their own.
_APART = 4.0

#: Stresses that are shown by default along the surface: what axes call them, and their sign.
SHOWN = {
    next(iter(rows.values())).path.rpartition("/")[2]: label
    for rows, label in (
        (PRESSURE, (r"contact pressure $-\sigma_{YY}$", -1.0)),
        (IN_PLANE, (r"in-plane stress $\sigma_{XX}$", 1.0)),
    )
}


def along(X: NDArray, values: NDArray) -> float:
    """Half-width over a of the part of the surface shown for values, (states, points)."""
    return _UNDER if np.isnan(values[:, ~under_punch(X)]).all() else _BESIDE


def broken(X: NDArray, values: NDArray) -> tuple[NDArray, NDArray]:
    """Positions and values of a line broken at the edges of the punch: across one it would lie."""
    beside, gap = ~under_punch(X), [np.nan]
    parts = (beside & (X < 0.0), ~beside, beside & (X > 0.0))
    pieces = [(X[part], values[part]) for part in parts if not np.isnan(values[part]).all()]
    xs, ys = ([part for piece in pieces for part in (piece[n], gap)] for n in (0, 1))
    return np.concatenate([*xs, gap]), np.concatenate([*ys, gap])


def limits(X: NDArray, values: NDArray) -> tuple[float, float]:
    """Room for the regular part of values, (curves, points); singular ends run out of the picture."""
    regular = values[:, from_edge(X) > _EDGE]
    if np.nanmax(np.abs(values)) <= 1.05 * np.nanmax(np.abs(regular)):
        regular = values  # nothing runs out: the ends of the contact are smooth
    low, high = np.nanmin(regular), np.nanmax(regular)
    margin = 0.08 * (high - low) or 1.0
    if 0.0 < -high < 0.2 * (high - low):  # zero is near
        return low - margin, margin
    if 0.0 <= low < 0.2 * (high - low):
        return -0.5 * margin, high + margin
    return low - margin, high + margin


def surface_curves(
    X: NDArray, values: Mapping[str, NDArray], look: Look, label: str, turn: float,
    place: tuple[float, float] = (1.0, 0.0),
) -> list[Curve]:  # fmt: skip
    """Curves of a stress along the surface, broken at the edges; positions times and plus ``place``."""
    factor, offset = place
    curves = []
    half = along(X, np.array(list(values.values())))
    inside = np.abs(X) <= half
    for curve in both(X, dict(values), look, label, turn):
        if curve.form == LINE:
            x, y = broken(X, np.asarray(curve.y))
        elif curve.form == "joined":
            at = np.zeros(len(X), dtype=bool)
            at[spaced(np.where(inside, X, np.nan), turn)] = True
            curves.append(
                replace(curve, form="markers", label="", x=offset + factor * X[at], y=curve.y[at])
            )
            (x, y), curve = broken(X, np.asarray(curve.y)), replace(curve, form=LINE, width=0.6)
        else:
            x, y = X[inside], np.asarray(curve.y)[inside]
        curves.append(replace(curve, x=offset + factor * x, y=y))
    return curves


def surface_names(of: Archive, method: str | None = None) -> list[str]:
    """Names of the stresses that an archive has along the surface."""
    return list(of.by_method(STATE, POINT, method=method))


def stress_names(of: Archive) -> list[str]:
    """Names of the stresses along the surface that figures show."""
    shown = of.choice.quantities or [name for name in SHOWN if name in surface_names(of)]
    return list(dict.fromkeys(shown))


def surface_stresses(of: Archive) -> dict[str, dict[str, NDArray]]:
    """Stresses along the surface by the name of their axis and by method, (states, points), the chosen
    ones or those that are shown by default."""
    available = of.by_method(STATE, POINT)
    shown = {}
    for name in (require_one_of("quantity", name, available) for name in stress_names(of)):
        rows = available[name]
        row = next(iter(rows.values()))
        words, sign = SHOWN.get(name, (short_name(row), 1.0))
        label = named(words, of.scaled(row).unit)
        shown[label] = {method: sign * of.values(row) for method, row in rows.items()}
    return shown


#: Ends of captions by the ends of the contact.
_ENDS = {SHARP: ": at its edges they grow without bound.", PRESCRIBED: "."} | dict.fromkeys(
    (FREE, ONE_FREE), "; at free ends they are finite."
)


def place_of(of: Archive, state: int) -> tuple[float, float]:
    """What positions over a of a state are multiplied by, and what is added, in the figure's units."""
    scale = of.units.position
    return tuple(float(z[state]) if np.ndim(z) else float(z) for z in (scale.factor, scale.offset))  # type: ignore[return-value]


def position_name(of: Archive, words: str = "position on the surface ") -> str:
    """Name of the axis of positions."""
    return f"{words}$X/a$" if of.units.dimensionless else f"{words}$X$ ({of.units.position.unit})"


def contacts_of(of: Archive, states: Sequence[int]) -> list[tuple[float, float]]:
    """Ends of some states' contacts in the figure's units, each once."""
    ends = {
        tuple(round(b + s * a, 12) for s in (-1.0, 1.0)) for a, b in (place_of(of, i) for i in states)
    }
    return sorted(ends)  # type: ignore[arg-type]


def surface(of: Archive) -> Drawing:
    """Figure of stresses along the surface: a column for each speed, or else for each value of the
    parameter that varies most slowly."""
    data, scene, choice = of.data, of.scene, of.choice
    loops, labels, width = Loops(of), of.labels, choice.size.width if choice.size else PAGE
    same = scene.body.alike and N in labels.parameters and not choice.states and of.units.dimensionless
    states = labels.where(labels.all, **{N: labels.values(N)[0]}) if same else labels.all
    groups = _groups(labels, states, choice.states, width)
    shown = surface_stresses(of)
    X = data[SURFACE_X.path]
    panels: list[Panel] = []
    for n, (name, (label, values)) in enumerate(zip(stress_names(of), shown.items())):
        drawn = next(iter(values.values()))
        half = along(X, drawn)
        ranges = _ranges(X, drawn, [numbers for _, numbers, _ in groups])
        for column, (title, numbers, names) in enumerate(groups):
            styles = labels.looks(numbers, names)
            curves = [
                curve
                for k, (i, look) in enumerate(zip(numbers, styles))
                for curve in surface_curves(
                    X, {method: of_method[i] for method, of_method in values.items()}, look,
                    labels.label(i, names), k / len(numbers), place_of(of, i),
                )
            ]  # fmt: skip
            ends = contacts_of(of, numbers)
            places = [place_of(of, i) for i in numbers]
            window = (
                min(b - half * a for a, b in places), max(b + half * a for a, b in places)
            )  # fmt: skip
            bare = len(set(ranges)) == 1 and column > 0
            panel = Panel(
                position_name(of), None if bare else label, curves=curves, title=title if not n else "",
                xlim=window, ylim=ranges[column], at_y=(0.0,),
                bands=ends if len(ends) == 1 and half == _BESIDE else (),
                after=_inset(of, loops, numbers, styles) if not n and half == _UNDER else None,
            )  # fmt: skip
            measured = choice.measured
            panels.append(measured.over_stress(panel, name, of.units) if measured else panel)
    if not any(panel.after for panel in panels) or _same_places(of, loops, groups):
        panels[1 : len(groups)] = [replace(panel, after=None) for panel in panels[1 : len(groups)]]
    if len([1 for _, numbers, _ in groups for _ in numbers]) == len(groups) == 1:
        panels = [
            replace(
                panel,
                curves=[
                    curve if curve.form == DOTS else replace(curve, label="") for curve in panel.curves
                ],
            )
            for panel in panels
        ]
    methods = {method for values in shown.values() for method in values}
    columns, size = len(groups), choice.size
    if columns == 1 and width > 4.5 and len(shown) > 1:  # side by side
        columns = 2
    figure = render(panels, size, columns, explained(methods))
    every = [state for _, numbers, _ in groups for state in numbers]
    varied = labels.varied(every)
    fixed = [name for name in labels.varied() if name not in varied]
    caption = "Stresses along the surface, under the punch (grey) and beside it" + _ENDS[scene.body.ends]
    if same:
        caption += " Over N/(2a) they are the same under every load."
    if any(axis.child_axes for axis in figure.axes):
        caption += " Insets show where on the friction loop each curve sits."
    if fixed:
        caption += f" All at {labels.text(every[0], fixed)}."
    missing = not_shown(labels, every, "--figure surface --states", choice.states)
    return Drawing("surface", caption, figure, left_out=missing)


def _ranges(X: NDArray, values: NDArray, groups: Sequence[Sequence[int]]) -> list[tuple[float, float]]:
    """Limits of each column: the same for all, unless a few would hardly be visible then."""
    every = [limits(X, values[list(numbers)]) for numbers in groups]
    low, high = min(y[0] for y in every), max(y[1] for y in every)
    return every if high - low > _APART * min(y[1] - y[0] for y in every) else [(low, high)] * len(every)


def _groups(
    labels: StateLabels, states: NDArray, requested: Sequence[int], width: float
) -> list[tuple[str, list[int], list[str]]]:
    """Title, states and parameters that distinguish them, by column."""
    states = np.array(requested) if requested else states
    varied = labels.varied(states)
    most = max(1, min(_COLUMNS, int(width / _LEAST)))
    by = varied[0] if len(varied) > 1 else ""
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


#: Size of an inset, of the names of its axes, and where it may begin, all over that of the panel.
_INSET, _NAMES = (0.27, 0.31), (0.07, 0.12)
_CORNERS = ((0.37, 0.18), (0.075, 0.13), (0.7, 0.13), (0.37, 0.64), (0.075, 0.64), (0.7, 0.64))


def _same_places(of: Archive, loops: Loops, groups: Sequence[tuple[str, list[int], list[str]]]) -> bool:
    places = [
        [(of.data[POSITION.path][i], of.data[FRICTION.path][i], id(loops.of(i))) for i in numbers]
        for _, numbers, _ in groups
    ]
    return all(place == places[0] for place in places)


def _inset(
    of: Archive, loops: Loops, numbers: Sequence[int], styles: Sequence[Look]
) -> Callable[[Axes], None] | None:
    """Function that draws the places of states on their friction loops in a corner where no curve is.

    A loop that all share is grey. It shows places, not values: axes have no numbers. None where friction
    is the same all along.
    """
    shown = loops.of_all(numbers)
    if not shown or not any(loop.varies for loop in shown):
        return None

    def draw(axis: Axes) -> None:
        to_panel = axis.transData + axis.transAxes.inverted()
        points = np.concatenate([to_panel.transform(line.get_xydata()) for line in axis.lines])
        points = points[np.isfinite(points).all(axis=1)]
        for corner in _CORNERS:
            first, last = np.array(corner) - _NAMES, np.array(corner) + _INSET + 0.02
            if not ((first <= points) & (points <= last)).all(axis=1).any():
                break
        else:
            return
        inset = axis.inset_axes((*corner, *_INSET))
        shared = all(loop is shown[0] for loop in shown)
        for n, (i, loop, look) in enumerate(zip(numbers, shown, styles)):
            if n == 0 or not shared:
                inset.plot(loop.X_over_L, loop.f, color=GREY if shared else look.colour, linewidth=0.6)
            place = float(of.data[POSITION.path][i]), float(of.data[FRICTION.path][i])
            inset.plot(*place, look.marker, color=look.colour, markersize=4)
        inset.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
        inset.set(xticks=[], yticks=[])
        inset.margins(0.08, 0.12)
        inset.set_xlabel("$X/L$", fontsize=SMALL, labelpad=1.0)
        inset.set_ylabel("$f$", fontsize=SMALL, labelpad=1.0, rotation=0, va="center", ha="right")

    return draw


#: Curves of an interface, the least width of its column [in], and positions shown over a and its depth.
_INTERFACE_CURVES, _LEAST_INTERFACE, _OVER_A, _OVER_DEPTH = 4, 2.2, 2.0, 2.5
#: What axes call stresses, and which of them share one: both sides of an interface.
_AT_INTERFACES = {
    ("sigma_YY",): r"normal traction $\sigma_{YY}$",
    ("sigma_XY",): r"shear traction $\sigma_{XY}$",
    ("sigma_XX_above", "sigma_XX_below"): r"in-plane stress $\sigma_{XX}$",
}


def interface_names(of: Archive, method: str | None = None) -> list[str]:
    """Names of the stresses that an archive has along interfaces."""
    return list(of.by_method(STATE, INTERFACE, ALONG, method=method))


def interfaces(of: Archive) -> Drawing:
    """Figure of stresses along interfaces: a column for each interface, or for some of many."""
    labels, choice = of.labels, of.choice
    states, width = of.selected(), choice.size.width if choice.size else PAGE
    names = labels.varied(states)
    if not choice.states:
        names, states = states_for_panel(labels, names, states, _INTERFACE_CURVES)
    states = labels.ordered(states)
    styles = looks(len(states), len(names) == 1 and labels.numeric(names[0]))
    depths, reach, unit = _depths(of)
    shown = spread(range(len(depths)), max(1, int(width / _LEAST_INTERFACE)))
    available = of.by_method(STATE, INTERFACE, ALONG)
    chosen = [require_one_of("quantity", name, available) for name in choice.quantities] or list(
        available
    )
    X, both_sides = of.data[ALONG_X.path], False
    panels: list[Panel] = []
    methods: set[str] = set()
    for sides, words in _AT_INTERFACES.items():
        rows = [available[name] for name in sides if name in chosen]
        both_sides |= len(rows) > 1
        for i in shown if rows else ():
            half = max(_OVER_A, _OVER_DEPTH * float(reach[i]))
            inside = np.abs(X) <= half
            curves = []
            for side, row in enumerate(rows):
                methods |= row.keys()
                values = {method: of.values(quantity) for method, quantity in row.items()}
                for k, (state, look) in enumerate(zip(states.tolist(), styles)):
                    factor, offset = place_of(of, state)
                    at = {method: y[state, i][inside] for method, y in values.items()}
                    look = look._replace(line="-" if side == 0 else (0, (4.0, 1.5)))
                    label = labels.label(state, names) if side == 0 and len(states) > 1 else ""
                    curves += both(offset + factor * X[inside], at, look, label, k / len(states))
            ends = [place_of(of, state) for state in states.tolist()]
            label = named(words, of.scaled(next(iter(rows[0].values()))).unit)
            title = f"depth {number(depths[i])} {unit}" if len(depths) > 1 or len(panels) == 0 else ""
            panels.append(Panel(
                position_name(of, "position along the interface "), label if i == shown[0] else "",
                curves=curves, title=title if len(panels) < len(shown) else "",
                xlim=(min(b - half * a for a, b in ends), max(b + half * a for a, b in ends)),
                bands=contacts_of(of, states.tolist()), at_y=(0.0,),
            ))  # fmt: skip
    notes = explained(methods)
    if both_sides:
        sides_look = [handle(Look(GREY, line, ""), f"{side} the interface")
                      for side, line in (("above", "-"), ("below", (0, (4.0, 1.5))))]  # fmt: skip
        notes = sides_look + notes
    columns = len(shown)
    if columns == 1 and width > 4.5:
        columns = len(panels)
    figure = render(panels, choice.size, columns, notes)
    caption = (
        "Stresses along the interfaces, under the punch (grey) and beside it: tractions, which both "
        "sides share, and in-plane stress, which jumps."
    )
    if len(shown) < len(depths):
        caption += f" {len(shown)} of {len(depths)} interfaces are shown; a wider --size shows more."
    fixed = [name for name in labels.varied() if name not in labels.varied(states)]
    if fixed:
        caption += f" All at {labels.text(int(states[0]), fixed)}."
    missing = not_shown(labels, states.tolist(), "--figure interfaces --states", choice.states)
    return Drawing("interfaces", caption, figure, left_out=missing)


def _depths(of: Archive) -> tuple[NDArray, NDArray, str]:
    """Depths of interfaces as titles show them, their reach over a half-width, and the unit of titles."""
    unit, of_states = interface_depths(of.data)
    depths, a = of_states[0], of.scene.body.half_width
    reach, in_m = (depths, depths * a) if unit == "1" else (depths / a, depths)
    if of.units.dimensionless and unit == "1":
        return depths, reach, "$a$"
    scale = replace_unit(of)
    return in_m * scale[0], reach, scale[1]


def replace_unit(of: Archive) -> tuple[float, str]:
    """What lengths in m are multiplied by in a figure, and their unit."""
    if of.units.dimensionless:
        return 1e3, "mm"
    scale = of.units.scale(CONTACT)
    return float(np.max(scale.factor)), scale.unit


#: Name of the stresses that maps show by default.
_MAPS = {
    "von_mises": r"von Mises $\sigma_{\mathrm{vM}}$",
    "sigma_XX": r"in-plane $\sigma_{XX}$",
    "sigma_YY": r"normal $\sigma_{YY}$",
    "sigma_XY": r"shear $\sigma_{XY}$",
    "max_shear": r"largest shear $\tau_{\mathrm{max}}$",
}
#: Columns of states, and the share of values that have colours of their own: those at the edges of the
#: punch would leave none for the rest.
_STATES, _SHARE = 2, 0.985


class Fields:
    """Stresses inside on the grid of an archive."""

    def __init__(self, of: Archive, method: str | None = None) -> None:
        self._of, data = of, of.data
        self._shape = tuple(data[stresses.MAP.path].tolist())
        self._quantities = of.by_method(STATE, INSIDE, method=method)
        self.methods = [m for m in METHODS if any(m in rows for rows in self._quantities.values())]

    @property
    def names(self) -> list[str]:
        """Names of all stresses inside that can be mapped."""
        names = dict.fromkeys(self._quantities)
        if {"sigma_XX", "sigma_YY", "sigma_XY"} <= names.keys():
            names |= dict.fromkeys(_MAPS)
        return list(names)

    def grid(self) -> tuple[NDArray, NDArray]:
        """Positions over a along both axes."""
        X, Y = (self._on_grid(self._of.data[row.path]) for row in (stresses.INSIDE_X, stresses.INSIDE_Y))
        return X[0], Y[:, 0]

    def place(self, state: int) -> tuple[NDArray, NDArray]:
        """Positions of a state along both axes in the figure's units."""
        (X, Y), (a, b) = self.grid(), place_of(self._of, state)
        return b + a * X, a * Y

    def values(self, name: str, method: str, state: int) -> NDArray:
        """One quantity of a state, (rows, columns), in the figure's units."""
        if name in self._quantities:
            return self._scaled(self._quantities[name][method], state)
        rows = stresses.STRESSES_INSIDE[method]
        XX, YY, XY = (self._scaled(row, state) for row in rows)
        if name == "max_shear":
            return maximum_shear(XX, YY, XY)
        return von_mises(XX, YY, XY, self._of.scene.solid.σ_ZZ(XX, YY, XY))

    def label(self, name: str) -> str:
        """Label of the colour bar of a quantity."""
        row = next(iter((self._quantities.get(name) or next(iter(self._quantities.values()))).values()))
        return named(_MAPS.get(name) or short_name(row), self._of.scaled(row).unit)

    def _scaled(self, row: Quantity, state: int) -> NDArray:
        scale = self._of.scaled(row)
        return scale.of(self._on_grid(self._of.data[row.path][state])[None], [state])[0]

    def _on_grid(self, values: NDArray) -> NDArray:
        return values[: np.prod(self._shape)].reshape(self._shape)


def has_map(of: Archive, method: str | None = None) -> bool:
    """Return True if an archive holds a map of stresses."""
    return of.has(stresses.MAP) and bool(of.by_method(STATE, INSIDE, method=method))


def map_of(
    of: Archive, fields: Fields, name: str, method: str, state: int, limit: float, **options: Any
) -> Map:
    """Map of a stress of a state."""
    values = fields.values(name, method, state)
    X, Y = fields.place(state)
    strength = of.scene.half_plane.yield_strength
    level = 0.0
    if name == "von_mises" and strength and not of.scene.layers:
        scale = of.units.stress  # of stresses over N/(2a) with the unit of Pa
        level = strength * float(of.units.scale("Pa").factor) if scale.unit != "N/(2a)" else 0.0
    return Map(X, Y, values, limit=limit, signed=name.startswith("sigma"), level=level, **options)


def inside(of: Archive) -> Drawing:
    """Figure of maps of stresses at the slowest and the fastest speed."""
    fields, labels, choice = Fields(of), of.labels, of.choice
    names = [require_one_of("quantity", name, fields.names) for name in choice.quantities]
    names = names or [name for name in _MAPS if name in fields.names]
    states = list(choice.states) or _two_states(labels)
    alone = len(names) == len(states) == 1
    apart = labels.varied(states) or ([C] if C in labels.varied() or alone else [])
    size = choice.size
    if size is None and len(states) == 1:
        size = Size(COLUMN if len(names) < 3 else PAGE)
    method, *others = fields.methods
    lines = list(_interfaces(of))
    places = [fields.place(i) for i in states]
    window = (min(X[0] for X, _ in places), max(X[-1] for X, _ in places))
    depth = (min(Y[0] for _, Y in places), 0.0)
    unit, panels, off = of.units.length.unit, [], 0.0
    wide = len(states) > 1
    for n, name in enumerate(names):
        every = np.array([fields.values(name, method, i) for i in states])
        limit = float(np.quantile(np.abs(every), _SHARE)) or 1.0
        signed = name.startswith("sigma")
        ends = (signed and bool(every.min() < -limit)), bool(every.max() > limit)
        extend = {(True, True): "both", (False, True): "max", (True, False): "min"}.get(ends, "neither")
        for other in others:
            beside = np.array([fields.values(name, other, i) for i in states])
            off = max(off, float(np.abs(beside - every).max() / np.abs(every).max()))
        for k, state in enumerate(states):
            last = k == len(states) - 1
            shown = map_of(
                of, fields, name, method, state, limit, extend=extend, lines=alone,
                label=fields.label(name) if last else "",
            )  # fmt: skip
            a, b = place_of(of, state)
            bottom = not wide or n == len(names) - 1
            panels.append(Panel(
                ("$X/a$" if of.units.dimensionless else f"$X$ ({unit})") if bottom else None,
                ("$Y/a$" if of.units.dimensionless else f"$Y$ ({unit})") if k == 0 else None,
                map=shown, bar=(b - a, b + a), xlim=window, ylim=depth, at_y=(),
                title=labels.label(state, apart) if n == 0 or not wide else "", dashes=lines,
            ))  # fmt: skip
    columns = len(states) if wide else across(size.width, len(names), 2.4) if size else 1
    figure = render(panels, size, columns)
    fixed = [name for name in labels.parameters if name not in labels.varied(states)]
    caption = (
        f"Stresses inside below the punch (black bar), {METHODS[method]}, at "
        f"{labels.text(states[0], fixed)}. They spread from the edges; beyond an arrow at the end of a "
        "bar its colours are clipped."
    )
    caption += " Dashed lines are the interfaces." * bool(lines)
    if any(
        panel.map and panel.map.level and panel.map.values.max() > panel.map.level for panel in panels
    ):
        caption += " Within the white line the solid would yield."
    if off:
        caption += (
            f" Finite elements differ by at most {plain(f'${number(off, 2)}$')} of the largest value."
        )
    how = f"--figure inside --states{'' if alone else ', single maps with --quantity'}"
    return Drawing("inside", caption, figure, True, not_shown(labels, states, how, choice.states))


def _interfaces(of: Archive) -> Sequence[float]:
    """Heights of the lower faces of layers in the figure's units; none where these differ by state."""
    if INTERFACE_DEPTHS.path in of.data:
        return []
    unit, depths = of.scene.body.depths
    if unit == "1":
        scale = of.units.length
        return [] if np.ndim(scale.factor) else (-scale.factor * depths).tolist()
    return [] if of.units.dimensionless else (-depths * replace_unit(of)[0]).tolist()


def _two_states(labels: StateLabels) -> list[int]:
    """First and last state of the parameter that varies most slowly, others at one of their values."""
    varied = labels.varied()
    states = labels.where(labels.all, **labels.fixed(varied[1:], labels.all))
    return sorted({int(states[0]), int(states[-1])})[:_STATES]


def has_surface(of: Archive) -> bool:
    """Return True if an archive has the chosen stresses along the surface."""
    return _has(surface_names(of), of)


def has_interfaces(of: Archive) -> bool:
    """Return True if an archive has the chosen stresses along interfaces."""
    return _has(interface_names(of), of)


def _has(names: Sequence[str], of: Archive) -> bool:
    return bool(names) and set(of.choice.quantities) <= set(names)


def has_inside(of: Archive) -> bool:
    """Return True if an archive has a map, and the chosen stresses in it."""
    return has_map(of) and set(of.choice.quantities) <= set(Fields(of).names)


#: States of each archive that can be told apart.
_COMPARED = 3


def compared(
    archives: Sequence[Archive], labels: Sequence[str], pairs: Sequence[Sequence[int]],
    titles: Sequence[str],
) -> Drawing:  # fmt: skip
    """Contact pressure and in-plane stress of states, colours by archive and lines by state.

    Args:
        archives: what to draw, in the same units.
        labels: of the archives.
        pairs: a state of each archive, (pairs, archives); of many some are drawn.
        titles: of the pairs.

    Raises:
        BadInput: an archive has no stresses along the surface, or measured points lie elsewhere.
    """
    for of, label in zip(archives, labels):
        if not has_surface(of):
            raise BadInput(
                f'{label} holds no stresses along the surface; add "surface" to output.quantities'
            )
    chosen, styles = spread(range(len(pairs)), _COMPARED), looks(len(archives))
    panels = []
    methods = {method for of in archives for by in surface_stresses(of).values() for method in by}
    for name in dict.fromkeys(name for of in archives for name in stress_names(of)):
        curves, ranges, windows, ends = [], [], [], []
        for n, of in enumerate(archives):
            shown = dict(zip(stress_names(of), surface_stresses(of).items()))
            if name not in shown:
                continue
            axis, values = shown[name]
            X, drawn = of.data[SURFACE_X.path], next(iter(values.values()))
            states = [pairs[k][n] for k in chosen]
            half = along(X, drawn)
            ranges.append(limits(X, drawn[states]))
            ends += contacts_of(of, states) if half > 1.5 else []
            for order, (k, state) in enumerate(zip(chosen, states)):
                line = LINES[order % len(LINES)] if len(chosen) > 1 else styles[n].line
                a, b = place_of(of, state)
                windows += [b - half * a, b + half * a]
                curves += surface_curves(
                    X, {method: y[state] for method, y in values.items()}, styles[n]._replace(line=line),
                    f"{labels[n]}, {titles[k]}" if len(chosen) > 1 else labels[n],
                    n / len(archives), (a, b),
                )  # fmt: skip
        low, high = np.min(ranges, axis=0)[0], np.max(ranges, axis=0)[1]
        panel = Panel(
            position_name(archives[0]), axis, curves=curves, xlim=(min(windows), max(windows)),
            ylim=(float(low), float(high)), at_y=(0.0,),
            bands=ends[:1] if ends and np.allclose(ends, ends[0], rtol=1e-9) else (),
        )  # fmt: skip
        measured = archives[0].choice.measured
        panels.append(measured.over_stress(panel, name, archives[0].units) if measured else panel)
    try:
        figure = render(panels, None, min(2, len(panels)), explained(methods))
    except TooSmall as error:
        raise BadInput(f"the titles of these archives leave no room for curves: {error}") from error
    left_out = (
        f"{len(pairs) - len(chosen)} of {len(pairs)} pairs of states not shown; choose by --states."
    )
    return Drawing(
        "compare", f"Stresses along the surface: {', '.join(labels)}.", figure,
        left_out=left_out if len(pairs) > len(chosen) else "",
    )  # fmt: skip
