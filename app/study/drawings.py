"""The study's figures: which states they show, and how they are drawn."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.postprocess.quantities.states import FRICTION, RATIO
from galinx.postprocess.quantities.stresses import IN_PLANE, PRESSURE, SURFACE_X
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.edges import under_punch
from galinx.solvers.friction import LAWS
from galinx.solvers.parameters import fields
from galinx.texts import number, plain

from ..figures.choice import PLACE, STROKE, Archive, C, Choice, Drawing
from ..figures.friction import Loops, loop_panel, loops_figure
from ..figures.numerics import mesh_figure
from ..figures.render import MARKERS, Curve, Panel, lines_and_markers, render
from ..figures.sketches import problem_figure, procedure_figure
from ..figures.stresses import Along, Shown, broken, limits, surface_panel
from ..figures.style import COLOURS, GREY, LINES, Look, looks
from ..plan.plan import make_plan
from ..plan.states import enumerate_states
from ..scene import read as scenes
from ..scene.library import SCENES
from ..scene.scene import Scene
from .published import FAST, MILDER, REFERENCE, SLOW

#: The study's strokes.
FM1, BM1, FM2 = "FM1", "BM1", "FM2"

#: Parameters of Dahl's law, one varied after the other, and the values of the other two meanwhile.
_MU, _SIGMA, _DELTA = "mu_c", "sigma0_over_load", "delta"
VARIED = {
    _MU: (0.1, 0.3, 0.5, 0.7),
    _SIGMA: (12500.0, 25000.0, 50000.0),
    _DELTA: (0.8, 1.0, 1.2, 1.5),
}
#: Speeds of Fig 6 (a).
SPEEDS = (SLOW, 0.2, 0.4, FAST)

#: By the name of the figure, but for those of stresses.
CAPTIONS = {
    "fig1":
        "Fig 1. The problem: a rigid flat punch under the loads N and F per depth slides at the speed V "
        "over an elastic half-plane; the axes move with it. Friction drags the surface along. In "
        "forward motion X = -a trails and X = a leads.",
    "fig2":
        "Fig 2. The friction loop: friction builds up from rest over the first stroke (FM1), and is "
        "built up once more, the other way, after each turn (BM1, FM2).",
    "fig3":
        "Fig 3. From friction to stresses. Numbers are those of the study's equations. Finite elements "
        "are given the friction coefficient alone, and compared with the integral equation.",
    "fig4":
        "Fig 4. The block that stands for the half-plane (scene box), W = 200 a wide and H = 100 a "
        "high, so that the punch is 2a/W = 0.01 and 2a/H = 0.02 of it, as the study has it, and the "
        "finer zone under the punch (black), whose cells are graded towards its edges. The study has "
        "145 106 quadrilaterals with mid-side nodes; these are {cells} of a high degree.",
    "fig6":
        "Fig 6. What speed and parameters do to the loop: (a) the speed nothing, the four loops are "
        "one, drawn one in the other; (b) μ_C sets how high friction comes, (c) σ₀ l/N how soon, and "
        "(d) δ_D how sharply it turns.",
    "sinusoidal":
        "Friction in sinusoidal motion (scene sinusoidal), of which the study's section 2 speaks: "
        "Dahl's law knows the way alone, so that over position the loop is that of Fig 2, nearly closed "
        "from the second cycle on; over time friction changes slowest at a turn, and fastest soon after. "
        "Its small corners are the path's, which is straight between its points.",
    "laws":
        "Friction laws by their contact stresses, which the study names as future work: {laws} with the "
        "same μ_C = 0.5 and, but for Coulomb's law, the same slope of 25 000/m at f = 0, in FM2 at X/L "
        "= {at:g}. Stresses follow f alone; laws that agree at full slip differ most behind a turn. Of "
        "these LuGre's law alone knows the speed: it falls from μ_S = 0.6 at rest to μ_C in fast "
        "sliding. In (a) lines are FM1, dashes BM1 and dots with dashes FM2.",
}  # fmt: skip
_CLOSED = " Lines and markers are the closed form"
_DIFFER = "; finite elements differ from it by what the last row shows"
_ENDS = (
    " X = -a is the trailing end in forward motion (FM1, FM2) and the leading one in backward motion "
    "(BM1); the study calls X = +a the leading end in all of them."
)


@dataclass(frozen=True)
class Stresses:
    """A figure of stresses: rows of panels, each with the same curves at its own value of a parameter.

    Attributes:
        caption: what the figure shows.
        at: parameters that all states share.
        row, rows: parameter that distinguishes the rows, and its values.
        curve, curves: parameter that distinguishes the curves, and its values.
        speeds: over c_s, drawn as lines, then as markers; at a single speed the closed form is drawn as
            lines, finite elements as markers.
    """

    caption: str
    at: dict[str, Any]
    row: str
    rows: tuple[Any, ...]
    curve: str
    curves: tuple[Any, ...]
    speeds: tuple[float, ...] = (SLOW, FAST)


#: By name.
STRESSES = {
    "fig5": Stresses(
        "Fig 5. Slow sliding (SS), at two places of three strokes: closed form as lines, finite "
        "elements, on a confocal mesh and not on the block of Fig 4, as markers. The pressure leans to "
        "the end that trails, where the surface is pulled; it is pressed at the other. BM1 at X/L = 0.2 "
        "has gone 0.8 L from its turn, at 0.8 only 0.2 L.",
        REFERENCE, STROKE, (FM1, BM1, FM2), PLACE, (0.2, 0.8), (SLOW,),
    ),
    "fig7": Stresses(
        "Fig 7. Slow (SS) and high speed (HS) at three places of three strokes. X/L is measured on one "
        "axis, as in Tables 4 and 5: at X/L = 1 BM1 has not left its turn and is FM1 still. Dotted is "
        "BM1 (SS) where it has travelled X/L since its turn, that is at 1 - X/L on the axis; what the "
        "study says of BM1 (slight differences at 0.2, notable ones at 0.5 and 1.0) fits this reading "
        "alone.",
        REFERENCE, PLACE, (0.2, 0.5, 1.0), STROKE, (FM1, BM1, FM2),
    ),
    "fig8": Stresses(
        "Fig 8. What μ_C does in FM1, slow (SS) and at high speed (HS): the more, the further the punch "
        "has come. At the beginning of the stroke σ₀ l/N alone sets the slope of friction.",
        REFERENCE | {STROKE: FM1}, PLACE, (0.2, 0.8), _MU, VARIED[_MU],
    ),
    "fig9": Stresses(
        "Fig 9. What σ₀ l/N does at X/L = 0.2, slow (SS) and at high speed (HS), with μ_C = 0.5: in "
        "FM1 friction is nearer to its full value, in FM2 it still points backward at 12 500/m and "
        "forward above. In FM1 the more of it, the larger the pressure at X = -a, and the nearer the top "
        "of the curve, the least pressure, to X = +a: the study says that it slants to the leading end.",
        MILDER | {PLACE: 0.2}, STROKE, (FM1, FM2), _SIGMA, VARIED[_SIGMA],
    ),
    "fig10": Stresses(
        "Fig 10. What δ_D does at X/L = 0.4 of FM1, slow (SS) and at high speed (HS), with μ_C = 0.5: "
        "a little less friction, hence less pressure and tension at X = -a, and less compression ahead "
        "at X = +a.",
        MILDER | {STROKE: FM1}, PLACE, (0.4,), _DELTA, VARIED[_DELTA],
    ),
}  # fmt: skip


#: Laws that are set beside each other on contact stresses: what they are called, and their
#: parameters; and where on FM2.
_ELEMENTS = ((13000.0, 0.15), (8000.0, 0.2), (4000.0, 0.15))
_AT = 0.3
_CURVE = {"mu_c": (0.5,), "mu_s": (0.6,), "stribeck_velocity": (3e-3,), "sigma0_over_load": (25000.0,)}
LAWS_SHOWN: dict[str, tuple[str, dict[str, tuple[Any, ...]]]] = {
    "coulomb": ("Coulomb", {"mu_c": (0.5,)}),
    "dahl": ("Dahl", {key: (value,) for key, value in MILDER.items()}),
    "bouc_wen": (
        "Bouc-Wen, $n = 4$",
        {"mu_c": (0.5,), "yield_displacement": (2e-5,), "exponent": (4.0,)},
    ),
    "maxwell_slip": ("Maxwell slip", {"elements": (_ELEMENTS,)}),
    "lugre": ("LuGre", _CURVE),
}


def of_study(data: dict[str, Any], scene: Scene) -> Iterator[Drawing]:
    """Figs 1 to 10 of the study from an archive of scenes/study.toml, and two that it speaks of."""
    of, fig6 = Archive(data, scene, Choice()), scenes.read(SCENES / "fig6.toml")
    reference = _state(of, REFERENCE)
    of_reference = plain(of.label(reference, [*REFERENCE]))
    yield Drawing("fig1", CAPTIONS["fig1"], problem_figure())
    yield Drawing(
        "fig2",
        f"{CAPTIONS['fig2']} {of_reference}.",
        loops_figure([Loops(of).panel([reference], [])], []),
    )
    yield Drawing("fig3", CAPTIONS["fig3"], procedure_figure())
    block = make_plan(scenes.read(SCENES / "box.toml")).fem  # nothing is solved on it
    assert block
    figure, cells = mesh_figure(block, zooms=(100.0, 4.0, 0.05), first="the whole block")
    yield Drawing("fig4", CAPTIONS["fig4"].format(cells=cells), figure, pixels=True)
    yield stresses_drawing("fig5", of)
    yield Drawing("fig6", CAPTIONS["fig6"], _loops(Loops(_archive(fig6))))
    for name in ("fig7", "fig8", "fig9", "fig10"):
        yield stresses_drawing(name, of)
    yield _sinusoidal(scenes.read(SCENES / "sinusoidal.toml"))
    yield _laws(scene, data[SURFACE_X.path])


def _sinusoidal(scene: Scene) -> Drawing:
    """Friction over time and position of a motion that is prescribed point by point."""
    (loop,) = Loops(_archive(scene)).of([0], [])
    assert scene.motion.path
    times = np.array([t for t, _ in scene.motion.path])
    points = len(loop.f) // len(scene.legs)
    t = np.concatenate([np.linspace(start, end, points) for start, end in pairwise(times)])
    cycle = times[np.flatnonzero(np.array(scene.motion.path)[:, 1] == 0.0)[1]]
    _, force = looks(2)
    over_time = Panel(
        "time over that of a cycle", "position $X/L$, friction $f$", title="over time", at_y=(0.0,),
        curves=[
            Curve(t / cycle, loop.X_over_L, Look(GREY, LINES[1], ""), "position $X/L$"),
            Curve(t / cycle, loop.f, force._replace(line="-"), "friction $f$"),
        ],
    )  # fmt: skip
    over_position = replace(loop_panel([loop]), title="over position")
    return Drawing("sinusoidal", CAPTIONS["sinusoidal"], render([over_time, over_position]))


def _archive(scene: Scene) -> Archive:
    """Friction of a scene, which nothing is solved for."""
    return Archive(enumerate_states(scene).datasets, scene, Choice())


def _laws(scene: Scene, X: NDArray) -> Drawing:
    """Contact stresses of several friction laws, by the closed form."""
    loops, dots, curves = [], [], {name: list[Shown]() for name in _AXES}
    motion = replace(scene.motion, c=(SLOW, FAST), X_over_L=(_AT,))
    for (name, (called, values)), look in zip(LAWS_SHOWN.items(), looks(len(LAWS_SHOWN))):
        given = {key: (field.default,) for key, field in fields(LAWS[name]).items()} | values
        friction = replace(scene.friction, law=LAWS[name], parameters=given, vary=())
        own = replace(scene, friction=friction, motion=motion)
        archive = _archive(own)
        at = [_state(archive, {STROKE: FM2, C: c}) for c in (SLOW, FAST)]
        g = archive.data[RATIO.path]
        punches = [FlatPunch(scene.solid.response(c), g[i]) for c, i in zip((SLOW, FAST), at)]
        slow, fast = (
            [[np.where(under_punch(X), punch.σ_YY(X), np.nan)], [punch.σ_XX(X)]] for punch in punches
        )
        for name_, along in _stresses(X, slow, fast).items():
            curves[name_] += along.shown([look._replace(line="-")])  # as the legend has it
        loops += [replace(loop, label=called) for loop in Loops(archive).of(at[:1], [])]
        place = np.array([_AT]), archive.data[FRICTION.path][at[:1]]
        dots.append(Curve(*place, look, "", MARKERS))
    left = loop_panel(loops)
    panels = [replace(left, curves=[*left.curves, *dots], title="loops, and the place shown")]
    panels += _stress_panels([(f"FM2, $X/L = {_AT:g}$", curves)])
    notes = lines_and_markers(*_slow_and_fast(archive, at))
    names = ", ".join(plain(called) for called, _ in LAWS_SHOWN.values())
    caption = CAPTIONS["laws"].format(laws=names, at=_AT)
    return Drawing("laws", caption, render(panels, None, 3, notes, high=0.95))


def _loops(loops: Loops) -> Any:
    """Loops over speed, then over each parameter of the law."""
    of = loops.archive
    over = {C: (REFERENCE, SPEEDS)} | {name: (MILDER, values) for name, values in VARIED.items()}
    panels = []
    for name, (at, values) in over.items():
        states = [_state(of, at | {name: value}) for value in values]
        others = [other for other in REFERENCE if other != name]
        # A panel of the archive's has every loop once; that of the speeds shows that there is but one.
        shown = loops.of(states, [name])
        if name == C:
            shown = [replace(loop, label=f"$c = {number(c)}$") for loop, c in zip(shown, SPEEDS)]
        panels.append(loop_panel(shown, True, of.label(states[0], others)))
    return loops_figure(panels, shown)


#: Axes of the two stresses.
_AXES = {
    "sigma_YY": r"contact stress $\sigma_{YY}/(N/2a)$",
    "sigma_XX": r"in-plane stress $\sigma_{XX}/(N/2a)$",
}
#: Differences below this are those of rounding [N/(2a)], and height of their panels over the others'.
_LEAST, _FLAT = 1e-15, 0.5


def _stresses(X: NDArray, lines: Any, markers: Any = None) -> dict[str, Along]:
    """Stresses drawn as lines, and as markers: σ_YY and σ_XX of each curve, (2, curves, points)."""
    drawn, places = {CLOSED_FORM: lines} | ({} if markers is None else {FEM: markers}), [(1.0, 0.0)]
    return {
        name: Along(X, axis, {by: np.asarray(y[n]) for by, y in drawn.items()}, places * len(lines[0]))
        for n, (name, axis) in enumerate(_AXES.items())
    }


def _stress_panels(rows: Sequence[tuple[str, Mapping[str, list[Shown]]]]) -> list[Panel]:
    """Panels of both stresses, row by row with title and curves, between limits that all rows share."""
    ylim = {}
    for name in _AXES:
        every = [curve for _, curves in rows for curve in curves[name]]
        values = [y[curve.row] for curve in every for y in curve.along.values.values()]
        ylim[name] = limits(every[0].along.X, np.array(values))
    return [
        surface_panel(curves[name], ylim[name], title=title) for title, curves in rows for name in _AXES
    ]


def stresses_drawing(name: str, of: Archive) -> Drawing:
    """A figure of stresses by its name: row by row, and below them the differences of both methods."""
    figure, data, X = STRESSES[name], of.data, of.data[SURFACE_X.path]
    single = len(figure.speeds) == 1
    marked = FEM if single else CLOSED_FORM
    solved = {method: PRESSURE[method].path in data for method in (CLOSED_FORM, FEM)}
    rows: list[tuple[str, dict[str, list[Shown]]]] = []
    states: list[list[int]] = []
    for value in figure.rows:
        at = figure.at | {figure.row: value}
        pairs = [
            [_state(of, at | {figure.curve: curve, C: c}) for c in figure.speeds]
            for curve in figure.curves
        ]
        states += pairs
        first, last = [pair[0] for pair in pairs], [pair[-1] for pair in pairs]
        markers, by = _values(data, marked, last) if solved[marked] else None, [figure.curve]
        styles, called = of.looks(first, by), [of.label(i, by) for i in first]
        stressed = _stresses(X, _values(data, CLOSED_FORM, first), markers)
        curves = {name: along.shown(styles, called) for name, along in stressed.items()}
        if name == "fig7":
            travelled = _state(of, at | {STROKE: BM1, C: SLOW, PLACE: 1.0 - value})
            label = "BM1 (SS), $X/L$ travelled since its turn"
            for name_, along in _stresses(X, _values(data, CLOSED_FORM, [travelled])).items():
                curves[name_].append(Shown(along, 0, Look(COLOURS[6], LINES[3], ""), label, 0.8))
        rows.append((of.label(first[0], [figure.row]), curves))
    panels = _stress_panels(rows)
    panels = [*(replace(panel, x=None) for panel in panels[:-2]), *panels[-2:]]
    if not single and solved[FEM]:
        panels += [_difference_panel(data, states, column, panels[column]) for column in range(2)]
    says = ("closed form", "finite elements") if single else _slow_and_fast(of, states[0])
    drawn = render(panels, None, 2, lines_and_markers(*says), high=0.5)
    others = [key for key in figure.at if key not in (STROKE, figure.curve, figure.row)]
    shared = plain(of.label(states[0][0], others))
    methods = "" if single else f"{_CLOSED}{_DIFFER * solved[FEM]}."
    return Drawing(name, f"{figure.caption} All with {shared}.{methods}{_ENDS}", drawn)


def _difference_panel(
    data: dict[str, Any], states: Sequence[Sequence[int]], column: int, above: Panel
) -> Panel:
    """Panel of the largest difference of both methods, of pairs of states at both speeds."""
    X, curves = data[SURFACE_X.path], list[Curve]()
    for n in range(2):
        of = [pair[n] for pair in states]
        off = np.abs(_values(data, FEM, of) - _values(data, CLOSED_FORM, of)).max(axis=1)[column]
        look = Look(COLOURS[-2], LINES[n], "")
        curves.append(Curve(*broken(X, np.maximum(off, _LEAST)), look, width=0.8))
    return Panel(
        "position on the surface $X/a$", r"$|\Delta\sigma|/(N/2a)$", curves=curves, xlim=above.xlim,
        log="y", tall=_FLAT, title="largest difference of both methods: SS line, HS dashes",
    )  # fmt: skip


def _slow_and_fast(of: Archive, states: Sequence[int]) -> tuple[str, str]:
    """Legend texts of lines and markers, for two states at the study's speeds."""
    slow, fast = (of.label(state, [C]) for state in states)
    return f"SS, {slow}", f"HS, {fast}"


def _values(data: dict[str, Any], method: str, states: Any) -> NDArray[np.float64]:
    """σ_YY and σ_XX of states over N/(2a), (2, …, points)."""
    return np.array([data[rows[method].path][states] for rows in (PRESSURE, IN_PLANE)])


def _state(of: Archive, values: dict[str, Any]) -> int:
    """Number of the first state whose named parameters have the given values."""
    return int(of.where(of.all, **values)[0])
