"""Contact pressures over the place, one after the other."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, panels
from galinx.postprocess.figures.film import Film
from galinx.postprocess.figures.style import COLOURS, COLUMN, GREY, PAGE, looks, styled

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
    _steady(axis, X, steady)
    legend.put(figure)
    return figure


def _steady(axis: Axes, X: NDArray, steady: NDArray) -> None:
    axis.plot(X, steady, color=GREY, linestyle="--", linewidth=0.8)
    axis.set(
        xlabel="position $X/a$",
        ylabel=r"pressure $-\sigma_{YY}/(N/2a)$",
        xlim=(-1.0, 1.0),
        ylim=(0.0, _TOP),
    )


@styled
def pressures_film(
    X: NDArray,
    t: NDArray,
    pressures: NDArray,
    steady: NDArray,
    centre: tuple[NDArray, float],
    size: Size | None = None,
) -> Film:
    """A pressure that changes, and beside it the way of its centre.

    Args:
        X: positions over a, (n,).
        t: times over a/c_s, (frames,).
        pressures: over N/(2a), (frames, n).
        steady: the same in steady motion, (n,).
        centre: of the pressure over a, (frames,), and in steady motion.
        size: of the figure.
    """
    figure, axes = panels(1, 2, size or Size(PAGE), 0.75, Room(0.55, 0.1, 0.43, 0.22, 0.7))
    line = axes[0, 0].plot(X, pressures[0], color=COLOURS[0])[0]
    _steady(axes[0, 0], X, steady)
    way, at_last = centre
    axes[0, 1].plot(t, way, color=COLOURS[0])
    axes[0, 1].axhline(at_last, color=GREY, linestyle="--", linewidth=0.8)
    dot = axes[0, 1].plot(t[:1], way[:1], "o", color="black", markersize=5)[0]
    axes[0, 1].set(xlabel="time $t/(a/c_s)$", ylabel="centre of pressure$/a$", xlim=(0.0, t[-1]))

    def show(frame: int) -> None:
        line.set_ydata(pressures[frame])
        dot.set_data([t[frame]], [way[frame]])
        axes[0, 0].set_title(f"$t = {t[frame]:.2f}\\,a/c_s$", loc="left")

    return Film(figure, len(t), show)
