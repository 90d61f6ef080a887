"""Figures of an archive by name, and the choice of those that are drawn."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

from galinx.postprocess.figures.canvas import TooSmall
from galinx.postprocess.figures.maps import FORMATS as OF_FILMS
from galinx.postprocess.quantities.quantity import METHODS
from galinx.postprocess.units import Units, contacts_of_states

from ..errors import BadInput
from ..pictures import film, friction, motion, numerics, surface, sweep
from ..pictures.choice import FILM, Choice, Drawing, Files, Written, require_one_of
from ..plan.plan import make_plan
from ..scene.scene import Scene

__all__ = ["Drawing", "names", "of_archive", "write"]

_Data = dict[str, Any]

#: A choice that leaves everything open.
_PLAIN = Choice()


@dataclass(frozen=True)
class _Figure:
    """A kind of figure: the options that it follows, whether an archive has it, and how it is drawn."""

    follows: set[str]
    has: Callable[[_Data, Scene, Choice], bool]
    draw: Callable[[_Data, Scene, Choice], Drawing]


def _on_surface(data: _Data, choice: Choice) -> bool:
    available = surface.quantities(data, choice.method)
    return bool(available) and set(choice.quantities) <= set(available)


def _below(data: _Data, scene: Scene, choice: Choice) -> bool:
    if not surface.has_map(data, choice.method):
        return False
    return set(choice.quantities) <= set(surface.Fields(data, scene, choice).names)


def _no_figure(data: _Data, scene: Scene, choice: Choice) -> Drawing:
    raise AssertionError("a film is no figure")


#: By name, in the order they are drawn.
_FIGURES = {
    "friction": _Figure({"states"}, lambda data, scene, _: not scene.steady, friction.friction),
    "parameters": _Figure(
        {"states", "method", "x", "y", "by"}, sweep.has_parameters,
        sweep.parameters,
    ),
    "surface": _Figure(
        {"states", "quantities", "method"}, lambda data, scene, choice: _on_surface(data, choice),
        surface.surface,
    ),
    "interfaces": _Figure(
        {"states", "quantities", "method"}, 
        lambda data, scene, choice: surface.has_interfaces(data, choice),
        surface.interfaces,
    ),
    "inside": _Figure({"states", "quantities", "method"}, _below, surface.inside),
    "slider": _Figure(set(), lambda data, scene, _: friction.has_slider(data), friction.slider),
    "time": _Figure(set(), lambda data, scene, _: motion.has_motions(data), motion.time),
    "pressures": _Figure(set(), lambda data, scene, _: motion.has_pressures(data), motion.pressures),
    "stresses": _Figure(
        set(), lambda data, scene, _: motion.has_surface(data), motion.stresses
    ),
    "energies": _Figure(set(), lambda data, scene, _: motion.has_energies(data), motion.energies),
    "angles": _Figure(set(), lambda data, scene, _: sweep.has_angles(scene), sweep.angles),
    "thicknesses": _Figure(
        set(), lambda data, scene, _: sweep.has_thicknesses(data, scene), sweep.thicknesses
    ),
    "degrees": _Figure(set(), lambda data, scene, _: numerics.has_degrees(data), numerics.degrees),
    "mesh": _Figure(set(), lambda data, scene, _: bool(make_plan(scene).fem), numerics.mesh),
    FILM: _Figure(
        {"states", "quantities", "method"},
        lambda data, scene, choice: film.has_film(data, scene, choice)
        or any(has for has, _ in _films(data)),
        _no_figure,
    ),
}  # fmt: skip


def in_units(choice: Choice, units: Units) -> Choice:
    """A choice whose figures have the units of a result: MPa, and mm where contacts differ."""
    if units.dimensionless:
        return choice
    own = contacts_of_states(units.data)
    unit = units.load / (2e6 * units.half_width)
    return replace(choice, unit=unit, ends=(1e3 * own[0], 1e3 * own[1]) if own else None)


def of_archive(data: _Data, scene: Scene, choice: Choice = _PLAIN) -> Iterator[Drawing]:
    """Every figure that an archive's data allow and a choice selects, one after the other.

    Raises:
        BadInput: the archive lacks a selected figure or quantity; the message says what it has.
    """
    for name in names(data, scene, choice):
        if name != FILM:
            try:
                yield _FIGURES[name].draw(data, scene, choice)
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
    in_time = [make for has, make in _films(data) if has]
    made = film.film if not in_time or film.has_film(data, scene, choice) else in_time[0]
    whole = (lambda: made(data, scene, choice)) if FILM in selected else None
    return files.write(of_archive(data, scene, choice), whole)


def _films(data: _Data) -> tuple[tuple[bool, Any], ...]:
    """Films of motions in time: whether an archive has the data, and the function that makes the film."""
    return (
        (motion.has_film(data), motion.film_of_surface),
        (motion.has_pressures(data), motion.pressure_film),
    )  # fmt: skip


def names(data: _Data, scene: Scene, choice: Choice = _PLAIN) -> list[str]:
    """Names of the figures that a choice selects.

    Raises:
        BadInput: the archive lacks a selected figure or quantity; the message says what it has.
    """
    choice.check_states(data)
    if choice.method:
        require_one_of("method", choice.method, METHODS)
    there_are = [name for name, figure in _FIGURES.items() if figure.has(data, scene, _PLAIN)]
    for name in choice.figures:
        # A film that the archive has too few states for says so itself.
        require_one_of("figure", name, dict.fromkeys([*there_are, FILM]))
        if ignored := choice.given - _FIGURES[name].follows:
            raise BadInput(f"--figure {name} follows no {_options(ignored)}; leave that away")
    for name in choice.quantities:
        require_one_of("quantity", name, dict.fromkeys(_quantities(data, scene)))
    selected = choice.figures or [
        name for name in there_are if name != FILM and choice.given <= _FIGURES[name].follows
    ]
    drawable = [name for name in selected if name == FILM or _FIGURES[name].has(data, scene, choice)]
    if not drawable or (choice.figures and len(drawable) < len(choice.figures)):
        raise BadInput(
            f"the archive has nothing to draw for {_options(choice.given)} together; it has the figures "
            f"{', '.join(there_are)}"
        )
    return drawable


def _quantities(data: _Data, scene: Scene) -> list[str]:
    below = surface.Fields(data, scene, _PLAIN).names if surface.has_map(data) else []
    return [*surface.quantities(data), *surface.interface_quantities(data), *below]


def _options(names: set[str]) -> str:
    options = {"quantities": "--quantity"}
    return ", ".join(options.get(name, f"--{name}") for name in sorted(names))
