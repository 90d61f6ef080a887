"""Figures of an archive by name, the choice of those that are drawn, and a film of strokes: where
friction is, and what that does to the stresses."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities.quantity import METHODS
from galinx.postprocess.quantities.states import FRICTION
from galinx.postprocess.quantities.stresses import SURFACE_X
from galinx.postprocess.units import Units
from galinx.texts import number

from ..errors import BadInput
from ..plan.plan import make_plan
from ..scene.scene import Scene
from . import along, friction, motion, numerics, stresses, sweep
from .choice import Archive, Choice, Drawing, require_one_of
from .files import FILM, OF_FILMS, Files, Written
from .friction import Loops, loop_panel
from .render import Curve, Film, Panel, TooSmall
from .states import PLACE, STROKE, StateLabels, not_shown
from .style import Look, looks

_Data = dict[str, Any]
#: A choice that leaves everything open, and the name that stands for all figures.
_PLAIN, ALL = Choice(), "all"


@dataclass(frozen=True)
class _Figure:
    """A kind of figure: how it is drawn, whether an archive has it, the options that it follows, and
    whether it is drawn without being named."""

    draw: Callable[[Archive], Drawing]
    has: Callable[[Archive], bool]
    follows: frozenset[str] = frozenset()
    usual: bool = False


_STRESSES = frozenset({"states", "quantities", "method"})


def _no_figure(of: Archive) -> Drawing:
    raise AssertionError("a film is no figure")


#: Frames that a film has at least.
_LEAST_FRAMES = 4


def _has_film(of: Archive) -> bool:
    """Return True if an archive has enough states along the strokes, or times, and stresses to show."""
    return _has_strokes(of) or motion.has_film(of) or motion.has_pressures(of)


def _has_strokes(of: Archive) -> bool:
    shown = stresses.surface_names(of) or stresses.has_map(of)
    return bool(shown) and len(_frames(of)) >= _LEAST_FRAMES


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
    labels, frames = of.labels, _frames(of)
    if len(frames) < _LEAST_FRAMES:
        raise BadInput(
            f"a film needs at least {_LEAST_FRAMES} states along strokes, found {len(frames)}; give "
            "motion.X_over_L more places"
        )
    loop = Loops(of).of(int(frames[0]))
    if loop is None:
        raise BadInput("a film needs the friction loop, which archives of more than 1 000 laws leave out")
    f, X = of.data[FRICTION.path], labels.values(PLACE)
    base = loop_panel([replace(loop, label="")])
    beside = _stresses_of(of, frames)

    def panels(frame: int) -> list[Panel]:
        i = int(frames[frame])
        dot = Curve(X[i : i + 1], f[i : i + 1], Look("black", "none", "o"), form="markers")
        title = f"{labels.label(i, [STROKE, PLACE])}, $f = {number(f[i], 2)}$"
        return [replace(base, curves=[*base.curves, dot], title=title), *beside[frame]]

    return Film(panels, len(frames), of.size), not_shown(
        labels, frames.tolist(), "--figure film --states", of.choice.states
    )


def _stresses_of(of: Archive, frames: NDArray) -> list[list[Panel]]:
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


def _frames(of: Archive) -> NDArray[np.int64]:
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


#: By name, in the order they are drawn; the usual ones answer what is asked most.
FIGURES = {
    "surface": _Figure(stresses.surface, stresses.has_surface, _STRESSES | {"measured"}, True),
    "along": _Figure(along.along, along.has_along, frozenset({"states", "method"}), True),
    "inside": _Figure(stresses.inside, stresses.has_inside, _STRESSES, True),
    "parameters": _Figure(
        sweep.parameters, sweep.has_parameters, frozenset({"states", "method", "x", "y", "by"}), True
    ),
    "friction": _Figure(
        friction.friction, lambda of: not of.scene.steady, frozenset({"states", "measured"}), True
    ),
    "slider": _Figure(friction.slider, friction.has_slider, usual=True),
    "time": _Figure(motion.time, motion.has_motions, usual=True),
    "interfaces": _Figure(stresses.interfaces, stresses.has_interfaces, _STRESSES),
    "pressures": _Figure(motion.pressures, motion.has_pressures),
    "stresses": _Figure(motion.stresses, motion.has_surface),
    "energies": _Figure(motion.energies, motion.has_energies),
    "degrees": _Figure(numerics.degrees, numerics.has_degrees),
    "mesh": _Figure(numerics.mesh, lambda of: bool(make_plan(of.scene).fem)),
    FILM: _Figure(_no_figure, _has_film, _STRESSES),
}


def in_units(choice: Choice, units: Units) -> Choice:
    """A choice whose figures have the units of a result."""
    return replace(choice, units=units)


def of_archive(data: _Data, scene: Scene, choice: Choice = _PLAIN) -> Iterator[Drawing]:
    """The figures that a choice selects, one after the other.

    Raises:
        BadInput: the archive lacks a selected figure or quantity; the message says what it has.
    """
    of = Archive(data, scene, choice)
    for name in names(data, scene, choice):
        if name != FILM:
            try:
                yield FIGURES[name].draw(of)
            except TooSmall as error:
                raise BadInput(f"--size: the figure {name} does not fit; {error}") from error


def write(data: _Data, scene: Scene, choice: Choice, files: Files) -> list[Written]:
    """Write the figures of :func:`of_archive`, and the film if it is selected.

    Raises:
        BadInput: the archive lacks a selected figure or quantity, or it cannot be written in this format.
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    if not choice.figures and (files.ending in OF_FILMS or set(files.formats) & OF_FILMS.keys()):
        choice = replace(choice, figures=(FILM,))
    selected = names(data, scene, choice)
    files.check(selected)
    of = Archive(data, scene, choice)
    whole = (lambda: film(of)) if FILM in selected else None
    return files.write(of_archive(data, scene, choice), whole)


def names(data: _Data, scene: Scene, choice: Choice = _PLAIN) -> list[str]:
    """Names of the figures that a choice selects: by default those that answer what is asked most.

    Raises:
        BadInput: the archive lacks a selected figure or quantity; the message says what it has.
    """
    choice.check_states(data)
    if choice.method:
        require_one_of("method", choice.method, METHODS)
    plain = Archive(data, scene, replace(_PLAIN, units=choice.units))
    of = Archive(data, scene, choice)
    there_are = [name for name, figure in FIGURES.items() if figure.has(plain)]
    whole = choice.figures == (ALL,)
    for name in () if whole else choice.figures:
        # A film that the archive has too few states for says so itself.
        require_one_of("figure", name, dict.fromkeys([*there_are, FILM]))
        if ignored := choice.given - FIGURES[name].follows:
            raise BadInput(f"--figure {name} follows no {_options(ignored)}; leave that away")
    for name in choice.quantities:
        require_one_of("quantity", name, dict.fromkeys(_quantities(plain)))
    usual = [name for name in there_are if FIGURES[name].usual and _answers(name, plain)]
    offered = there_are if whole or choice.given else usual or there_are[:1]
    selected = (() if whole else choice.figures) or [
        name for name in offered if name != FILM and choice.given <= FIGURES[name].follows
    ]
    if measured := choice.measured:
        selected = [name for name in selected if measured.lies_in(name, choice.quantities)]
        if not selected:
            raise BadInput(
                f"--measured {measured.name}: found {', '.join(measured.points)}, which no chosen figure "
                "or quantity shows"
            )
    drawable = [name for name in selected if name == FILM or FIGURES[name].has(of)]
    if not drawable or (choice.figures and not whole and len(drawable) < len(choice.figures)):
        raise BadInput(
            f"the archive has nothing to draw for {_options(choice.given)} together; it has the figures "
            f"{', '.join(there_are)}"
        )
    return drawable


def _answers(name: str, of: Archive) -> bool:
    """False for a loop of friction that is no loop."""
    return name != "friction" or friction.has_loop(of)


def _quantities(of: Archive) -> list[str]:
    below = stresses.Fields(of).names if stresses.has_map(of) else []
    return [*stresses.surface_names(of), *stresses.interface_names(of), *below]


def _options(names: set[str]) -> str:
    options = {"quantities": "--quantity"}
    return ", ".join(options.get(name, f"--{name}") for name in sorted(names))
