"""Curves over the angle of a solid."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Size, TooSmall, handle, lettered
from galinx.postprocess.figures.style import GREY, PAGE, SMALL, looks, styled

#: Least width of a panel [in], and heights of what stands above and below its panels.
_LEAST, _ABOVE, _BELOW = 1.6, 0.45, 0.25


@dataclass(frozen=True)
class Panel:
    """Curves with one radius.

    Attributes:
        title: what the radius is, with its unit.
        curves: values at the angles by label, each (angles,); NaN where there is none.
    """

    title: str
    curves: dict[str, NDArray]


@styled
def polar_figure(angles: NDArray, shown: Sequence[Panel], now: float, size: Size | None = None) -> Figure:
    """Panels side by side, in rows where the figure is narrow; radii begin at 0.

    Args:
        angles: of the solid's axis from X [°], (n,).
        shown: the panels.
        now: an angle that is marked [°].
        size: of the figure.

    Raises:
        TooSmall: it does not fit.
    """
    size = size or Size(PAGE)
    if size.width < _LEAST:
        raise TooSmall(f"expected at least {_LEAST} in of width")
    columns = min(len(shown), int(size.width / _LEAST))
    columns = -(-len(shown) // -(-len(shown) // columns))  # as even as rows can be
    rows = -(-len(shown) // columns)
    legends = [Legend(_entries(panel), size.width / columns) for panel in shown]
    below = max(legend.height for legend in legends) + _BELOW
    circle = 0.72 * size.width / columns
    height = size.height or rows * (circle + _ABOVE + below)
    figure = Figure((size.width, height))
    FigureCanvasAgg(figure)
    place = {"left": 0.06, "right": 0.94, "bottom": below / height, "top": 1.0 - _ABOVE / height}
    between = (_ABOVE + below) / max(height / rows - _ABOVE - below, 0.1)
    every = figure.subplots(
        rows, columns, squeeze=False, subplot_kw={"projection": "polar"},
        gridspec_kw=place | {"wspace": 0.4, "hspace": between},
    ).ravel()  # fmt: skip
    axes = every[: len(shown)]
    for axis in every[len(shown) :]:
        axis.remove()
    φ = np.deg2rad(angles)
    for axis, panel in zip(axes, shown):
        for (_, values), look in zip(panel.curves.items(), looks(len(panel.curves))):
            axis.plot(φ, values, color=look.colour, linestyle=look.line)
        largest = max(np.nanmax(values, initial=0.0) for values in panel.curves.values())
        axis.set_rlim(0.0, 1.2 * largest if largest > 0.0 else 1.0)
        # None at the rim, where the angles' own numbers are.
        axis.yaxis.set_major_locator(MaxNLocator(3, prune="both"))
        axis.plot(np.deg2rad([now, now]), axis.get_ylim(), color=GREY, linewidth=0.5)
        axis.set_thetagrids(range(0, 360, 30))
        axis.tick_params(labelsize=SMALL, pad=0.5)
        axis.set_rlabel_position(45.0)
        if len(panel.curves) > 1:
            axis.legend(
                handles=_entries(panel), loc="upper center", bbox_to_anchor=(0.5, -0.12), fontsize=SMALL,
                labelspacing=0.2, borderaxespad=0.0,
            )  # fmt: skip
    lettered(axes, [panel.title for panel in shown], above=True)
    return figure


def _entries(panel: Panel) -> list:
    if len(panel.curves) == 1:
        return []
    return [handle(look, label) for label, look in zip(panel.curves, looks(len(panel.curves)))]
