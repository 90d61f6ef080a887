"""Starts from rest of an archive."""

from typing import Any

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import METHODS, Drawing, there
from galinx.app.pictures.told import spread
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.over_time import Start, time_figure
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.quantity import FEM, SIE

#: Starts that can be told apart.
_STARTS = 6


def has(data: dict[str, Any]) -> bool:
    """Does an archive hold a start from rest?"""
    return there(data, rows.TIMES)


def time(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Centre of the pressure, indentation and intensities over time of some starts."""
    method = next(name for name in (FEM, SIE) if rows.V0[name].path in data)
    other = SIE if method == FEM and rows.V0[SIE].path in data else ""
    c, g, steady = (data[row.path] for row in (rows.SPEED, rows.RATIO, rows.STEADY_CENTRE))
    shown = spread(list(range(len(c))), _STARTS)
    by_method = rows.CENTRE, rows.V0, rows.K_I_LEFT, rows.K_I_RIGHT
    starts = []
    for i in shown:
        curves = [data[row[method].path][i] for row in by_method]
        beside = [data[row[other].path][i] for row in by_method] if other else []
        label = f"$c = {c[i]:.4g}$, $\\sigma_{{XY}}/\\sigma_{{YY}} = {g[i]:.4g}$"
        starts.append(Start(label, curves, beside, float(steady[i])))
    caption = (
        f"From rest to steady sliding, {METHODS[method]}"
        f"{f', points: {METHODS.get(other)}' * bool(other)}: centre of the pressure, whose dotted line "
        "is that of steady motion, indentation since the punch touched, and K_I at both ends by the "
        f"final load, over time. The load comes on within {scene.time.load_ramp:g} a/c_s."  # type: ignore[union-attr]
    )
    left = f"{len(c) - len(shown)} of {len(c)} starts not shown." * (len(shown) < len(c))
    return Drawing(
        "time", caption, time_figure(data[rows.TIMES.path], starts, choice.size), left_out=left
    )
