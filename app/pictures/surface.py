"""Stresses along the surface of some of an archive's states."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.pictures.choice import Choice, one_of
from galinx.app.pictures.drawing import Drawing, by_method
from galinx.app.pictures.friction import Loops
from galinx.app.pictures.told import C, N, Told, few, not_shown, spread
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.style import PAGE
from galinx.postprocess.figures.surface import Column, Curve, Place, Stress, surface_figure
from galinx.postprocess.quantities.quantity import POINT, STATE
from galinx.postprocess.quantities.states import FRICTION, POSITION
from galinx.postprocess.quantities.stresses import IN_PLANE, PRESSURE, SURFACE_X

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


def stresses(data: dict[str, Any], choice: Choice) -> list[Stress]:
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
        data[SURFACE_X.path], stresses(data, choice), columns, choice.size, choice.ends
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
