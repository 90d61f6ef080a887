"""Maps of stresses below the punch."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from galinx.postprocess.figures.canvas import Room, Size, lettered, panels
from galinx.postprocess.figures.style import COLUMN, PAGE, SMALL, styled

#: Share of the values that have colours of their own: the edges of the punch would leave none for the
#: rest.
_SHOWN = 0.985

#: Room that a bar of colours takes [in].
_BAR = 0.7

#: Colours of differences begin where so many of them lie below.
_LEAST = 0.02


@dataclass(frozen=True)
class Map:
    """A quantity on the grid.

    Attributes:
        values: by column, (columns, rows of the grid, columns of the grid).
        label: of its colours.
        signed: zero is in the middle of them.
        interfaces: depths of layers' lower faces over a.
    """

    label: str
    values: NDArray
    signed: bool
    interfaces: tuple[float, ...] = ()


@styled
def maps_figure(
    X: NDArray,
    Y: NDArray,
    maps: Sequence[Map],
    titles: Sequence[str],
    differences: Sequence[NDArray] = (),
    size: Size | None = None,
    frames: Sequence[tuple[float, float]] = (),
) -> Figure:
    """Maps: a row for each quantity, a column for each solution, then a column for each difference.

    Args:
        X, Y: positions over a, (columns,) and (rows,).
        maps: what to map; the maps of a row share their colours.
        titles: of the columns.
        differences: by row, over the row's largest value, (columns, rows, columns); none for none.
        size: of the figure.
        frames: half-width and middle [mm] of each solution's contact, drawn in mm; none: over a.
    """
    alone = len(titles) == 1 and len(maps) == 1
    # Two columns of many rows would be taller than a page.
    usual = COLUMN if len(titles) == 1 else PAGE if len(differences) or len(maps) < 3 else 0.7 * PAGE
    size = size or Size(usual)
    columns = len(titles) + (len(differences[0]) if len(differences) else 0)
    right = _BAR + (_BAR if len(differences) else 0.0)
    lines = max(title.count("\n") for title in titles) + (3 if len(differences) else 1)
    room = Room(0.45, right, 0.38, 0.09 + 0.167 * lines, 0.45 if frames else 0.12, 0.26)
    # The first column of differences stands beside the bars of the stresses.
    figure, axes = panels(len(maps), columns, size, (Y[-1] - Y[0]) / (X[-1] - X[0]), room)
    if len(differences):
        _make_way(axes[:, len(titles) :], _BAR / size.width)
    grids = [_Grid(X, Y, *frame) for frame in frames] or [_Grid(X, Y)] * len(titles)
    for shown, row in zip(maps, axes):
        limit, extend = _limits(shown)
        for grid, axis, values in zip(grids, row, shown.values):
            grid.draw(axis, values, limit, signed=shown.signed, lines=alone)
            grid.layers(axis, shown.interfaces)
        grids[0].bar(row[len(titles) - 1], limit, extend, shown)
    if len(differences):
        _differences(grids, axes[:, len(titles) :], np.asarray(differences))
    for axis in [] if frames else axes[:, 1:].flat:
        axis.set_yticklabels([])
    for axis in axes[:-1].flat:
        axis.set_xticklabels([])
    for axis in axes[-1]:
        axis.set_xlabel("$X$ (mm)" if frames else "$X/a$")
    for axis in axes[:, 0]:
        axis.set_ylabel("$Y$ (mm)" if frames else "$Y/a$")
    _name(axes, titles)
    return figure


def _name(axes: NDArray, titles: Sequence[str]) -> None:
    apart = axes.shape[1] > len(titles)
    told = [*titles, *[f"difference at\n{title}" for title in titles[: axes.shape[1] - len(titles)]]]
    lettered(axes.flat, [] if apart else titles)
    for axis, title in zip(axes[0], told if apart else []):
        axis.set_title(f"{title}\n{axis.get_title(loc='left')}")
    for axis in axes.flat:
        axis.set_title(axis.get_title(loc="left"), pad=4.5, y=1.0)


def _make_way(axes: NDArray, by: float) -> None:
    for axis in axes.flat:
        place = axis.get_position()
        axis.set_position([place.x0 + by, place.y0, place.width, place.height])


def _limits(shown: Map) -> tuple[float, str]:
    """Largest value with a colour of its own, and at which ends of the bar colours are clipped."""
    limit = float(np.quantile(np.abs(shown.values), _SHOWN)) or 1.0
    above, below = bool(shown.values.max() > limit), bool(shown.values.min() < -limit)
    return limit, {(True, True): "both", (True, False): "max", (False, True): "min"}.get(
        (above, below and shown.signed), "neither"
    )


def moving(axis: Axes, X: NDArray, Y: NDArray, shown: Map) -> Callable[[int], None]:
    """A map that changes: what draws one of its values."""
    limit, extend = _limits(shown)
    grid = _Grid(X, Y)
    grid.draw(axis, shown.values[0], limit, shown.signed, lines=False)
    grid.layers(axis, shown.interfaces)
    axis.set(xlabel="$X/a$", ylabel="$Y/a$")
    grid.bar(axis, limit, extend, shown)
    return lambda frame: axis.images[0].set_data(shown.values[frame])


class _Grid:
    """Where maps lie.

    Args:
        X, Y: positions over a.
        half_width, centre: of the contact.
    """

    def __init__(self, X: NDArray, Y: NDArray, half_width: float = 1.0, centre: float = 0.0) -> None:
        self._X, self._Y = X, Y = centre + half_width * X, half_width * Y
        self._contact = [centre - half_width, centre + half_width]
        half_X, half_Y = (abs(z[-1] - z[0]) / max(len(z) - 1, 1) / 2.0 for z in (X, Y))
        self._extent = (X[0] - half_X, X[-1] + half_X, Y[0] - half_Y, Y[-1] + half_Y)

    def draw(self, axis: Axes, values: NDArray, limit: float, signed: bool, lines: bool) -> None:
        low, colours = (-limit, "RdBu_r") if signed else (0.0, "viridis")
        axis.imshow(
            values, extent=self._extent, origin="lower", interpolation="bilinear", aspect="equal",
            cmap=colours, vmin=low, vmax=limit,
        )  # fmt: skip
        if lines:
            levels = MaxNLocator(9).tick_values(low, limit)
            axis.contour(self._X, self._Y, values, levels, colors="black", linewidths=0.3)
        self.frame(axis)

    def frame(self, axis: Axes) -> None:
        axis.plot(self._contact, [0.0, 0.0], color="black", linewidth=2.5, clip_on=False)
        axis.set(xlim=(self._X[0], self._X[-1]), ylim=(self._Y[0], 0.0))
        axis.locator_params(axis="x", nbins=6 if self._contact == [-1.0, 1.0] else 3)
        axis.locator_params(axis="y", nbins=4)

    def layers(self, axis: Axes, depths: Sequence[float]) -> None:
        """A line along each interface that is in the picture."""
        for depth in depths:
            if -depth > self._Y[0]:
                axis.axhline(-depth, color="black", linewidth=0.6, linestyle=(0, (5.0, 2.5)))

    def bar(self, axis: Axes, limit: float, extend: str, shown: Map) -> None:
        figure, place = axis.figure, axis.get_position()
        wide, tall = figure.get_figwidth() * place.width, figure.get_figheight() * place.height
        beside = axis.inset_axes((1.0 + 0.06 / wide, 0.0, 0.09 / wide, 1.0))
        bar = figure.colorbar(axis.images[0], cax=beside, extend=extend)
        bar.set_label(shown.label, fontsize=SMALL)
        bar.locator = MaxNLocator(max(3, int(4.0 * tall)))
        bar.update_ticks()


def _differences(grids: Sequence[_Grid], axes: NDArray, values: NDArray) -> None:
    """Sizes of differences, all in one range of colours."""
    sizes = np.abs(values)
    some = sizes[sizes > 0.0]
    low, high = np.quantile(some, (_LEAST, 1.0)) if len(some) else (1e-16, 1e-15)
    norm = colors.LogNorm(low, max(high, 2.0 * low))
    for row, of_row in zip(axes, sizes):
        for grid, axis, shown in zip(grids, row, of_row):
            axis.imshow(
                np.maximum(shown, low), extent=grid._extent, origin="lower", aspect="equal", norm=norm,
                cmap="cividis", interpolation="bilinear",
            )  # fmt: skip
            grid.frame(axis)
    upper, lower = axes[0, -1].get_position(), axes[-1, -1].get_position()
    figure = axes[0, 0].figure
    middle, tall = (upper.y1 + lower.y0) / 2.0, 0.6 * (upper.y1 - lower.y0)
    place = figure.add_axes(
        (upper.x1 + 0.08 / figure.get_figwidth(), middle - tall / 2.0, 0.1 / figure.get_figwidth(), tall)
    )
    figure.colorbar(
        axes[0, 0].images[0], cax=place, extend="min", label="difference of methods over the largest"
    )
