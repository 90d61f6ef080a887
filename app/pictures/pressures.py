"""Pressures of a start from rest at some times."""

from typing import Any

import numpy as np

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing, there
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.pressures import pressures_figure
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities import work_over_time as of
from galinx.solvers.sie.closed_form import FlatPunch

#: Times that are drawn.
_TIMES = 6


def has(data: dict[str, Any]) -> bool:
    """Does an archive hold pressures over time?"""
    return there(data, of.PRESSURE, of.PLACES)


def pressures(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Of the start whose steady pressure leans most, at times that double up to the last."""
    lean = np.abs(data[rows.STEADY_CENTRE.path])
    start, count = int(lean.argmax()), len(lean)
    t, X, σ = data[rows.TIMES.path], data[of.PLACES.path], data[of.PRESSURE.path][start]
    c, g = (float(data[row.path][start]) for row in (rows.SPEED, rows.RATIO))
    at = np.unique([int(np.abs(t - t[-1] / 2.0**n).argmin()) for n in range(_TIMES)])
    steady = FlatPunch(scene.solid.response(c), g).σ_YY(X)
    caption = (
        f"Contact pressure under the punch at c = {c:.4g}, σ_XY/σ_YY = {g:.4g}, by the integral "
        "equation, at times after it touched; dashed in steady motion. While the load comes on the "
        "pressure grows, and then it shifts from one side to the other."
    )
    left = f"{count - 1} of {count} starts not shown." * (count > 1)
    figure = pressures_figure(X, {f"$t = {t[i]:.3g}\\,a/c_s$": -σ[i] for i in at}, -steady, choice.size)
    return Drawing("pressures", caption, figure, left_out=left)
