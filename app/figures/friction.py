"""Friction of an archive: loops of its states, stick-slip of its sliders; and fits to measurements."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import column, preferred, runs
from galinx.postprocess.quantities.states import RESULTANT_RATIO
from galinx.postprocess.tables import states_of_loops, states_of_sliders
from galinx.postprocess.units import prefixed
from galinx.solvers.friction.fit import Measured
from galinx.solvers.friction.motion import names

from .choice import Archive, C, Drawing, N, fewer, named, spread
from .render import DOTS, Curve, Panel, Size, across, note, render
from .style import COLOURS, COLUMN, GREY, LINES, PAGE, Look, looks

#: Axis of friction.
F_LABEL = "friction coefficient $f = F/N$"
#: Loops that can be told apart in a panel, and sliders in a figure; cycles of a slider over time.
_LOOPS, _CYCLES = 6, 12


@dataclass(frozen=True)
class Loop:
    """Loop of friction along all strokes in the order of travel.

    Attributes:
        label: its name in a legend.
        X_over_L, f: position over the pre-sliding displacement and friction coefficient, (n,).
        strokes: name of each stroke, and its part of the loop.
    """

    label: str
    X_over_L: NDArray
    f: NDArray
    strokes: Sequence[tuple[str, slice]]


def _changes(f: NDArray) -> bool:
    return bool(len(f) and np.ptp(f) > 1e-6 * np.abs(f).max())


class Loops:
    """Friction loops of an archive's states; states with the same law share theirs."""

    def __init__(self, of: Archive) -> None:
        self.archive, legs = of, of.scene.legs
        self.rows, self._X, self._f = (
            of.data[row.path] for row in (runs.LOOP_OF_STATE, runs.LOOP_X, runs.LOOP_F)
        )
        # Legs of one stroke: each by its name, of a path those up to the next turn.
        path = of.scene.motion.path is not None
        runs_ = [list(run) for _, run in groupby(legs, lambda leg: leg.s if path else leg.name)]
        called = names([run[0].s for run in runs_]) if path else [run[0].name for run in runs_]
        ends = np.cumsum([0, *(len(self._X) // len(legs) * len(run) for run in runs_)]).tolist()
        self._strokes = [(name, slice(*part)) for name, part in zip(called, pairwise(ends))]
        #: A state on each loop.
        self.first = states_of_loops(of.data)
        varied = self.archive.varied(self.first)
        # Loops differ with the speed only where the law depends on it.
        self.names = [name for name in (C, *self.archive.law) if name in varied]

    def of(self, states: Sequence[int], called: Sequence[str] | None = None) -> list[Loop]:
        """The loops that states lie on, but for those that the archive has too many to hold.

        Args:
            states: which.
            called: parameters that labels name; None for those that distinguish the loops.
        """
        names = self.names if called is None else called
        return [
            Loop(self.archive.label(state, names), self._X, self._f[self.rows[state]], self._strokes)
            for state in states if self.rows[state] >= 0
        ]  # fmt: skip

    @property
    def few(self) -> list[Loop]:
        """The first loops, as many as a panel tells apart."""
        return self.of(self.first[:_LOOPS].tolist())

    def panel(self, states: Sequence[int], called: Sequence[str], title: str = "") -> Panel:
        """A panel with the loops of some states, each once."""
        once = list({int(self.rows[state]): state for state in reversed(states)}.values())[::-1]
        return loop_panel(
            self.of(once, called), len(called) == 1 and self.archive.numeric(called[0]), title
        )

    def panels(self) -> tuple[list[Panel], list[int]]:
        """All loops if they are few, else a panel for each parameter of the law, the others at the middle
        of their lists; and the states that they are of."""
        if len(self.first) <= _LOOPS:
            states = self.archive.ordered(self.first).tolist()
            return [self.panel(states, self.names)], states
        shown, drawn = [], []
        for name in self.names:
            others = [other for other in self.names if other != name]
            candidates = self.archive.where(self.first, **self.archive.fixed(others, self.first))
            values = self.archive.parameter(name)
            states = spread(sorted(candidates.tolist(), key=lambda state: values[state]), _LOOPS)
            shown.append(self.panel(states, [name], self.archive.label(states[0], others)))
            drawn += states
        return shown, drawn


def loop_panel(loops: Sequence[Loop], ordered: bool = False, title: str = "") -> Panel:
    """Panel of loops with arrows in the direction of travel. One alone has a colour and a name for every
    stroke; of several each has its colour, and strokes are told apart by their lines."""
    alone = len(loops) == 1
    f = np.array([loop.f for loop in loops])
    low, high = float(f.min()), float(f.max())
    if high - low > 0.2 * max(abs(low), abs(high)):  # else zero would flatten all loops
        low, high = min(0.0, low), max(0.0, high)
    margin = 0.06 * (high - low) or 1.0
    curves = []
    for k, (loop, look) in enumerate(zip(loops, looks(len(loops), ordered))):
        # Loops that are the same are drawn one in the other, the first as the widest line.
        again = sum(np.array_equal(loop.f, later.f) for later in loops[k + 1 :])
        arrows = () if again else (0.5 if alone else 0.25 + 0.5 * k / len(loops),)
        for n, (of_stroke, (name, part)) in enumerate(zip(looks(len(loop.strokes)), loop.strokes)):
            own = of_stroke if alone else look._replace(line="-" if again else LINES[n % len(LINES)])
            label = name * (len(loop.strokes) > 1) if alone else loop.label * (n == 0)
            x, y, width = loop.X_over_L[part], loop.f[part], 1.0 + 1.2 * again
            curves.append(Curve(x, y, own, label, width=width, arrows=arrows))
    return Panel(
        "position on the stroke $X/L$", F_LABEL, curves=curves, title=title, xlim=(-0.03, 1.03),
        ylim=(low - margin, high + margin), at_y=(0.0,),
    )  # fmt: skip


def varies(of: Archive) -> bool:
    """Return True if friction changes between places or strokes."""
    return not of.scene.steady and any(_changes(loop.f) for loop in Loops(of).few)


def has_loop(of: Archive) -> bool:
    """Return True if friction changes along a stroke, or between strokes, but not along the contact."""
    along = preferred(of.data, RESULTANT_RATIO)
    if along or of.scene.slider is not None:
        return False
    return any(_changes(loop.f[part]) for loop in Loops(of).few for _, part in loop.strokes)


def friction(of: Archive) -> Drawing:
    """Figure of the loops that an archive's states lie on."""
    loops, choice = Loops(of), of.choice
    rows = loops.rows
    if choice.states:
        varied = [name for name in loops.names if name in of.varied(choice.states)]
        shown, drawn = [loops.panel(choice.states, varied)], list(choice.states)
    else:
        shown, drawn = loops.panels()
    if choice.measured:
        lengths = of.data.get(column("friction.pre_sliding"), np.array([of.scene.friction.pre_sliding]))
        lengths = lengths[drawn] if len(lengths) > 1 else lengths
        shown = [choice.measured.over_loops(panel, lengths) for panel in shown]
    figure = loops_figure(shown, loops.of(drawn), choice.size)
    covered = np.flatnonzero(np.isin(rows, rows[drawn])).tolist()
    missing = of.not_shown(covered, "--figure friction --states")
    caption = (
        "Friction along the strokes, in the direction of the arrows, from rest and after each turn. A "
        "closed loop dissipates its area times N L."
    )
    return Drawing("friction", caption, figure, left_out=missing)


def loops_figure(panels: Sequence[Panel], loops: Sequence[Loop], size: Size | None = None) -> Any:
    """Panels of loops with legends of their own where these differ.

    Args:
        panels: of the loops.
        loops: whose strokes the legend names where several loops are in a panel.
        size: of the figure.
    """
    size = size or Size(COLUMN if len(panels) == 1 else PAGE)
    entries = {
        tuple(curve.label for curve in panel.curves if curve.label and curve.form != DOTS)
        for panel in panels
    }
    if len(entries) > 1:
        panels = [replace(panel, own_legend=True) for panel in panels]
    strokes = [name for name, _ in loops[0].strokes] if len(loops) > 1 and any(entries) else []
    strokes *= len(strokes) > 1
    notes = [note(Look(GREY, LINES[n % len(LINES)], ""), name) for n, name in enumerate(strokes)]
    return render(panels, size, across(size.width, len(panels), 2.0), notes, high=0.78)


def slider(of: Archive) -> Drawing:
    """Figure of an archive's sliders, one for each load and law, of some of them where they are many."""
    data, scene, choice = of.data, of.scene, of.choice
    loops, count = Loops(of), len(data[runs.PERIOD.path])
    laws = spread(range(count), _LOOPS)
    several = len(scene.punch.loads) > 1
    called = [*[N] * several, *(name for name in loops.names if name != C)]
    states, called = states_of_sliders(data).tolist(), called * (len(laws) > 1)
    labels = [of.label(states[law], called) for law in laws]
    ordered = len(called) == 1 and of.numeric(called[0])
    t, v, cycle_v = (of.values(row) for row in (runs.TIMES, runs.VELOCITY, runs.CYCLE_VELOCITY))
    cycle_f = data[runs.CYCLE_FRICTION.path]
    assert scene.slider is not None
    scale = of.scaled(runs.VELOCITY)
    drive = scene.slider.drive_speed * scale.factor
    velocity = named("velocity $v$", scale.unit)
    styles = looks(len(laws), ordered)
    cycles = [(law, look) for law, look in zip(laws, styles) if np.isfinite(cycle_v[law]).all()]
    # Of more cycles a line would be a band.
    shown, period = float(t[-1]), np.nan_to_num(of.values(runs.PERIOD)[laws]).max()
    if period and shown > 2.0 * _CYCLES * period:
        shown = _CYCLES * float(period)
    panels = [
        Panel(
            named("time $t$", of.scaled(runs.TIMES).unit), velocity,
            curves=[Curve(t, v[law], look, label) for law, look, label in zip(laws, styles, labels)],
            at_y=(drive,), xlim=(0.0, shown),
        )
    ]  # fmt: skip
    if cycles:
        curves = [Curve(cycle_v[law], cycle_f[law], look, arrows=(0.25, 0.75)) for law, look in cycles]
        panels.append(Panel(velocity, F_LABEL, curves=curves, at_x=(drive,)))
    caption = (
        "A mass that is pulled through a spring: its velocity, and friction over velocity in the last "
        "cycle, in the direction of the arrows."
    )
    if len(cycles) < len(laws):
        caption += (
            " Where no loop is drawn the mass has no cycle in the end: it slides steadily or sticks."
        )
    if shown < t[-1]:
        caption += f" Of the velocity the first {_CYCLES} cycles are shown."
    missing = fewer(len(laws), count, f"laws{several * ' and loads'}")
    figure = render(panels, choice.size, 0, [note(Look(GREY, "-", ""), "drive", width=0.4)], 0.62)
    return Drawing("slider", caption, figure, left_out=missing)


def fitted_figure(measured: Measured, law: NDArray, timed: bool) -> Any:
    """Figure of friction over position, and the residuals over time or slip.

    Args:
        measured: time, position and friction coefficient, (samples,) each.
        law: friction coefficient of the law, NaN where it has none, (samples,).
        timed: time was measured.
    """
    t, X, f = measured.t, measured.X, measured.f
    unit, of_si = prefixed("m", float(np.ptp(X)))
    dots, line = Look(COLOURS[0], "none", "."), Look(COLOURS[1], "-", "")
    over, label = (t, "time (s)") if timed else (X / of_si, f"slip ({unit})")
    return render([
        Panel(
            f"position ({unit})" if timed else f"slip ({unit})", "friction coefficient $f$",
            curves=[
                Curve(X / of_si, f, dots, "measured", DOTS), Curve(X / of_si, law, line, "fitted"),
            ],
        ),
        Panel(
            label, "measured less fitted $f$", at_y=(0.0,),
            curves=[Curve(over, f - law, dots, "", DOTS)],
        ),
    ], high=0.66)  # fmt: skip
