"""Curves over the angle of a solid."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Size, TooSmall, handle, lettered
from galinx.postprocess.figures.style import GREY, PAGE, SMALL, looks, styled

#: Least width of a figure [in], and heights of what stands above and below its panels.
_LEAST, _ABOVE, _BELOW = 4.5, 0.45, 0.25


@dataclass(frozen=True)
class Panel:
    """Curves with one radius.

    Attributes:
        title: what the radius is, with its unit.
        curves: values at the angles by label, each (angles,); NaN where there is none.
        from_zero: the radius begins at 0.
    """

    title: str
    curves: dict[str, NDArray]
    from_zero: bool = True


@styled
def polar_figure(angles: NDArray, shown: Sequence[Panel], now: float, size: Size | None = None) -> Figure:
    """Panels side by side.

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
    legends = [Legend(_entries(panel), size.width / len(shown)) for panel in shown]
    below = max(legend.height for legend in legends) + _BELOW
    height = size.height or size.width / len(shown) * 0.82 + _ABOVE + below
    figure = Figure((size.width, height))
    FigureCanvasAgg(figure)
    place = {"left": 0.05, "right": 0.95, "bottom": below / height, "top": 1.0 - _ABOVE / height}
    axes = figure.subplots(
        1,
        len(shown),
        squeeze=False,
        subplot_kw={"projection": "polar"},
        gridspec_kw=place | {"wspace": 0.4},
    )[0]
    φ = np.deg2rad(angles)
    for axis, panel in zip(axes, shown):
        for (_, values), look in zip(panel.curves.items(), looks(len(panel.curves))):
            axis.plot(φ, values, color=look.colour, linestyle=look.line)
        if panel.from_zero:
            axis.set_rmin(0.0)
        else:
            all_of_it = np.concatenate(list(panel.curves.values()))
            axis.set_rlim(np.nanmin(all_of_it) * 0.95, np.nanmax(all_of_it) * 1.01)
        axis.plot(np.deg2rad([now, now]), axis.get_ylim(), color=GREY, linewidth=0.5)
        axis.set_thetagrids(range(0, 360, 30))
        axis.tick_params(labelsize=SMALL, pad=0.5)
        axis.set_rlabel_position(75.0)
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
