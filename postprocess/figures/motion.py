"""Motions in time: the pressure and its punch, works and energies, contact pressures, surface stresses.

Curves over time show indentation, centre of the pressure and K_I, works, and the energies that they
become. Contact pressures are drawn at several times in one panel, or as a film; stresses along the
surface as a film, beside the way of the pressure's centre.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from .canvas import Legend, Room, Size, handle, lettered, panels
from .maps import Film, along_surface
from .style import COLOURS, COLUMN, GREY, PAGE, looks, styled
from .surface import Stress, parts

#: Labels of the panels' axes.
_LABELS = (
    "centre of pressure$/a$", r"indentation $v_0/(N/2\mu)$", "$K_I$ at $X = -a$", "$K_I$ at $X = a$",
)  # fmt: skip
#: Points of the other method along a curve.
_POINTS = 15


@dataclass(frozen=True)
class Start:
    """Motion that starts from rest.

    Attributes:
        label: its name in a legend.
        curves: numbers of each panel, (times,) each.
        beside: numbers of each panel by another method, or none.
        steady: centre of the pressure over a if it were at once that of steady motion, (times,).
    """

    label: str
    curves: Sequence[NDArray]
    beside: Sequence[NDArray]
    steady: NDArray


@styled
def time_figure(t: NDArray, starts: Sequence[Start], size: Size | None = None) -> Figure:
    """Figure with a panel over time for each of the curves that is not NaN.

    Args:
        t: times over a/c_s.
        starts: what to draw.
        size: of the figure.
    """
    size = size or Size(PAGE)
    styles = looks(len(starts))
    legend = Legend([handle(look, start.label) for look, start in zip(styles, starts)], size.width)
    wide = size.width > 4.5
    room = Room(0.6, 0.1, 0.42 + legend.height, 0.2, 0.65, 0.5)
    shown = [
        n for n in range(len(_LABELS)) if any(np.isfinite(start.curves[n]).any() for start in starts)
    ]
    across = 2 if wide else 1
    figure, axes = panels(len(shown) // across, across, size, 0.62, room)
    every = max(len(t) // _POINTS, 1)
    for axis, n in zip(axes.flat, shown):
        for look, start in zip(styles, starts):
            axis.plot(t, start.curves[n], color=look.colour, linestyle=look.line)
            if start.beside:
                axis.plot(
                    t[::every],
                    start.beside[n][::every],
                    "o",
                    color=look.colour,
                    markersize=2.5,
                    mfc="none",
                )
            if n == 0:
                axis.plot(t, start.steady, color=look.colour, linewidth=0.7, linestyle=":", zorder=0)
        axis.set(xlabel="time $t/(a/c_s)$", ylabel=_LABELS[n], xlim=(0.0, t[-1]))
    lettered(axes.flat)
    legend.put(figure)
    return figure


@styled
def energies_figure(
    t: NDArray, done: Mapping[str, NDArray], held: Mapping[str, NDArray], size: Size | None = None
) -> Figure:
    """Figure of works, and of the energies that they become, each with its sum.

    Args:
        t: times over a/c_s, (times,).
        done: works by name over N²/(4μ), (times,) each.
        held: energies by name.
        size: of the figure.
    """
    size, styles = size or Size(PAGE), looks(len(done) + len(held))
    names = [*done, *held]
    handles = [handle(look, name) for look, name in zip(styles, names)]
    handles.append(handle(styles[0]._replace(colour=GREY, line="-"), "all together", linewidth=1.8))
    legend = Legend(handles, size.width)
    across = 2 if size.width > 4.5 else 1
    room = Room(0.6, 0.1, 0.43 + legend.height, 0.2, 0.65, 0.5)
    figure, axes = panels(2 // across, across, size, 0.68, room)
    for axis, energies in zip(axes.flat, (done, held)):
        axis.plot(t, sum(energies.values()), color=GREY, linewidth=1.8, zorder=0)
        for name, values in energies.items():
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


#: Pressure over the largest that is drawn: it is infinite at the ends.
_TOP = 2.5


@styled
def pressures_figure(
    X: NDArray, pressures: dict[str, NDArray], steady: NDArray, size: Size | None = None
) -> Figure:
    """Figure of pressures by their names in a legend, and that of steady motion.

    Args:
        X: positions over a, (n,).
        pressures: over N/(2a), (n,) each.
        steady: pressure in steady motion over N/(2a), (n,).
        size: of the figure.
    """
    size, styles = size or Size(COLUMN), looks(len(pressures), ordered=True)
    handles = [handle(look, label) for look, label in zip(styles, pressures)]
    handles.append(Line2D([], [], color=GREY, linestyle="--", label="steady"))
    legend = Legend(handles, size.width)
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
    """Film of a pressure that changes, and beside it the way of its centre.

    Args:
        X: positions over a, (n,).
        t: times over a/c_s, (frames,).
        pressures: over N/(2a), (frames, n).
        steady: pressure in steady motion over N/(2a), (n,).
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


@styled
def surface_film(
    X: NDArray,
    t: NDArray,
    stresses: Sequence[Stress],
    steady: Sequence[NDArray],
    centre: tuple[NDArray, NDArray, NDArray],
    size: Size | None = None,
) -> Film:
    """Film of stresses along the surface, and beside it the way of the pressure's centre.

    Args:
        X: positions over a, (n,).
        t: times over a/c_s, (frames,).
        stresses: by one method each, (frames, n).
        steady: of each in steady motion, (n,).
        centre: times, centre of the pressure over a then, and at which of them each frame is.
        size: of the figure.
    """
    room = Room(0.55, 0.1, 0.43, 0.22, 0.7)
    figure: Figure
    figure, axes = panels(1, len(stresses) + 1, size or Size(PAGE), 0.85, room)
    updates = []
    for axis, stress, last in zip(axes[0], stresses, steady):
        for part in parts(X):
            axis.plot(X[part], last[part], color=GREY, linestyle="--", linewidth=0.8, zorder=0)
        updates.append(along_surface(axis, X, stress))
    times, way, at = centre
    axis = axes[0, -1]
    axis.plot(times, way, color=COLOURS[0])
    dot = axis.plot(times[at[:1]], way[at[:1]], "o", color="black", markersize=5)[0]
    axis.set(xlabel="time $t/(a/c_s)$", ylabel="centre of pressure$/a$", xlim=(0.0, times[-1]))

    def show(frame: int) -> None:
        dot.set_data([times[at[frame]]], [way[at[frame]]])
        axes[0, 0].set_title(f"$t = {t[frame]:.3g}\\,a/c_s$", loc="left")
        for update in updates:
            update(frame)

    return Film(figure, len(t), show)
