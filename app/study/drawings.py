"""The study's figures."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from galinx.app.results.drawings import Drawing, Loops, Told
from galinx.app.study.published import REFERENCE
from galinx.postprocess.figures.loops import loops_figure
from galinx.postprocess.figures.surface import Column, surface_figure
from galinx.postprocess.quantities import column
from galinx.postprocess.quantities.states import MOTION, POSITION

#: The study's two speeds.
SLOW, FAST = 4.786e-7, 0.6


def of_study(data: dict[str, Any]) -> Iterator[Drawing]:
    """Figs 2 and 5-10 of the study from an archive of scenes/study.toml."""
    loops, told = Loops(data), Told(data)
    reference = _first(data, **REFERENCE)
    yield Drawing(
        "fig2", "Fig 2. The friction loop.", loops_figure([("Dahl's law", loops.of_all([reference]))])
    )
    yield _slow_or_fast("fig5", "Fig 5. Slow sliding", data, loops, SLOW)
    panels = []
    for name in told.law:
        at = [_first(data, **(REFERENCE | {name: value})) for value in np.unique(told.values(name))]
        named = [replace(loop, label=told.label(i, [name])) for i, loop in zip(at, loops.of_all(at))]
        panels.append(("", named))
    yield Drawing("fig6", "Fig 6. What the parameters do to the loop.", loops_figure(panels))
    yield _slow_or_fast("fig7", "Fig 7. Fast sliding", data, loops, FAST)
    for figure, name in zip(("fig8", "fig9", "fig10"), told.law):
        columns = []
        for c in (SLOW, FAST):
            states = [
                _first(data, c=c, motion="FM1", X_over_L=0.8, **(REFERENCE | {name: value}))
                for value in np.unique(told.values(name))
            ]
            columns.append(
                Column(
                    f"FM1, X/L = 0.8, c = {c:g}",
                    states,
                    [told.label(i, [name]) for i in states],
                    loops.of_all(states),
                )
            )
        caption = f"Fig {figure[3:]}. What {told.parameters[name].symbol} does, slow and fast."
        yield Drawing(figure, caption, surface_figure(data, columns))


def _slow_or_fast(name: str, caption: str, data: dict[str, Any], loops: Loops, c: float) -> Drawing:
    columns = []
    for X in np.unique(data[POSITION.path]):
        states = [_first(data, c=c, X_over_L=X, motion=m, **REFERENCE) for m in ("FM1", "BM1", "FM2")]
        labels = [str(data[MOTION.path][i]) for i in states]
        columns.append(Column(f"c = {c:g}, X/L = {X:g}", states, labels, loops.of_all(states)))
    return Drawing(name, f"{caption}, at two places of three strokes.", surface_figure(data, columns))


def _first(data: dict[str, Any], **values: Any) -> int:
    """The first state whose named parameters have the given values."""
    matches = np.all([data[column(key)] == value for key, value in values.items()], axis=0)
    return int(np.flatnonzero(matches)[0])
