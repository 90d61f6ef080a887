"""The study's figures."""

from collections.abc import Iterator
from typing import Any

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing
from galinx.app.pictures.friction import Loops
from galinx.app.pictures.surface import column, stresses
from galinx.app.pictures.told import C
from galinx.app.scene.scene import Scene
from galinx.app.study.published import REFERENCE
from galinx.postprocess.figures.loops import loops_figure
from galinx.postprocess.figures.surface import Column, surface_figure
from galinx.postprocess.figures.typeset import plain
from galinx.postprocess.quantities.stresses import SURFACE_X

#: The study's two speeds, and its strokes.
SLOW, FAST = 4.786e-7, 0.6
STROKES = ("FM1", "BM1", "FM2")

_LOOP = (
    "Fig 2. The friction loop: friction builds up from rest over the first stroke (FM1), and is built up "
    "once more, the other way, after each turn (BM1, FM2)."
)
_PARAMETERS = (
    "Fig 6. What the parameters do to the loop: (a) μ_C sets how high friction comes, (b) σ₀ l/N how "
    "soon, and (c) δ_D how sharply it turns."
)
_STRESSES = (
    "sliding, at two places of three strokes. The pressure leans to the trailing edge; the surface is "
    "pulled behind the punch and pressed ahead of it. Where insets show the same friction, curves lie on "
    "each other."
)


def of_study(data: dict[str, Any], scene: Scene) -> Iterator[Drawing]:
    """Figs 2 and 5-10 of the study from an archive of scenes/study.toml."""
    loops = Loops(data, scene)
    told = loops.told
    reference = _state(loops, **REFERENCE)
    yield Drawing("fig2", _LOOP, loops_figure([loops.panel([reference], [])]))
    yield _slow_or_fast("fig5", f"Fig 5. Slow {_STRESSES}", data, loops, SLOW)
    panels = []
    middle = REFERENCE | {"mu_c": 0.5}
    for name in told.law:
        at = [_state(loops, **(middle | {name: value})) for value in told.distinct(name)]
        panels.append(loops.panel(at, [name]))
    yield Drawing("fig6", _PARAMETERS, loops_figure(panels))
    yield _slow_or_fast("fig7", f"Fig 7. Fast {_STRESSES}", data, loops, FAST)
    for figure, name in zip(("fig8", "fig9", "fig10"), told.law):
        columns = []
        for c in (SLOW, FAST):
            states = [
                _state(loops, c=c, motion=STROKES[0], X_over_L=0.8, **(middle | {name: value}))
                for value in told.distinct(name)
            ]
            columns.append(_column(data, loops, told.label(states[0], [C]), states, [name]))
        caption = (
            f"Fig {figure[3:]}. What {plain(f'${told.parameters[name].symbol}$')} does, slow and fast, "
            f"at X/L = 0.8 of {STROKES[0]}: it acts through friction, which the inset shows; more of it "
            "leans the pressure back and pulls the surface more behind the punch. Speed raises the "
            "in-plane stress."
        )
        yield Drawing(figure, caption, _figure(data, columns))


def _figure(data: dict[str, Any], columns: list[Column]) -> Any:
    return surface_figure(data[SURFACE_X.path], stresses(data, Choice()), columns)


def _column(
    data: dict[str, Any], loops: Loops, title: str, states: list[int], names: list[str]
) -> Column:
    return column(data, loops, title, states, names, loops.told.looks(states, names))


def _slow_or_fast(name: str, caption: str, data: dict[str, Any], loops: Loops, c: float) -> Drawing:
    columns = []
    for X in (0.2, 0.8):
        states = [_state(loops, c=c, X_over_L=X, motion=motion, **REFERENCE) for motion in STROKES]
        title = loops.told.label(states[0], [C, "X_over_L"])
        columns.append(_column(data, loops, title, states, ["motion"]))
    return Drawing(name, caption, _figure(data, columns))


def _state(loops: Loops, **values: Any) -> int:
    """The first state whose named parameters have the given values."""
    return int(loops.told.where(loops.told.all, **values)[0])
