"""A film of the strokes of an archive: where friction is, and what that does to the stresses."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.figures.maps import Film, Map, strokes_film
from galinx.postprocess.figures.surface import Stress
from galinx.postprocess.quantities.states import FRICTION
from galinx.postprocess.quantities.stresses import SURFACE_X

from ..errors import BadInput
from ..scene.scene import Scene
from . import surface
from .choice import Choice
from .friction import Loops
from .state_labels import PLACE, STROKE, StateLabels, not_shown

#: Frames that a film has at least.
_FRAMES = 4


def has_film(data: dict[str, Any], scene: Scene, choice: Choice) -> bool:
    """Return True if an archive has enough states along the strokes, and stresses to show in them."""
    shown = surface.quantities(data, choice.method) or surface.has_map(data, choice.method)
    return bool(shown) and len(_frames(StateLabels(data, scene), choice)) >= _FRAMES


def film(data: dict[str, Any], scene: Scene, choice: Choice) -> tuple[Film, str]:
    """Film of the strokes, and a sentence on the states that it leaves out.

    Raises:
        BadInput: there are too few states along the strokes.
    """
    loops = Loops(data, scene)
    labels = loops.labels
    frames = _frames(labels, choice)
    if len(frames) < _FRAMES:
        raise BadInput(
            f"a film needs at least {_FRAMES} states along strokes, found {len(frames)}; give "
            "motion.X_over_L more places"
        )
    loop = loops.of(int(frames[0]))
    if loop is None:
        raise BadInput("a film needs the friction loop, which archives of more than 1 000 laws leave out")
    stresses, fields = _shown(data, scene, choice, frames)
    f = data[FRICTION.path]
    made = strokes_film(
        loop,
        [(float(labels.values(PLACE)[i]), float(f[i])) for i in frames],
        [f"{labels.label(int(i), [STROKE, PLACE])}, $f = {f[i]:.2f}$" for i in frames],
        data.get(SURFACE_X.path, np.empty(0)),
        stresses,
        surface.Fields(data, scene, Choice()).grid() if fields else None,
        fields,
        choice.size,
    )
    return made, not_shown(labels, frames.tolist(), "--figure film --states", choice.states)


def _shown(
    data: dict[str, Any], scene: Scene, choice: Choice, frames: NDArray
) -> tuple[list[Stress], list[Map]]:
    """Stresses along the surface by one method, or maps where there are none or they are chosen."""
    available = surface.quantities(data, choice.method)
    if available and set(choice.quantities) <= set(available):
        return [
            Stress(stress.label, {method: values[frames]})
            for stress in surface.stresses_of(data, choice)
            for method, values in list(stress.values.items())[:1]
        ], []
    fields = surface.Fields(data, scene, choice)
    names = choice.quantities or ("sigma_XX", "von_mises")
    made = []
    for name in names:
        values = np.array([fields.values(name, fields.methods[0], int(i)) for i in frames])
        signed = bool(values.min() < 0.0)
        made.append(Map(fields.label(name, True), values, signed, fields.interfaces))
    return [], made


def _frames(labels: StateLabels, choice: Choice) -> NDArray[np.int64]:
    """States of one law and speed, in the order of travel."""
    states = np.array(choice.states) if choice.states else labels.all
    rest = [name for name in labels.varied(states) if name not in (STROKE, PLACE)]
    if not choice.states:
        states = labels.where(states, **labels.fixed(rest, states))
    elif rest:
        raise BadInput(f"--states: a film follows one law at one speed, found several {', '.join(rest)}")
    strokes = list(dict.fromkeys(labels.values(STROKE).tolist()))
    order = [
        (strokes.index(stroke), X if stroke.startswith("F") else -X)
        for stroke, X in zip(
            labels.values(STROKE)[states].tolist(), labels.values(PLACE)[states].tolist()
        )
    ]
    return states[sorted(range(len(states)), key=order.__getitem__)]
