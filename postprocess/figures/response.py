"""What a punch answers to loads that oscillate, over frequency."""

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, lettered, panels
from galinx.postprocess.figures.style import PAGE, looks, styled

_LABELS = (
    r"stiffness $\mathrm{Re}\,(\hat N/\hat v_0)/2\mu$",
    r"damping $\mathrm{Im}\,(\hat N/\hat v_0)/2\mu\;/\;(\omega a/c_s)$",
)


@dataclass(frozen=True)
class Curve:
    """A speed with a friction.

    Attributes:
        label: names it in a legend.
        ω: angular frequencies over c_s/a, (n,).
        parts: real part of N̂/v̂₀ over 2μ, and its imaginary part over that and ω, (2, n).
        plane_waves: what the latter comes to.
    """

    label: str
    ω: NDArray
    parts: NDArray
    plane_waves: float


@styled
def response_figure(curves: Sequence[Curve], size: Size | None = None) -> Figure:
    """Stiffness and damping over frequency.

    Args:
        curves: what to draw.
        size: of the figure.
    """
    size = size or Size(PAGE)
    styles = looks(len(curves))
    legend = Legend([handle(look, curve.label) for look, curve in zip(styles, curves)], size.width)
    wide = size.width > 4.5
    room = Room(0.6, 0.1, 0.42 + legend.height, 0.2, 0.65, 0.5)
    figure, axes = panels(1 if wide else 2, 2 if wide else 1, size, 0.72, room)
    for n, (axis, label) in enumerate(zip(axes.flat, _LABELS)):
        for look, curve in zip(styles, curves):
            axis.plot(curve.ω, curve.parts[n], color=look.colour, linestyle=look.line)
            if n == 1:
                axis.axhline(
                    curve.plane_waves, color=look.colour, linewidth=0.5, linestyle="--", zorder=0
                )
        ends = curves[0].ω[0], curves[0].ω[-1]
        axis.set(xscale="log", xlabel=r"frequency $\omega a/c_s$", ylabel=label, xlim=ends)
    lettered(axes.flat)
    legend.put(figure)
    return figure
