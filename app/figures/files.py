"""Files of figures and films: names, formats and resolution; all are written, or none."""

import shutil
from base64 import b64encode
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from io import BytesIO
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from matplotlib.animation import FFMpegWriter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from galinx.postprocess.target import GIF, MP4, PDF, PNG, SVG, Folder, Kind, Target

from ..errors import BadInput
from ..process import side_by_side
from .choice import Drawing
from .render import Film
from .style import DPI, styled

#: Kinds of files of figures and of films, by the format's ending.
FORMATS: dict[str, Kind] = {"pdf": PDF, "png": PNG, "svg": SVG}
OF_FILMS: dict[str, Kind] = {"mp4": MP4, "gif": GIF}
#: Nouns and formats of figures, and of films.
_KINDS = ("figure", FORMATS), ("film", OF_FILMS)
#: Formats by default: text that stays text, and pixels for everything else.
USUAL = ("pdf", "png")
#: The picture that moves.
FILM = "film"
#: Frames a second, and dots per inch, which screens show; and dots per inch that a file may have.
RATE, FILM_DPI, _RESOLUTIONS = 8, 160, range(30, 2401)
#: Formats that other programs make of PDF, and of PNG.
_CONVERTED = {
    **dict.fromkeys(("eps", "ps", "emf"), "pdf"),
    **dict.fromkeys(("jpg", "jpeg", "tif", "tiff", "bmp"), "png"),
}


@styled
def content(figure: Figure, ending: str, dpi: int = DPI, transparent: bool = False) -> bytes:
    """Bytes of a figure's file.

    Args:
        figure: the figure.
        ending: one of ``FORMATS``.
        dpi: dots per inch of what is made of pixels.
        transparent: without ground.
    """
    data = BytesIO()  # matplotlib leaves half of a figure on a full disk
    # Without a date a figure that is drawn again is the same file.
    metadata = {"Software" if ending == "png" else "Creator": "galinx"}
    options: dict[str, Any] = {"metadata": metadata | ({"Date": None} if ending == "svg" else {})}
    if ending == "png":  # pixels that are nearly all white are packed as well at once as after a search
        options["pil_kwargs"] = {"compress_level": 1}
    figure.savefig(data, format=ending, dpi=dpi, transparent=transparent, **options)
    return data.getvalue()


@styled
def film_content(film: Film, ending: str, dpi: int = FILM_DPI) -> bytes:
    """Bytes of a film's file.

    Args:
        film: the film.
        ending: one of ``OF_FILMS``; ``"mp4"`` where :func:`can_write` is true of it.
        dpi: dots per inch.
    """
    if ending == "mp4":
        with TemporaryDirectory() as folder:  # ffmpeg goes back in its file, and so needs one of its own
            path = Path(folder) / "film.mp4"
            writer = FFMpegWriter(fps=RATE, metadata={"comment": "galinx"})
            with writer.saving(film.figure, str(path), dpi):
                for n in range(film.frames):
                    film.show(n)
                    writer.grab_frame()
            return path.read_bytes()
    film.figure.set_dpi(dpi)
    canvas, frames, data = FigureCanvasAgg(film.figure), [], BytesIO()
    for n in range(film.frames):
        film.show(n)
        canvas.draw()
        frames.append(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB").quantize())
    frames[0].save(
        data, "GIF", save_all=True, append_images=frames[1:], duration=1000 // RATE, loop=0,
        comment=b"galinx",
    )  # fmt: skip
    return data.getvalue()


def can_write(ending: str) -> bool:
    """True where films can be made in this format on this machine."""
    return ending == "gif" or shutil.which("ffmpeg") is not None


def embedded(data: bytes, kind: str = "png") -> str:
    """Data URI of the bytes of a picture's file, for a page."""
    return f"data:image/{kind};base64,{b64encode(data).decode()}"


class Written(NamedTuple):
    """A file that was written.

    Attributes:
        path: its name.
        noun: what it is.
        left_out: which states it does not show and how to draw them.
        data: its bytes.
    """

    path: Path
    noun: str
    left_out: str
    data: bytes


@dataclass(frozen=True)
class Files:
    """Destination of figures: folder or file, names, formats and resolution.

    Attributes:
        to: a folder, or a file whose ending is its format.
        name: prefix of the names of files in a folder; with "" they are the figures' own.
        formats: endings; () for the usual ones.
        dpi: dots per inch, 0 for the usual ones.
        overwrite: files of any kind are replaced.
        inputs: files that are read, and never replaced.
    """

    to: Path
    name: str = ""
    formats: tuple[str, ...] = ()
    dpi: int = 0
    overwrite: bool = False
    inputs: tuple[Path, ...] = ()

    @property
    def ending(self) -> str:
        """Ending of a single file, "" for a folder."""
        suffix = self.to.suffix.removeprefix(".").lower()
        return "" if self.to.is_dir() or not suffix.isalnum() or len(suffix) > 4 else suffix

    def check(self, names: Sequence[str]) -> None:
        """Refuse formats that cannot be written, before anything is drawn.

        Args:
            names: of the figures.

        Raises:
            BadInput: a format, or a file for several figures; the message says what to do.
        """
        if self.dpi and self.dpi not in _RESOLUTIONS:
            raise BadInput(f"--dpi: found {self.dpi}, expected {_RESOLUTIONS[0]} to {_RESOLUTIONS[-1]}")
        option, endings = (f"-o {self.to}", (self.ending,)) if self.ending else ("--format", self.formats)
        for name, ending in product(names, endings):
            noun, kinds = _KINDS[name == FILM]
            if ending not in kinds:
                other = _CONVERTED.get(ending)
                raise BadInput(
                    f"{option}: found {ending!r} for the {noun}{f' {name}' * (name != noun)}, expected "
                    f"{', '.join(kinds)}{' or a folder' * bool(self.ending)}"
                    + (f"; convert a {other} for {ending}" if other else "")
                )
            if ending in OF_FILMS and not can_write(ending):
                raise BadInput(f"{option}: {ending} needs ffmpeg, which is not installed; gif does not")
        if self.ending and self.formats not in ((), (self.ending,)):
            raise BadInput(f"--format {','.join(self.formats)} is not the ending of {self.to}; give one")
        if self.ending and len(names) != 1:
            raise BadInput(
                f"-o {self.to} is one file, found {len(names)} figures; choose one by --figure: "
                f"{', '.join(names)}; or name a folder"
            )

    def endings(self, name: str) -> tuple[str, ...]:
        """Formats of a figure."""
        usual = ("mp4" if can_write("mp4") else "gif",) if name == FILM else USUAL
        return (self.ending,) if self.ending else self.formats or usual

    def write(self, drawings: Iterable[Drawing]) -> list[Written]:
        """Write figures and films; none where one cannot be written.

        Raises:
            Occupied: something is there that may not be replaced.
            UnwritableArchive: the file system refused.
        """
        if not self.ending:
            Folder(self.to, self.overwrite, self.inputs)
        made: list[tuple[Target, str, str]] = []
        work: list[Callable[[], bytes]] = []
        for drawing in drawings:
            noun, kinds = _KINDS[drawing.film is not None]
            for ending in self.endings(drawing.name):
                name = f"{self.name}_{drawing.name}.{ending}".removeprefix("_")
                path = self.to if self.ending else self.to / name
                target = Target(path, kinds[ending], self.overwrite, self.inputs)
                made.append((target, noun, drawing.left_out))
                work.append(
                    partial(film_content, drawing.film, ending, self.dpi or FILM_DPI)
                    if drawing.film
                    else partial(content, drawing.figure, ending, self.dpi or DPI)
                )
        written = [*zip(made, side_by_side(work))]
        for (target, *_), data in written:
            target.write(data)
        return [Written(target.path, noun, left_out, data) for (target, noun, left_out), data in written]
