"""Numbers of an archive's states over what is swept, over the angle of the solid, and over the
thickness of the uppermost layer.

Numbers over a sweep are those of the archive; two swept numbers make maps. Over the angle of the solid
the closed form gives the speed limit, and the exponents and K_I of sharp edges, or contacts with free
ends. Over the thickness of the uppermost layer the integral equation gives K_I, and the largest stresses
along the layer's lower face.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import Quantity, column, layers, states, stresses, validity, yielding
from galinx.postprocess.quantities.quantity import FEM, METHODS, SIE, STATE
from galinx.postprocess.quantities.states import FRICTION, VELOCITY
from galinx.solvers.contact import layered as on_layers
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.solution import FLAT, FREE, ONE_FREE, PRESCRIBED, SHARP, Contact, Places, Task
from galinx.solvers.contact.stresses import NEAR
from galinx.solvers.contact.uniform import contacts
from galinx.solvers.errors import SolveError
from galinx.texts import number, plain

from ..errors import BadInput
from ..plan.plan import interface_grid, surface_grid
from .choice import Archive, Drawing, both, explained, named, require_one_of
from .render import Curve, Map, Panel, render
from .states import PLACE, C, N, StateLabels, not_shown, spread
from .stresses import replace_unit, short_name
from .style import COLUMN, looks

#: Values of a parameter that make a curve, and those of two that make a map; curves that can be told
#: apart, and panels of a page.
_VALUES, _OF_MAP, _CURVES, _PANELS = 3, 5, 6, 12
#: Relative change below which numbers count as constant or, up to a factor, as those of another column.
_SAME = 1e-5
#: Axes are logarithmic where numbers span more than this, that of the parameter where it spans more than
#: that, by steps that are equal ratios rather than differences.
_DECADES, _RATIOS = 200.0, 30.0


def _names(*rows: Quantity) -> list[str]:
    return list(dict.fromkeys(row.path.rpartition("/")[2] for row in rows))


#: Where answers do not hold, and the speed once more: drawn on request only.
_LIMITS = set(_names(
    VELOCITY, validity.CROSSINGS, *validity.SLIP_REVERSED, *validity.STRAIN,
    *validity.TENSION.values(), *validity.TENSION_X.values(),
))  # fmt: skip
#: Largest shear at any interface, which is no column of its own.
_INTERFACE_SHEAR = "interface_shear"
#: What people ask for: drawn by itself where there is any of it.
_ANSWERS = [
    *_names(*states.LARGEST.values(), *stresses.HIGHEST.values(), *yielding.VON_MISES.values()),
    _INTERFACE_SHEAR, *_names(*states.HALF_WIDTH.values()),
]  # fmt: skip
#: Another name of the speed, in m/s.
_SPEED = "speed"


@dataclass(frozen=True)
class Column:
    """Numbers of the states under one name, by each method, (states,), with the name of their axis."""

    about: str
    unit: str
    values: dict[str, NDArray]

    @property
    def best(self) -> NDArray:
        """Numbers of the states, not by finite elements where there are others."""
        return self.values[next((method for method in self.values if method != FEM), FEM)]


@dataclass(frozen=True)
class Sweep:
    """Curves of a figure: columns that are drawn, their parameter, and the states of each curve.

    Attributes:
        name, label, x: the parameter, the name of its axis, and its numbers, (states,).
        beside: second axis of the speed; None for none.
        by: name of the parameter that distinguishes curves, "" for one curve.
        groups: label and states of each curve.
        fixed: other parameters that differ between states, and the values at which they are held.
        drawn: names of columns.
        same: names of columns that are constant, or proportional to a drawn one.
        more: names of columns for which a page has no room, or which nobody asked for.
    """

    name: str
    label: str
    x: NDArray
    beside: tuple[str, float] | None
    by: str
    groups: list[tuple[str, NDArray]]
    fixed: dict[str, Any]
    drawn: list[str]
    same: list[str]
    more: list[str]

    @property
    def states(self) -> NDArray[np.int64]:
        """Numbers of all states that are drawn."""
        return np.concatenate([states for _, states in self.groups])


def has_parameters(of: Archive) -> bool:
    """Return True if something that is swept changes a number, or if the chosen axes can be drawn."""
    choice = of.choice
    if choice.x or choice.y or choice.by:
        return bool(columns_of(of))
    return bool(_swept(of.labels, of.selected())) and bool(sweep_of(of).drawn)


def parameters(of: Archive) -> Drawing:
    """Figure of the numbers of states that vary, over a swept parameter; maps over two.

    Raises:
        BadInput: the states differ in no number, or nothing varies with it.
    """
    columns, sweep = columns_of(of), sweep_of(of)
    if not sweep.drawn:
        raise BadInput(f"--x: no number of the states varies with it; --y takes {', '.join(columns)}")
    grid = _grid(of, sweep)
    panels = _maps(of, sweep, columns, *grid) if grid else _curves(of, sweep, columns)
    methods = {method for name in sweep.drawn for method in columns[name].values}
    size = of.size
    if size is None and len(panels) == 1:
        from .render import Size

        size = Size(COLUMN)
    figure = render(panels, size, notes=[] if grid else explained(methods), high=0.72)
    at = f" at {of.labels.text(int(sweep.states[0]), list(sweep.fixed))}" if sweep.fixed else ""
    caption = f"What follows from {plain(sweep.label)}{at}."
    if sweep.same:
        caption += f" Not drawn, being constant or the same up to a factor: {', '.join(sweep.same)}."
    left_out = "" if grid else not_shown(
        of.labels, sweep.states.tolist(), "--states, --x and --by", of.choice.states
    )  # fmt: skip
    if sweep.more:
        left_out += f" Drawn by --y alone: {', '.join(sweep.more)}."
    return Drawing("parameters", caption, figure, left_out=left_out.strip())


def _curves(of: Archive, sweep: Sweep, columns: dict[str, Column]) -> list[Panel]:
    ordered = not sweep.by or of.labels.numeric(sweep.by)
    styles, panels = looks(len(sweep.groups), ordered), []
    logarithmic = "x" * (_spans(sweep.x[sweep.states], _RATIOS) and _by_ratios(sweep.x[sweep.states]))
    for name in sweep.drawn:
        shown, curves = columns[name], []
        for k, ((label, numbers), look) in enumerate(zip(sweep.groups, styles)):
            order = numbers[np.argsort(sweep.x[numbers], kind="stable")]
            values = {method: y[order] for method, y in shown.values.items()}
            label = label if len(sweep.groups) > 1 else ""
            curves += both(sweep.x[order], values, look, label, k / len(styles))
            if len(order) == 1:  # no line: a place of its own
                curves = [replace(curve, form="markers") for curve in curves]
        every = np.concatenate([curve.y for curve in curves])
        crosses = np.nanmin(every) < 0.0 < np.nanmax(every)
        panels.append(Panel(
            sweep.label, shown.about, shown.unit, curves, log=logarithmic + "y" * _spans(every, _DECADES),
            at_y=(0.0,) if crosses else (), beside=sweep.beside,
        ))  # fmt: skip
    return panels


def _grid(of: Archive, sweep: Sweep) -> tuple[list[Any], list[Any], NDArray] | None:
    """Values of two swept numbers, and the state of each pair, (values, others); None for curves."""
    labels, choice = of.labels, of.choice
    if not sweep.by or sweep.name not in labels.parameters or not labels.numeric(sweep.by) or choice.by:
        return None
    free = [name for name in labels.varied(of.selected()) if name not in (sweep.name, sweep.by)]
    every = labels.where(of.selected(), **labels.fixed(free, of.selected()))
    across, up = (labels.distinct(name, every) for name in (sweep.name, sweep.by))
    if (
        min(len(across), len(up)) < _OF_MAP
        or len(every) != len(across) * len(up)
        or PLACE in (sweep.name, sweep.by)
    ):
        return None
    numbers = np.zeros((len(up), len(across)), dtype=int)
    for state in every.tolist():
        place = (up.index(labels.values(sweep.by)[state]), across.index(labels.values(sweep.name)[state]))
        numbers[place] = state
    return across, up, numbers


def _maps(
    of: Archive, sweep: Sweep, columns: dict[str, Column], across: Any, up: Any, numbers: Any
) -> list[Panel]:
    x, y = sweep.x[numbers[0]], _axis(of, sweep.by)[1][numbers[:, 0]]
    panels = []
    for name in sweep.drawn:
        shown = columns[name]
        values = shown.best[numbers]
        # On a grid of equal steps, as pictures are.
        X, Y = np.linspace(x[0], x[-1], 4 * len(x)), np.linspace(y[0], y[-1], 4 * len(y))
        fine = np.array([np.interp(X, x, row) for row in values])
        fine = np.array([np.interp(Y, y, row) for row in fine.T]).T
        limit = float(np.nanmax(np.abs(fine))) or 1.0
        signed = bool(np.nanmin(fine) < -1e-9 * limit)
        panels.append(Panel(
            sweep.label, _axis(of, sweep.by)[0], xlim=(X[0], X[-1]), ylim=(Y[0], Y[-1]),
            map=Map(
                X, Y, fine, named(shown.about, shown.unit), limit, signed=signed, lines=True, equal=False
            ),
        ))  # fmt: skip
    return panels


def sweep_of(of: Archive) -> Sweep:
    """What is drawn of an archive's states over which parameter."""
    choice, data, labels = of.choice, of.data, of.labels
    columns, selected = columns_of(of), of.selected()
    name, label, beside, x = _over(of, choice.x, selected)
    by = _by(labels, choice.by, name, selected)
    free = [name, by] if name in labels.parameters else [by, *labels.varied()]
    fixed = labels.fixed([other for other in labels.varied(selected) if other not in free], selected)
    groups = _groups(labels, by, labels.where(selected, **fixed))
    selected = np.concatenate([numbers for _, numbers in groups])
    same: list[str] = []
    more: list[str] = []
    if choice.y:
        drawn = [require_one_of("y", y, columns) for y in choice.y]
    else:
        # Along strokes friction is drawn as a loop.
        elsewhere = [x] if name != PLACE else [x, data[FRICTION.path]]
        excluded = {name, *_LIMITS}
        numbers = {key: column.best[selected] for key, column in columns.items() if key not in excluded}
        changing = {key for key in numbers if any(_varies(columns[key].best[of_]) for _, of_ in groups)}
        asked = [key for key in _ANSWERS if key in changing]
        if asked:
            asked += [key for key in ("K_I_left", "K_I_right") if key in changing]
            drawn, more = asked, [key for key in columns if key in changing and key not in asked]
        else:
            order = sorted(numbers, key=lambda key: -len(columns[key].values))
            drawn, same = _apart(numbers, order, changing, [values[selected] for values in elsewhere])
    most = len(choice.y) or _PANELS
    return Sweep(name, label, x, beside, by, groups, fixed, drawn[:most], same, [*drawn[most:], *more])


def columns_of(of: Archive, method: str | None = None) -> dict[str, Column]:
    """Columns of an archive by name: quantities with one number a state, except for error estimates."""
    columns = {}
    for name, rows in of.by_method(STATE, method=method).items():
        first = next(iter(rows.values()))
        if all(row.accuracy for row in rows.values()) or not first.path.startswith(column("")):
            continue
        scaled = of.scaled(first)
        values = {m: np.asarray(scaled.of(of.data[row.path]), dtype=float) for m, row in rows.items()}
        label = _label(first) + " over $a$" * (
            "over the half-width" in first.about and of.units.dimensionless
        )
        columns[name] = Column(label, "" if scaled.unit in ("1", "none") else scaled.unit, values)
    shear = {m: rows[4:8] for m, rows in layers.INTERFACE_EXTREMES.items() if of.has(rows[4], rows[6])}
    if shear:
        unit = of.scaled(next(iter(shear.values()))[0]).unit
        values = {
            m: np.nanmax([np.abs(of.values(row)).max(axis=1) for row in (rows[0], rows[2])], axis=0)
            for m, rows in shear.items()
        }
        columns[_INTERFACE_SHEAR] = Column("largest shear at an interface", unit, values)
    return columns


def _label(row: Quantity) -> str:
    """Name of a quantity for an axis, with formulas in TeX."""
    from re import sub

    text = sub(r"\bX = (-?a)\b", r"$X = \1$", short_name(row))
    text = text.replace("sigma_XX", r"$\sigma_{XX}$")
    if row.symbol:
        text = f"{text.removesuffix(plain(f'${row.symbol}$')).strip()} ${row.symbol}$"
    return text


def _swept(labels: StateLabels, selected: NDArray) -> list[str]:
    """Names of numeric parameters with enough values for a curve, those with most values first."""
    counts = {
        name: len(labels.distinct(name, selected)) for name in labels.parameters if labels.numeric(name)
    }
    return sorted((name for name in counts if counts[name] >= _VALUES), key=lambda name: -counts[name])


def _axis(of: Archive, name: str) -> tuple[str, NDArray]:
    """Name of the axis of a parameter, and its numbers, (states,)."""
    labels = of.labels
    row = labels.parameters[name]
    symbol, factor, unit = labels.scale(name)
    about = f"speed ${symbol}$" if name == C and unit != "1" else _label(row)
    return named(about, unit), factor * labels.values(name)


def _over(
    of: Archive, requested: str, selected: NDArray
) -> tuple[str, str, tuple[str, float] | None, NDArray]:
    """Parameter or quantity that curves are drawn over: its name, that of its axis, a second axis, and
    numbers, (states,)."""
    labels, columns = of.labels, columns_of(of, method="")
    numeric = [name for name in labels.parameters if labels.numeric(name)]
    if requested:
        require_one_of("x", requested, [*numeric, _SPEED, *columns])
    swept = _swept(labels, selected) or labels.varied(selected)
    name = (
        C if requested == _SPEED else requested or next((name for name in swept if name in numeric), "")
    )
    if not name:
        raise BadInput("--x: the states differ in no number; name one of " + ", ".join(numeric))
    if name not in labels.parameters:
        return name, named(columns[name].about, columns[name].unit), None, columns[name].best
    label, values = _axis(of, name)
    if requested == _SPEED and of.units.dimensionless:
        return name, "speed $V$ (m/s)", None, labels.values(C) * labels.c_s
    beside = ("speed (m/s)", labels.c_s) if name == C and of.units.dimensionless else None
    return name, label, beside, values


def _by(labels: StateLabels, requested: str, x: str, selected: NDArray) -> str:
    """Name of the parameter that distinguishes the curves; "" for one curve."""
    varied = [name for name in labels.varied(selected) if name != x]
    if requested:
        return require_one_of("by", requested, varied)
    law = [name for name in varied if name in (C, N, *labels.law)]
    # Places are the strokes' only where nothing else is swept.
    return next(iter([*law, *varied]), "")


def _groups(labels: StateLabels, by: str, selected: NDArray) -> list[tuple[str, NDArray]]:
    """Label and states of each curve."""
    if not by:
        return [("", selected)]
    values = spread(labels.distinct(by, selected), _CURVES)
    groups = [labels.where(selected, **{by: value}) for value in values]
    return [(labels.label(int(numbers[0]), [by]), numbers) for numbers in groups]


def _apart(
    numbers: dict[str, NDArray], order: Sequence[str], changing: set[str], elsewhere: list[NDArray]
) -> tuple[list[str], list[str]]:
    """Names of numbers that differ from each other, in the order of ``numbers``, and all other names."""
    drawn: list[str] = []
    for name in order:
        twins = [*elsewhere, *(numbers[other] for other in drawn)]
        if name in changing and not any(_proportional(numbers[name], other) for other in twins):
            drawn.append(name)
    return [name for name in numbers if name in drawn], [name for name in numbers if name not in drawn]


def _varies(values: NDArray) -> bool:
    finite = values[np.isfinite(values)]
    return len(finite) > 1 and np.ptp(finite) > _SAME * np.abs(finite).max()


def _proportional(first: NDArray, second: NDArray) -> bool:
    sizes = np.abs(first).max(), np.abs(second).max()
    if not all(0.0 < size < np.inf for size in sizes):
        return False
    first, second = first / sizes[0], second / sizes[1]
    return any(np.allclose(first, sign * second, rtol=0.0, atol=_SAME) for sign in (1.0, -1.0))


def _spans(values: NDArray, more_than: float) -> bool:
    finite = values[np.isfinite(values)]
    return bool(len(finite) and finite.min() > 0.0 and finite.max() > more_than * finite.min())


def _by_ratios(x: NDArray) -> bool:
    """True where the middle number lies midway by ratios, rather than by differences."""
    low, middle, high = np.quantile(np.unique(x[np.isfinite(x)]), (0.0, 0.5, 1.0))
    return bool(middle**2 < (low * high) ** 0.5 * (low + high) / 2.0)


#: Angles that are drawn [°]; a half turn leaves a solid as it is.
_ANGLES = np.arange(0.0, 181.0, 3.0)


def has_angles(of: Archive) -> bool:
    """Return True if the scene's solid has an angle."""
    return any(field.name == "angle" for field in fields(of.scene.solid))  # type: ignore[arg-type]


def angles(of: Archive) -> Drawing:
    """Figure over the angle of the solid, under the archive's steepest friction at its fastest speed."""
    data, scene = of.data, of.scene
    g = data[states.RATIO.path]
    steepest = float(g[np.argmax(np.abs(g))])
    V = float(data[states.SPEED.path].max()) * scene.solid.c_s
    turned: list[Any] = [replace(scene.solid, angle=angle) for angle in _ANGLES.tolist()]  # type: ignore[type-var]
    limits = np.array([solid.limit() * solid.c_s for solid in turned])
    bodies = [replace(scene.body, solid=solid) for solid in turned]
    more, what = _OVER_ANGLE[scene.body.ends](of, bodies, V, steepest)
    shown = [("speed limit (m/s)", {"": limits}), *more]
    panels = [
        Panel(
            "angle of the first axis from $X$ (°)", title, xlim=(0.0, 180.0), own_legend=len(curves) > 1,
            ylim=(0.0, 1.08 * max(np.nanmax(values, initial=1e-9) for values in curves.values())),
            curves=[
                Curve(_ANGLES, values, look, label)
                for (label, values), look in zip(curves.items(), looks(len(curves)))
            ],
            at_x=(float(scene.solid.angle) % 180.0,),  # type: ignore[attr-defined]
        )
        for title, curves in shown
    ]  # fmt: skip
    caption = (
        f"The solid turned under the punch, closed form at {number(V)} m/s and σ_XY/σ_YY = "
        f"{number(steepest)}: over the angle from X to its first axis the speed of the wave along its "
        f"surface, {what}. "
        "The grey line is the angle of the archive; where there is no curve the solid's limit is slower."
    )
    return Drawing("angles", caption, render(panels, of.size, high=0.72))


_Panels = list[tuple[str, dict[str, NDArray]]]


def _of_edges(of: Archive, bodies: list[Contact], V: float, g: float) -> tuple[_Panels, str]:
    """Panels of -α and -β of sharp edges, and of K_I of a flat punch; and what they show."""
    flat = [_at(body, V, lambda response, body: FlatPunch(response, g)) for body in bodies]

    def each(name: str, sign: float) -> NDArray:
        return np.array([np.nan if punch is None else sign * getattr(punch, name) for punch in flat])

    exponents = {r"$-\alpha$, at $X = a$": each("α", -1.0), r"$-\beta$, at $X = -a$": each("β", -1.0)}
    panels: _Panels = [(r"edge exponents $-\alpha$, $-\beta$", exponents)]
    what = "how strong the pressure's singularity is at either end"
    if FLAT in bodies[0].lacks:
        return panels, what
    return [*panels, ("$K_I$", {"": each("K_I", 1.0)})], f"{what}, and K_I, the same at both"


def _of_contacts(
    of: Archive, bodies: list[Contact], V: float, g: float, nearest: float = 0.0
) -> tuple[_Panels, str]:
    """Panels of half-width, largest pressure and tension, and of the intensity of a sharp end; and what
    they show. Tensions are no nearer to an end than a distance over a."""
    length, unit = replace_unit(of)
    of_pa, stress_unit = (
        (1e-6, "MPa") if of.units.dimensionless else (_of_pascal(of), of.units.stress.unit)
    )

    def numbers(response: Any, body: Contact) -> list[float]:
        contact = contacts(response, np.array([g]), body.profile, body.compression)
        h = float(contact.of("half_width")[0])
        in_pa = body.load / (2.0 * h)
        X = surface_grid()
        X = X[np.abs(np.abs(X) - 1.0) >= nearest]
        tension = in_pa * float(contact.on_surface(X)[0].max())
        pressure = in_pa * float(contact.largest()[0][0])
        return [length * h, of_pa * pressure, of_pa * tension, *contact.of("K_I")[0]]

    rows = [_at(body, V, numbers) for body in bodies]
    h, pressure, tension, K_left, K_right = np.array([row or [np.nan] * 5 for row in rows]).T
    titles = {
        f"half-width ({unit})": h, f"largest pressure ({stress_unit})": pressure,
        f"largest tension ({stress_unit})": tension,
    }  # fmt: skip
    panels: _Panels = [
        (title, {"": values}) for title, values in titles.items() if np.isfinite(values).any()
    ]
    if np.nan_to_num([K_left, K_right]).any():
        ends = {"at $X = a$": K_right, "at $X = -a$": K_left}
        panels.append(("$K_I$", {label: values for label, values in ends.items() if values.any()}))
    what = "half-width, largest pressure and tension on the surface of the contact under"
    return panels, f"{what} {number(1e-3 * bodies[0].load)} N/mm"


def _of_pascal(of: Archive) -> float:
    """What stresses in Pa are multiplied by in a figure."""
    load, half = np.ravel(of.units.load)[0], np.ravel(of.units.half_width)[0]
    return float(np.ravel(of.units.stress.factor)[0] / (load / (2.0 * half)))


#: Panels over the angle, and what they show, by the ends of the contact.
_OVER_ANGLE: dict[str, Callable[[Archive, list[Contact], float, float], tuple[_Panels, str]]] = {
    SHARP: _of_edges,
    PRESCRIBED: _of_edges,
    FREE: _of_contacts,
    ONE_FREE: partial(_of_contacts, nearest=NEAR),  # beside a sharp edge it is infinite
}


def _at(body: Contact, V: float, of: Callable[[Any, Contact], Any]) -> Any:
    """Value of ``of`` for a body at a speed [m/s]; None from the limit on, and without a contact."""
    c = V / body.solid.c_s
    if c >= body.solid.limit():
        return None
    with suppress(SolveError):
        return of(body.solid.response(c), body)
    return None


#: Thicknesses over that of the archive: from the first to the last, so many.
_FIRST, _LAST, _COUNT = 0.1, 10.0, 17
#: The thinnest layer over a that is drawn: thinner ones take the equation many seconds.
_THINNEST = 0.05
#: Relative accuracy: more than a figure shows.
_TOLERANCE = 1e-4
#: Panels, in their order.
_SHOWN = (
    "$K_I$ at $X = -a$",
    "$K_I$ at $X = a$",
    r"largest $-\sigma_{YY}$ below the layer",
    r"largest shear traction $|\sigma_{XY}|$ there",
    r"largest $\sigma_{XX}$ in the layer",
    r"largest $\sigma_{XX}$ below the layer",
)


def has_thicknesses(of: Archive) -> bool:
    """Return True if a punch with sharp edges was solved over uniform layers by the integral equation."""
    scene = of.scene
    solved = any(path.startswith(f"states/{SIE}/") for path in of.data)
    sharp = scene.body.ends == SHARP
    least = _THINNEST * scene.body.half_width
    # Graded ones take a second or two a thickness.
    quick = all(layer.bottom is None and layer.thickness >= least for layer in scene.layers)
    return solved and sharp and bool(scene.layers) and quick


def thicknesses(of: Archive) -> Drawing:
    """Figure over the thickness of the top layer, under the steepest friction at the fastest speed."""
    data, scene = of.data, of.scene
    g = data[states.RATIO.path]
    steepest = float(g[np.argmax(np.abs(g))])
    c = float(data[states.SPEED.path].max())
    top, a = scene.layers[0].thickness, scene.body.half_width
    H = np.geomspace(max(_FIRST * top, _THINNEST * a), _LAST * top, _COUNT)
    numbers = np.full((_COUNT, len(_SHOWN)), np.nan)
    for row, thickness in zip(numbers, H.tolist()):
        body = _with_top(scene.body, thickness)
        with suppress(SolveError):
            if c < body.solid.limit():
                row[:] = _at_thickness(body, c, steepest)
    factor, unit = float(np.ravel(of.units.stress.factor)[0]), of.units.stress.unit
    length, length_unit = (1.0 / a, "") if of.units.dimensionless else replace_unit(of)
    about = "thickness of the uppermost layer"
    label = f"{about} over $a$" if of.units.dimensionless else f"{about} ({length_unit})"
    beside = ("thickness (mm)", 1e3 * a) if of.units.dimensionless else None
    panels = []
    for n, (title, values) in enumerate(zip(_SHOWN, numbers.T)):
        panels.append(Panel(
            label, named(title, unit) if n > 1 else title, log="x", at_x=(length * top,), beside=beside,
            curves=[Curve(length * H, values * (factor if n > 1 else 1.0), looks(1)[0])],
        ))  # fmt: skip
    caption = (
        f"The uppermost layer thinner and thicker, by the {METHODS[SIE]} at "
        f"{number(c * scene.solid.c_s)} m/s and σ_XY/σ_YY = {number(steepest)}: K_I at both ends, and "
        "the largest stresses along the layer's lower face: pressure, the shear that it has to bear, and "
        "σ_XX in the layer and in what is below. The grey line is the archive's; where there is no curve "
        "the limit is slower than the punch, or the equation has no answer."
    )
    return Drawing("thicknesses", caption, render(panels, of.size, high=0.72))


def _with_top(body: Contact, thickness: float) -> Contact:
    top, *others = body.solid.layers
    layers_ = (replace(top, thickness=thickness), *others)
    return replace(body, solid=replace(body.solid, layers=layers_))  # type: ignore[type-var]


def _at_thickness(body: Contact, c: float, g: float) -> NDArray[np.float64]:
    """Numbers of all panels at one thickness, (panels,).

    Raises:
        SolveError: the equation has no answer.
    """
    depths, along = interface_grid(body)
    places = Places(np.empty(0), np.empty((0, 2)), interfaces=depths[:1], along=along)
    response = body.response(c)
    task = Task(0, body, response, places, (), ())
    stack = response.stack(body.half_width)  # type: ignore[attr-defined]
    punch = on_layers.at_speed(task, stack, _TOLERANCE, np.array([g])).states(np.array([g]))
    σ_YY, σ_XY, above, below = punch.interfaces[:, 0, 0]
    return np.array([*punch.K_I[0], -σ_YY.min(), np.abs(σ_XY).max(), above.max(), below.max()])
