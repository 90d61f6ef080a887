"""Numbers of an archive's states over what is swept; over two swept numbers they are maps."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import Quantity, column, layers, states, stresses, validity, yielding
from galinx.postprocess.quantities.quantity import FEM, STATE
from galinx.postprocess.quantities.states import FRICTION, VELOCITY
from galinx.texts import plain

from ..errors import BadInput
from .choice import (
    PLACE,
    Archive,
    C,
    Drawing,
    N,
    StateLabels,
    both,
    explained,
    named,
    not_shown,
    require_one_of,
    short_name,
    spread,
)
from .render import Map, Panel, Size, render
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
    """Numbers of an archive's states to draw, and the parameter they are drawn over."""
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
