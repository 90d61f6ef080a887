"""Numbers of an archive's states over what is swept; over two swept numbers they are maps."""

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import Quantity, column, layers, states, stresses, validity, yielding
from galinx.postprocess.quantities.quantity import FEM, STATE
from galinx.postprocess.quantities.states import VELOCITY
from galinx.texts import plain

from ..errors import BadInput, require_one_of
from .choice import PLACE, Archive, C, Drawing, N, both, explained, named, short_name, spread
from .render import DOTS, MARKERS, Curve, Map, Panel, Size, render
from .style import COLUMN, Look, looks

#: Relative change below which numbers count as constant.
_SAME = 1e-5


def _names(*rows: Quantity) -> list[str]:
    return list(dict.fromkeys(row.path.rpartition("/")[2] for row in rows))


#: Where answers do not hold, and the speed once more: drawn on request only.
_LIMITS = _names(
    VELOCITY, validity.CROSSINGS, *validity.SLIP_REVERSED, *validity.STRAIN,
    *validity.TENSION.values(), *validity.TENSION_X.values(),
)  # fmt: skip
#: Drawn as a loop along strokes.
_FRICTIONS = _names(states.FRICTION, states.RATIO)
#: Largest shear at any interface, which is no column of its own.
_INTERFACE_SHEAR = "interface_shear"
_INTENSITIES = _names(*states.K_I_LEFT.values(), *states.K_I_RIGHT.values())
#: What people ask for, and what is drawn where there is none of it.
_ANSWERS = [
    *_names(*states.LARGEST.values(), *stresses.HIGHEST.values(), *yielding.VON_MISES.values()),
    _INTERFACE_SHEAR, *_names(*states.HALF_WIDTH.values()),
]  # fmt: skip
_OF_EDGES = [*_names(states.ALPHA, states.BETA), *_INTENSITIES, *_names(states.INDENTATION)]


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


def has_parameters(of: Archive) -> bool:
    """Return True if something that is swept changes a number, or if the chosen axes can be drawn."""
    choice = of.choice
    if choice.x or choice.y or choice.by:
        return bool(columns_of(of))
    return bool(_swept(of, of.selected())) and bool(_Sweep(of).drawn)


def parameters(of: Archive) -> Drawing:
    """Figure of the numbers of states that vary, over a swept parameter; maps over two.

    Raises:
        BadInput: the states differ in no number, or nothing varies with it.
    """
    sweep = _Sweep(of)
    if not sweep.drawn:
        raise BadInput(
            f"--x: no number of the states varies with it; --y takes {', '.join(sweep.columns)}"
        )
    maps = sweep.maps()
    panels = maps or sweep.curves()
    methods = {method for name in sweep.drawn for method in sweep.columns[name].values}
    size = of.choice.size or (Size(COLUMN) if len(panels) == 1 else None)
    figure = render(panels, size, notes=[] if maps else explained(methods), high=0.72)
    shown = np.concatenate([states for _, states in sweep.groups]).tolist()
    at = f" at {of.text(shown[0], list(sweep.fixed))}" if sweep.fixed else ""
    over = plain(f"{sweep.label} and {panels[0].y}" if maps else sweep.label)
    caption = f"What follows from {over}{at}.{sweep.same}{of.formal(shown)}"
    if any(sweep.columns[name].unit == "a" for name in sweep.drawn):
        caption += f" Half-width and centre are over {of.units.of_a}."
    if maps:
        dots = "; dots are states" * bool(panels[0].curves)
        caption += f" Between the states it is interpolated{dots}."
    left_out = "" if maps else of.not_shown(shown, "--states, --x and --by")
    if sweep.more:
        left_out += f" Drawn by --y alone: {', '.join(sweep.more)}."
    return Drawing("parameters", caption, figure, left_out=left_out.strip())


class _Sweep:
    """Numbers of an archive's states that are drawn, and over what.

    Attributes:
        columns: numbers of the states by name.
        name, label, x: parameter or quantity that they are drawn over, the name of its axis, and its
            numbers, (states,).
        beside: second axis of the speed; None for none.
        by: name of the parameter that distinguishes curves, "" for one curve.
        groups: label and states of each curve.
        fixed: other parameters that differ between states, and the values at which they are held.
        drawn: names of columns.
        more: names of columns that change as well.
        same: sentence on swept numbers that change no column; "" for none.
    """

    def __init__(self, of: Archive) -> None:
        self._of, self.columns = of, columns_of(of)
        choice, every, self.same = of.choice, of.selected(), ""
        considered = self.columns.keys() & ({*choice.y} or {*_ANSWERS, *_OF_EDGES}) or self.columns
        once = of.once(every, *(self.columns[name].best for name in considered))
        if of.varied(once[0]) and not (choice.x or choice.by):
            every, self.same = once
        self.beside: tuple[str, float] | None = None
        self.name, self.label, self.x = self._over(every)
        varied = of.varied(every)
        others = [name for name in varied if name != self.name]
        law = [name for name in others if name in (C, N, *of.law)]
        # Places are the strokes' only where nothing else is swept.
        usual = next(iter([*law, *others]), "")
        self.by = require_one_of("by", choice.by, others) if choice.by else usual
        free = [self.by, *([self.name] if self.name in of.parameters else of.varied())]
        self.fixed = of.fixed([name for name in varied if name not in free], every)
        states = of.where(every, **self.fixed)
        self.groups = [("", states)]
        if self.by:
            values = spread(of.distinct(self.by, states), 6)  # curves that can be told apart
            own = [of.where(states, **{self.by: value}) for value in values]
            self.groups = [(of.label(int(numbers[0]), [self.by]), numbers) for numbers in own]
        self.drawn, self.more = [require_one_of("y", y, self.columns) for y in choice.y], list[str]()
        if not self.drawn:
            apart = [self.name, *_LIMITS, *_FRICTIONS * (self.name == PLACE)]
            changing = [
                name for name, column in self.columns.items()
                if name not in apart and any(_varies(column.best[own]) for _, own in self.groups)
            ]  # fmt: skip
            answers = [name for name in _ANSWERS if name in changing]
            names = [*answers, *_INTENSITIES] if answers else _OF_EDGES
            shown = [name for name in names if name in changing] or changing
            if {*_INTENSITIES} <= {*shown}:  # over N both ends of a flat punch have the same
                left, right = (self.columns[name].best for name in _INTENSITIES)
                if np.allclose(left, right, rtol=_SAME, atol=0.0, equal_nan=True):
                    shown.remove(_INTENSITIES[1])
            self.drawn = shown[:12]  # panels of a page
            self.more = [name for name in changing if name not in self.drawn]

    def _over(self, selected: NDArray) -> tuple[str, str, NDArray]:
        """Parameter or quantity that numbers are drawn over, the name of its axis, and its numbers."""
        of, requested = self._of, self._of.choice.x
        columns = columns_of(of, method="")
        numeric = [name for name in of.parameters if of.numeric(name)]
        if requested:
            require_one_of("x", requested, [*numeric, "speed", *columns])
        swept = _swept(of, selected) or of.varied(selected)
        usual = next((name for name in swept if name in numeric), "")
        name = C if requested == "speed" else requested or usual
        if not name:
            raise BadInput("--x: the states differ in no number; name one of " + ", ".join(numeric))
        if name not in of.parameters:
            return name, named(columns[name].about, columns[name].unit), columns[name].best
        if requested == "speed" and (of.units.dimensionless or of.by_c):
            return name, "speed $V$ (m/s)", of.speeds
        if name == C and of.axis(C)[2] == "1" and not of.by_c:
            self.beside = "speed (m/s)", of.c_s
        return name, *self._axis(name)

    def _axis(self, name: str) -> tuple[str, NDArray]:
        """Name of the axis of a parameter, and its numbers, (states,)."""
        of = self._of
        symbol, factor, unit = of.axis(name)
        about = f"speed ${symbol}$" if name == C and unit != "1" else _label(of.parameters[name])
        return named(about, unit), factor * of.parameter(name)

    def curves(self) -> list[Panel]:
        """A panel for each column that is drawn, with a curve for each group."""
        styles = looks(len(self.groups), not self.by or self._of.numeric(self.by))
        x, panels = np.concatenate([self.x[numbers] for _, numbers in self.groups]), list[Panel]()
        logarithmic = "x" * _by_ratios(x)
        ticks = np.unique(x[np.isfinite(x)])
        ticks = ticks[: len(ticks) * (max(len(f"{value:g}") for value in ticks) <= 4)]
        for name in self.drawn:
            shown, curves = self.columns[name], []
            for k, ((label, numbers), look) in enumerate(zip(self.groups, styles)):
                order = numbers[np.argsort(self.x[numbers], kind="stable")]
                values = {method: y[order] for method, y in shown.values.items()}
                label = label if len(self.groups) > 1 else ""
                curves += both(self.x[order], values, look, label, k / len(styles))
                if len(order) == 1:  # no line: a place of its own
                    curves = [replace(curve, form=MARKERS) for curve in curves]
                elif len(order) <= 12 and FEM not in values:  # what is computed, between what is drawn
                    curves.append(replace(curves[-1], label="", form=DOTS))
            every = np.concatenate([curve.y for curve in curves])
            crosses = np.nanmin(every) < 0.0 < np.nanmax(every)
            panels.append(Panel(
                self.label, shown.about, shown.unit, curves, beside=self.beside, ticks=ticks,
                log=logarithmic + "y" * _spans(every, 200.0), at_y=(0.0,) if crosses else (),
            ))  # fmt: skip
        return panels

    def maps(self) -> list[Panel]:
        """A map for each column that is drawn, over two swept numbers; none where curves are drawn."""
        of, choice, every = self._of, self._of.choice, self._of.selected()
        both_ = self.name, self.by
        if not self.by or self.name not in of.parameters or not of.numeric(self.by) or choice.by:
            return []
        free = [name for name in of.varied(every) if name not in both_]
        every = of.where(every, **of.fixed(free, every))
        across, up = (of.distinct(name, every) for name in both_)
        few = min(len(across), len(up)) < 5
        if few or len(every) != len(across) * len(up) or PLACE in both_:
            return []
        # States by the values of both parameters: the first changes along a row.
        order = np.lexsort([of.parameter(name)[every] for name in both_])
        numbers = every[order].reshape(len(up), len(across))
        label, y = self._axis(self.by)
        x, y = self.x[numbers[0]], y[numbers[:, 0]]
        log = "x" * _by_ratios(x) + "y" * _by_ratios(y)
        (X, along), (Y, upwards) = _finer(x), _finer(y)
        computed, panels = list[Curve](), list[Panel]()
        if len(every) <= 150:
            at_x, at_y = np.meshgrid(x, y)
            computed = [Curve(at_x.ravel(), at_y.ravel(), Look("black", "none", "."), form=DOTS)]
        for name in self.drawn:
            shown = self.columns[name]
            values = shown.best[numbers]
            by_ratios = _spans(values, 200.0)
            fine = np.log(values) if by_ratios else values
            fine = np.array([along(row) for row in fine])
            fine = np.array([upwards(row) for row in fine.T]).T
            fine = np.exp(fine) if by_ratios else fine
            limit = float(np.nanmax(np.abs(fine))) or 1.0
            signed = bool(np.nanmin(fine) < -1e-9 * limit)
            about = named(shown.about, shown.unit)
            panels.append(Panel(
                self.label, label, curves=computed, xlim=(X[0], X[-1]), ylim=(Y[0], Y[-1]), log=log,
                map=Map(
                    X, Y, fine, about, limit, signed=signed, lines=True, equal=False, log=by_ratios
                ),
            ))  # fmt: skip
        return panels


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
    stress = of.units.stress
    shear = {
        m: stress.of(layers.largest_shear(of.data, m)[0]).max(axis=1)
        for m, rows in layers.INTERFACE_EXTREMES.items() if of.has(rows[4])
    }  # fmt: skip
    if shear:
        columns[_INTERFACE_SHEAR] = Column("largest shear at an interface", stress.unit, shear)
    return columns


def _label(row: Quantity) -> str:
    """Name of a quantity for an axis, with formulas in TeX."""
    text = re.sub(r"\bX = (-?a)\b", r"$X = \1$", short_name(row))
    text = text.replace("sigma_XX", r"$\sigma_{XX}$")
    if row.symbol:
        text = f"{text.removesuffix(plain(f'${row.symbol}$')).strip()} ${row.symbol}$"
    return text


def _swept(of: Archive, selected: NDArray) -> list[str]:
    """Names of numeric parameters with enough values for a curve, those with most values first."""
    counts = {name: len(of.distinct(name, selected)) for name in of.parameters if of.numeric(name)}
    return sorted((name for name in counts if counts[name] >= 3), key=lambda name: -counts[name])


def _varies(values: NDArray) -> bool:
    finite = values[np.isfinite(values)]
    return len(finite) > 1 and np.ptp(finite) > _SAME * np.abs(finite).max()


def _by_ratios(x: NDArray) -> bool:
    """True for numbers over more than a decade whose middle one lies midway rather by ratios."""
    if not _spans(x, 30.0):
        return False
    low, middle, high = np.quantile(np.unique(x[np.isfinite(x)]), (0.0, 0.5, 1.0))
    return bool(middle**2 < (low * high) ** 0.5 * (low + high) / 2.0)


def _finer(x: NDArray) -> tuple[NDArray, Callable[[NDArray], NDArray]]:
    """Rising numbers with more between them, by equal steps or ratios, and what interpolates there.

    Curves between numbers rise and fall as these do; beside one that is missing they are straight.
    """
    from scipy.interpolate import PchipInterpolator  # a slow import, and most figures are curves

    parts, log = ceil(64 / (len(x) - 1)), _by_ratios(x)
    steps = np.log(x) if log else x
    places = np.interp(np.arange(parts * (len(x) - 1) + 1) / parts, np.arange(len(x)), steps)
    X = np.exp(places) if log else places
    X[::parts] = x

    def between(y: NDArray) -> NDArray[np.float64]:
        if np.isfinite(y).all():
            return np.asarray(PchipInterpolator(steps, y)(places))
        return np.interp(places, steps, y)

    return X, between


def _spans(values: NDArray, more_than: float) -> bool:
    finite = values[np.isfinite(values)]
    return bool(len(finite) and finite.min() > 0.0 and finite.max() > more_than * finite.min())
