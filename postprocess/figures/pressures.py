"""Contact pressures over the place, one after the other."""

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, panels
from galinx.postprocess.figures.style import COLUMN, GREY, looks, styled

#: Pressure over the largest that is drawn: it is infinite at the ends.
_TOP = 2.5


@styled
def pressures_figure(
    X: NDArray, pressures: dict[str, NDArray], steady: NDArray, size: Size | None = None
) -> Figure:
    """Pressures by what a legend calls them, and that of steady motion.

    Args:
        X: positions over a, (n,).
        pressures: over N/(2a), (n,) each.
        steady: the same in steady motion, (n,).
        size: of the figure.
    """
    size, styles = size or Size(COLUMN), looks(len(pressures), ordered=True)
    told = [handle(look, label) for look, label in zip(styles, pressures)]
    told.append(Line2D([], [], color=GREY, linestyle="--", label="steady"))
    legend = Legend(told, size.width)
    figure, axes = panels(1, 1, size, 0.75, Room(0.55, 0.1, 0.43 + legend.height, 0.1))
    axis = axes[0, 0]
    for look, pressure in zip(styles, pressures.values()):
        axis.plot(X, pressure, color=look.colour, linestyle=look.line)
    axis.plot(X, steady, color=GREY, linestyle="--", linewidth=0.8)
    axis.set(
        xlabel="position $X/a$",
        ylabel=r"pressure $-\sigma_{YY}/(N/2a)$",
        xlim=(-1.0, 1.0),
        ylim=(0.0, _TOP),
    )
    legend.put(figure)
    return figure
