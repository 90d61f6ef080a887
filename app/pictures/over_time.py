"""Motions in time of an archive."""

from typing import Any

import numpy as np

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing, there
from galinx.app.pictures.told import drive_label, spread
from galinx.app.scene.scene import Scene, Time
from galinx.postprocess.figures.over_time import Start, time_figure
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.quantity import FEM, METHODS, SIE

#: Starts that can be told apart.
_STARTS = 6


def has(data: dict[str, Any]) -> bool:
    """Does an archive hold a start from rest?"""
    return there(data, rows.TIMES)


def time(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Centre of the pressure, indentation and intensities over time of some starts."""
    method = next(name for name in (FEM, SIE) if rows.V0[name].path in data)
    other = SIE if method == FEM and rows.V0[SIE].path in data else ""
    c, g, steady = (data[row.path] for row in (rows.SPEED, rows.RATIO, rows.CENTRES))
    way = data[rows.DIRECTION.path][:, -1]
    shown = spread(list(range(len(c))), _STARTS)
    by_method = rows.CENTRE, rows.V0, rows.K_I_LEFT, rows.K_I_RIGHT
    starts = []
    for i in shown:
        curves = [data[row[method].path][i] for row in by_method]
        beside = [data[row[other].path][i] for row in by_method] if other else []
        label = drive_label(c[i], g[i], way[i])
        starts.append(Start(label, curves, beside, steady[i]))
    asked = scene.time
    assert asked
    told = np.isfinite(data[rows.K_I_LEFT[method].path]).any()
    caption = (
        f"From {'steady motion on' if asked.steady else 'rest to steady sliding'}, {METHODS[method]}"
        f"{f', points: {METHODS.get(other)}' * bool(other)}: centre of the pressure, whose dotted line "
        "is that of steady motion by the friction of the same time, indentation since the first"
        f"{', and K_I at both ends by the full load' * bool(told)}, over time. {_what(asked)}"
    )
    left = f"{len(c) - len(shown)} of {len(c)} starts not shown." * (len(shown) < len(c))
    return Drawing(
        "time", caption, time_figure(data[rows.TIMES.path], starts, choice.size), left_out=left
    )


def _what(asked: Time) -> str:
    load = f"The load comes on within {asked.load_ramp:g} a/c_s." * (
        not asked.load and not asked.steady
    ) or "The load changes as the scene says." * bool(asked.load)
    return " ".join(filter(None, [load, "Friction follows its law along the strokes." * asked.by_law]))
