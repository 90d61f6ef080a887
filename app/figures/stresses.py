"""Stresses of an archive's states: along the surface, along the interfaces of layers, and maps of those
inside; and friction along the contact."""

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import preferred, stresses
from galinx.postprocess.quantities.layers import ALONG_X
from galinx.postprocess.quantities.quantity import (
    ALONG,
    CLOSED_FORM,
    CONTACT,
    INSIDE,
    INTERFACE,
    METHODS,
    POINT,
    STATE,
)
from galinx.postprocess.quantities.states import CENTRE, HALF_WIDTH, LOAD, RESULTANT_RATIO, SPEED
from galinx.postprocess.quantities.stresses import PRESSURE, RATIO_ALONG, SURFACE_X
from galinx.postprocess.quantities.swept import interface_depths
from galinx.solvers.contact.edges import from_edge, under_punch
from galinx.solvers.contact.equation import under_punch as half_plane_under_punch
from galinx.solvers.contact.solution import FREE, ONE_FREE, PRESCRIBED, SHARP, make_contact
from galinx.solvers.contact.stresses import maximum_shear
from galinx.texts import number, plain

from ..errors import require_one_of
from ..plan.variants import of_state
from .choice import (
    PLACE,
    STROKE,
    Archive,
    C,
    Drawing,
    N,
    both,
    explained,
    named,
    short_name,
    spread,
    states_for_panel,
)
from .render import JOINED, LINE, MARKERS, Map, Panel, Size, across, note, render, spaced
from .style import COLUMN, GREY, LINES, PAGE, Look, looks

#: Curves that can be told apart in a panel, those that are each of several lines, columns of a page, and
#: the least width for one [in].
_CURVES, _FEW, _COLUMNS, _LEAST = 6, 4, 3, 2.0
#: Positions shown of a stress all along the surface, and of one under the punch alone [a]; those round
#: the largest tension over its distance.
_BESIDE, _UNDER, _ROUND = 2.0, 1.04, 1.5

#: Stresses that are shown by default along the surface: what axes call them, and their sign.
SHOWN = {
    "sigma_YY": (r"contact pressure $-\sigma_{YY}$", -1.0),
    "sigma_XX": (r"in-plane stress $\sigma_{XX}$", 1.0),
}


def limits(X: NDArray, values: NDArray) -> tuple[float, float]:
    """Room for values further than 0.09 a from the edges, (curves, points); singular ends run out of the
    picture."""
    regular = values[:, from_edge(X) > 0.09]
    if np.isnan(regular).all():
        return 0.0, 1.0
    if np.nanmax(np.abs(values)) <= 1.05 * np.nanmax(np.abs(regular)):
        regular = values  # nothing runs out: the ends of the contact are smooth
    low, high = np.nanmin(regular), np.nanmax(regular)
    margin = 0.08 * (high - low) or 1.0
    if 0.0 < -high < 0.2 * (high - low):  # zero is near
        return low - margin, margin
    if 0.0 <= low < 0.2 * (high - low):
        return -0.5 * margin, high + margin
    return low - margin, high + margin


def broken(X: NDArray, values: NDArray) -> tuple[NDArray, NDArray]:
    """Positions and values of a line broken at the edges of the punch: across one it would lie."""
    beside = ~under_punch(X)
    parts = (beside & (X < 0.0), ~beside, beside & (X > 0.0))
    pieces = [part for part in parts if not np.isnan(values[part]).all()]
    if not pieces:
        return X, values
    x, y = (np.concatenate([np.append(z[part], np.nan) for part in pieces]) for z in (X, values))
    return x, y


def position_name(of: Archive, words: str = "position on the surface ") -> str:
    """Name of the axis of positions."""
    return f"{words}$X/a$" if of.units.dimensionless else f"{words}$X$ ({of.units.position.unit})"


def places_of(of: Archive, states: Iterable[int]) -> list[tuple[float, float]]:
    """Factor and offset that turn positions over a of each state into the figure's units."""
    scale = of.units.position
    each = ((z[i] if np.ndim(z) else z for z in (scale.factor, scale.offset)) for i in states)
    return [(float(a), float(b)) for a, b in each]


@dataclass(frozen=True)
class Along:
    """A stress along the surface or an interface by method; a row is of a state, or of a time.

    Attributes:
        X: positions over a, (points,).
        axis: name of the stress on its axis.
        values: numbers in the figure's units by method, (rows, points).
        places: factor and offset that turn X into positions in the figure, of each row.
        position: name of the axis of positions.
        half: positions over a that are shown; 0 for those that the contact needs, where lines
            break at its edges.
    """

    X: NDArray[np.float64]
    axis: str
    values: dict[str, NDArray]
    places: Sequence[tuple[float, float]]
    position: str = "position on the surface $X/a$"
    half: float = 0.0

    def limits(self, rows: Sequence[int]) -> tuple[float, float]:
        """Limits of some rows by the first method."""
        return limits(self.X, next(iter(self.values.values()))[list(rows)])

    def shown(
        self, looks: Sequence[Look], labels: Sequence[str] = (), width: float = 1.0,
        rows: Sequence[int] = (),
    ) -> list["Shown"]:  # fmt: skip
        """Some rows, by default the first, with their looks and their names in the legend."""
        numbered = zip(rows or range(len(looks)), looks, labels or [""] * len(looks))
        return [Shown(self, *each, width) for each in numbered]


class Shown(NamedTuple):
    """A row of a stress in a panel, its look, its name in the legend, and the width of its line [pt]."""

    along: Along
    row: int
    look: Look
    label: str = ""
    width: float = 1.0


def _needed(X: NDArray, values: NDArray) -> float:
    """Half the width over a of a panel that shows a contact, and the largest tension beside it."""
    beside = np.where(under_punch(X), np.nan, values)
    if np.isnan(beside).all():
        return _UNDER
    far = np.abs(X[np.nanargmax(beside)])  # a stiff plate bends: the tension of its surface is there
    return max(_BESIDE, _ROUND * far) if np.nanmax(beside) > 0.0 else _BESIDE


def surface_panel(
    shown: Sequence[Shown], ylim: tuple[float, float] | None = None, **options: Any
) -> Panel:
    """Panel of a stress along the surface, as wide as its contacts need; lines break at the edges.

    Args:
        shown: rows, which may be of several archives with the same units.
        ylim: limits of the stress, those of the rows by default.
        options: further attributes of the panel.
    """
    curves, ranges, places, half = [], [], [], _UNDER
    for along, row, *_ in shown:
        first = next(iter(along.values.values()))[row]
        half = max(half, along.half or _needed(along.X, first))
        ranges.append(limits(along.X, first[None]))
        places.append(along.places[row])
    xlim = min(b - half * a for a, b in places), max(b + half * a for a, b in places)
    for k, ((along, row, look, label, width), (a, b)) in enumerate(zip(shown, places)):
        X, values = along.X, {method: y[row] for method, y in along.values.items()}
        inside = (xlim[0] <= b + a * X) & (b + a * X <= xlim[1])
        for curve in both(X, values, look, label, k / len(shown)):
            x, y = X[inside], np.asarray(curve.y)[inside]
            thin = width
            if curve.form == JOINED and not along.half:  # markers, and a line that breaks between them
                at = spaced(x, curve.turn)
                curves.append(replace(curve, form=MARKERS, label="", x=b + a * x[at], y=y[at]))
                curve, thin = replace(curve, form=LINE), 0.6 * width
            if curve.form == LINE and not along.half:
                x, y = broken(X, np.asarray(curve.y))
            curves.append(replace(curve, x=b + a * x, y=y, width=thin))
    low, high = np.array(ranges).T
    ends = sorted({(round(b - a, 12), round(b + a, 12)) for a, b in places})
    same = half >= _BESIDE and np.allclose(ends, ends[0], rtol=1e-9)
    panel = Panel(
        shown[0].along.position, shown[0].along.axis, curves=curves, xlim=xlim,
        ylim=ylim or (float(low.min()), float(high.max())), at_y=(0.0,),
        bands=ends if shown[0].along.half else ends[:1] * same,
    )  # fmt: skip
    return replace(panel, **options)


def surface_panels(along: Along, states: Sequence[int], label: str = "", **options: Any) -> list[Panel]:
    """A panel for each of some states, all with the same limits; arguments as for surface_panel."""
    ylim, (look,) = along.limits(states), looks(1)
    return [surface_panel([Shown(along, i, look, label)], ylim, **options) for i in states]


def stresses_along(of: Archive) -> dict[str, Along]:
    """Stresses along the surface by name, of all states: the chosen ones or those shown by default."""
    available, stressed = of.by_method(STATE, POINT), {}
    where = places_of(of, of.all), position_name(of)
    for name in of.choice.quantities or [name for name in SHOWN if name in available]:
        rows = available[require_one_of("quantity", name, available)]
        first = next(iter(rows.values()))
        words, sign = SHOWN.get(name, (short_name(first), 1.0))
        values = {each: sign * of.values(row) for each, row in rows.items()}
        axis = named(words, of.scaled(first).unit)
        stressed[name] = Along(of.data[SURFACE_X.path], axis, values, *where)
    return stressed


#: Ends of captions by the ends of the contact.
_ENDS = {SHARP: ": at its edges they grow without bound.", PRESCRIBED: "."} | dict.fromkeys(
    (FREE, ONE_FREE), "; at free ends they are finite."
)


def surface(of: Archive) -> Drawing:
    """Figure of stresses along the surface: a column for each speed, or else for each value of the
    parameter that varies most slowly."""
    choice, stressed = of.choice, stresses_along(of)
    width = choice.size.width if choice.size else PAGE
    same = of.scene.body.alike and N in of.parameters and not choice.states and of.units.dimensionless
    every = of.selected()
    states = of.where(every, **{N: of.parameter(N)[every[0]]}) if same else every
    states, alike_at = of.once(states, *(y for along in stressed.values() for y in along.values.values()))
    groups = _groups(of, states, width)
    every = [state for _, numbers, _ in groups for state in numbers]
    panels: list[Panel] = []
    for n, (name, along) in enumerate(stressed.items()):
        # The same limits for all columns, unless some would fill less than a quarter of them.
        ranges = [along.limits(numbers) for _, numbers, _ in groups]
        low, high = min(y[0] for y in ranges), max(y[1] for y in ranges)
        similar = high - low <= 4.0 * min(y[1] - y[0] for y in ranges)
        for column, (title, numbers, names) in enumerate(groups):
            called = [of.label(i, names) if len(every) > 1 else "" for i in numbers]
            shown = along.shown(of.looks(numbers, names), called, rows=numbers)
            ylim = (low, high) if similar else ranges[column]
            panel = surface_panel(shown, ylim, title="" if n else title)
            panel = choice.measured.over_stress(panel, name, of.units) if choice.measured else panel
            panels.append(replace(panel, y=None) if column and similar else panel)
    columns = len(groups)
    if columns == 1 and width > 4.5 and len(stressed) > 1:  # side by side
        columns = 2
    figure = render(panels, choice.size, columns, explained(*(each.values for each in stressed.values())))
    grey = " (grey)" * any(panel.bands for panel in panels)
    caption = (
        f"Stresses along the surface, under the punch{grey} and beside it{_ENDS[of.scene.body.ends]}"
    )
    if same:
        caption += " Over N/(2a) they are the same under every load."
    caption += alike_at + of.all_at(every) + of.formal(every)
    missing = of.not_shown(every, "--figure surface --states")
    return Drawing("surface", caption, figure, left_out=missing)


def _groups(of: Archive, states: NDArray, width: float) -> list[tuple[str, list[int], list[str]]]:
    """Title, states and parameters that distinguish them, by column."""
    requested = of.choice.states
    states = np.array(requested) if requested else states
    varied = of.varied(states)
    most = max(1, min(_COLUMNS, int(width / _LEAST)))
    by = varied[0] if len(varied) > 1 else ""
    values = of.distinct(by, states) if by else []
    if not by or (requested and len(values) > most):
        names, shown = (varied, states) if requested else states_for_panel(of, varied, states, _CURVES)
        return [("", shown.tolist(), names)]
    groups = []
    for value in spread(values, most) if most > 1 else values[-1:]:
        group, names = of.where(states, **{by: value}), [name for name in varied if name != by]
        if not requested:
            names, group = states_for_panel(of, names, group, _CURVES)
        groups.append((of.label(int(group[0]), [by]), of.ordered(group).tolist(), names))
    return groups


def _of_one_friction(of: Archive, state: int, g: float, X: NDArray) -> NDArray[np.float64]:
    """Pressure over N/(2a) with one friction g, at places X over a half-width a, (n,), of a state."""
    scene, data = of_state(of.scene, state)[0], of.data
    load = float(data[LOAD.path][state]) if LOAD.path in data else scene.punch.load
    body = make_contact(scene.solid, scene.punch.profile, load)
    response = body.response(float(data[SPEED.path][state]))
    contact = half_plane_under_punch(body, response, 1e-4).contact(g)  # as accurate as a drawing
    unit = body.half_width
    half_width, centre = preferred(data, HALF_WIDTH), preferred(data, CENTRE)
    h = data[half_width.path][state] if half_width else unit
    m = data[centre.path][state] if centre else 0.0
    r = ((m + h * X) / unit - contact.centre) / contact.half_width
    return np.asarray(-contact.pressure.σ_YY(r) * h / (contact.half_width * unit))


def friction_along(of: Archive) -> Drawing:
    """Figure of f over X, and of the pressure beside that of uniform friction of the same force."""
    data = of.data
    names, chosen = states_for_panel(of, of.varied(of.selected()), of.selected(), _FEW)
    states, rows = chosen.tolist(), {method: row for method, row in PRESSURE.items() if of.has(row)}
    resultant = next(data[row.path] for row in RESULTANT_RATIO.values() if of.has(row))
    under, scale = np.abs(data[SURFACE_X.path]) < 1.0, of.scaled(next(iter(rows.values())))
    X = data[SURFACE_X.path][under]
    of_states = np.array([_of_one_friction(of, i, float(resultant[i]), X) for i in states])
    uniform = scale.of(of_states, states)
    pressures = {method: -of.values(row)[states][:, under] for method, row in rows.items()}
    g = of.scene.friction.stress_ratio * data[RATIO_ALONG.path][states][:, under]
    over = {  # at a free end one of the two ends before the other
        method: np.divide(p, uniform, out=np.full_like(p, np.nan), where=uniform > 0.0)
        for method, p in pressures.items()
    }
    where = places_of(of, states), position_name(of, "position ")
    styles, dotted = of.looks(states, names), LINES[3]
    f = Along(X, "friction coefficient $f$", {CLOSED_FORM: g}, *where)
    pressure = Along(X, named(SHOWN["sigma_YY"][0], scale.unit), pressures, *where)
    beside = replace(pressure, values={CLOSED_FORM: uniform})
    shown_beside = beside.shown([look._replace(line=dotted) for look in styles], width=0.7)
    ratio = Along(X, "pressure over that of uniform $f$", over, *where)
    panels = [
        surface_panel(f.shown(styles, [of.label(i, names) for i in states])),
        surface_panel([*pressure.shown(styles), *shown_beside]),
        surface_panel(ratio.shown(styles), at_y=(1.0,)),
    ]
    panels[0] = replace(panels[0], ylim=None)
    notes = [
        *explained(pressures),
        note(Look(GREY, dotted, ""), "dotted: uniform $f$ of the same force"),
    ]
    figure = render(panels, of.choice.size, 0 if of.choice.size else 3, notes, 0.8)
    caption = (
        "Friction along the contact, and the contact pressure beside that of uniform friction of the "
        "same force (dotted). At each end the pressure has the exponent of the friction there."
    )
    missing = of.not_shown(states, "--figure along --states")
    return Drawing("along", caption, figure, left_out=missing)


#: What axes call stresses, and which of them share one: both sides of an interface, with their lines.
_AT_INTERFACES = {
    ("sigma_YY",): r"normal traction $\sigma_{YY}$",
    ("sigma_XY",): r"shear traction $\sigma_{XY}$",
    ("sigma_XX_above", "sigma_XX_below"): r"in-plane stress $\sigma_{XX}$",
}
_SIDES = {"above": "-", "below": (0, (4.0, 1.5))}


def interfaces(of: Archive) -> Drawing:
    """Figure of stresses along interfaces: a column for each interface, or for some of many."""
    choice = of.choice
    available = of.by_method(STATE, INTERFACE, ALONG)
    every = (of.values(row) for rows in available.values() for row in rows.values())
    states, same = of.once(of.selected(), *every)
    width = choice.size.width if choice.size else PAGE
    names = of.varied(states)
    if not choice.states:
        names, states = states_for_panel(of, names, states, _FEW)
    numbers = of.ordered(states).tolist()
    styles = looks(len(numbers), len(names) == 1 and of.numeric(names[0]))
    called = [of.label(i, names) if len(numbers) > 1 else "" for i in numbers]
    unit, depths = interface_depths(of.data)
    bodies = [of_state(of.scene, i)[0].body for i in (numbers if len(depths) > 1 else [0])]
    depths = depths[numbers] if len(depths) > 1 else depths
    over_a = np.max([d if unit == "1" else d / b.half_width for d, b in zip(depths, bodies)], axis=0)
    scale, in_a = of.units.scale(CONTACT), unit == "1"
    factor, length = np.max(scale.factor) * (bodies[0].half_width if in_a else 1.0), scale.unit
    if of.units.dimensionless:
        factor, length = (1.0, "$a$") if in_a else (1e3, "mm")
    titles = [
        f"depth {number(depth * factor)} {length}" if same else f"interface {i}"
        for i, (depth, same) in enumerate(zip(depths[0], np.ptp(depths, axis=0) == 0.0), 1)
    ]
    columns = spread(range(len(over_a)), max(1, int(width / 2.2)))
    position = position_name(of, "position along the interface ")
    shown = [require_one_of("quantity", name, available) for name in choice.quantities or available]
    X, places = of.data[ALONG_X.path], places_of(of, of.all)
    panels: list[Panel] = []
    notes, methods = list[Any](), set[str]()
    for of_sides, words in _AT_INTERFACES.items():
        sides = [name.rpartition("_")[2] for name in of_sides if name in shown]
        rows = [available[name] for name in of_sides if name in shown]
        values = [{method: of.values(row) for method, row in by_method.items()} for by_method in rows]
        methods.update(*rows)
        if rows and len(of_sides) > 1:
            notes = [note(Look(GREY, _SIDES[side], ""), f"{side} the interface") for side in sides]
        for i in columns if rows else ():
            drawn: list[Shown] = []
            axis = named(words, of.scaled(next(iter(rows[0].values()))).unit) if i == columns[0] else ""
            half = max(2.0, 2.5 * float(over_a[i]))  # stresses spread with the depth
            for side, by_method in zip(sides, values):
                own = {method: y[:, i] for method, y in by_method.items()}
                along = Along(X, axis, own, places, position, half)
                on_side = [look._replace(line=_SIDES.get(side, "-")) for look in styles]
                drawn += along.shown(on_side, called if side == sides[0] else (), rows=numbers)
            title = titles[i] if len(panels) < len(columns) else ""
            panels.append(replace(surface_panel(drawn, title=title), ylim=None))
    across_ = len(panels) if len(columns) == 1 and width > 4.5 else len(columns)
    grey = "grey, all contacts together" if any(len(panel.bands) > 1 for panel in panels) else "grey"
    caption = (
        f"Stresses along the interfaces, under the punch ({grey}) and beside it: tractions, which both "
        "sides share, and in-plane stress, which jumps: above solid, below dashed."
    )
    if len(columns) < len(over_a):
        caption += f" {len(columns)} of {len(over_a)} interfaces are shown; a wider --size shows more."
    caption += same + of.all_at(numbers)
    missing = of.not_shown(numbers, "--figure interfaces --states")
    figure = render(panels, choice.size, across_, notes + explained(methods))
    return Drawing("interfaces", caption, figure, left_out=missing)


#: Names of the stresses that maps show by default.
_MAPS = {
    "von_mises": r"von Mises $\sigma_{\mathrm{vM}}$",
    "sigma_XX": r"in-plane $\sigma_{XX}$",
    "sigma_YY": r"normal $\sigma_{YY}$",
    "sigma_XY": r"shear $\sigma_{XY}$",
    "max_shear": r"largest shear $\tau_{\mathrm{max}}$",
}
#: What names of quantities in an elastic punch begin with.
_PUNCH = "punch_"
_NO_DEPTHS = np.empty(0)
#: The stress that no archive has, and those that it follows from.
_SHEAR, _COMPONENTS = "max_shear", ("sigma_XX", "sigma_YY", "sigma_XY")


class Fields:
    """Stresses inside on the grid of an archive."""

    def __init__(self, of: Archive) -> None:
        self._of, self._shape = of, tuple(of.data[stresses.MAP.path].tolist())
        self._rows = of.by_method(STATE, INSIDE)
        below = [rows for name, rows in self._rows.items() if not name.startswith(_PUNCH)]
        self.methods = [method for method in METHODS if any(method in rows for rows in below)]
        X, Y = (self._on_grid(of.data[row.path]) for row in (stresses.INSIDE_X, stresses.INSIDE_Y))
        #: Positions over a along both axes.
        self.X, self.Y = X[0], Y[:, 0]

    @property
    def names(self) -> list[str]:
        """Names of all stresses inside that can be mapped."""
        every = [*self._rows, *[_SHEAR] * (self._rows.keys() >= {*_COMPONENTS})]
        return [name for name in every if not name.startswith(_PUNCH)]

    def values(self, name: str, method: str, states: Sequence[int], body: str = "") -> NDArray | None:
        """A stress of states below the punch, or in the body "punch_", in the figure's units, (states,
        rows, columns); None where there is none."""
        of, states = self._of, list(states)
        names = _COMPONENTS if name == _SHEAR else (name,)
        rows = [row for one in names if (row := self._rows.get(body + one, {}).get(method))]
        if len(rows) < len(names):
            return None
        each = [of.scaled(row).of(self._on_grid(of.data[row.path][states]), states) for row in rows]
        return maximum_shear(*each) if name == _SHEAR else each[0]

    def above(self, name: str, method: str, state: int) -> tuple[NDArray, NDArray] | None:
        """A stress of a state in an elastic punch at -Y, and its strength; None without."""
        values = self.values(name, method, [state], _PUNCH)
        if values is None:
            return None
        return values[0], self._level(name, [of_state(self._of.scene, state)[0].solid.punch_strength])

    def _level(
        self, name: str, strengths: Sequence[float | None], depths: NDArray = _NO_DEPTHS
    ) -> NDArray[np.float64]:
        """Yield strength at every Y in the figure's units where a map shows von Mises stresses, (rows,);
        infinite where there is none.

        Args:
            name: of the stress.
            strengths: of bodies from the surface down [Pa].
            depths: where they meet, over a.
        """
        units = self._of.units
        if name != "von_mises" or units.dimensionless:
            return np.full(len(self.Y), np.inf)
        limits = np.array([strength or np.inf for strength in strengths])
        factor = float(np.max(units.stress.factor * 2.0 * units.half_width / units.load))
        return factor * limits[np.searchsorted(depths, -self.Y)]

    def label(self, name: str) -> str:
        """Label of the colour bar of a quantity."""
        row = next(iter((self._rows.get(name) or self._rows[self.names[0]]).values()))
        return named(_MAPS.get(name) or short_name(row), self._of.scaled(row).unit)

    def panels(self, name: str, states: Sequence[int], **options: Any) -> list[Panel]:
        """A panel for each of some states by the first method, all with the same colours, and a black bar
        for the punch above each.

        Args:
            name: of the stress.
            states: numbers of states.
            options: further attributes of the maps.
        """
        of, values, panels = self._of, self.values(name, self.methods[0], states), list[Panel]()
        assert values is not None
        # The largest values, at the edges of the punch, would leave no colours for the rest.
        limit = float(np.quantile(np.abs(values), 0.985)) or 1.0
        x, half_widths = position_name(of, ""), np.broadcast_to(of.units.half_width, len(of.all))
        for i, (a, b), grid in zip(states, places_of(of, states), values):
            body = of_state(of.scene, i)[0].body
            depths = body.solid.depths / half_widths[i]  # of the lower faces of layers
            shown: dict[str, Any] = {
                "signed": name.startswith("sigma"), "label": self.label(name),
                "level": self._level(name, body.strengths, depths),
            }  # fmt: skip
            drawn = Map(b + a * self.X, a * self.Y, grid, limit=limit, **shown | options)
            heights = (-a * depths).tolist()
            panels.append(Panel(x, x.replace("X", "Y"), map=drawn, bar=(b - a, b + a), dashes=heights))
        return panels

    def _on_grid(self, values: NDArray) -> NDArray:
        return values[..., : np.prod(self._shape)].reshape(*values.shape[:-1], *self._shape)


def inside(of: Archive) -> Drawing:
    """Figure of maps of stresses at the slowest and the fastest speed."""
    fields, choice, size = Fields(of), of.choice, of.choice.size
    names = [require_one_of("quantity", name, fields.names) for name in choice.quantities]
    names = names or [name for name in _MAPS if name in fields.names]
    varied, states = of.varied(), list(choice.states)
    if not states:  # first and last of the parameter that varies most slowly
        every = of.selected()
        every = of.where(every, **of.fixed(varied[1:], every))
        states = sorted({int(every[0]), int(every[-1])})
    alone, wide = len(names) == len(states) == 1, len(states) > 1
    swept = [name for name in varied if name not in (PLACE, STROKE)]
    apart = of.varied(states) or swept or [C] * alone
    if size is None and not wide:
        size = Size(COLUMN if len(names) < 3 else PAGE)
    method, *others = fields.methods
    panels, maps, off = list[Panel](), list[Map](), 0.0
    for n, name in enumerate(names):
        every = fields.panels(name, states, lines=alone)
        drawn = [panel.map for panel in every if panel.map]
        values, limit = np.array([shown.values for shown in drawn]), drawn[0].limit
        low, high = name.startswith("sigma") and values.min() < -limit, values.max() > limit
        extend = ("neither", "max", "min", "both")[2 * int(low) + int(high)]
        for other in others:
            beside = fields.values(name, other, states)
            off = max(off, float(np.abs(beside - values).max() / np.abs(values).max()))
        for k, (state, panel, shown) in enumerate(zip(states, every, drawn)):
            label, above = shown.label * (k == len(states) - 1), fields.above(name, method, state)
            maps.append(replace(shown, extend=extend, above=above, label=label))
            panels.append(replace(
                panel, map=maps[-1], x=panel.x if not wide or n == len(names) - 1 else None,
                y=panel.y if k == 0 else None,
                title=of.label(state, apart) if n == 0 or not wide else "",
            ))  # fmt: skip
    both = any(m.above for m in maps)
    bodies = [body for m in maps for body in ((m.values, m.level), m.above) if body]
    yields = any((values > level[:, None]).any() for values, level in bodies)
    xlim, ylim = (min(m.X[0] for m in maps), max(m.X[-1] for m in maps)), min(m.Y[0] for m in maps)
    panels = [replace(panel, xlim=xlim, ylim=(ylim, -ylim if both else 0.0)) for panel in panels]
    columns = len(states) if wide else across(size.width, len(names), 2.4) if size else 1
    fixed = [name for name in of.parameters if name not in of.varied(states)]
    caption = (
        f"Stresses inside {'both bodies, above the contact' if both else 'below the punch'} (black bar)"
        f"{' the punch as a half-plane' * both}, {METHODS[method]}, at "
        f"{of.text(states[0], fixed)}. They spread from the edges; beyond an arrow at the end of a "
        "bar its colours are clipped."
    )
    caption += " Dashed lines are the interfaces." * any(panel.dashes for panel in panels)
    caption += f" Within the white line {'a body' if both else 'the solid'} would yield." * yields
    if off:
        caption += (
            f" Finite elements differ by at most {plain(f'${number(off, 2)}$')} of the largest value."
        )
    how = f"--figure inside --states{'' if alone else ', single maps with --quantity'}"
    missing = of.not_shown(states, how)
    return Drawing("inside", caption, render(panels, size, columns), True, missing)


def map_names(of: Archive) -> list[str]:
    """Names of the stresses that an archive has maps of."""
    return Fields(of).names if of.has(stresses.MAP) and of.by_method(STATE, INSIDE) else []


#: Names of the stresses that an archive has for a figure, by the figure's name.
NAMES: dict[str, Callable[[Archive], Collection[str]]] = {
    "surface": lambda of: of.by_method(STATE, POINT),
    "interfaces": lambda of: of.by_method(STATE, INTERFACE, ALONG),
    "inside": map_names,
}
