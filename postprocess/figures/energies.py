"""Energies over time: what is done on a solid, and where it is."""

from collections.abc import Mapping

from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Legend, Room, Size, handle, lettered, panels
from galinx.postprocess.figures.style import GREY, PAGE, looks, styled


@styled
def energies_figure(
    t: NDArray, done: Mapping[str, NDArray], held: Mapping[str, NDArray], size: Size | None = None
) -> Figure:
    """Works, and the energies that they become, each with its sum.

    Args:
        t: times over a/c_s, (times,).
        done: works by name over N²/(4μ), (times,) each.
        held: energies by name.
        size: of the figure.
    """
    size, styles = size or Size(PAGE), looks(len(done) + len(held))
    names = [*done, *held]
    told = [handle(look, name) for look, name in zip(styles, names)]
    told.append(handle(styles[0]._replace(colour=GREY, line="-"), "all together", linewidth=1.8))
    legend = Legend(told, size.width)
    across = 2 if size.width > 4.5 else 1
    room = Room(0.6, 0.1, 0.43 + legend.height, 0.2, 0.65, 0.5)
    figure, axes = panels(2 // across, across, size, 0.68, room)
    for axis, some in zip(axes.flat, (done, held)):
        axis.plot(t, sum(some.values()), color=GREY, linewidth=1.8, zorder=0)
        for name, values in some.items():
            look = styles[names.index(name)]
            axis.plot(t, values, color=look.colour, linestyle=look.line)
        axis.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
        axis.set(xlabel="time $t/(a/c_s)$", xlim=(0.0, t[-1]))
    low, high = (pick(axis.get_ylim()[n] for axis in axes.flat) for n, pick in ((0, min), (1, max)))
    for axis, what in zip(axes.flat, ("work", "energy")):
        axis.set(ylabel=rf"{what} since $t = 0$ over $N^2/4\mu$", ylim=(low, high))
    lettered(axes.flat)
    legend.put(figure)
    return figure
