"""Stresses along the surface of a motion in time, at some of the chosen times."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.pictures.choice import Choice
from galinx.app.pictures.drawing import Drawing
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.film import Film
from galinx.postprocess.figures.style import looks
from galinx.postprocess.figures.surface import Column, Curve, Stress, surface_figure
from galinx.postprocess.figures.surface_over_time import surface_film
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities import surface_over_time as at
from galinx.postprocess.quantities.quantity import FEM, METHODS, SIE
from galinx.solvers.sie.closed_form import FlatPunch

#: Times that are drawn, and frames of a film that make one.
_TIMES, _FRAMES = 5, 4
#: What is drawn, and what it is called.
_LABELS = {
    "sigma_XX": r"in-plane stress $\sigma_{XX}/(N/2a)$",
    "sigma_YY": r"contact stress $\sigma_{YY}/(N/2a)$",
}
#: What a caption says of what is beside it.
_BESIDE = "; beside it what they were if they were at once those of steady motion"


def has(data: dict[str, Any]) -> bool:
    """Does an archive hold stresses along the surface over time?"""
    return bool(_methods(data))


def has_film(data: dict[str, Any]) -> bool:
    """Of times enough to see how they move?"""
    return has(data) and len(data[at.TIMES.path]) >= _FRAMES


def stresses(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Of the first start, at chosen times from the first to the last, beside steady motion of then."""
    t, methods = data[at.TIMES.path], _methods(data)[::-1]  # what is drawn as lines comes first
    shown = np.unique(np.linspace(0, len(t) - 1, _TIMES).round().astype(int))
    styles, count = looks(len(shown), True), len(shown)
    sides = [("in time", 0), ("steady motion of that time's friction and load", count)]
    columns = [
        Column(title, [
            Curve(first + n, f"$t = {t[i]:.3g}\\,a/c_s$", look)
            for n, (i, look) in enumerate(zip(shown, styles))
        ])
        for title, first in sides[: 1 if scene.layers else 2]
    ]  # fmt: skip
    steady = _steady(data, scene, t[shown])
    as_lines = [1.0 if method == methods[0] else np.nan for method in methods]
    found = [
        Stress(label, {
            method: np.vstack([_told(data, name, method)[shown], as_line * steady[name]])
            for method, as_line in zip(methods, as_lines)
        })
        for name, label in _LABELS.items()
    ]  # fmt: skip
    c = float(data[rows.SPEED.path][0])
    caption = (
        "Stresses along the surface, under the punch (grey) and beside it, over time, "
        f"{' and '.join(METHODS[method] for method in methods)}, at c = {c:.4g}"
        f"{_BESIDE * (not scene.layers)}. At the edges they grow without bound."
    )
    figure = surface_figure(data[at.PLACES.path], found, columns, choice.size)
    return Drawing("stresses", caption, figure, left_out=_left_out(data))


def film(data: dict[str, Any], scene: Scene, choice: Choice) -> tuple[Film, str]:
    """The same start at all chosen times as a film, and what it leaves out."""
    method, steady = _methods(data)[0], _steady(data, scene, data[rows.TIMES.path][-1:])
    moving = [Stress(label, {method: _told(data, name, method)}) for name, label in _LABELS.items()]
    nearest = np.abs(np.subtract.outer(data[at.TIMES.path], data[rows.TIMES.path])).argmin(axis=1)
    made = surface_film(
        data[at.PLACES.path], data[at.TIMES.path], moving, [steady[name][0] for name in _LABELS],
        (data[rows.TIMES.path], data[rows.CENTRE[method].path][0], nearest), choice.size,
    )  # fmt: skip
    return made, _left_out(data)


def _methods(data: dict[str, Any]) -> list[str]:
    return [name for name in (FEM, SIE) if at.IN_PLANE[name].path in data]


def _told(data: dict[str, Any], name: str, method: str) -> NDArray[np.float64]:
    """A stress at the chosen times, (times, places)."""
    row = {"sigma_XX": at.IN_PLANE, "sigma_YY": at.PRESSURE}[name][method]
    return np.asarray(data[row.path][0])


def _steady(data: dict[str, Any], scene: Scene, t: NDArray) -> dict[str, NDArray[np.float64]]:
    """Stresses of steady motion at the friction and the load of some times, (times, places) each."""
    X = data[at.PLACES.path]
    if scene.layers:  # no closed form
        return {name: np.full((len(t), len(X)), np.nan) for name in _LABELS}
    response = scene.solid.response(float(data[rows.SPEED.path][0]))
    found: dict[str, list[NDArray]] = {name: [] for name in _LABELS}
    for i in np.abs(np.subtract.outer(t, data[rows.TIMES.path])).argmin(axis=1):
        punch = FlatPunch(response, float(data[rows.RATIOS.path][0][i]))
        load = float(data[rows.LOAD.path][i])
        found["sigma_XX"].append(load * punch.σ_XX(X))
        found["sigma_YY"].append(load * punch.σ_YY(X))
    return {name: np.array(values) for name, values in found.items()}


def _left_out(data: dict[str, Any]) -> str:
    count = len(data[rows.SPEED.path])
    return f"{count - 1} of {count} starts not shown." * (count > 1)
