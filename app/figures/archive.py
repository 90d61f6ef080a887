"""Figures of an archive by name, the choice of those that are drawn, and a film of strokes: where
friction is, and what that does to the stresses."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np

from galinx.postprocess.quantities import Quantity, over_time, runs, solved_states
from galinx.postprocess.quantities.quantity import METHODS
from galinx.postprocess.quantities.states import FRICTION
from galinx.postprocess.quantities.stresses import RATIO_ALONG
from galinx.texts import number

from ..errors import BadInput, require_one_of
from ..plan.plan import make_plan
from ..scene.scene import Scene
from . import friction, motion, numerics, stresses, sweep, waves
from .choice import PLACE, STROKE, Archive, Choice, Drawing
from .files import FILM, OF_FILMS, Files, Written
from .friction import Loops, loop_panel
from .render import Film, Panel, TooSmall, with_dot

#: Name that stands for all figures, and a choice that leaves everything open.
ALL, PLAIN = "all", Choice()
#: Figures that take long, which are drawn only where they are named.
_BY_NAME = FILM, "flutter"


@dataclass(frozen=True)
class _Figure:
    """A kind of figure: how it is drawn, whether an archive has it, the options that it follows, and
    whether it is drawn without being named."""

    draw: Callable[[Archive], Drawing]
    has: Callable[[Archive], bool]
    follows: frozenset[str] = frozenset()
    usual: Callable[[Archive], bool] = lambda _: False


def film(of: Archive) -> Drawing:
    """Film of the strokes, or of a motion in time.

    Raises:
        BadInput: there are too few states along the strokes.
    """
    if not _has_strokes(of) and motion.has_film(of):
        return motion.film(of)
    frames = _frames(of)
    if len(frames) < motion.LEAST_FRAMES:
        raise BadInput(
            f"a film needs at least {motion.LEAST_FRAMES} states along strokes, found {len(frames)}; "
            "give motion.X_over_L more places"
        )
    if _has("surface")(of):  # by one method
        stressed, x = stresses.stresses_along(of).values(), stresses.position_name(of, "")
        alone = [replace(along, values=dict([*along.values.items()][:1])) for along in stressed]
        made = [stresses.surface_panels(along, frames, x=x) for along in alone]
    elif stresses.map_names(of):
        fields, shown = stresses.Fields(of), of.choice.quantities or ("sigma_XX", "von_mises")
        made = [fields.panels(name, frames, level=np.inf, equal=False) for name in shown]
    else:
        raise BadInput('a film needs stresses; add "surface" to output.quantities, or output.map')
    loops = Loops(of).of(frames[:1], [])
    if not loops:
        raise BadInput("a film needs the friction loop, which archives of more than 1 000 laws leave out")
    f, X = of.data[FRICTION.path], of.parameter(PLACE)
    base = loop_panel(loops)

    def panels(frame: int) -> list[Panel]:
        i = frames[frame]
        title = f"{of.label(i, [STROKE, PLACE])}, $f = {number(f[i], 2)}$"
        return [replace(with_dot(base, X[i], f[i]), title=title), *(of_name[frame] for of_name in made)]

    moving = Film(panels, len(frames), of.choice.size)
    missing = of.not_shown(frames, "--figure film --states")
    return Drawing(FILM, "", moving.figure, left_out=missing, film=moving)


def _has_strokes(of: Archive) -> bool:
    names = stresses.NAMES["surface"](of) or stresses.map_names(of)
    return bool(names) and len(_frames(of)) >= motion.LEAST_FRAMES


def _frames(of: Archive) -> list[int]:
    """States of one law and speed, in the order of travel."""
    states = of.selected()
    rest = [name for name in of.varied(states) if name not in (STROKE, PLACE)]
    if not of.choice.states:
        states = of.where(states, **of.fixed(rest, states))
    elif rest:
        raise BadInput(f"--states: a film follows one law at one speed, found several {', '.join(rest)}")
    strokes, X = of.parameter(STROKE), of.parameter(PLACE)
    every = of.distinct(STROKE)

    def travelled(i: int) -> tuple[int, float]:
        return every.index(strokes[i]), X[i] if strokes[i].startswith("F") else -X[i]

    return sorted(states.tolist(), key=travelled)


def _has(name: str) -> Callable[[Archive], bool]:
    """Condition that an archive has some stresses for a figure, and the chosen ones among them."""
    return lambda of: bool(there := stresses.NAMES[name](of)) and {*of.choice.quantities} <= {*there}


def _holds(*rows: Quantity) -> Callable[[Archive], bool]:
    """Condition that an archive holds all of some quantities."""
    return lambda of: of.has(*rows)


#: A figure that is drawn without being named, and options of figures of stresses.
_ALWAYS = _holds()
_STRESSES = frozenset({"states", "quantities", "method"})

#: By name, in the order they are drawn; the usual ones answer what is asked most.
FIGURES = {
    "surface": _Figure(stresses.surface, _has("surface"), _STRESSES | {"measured"}, _ALWAYS),
    "along": _Figure(
        stresses.friction_along, _holds(RATIO_ALONG), frozenset({"states", "method"}), _ALWAYS
    ),
    "inside": _Figure(stresses.inside, _has("inside"), _STRESSES, _ALWAYS),
    "parameters": _Figure(
        sweep.parameters, sweep.has_parameters, frozenset({"states", "method", "x", "y", "by"}), _ALWAYS
    ),
    "friction": _Figure(
        friction.friction, friction.varies, frozenset({"states", "measured"}), friction.has_loop
    ),
    "slider": _Figure(friction.slider, _holds(runs.TIMES), usual=_ALWAYS),
    "time": _Figure(motion.time, _holds(over_time.TIMES), usual=_ALWAYS),
    "interfaces": _Figure(stresses.interfaces, _has("interfaces"), _STRESSES, _ALWAYS),
    "pressures": _Figure(motion.pressures, _holds(*motion.PRESSURES)),
    "stresses": _Figure(motion.stresses, motion.has_surface),
    "energies": _Figure(motion.energies, _holds(*motion.ENERGIES)),
    "flutter": _Figure(waves.flutter, waves.has_flutter),
    "degrees": _Figure(numerics.degrees, _holds(*numerics.DEGREES)),
    "mesh": _Figure(numerics.mesh, lambda of: bool(make_plan(of.scene).fem)),
    FILM: _Figure(film, lambda of: _has_strokes(of) or motion.has_film(of), _STRESSES),
}  # fmt: skip


def of_archive(data: dict[str, Any], scene: Scene, choice: Choice = PLAIN) -> Iterator[Drawing]:
    """The figures that a choice selects, and the film if it is named, one after the other.

    Raises:
        BadInput: the archive lacks a selected figure or quantity; the message says what it has.
    """
    of = Archive(data, scene, choice)
    for name in names(data, scene, choice):
        try:
            yield FIGURES[name].draw(of)
        except TooSmall as error:
            raise BadInput(f"--size: the figure {name} does not fit; {error}") from error


def write(data: dict[str, Any], scene: Scene, choice: Choice, files: Files) -> list[Written]:
    """Write the figures of :func:`of_archive`.

    Raises:
        BadInput: the archive lacks a figure or quantity, or it cannot be written in this format.
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    if not choice.figures and OF_FILMS.keys() & {files.ending, *files.formats}:
        choice = replace(choice, figures=(FILM,))
    if not (drawn := names(data, scene, choice)):
        raise BadInput('the archive has nothing to draw; add "surface" to output.quantities')
    files.check(drawn)
    return files.write(of_archive(data, scene, choice))


def names(data: dict[str, Any], scene: Scene, choice: Choice = PLAIN) -> list[str]:
    """Names of the figures that a choice selects; by default those that answer what is asked most.

    Raises:
        BadInput: the archive lacks a selected figure or quantity; the message says what it has.
    """
    count = len(data[FRICTION.path])
    for state in choice.states:
        if not 0 <= state < count:
            raise BadInput(
                f"--states: found {state}, expected numbers from 0 to {count - 1}; show lists them"
            )
        if state not in np.arange(count)[solved_states(data)]:
            raise BadInput(f"--states: found {state}, which has no solution; show says why")
    if choice.method:
        require_one_of("method", choice.method, METHODS)
    # Axes that are named have a figure where two values by themselves have none.
    axes = Choice(units=choice.units, x=choice.x, y=choice.y, by=choice.by)
    plain, of = Archive(data, scene, axes), Archive(data, scene, choice)
    available = [name for name, figure in FIGURES.items() if figure.has(plain)]
    whole = choice.figures == (ALL,)
    named = () if whole else choice.figures
    for name in named:
        # A film that the archive has too few states for says so itself.
        require_one_of("figure", name, dict.fromkeys([*available, FILM]))
        if ignored := choice.given - FIGURES[name].follows:
            raise BadInput(f"--figure {name} follows no {_options(ignored)}; leave that away")
    quantities = dict.fromkeys(chain.from_iterable(of_kind(plain) for of_kind in stresses.NAMES.values()))
    for name in choice.quantities:
        require_one_of("quantity", name, quantities)
    usual = [name for name in available if FIGURES[name].usual(plain)]
    quick = [name for name in available if name not in _BY_NAME] or available[:1]
    offered = quick if whole or choice.given else usual or quick[:1]
    selected = list(named) or [name for name in offered if choice.given <= FIGURES[name].follows]
    if measured := choice.measured:
        selected = [name for name in selected if measured.lies_in(name, choice.quantities)]
        if not selected:
            raise BadInput(
                f"--measured {measured.name}: found {', '.join(measured.points)}, which no chosen figure "
                "or quantity shows"
            )
    drawable = [name for name in selected if name == FILM or FIGURES[name].has(of)]
    if len(drawable) < len(named) or (choice.given and not drawable):
        raise BadInput(
            f"the archive has nothing to draw for {_options(choice.given)}"
            f"{' together' * (len(choice.given) > 1)}; it has the figures {', '.join(available)}"
        )
    return drawable


def _options(names: set[str]) -> str:
    return ", ".join(f"--{'quantity' if name == 'quantities' else name}" for name in sorted(names))
