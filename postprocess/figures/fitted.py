"""Measured friction, a law that fits it, and what is left."""

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, lettered, panels
from galinx.postprocess.figures.style import COLOURS, GREY, PAGE, Look, styled

#: Powers of ten of a metre by its prefix, from which on lengths are told so.
_PREFIXES = ((1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm"))


@styled
def fitted_figure(t: NDArray, X: NDArray, f: NDArray, law: NDArray, timed: bool) -> Figure:
    """Friction over position, and the residuals over time or slip.

    Args:
        t: time [s], (samples,).
        X: position [m], (samples,).
        f: measured friction coefficient, (samples,).
        law: that of the law, NaN where it has none, (samples,).
        timed: was time measured?
    """
    size = Size(PAGE)
    legend = Legend(
        [
            handle(Look(COLOURS[0], "none", "."), "measured", marker="."),
            handle(Look(COLOURS[1], "-", ""), "fitted"),
        ],
        size.width,
    )
    room = Room(0.55, 0.1, 0.42 + legend.height, 0.2, 0.7)
    figure, axes = panels(1, 2, size, 0.66, room)
    first, second = axes.flat
    scale, unit = next(
        ((one, name) for one, name in _PREFIXES if np.ptp(X) >= one), _PREFIXES[-1]
    )  # fmt: skip
    first.plot(X / scale, f, ".", color=COLOURS[0], markersize=2.0)
    first.plot(X / scale, law, color=COLOURS[1])
    over, label = (t, "time (s)") if timed else (X / scale, f"slip ({unit})")
    second.plot(over, f - law, ".", color=COLOURS[0], markersize=2.0)
    second.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
    for axis in (first, second):
        axis.set_ylabel("friction coefficient $f$" if axis is first else "measured less fitted $f$")
    first.set_xlabel(f"position ({unit})" if timed else f"slip ({unit})")
    second.set_xlabel(label)
    lettered(axes.flat)
    legend.put(figure)
    return figure
