"""Stick-slip of an archive."""

from typing import Any

import numpy as np

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing, there
from galinx.app.pictures.friction import Loops
from galinx.app.pictures.told import C, N, spread
from galinx.app.plan.states import order
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.slider import Slide, slider_figure
from galinx.postprocess.quantities import slider as rows

#: Sliders that can be told apart.
_SLIDERS = 6


def has(data: dict[str, Any]) -> bool:
    """Does an archive hold a slider?"""
    return there(data, rows.TIMES)


def slider(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """The sliders of an archive, one for each load and law, those of some where they are many."""
    loops, count = Loops(data, scene), len(data[rows.PERIOD.path])
    laws = spread(list(range(count)), _SLIDERS)
    several = len(scene.punch.loads) > 1
    names = [*[N] * several, *(name for name in loops.names if name != C)]
    # States of a load follow one another, as its sliders do.
    each = order(scene).shape[-1]
    labels = [loops.told.label(law * each, names) if names else "" for law in laws]
    wanted = (rows.VELOCITY, rows.CYCLE_VELOCITY, rows.CYCLE_FRICTION)
    v, cycle_v, cycle_f = (data[row.path] for row in wanted)
    slides = [
        Slide(label, v[law], cycle_v[law], cycle_f[law]) for label, law in zip(labels, laws)
    ]  # fmt: skip
    assert scene.slider is not None
    ordered = len(names) == 1 and loops.told.numeric(names[0])
    caption = (
        "A mass that is pulled through a spring: its velocity, the line is that of the drive, and "
        "friction over velocity in the last cycle, in the direction of the arrows."
    )
    if not np.isfinite(cycle_v[laws]).all():
        caption += " Where no loop is drawn the mass slides steadily in the end."
    left = f"{count - len(laws)} of {count} laws{several * ' and loads'} not shown." * (len(laws) < count)
    figure = slider_figure(data[rows.TIMES.path], slides, scene.slider.drive_speed, ordered, choice.size)
    return Drawing("slider", caption, figure, left_out=left)
