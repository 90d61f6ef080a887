"""Which figures an archive has, and which of them are wanted."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from galinx.app.errors import BadInput
from galinx.app.pictures import friction, inside, numerics, surface, sweep
from galinx.app.pictures.choice import Choice, one_of
from galinx.app.pictures.drawing import METHODS, Drawing, there
from galinx.app.plan.plan import make_plan
from galinx.app.scene.scene import Scene

__all__ = ["Drawing", "drawn", "of_archive", "there"]

_Data = dict[str, Any]


@dataclass(frozen=True)
class _Figure:
    """A kind of figure: which options it follows, whether an archive has it, and how it is drawn."""

    follows: set[str]
    has: Callable[[_Data, Scene, Choice], bool]
    draw: Callable[[_Data, Scene, Choice], Drawing]


def _on_surface(data: _Data, choice: Choice) -> bool:
    known = surface.quantities(data, choice.method)
    return bool(known) and set(choice.quantities) <= set(known)


def _below(data: _Data, scene: Scene, choice: Choice) -> bool:
    if not inside.has_map(data, choice.method):
        return False
    return set(choice.quantities) <= set(inside.Fields(data, scene, choice.method).names)


#: By name, in the order they are drawn.
_FIGURES = {
    "friction": _Figure({"states"}, lambda data, scene, _: True, friction.friction),
    "parameters": _Figure(
        {"states", "method", "x", "y", "by"}, lambda data, scene, choice: sweep.has(data, scene, choice),
        sweep.parameters,
    ),
    "surface": _Figure(
        {"states", "quantities", "method"}, lambda data, scene, choice: _on_surface(data, choice),
        surface.surface,
    ),
    "inside": _Figure({"states", "quantities", "method"}, _below, inside.inside),
    "degrees": _Figure(set(), lambda data, scene, _: numerics.has_degrees(data), numerics.degrees),
    "mesh": _Figure(set(), lambda data, scene, _: bool(make_plan(scene).fem), numerics.mesh),
}  # fmt: skip


def of_archive(data: _Data, scene: Scene, choice: Choice = Choice()) -> Iterator[Drawing]:
    """Every figure that an archive's data allow and a choice wants, one after the other.

    Raises:
        BadInput: what is wanted is not there; the message says what is.
    """
    for name in drawn(data, scene, choice):
        yield _FIGURES[name].draw(data, scene, choice)


def drawn(data: _Data, scene: Scene, choice: Choice = Choice()) -> list[str]:
    """Names of the figures that :func:`of_archive` draws.

    Raises:
        BadInput: what is wanted is not there; the message says what is.
    """
    choice.check_states(data)
    if choice.method:
        one_of("--method", choice.method, METHODS)
    plain = Choice()
    there_are = [name for name, figure in _FIGURES.items() if figure.has(data, scene, plain)]
    for name in choice.figures:
        one_of("--figure", name, there_are)
        if ignored := choice.given - _FIGURES[name].follows:
            raise BadInput(f"--figure {name} follows no {_options(ignored)}; leave that away")
    for name in choice.quantities:
        one_of("--quantity", name, dict.fromkeys(_quantities(data, scene)))
    wanted = choice.figures or [
        name for name in there_are if choice.given <= _FIGURES[name].follows
    ]
    found = [name for name in wanted if _FIGURES[name].has(data, scene, choice)]
    if not found or choice.figures and len(found) < len(choice.figures):
        raise BadInput(
            f"the archive has nothing to draw for {_options(choice.given)} together; it has the figures "
            f"{', '.join(there_are)}"
        )
    return found


def _quantities(data: _Data, scene: Scene) -> list[str]:
    below = inside.Fields(data, scene).names if inside.has_map(data) else []
    return [*surface.quantities(data), *below]


def _options(names: set[str]) -> str:
    told = {"quantities": "--quantity"}
    return ", ".join(told.get(name, f"--{name}") for name in sorted(names))
