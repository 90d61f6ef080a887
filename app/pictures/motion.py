"""Motions in time of an archive.

From rest or from steady motion: centre of the pressure, indentation and K_I over time; where the energy
goes; pressures at some times; and stresses along the surface at some of the chosen times, beside those of
steady motion, which are the closed form's.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.figures.maps import Film
from galinx.postprocess.figures.motion import (
    Start,
    energies_figure,
    pressures_figure,
    pressures_film,
    surface_film,
    time_figure,
)
from galinx.postprocess.figures.style import looks
from galinx.postprocess.figures.surface import Column, Curve, Stress, surface_figure
from galinx.postprocess.over_time import energy_imbalance
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.over_time import OF_FRICTION, OF_LOAD
from galinx.postprocess.quantities.quantity import FEM, METHODS, SIE
from galinx.solvers.contact.closed_form import FlatPunch

from ..scene.scene import Scene, Time
from .choice import Choice, Drawing, has_quantities
from .state_labels import drive_label, spread

#: Starts that can be distinguished in a figure.
_STARTS = 6


def has_motions(data: dict[str, Any]) -> bool:
    """Return True if an archive holds motions in time."""
    return has_quantities(data, rows.TIMES)


def time(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of the centre of the pressure, indentation and intensities over time of some starts."""
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
    settings = scene.time
    assert settings
    with_K_I = np.isfinite(data[rows.K_I_LEFT[method].path]).any()
    caption = (
        f"From {'steady motion on' if settings.steady else 'rest to steady sliding'}, {METHODS[method]}"
        f"{f', points: {METHODS.get(other)}' * bool(other)}: centre of the pressure, whose dotted line "
        "is that of steady motion by the friction of the same time, indentation since the first"
        f"{', and K_I at both ends by the full load' * bool(with_K_I)}, over time. {_history(settings)}"
    )
    missing = f"{len(c) - len(shown)} of {len(c)} starts not shown." * (len(shown) < len(c))
    return Drawing(
        "time", caption, time_figure(data[rows.TIMES.path], starts, choice.size), left_out=missing
    )


def _history(settings: Time) -> str:
    load = f"The load comes on within {settings.load_ramp:g} a/c_s." * (
        not settings.load and not settings.steady
    ) or "The load changes as the scene says." * bool(settings.load)
    return " ".join(filter(None, [load, "Friction follows its law along the strokes." * settings.by_law]))


_DONE = {"load": OF_LOAD[FEM], "friction": OF_FRICTION[FEM], "being carried past the punch": rows.CARRIED}
_HELD = {"strain near": rows.STRAIN, "motion near": rows.KINETIC, "radiated": rows.RADIATED}


def has_energies(data: dict[str, Any]) -> bool:
    """Return True if an archive holds energies over time."""
    return has_quantities(data, *_DONE.values(), *_HELD.values())


def energies(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of the work and the energies over time of the first start."""
    done, held = ({name: data[row.path][0] for name, row in kinds.items()} for kinds in (_DONE, _HELD))
    off = float(np.abs(energy_imbalance(data)[0]).max())
    heat = float(data[rows.DISSIPATED.path][0, -1])
    caption = (
        "Work of the punch on the solid besides the heat of friction, and where it is: strained and "
        "moving within 3 a of the middle and 2 a below it, and what went beyond, finite elements. Sums "
        f"are within {off:.1e} of the largest work. Friction took {heat:.3g} N a meanwhile, of first "
        "order in the load, where all of these are of second."
    )
    count = len(data[rows.SPEED.path])
    missing = f"{count - 1} of {count} starts not shown." * (count > 1)
    figure = energies_figure(data[rows.TIMES.path], done, held, choice.size)
    return Drawing("energies", caption, figure, left_out=missing)


#: Times that are drawn.
_TIMES = 6
#: Frames of a film at most.
_FRAMES = 160


def has_pressures(data: dict[str, Any]) -> bool:
    """Return True if an archive holds pressures over time."""
    return has_quantities(data, rows.PRESSURE, rows.PLACES)


def pressures(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of the pressure of the start whose steady pressure leans most, at times that double up."""
    start = _start(data)
    t, X, σ = data[rows.TIMES.path], data[rows.PLACES.path], data[rows.PRESSURE.path][start]
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


def pressure_film(data: dict[str, Any], scene: Scene, choice: Choice) -> tuple[Film, str]:
    """Film of the pressure of the start whose steady pressure leans most, and what it leaves out."""
    start, t = _start(data), data[rows.TIMES.path]
    frames = np.unique(np.linspace(0, len(t) - 1, _FRAMES).round().astype(int))
    made = pressures_film(
        data[rows.PLACES.path], t[frames], -data[rows.PRESSURE.path][start][frames],
        -_steady(data, scene, start),
        (data[rows.CENTRE[SIE].path][start][frames], float(data[rows.STEADY_CENTRE.path][start])),
        choice.size,
    )  # fmt: skip
    return made, _left_out(data)


def _start(data: dict[str, Any]) -> int:
    """Number of the start whose steady pressure leans most."""
    return int(np.abs(data[rows.STEADY_CENTRE.path]).argmax())


def _steady(data: dict[str, Any], scene: Scene, start: int) -> NDArray[np.float64]:
    if scene.layers:  # no closed form
        return np.full(len(data[rows.PLACES.path]), np.nan)
    c, g = (float(data[row.path][start]) for row in (rows.SPEED, rows.RATIO))
    return FlatPunch(scene.solid.response(c), g).σ_YY(data[rows.PLACES.path])


def _left_out(data: dict[str, Any]) -> str:
    count = len(data[rows.STEADY_CENTRE.path])
    return f"{count - 1} of {count} starts not shown." * (count > 1)


#: Times that are drawn, and frames of a film that make one.
_SURFACE_TIMES, _SURFACE_FRAMES = 5, 4
#: What is drawn, and what it is called.
_LABELS = {
    "sigma_XX": r"in-plane stress $\sigma_{XX}/(N/2a)$",
    "sigma_YY": r"contact stress $\sigma_{YY}/(N/2a)$",
}
#: What a caption says of what is beside it.
_BESIDE = "; beside it what they were if they were at once those of steady motion"


def has_surface(data: dict[str, Any]) -> bool:
    """Return True if an archive holds stresses along the surface over time."""
    return bool(_methods(data))


def has_film(data: dict[str, Any]) -> bool:
    """Return True if stresses along the surface are held at enough times for a film."""
    return has_surface(data) and len(data[rows.SURFACE_TIMES.path]) >= _SURFACE_FRAMES


def stresses(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Figure of the stresses along the surface of the first start, at chosen times from the first to the
    last, beside those of steady motion with the friction and the load of these times."""
    t, methods = data[rows.SURFACE_TIMES.path], _methods(data)[::-1]  # what is drawn as lines comes first
    shown = np.unique(np.linspace(0, len(t) - 1, _SURFACE_TIMES).round().astype(int))
    styles, count = looks(len(shown), True), len(shown)
    sides = [("in time", 0), ("steady motion of that time's friction and load", count)]
    columns = [
        Column(title, [
            Curve(first + n, f"$t = {t[i]:.3g}\\,a/c_s$", look)
            for n, (i, look) in enumerate(zip(shown, styles))
        ])
        for title, first in sides[: 1 if scene.layers else 2]
    ]  # fmt: skip
    steady = _steady_surface(data, scene, t[shown])
    as_lines = [1.0 if method == methods[0] else np.nan for method in methods]
    series = [
        Stress(label, {
            method: np.vstack([_stress_over_time(data, name, method)[shown], as_line * steady[name]])
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
    figure = surface_figure(data[rows.SURFACE_PLACES.path], series, columns, choice.size)
    return Drawing("stresses", caption, figure, left_out=_surface_left_out(data))


def film_of_surface(data: dict[str, Any], scene: Scene, choice: Choice) -> tuple[Film, str]:
    """Film of the stresses along the surface of the first start, and a sentence on what it leaves out."""
    method, steady = _methods(data)[0], _steady_surface(data, scene, data[rows.TIMES.path][-1:])
    moving = [
        Stress(label, {method: _stress_over_time(data, name, method)}) for name, label in _LABELS.items()
    ]
    nearest = np.abs(np.subtract.outer(data[rows.SURFACE_TIMES.path], data[rows.TIMES.path])).argmin(
        axis=1
    )
    made = surface_film(
        data[rows.SURFACE_PLACES.path], data[rows.SURFACE_TIMES.path], moving,
        [steady[name][0] for name in _LABELS],
        (data[rows.TIMES.path], data[rows.CENTRE[method].path][0], nearest), choice.size,
    )  # fmt: skip
    return made, _surface_left_out(data)


def _methods(data: dict[str, Any]) -> list[str]:
    return [name for name in (FEM, SIE) if rows.SURFACE_IN_PLANE[name].path in data]


def _stress_over_time(data: dict[str, Any], name: str, method: str) -> NDArray[np.float64]:
    """A stress of the first start over N/(2a) at the chosen times, (times, places)."""
    row = {"sigma_XX": rows.SURFACE_IN_PLANE, "sigma_YY": rows.SURFACE_PRESSURE}[name][method]
    return np.asarray(data[row.path][0])


def _steady_surface(data: dict[str, Any], scene: Scene, t: NDArray) -> dict[str, NDArray[np.float64]]:
    """Stresses over N/(2a) of steady motion at the friction and load of some times, (times, places)."""
    X = data[rows.SURFACE_PLACES.path]
    if scene.layers:  # no closed form
        return {name: np.full((len(t), len(X)), np.nan) for name in _LABELS}
    response = scene.solid.response(float(data[rows.SPEED.path][0]))
    stresses_at: dict[str, list[NDArray]] = {name: [] for name in _LABELS}
    for i in np.abs(np.subtract.outer(t, data[rows.TIMES.path])).argmin(axis=1):
        punch = FlatPunch(response, float(data[rows.RATIOS.path][0][i]))
        load = float(data[rows.LOAD.path][i])
        stresses_at["sigma_XX"].append(load * punch.σ_XX(X))
        stresses_at["sigma_YY"].append(load * punch.σ_YY(X))
    return {name: np.array(values) for name, values in stresses_at.items()}


def _surface_left_out(data: dict[str, Any]) -> str:
    count = len(data[rows.SPEED.path])
    return f"{count - 1} of {count} starts not shown." * (count > 1)
