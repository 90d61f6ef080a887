"""How fast waves along layers run, over how short they are."""

from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Room, Size, panels
from galinx.postprocess.figures.style import COLUMN, GREY, looks, styled


@styled
def dispersion_figure(
    kH: NDArray, speed: NDArray, limit: float, ends: tuple[float, float], size: Size | None = None
) -> Figure:
    """The slowest wave's speed, the highest speed of a punch, and what both ends tend to.

    Args:
        kH: wavenumber times the thickness of all layers, (n,).
        speed: of the slowest wave [m/s], NaN for none, (n,).
        limit: highest speed of a punch [m/s].
        ends: speeds of the waves along the substrate and the surface's solid alone [m/s].
        size: of the figure.
    """
    size = size or Size(COLUMN)
    figure, axes = panels(1, 1, size, 0.72, Room(0.62, 0.1, 0.48, 0.1))
    axis, (look, *_) = axes[0, 0], looks(1)
    axis.plot(kH, speed, color=look.colour, linestyle=look.line)
    axis.axhline(limit, color=GREY, linewidth=0.7, linestyle="--")
    for x, y in zip((kH[0], kH[-1]), ends):
        axis.plot([x], [y], marker="o", color=look.colour, markerfacecolor="none", clip_on=False)
    axis.set(xscale="log", xlabel="wavenumber $kH$", ylabel="speed [m/s]", xlim=(kH[0], kH[-1]))
    axis.margins(y=0.1)
    return figure
