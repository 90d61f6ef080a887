"""Motions in time of an archive.

From rest or from steady motion: centre of the pressure, indentation and K_I over time; where the energy
goes; pressures at some times; and stresses along the surface at some of the chosen times, beside those of
steady motion, which are the closed form's. Films show pressures and stresses as they change.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.over_time import energy_imbalance
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.over_time import OF_FRICTION, OF_LOAD
from galinx.postprocess.quantities.quantity import FEM, METHODS, SIE
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.texts import number, plain

from ..scene.sections import Time
from .choice import Archive, Drawing, both, explained, named
from .render import Curve, Film, Panel, Size, handle, render
from .states import drive_label, spread
from .stresses import _BESIDE, limits, position_name, surface_curves
from .style import COLUMN, GREY, Look, looks

#: Starts that can be told apart in a figure, times that are drawn of one, and frames of a film at most.
_STARTS, _TIMES, _SURFACE_TIMES, _FRAMES = 6, 6, 5, 160
#: Frames that make a film of stresses.
_LEAST_FRAMES = 4
#: Pressure over the largest that is drawn, over N/(2a): it is infinite at the ends.
_TOP = 2.5
#: What is drawn over time, and what it is called.
_OVER_TIME = (
    (rows.CENTRE, "centre of pressure"), (rows.V0, "indentation $v_0$"),
    (rows.K_I_LEFT, "$K_I$ at $X = -a$"),
    (rows.K_I_RIGHT, "$K_I$ at $X = a$"),
)  # fmt: skip


def has_motions(of: Archive) -> bool:
    """Return True if an archive holds motions in time."""
    return of.has(rows.TIMES)


def _time(of: Archive) -> tuple[str, NDArray]:
    """Name of the axis of time, and times."""
    unit = of.scaled(rows.TIMES).unit
    return ("time $t/(a/c_s)$" if unit == "a/c_s" else f"time $t$ ({unit})"), of.values(rows.TIMES)


def _at_time(of: Archive, t: float) -> str:
    """Label of a time over a/c_s."""
    scale = of.scaled(rows.TIMES)
    unit = r"\,a/c_s$" if scale.unit == "a/c_s" else f"$ {scale.unit}"
    return f"$t = {number(t * scale.factor, 3)}{unit}"


def _over_a(of: Archive, words: str, row: Any) -> str:
    """Name of an axis of a quantity, over what it is over where it is dimensionless."""
    unit = of.scaled(row).unit
    over = {"N/(2mu)": "$/(N/2\\mu)$", "1": "$/a$" if row.scale else ""}
    return words + over[unit] if unit in over else named(words, unit)


def time(of: Archive) -> Drawing:
    """Figure of the centre of the pressure, indentation and intensities over time of some starts."""
    data, settings = of.data, of.scene.time
    assert settings
    methods = [name for name in (SIE, FEM) if rows.V0[name].path in data]
    c, g = (data[row.path] for row in (rows.SPEED, rows.RATIO))
    way = data[rows.DIRECTION.path][:, -1]
    shown = spread(list(range(len(c))), _STARTS)
    styles = looks(len(shown))
    label, t = _time(of)
    panels = []
    for n, (by_method, words) in enumerate(_OVER_TIME):
        row = by_method[methods[0]]
        values = {m: of.values(by_method[m]) for m in methods}
        if not any(np.isfinite(y[shown]).any() for y in values.values()):
            continue
        curves = []
        for k, (i, look) in enumerate(zip(shown, styles)):
            name = drive_label(c[i], g[i], way[i]) if n == 0 and len(shown) > 1 else ""
            curves += both(t, {m: y[i] for m, y in values.items()}, look, name, k / len(shown))
            if n == 0:
                steady = of.values(rows.CENTRES)[i]
                curves.append(Curve(t, steady, look._replace(line=":"), width=0.7))
        panels.append(Panel(label, _over_a(of, words, row), curves=curves, xlim=(0.0, float(t[-1]))))
    with_K_I = len(panels) > 2
    caption = (
        f"From {'steady motion on' if settings.steady else 'rest to steady sliding'}, "
        f"{' and '.join(METHODS[m] for m in methods)}: centre of the pressure, whose dotted line "
        "is that of steady motion by the friction of the same time, indentation since the first"
        f"{', and K_I at both ends by the full load' * with_K_I}, over time. {_history(settings)}"
    )
    if len(shown) == 1:
        caption += f" At {plain(drive_label(c[0], g[0], way[0]))}."
    missing = f"{len(c) - len(shown)} of {len(c)} starts not shown." * (len(shown) < len(c))
    columns = 2 if not of.size or of.size.width > 3.0 else 1
    return Drawing(
        "time", caption, render(panels, of.size, columns, explained(methods)), left_out=missing
    )


def _history(settings: Time) -> str:
    load = f"The load comes on within {settings.load_ramp:g} a/c_s." * (
        not settings.load and not settings.steady
    ) or "The load changes as the scene says." * bool(settings.load)
    return " ".join(filter(None, [load, "Friction follows its law along the strokes." * settings.by_law]))


_DONE = {"load": OF_LOAD[FEM], "friction": OF_FRICTION[FEM], "being carried past the punch": rows.CARRIED}
_HELD = {"strain near": rows.STRAIN, "motion near": rows.KINETIC, "radiated": rows.RADIATED}


def has_energies(of: Archive) -> bool:
    """Return True if an archive holds energies over time."""
    return of.has(*_DONE.values(), *_HELD.values())


def energies(of: Archive) -> Drawing:
    """Figure of the work and the energies over time of the first start."""
    label, t = _time(of)
    styles = iter(looks(len(_DONE) + len(_HELD)))
    panels = []
    for what, kinds in (("work", _DONE), ("energy", _HELD)):
        values = {name: of.values(row)[0] for name, row in kinds.items()}
        curves = [Curve(t, np.sum(list(values.values()), axis=0), Look(GREY, "-", ""), width=1.8)]
        curves += [Curve(t, y, next(styles), name) for name, y in values.items()]
        unit = of.scaled(next(iter(kinds.values()))).unit
        over = r" over $N^2/4\mu$" if unit.startswith("N^2") else f" ({unit})"
        panels.append(Panel(
            label, rf"{what} since $t = 0${over}", curves=curves, at_y=(0.0,), xlim=(0.0, float(t[-1]))
        ))  # fmt: skip
    every = np.concatenate([curve.y for panel in panels for curve in panel.curves])
    room = 0.05 * np.ptp(every)
    panels = [replace(panel, ylim=(every.min() - room, every.max() + room)) for panel in panels]
    notes = [handle(Look(GREY, "-", ""), "all together", linewidth=1.8)]
    off = float(np.abs(energy_imbalance(of.data)[0]).max())
    heat, unit = float(of.values(rows.DISSIPATED)[0, -1]), of.scaled(rows.DISSIPATED).unit
    caption = (
        "Work of the punch on the solid besides the heat of friction, and where it is: strained and "
        "moving within 3 a of the middle and 2 a below it, and what went beyond, finite elements. Sums "
        f"are within {off:.1e} of the largest work. Friction took {heat:.3g} {unit.replace('*', ' ')} "
        "meanwhile, of first order in the load, where all of these are of second."
    )
    return Drawing(
        "energies", caption, render(panels, of.size, 0, notes, high=0.68), left_out=_left_out(of)
    )


def has_pressures(of: Archive) -> bool:
    """Return True if an archive holds pressures over time."""
    return of.has(rows.PRESSURE, rows.PLACES)


def _steady(
    of: Archive, start: int, X: NDArray, ratios: NDArray, loads: NDArray
) -> dict[str, NDArray[np.float64]]:
    """Stresses of steady motion by name in the figure's units, (n, places); NaN over layers.

    Args:
        of: the archive.
        start: number of the start.
        X: places over a.
        ratios, loads: σ_XY/σ_YY and load over N, (n,).
    """
    if of.scene.layers:  # no closed form
        return {name: np.full((len(ratios), len(X)), np.nan) for name in _LABELS}
    response = of.scene.solid.response(float(of.data[rows.SPEED.path][start]))
    punches = [FlatPunch(response, ratio) for ratio in ratios.tolist()]
    factor = float(np.max(of.scaled(rows.PRESSURE).factor)) * loads[:, None]
    return {
        "sigma_YY": -factor * np.array([punch.σ_YY(X) for punch in punches]),
        "sigma_XX": factor * np.array([punch.σ_XX(X) for punch in punches]),
    }


def _pressures(of: Archive, start: int) -> tuple[NDArray, NDArray, NDArray, Panel]:
    """Positions, pressures over time and in steady motion, and a panel for them without any."""
    scale, ends = of.scaled(rows.PRESSURE), of.data[rows.RATIO.path][[start]]
    steady = _steady(of, start, of.data[rows.PLACES.path], ends, np.ones(1))["sigma_YY"][0]
    panel = Panel(
        position_name(of, "position "), named(_LABELS["sigma_YY"][0], scale.unit), xlim=_ends(of),
        ylim=(0.0, _TOP * float(np.max(scale.factor))),
    )  # fmt: skip
    return of.values(rows.PLACES), -of.values(rows.PRESSURE)[start], steady, panel


def _ends(of: Archive) -> tuple[float, float]:
    """Ends of the contact in the figure's units."""
    scale = of.scaled(rows.PLACES)
    ends = scale.of(np.array([-1.0, 1.0]))
    return float(ends[0]), float(ends[1])


_STEADY = Look(GREY, "--", "")


def pressures(of: Archive) -> Drawing:
    """Figure of the pressure of the start whose steady pressure leans most, at times that double up."""
    start = _leaning(of)
    t = of.data[rows.TIMES.path]
    c, g = (float(of.data[row.path][start]) for row in (rows.SPEED, rows.RATIO))
    at = np.unique([int(np.abs(t - t[-1] / 2.0**n).argmin()) for n in range(_TIMES)])
    X, p, steady, panel = _pressures(of, start)
    curves = [
        Curve(X, p[i], look, _at_time(of, t[i])) for i, look in zip(at, looks(len(at), ordered=True))
    ]
    curves.append(Curve(X, steady, _STEADY, "steady", width=0.8))
    caption = (
        f"Contact pressure under the punch at c = {c:.4g}, σ_XY/σ_YY = {g:.4g}, by the integral "
        "equation, at times after it touched; dashed in steady motion. While the load comes on the "
        "pressure grows, and then it shifts from one side to the other."
    )
    figure = render([replace(panel, curves=curves)], of.size or Size(COLUMN), high=0.75)
    return Drawing("pressures", caption, figure, left_out=_left_out(of))


def _film(
    of: Archive, method: str, start: int, shown: NDArray, stresses: Callable[[int], list[Panel]],
    at_y: tuple[float, ...] = (),
) -> tuple[Film, str]:  # fmt: skip
    """Film of stresses beside the centre of the pressure over time, and what it leaves out.

    Args:
        of: the archive.
        method: of solution, of the centre.
        start: number of the start.
        shown: numbers of the times of the frames.
        stresses: panels of a frame.
        at_y: lines across the panel of the centre.
    """
    (label, t), row, look = _time(of), rows.CENTRE[method], Look("black", "none", "o")
    centre = of.values(row)[start]
    way = Panel(
        label, _over_a(of, "centre of pressure", row), xlim=(0.0, float(t[-1])), at_y=at_y,
        curves=[Curve(t, centre, looks(1)[0])],
    )  # fmt: skip

    def panels(frame: int) -> list[Panel]:
        i = shown[frame]
        first, *others = stresses(frame)
        first = replace(first, title=_at_time(of, of.data[rows.TIMES.path][i]))
        dot = Curve(t[i : i + 1], centre[i : i + 1], look, form="markers")
        return [first, *others, replace(way, curves=[*way.curves, dot])]

    return Film(panels, len(shown), of.size), _left_out(of)


def pressure_film(of: Archive) -> tuple[Film, str]:
    """Film of the pressure of the start whose steady pressure leans most, and what it leaves out."""
    start, times = _leaning(of), len(of.data[rows.TIMES.path])
    shown = np.unique(np.linspace(0, times - 1, _FRAMES).round().astype(int))
    X, p, steady, panel = _pressures(of, start)
    lean = of.scaled(rows.CENTRE[SIE]).of(of.data[rows.STEADY_CENTRE.path][[start]])

    def pressure(frame: int) -> list[Panel]:
        now = Curve(X, p[shown[frame]], looks(1)[0])
        return [replace(panel, curves=[now, Curve(X, steady, _STEADY, width=0.8)])]

    return _film(of, SIE, start, shown, pressure, (float(np.ravel(lean)[0]),))


def _leaning(of: Archive) -> int:
    """Number of the start whose steady pressure leans most."""
    return int(np.abs(of.data[rows.STEADY_CENTRE.path]).argmax())


def _left_out(of: Archive) -> str:
    count = len(of.data[rows.SPEED.path])
    return f"{count - 1} of {count} starts not shown." * (count > 1)


#: Stresses along the surface over time: what they are called, and their sign.
_LABELS = {
    "sigma_YY": (r"contact pressure $-\sigma_{YY}$", -1.0, rows.SURFACE_PRESSURE),
    "sigma_XX": (r"in-plane stress $\sigma_{XX}$", 1.0, rows.SURFACE_IN_PLANE),
}
#: What a caption says of what is beside it.
_BESIDE_IT = "; beside it what they were if they were at once those of steady motion"


def has_surface(of: Archive) -> bool:
    """Return True if an archive holds stresses along the surface over time."""
    return bool(_methods(of))


def has_film(of: Archive) -> bool:
    """Return True if stresses along the surface are held at enough times for a film."""
    return has_surface(of) and len(of.data[rows.SURFACE_TIMES.path]) >= _LEAST_FRAMES


def stresses(of: Archive) -> Drawing:
    """Figure of the stresses along the surface of the first start, at chosen times from the first to the
    last, beside those of steady motion with the friction and the load of these times."""
    t, methods = of.data[rows.SURFACE_TIMES.path], _methods(of)
    shown = np.unique(np.linspace(0, len(t) - 1, _SURFACE_TIMES).round().astype(int))
    steady, panels = _steady_at(of, _steps(of)[shown]), []
    for n, name in enumerate(_LABELS):
        columns = {"in time": {method: _over_time(of, name, method)[shown] for method in methods}}
        if not of.scene.layers:
            columns["steady motion of that time's friction and load"] = {SIE: steady[name]}
        every = np.vstack([y for values in columns.values() for y in values.values()])
        panel = _panel(of, name, every)
        for k, (title, values) in enumerate(columns.items()):
            curves = []
            for i, look in enumerate(looks(len(shown), True)):
                of_time = {method: y[i] for method, y in values.items()}
                label, turn = _at_time(of, t[shown[i]]), i / len(shown)
                curves += surface_curves(_X(of), of_time, look, label, turn, _place(of))
            panels.append(replace(
                panel, y=panel.y if k == 0 else None, title=title if n == 0 else "", curves=curves
            ))  # fmt: skip
    c = float(of.data[rows.SPEED.path][0])
    caption = (
        "Stresses along the surface, under the punch (grey) and beside it, over time, "
        f"{' and '.join(METHODS[method] for method in methods)}, at c = {c:.4g}"
        f"{_BESIDE_IT * (not of.scene.layers)}. At the edges they grow without bound."
    )
    figure = render(panels, of.size, 1 if of.scene.layers else 2, explained(methods))
    return Drawing("stresses", caption, figure, left_out=_left_out(of))


def film_of_surface(of: Archive) -> tuple[Film, str]:
    """Film of the stresses along the surface of the first start, and a sentence on what it leaves out."""
    method = _methods(of)[-1]
    every = {name: _over_time(of, name, method) for name in _LABELS}
    panels = {name: _panel(of, name, values) for name, values in every.items()}
    last = _steady_at(of, np.array([len(of.data[rows.TIMES.path]) - 1]))

    def shown(frame: int) -> list[Panel]:
        result = []
        for name, panel in panels.items():
            both_curves = ((every[name][frame], looks(1)[0]), (last[name][0], _STEADY))
            curves = [
                surface_curves(_X(of), {SIE: y}, look, "", 0.0, _place(of))[0] for y, look in both_curves
            ]
            result.append(replace(panel, curves=[replace(curves[0], width=1.0), curves[1]]))
        return result

    return _film(of, method, 0, _steps(of), shown)


def _panel(of: Archive, name: str, values: NDArray) -> Panel:
    """Panel of a stress along the surface, without curves, with room for values (n, places)."""
    (words, _, row), (factor, offset) = _LABELS[name], _place(of)
    half = 1.04 if name == "sigma_YY" else _BESIDE
    return Panel(
        position_name(of), named(words, of.scaled(row[_methods(of)[0]]).unit),
        xlim=(offset - half * factor, offset + half * factor), ylim=limits(_X(of), values), at_y=(0.0,),
        bands=[_ends(of)] if half == _BESIDE else (),
    )  # fmt: skip


def _X(of: Archive) -> NDArray[np.float64]:
    """Places along the surface, X over a."""
    return np.asarray(of.data[rows.SURFACE_PLACES.path])


def _place(of: Archive) -> tuple[float, float]:
    """Factor and offset from X over a to positions in the figure's units."""
    scale = of.scaled(rows.SURFACE_PLACES)
    return float(np.max(scale.factor)), float(np.max(scale.offset))


def _methods(of: Archive) -> list[str]:
    return [name for name in (SIE, FEM) if rows.SURFACE_IN_PLANE[name].path in of.data]


def _over_time(of: Archive, name: str, method: str) -> NDArray[np.float64]:
    """A stress of the first start at the chosen times in the figure's units, (times, places)."""
    _, sign, by_method = _LABELS[name]
    return sign * of.values(by_method[method])[0]


def _steps(of: Archive) -> NDArray[np.int64]:
    """Numbers of the steps at whose ends stresses along the surface are held."""
    t, times = of.data[rows.SURFACE_TIMES.path], of.data[rows.TIMES.path]
    return np.asarray(np.abs(np.subtract.outer(t, times)).argmin(axis=1))


def _steady_at(of: Archive, steps: NDArray) -> dict[str, NDArray[np.float64]]:
    """Stresses of the first start's steady motion at the friction and load of some steps."""
    return _steady(of, 0, _X(of), of.data[rows.RATIOS.path][0][steps], of.data[rows.LOAD.path][steps])
