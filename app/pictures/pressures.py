"""Pressures of a start from rest at some times."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing, there
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.film import Film
from galinx.postprocess.figures.pressures import pressures_figure, pressures_film
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities import work_over_time as of
from galinx.postprocess.quantities.quantity import SIE
from galinx.solvers.sie.closed_form import FlatPunch

#: Times that are drawn.
_TIMES = 6
#: Frames of a film at most.
_FRAMES = 160


def has(data: dict[str, Any]) -> bool:
    """Does an archive hold pressures over time?"""
    return there(data, of.PRESSURE, of.PLACES)


def pressures(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Of the start whose steady pressure leans most, at times that double up to the last."""
    start = _start(data)
    t, X, σ = data[rows.TIMES.path], data[of.PLACES.path], data[of.PRESSURE.path][start]
    c, g = (float(data[row.path][start]) for row in (rows.SPEED, rows.RATIO))
    at = np.unique([int(np.abs(t - t[-1] / 2.0**n).argmin()) for n in range(_TIMES)])
    steady = _steady(data, scene, start)
    caption = (
        f"Contact pressure under the punch at c = {c:.4g}, σ_XY/σ_YY = {g:.4g}, by the integral "
        "equation, at times after it touched; dashed in steady motion. While the load comes on the "
        "pressure grows, and then it shifts from one side to the other."
    )
    figure = pressures_figure(X, {f"$t = {t[i]:.3g}\\,a/c_s$": -σ[i] for i in at}, -steady, choice.size)
    return Drawing("pressures", caption, figure, left_out=_left_out(data))


def film(data: dict[str, Any], scene: Scene, choice: Choice) -> tuple[Film, str]:
    """The same start as a film, and what it leaves out."""
    start, t = _start(data), data[rows.TIMES.path]
    frames = np.unique(np.linspace(0, len(t) - 1, _FRAMES).round().astype(int))
    made = pressures_film(
        data[of.PLACES.path], t[frames], -data[of.PRESSURE.path][start][frames],
        -_steady(data, scene, start),
        (data[rows.CENTRE[SIE].path][start][frames], float(data[rows.STEADY_CENTRE.path][start])),
        choice.size,
    )  # fmt: skip
    return made, _left_out(data)


def _start(data: dict[str, Any]) -> int:
    """That whose steady pressure leans most."""
    return int(np.abs(data[rows.STEADY_CENTRE.path]).argmax())


def _steady(data: dict[str, Any], scene: Scene, start: int) -> NDArray[np.float64]:
    if scene.layers:  # no closed form
        return np.full(len(data[of.PLACES.path]), np.nan)
    c, g = (float(data[row.path][start]) for row in (rows.SPEED, rows.RATIO))
    return FlatPunch(scene.solid.response(c), g).σ_YY(data[of.PLACES.path])


def _left_out(data: dict[str, Any]) -> str:
    count = len(data[rows.STEADY_CENTRE.path])
    return f"{count - 1} of {count} starts not shown." * (count > 1)
