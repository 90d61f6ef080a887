"""The study's Figs 2 and 5 to 10: which states they show, and how they are drawn."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing
from galinx.app.pictures.friction import Loops
from galinx.app.pictures.surface import stresses
from galinx.app.pictures.told import C, PLACE, STROKE, Told
from galinx.app.plan.states import enumerate_states
from galinx.app.scene import read as scenes
from galinx.app.scene.scene import Scene
from galinx.app.scene.templates import SCENES
from galinx.app.study.published import REFERENCE
from galinx.postprocess.figures.loops import Panel, loops_figure
from galinx.postprocess.figures.rows import Curve, Row, rows_figure
from galinx.postprocess.figures.style import COLOURS, LINES, Look
from galinx.postprocess.figures.surface import Stress
from galinx.postprocess.figures.typeset import number
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.postprocess.quantities.stresses import SURFACE_X

#: The study's two speeds over the shear wave speed, slow and high, and its strokes.
SS, HS = 4.786e-7, 0.6
FM1, BM1, FM2 = "FM1", "BM1", "FM2"

#: Parameters of Dahl's law, one varied after the other, and what the other two are then.
_MU, _SIGMA, _DELTA = "mu_c", "sigma0_over_load", "delta"
VARIED = {
    _MU: (0.1, 0.3, 0.5, 0.7),
    _SIGMA: (12500.0, 25000.0, 50000.0),
    _DELTA: (0.8, 1.0, 1.2, 1.5),
}
MIDDLE = REFERENCE | {_MU: 0.5}
#: Speeds of Fig 6 (a).
SPEEDS = (SS, 0.2, 0.4, HS)

_LOOP = (
    "Fig 2. The friction loop: friction builds up from rest over the first stroke (FM1), and is built up "
    "once more, the other way, after each turn (BM1, FM2)."
)
_PARAMETERS = (
    "Fig 6. What speed and parameters do to the loop: (a) the speed nothing, the four loops are one, drawn "
    "one in the other; (b) μ_C sets how high friction comes, (c) σ₀ l/N how soon, and (d) δ_D how sharply "
    "it turns."
)
_ENDS = (
    " X = -a is the trailing end in forward motion (FM1, FM2) and the leading one in backward motion (BM1); "
    "the study calls X = +a the leading end in all of them."
)


@dataclass(frozen=True)
class Stresses:
    """A figure of stresses: rows of panels, each with the same curves at a value of its own.

    Attributes:
        caption: what to see in it.
        at: parameters that all states share.
        row, rows: parameter that tells the rows apart, and its values.
        curve, curves: that of the curves.
        speeds: whose stresses are lines, then markers; of one both are drawn, by the closed form as
            lines, by finite elements as markers.
    """

    caption: str
    at: dict[str, Any]
    row: str
    rows: tuple[Any, ...]
    curve: str
    curves: tuple[Any, ...]
    speeds: tuple[float, ...] = (SS, HS)


#: By name.
STRESSES = {
    "fig5": Stresses(
        "Fig 5. Slow sliding (SS), at two places of three strokes: closed form as lines, finite elements as "
        "markers. The pressure leans to the end that trails, where the surface is pulled; it is pressed at "
        "the other. BM1 at X/L = 0.2 has gone 0.8 L from its turn, at 0.8 only 0.2 L.",
        REFERENCE, STROKE, (FM1, BM1, FM2), PLACE, (0.2, 0.8), (SS,),
    ),
    "fig7": Stresses(
        "Fig 7. Slow (SS) and high speed (HS) at three places of three strokes. X/L is measured on one axis, "
        "as in Tables 4 and 5: at X/L = 1 BM1 has not left its turn and is FM1 still. Dotted is BM1 (SS) where "
        "it has travelled X/L since its turn, that is at 1 - X/L on the axis; what the study says of BM1 "
        "(slight differences at 0.2, notable ones at 0.5 and 1.0) fits this reading alone.",
        REFERENCE, PLACE, (0.2, 0.5, 1.0), STROKE, (FM1, BM1, FM2),
    ),
    "fig8": Stresses(
        "Fig 8. What μ_C does in FM1, slow (SS) and at high speed (HS): little at the beginning of the stroke, "
        "where σ₀ l/N alone sets the friction, and the more, the further the punch has come.",
        REFERENCE | {STROKE: FM1}, PLACE, (0.2, 0.8), _MU, VARIED[_MU],
    ),
    "fig9": Stresses(
        "Fig 9. What σ₀ l/N does at X/L = 0.2, slow (SS) and at high speed (HS), with μ_C = 0.5: in FM1 friction "
        "is nearer to its full value, in FM2 it still points backward at 12 500/m and forward above. In FM1 the "
        "pressure slants the more to X = -a; the study says, to the leading end, which its Eq 25 makes of it.",
        MIDDLE | {PLACE: 0.2}, STROKE, (FM1, FM2), _SIGMA, VARIED[_SIGMA],
    ),
    "fig10": Stresses(
        "Fig 10. What δ_D does at X/L = 0.4 of FM1, slow (SS) and at high speed (HS), with μ_C = 0.5: a little "
        "less friction, hence less pressure and tension at X = -a, and less compression ahead at X = +a.",
        MIDDLE | {STROKE: FM1}, PLACE, (0.4,), _DELTA, VARIED[_DELTA],
    ),
}  # fmt: skip


def of_study(data: dict[str, Any], scene: Scene) -> Iterator[Drawing]:
    """Figs 2 and 5-10 of the study from an archive of scenes/study.toml."""
    loops, fig6 = Loops(data, scene), scenes.read(SCENES / "fig6.toml")
    reference = _state(loops.told, REFERENCE)
    yield Drawing("fig2", _LOOP, loops_figure([loops.panel([reference], [])]))
    yield stresses_drawing("fig5", data, loops.told)
    yield Drawing("fig6", _PARAMETERS, _loops(Loops(enumerate_states(fig6).datasets, fig6)))
    for name in ("fig7", "fig8", "fig9", "fig10"):
        yield stresses_drawing(name, data, loops.told)


def _loops(loops: Loops) -> Any:
    """Loops over speed, then over each parameter of the law."""
    told = loops.told
    over = {C: (REFERENCE, SPEEDS)} | {name: (MIDDLE, values) for name, values in VARIED.items()}
    panels = []
    for name, (at, values) in over.items():
        states = [_state(told, at | {name: value}) for value in values]
        others = [other for other in REFERENCE if other != name]
        # A panel of the archive's has every loop once; that of the speeds shows that there is but one.
        shown = [loop for loop in (loops.of(state, [name]) for state in states) if loop]
        if name == C:
            shown = [replace(loop, label=f"$c = {number(c)}$") for loop, c in zip(shown, SPEEDS)]
        panels.append(Panel(told.label(states[0], others), shown, True))
    return loops_figure(panels)


def stresses_drawing(name: str, data: dict[str, Any], told: Told) -> Drawing:
    """A figure of stresses, by its name."""
    figure = STRESSES[name]
    shown = stresses(data, Choice())
    rows, states = [], []
    for value in figure.rows:
        at = figure.at | {figure.row: value}
        found = [
            [_state(told, at | {figure.curve: one, C: c}) for c in figure.speeds] for one in figure.curves
        ]
        states += found
        looks = told.looks([some[0] for some in found], [figure.curve])
        curves = [
            _curve(told.label(some[0], [figure.curve]), look, shown, some)
            for some, look in zip(found, looks)
        ]
        if name == "fig7":
            travelled = _state(told, at | {STROKE: BM1, C: SS, PLACE: 1.0 - value})
            dots = Look(COLOURS[6], LINES[3], "")
            label = "BM1 (SS), $X/L$ travelled since its turn"
            curves.append(Curve(label, dots, _values(shown, CLOSED_FORM, travelled), width=0.8))
        rows.append(Row(told.label(found[0][0], [figure.row]), curves))
    if len(figure.speeds) == 1:
        says = ("lines: closed form", "markers: finite elements")
        differ: dict[str, NDArray] = {}
    else:
        words = (f"SS, {told.label(states[0][0], [C])}", f"HS, {told.label(states[0][1], [C])}")
        says = (f"lines: {words[0]}", f"markers: {words[1]}")
        differ = {} if FEM not in shown[0].values else {
            word: _differences(shown, [some[n] for some in states]) for n, word in enumerate(("SS", "HS"))
        }  # fmt: skip
    drawn = rows_figure(data[SURFACE_X.path], [stress.label for stress in shown], rows, says, differ)
    return Drawing(name, figure.caption + _ENDS, drawn)


def _curve(label: str, look: Look, shown: list[Stress], states: Sequence[int]) -> Curve:
    """Slow as a line and fast as markers, or one speed's closed form and finite elements."""
    method = CLOSED_FORM if len(states) > 1 else FEM
    has = method in shown[0].values
    markers = _values(shown, method, states[-1]) if has else None
    return Curve(label, look, _values(shown, CLOSED_FORM, states[0]), markers)


def _values(shown: list[Stress], method: str, state: int) -> NDArray[np.float64]:
    return np.array([stress.values[method][state] for stress in shown])


def _differences(shown: list[Stress], states: list[int]) -> NDArray[np.float64]:
    """Largest differences between closed form and finite elements of some states, (stresses, points)."""
    apart = [stress.values[FEM][states] - stress.values[CLOSED_FORM][states] for stress in shown]
    return np.abs(np.array(apart)).max(axis=1)


def _state(told: Told, values: dict[str, Any]) -> int:
    """The first state whose named parameters have the given values."""
    return int(told.where(told.all, **values)[0])
