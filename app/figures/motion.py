"""Motions in time of an archive.

From rest or from steady motion: centre of the pressure, indentation and K_I over time; where the energy
goes; pressures at some times; and stresses along the surface at some of the chosen times, beside those of
steady motion, which are the closed form's. Films show pressures and stresses as they change.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.over_time import DONE, HELD, energy_imbalance
from galinx.postprocess.quantities import Quantity
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.quantity import FEM, METHODS, SIE
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.edges import under_punch
from galinx.texts import number, plain

from .choice import Archive, Drawing, both, drive_label, explained, fewer, named, spread
from .files import FILM
from .render import Curve, Film, Panel, Size, note, render, with_dot
from .stresses import SHOWN, Along, limits, position_name, surface_panel
from .style import COLUMN, GREY, Look, looks

#: Starts that can be told apart in a figure, times that are drawn of one, and frames of a film at most.
_STARTS, _TIMES, _SURFACE_TIMES, _FRAMES = 6, 6, 5, 160
#: Frames that make a film.
LEAST_FRAMES = 4
#: What is drawn over time, and what it is called.
_OVER_TIME = (
    (rows.CENTRE, "centre of pressure"), (rows.V0, "indentation $v_0$"),
    (rows.K_I_LEFT, "$K_I$ at $X = -a$, over $N$"),
    (rows.K_I_RIGHT, "$K_I$ at $X = a$, over $N$"),
)  # fmt: skip
#: Names of the curves of works and energies.
_WORKS = ("load", "friction", "being carried past the punch"), ("strain near", "motion near", "radiated")
#: Quantities that an archive of energies, and of pressures over time, has.
ENERGIES, PRESSURES = (*DONE, *HELD), (rows.PRESSURE, rows.PLACES)
_STEADY, _SUM = Look(GREY, "--", ""), Look(GREY, "-", "")


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
    return f"{words}$/a$" if unit == "1" and row.scale else named(words, unit)


def _left_out(of: Archive, shown: int = 1) -> str:
    return fewer(shown, len(of.data[rows.SPEED.path]), "starts")


def time(of: Archive) -> Drawing:
    """Figure of the centre of the pressure, indentation and intensities over time of some starts."""
    data, settings = of.data, of.scene.time
    assert settings
    methods = [name for name in (SIE, FEM) if rows.V0[name].path in data]
    motions = [*zip(data[rows.SPEED.path], data[rows.RATIO.path], data[rows.DIRECTION.path][:, -1])]
    shown = spread(range(len(motions)), _STARTS)
    label, t = _time(of)
    panels = []
    for n, (by_method, words) in enumerate(_OVER_TIME):
        values = {m: of.values(by_method[m]) for m in methods}
        if not any(np.isfinite(y[shown]).any() for y in values.values()):
            continue
        curves = []
        for k, (i, look) in enumerate(zip(shown, looks(len(shown)))):
            name = drive_label(*motions[i]) if n == 0 and len(shown) > 1 else ""
            curves += both(t, {m: y[i] for m, y in values.items()}, look, name, k / len(shown))
            if n == 0:
                steady = of.values(rows.CENTRES)[i]
                curves.append(Curve(t, steady, look._replace(line=":"), width=0.7))
        axis = _over_a(of, words, by_method[methods[0]])
        panels.append(Panel(label, axis, curves=curves, xlim=(0.0, float(t[-1]))))
    with_K_I = len(panels) > 2
    caption = (
        f"From {'steady motion on' if settings.steady else 'rest to steady sliding'}, "
        f"{' and '.join(METHODS[m] for m in methods)}: centre of the pressure, whose dotted line "
        "is that of steady motion by the friction of the same time, indentation since the first"
        f"{', and K_I at both ends by the full load' * with_K_I}, over time."
    )
    if settings.load:
        caption += " The load changes as the scene says."
    elif not settings.steady:
        caption += f" The load comes on within {settings.load_ramp:g} a/c_s."
    caption += " Friction follows its law along the strokes." * settings.by_law
    if len(shown) == 1:
        caption += f" At {plain(drive_label(*motions[0]))}."
    columns = 2 if not of.choice.size or of.choice.size.width > 3.0 else 1
    dotted = note(_STEADY._replace(line=":"), "steady motion", width=0.7)
    figure = render(panels, of.choice.size, columns, [*explained(methods), dotted])
    return Drawing("time", caption, figure, left_out=_left_out(of, len(shown)))


def energies(of: Archive) -> Drawing:
    """Figure of the work and the energies over time of the first start."""
    label, t = _time(of)
    styles = iter(looks(len(ENERGIES)))
    panels = []
    for what, kinds, names in zip(("work", "energy"), (DONE, HELD), _WORKS):
        values = {name: of.values(row)[0] for name, row in zip(names, kinds)}
        curves = [Curve(t, np.sum(list(values.values()), axis=0), _SUM, width=1.8)]
        curves += [Curve(t, y, next(styles), name) for name, y in values.items()]
        axis = named(f"{what} since $t = 0$", of.scaled(kinds[0]).unit)
        panels.append(Panel(label, axis, curves=curves, at_y=(0.0,), xlim=(0.0, float(t[-1]))))
    every = np.concatenate([curve.y for panel in panels for curve in panel.curves])
    room = 0.05 * np.ptp(every)
    panels = [replace(panel, ylim=(every.min() - room, every.max() + room)) for panel in panels]
    off = float(np.abs(energy_imbalance(of.data)[0]).max())
    heat, unit = float(of.values(rows.DISSIPATED)[0, -1]), of.scaled(rows.DISSIPATED).unit
    caption = (
        "Work of the punch on the solid besides the heat of friction, and where it is: strained and "
        "moving within 3 a of the middle and 2 a below it, and what went beyond, finite elements. Sums "
        f"are within {off:.1e} of the largest work. Friction took {heat:.3g} {unit.replace('*', ' ')} "
        "meanwhile, of first order in the load, where all of these are of second."
    )
    notes = [note(_SUM, "all together", width=1.8)]
    figure = render(panels, of.choice.size, 0, notes, high=0.68)
    return Drawing("energies", caption, figure, left_out=_left_out(of))


def _held(
    of: Archive, X: Quantity, stresses: Mapping[str, Mapping[str, Quantity]], start: int = 0,
    steps: Any = slice(None),
) -> dict[str, Along]:  # fmt: skip
    """Stresses of a start at some steps, (steps, places), by name, from quantities of each method."""
    places, scale, held = of.data[X.path], of.scaled(X), {}
    position = position_name(of, "position " if X is rows.PLACES else "position on the surface ")
    place = float(np.max(scale.factor)), float(np.max(scale.offset))
    for name, by_method in stresses.items():
        label, sign = SHOWN[name]
        axis = named(label, of.scaled(next(iter(by_method.values()))).unit)
        shown = np.where(under_punch(places) | (name != "sigma_YY"), sign, np.nan)
        values = {method: shown * of.values(row)[start][steps] for method, row in by_method.items()}
        times = len(next(iter(values.values())))
        held[name] = Along(places, axis, values, [place] * times, position)
    return held


def _steady(
    of: Archive, held: Mapping[str, Along], start: int, steps: NDArray | list[int]
) -> dict[str, Along]:
    """Stresses of steady motion with a start's friction and load at some steps; none over layers."""
    if of.scene.layers:  # no closed form
        return {}
    response = of.scene.solid.response(float(of.data[rows.SPEED.path][start]))
    punches = [FlatPunch(response, g) for g in of.data[rows.RATIOS.path][start][steps].tolist()]
    X, stress = next(iter(held.values())).X, float(np.max(of.scaled(rows.SURFACE_PRESSURE[SIE]).factor))
    load = stress * of.data[rows.LOAD.path][steps][:, None]
    values = {
        "sigma_YY": -load * np.where(under_punch(X), [punch.σ_YY(X) for punch in punches], np.nan),
        "sigma_XX": load * np.array([punch.σ_XX(X) for punch in punches]),
    }
    return {name: replace(along, values={SIE: values[name]}) for name, along in held.items()}


def _at_chosen_times(of: Archive) -> tuple[dict[str, Along], NDArray[np.int64]]:
    """Stresses of the first start along the surface at the chosen times, and the steps that end then."""
    methods = [name for name in (SIE, FEM) if of.has(rows.SURFACE_IN_PLANE[name])]
    stresses = {"sigma_YY": rows.SURFACE_PRESSURE, "sigma_XX": rows.SURFACE_IN_PLANE}
    by_method = {name: {method: row[method] for method in methods} for name, row in stresses.items()}
    t, times = of.data[rows.SURFACE_TIMES.path], of.data[rows.TIMES.path]
    steps = np.asarray(np.abs(np.subtract.outer(t, times)).argmin(axis=1))
    return _held(of, rows.SURFACE_PLACES, by_method), steps


def _leaning(of: Archive, steps: Any) -> tuple[int, dict[str, Along], tuple[float, float]]:
    """Start whose steady pressure leans most, its pressures at some steps, and limits of these."""
    start = int(np.abs(of.data[rows.STEADY_CENTRE.path]).argmax())
    held = _held(of, rows.PLACES, {"sigma_YY": {SIE: rows.PRESSURE}}, start, steps)
    highest = 2.5  # over N/(2a): at the ends it is infinite
    return start, held, (0.0, highest * float(np.max(of.scaled(rows.PRESSURE).factor)))


def pressures(of: Archive) -> Drawing:
    """Figure of the pressure of the start whose steady pressure leans most, at times that double up."""
    t = of.data[rows.TIMES.path]
    at = np.unique([int(np.abs(t - t[-1] / 2.0**n).argmin()) for n in range(_TIMES)])
    start, held, ylim = _leaning(of, at)
    c, g = (float(of.data[row.path][start]) for row in (rows.SPEED, rows.RATIO))
    (pressure,) = held.values()
    shown = pressure.shown(looks(len(at), True), [_at_time(of, when) for when in t[at].tolist()])
    for along in _steady(of, held, start, [-1]).values():
        shown += along.shown([_STEADY], ["steady"], 0.8)
    panel = surface_panel(shown, ylim)
    caption = (
        f"Contact pressure under the punch at c = {c:.4g}, σ_XY/σ_YY = {g:.4g}, by the integral "
        "equation, at times after it touched; dashed in steady motion. While the load comes on the "
        "pressure grows, and then it shifts from one side to the other."
    )
    figure = render([panel], of.choice.size or Size(COLUMN), high=0.75)
    return Drawing("pressures", caption, figure, left_out=_left_out(of))


def has_surface(of: Archive) -> bool:
    """Return True if an archive holds stresses along the surface over time."""
    return any(of.has(row) for row in rows.SURFACE_IN_PLANE.values())


def stresses(of: Archive) -> Drawing:
    """Figure of the stresses along the surface of the first start, at chosen times from the first to the
    last, beside those of steady motion with the friction and the load of these times."""
    (held, steps), t = _at_chosen_times(of), of.data[rows.SURFACE_TIMES.path]
    at = spread(range(len(t)), _SURFACE_TIMES)
    styles, called = looks(len(at), True), [_at_time(of, t[i]) for i in at]
    steady, panels = _steady(of, held, 0, steps[at]), list[Panel]()
    titles = ["in time", "steady motion of that time's friction and load"][: 1 + bool(steady)]
    for name, along in held.items():
        columns = [along.shown(styles, called, rows=at)]
        every = [y[at] for y in along.values.values()]
        if steady:
            columns.append(steady[name].shown(styles, called))
            every += steady[name].values.values()
        for title, shown in zip(titles, columns):
            panel = surface_panel(shown, limits(along.X, np.vstack(every)))
            panel = panel if shown is columns[0] else replace(panel, y=None)
            panels.append(replace(panel, title=title * (len(panels) < len(columns))))
    c = float(of.data[rows.SPEED.path][0])
    caption = (
        "Stresses along the surface, under the punch (grey) and beside it, over time, "
        f"{' and '.join(METHODS[method] for method in held['sigma_XX'].values)}, at c = {c:.4g}"
        f"{'; beside it what they were if they were at once those of steady motion' * bool(steady)}. "
        "At the edges they grow without bound."
    )
    notes = explained(*(along.values for along in held.values()))
    figure = render(panels, of.choice.size, len(titles), notes)
    return Drawing("stresses", caption, figure, left_out=_left_out(of))


def has_film(of: Archive) -> bool:
    """Return True if an archive holds stresses along the surface or pressures at enough times."""
    enough = has_surface(of) and len(of.data[rows.SURFACE_TIMES.path]) >= LEAST_FRAMES
    return enough or of.has(*PRESSURES)


def film(of: Archive) -> Drawing:
    """Film of the stresses along the surface of the first start, or of the pressure of the start whose
    steady pressure leans most, beside the centre of the pressure."""
    label, t = _time(of)
    if has_surface(of) and len(of.data[rows.SURFACE_TIMES.path]) >= LEAST_FRAMES:
        start, (held, steps) = 0, _at_chosen_times(of)
        method = [*held["sigma_XX"].values][-1]
        ylims = {name: limits(along.X, along.values[method]) for name, along in held.items()}
    else:
        steps = np.array(spread(range(len(t)), _FRAMES))
        start, held, ylim = _leaning(of, steps)
        method, ylims = SIE, {"sigma_YY": ylim}
    # All by one method, as lines.
    held = {name: replace(along, values={SIE: along.values[method]}) for name, along in held.items()}
    steady, row = _steady(of, held, start, [-1]), rows.CENTRE[method]
    end = of.scaled(rows.STEADY_CENTRE).of(of.data[rows.STEADY_CENTRE.path])[start]
    centre = of.values(row)[start]
    way = Panel(
        label, _over_a(of, "centre of pressure", row), xlim=(0.0, float(t[-1])), at_y=(float(end),),
        curves=[Curve(t, centre, looks(1)[0])],
    )  # fmt: skip

    def panels(frame: int) -> list[Panel]:
        i, made = steps[frame], list[Panel]()
        for name, along in held.items():
            shown = along.shown(looks(1), rows=[frame])
            called = [] if made else ["steady"]
            shown += steady[name].shown([_STEADY], called, 0.8) if steady else []
            made.append(surface_panel(shown, ylims[name]))
        made[0] = replace(made[0], title=_at_time(of, of.data[rows.TIMES.path][i]))
        return [*made, with_dot(way, t[i], centre[i])]

    moving = Film(panels, len(steps), of.choice.size)
    return Drawing(FILM, "", moving.figure, left_out=_left_out(of), film=moving)
