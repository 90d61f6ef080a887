"""Single numbers of states over what a scene sweeps."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.errors import BadInput
from galinx.app.pictures.choice import Choice, one_of
from galinx.app.pictures.drawing import Drawing, by_method, noun
from galinx.app.pictures.told import C, Told, not_shown, spread
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.curves import Line, Panel, Parameter, curves_figure
from galinx.postprocess.figures.typeset import plain, unit
from galinx.postprocess.quantities import Quantity
from galinx.postprocess.quantities.quantity import FEM, STATE

#: Values of a parameter that make a curve, and curves that can be told apart.
_VALUES, _CURVES = 3, 6

#: Relative change below which numbers count as constant or, up to a factor, as those of another column.
_SAME = 1e-5

#: Another name of the speed, in m/s.
_SPEED = "speed"


@dataclass(frozen=True)
class Column:
    """Numbers of states of one name.

    Attributes:
        about: what they are, with symbol and unit.
        exact, found: in closed form or of no method, and by finite elements, (states,).
    """

    about: str
    exact: NDArray | None
    found: NDArray | None

    @property
    def best(self) -> NDArray:
        """Its numbers, in closed form where there are any."""
        values = self.exact if self.exact is not None else self.found
        assert values is not None
        return values

    @property
    def methods(self) -> int:
        """By how many methods they are known."""
        return (self.exact is not None) + (self.found is not None)


def has(data: dict[str, Any], scene: Scene, choice: Choice) -> bool:
    """Is something swept, or wanted?"""
    told = Told(data, scene)
    return bool(choice.x or choice.y or _swept(told, told.all)) and bool(_columns(data, choice.method))


def parameters(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """What varies, over what is swept."""
    told, known = Told(data, scene), _columns(data, choice.method)
    some = np.array(choice.states) if choice.states else told.all
    x, over, values = _over(told, known, choice.x, some)
    by = _by(told, choice.by, x, some)
    free = [x, by] if x in told.parameters else [x, by, *told.varied()]
    fixed = told.fixed([name for name in told.varied(some) if name not in free], some)
    some = told.where(some, **fixed)
    groups = _groups(told, by, some)
    shown = np.concatenate([states for _, states in groups])
    names, same = _worth_it(known, shown, choice.y, x)
    panels = [
        Panel(known[name].about, [_line(known[name], label, values, states) for label, states in groups])
        for name in names
    ]
    figure = curves_figure(panels, over, not by or told.numeric(by), choice.size)
    at = f" at {told.label(int(shown[0]), list(fixed))}" if fixed else ""
    caption = f"What follows from {plain(over.label)}{at}."
    if same:
        caption += f" The same up to a factor and not drawn, or constant: {', '.join(same)}."
    how = "--states, or --x, --y and --by"
    return Drawing("parameters", caption, figure, left_out=not_shown(told, shown.tolist(), how))


def _columns(data: dict[str, Any], method: str) -> dict[str, Column]:
    """What an archive has one number a state of, but how good these are."""
    found = {}
    for name, rows in by_method(data, (STATE,), method).items():
        if all(row.accuracy for row in rows.values()):
            continue
        exact = next((data[row.path] for of, row in rows.items() if of != FEM), None)
        fem = data[rows[FEM].path] if FEM in rows else None
        found[name] = Column(_label(next(iter(rows.values()))), exact, fem)
    return found


def _label(row: Quantity) -> str:
    symbol = f" ${row.symbol}$" if row.symbol else ""
    over = f" $/\\,({row.unit})$" if "/(" in row.unit else ""
    return f"{noun(row)}{symbol}{over}" + (f" $[{unit(row.unit)}]$" if unit(row.unit) and not over else "")


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
        one_of("--x", wanted, [*numeric, _SPEED, *known])
    swept = _swept(told, some) or told.varied(some)
    name = C if wanted == _SPEED else wanted or next((name for name in swept if name in numeric), "")
    if not name:
        raise BadInput("--x: the states differ in no number; name one of " + ", ".join(numeric))
    if name not in told.parameters:
        return name, Parameter(known[name].about), known[name].best
    label, values = _label(told.parameters[name]), told.values(name)
    if wanted == _SPEED:
        return name, Parameter("speed [m/s]"), values * told.c_s
    return name, Parameter(label, ("speed [m/s]", told.c_s) if name == C else None), values


def _by(told: Told, wanted: str, x: str, some: NDArray) -> str:
    """What tells the curves apart; nothing for one curve."""
    varied = [name for name in told.varied(some) if name != x]
    if wanted:
        return one_of("--by", wanted, varied)
    law = [name for name in varied if name in (C, *told.law)]
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
    exact, found = (values if values is None else values[order] for values in (column.exact, column.found))
    return Line(label, x[order], exact, found)


def _worth_it(
    known: dict[str, Column], shown: NDArray, wanted: Sequence[str], x: str
) -> tuple[list[str], list[str]]:
    """Names that are drawn, and those that would show the same or nothing."""
    if wanted:
        return [one_of("--y", name, known) for name in wanted], []
    drawn: list[str] = []
    same = []
    for name in sorted((name for name in known if name != x), key=lambda name: -known[name].methods):
        values = known[name].best[shown]
        twin = any(_proportional(values, known[other].best[shown]) for other in drawn)
        if twin or np.ptp(values) <= _SAME * np.abs(values).max() or not np.isfinite(values).all():
            same.append(name)
        else:
            drawn.append(name)
    if not drawn:
        raise BadInput("--y: no number of the states varies; expected one of " + ", ".join(known))
    return [name for name in known if name in drawn], same


def _proportional(one: NDArray, other: NDArray) -> bool:
    one, other = (values / np.abs(values).max() for values in (one, other))
    return bool(np.allclose(one, other, atol=_SAME, rtol=0.0) or np.allclose(one, -other, atol=_SAME, rtol=0.0))
