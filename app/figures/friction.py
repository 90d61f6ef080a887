"""Friction of an archive: loops of its states, stick-slip of its sliders; and fits to measurements."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from galinx.postprocess.quantities import column, runs
from galinx.postprocess.quantities.states import RESULTANT_RATIO
from galinx.postprocess.units import prefixed
from galinx.solvers.friction.motion import names

from ..plan.states import order
from .choice import Archive, Drawing, named
from .render import DOTS, Curve, Panel, Size, across, handle, render
from .states import C, N, not_shown, spread
from .style import COLOURS, COLUMN, GREY, LINES, PAGE, SMALL, Look, looks

#: Axes of a loop.
X_LABEL, F_LABEL = "position on the stroke $X/L$", "friction coefficient $f = F/N$"
#: Loops that can be told apart in a panel, and sliders in a figure.
_LOOPS, _SLIDERS = 6, 6
#: Points of a stroke between its name and its arrow, over all its points; strokes nearer than this share
#: of the axes, which one name serves; and points that are tried for the place of its name.
_APART, _SAME, _POINTS = 0.2, 0.012, 100
#: Variation of friction, over its size, from which on zero is on the axis.
_LEVEL = 0.2
#: Shares of a cycle at which arrows stand.
_ARROWS = (0.25, 0.75)


@dataclass(frozen=True)
class Loop:
    """Loop of friction along all strokes in the order of travel.

    Attributes:
        label: its name in a legend.
        X_over_L, f: position over the pre-sliding displacement and friction coefficient, (n,).
        strokes: names of their pieces, each of as many points; pieces of one name that follow each other
            are one stroke.
    """

    label: str
    X_over_L: NDArray
    f: NDArray
    strokes: Sequence[str]

    def along(self) -> Iterator[tuple[str, NDArray, NDArray]]:
        """Name, positions and friction coefficient of each stroke."""
        points, first = len(self.f) // len(self.strokes), 0
        for name, pieces in groupby(self.strokes):
            last = first + points * len(list(pieces))
            yield name, self.X_over_L[first:last], self.f[first:last]
            first = last

    @property
    def varies(self) -> bool:
        """True where friction changes along a stroke."""
        return any(np.ptp(f) > 1e-6 * np.abs(f).max() for _, _, f in self.along() if len(f))


class Loops:
    """Friction loops of an archive's states; states with the same law share theirs."""

    def __init__(self, of: Archive) -> None:
        self._data, self.labels, scene = of.data, of.labels, of.scene
        self._strokes = [leg.name for leg in scene.legs]
        if scene.motion.path is not None:  # its pieces are strokes together up to the next turn
            together = [list(run) for _, run in groupby(scene.legs, lambda leg: leg.s)]
            called = names([run[0].s for run in together])
            self._strokes = [name for name, run in zip(called, together) for _ in run]
        _, first = np.unique(of.data[runs.LOOP_OF_STATE.path], return_index=True)
        #: A state on each loop.
        self.first = np.array([state for state in first if of.data[runs.LOOP_OF_STATE.path][state] >= 0])
        varied = self.labels.varied(self.first)
        # Loops differ with the speed only where the law depends on it.
        self.names = [name for name in (C, *self.labels.law) if name in varied]
        self._cache: dict[int, Loop] = {}

    def of(self, state: int, called: Sequence[str] | None = None) -> Loop | None:
        """The loop that a state lies on, None where the archive has too many to hold it.

        Args:
            state: which.
            called: parameters that its label names; None for those that distinguish the loops.
        """
        row = int(self._data[runs.LOOP_OF_STATE.path][state])
        if row < 0:
            return None
        if called is not None:
            return self._made(row, self.labels.label(state, called))
        if row not in self._cache:
            self._cache[row] = self._made(row, self.labels.label(state, self.names))
        return self._cache[row]

    def _made(self, row: int, label: str) -> Loop:
        X, f = self._data[runs.LOOP_X.path], self._data[runs.LOOP_F.path][row]
        return Loop(label, X, f, self._strokes)

    def of_all(self, states: Sequence[int]) -> list[Loop]:
        """Loops of some states; none at all where one is missing."""
        loops = [self.of(state) for state in states]
        return [loop for loop in loops if loop] if all(loops) else []

    def panel(self, states: Sequence[int], called: Sequence[str], title: str = "") -> Panel:
        """A panel with the loops of some states, each once."""
        rows = self._data[runs.LOOP_OF_STATE.path]
        once = list({int(rows[state]): state for state in reversed(states)}.values())[::-1]
        loops = [loop for loop in (self.of(state, called) for state in once) if loop]
        return loop_panel(loops, len(called) == 1 and self.labels.numeric(called[0]), title)

    def panels(self) -> tuple[list[Panel], list[int]]:
        """All loops if they are few, else a panel for each parameter of the law, the others at the middle
        of their lists; and the states that they are of."""
        if len(self.first) <= _LOOPS:
            states = self.labels.ordered(self.first).tolist()
            return [self.panel(states, self.names)], states
        shown, drawn = [], []
        for name in self.names:
            others = [other for other in self.names if other != name]
            candidates = self.labels.where(self.first, **self.labels.fixed(others, self.first))
            candidates = np.array(sorted(candidates, key=lambda state: self.labels.values(name)[state]))
            states = [int(state) for state in spread(candidates.tolist(), _LOOPS)]
            shown.append(self.panel(states, [name], self.labels.label(states[0], others)))
            drawn += states
        return shown, drawn


def loop_panel(loops: Sequence[Loop], ordered: bool = False, title: str = "") -> Panel:
    """Panel of loops. One alone has a colour and a name for every stroke; of several each has its colour,
    and strokes are told apart by their lines."""
    alone = len(loops) == 1
    f = np.array([loop.f for loop in loops])
    low, high = float(f.min()), float(f.max())
    if high - low > _LEVEL * max(abs(low), abs(high)):  # else zero would flatten all loops
        low, high = min(0.0, low), max(0.0, high)
    margin = 0.06 * (high - low) or 1.0
    curves, arrows = [], []
    for k, (loop, look) in enumerate(zip(loops, looks(len(loops), ordered))):
        strokes = list(loop.along())
        # Loops that are the same are drawn one in the other, the first as the widest line.
        again = sum(np.array_equal(loop.f, later.f) for later in loops[k + 1 :])
        for n, (of_stroke, (name, X, values)) in enumerate(zip(looks(len(strokes)), strokes)):
            own = of_stroke if alone else look._replace(line=LINES[n % len(LINES)])
            own = own._replace(line="-") if again else own
            label = loop.label if n == 0 and not alone else ""
            curves.append(Curve(X, values, own, label, width=1.0 + 1.2 * again))
            if not again:
                at = 0 if alone else int(len(X) * (0.25 + 0.5 * k / len(loops)))
                arrows.append((X, values, own.colour, name if alone else "", n, at, strokes))

    def after(axis: Axes) -> None:
        for X, values, colour, name, n, at, strokes in arrows:
            place = _freest(axis, strokes, n) if alone else at
            if place is not None:
                _point(axis, X, values, place, colour, name)

    return Panel(
        X_LABEL, F_LABEL, curves=curves, title=title, xlim=(-0.03, 1.03),
        ylim=(low - margin, high + margin),
        at_y=(0.0,), after=after,
    )  # fmt: skip


def of_strokes(loops: Sequence[Loop]) -> list[Any]:
    """Handles that explain lines as strokes where colours stand for loops."""
    strokes = [name for name, *_ in loops[0].along()] if len(loops) > 1 else []
    return [handle(Look(GREY, LINES[n % len(LINES)], ""), name) for n, name in enumerate(strokes)]


def _freest(axis: Axes, strokes: Sequence[tuple[str, NDArray, NDArray]], n: int) -> int | None:
    """Index of the point of a stroke farthest from others; None where an earlier stroke is the same."""
    _, X, f = strokes[n]
    if len(strokes) == 1:
        return len(X) // 2
    scale = np.array([np.ptp(axis.get_xlim()), np.ptp(axis.get_ylim())])
    own = np.column_stack([X, f]) / scale
    coarse = max(1, len(X) // _POINTS)
    inner = np.arange(len(X) // 6, len(X) - len(X) // 3, coarse)
    nearest = []
    for _, other_X, other_f in strokes:
        other = np.column_stack([other_X, other_f])[::coarse] / scale
        gaps = own[inner, None] - other[None]
        nearest.append(np.hypot(gaps[..., 0], gaps[..., 1]).min(axis=1))
    distinct = [gap for m, gap in enumerate(nearest) if m != n and (m < n or gap.max() >= _SAME)]
    free = np.min(distinct, axis=0) if distinct else np.ones(len(inner))
    at = int(np.argmax(free))
    return None if free[at] < _SAME else int(inner[at])


def _point(axis: Axes, X: NDArray, f: NDArray, at: int, colour: Any, name: str) -> None:
    """Draw an arrow along a stroke, and its name."""
    ahead = min(at + int(_APART * len(X)) * bool(name), len(X) - 3)
    _arrow(axis, (X[ahead], f[ahead]), (X[ahead + 1], f[ahead + 1]), colour)
    if name:
        box = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}
        axis.text(X[at], f[at], name, color=colour, fontsize=SMALL, ha="center", va="center", bbox=box)


def _arrow(axis: Axes, start: Any, end: Any, colour: Any) -> None:
    style = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9}
    axis.annotate("", end, start, arrowprops=style)


def has_loop(of: Archive) -> bool:
    """Return True if friction changes along a stroke, or between strokes, but not along the contact."""
    if any(of.has(row) for row in RESULTANT_RATIO.values()):
        return False
    loops = Loops(of)
    shown = [loop for loop in (loops.of(int(i)) for i in loops.first[:_LOOPS]) if loop]
    return of.scene.slider is None and any(loop.varies for loop in shown)


def friction(of: Archive) -> Drawing:
    """Figure of the loops that an archive's states lie on."""
    loops, choice = Loops(of), of.choice
    labels, rows = loops.labels, of.data[runs.LOOP_OF_STATE.path]
    if choice.states:
        varied = [name for name in loops.names if name in labels.varied(choice.states)]
        shown, drawn = [loops.panel(choice.states, varied)], list(choice.states)
    else:
        shown, drawn = loops.panels()
    if choice.measured:
        lengths = of.data.get(column("friction.pre_sliding"), np.array([of.scene.friction.pre_sliding]))
        lengths = lengths[drawn] if len(lengths) > 1 else lengths
        shown = [choice.measured.over_loops(panel, lengths) for panel in shown]
    figure = loops_figure(shown, [loop for loop in map(loops.of, drawn) if loop], choice.size)
    covered = np.flatnonzero(np.isin(rows, rows[drawn])).tolist()
    missing = not_shown(labels, covered, "--figure friction --states", choice.states)
    caption = (
        "Friction along the strokes, in the direction of the arrows, from rest and after each turn. A "
        "closed loop dissipates its area times N L."
    )
    return Drawing("friction", caption, figure, left_out=missing)


def loops_figure(panels: Sequence[Panel], loops: Sequence[Loop], size: Any = None) -> Any:
    """Panels of loops with legends of their own where these differ."""
    size = size or Size(COLUMN if len(panels) == 1 else PAGE)
    entries = [
        tuple(curve.label for curve in panel.curves if curve.label and curve.form != DOTS)
        for panel in panels
    ]
    if len(set(entries)) > 1:
        panels = [replace(panel, own_legend=True) for panel in panels]
    several = any(len(names_) for names_ in entries)
    notes = of_strokes([loops[0]] * 2) if several and loops else []
    return render(panels, size, across(size.width, len(panels), 2.0), notes, high=0.78)


def has_slider(of: Archive) -> bool:
    """Return True if an archive holds a slider."""
    return of.has(runs.TIMES)


def slider(of: Archive) -> Drawing:
    """Figure of an archive's sliders, one for each load and law, of some of them where they are many."""
    data, scene, choice = of.data, of.scene, of.choice
    loops, count = Loops(of), len(data[runs.PERIOD.path])
    laws = spread(list(range(count)), _SLIDERS)
    several = len(scene.punch.loads) > 1
    called = [*[N] * several, *(name for name in loops.names if name != C)]
    # States of a load follow one another, as its sliders do.
    each = order(scene).shape[-1]
    labels = [loops.labels.label(law * each, called) if called and len(laws) > 1 else "" for law in laws]
    ordered = len(called) == 1 and loops.labels.numeric(called[0])
    t, v, cycle_v = (of.values(row) for row in (runs.TIMES, runs.VELOCITY, runs.CYCLE_VELOCITY))
    cycle_f = data[runs.CYCLE_FRICTION.path]
    assert scene.slider is not None
    scale = of.scaled(runs.VELOCITY)
    drive = scene.slider.drive_speed * scale.factor
    velocity = named("velocity $v$", scale.unit)
    styles = looks(len(laws), ordered)
    cycles = [(law, look) for law, look in zip(laws, styles) if np.isfinite(cycle_v[law]).all()]

    def arrows(axis: Axes) -> None:
        for law, look in cycles:
            for share in _ARROWS:
                _arrow_along(axis, cycle_v[law], cycle_f[law], share, look.colour)

    panels = [
        Panel(
            named("time $t$", of.scaled(runs.TIMES).unit), velocity,
            curves=[Curve(t, v[law], look, label) for law, look, label in zip(laws, styles, labels)],
            at_y=(drive,), xlim=(0.0, float(t[-1])),
        )
    ]  # fmt: skip
    if cycles:
        panels.append(Panel(
            velocity, F_LABEL, curves=[Curve(cycle_v[law], cycle_f[law], look) for law, look in cycles],
            at_x=(drive,), after=arrows,
        ))  # fmt: skip
    caption = (
        "A mass that is pulled through a spring: its velocity, the line is that of the drive, and "
        "friction over velocity in the last cycle, in the direction of the arrows."
    )
    if len(cycles) < len(laws):
        caption += (
            " Where no loop is drawn the mass has no cycle in the end: it slides steadily or sticks."
        )
    missing = f"{count - len(laws)} of {count} laws{several * ' and loads'} not shown." * (
        len(laws) < count
    )
    return Drawing("slider", caption, render(panels, choice.size, high=0.62), left_out=missing)


def _arrow_along(axis: Axes, x: NDArray, y: NDArray, share: float, colour: Any) -> None:
    """Draw an arrow along a loop, where the share of its length on the page is done."""
    steps = np.hypot(np.diff(x) / (np.ptp(x) or 1.0), np.diff(y) / (np.ptp(y) or 1.0))
    way = np.append(0.0, np.cumsum(steps))
    from_, to = np.searchsorted(way, [share * way[-1], (share + 0.02) * way[-1]])
    to = min(max(int(to), int(from_) + 1), len(way) - 1)
    _arrow(axis, (x[from_], y[from_]), (x[to], y[to]), colour)


def fitted_figure(t: NDArray, X: NDArray, f: NDArray, law: NDArray, timed: bool) -> Any:
    """Figure of friction over position, and the residuals over time or slip.

    Args:
        t: time [s], (samples,).
        X: position [m], (samples,).
        f: measured friction coefficient, (samples,).
        law: friction coefficient of the law, NaN where it has none, (samples,).
        timed: time was measured.
    """
    unit, of_si = prefixed("m", float(np.ptp(X)))
    measured, fitted = Look(COLOURS[0], "none", "."), Look(COLOURS[1], "-", "")
    over, label = (t, "time (s)") if timed else (X / of_si, f"slip ({unit})")
    return render([
        Panel(
            f"position ({unit})" if timed else f"slip ({unit})", "friction coefficient $f$",
            curves=[
                Curve(X / of_si, f, measured, "measured", DOTS), Curve(X / of_si, law, fitted, "fitted"),
            ],
        ),
        Panel(
            label, "measured less fitted $f$", at_y=(0.0,),
            curves=[Curve(over, f - law, measured, "", DOTS)],
        ),
    ], high=0.66)  # fmt: skip
