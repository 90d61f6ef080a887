"""Films: pictures of the states of strokes, one after the other."""

import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from matplotlib.animation import FFMpegWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from galinx.postprocess.figures import loops, maps, surface
from galinx.postprocess.figures.canvas import Room, Size, panels
from galinx.postprocess.figures.style import COLOURS, GREY, PAGE, styled
from galinx.postprocess.target import GIF, MP4, Kind

#: Kind of file by the format's ending.
FORMATS: dict[str, Kind] = {"mp4": MP4, "gif": GIF}

#: Frames a second, and dots per inch, which screens show.
RATE, DPI = 8, 160


@dataclass(frozen=True)
class Film:
    """A figure that changes.

    Attributes:
        figure: it.
        frames: how often.
        show: draws one of them.
    """

    figure: Figure
    frames: int
    show: Callable[[int], None]


@styled
def strokes_film(
    loop: loops.Loop,
    places: Sequence[tuple[float, float]],
    titles: Sequence[str],
    surface_X: NDArray,
    stresses: Sequence[surface.Stress],
    grid: tuple[NDArray, NDArray] | None = None,
    mapped: Sequence[maps.Map] = (),
    size: Size | None = None,
) -> Film:
    """A friction loop on which a dot moves, and beside it the stresses there.

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
    loops.draw(axes[0, 0], loops.Panel("", [loop]))
    axes[0, 0].set(xlabel=loops.X_LABEL, ylabel=loops.F_LABEL)
    dot = axes[0, 0].plot(*places[0], "o", color="black", markersize=5, zorder=9)[0]
    updates: list[Callable[[int], None]] = []
    for axis, stress in zip(axes[0, 1:], stresses):
        updates.append(along_surface(axis, surface_X, stress))
    for axis, shown in zip(axes[0, 1 + len(stresses) :], mapped):
        assert grid is not None
        updates.append(maps.moving(axis, *grid, shown))

    def show(frame: int) -> None:
        dot.set_data([places[frame][0]], [places[frame][1]])
        axes[0, 0].set_title(titles[frame], loc="left")
        for update in updates:
            update(frame)

    return Film(figure, len(places), show)


def along_surface(axis: Axes, X: NDArray, stress: surface.Stress) -> Callable[[int], None]:
    """Draw the first frame of a stress, and return what draws another."""
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
    """A film as the bytes of a file.

    Args:
        film: which.
        ending: one of ``FORMATS``; ``"mp4"`` where :func:`can` says so.
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


def can(ending: str) -> bool:
    """Can films be made in this format here?"""
    return ending == "gif" or shutil.which("ffmpeg") is not None


def _mp4(film: Film, dpi: int) -> bytes:
    """ffmpeg goes back in its file, and so wants one of its own."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "film.mp4"
        writer = FFMpegWriter(fps=RATE, metadata={"comment": "galinx"})
        with writer.saving(film.figure, str(path), dpi):
            for n in range(film.frames):
                film.show(n)
                writer.grab_frame()
        return path.read_bytes()
