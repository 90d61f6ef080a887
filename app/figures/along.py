"""Friction along the contact, and the pressure beside that of one friction with the same resultant."""

import numpy as np

from galinx.postprocess.quantities.states import RESULTANT_RATIO, SPEED
from galinx.postprocess.quantities.stresses import PRESSURE, RATIO_ALONG, SURFACE_X
from galinx.solvers.contact.closed_form import FlatPunch

from .choice import Archive, Drawing, both, explained, named
from .render import Curve, Panel, handle, render
from .states import not_shown, states_for_panel
from .stresses import limits, place_of, position_name
from .style import GREY, LINES, Look

#: Curves that can be told apart.
_CURVES = 4
#: Positions shown over a.
_UNDER = 1.04


def has_along(of: Archive) -> bool:
    """Return True if an archive has friction that varies along the contact."""
    return of.has(RATIO_ALONG)


def along(of: Archive) -> Drawing:
    """Figure of f over X, and of the pressure beside that of one friction with the same resultant."""
    data, labels, X = of.data, of.labels, of.data[SURFACE_X.path]
    names, chosen = states_for_panel(labels, labels.varied(of.selected()), of.selected(), _CURVES)
    states, rows = chosen.tolist(), {method: row for method, row in PRESSURE.items() if of.has(row)}
    pressures = {method: -of.values(row) for method, row in rows.items()}
    of_one = next(data[row.path] for row in RESULTANT_RATIO.values() if of.has(row))
    under, unit = np.abs(X) < 1.0, of.scaled(next(iter(rows.values())))
    curves: tuple[list[Curve], ...] = ([], [], [])
    for k, (i, look) in enumerate(zip(states, labels.looks(states, names))):
        (a, middle), turn = place_of(of, i), k / len(states)
        x, ratio = middle + a * X[under], of.scene.friction.stress_ratio
        curves[0].append(Curve(x, ratio * data[RATIO_ALONG.path][i][under], look, labels.label(i, names)))
        punch = FlatPunch(of.scene.body.response(float(data[SPEED.path][i])), float(of_one[i]))
        one = unit.of(np.tile(-punch.σ_YY(X[under]), (len(of_one), 1)))[i]
        each = {method: p[i][under] for method, p in pressures.items()}
        curves[1].extend(both(x, each, look, "", turn))
        curves[1].append(Curve(x, one, look._replace(line=LINES[3]), "", width=0.7))
        curves[2].extend(both(x, {method: p / one for method, p in each.items()}, look, "", turn))
    labels_y = (
        ("friction coefficient $f$", 0.0),
        (named(r"contact pressure $-\sigma_{YY}$", unit.unit), 0.0),
        ("over that of one friction", 1.0),
    )
    ranges = [None] + [limits(X[under], np.array([curve.y for curve in drawn])) for drawn in curves[1:]]
    panels = [
        Panel(
            position_name(of, "position "), y, curves=drawn, ylim=ylim, at_y=(level,),
            xlim=(middle - _UNDER * a, middle + _UNDER * a),
        )
        for drawn, (y, level), ylim in zip(curves, labels_y, ranges)
    ]  # fmt: skip
    dotted = handle(Look(GREY, LINES[3], ""), "dotted: one friction of the same resultant")
    figure = render(panels, of.size, 0 if of.size else 3, [*explained(set(pressures)), dotted], 0.8)
    caption = (
        "Friction along the contact, and the contact pressure beside that of one friction with the same "
        "resultant (dotted). At each end the pressure has the exponent of the friction there."
    )
    missing = not_shown(labels, states, "--figure along --states", of.choice.states)
    return Drawing("along", caption, figure, left_out=missing)
