"""Single numbers of states over what a scene sweeps."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.errors import BadInput
from galinx.app.pictures.choice import Choice, noun, one_of
from galinx.app.pictures.drawing import Drawing, by_method
from galinx.app.pictures.told import PLACE, C, N, Told, not_shown, spread
from galinx.app.results.si import contacts_of_states, in_si
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.curves import Line, Panel, Parameter, curves_figure
from galinx.postprocess.figures.typeset import plain, unit
from galinx.postprocess.quantities import Quantity, column, validity
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, METHODS, SIE, STATE
from galinx.postprocess.quantities.states import FRICTION, VELOCITY
from galinx.postprocess.scaling import as_archived

#: Values of a parameter that make a curve, curves that can be told apart, and panels of a page.
_VALUES, _CURVES, _PANELS = 3, 6, 12

#: Relative change below which numbers count as constant or, up to a factor, as those of another column.
_SAME = 1e-5

#: Where answers do not hold, and the speed once more: drawn where they are asked for.
_LIMITS = {
    row.path.rpartition("/")[2]
    for row in (
        VELOCITY, validity.CROSSINGS, *validity.STRAINED,
        *(row for rows in validity.TENSION.values() for row in rows),
    )
}  # fmt: skip

#: What axes have instead of SI's units: by what numbers are multiplied, and the unit.
_LARGER = {"Pa": (1e-6, "MPa"), "m": (1e3, "mm")}

#: Another name of the speed, in m/s.
_SPEED = "speed"


@dataclass(frozen=True)
class Column:
    """Numbers of states of one name.

    Attributes:
        about: what they are, with symbol.
        unit: in TeX.
        exact, found: not by finite elements, and by these, (states,).
        by: the method of the first, "" for none.
    """

    about: str
    unit: str
    exact: NDArray | None
    found: NDArray | None
    by: str

    @property
    def best(self) -> NDArray:
        """Its numbers, not by finite elements where there are such."""
        values = self.exact if self.exact is not None else self.found
        assert values is not None
        return values

    @property
    def methods(self) -> int:
        """By how many methods they are known."""
        return (self.exact is not None) + (self.found is not None)


@dataclass(frozen=True)
class Sweep:
    """What is drawn of an archive.

    Attributes:
        over, x: the parameter, and its numbers, (states,).
        by: name of what tells curves apart, "" for one curve.
        groups: label and states of each curve.
        fixed: what else differs between states, and where it is looked at.
        drawn: names of columns.
        same: names of those that show nothing else, or no change.
        more: names of those for which a page has no room.
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
        """All that are drawn."""
        return np.concatenate([states for _, states in self.groups])


def has(data: dict[str, Any], scene: Scene, choice: Choice) -> bool:
    """Is something swept that changes something, or wanted?"""
    told = Told(data, scene)
    if choice.x or choice.y or choice.by:
        return bool(_columns(data, scene, choice))
    return bool(_swept(told, _some(told, choice))) and bool(_sweep(data, scene, told, choice).drawn)


def parameters(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """What varies, over what is swept.

    Raises:
        BadInput: the states differ in no number, or nothing varies with it.
    """
    told, known = Told(data, scene), _columns(data, scene, choice)
    sweep = _sweep(data, scene, told, choice)
    if not sweep.drawn:
        raise BadInput(f"--x: no number of the states varies with it; --y takes {', '.join(known)}")
    panels = [
        Panel(
            known[name].about,
            [_line(known[name], label, sweep.x, states) for label, states in sweep.groups],
            known[name].unit,
        )
        for name in sweep.drawn
    ]
    ordered = not sweep.by or told.numeric(sweep.by)
    exactly = METHODS[SIE if SIE in {known[name].by for name in sweep.drawn} else CLOSED_FORM]
    figure = curves_figure(panels, sweep.over, ordered, choice.size, exactly)
    at = f" at {told.text(int(sweep.states[0]), list(sweep.fixed))}" if sweep.fixed else ""
    caption = f"What follows from {plain(sweep.over.label)}{at}."
    if sweep.same:
        caption += f" Not drawn, being constant or the same up to a factor: {', '.join(sweep.same)}."
    left_out = not_shown(told, sweep.states.tolist(), "--states, --x and --by", choice.states)
    if sweep.more:
        left_out += f" Drawn by --y alone: {', '.join(sweep.more)}."
    return Drawing("parameters", caption, figure, left_out=left_out.strip())


def _some(told: Told, choice: Choice) -> NDArray[np.int64]:
    return np.array(choice.states) if choice.states else told.all


def _sweep(data: dict[str, Any], scene: Scene, told: Told, choice: Choice) -> Sweep:
    known, some = _columns(data, scene, choice), _some(told, choice)
    name, over, x = _over(told, _columns(data, scene, replace(choice, method="")), choice.x, some)
    by = _by(told, choice.by, name, some)
    free = [name, by] if name in told.parameters else [by, *told.varied()]
    fixed = told.fixed([one for one in told.varied(some) if one not in free], some)
    groups = _groups(told, by, told.where(some, **fixed))
    some = np.concatenate([states for _, states in groups])
    same: list[str] = []
    if choice.y:
        drawn = [one_of("y", one, known) for one in choice.y]
    else:
        # Along strokes friction is drawn as a loop.
        elsewhere = [x] if name != PLACE else [x, data[FRICTION.path]]
        left = {name, *_LIMITS}
        numbers = {one: column.best[some] for one, column in known.items() if one not in left}
        order = sorted(numbers, key=lambda one: -known[one].methods)
        changing = {one for one in numbers if any(_varies(known[one].best[of]) for _, of in groups)}
        drawn, same = _apart(numbers, order, changing, [values[some] for values in elsewhere])
    most = len(choice.y) or _PANELS
    return Sweep(over, x, by, groups, fixed, drawn[:most], same, drawn[most:])


def _columns(data: dict[str, Any], scene: Scene, choice: Choice) -> dict[str, Column]:
    """What an archive has one number a state of, but how good these are.

    In units where they are asked for, and where every state has a half-width of its own: over that,
    numbers of states could not be compared.
    """
    found = {}
    in_units = choice.in_si or contacts_of_states(data) is not None
    for name, rows in by_method(data, (STATE,), choice.method).items():
        first = next(iter(rows.values()))
        if all(row.accuracy for row in rows.values()) or not first.path.startswith(column("")):
            continue
        by = next((of for of in rows if of != FEM), "")
        told = in_si(first, name, scene, data) if in_units else None
        if told is None or told.unit not in _LARGER:
            told = as_archived(first, name)
        other = told.unit != first.unit
        factor, shown = _LARGER[told.unit] if other else (1.0, told.unit)
        exact, fem = (factor * told.of(data[rows[of].path]) if of in rows else None for of in (by, FEM))
        label = _label(first).removesuffix(" over $a$" if other else "")
        found[name] = Column(label, unit(shown).removeprefix(r"\,"), exact, fem, by)
    return found


def _label(row: Quantity) -> str:
    """What a quantity is, with formulas set as such; stresses over what they are over."""
    told = re.sub(r"\bX = (-?a)\b", r"$X = \1$", noun(row))
    if row.symbol:
        told = f"{told.removesuffix(plain(f'${row.symbol}$')).strip()} ${row.symbol}$"
    return told


def _swept(told: Told, some: NDArray) -> list[str]:
    """Numbers that take enough values for a curve, most first."""
    counts = {name: len(told.distinct(name, some)) for name in told.parameters if told.numeric(name)}
    return sorted((name for name in counts if counts[name] >= _VALUES), key=lambda name: -counts[name])


def _over(
    told: Told, known: dict[str, Column], wanted: str, some: NDArray
) -> tuple[str, Parameter, NDArray]:
    """Name, axis and numbers of what is drawn over."""
    numeric = [name for name in told.parameters if told.numeric(name)]
    if wanted:
        one_of("x", wanted, [*numeric, _SPEED, *known])
    swept = _swept(told, some) or told.varied(some)
    name = C if wanted == _SPEED else wanted or next((name for name in swept if name in numeric), "")
    if not name:
        raise BadInput("--x: the states differ in no number; name one of " + ", ".join(numeric))
    if name not in told.parameters:
        return name, Parameter(known[name].about), known[name].best
    row, values = told.parameters[name], told.values(name)
    in_unit = unit(row.unit).removeprefix(r"\,")
    label = _label(row) + (f" $[{in_unit}]$" if in_unit else "")
    if wanted == _SPEED:
        return name, Parameter("speed [m/s]"), values * told.c_s
    return name, Parameter(label, ("speed [m/s]", told.c_s) if name == C else None), values


def _by(told: Told, wanted: str, x: str, some: NDArray) -> str:
    """What tells the curves apart; nothing for one curve."""
    varied = [name for name in told.varied(some) if name != x]
    if wanted:
        return one_of("by", wanted, varied)
    law = [name for name in varied if name in (C, N, *told.law)]
    # Places are the strokes' only where nothing else is swept.
    return next(iter([*law, *varied]), "")


def _groups(told: Told, by: str, some: NDArray) -> list[tuple[str, NDArray]]:
    """Label and states of each curve."""
    if not by:
        return [("", some)]
    values = spread(told.distinct(by, some), _CURVES)
    groups = [told.where(some, **{by: value}) for value in values]
    return [(told.label(int(states[0]), [by]), states) for states in groups]


def _line(column: Column, label: str, x: NDArray, states: NDArray) -> Line:
    order = states[np.argsort(x[states], kind="stable")]
    exact, found = (
        values if values is None else values[order] for values in (column.exact, column.found)
    )
    return Line(label, x[order], exact, found)


def _apart(
    numbers: dict[str, NDArray], order: Sequence[str], changing: set[str], seen: list[NDArray]
) -> tuple[list[str], list[str]]:
    """Names that show something, in the order of ``numbers``, and those that would show it again."""
    drawn: list[str] = []
    for name in order:
        twins = [*seen, *(numbers[other] for other in drawn)]
        if name in changing and not any(_proportional(numbers[name], other) for other in twins):
            drawn.append(name)
    return [name for name in numbers if name in drawn], [name for name in numbers if name not in drawn]


def _varies(values: NDArray) -> bool:
    some = values[np.isfinite(values)]
    return len(some) > 1 and np.ptp(some) > _SAME * np.abs(some).max()


def _proportional(one: NDArray, other: NDArray) -> bool:
    sizes = np.abs(one).max(), np.abs(other).max()
    if not all(0.0 < size < np.inf for size in sizes):
        return False
    one, other = one / sizes[0], other / sizes[1]
    return any(np.allclose(one, sign * other, rtol=0.0, atol=_SAME) for sign in (1.0, -1.0))
