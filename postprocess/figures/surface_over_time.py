"""Stresses along the surface that move, and beside them the way of the pressure's centre."""

from collections.abc import Sequence

from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Room, Size, panels
from galinx.postprocess.figures.film import Film, along_surface
from galinx.postprocess.figures.style import COLOURS, GREY, PAGE, styled
from galinx.postprocess.figures.surface import Stress, parts


@styled
def surface_film(
    X: NDArray,
    t: NDArray,
    stresses: Sequence[Stress],
    steady: Sequence[NDArray],
    centre: tuple[NDArray, NDArray, NDArray],
    size: Size | None = None,
) -> Film:
    """A film of stresses.

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
