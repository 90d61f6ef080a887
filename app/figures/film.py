"""A film of the strokes of an archive: where friction is, and what that does to the stresses."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities.states import FRICTION
from galinx.postprocess.quantities.stresses import SURFACE_X
from galinx.texts import number

from ..errors import BadInput
from . import motion, stresses
from .choice import Archive
from .friction import Loops, loop_panel
from .render import Curve, Film, Panel
from .states import PLACE, STROKE, StateLabels, not_shown
from .style import Look, looks

#: The picture that moves, and frames that it has at least.
FILM, _FRAMES = "film", 4


def has_film(of: Archive) -> bool:
    """Return True if an archive has enough states along the strokes, or times, and stresses to show."""
    return _has_strokes(of) or motion.has_film(of) or motion.has_pressures(of)


def _has_strokes(of: Archive) -> bool:
    shown = stresses.surface_names(of) or stresses.has_map(of)
    return bool(shown) and len(_states(of)) >= _FRAMES


def film(of: Archive) -> tuple[Film, str]:
    """Film of the strokes, or of a motion in time, and a sentence on what it leaves out.

    Raises:
        BadInput: there are too few states along the strokes.
    """
    if not _has_strokes(of):
        if motion.has_film(of):
            return motion.film_of_surface(of)
        if motion.has_pressures(of):
            return motion.pressure_film(of)
    labels, frames = of.labels, _states(of)
    if len(frames) < _FRAMES:
        raise BadInput(
            f"a film needs at least {_FRAMES} states along strokes, found {len(frames)}; give "
            "motion.X_over_L more places"
        )
    loop = Loops(of).of(int(frames[0]))
    if loop is None:
        raise BadInput("a film needs the friction loop, which archives of more than 1 000 laws leave out")
    f, X = of.data[FRICTION.path], labels.values(PLACE)
    base = loop_panel([replace(loop, label="")])
    beside = _stresses(of, frames)

    def panels(frame: int) -> list[Panel]:
        i = int(frames[frame])
        dot = Curve(X[i : i + 1], f[i : i + 1], Look("black", "none", "o"), form="markers")
        title = f"{labels.label(i, [STROKE, PLACE])}, $f = {number(f[i], 2)}$"
        return [replace(base, curves=[*base.curves, dot], title=title), *beside[frame]]

    return Film(panels, len(frames), of.size), not_shown(
        labels, frames.tolist(), "--figure film --states", of.choice.states
    )


def _stresses(of: Archive, frames: NDArray) -> list[list[Panel]]:
    """Stresses along the surface by one method, or maps where there are none or they are chosen, of every
    frame."""
    available, chosen = stresses.surface_names(of), of.choice.quantities
    if available and set(chosen) <= set(available):
        data_X, shown = of.data[SURFACE_X.path], stresses.surface_stresses(of)
        made: list[list[Panel]] = [[] for _ in frames]
        for label, values in shown.items():
            drawn = next(iter(values.values()))[frames]
            half, ylim = stresses.along(data_X, drawn), stresses.limits(data_X, drawn)
            for n, i in enumerate(frames.tolist()):
                place = stresses.place_of(of, i)
                curve = stresses.surface_curves(data_X, {"": drawn[n]}, looks(1)[0], "", 0.0, place)[0]
                window = place[1] - half * place[0], place[1] + half * place[0]
                bands = stresses.contacts_of(of, [i]) if half > 1.5 else ()
                name = stresses.position_name(of, "")
                made[n].append(
                    Panel(name, label, curves=[curve], xlim=window, ylim=ylim, bands=bands, at_y=(0.0,))
                )
        return made
    fields = stresses.Fields(of)
    made = [[] for _ in frames]
    for name in chosen or ("sigma_XX", "von_mises"):
        method = fields.methods[0]
        every = np.array([fields.values(name, method, int(i)) for i in frames])
        limit = float(np.quantile(np.abs(every), 0.985)) or 1.0
        for n, i in enumerate(frames.tolist()):
            shown_map = stresses.map_of(of, fields, name, method, i, limit, label=fields.label(name))
            X, Y = stresses.position_name(of, ""), stresses.position_name(of, "").replace("X", "Y")
            made[n].append(Panel(X, Y, map=replace(shown_map, level=0.0, equal=False)))
    return made


def _states(of: Archive) -> NDArray[np.int64]:
    """States of one law and speed, in the order of travel."""
    labels, choice = of.labels, of.choice
    states = of.selected()
    rest = [name for name in labels.varied(states) if name not in (STROKE, PLACE)]
    if not choice.states:
        states = labels.where(states, **labels.fixed(rest, states))
    elif rest:
        raise BadInput(f"--states: a film follows one law at one speed, found several {', '.join(rest)}")
    return _in_order(labels, states)


def _in_order(labels: StateLabels, states: NDArray) -> NDArray[np.int64]:
    strokes = list(dict.fromkeys(labels.values(STROKE).tolist()))
    order = [
        (strokes.index(stroke), X if stroke.startswith("F") else -X)
        for stroke, X in zip(
            labels.values(STROKE)[states].tolist(), labels.values(PLACE)[states].tolist()
        )
    ]
    return states[sorted(range(len(states)), key=order.__getitem__)]
