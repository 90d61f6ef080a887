"""Figures of an archive by name, and the choice of those that are drawn."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

from galinx.postprocess.quantities.quantity import METHODS
from galinx.postprocess.units import Units

from ..errors import BadInput
from ..plan.plan import make_plan
from ..scene.scene import Scene
from . import along, film, friction, motion, numerics, stresses, sweep
from .choice import Archive, Choice, Drawing, require_one_of
from .files import OF_FILMS, Files, Written
from .film import FILM
from .render import TooSmall

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
    "angles": _Figure(sweep.angles, sweep.has_angles),
    "thicknesses": _Figure(sweep.thicknesses, sweep.has_thicknesses),
    "degrees": _Figure(numerics.degrees, numerics.has_degrees),
    "mesh": _Figure(numerics.mesh, lambda of: bool(make_plan(of.scene).fem)),
    FILM: _Figure(_no_figure, film.has_film, _STRESSES),
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
    whole = (lambda: film.film(of)) if FILM in selected else None
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
