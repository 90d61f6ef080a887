"""Maps of stresses below the punch, and films: pictures of the states of strokes, one after the other."""

import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from matplotlib import colors
from matplotlib.animation import FFMpegWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray
from PIL import Image

from ..target import GIF, MP4, Kind
from . import friction, surface
from .canvas import Room, Size, lettered, panels
from .style import COLOURS, COLUMN, GREY, PAGE, SMALL, styled

#: Share of the values that have colours of their own: stresses at the edges of the punch would leave none
#: for the rest.
_SHOWN = 0.985

#: Room that a bar of colours takes [in].
_BAR = 0.7

#: Colours of differences begin where so many of them lie below.
_LEAST = 0.02


@dataclass(frozen=True)
class Map:
    """Map of a quantity on the grid, one for each column of a figure.

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
    """Figure of maps: a row for each quantity, a column for each solution and then each difference.

    Args:
        X, Y: positions over a, (columns,) and (rows,).
        maps: what to map; the maps of a row share their colours.
        titles: of the columns.
        differences: by row, over the row's largest value, (columns, rows, columns); none for none.
        size: of the figure.
        frames: half-width and middle [mm] of each solution's contact, for maps in mm; none for over a.
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
    all_titles = [
        *titles,
        *[f"difference at\n{title}" for title in titles[: axes.shape[1] - len(titles)]],
    ]
    lettered(axes.flat, [] if apart else titles)
    for axis, title in zip(axes[0], all_titles if apart else []):
        axis.set_title(f"{title}\n{axis.get_title(loc='left')}")
    for axis in axes.flat:
        axis.set_title(axis.get_title(loc="left"), pad=4.5, y=1.0)


def _make_way(axes: NDArray, by: float) -> None:
    for axis in axes.flat:
        place = axis.get_position()
        axis.set_position([place.x0 + by, place.y0, place.width, place.height])


def _limits(shown: Map) -> tuple[float, str]:
    """Largest value with a colour of its own, and the ends of the bar at which colours are clipped."""
    limit = float(np.quantile(np.abs(shown.values), _SHOWN)) or 1.0
    above, below = bool(shown.values.max() > limit), bool(shown.values.min() < -limit)
    return limit, {(True, True): "both", (True, False): "max", (False, True): "min"}.get(
        (above, below and shown.signed), "neither"
    )


def moving(axis: Axes, X: NDArray, Y: NDArray, shown: Map) -> Callable[[int], None]:
    """Draw the first frame of a map that changes, and return a function that draws another."""
    limit, extend = _limits(shown)
    grid = _Grid(X, Y)
    grid.draw(axis, shown.values[0], limit, shown.signed, lines=False)
    grid.layers(axis, shown.interfaces)
    axis.set(xlabel="$X/a$", ylabel="$Y/a$")
    grid.bar(axis, limit, extend, shown)
    return lambda frame: axis.images[0].set_data(shown.values[frame])


class _Grid:
    """Grid on which maps lie.

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
    positive = sizes[sizes > 0.0]
    low, high = np.quantile(positive, (_LEAST, 1.0)) if len(positive) else (1e-16, 1e-15)
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


#: Kind of file by the format's ending.
FORMATS: dict[str, Kind] = {"mp4": MP4, "gif": GIF}

#: Frames a second, and dots per inch, which screens show.
RATE, DPI = 8, 160


@dataclass(frozen=True)
class Film:
    """Figure that changes from frame to frame.

    Attributes:
        figure: the figure.
        frames: number of frames.
        show: draws a frame.
    """

    figure: Figure
    frames: int
    show: Callable[[int], None]


@styled
def strokes_film(
    loop: friction.Loop,
    places: Sequence[tuple[float, float]],
    titles: Sequence[str],
    surface_X: NDArray,
    stresses: Sequence[surface.Stress],
    grid: tuple[NDArray, NDArray] | None = None,
    mapped: Sequence[Map] = (),
    size: Size | None = None,
) -> Film:
    """Film of a friction loop on which a dot moves, and beside it the stresses there.

    Args:
        loop: the loop.
        places: position on the stroke and friction coefficient of each frame.
        titles: of the frames.
        surface_X: positions on the surface over a, (points,).
        stresses: along it, one method each, (frames, points).
        grid: positions over a of maps along both axes.
        mapped: stresses inside, one a frame.
        size: of the figure.
    """
    count = 1 + len(stresses) + len(mapped)
    size = size or Size(PAGE)
    room = Room(0.48, 0.1, 0.38, 0.2, 0.62, 0.4)
    if mapped:  # beside each stands the bar of its colours
        room = room._replace(right=0.62, across=0.95)
    figure, axes = panels(1, count, size, 0.85, room)
    friction.draw(axes[0, 0], friction.Panel("", [loop]))
    axes[0, 0].set(xlabel=friction.X_LABEL, ylabel=friction.F_LABEL)
    dot = axes[0, 0].plot(*places[0], "o", color="black", markersize=5, zorder=9)[0]
    updates: list[Callable[[int], None]] = []
    for axis, stress in zip(axes[0, 1:], stresses):
        updates.append(along_surface(axis, surface_X, stress))
    for axis, shown in zip(axes[0, 1 + len(stresses) :], mapped):
        assert grid is not None
        updates.append(moving(axis, *grid, shown))

    def show(frame: int) -> None:
        dot.set_data([places[frame][0]], [places[frame][1]])
        axes[0, 0].set_title(titles[frame], loc="left")
        for update in updates:
            update(frame)

    return Film(figure, len(places), show)


def along_surface(axis: Axes, X: NDArray, stress: surface.Stress) -> Callable[[int], None]:
    """Draw the first frame of a stress, and return a function that draws another."""
    values = next(iter(stress.values.values()))
    half = surface.half_width(X, [stress])
    low, high = surface.limits(X, values)
    axis.set(xlim=(-half, half), ylim=(low, high), xlabel="$X/a$", ylabel=stress.label)
    axis.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
    axis.axvspan(-1.0, 1.0, color="#F2F2F2", linewidth=0.0, zorder=-1)
    parts = surface.parts(X)
    lines = [axis.plot(X[part], values[0][part], color=COLOURS[0])[0] for part in parts]

    def update(frame: int) -> None:
        for line, part in zip(lines, parts):
            line.set_ydata(values[frame][part])

    return update


@styled
def content(film: Film, ending: str, dpi: int = DPI) -> bytes:
    """Bytes of a film's file.

    Args:
        film: the film.
        ending: one of ``FORMATS``; ``"mp4"`` where :func:`can` is true of it.
        dpi: dots per inch.
    """
    if ending == "mp4":
        return _mp4(film, dpi)
    film.figure.set_dpi(dpi)
    canvas, frames = FigureCanvasAgg(film.figure), []
    for n in range(film.frames):
        film.show(n)
        canvas.draw()
        frames.append(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB").quantize())
    data = BytesIO()
    frames[0].save(
        data, "GIF", save_all=True, append_images=frames[1:], duration=1000 // RATE, loop=0,
        comment=b"galinx",
    )  # fmt: skip
    return data.getvalue()


def can_write(ending: str) -> bool:
    """True where films can be made in this format on this machine."""
    return ending == "gif" or shutil.which("ffmpeg") is not None


def _mp4(film: Film, dpi: int) -> bytes:
    """Bytes of a film as MP4; ffmpeg goes back in its file, and so needs one of its own."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "film.mp4"
        writer = FFMpegWriter(fps=RATE, metadata={"comment": "galinx"})
        with writer.saving(film.figure, str(path), dpi):
            for n in range(film.frames):
                film.show(n)
                writer.grab_frame()
        return path.read_bytes()
