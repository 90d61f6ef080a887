"""Friction along the contact, and the pressure beside that of one friction with the same resultant."""

import numpy as np

from galinx.postprocess.quantities.states import FRICTION, RATIO, RESULTANT_RATIO, SPEED
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
    states, pressures = chosen.tolist(), {m: row for m, row in PRESSURE.items() if row.path in data}
    values = {method: -of.values(row) for method, row in pressures.items()}
    ratio = next(data[row.path] for row in RESULTANT_RATIO.values() if row.path in data)
    over_x, over_p, over_one, inside = list[Curve](), list[Curve](), list[Curve](), np.abs(X) < 1.0
    unit = of.scaled(next(iter(pressures.values())))
    for k, (i, look) in enumerate(zip(states, labels.looks(states, names))):
        factor, offset = place_of(of, i)
        x, sign = (
            offset + factor * X[inside],
            np.sign(data[FRICTION.path][i] * data[RATIO.path][i]) or 1.0,
        )
        label = labels.label(i, names)
        over_x.append(Curve(x, sign * data[RATIO_ALONG.path][i][inside], look, label))
        of_state = {method: p[i][inside] for method, p in values.items()}
        over_p += both(x, of_state, look, "", k / len(states))
        response = of.scene.body.response(float(data[SPEED.path][i]))
        one = -FlatPunch(response, float(ratio[i])).σ_YY(X)
        one_of_all = unit.of(np.tile(one, (len(data[RATIO.path]), 1)))[i][inside]
        over_one += both(x, {m: p / one_of_all for m, p in of_state.items()}, look, "", k / len(states))
        over_p.append(Curve(x, one_of_all, look._replace(line=LINES[3]), "", width=0.7))
    shown = np.concatenate([p[states] for p in values.values()])
    factor, offset = place_of(of, states[0])
    window = (offset - factor * _UNDER, offset + factor * _UNDER)
    panels = [
        Panel(position_name(of, "position "), "friction coefficient $f$", curves=over_x, xlim=window, at_y=(0.0,)),
        Panel(
            position_name(of, "position "), named(r"contact pressure $-\sigma_{YY}$", unit.unit), curves=over_p,
            xlim=window, ylim=limits(X, shown), at_y=(0.0,),
        ),
        Panel(position_name(of, "position "), "pressure over that of one friction", curves=over_one, xlim=window, at_y=(1.0,)),
    ]  # fmt: skip
    notes = [
        *explained(set(values)),
        handle(Look(GREY, LINES[3], ""), "dotted: one friction of the same resultant"),
    ]
    caption = (
        "Friction along the contact, and the contact pressure beside that of one friction with the same "
        "resultant (dotted). At each end the pressure has the exponent of the friction there."
    )
    missing = not_shown(labels, states, "--figure along --states", of.choice.states)
    return Drawing(
        "along", caption, render(panels, of.size, 0 if of.size else 3, notes, 0.8), left_out=missing
    )
