"""Friction loops of an archive."""

from collections.abc import Sequence
from itertools import groupby
from typing import Any

import numpy as np

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing
from galinx.app.pictures.told import C, Told, not_shown, spread
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.loops import Loop, Panel, loops_figure
from galinx.postprocess.quantities import runs
from galinx.solvers.friction.motion import names

#: Loops that can be told apart in a panel.
_LOOPS = 6


class Loops:
    """Friction loops of an archive's states; states with the same law share theirs.

    Args:
        data, scene: the archive's.
    """

    def __init__(self, data: dict[str, Any], scene: Scene) -> None:
        self._data, self.told = data, Told(data, scene)
        self._strokes = [leg.name for leg in scene.legs]
        if scene.motion.path is not None:  # its pieces are strokes together up to the next turn
            together = [list(run) for _, run in groupby(scene.legs, lambda leg: leg.s)]
            called = names([run[0].s for run in together])
            self._strokes = [name for name, run in zip(called, together) for _ in run]
        _, first = np.unique(data[runs.LOOP_OF_STATE.path], return_index=True)
        #: A state on each loop.
        self.first = np.array([state for state in first if data[runs.LOOP_OF_STATE.path][state] >= 0])
        varied = self.told.varied(self.first)
        # The speed tells loops apart only where the law depends on it.
        self.names = [name for name in (C, *self.told.law) if name in varied]
        self._known: dict[int, Loop] = {}

    def of(self, state: int, called: Sequence[str] | None = None) -> Loop | None:
        """The loop that a state lies on, None where the archive has too many to hold it.

        Args:
            state: which.
            called: parameters that its label names, those that tell loops apart if not given.
        """
        row = int(self._data[runs.LOOP_OF_STATE.path][state])
        if row < 0:
            return None
        if called is not None:
            return self._made(row, self.told.label(state, called))
        if row not in self._known:
            self._known[row] = self._made(row, self.told.label(state, self.names))
        return self._known[row]

    def _made(self, row: int, label: str) -> Loop:
        X, f = self._data[runs.LOOP_X.path], self._data[runs.LOOP_F.path][row]
        return Loop(label, X, f, self._strokes)

    def of_all(self, some: Sequence[int]) -> list[Loop]:
        """The loops of some states, none at all where one is missing."""
        found = [self.of(state) for state in some]
        return [loop for loop in found if loop] if all(found) else []

    def panel(self, some: Sequence[int], called: Sequence[str], title: str = "") -> Panel:
        """Loops of some states, each once."""
        rows = self._data[runs.LOOP_OF_STATE.path]
        once = list({int(rows[state]): state for state in reversed(some)}.values())[::-1]
        found = [self.of(state, called) for state in once]
        ordered = len(called) == 1 and self.told.numeric(called[0])
        return Panel(title, [loop for loop in found if loop], ordered)

    def panels(self) -> tuple[list[Panel], list[int]]:
        """All loops if they are few, else a panel for each parameter of the law, the others at the middle
        of their lists; and the states that they are of."""
        if len(self.first) <= _LOOPS:
            states = self.told.ordered(self.first).tolist()
            return [self.panel(states, self.names)], states
        shown, drawn = [], []
        for name in self.names:
            others = [other for other in self.names if other != name]
            some = self.told.where(self.first, **self.told.fixed(others, self.first))
            some = np.array(sorted(some, key=lambda state: self.told.values(name)[state]))
            states = [int(state) for state in spread(some.tolist(), _LOOPS)]
            shown.append(self.panel(states, [name], self.told.label(states[0], others)))
            drawn += states
        return shown, drawn


def friction(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """The loops that an archive's states lie on."""
    loops = Loops(data, scene)
    told, rows = loops.told, data[runs.LOOP_OF_STATE.path]
    if choice.states:
        varied = [name for name in loops.names if name in told.varied(choice.states)]
        shown, drawn = [loops.panel(choice.states, varied)], list(choice.states)
    else:
        shown, drawn = loops.panels()
    seen = np.flatnonzero(np.isin(rows, rows[drawn])).tolist()
    missing = not_shown(told, seen, "--figure friction --states", choice.states)
    caption = (
        "Friction along the strokes, in the direction of the arrows, from rest and after each turn. A "
        "closed loop dissipates its area times N L."
    )
    return Drawing("friction", caption, loops_figure(shown, choice.size), left_out=missing)
