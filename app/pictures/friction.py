"""Friction of an archive: the loops that its states lie on, and the stick-slip of its sliders."""

from collections.abc import Sequence
from itertools import groupby
from typing import Any

import numpy as np

from galinx.postprocess.figures.friction import Loop, Panel, Slide, loops_figure, slider_figure
from galinx.postprocess.quantities import runs
from galinx.solvers.friction.motion import names

from ..plan.states import order
from ..scene.scene import Scene
from .choice import Choice, Drawing, has_quantities
from .state_labels import C, N, StateLabels, not_shown, spread

#: Loops that can be distinguished in a panel.
_LOOPS = 6


class Loops:
    """Friction loops of an archive's states; states with the same law share theirs.

    Args:
        data, scene: datasets by path, and the scene, of an archive.
    """

    def __init__(self, data: dict[str, Any], scene: Scene) -> None:
        self._data, self.labels = data, StateLabels(data, scene)
        self._strokes = [leg.name for leg in scene.legs]
        if scene.motion.path is not None:  # its pieces are strokes together up to the next turn
            together = [list(run) for _, run in groupby(scene.legs, lambda leg: leg.s)]
            called = names([run[0].s for run in together])
            self._strokes = [name for name, run in zip(called, together) for _ in run]
        _, first = np.unique(data[runs.LOOP_OF_STATE.path], return_index=True)
        #: A state on each loop.
        self.first = np.array([state for state in first if data[runs.LOOP_OF_STATE.path][state] >= 0])
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
        loops = [self.of(state, called) for state in once]
        ordered = len(called) == 1 and self.labels.numeric(called[0])
        return Panel(title, [loop for loop in loops if loop], ordered)

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


def friction(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of the loops that an archive's states lie on."""
    loops = Loops(data, scene)
    labels, rows = loops.labels, data[runs.LOOP_OF_STATE.path]
    if choice.states:
        varied = [name for name in loops.names if name in labels.varied(choice.states)]
        shown, drawn = [loops.panel(choice.states, varied)], list(choice.states)
    else:
        shown, drawn = loops.panels()
    covered = np.flatnonzero(np.isin(rows, rows[drawn])).tolist()
    missing = not_shown(labels, covered, "--figure friction --states", choice.states)
    caption = (
        "Friction along the strokes, in the direction of the arrows, from rest and after each turn. A "
        "closed loop dissipates its area times N L."
    )
    return Drawing("friction", caption, loops_figure(shown, choice.size), left_out=missing)


#: Sliders that can be distinguished in a figure.
_SLIDERS = 6


def has_slider(data: dict[str, Any]) -> bool:
    """Return True if an archive holds a slider."""
    return has_quantities(data, runs.TIMES)


def slider(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of an archive's sliders, one for each load and law, of some of them where they are many."""
    loops, count = Loops(data, scene), len(data[runs.PERIOD.path])
    laws = spread(list(range(count)), _SLIDERS)
    several = len(scene.punch.loads) > 1
    names = [*[N] * several, *(name for name in loops.names if name != C)]
    # States of a load follow one another, as its sliders do.
    each = order(scene).shape[-1]
    labels = [loops.labels.label(law * each, names) if names else "" for law in laws]
    quantities = (runs.VELOCITY, runs.CYCLE_VELOCITY, runs.CYCLE_FRICTION)
    v, cycle_v, cycle_f = (data[row.path] for row in quantities)
    slides = [
        Slide(label, v[law], cycle_v[law], cycle_f[law]) for label, law in zip(labels, laws)
    ]  # fmt: skip
    assert scene.slider is not None
    ordered = len(names) == 1 and loops.labels.numeric(names[0])
    caption = (
        "A mass that is pulled through a spring: its velocity, the line is that of the drive, and "
        "friction over velocity in the last cycle, in the direction of the arrows."
    )
    if not np.isfinite(cycle_v[laws]).all():
        caption += " Where no loop is drawn the mass slides steadily in the end."
    missing = f"{count - len(laws)} of {count} laws{several * ' and loads'} not shown." * (
        len(laws) < count
    )
    figure = slider_figure(data[runs.TIMES.path], slides, scene.slider.drive_speed, ordered, choice.size)
    return Drawing("slider", caption, figure, left_out=missing)
