"""Single numbers of an archive's states over what its scene sweeps, over the angle of its solid, and over
the thickness of its uppermost layer.

Numbers over a sweep are those of the archive. Over the angle of the solid the closed form gives the speed
limit, and the exponents and K_I of sharp edges, or contacts with free ends. Over the thickness of the
uppermost layer the integral equation gives K_I, and the largest stresses along the layer's lower face.
"""

import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.figures.curves import (
    Line,
    Panel,
    Parameter,
    PolarPanel,
    curves_figure,
    polar_figure,
)
from galinx.postprocess.figures.style import number, plain, unit
from galinx.postprocess.quantities import Quantity, column, states, validity
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, METHODS, SIE, STATE
from galinx.postprocess.quantities.states import FRICTION, VELOCITY
from galinx.postprocess.units import Units, as_archived, contacts_of_states
from galinx.solvers.contact import layered as on_layers
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.solution import FLAT, FREE, ONE_FREE, PRESCRIBED, SHARP, Contact, Places, Task
from galinx.solvers.contact.stresses import NEAR
from galinx.solvers.contact.uniform import contacts
from galinx.solvers.errors import SolveError

from ..errors import BadInput
from ..plan.plan import interface_grid, surface_grid
from ..scene.scene import Scene
from .choice import Choice, Drawing, by_method, require_one_of, short_name
from .state_labels import PLACE, C, N, StateLabels, not_shown, spread

#: Values of a parameter that make a curve, curves that can be distinguished, and panels of a page.
_VALUES, _CURVES, _PANELS = 3, 6, 12

#: Relative change below which numbers count as constant or, up to a factor, as those of another column.
_SAME = 1e-5

#: Where answers do not hold, and the speed once more: drawn on request only.
_LIMITS = {
    row.path.rpartition("/")[2]
    for row in (
        VELOCITY, validity.CROSSINGS, *validity.SLIP_REVERSED, *validity.STRAIN,
        *(row for rows in validity.TENSION.values() for row in rows),
    )
}  # fmt: skip

#: What axes have instead of SI's units: by what numbers are multiplied, and the unit.

#: Another name of the speed, in m/s.
_SPEED = "speed"


@dataclass(frozen=True)
class Column:
    """Numbers of the states under one name, by each method.

    Attributes:
        about: what they are, with symbol.
        unit: in TeX.
        exact, fem: numbers by another method than finite elements, and by these, (states,).
        by: method of ``exact``, "" for none.
    """

    about: str
    unit: str
    exact: NDArray | None
    fem: NDArray | None
    by: str

    @property
    def best(self) -> NDArray:
        """Numbers of the states, (states,), not by finite elements where there are such."""
        values = self.exact if self.exact is not None else self.fem
        assert values is not None
        return values

    @property
    def methods(self) -> int:
        """Number of methods that give these numbers."""
        return (self.exact is not None) + (self.fem is not None)


@dataclass(frozen=True)
class Sweep:
    """Curves of a figure: columns that are drawn, their parameter, and the states of each curve.

    Attributes:
        over, x: the parameter, and its numbers, (states,).
        by: name of the parameter that distinguishes curves, "" for one curve.
        groups: label and states of each curve.
        fixed: other parameters that differ between states, and the values at which they are held.
        drawn: names of columns.
        same: names of columns that are constant, or proportional to a drawn one.
        more: names of columns for which a page has no room.
    """

    over: Parameter
    x: NDArray
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


def has_parameters(data: dict[str, Any], scene: Scene, choice: Choice) -> bool:
    """Return True if something that is swept changes a number, or if the chosen axes can be drawn."""
    labels = StateLabels(data, scene)
    if choice.x or choice.y or choice.by:
        return bool(_columns(data, scene, choice))
    return bool(_swept(labels, _selected(labels, choice))) and bool(
        _sweep(data, scene, labels, choice).drawn
    )


def parameters(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of the numbers of states that vary, over a swept parameter.

    Raises:
        BadInput: the states differ in no number, or nothing varies with it.
    """
    labels, columns = StateLabels(data, scene), _columns(data, scene, choice)
    sweep = _sweep(data, scene, labels, choice)
    if not sweep.drawn:
        raise BadInput(f"--x: no number of the states varies with it; --y takes {', '.join(columns)}")
    panels = [
        Panel(
            columns[name].about,
            [_line(columns[name], label, sweep.x, states) for label, states in sweep.groups],
            columns[name].unit,
        )
        for name in sweep.drawn
    ]
    ordered = not sweep.by or labels.numeric(sweep.by)
    exactly = METHODS[SIE if SIE in {columns[name].by for name in sweep.drawn} else CLOSED_FORM]
    figure = curves_figure(panels, sweep.over, ordered, choice.size, exactly)
    at = f" at {labels.text(int(sweep.states[0]), list(sweep.fixed))}" if sweep.fixed else ""
    caption = f"What follows from {plain(sweep.over.label)}{at}."
    if sweep.same:
        caption += f" Not drawn, being constant or the same up to a factor: {', '.join(sweep.same)}."
    left_out = not_shown(labels, sweep.states.tolist(), "--states, --x and --by", choice.states)
    if sweep.more:
        left_out += f" Drawn by --y alone: {', '.join(sweep.more)}."
    return Drawing("parameters", caption, figure, left_out=left_out.strip())


def _selected(labels: StateLabels, choice: Choice) -> NDArray[np.int64]:
    return np.array(choice.states) if choice.states else labels.all


def _sweep(data: dict[str, Any], scene: Scene, labels: StateLabels, choice: Choice) -> Sweep:
    columns, selected = _columns(data, scene, choice), _selected(labels, choice)
    name, over, x = _over(labels, _columns(data, scene, replace(choice, method="")), choice.x, selected)
    by = _by(labels, choice.by, name, selected)
    free = [name, by] if name in labels.parameters else [by, *labels.varied()]
    fixed = labels.fixed([other for other in labels.varied(selected) if other not in free], selected)
    groups = _groups(labels, by, labels.where(selected, **fixed))
    selected = np.concatenate([states for _, states in groups])
    same: list[str] = []
    if choice.y:
        drawn = [require_one_of("y", y, columns) for y in choice.y]
    else:
        # Along strokes friction is drawn as a loop.
        elsewhere = [x] if name != PLACE else [x, data[FRICTION.path]]
        excluded = {name, *_LIMITS}
        numbers = {key: column.best[selected] for key, column in columns.items() if key not in excluded}
        order = sorted(numbers, key=lambda key: -columns[key].methods)
        changing = {key for key in numbers if any(_varies(columns[key].best[of]) for _, of in groups)}
        drawn, same = _apart(numbers, order, changing, [values[selected] for values in elsewhere])
    most = len(choice.y) or _PANELS
    return Sweep(over, x, by, groups, fixed, drawn[:most], same, drawn[most:])


def _columns(data: dict[str, Any], scene: Scene, choice: Choice) -> dict[str, Column]:
    """Columns of an archive by name: quantities with one number a state, except for error estimates.

    They are in SI on request, and where every state has a half-width of its own: numbers over that could
    not be compared between states.
    """
    columns = {}
    in_units = choice.in_si or contacts_of_states(data) is not None
    units = Units(scene.body, data, not in_units)
    for name, rows in by_method(data, (STATE,), choice.method).items():
        first = next(iter(rows.values()))
        if all(row.accuracy for row in rows.values()) or not first.path.startswith(column("")):
            continue
        by = next((of for of in rows if of != FEM), "")
        scaled = units(first, name) or as_archived(first, name)
        exact, fem = (scaled.of(data[rows[of].path]) if of in rows else None for of in (by, FEM))
        label = _label(first).removesuffix(" over $a$" if scaled.unit != first.unit else "")
        columns[name] = Column(label, unit(scaled.unit).removeprefix(r"\,"), exact, fem, by)
    return columns


def _label(row: Quantity) -> str:
    """Name of a quantity for an axis, with formulas in TeX."""
    text = re.sub(r"\bX = (-?a)\b", r"$X = \1$", short_name(row))
    if row.symbol:
        text = f"{text.removesuffix(plain(f'${row.symbol}$')).strip()} ${row.symbol}$"
    return text


def _swept(labels: StateLabels, selected: NDArray) -> list[str]:
    """Names of numeric parameters with enough values for a curve, those with most values first."""
    counts = {
        name: len(labels.distinct(name, selected)) for name in labels.parameters if labels.numeric(name)
    }
    return sorted((name for name in counts if counts[name] >= _VALUES), key=lambda name: -counts[name])


def _over(
    labels: StateLabels, columns: dict[str, Column], requested: str, selected: NDArray
) -> tuple[str, Parameter, NDArray]:
    """Name, axis and numbers, (states,), of the parameter or quantity that curves are drawn over."""
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
        return name, Parameter(columns[name].about), columns[name].best
    row, values = labels.parameters[name], labels.values(name)
    in_unit = unit(row.unit).removeprefix(r"\,")
    label = _label(row) + (f" $[{in_unit}]$" if in_unit else "")
    if requested == _SPEED:
        return name, Parameter("speed [m/s]"), values * labels.c_s
    return name, Parameter(label, ("speed [m/s]", labels.c_s) if name == C else None), values


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
    return [(labels.label(int(states[0]), [by]), states) for states in groups]


def _line(column: Column, label: str, x: NDArray, states: NDArray) -> Line:
    order = states[np.argsort(x[states], kind="stable")]
    exact, fem = (values if values is None else values[order] for values in (column.exact, column.fem))
    return Line(label, x[order], exact, fem)


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


#: Angles that are drawn [°]; a half turn leaves a solid as it is.
_ANGLES = np.arange(0.0, 181.0, 3.0)


def has_angles(scene: Scene) -> bool:
    """Return True if the scene's solid has an angle."""
    return any(field.name == "angle" for field in fields(scene.solid))  # type: ignore[arg-type]


def angles(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure over the angle of the solid, under the archive's steepest friction at its fastest speed."""
    g = data[states.RATIO.path]
    steepest = float(g[np.argmax(np.abs(g))])
    V = float(data[states.SPEED.path].max()) * scene.solid.c_s
    turned: list[Any] = [replace(scene.solid, angle=angle) for angle in _ANGLES.tolist()]  # type: ignore[type-var]
    limits = np.array([solid.limit() * solid.c_s for solid in turned])
    panels = [PolarPanel("speed limit [m/s]", {"": limits})]
    bodies = [replace(scene.body, solid=solid) for solid in turned]
    more, what = _OVER_ANGLE[scene.body.ends](bodies, V, steepest)
    panels += more
    around = np.concatenate([_ANGLES, _ANGLES[1:] + 180.0])
    twice = [
        PolarPanel(
            panel.title,
            {label: np.concatenate([values, values[1:]]) for label, values in panel.curves.items()},
        )
        for panel in panels
    ]
    caption = (
        f"The solid turned under the punch, closed form at {number(V)} m/s and σ_XY/σ_YY = "
        f"{number(steepest)}: over the angle from X to its first axis the speed of the wave along its "
        f"surface, {what}. "
        "The grey line is the angle of the archive; where there is no curve the solid's limit is slower."
    )
    now = float(scene.solid.angle)  # type: ignore[attr-defined]
    return Drawing("angles", caption, polar_figure(around, twice, now, choice.size))


def _of_edges(bodies: list[Contact], V: float, g: float) -> tuple[list[PolarPanel], str]:
    """Panels of -α and -β of sharp edges, and of K_I of a flat punch; and what they show."""
    flat = [_at(body, V, lambda response, body: FlatPunch(response, g)) for body in bodies]
    at_left, at_right = (
        np.array([np.nan if punch is None else -getattr(punch, name) for punch in flat])
        for name in ("β", "α")
    )
    panels = [
        PolarPanel(
            "$-\\alpha$, $-\\beta$",
            {"$-\\alpha$, at $X = a$": at_right, "$-\\beta$, at $X = -a$": at_left},
        )
    ]
    what = "how strong the pressure's singularity is at either end"
    if FLAT in bodies[0].lacks:
        return panels, what
    K_I = np.array([np.nan if punch is None else punch.K_I for punch in flat])
    return [*panels, PolarPanel("$K_I$", {"": K_I})], f"{what}, and K_I, the same at both"


def _of_contacts(
    bodies: list[Contact], V: float, g: float, nearest: float = 0.0
) -> tuple[list[PolarPanel], str]:
    """Panels of half-width, largest pressure and tension, and of the intensity of a sharp end; and what
    they show. Tensions are no nearer to an end than a distance over a."""

    def numbers(response: Any, body: Contact) -> list[float]:
        contact = contacts(response, np.array([g]), body.profile, body.compression)
        h = float(contact.of("half_width")[0])
        unit = 1e-6 * body.load / (2.0 * h)
        X = surface_grid()
        X = X[np.abs(np.abs(X) - 1.0) >= nearest]
        tension = float(contact.σ_XX(X).max())
        return [1e3 * h, unit * float(contact.largest()[0][0]), unit * tension, *contact.of("K_I")[0]]

    rows = [_at(body, V, numbers) for body in bodies]
    h, pressure, tension, K_left, K_right = np.array([row or [np.nan] * 5 for row in rows]).T
    titles = {"half-width [mm]": h, "largest pressure [MPa]": pressure, "largest tension [MPa]": tension}
    panels = [
        PolarPanel(title, {"": values}) for title, values in titles.items() if np.isfinite(values).any()
    ]
    if np.nan_to_num([K_left, K_right]).any():
        ends = {"at $X = a$": K_right, "at $X = -a$": K_left}
        panels.append(
            PolarPanel("$K_I$", {label: values for label, values in ends.items() if values.any()})
        )
    what = "half-width, largest pressure and tension on the surface of the contact under"
    return panels, f"{what} {number(bodies[0].load)} N/m"


#: Panels over the angle, and what they show, by the ends of the contact.
_OVER_ANGLE: dict[str, Callable[[list[Contact], float, float], tuple[list[PolarPanel], str]]] = {
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
    r"largest $-\sigma_{YY}/(N/2a)$ below the layer",
    r"largest shear traction $|\sigma_{XY}|/(N/2a)$ there",
    r"largest $\sigma_{XX}/(N/2a)$ in the layer",
    r"largest $\sigma_{XX}/(N/2a)$ below the layer",
)


def has_thicknesses(data: dict[str, Any], scene: Scene) -> bool:
    """Return True if a punch with sharp edges was solved over uniform layers by the integral equation."""
    solved = any(path.startswith(f"states/{SIE}/") for path in data)
    sharp = scene.body.ends == SHARP
    least = _THINNEST * scene.body.half_width
    # Graded ones take a second or two a thickness.
    quick = all(layer.bottom is None and layer.thickness >= least for layer in scene.layers)
    return solved and sharp and bool(scene.layers) and quick


def thicknesses(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure over the thickness of the top layer, under the steepest friction at the fastest speed."""
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
    titles: tuple[str, ...] = _SHOWN
    if choice.in_si:
        numbers[:, 2:] *= 1e-6 * scene.body.stress
        titles = tuple(title.replace("/(N/2a)$", "$ [MPa]") for title in _SHOWN)
    panels = [Panel(title, [Line("", H / a, values)]) for title, values in zip(titles, numbers.T)]
    over = Parameter("thickness of the uppermost layer over $a$", ("thickness [mm]", 1e3 * a), top / a)
    caption = (
        "The uppermost layer thinner and thicker, by the integral equation at "
        f"{number(c * scene.solid.c_s)} m/s and σ_XY/σ_YY = {number(steepest)}: K_I at both ends, and "
        "the largest stresses along the layer's lower face: pressure, the shear that it has to bear, and "
        "σ_XX in the layer and in what is below. The grey line is the archive's; where there is no curve "
        "the limit is slower than the punch, or the equation has no answer."
    )
    return Drawing("thicknesses", caption, curves_figure(panels, over, size=choice.size))


def _with_top(body: Contact, thickness: float) -> Contact:
    top, *others = body.solid.layers
    layers = (replace(top, thickness=thickness), *others)
    return replace(body, solid=replace(body.solid, layers=layers))  # type: ignore[type-var]


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
