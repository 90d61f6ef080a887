"""Figure of the stresses along the surface of several archives' states, one over the other."""

from collections.abc import Sequence

import numpy as np

from galinx.postprocess.quantities.stresses import SURFACE_X

from ..errors import BadInput
from .choice import Archive, Drawing, explained
from .render import Panel, TooSmall, render
from .states import spread
from .stresses import (
    along,
    contacts_of,
    has_surface,
    limits,
    place_of,
    position_name,
    stress_names,
    surface_curves,
    surface_stresses,
)
from .style import LINES, looks

#: States of each archive that can be told apart.
_STATES = 3


def compared(
    archives: Sequence[Archive], labels: Sequence[str], pairs: Sequence[Sequence[int]],
    titles: Sequence[str],
) -> Drawing:  # fmt: skip
    """Contact pressure and in-plane stress of states, colours by archive and lines by state.

    Args:
        archives: what to draw, in the same units.
        labels: of the archives.
        pairs: a state of each archive, (pairs, archives); of many some are drawn.
        titles: of the pairs.

    Raises:
        BadInput: an archive has no stresses along the surface, or measured points lie elsewhere.
    """
    for of, label in zip(archives, labels):
        if not has_surface(of):
            raise BadInput(
                f'{label} holds no stresses along the surface; add "surface" to output.quantities'
            )
    chosen, styles = spread(range(len(pairs)), _STATES), looks(len(archives))
    panels = []
    methods = {method for of in archives for by in surface_stresses(of).values() for method in by}
    for name in dict.fromkeys(name for of in archives for name in stress_names(of)):
        curves, ranges, windows, ends = [], [], [], []
        for n, of in enumerate(archives):
            shown = dict(zip(stress_names(of), surface_stresses(of).items()))
            if name not in shown:
                continue
            axis, values = shown[name]
            X, drawn = of.data[SURFACE_X.path], next(iter(values.values()))
            states = [pairs[k][n] for k in chosen]
            half = along(X, drawn)
            ranges.append(limits(X, drawn[states]))
            ends += contacts_of(of, states) if half > 1.5 else []
            for order, (k, state) in enumerate(zip(chosen, states)):
                line = LINES[order % len(LINES)] if len(chosen) > 1 else styles[n].line
                a, b = place_of(of, state)
                windows += [b - half * a, b + half * a]
                curves += surface_curves(
                    X, {method: y[state] for method, y in values.items()}, styles[n]._replace(line=line),
                    f"{labels[n]}, {titles[k]}" if len(chosen) > 1 else labels[n],
                    n / len(archives), (a, b),
                )  # fmt: skip
        low, high = np.min(ranges, axis=0)[0], np.max(ranges, axis=0)[1]
        panel = Panel(
            position_name(archives[0]), axis, curves=curves, xlim=(min(windows), max(windows)),
            ylim=(float(low), float(high)), at_y=(0.0,),
            bands=ends[:1] if ends and np.allclose(ends, ends[0], rtol=1e-9) else (),
        )  # fmt: skip
        measured = archives[0].choice.measured
        panels.append(measured.over_stress(panel, name, archives[0].units) if measured else panel)
    try:
        figure = render(panels, None, min(2, len(panels)), explained(methods))
    except TooSmall as error:
        raise BadInput(f"the titles of these archives leave no room for curves: {error}") from error
    left_out = (
        f"{len(pairs) - len(chosen)} of {len(pairs)} pairs of states not shown; choose by --states."
    )
    return Drawing(
        "compare", f"Stresses along the surface: {', '.join(labels)}.", figure,
        left_out=left_out if len(pairs) > len(chosen) else "",
    )  # fmt: skip
