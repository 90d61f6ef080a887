"""Stick-slip: velocity over time, and friction over velocity in a cycle."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, lettered, panels
from galinx.postprocess.figures.style import GREY, PAGE, looks, styled

#: Steps of a cycle between its beginning and an arrow, over all.
_ARROWS = (0.25, 0.75)


@dataclass(frozen=True)
class Slide:
    """How a slider moved.

    Attributes:
        label: names it in a legend.
        v: velocity at the times [m/s].
        cycle_v, cycle_f: velocity [m/s] and friction coefficient in the last cycle, NaN for none.
    """

    label: str
    v: NDArray
    cycle_v: NDArray
    cycle_f: NDArray


@styled
def slider_figure(
    t: NDArray, slides: Sequence[Slide], drive_speed: float, ordered: bool, size: Size | None = None
) -> Figure:
    """Sliders side by side: all velocities over time, and the loops of their last cycles.

    Args:
        t: times [s].
        slides: what to draw.
        drive_speed: of the spring's other end [m/s], a line.
        ordered: the sliders follow a number.
        size: of the figure.
    """
    size = size or Size(PAGE)
    styles = looks(len(slides), ordered)
    several = len(slides) > 1
    handles = [handle(look, slide.label) for look, slide in zip(styles, slides)] if several else []
    legend = Legend(handles, size.width)
    wide = size.width > 4.5
    room = Room(0.6, 0.1, 0.42 + legend.height, 0.2, 0.65, 0.65)
    figure, axes = panels(1 if wide else 2, 2 if wide else 1, size, 0.62, room)
    first, second = axes.flat
    for look, slide in zip(styles, slides):
        first.plot(t, slide.v, color=look.colour, linestyle=look.line)
        if np.isfinite(slide.cycle_v).all():
            second.plot(slide.cycle_v, slide.cycle_f, color=look.colour, linestyle=look.line)
            for share in _ARROWS:
                _arrow(second, slide, share, look.colour)
    for draw in (first.axhline, second.axvline):
        draw(drive_speed, color=GREY, linewidth=0.4, zorder=0)
    first.set(xlabel="time $t$ (s)", ylabel=r"velocity $v$ (m/s)", xlim=(0.0, t[-1]))
    second.set(xlabel=r"velocity $v$ (m/s)", ylabel="friction coefficient $f = F/N$")
    lettered(axes.flat)
    legend.put(figure)
    return figure


def _arrow(axis: Axes, slide: Slide, share: float, colour: Any) -> None:
    """Along a loop, where by its length on the page the share of it is done."""
    spans = np.ptp(slide.cycle_v) or 1.0, np.ptp(slide.cycle_f) or 1.0
    steps = np.hypot(np.diff(slide.cycle_v) / spans[0], np.diff(slide.cycle_f) / spans[1])
    way = np.append(0.0, np.cumsum(steps))
    from_, to = np.searchsorted(way, [share * way[-1], (share + 0.02) * way[-1]])
    to = min(max(int(to), int(from_) + 1), len(way) - 1)
    axis.annotate(
        "", (slide.cycle_v[to], slide.cycle_f[to]), (slide.cycle_v[from_], slide.cycle_f[from_]),
        arrowprops={
            "arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9,
        },
    )  # fmt: skip
