"""Files of figures and films: names, formats and resolution; all are written, or none."""

import shutil
from base64 import b64encode
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from matplotlib.animation import FFMpegWriter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from galinx.postprocess.target import GIF, MP4, PDF, PNG, SVG, Folder, Kind, Target

from ..errors import BadInput
from .choice import Drawing
from .render import Film
from .style import DPI, styled

#: Key of a file's metadata that names its maker, and the kind of file, by the format's ending.
FORMATS: dict[str, tuple[str, Kind]] = {
    "pdf": ("Creator", PDF),
    "png": ("Software", PNG),
    "svg": ("Creator", SVG),
}

#: Formats by default: text that stays text, and pixels for everything else.
USUAL = ("pdf", "png")


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
    metadata = {FORMATS[ending][0]: "galinx"} | ({"Date": None} if ending == "svg" else {})
    # Pixels that are nearly all white are packed as well at once as after a search.
    packed = {"pil_kwargs": {"compress_level": 1}} if ending == "png" else {}
    figure.savefig(data, format=ending, dpi=dpi, metadata=metadata, transparent=transparent, **packed)
    return data.getvalue()


def save(figures: Iterable[tuple[str, Figure]], folder: Folder) -> dict[str, bytes]:
    """Write figures by name into a folder in the usual formats; none where one may not be written.

    Returns:
        The pixels of each by name, as PNG, for pages.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    made = {
        folder.target(f"{name}.{ending}", FORMATS[ending][1]): content(figure, ending)
        for name, figure in figures
        for ending in USUAL
    }
    write(made.items())
    return {t.path.stem: data for t, data in made.items() if t.path.suffix == ".png"}


def write(files: Iterable[tuple[Target, bytes]]) -> None:
    """Write files; none where one of them cannot be made.

    Args:
        files: each with its bytes, which are all made before the first is written.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    for target, data in list(files):
        target.write(data)


def in_a_page(figure: Figure, pixels: bool) -> str:
    """Data URI of a figure for a page.

    Args:
        figure: what to show.
        pixels: as PNG, for pictures with too many elements to draw each; else as SVG, without ground.
    """
    if pixels:
        return embedded(content(figure, "png", 160))
    return embedded(content(figure, "svg", transparent=True), "svg+xml")


def embedded(data: bytes, kind: str = "png") -> str:
    """Data URI of the bytes of a picture's file."""
    return f"data:image/{kind};base64,{b64encode(data).decode()}"


#: Dots per inch on a screen.
_DPI = 110


def for_notebook(figure: Figure) -> Figure:
    """Figure that notebooks can show, which otherwise know only figures of pyplot."""
    figure._repr_png_ = lambda: content(figure, "png", _DPI)  # type: ignore[attr-defined]
    return figure


#: Kind of file of a film by the format's ending.
OF_FILMS: dict[str, Kind] = {"mp4": MP4, "gif": GIF}

#: Frames a second, and dots per inch, which screens show.
RATE, FILM_DPI = 8, 160


@styled
def film_content(film: Film, ending: str, dpi: int = FILM_DPI) -> bytes:
    """Bytes of a film's file.

    Args:
        film: the film.
        ending: one of ``OF_FILMS``; ``"mp4"`` where :func:`can_write` is true of it.
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


#: Dots per inch that a file may have.
_RESOLUTIONS = range(30, 2401)


class Written(NamedTuple):
    """A file that was written.

    Attributes:
        path: its name.
        noun: what it is.
        left_out: which states it does not show and how to draw them.
    """

    path: Path
    noun: str
    left_out: str


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
        for name in names:
            valid, option = _formats(name), f"-o {self.to}" if self.ending else "--format"
            for ending in (self.ending,) if self.ending else self.formats:
                if ending not in valid:
                    raise BadInput(
                        f"{option}: found {ending!r} for the {_noun(name)} {name}, expected "
                        f"{', '.join(valid)}{' or a folder' * bool(self.ending)}{_converted(ending)}"
                    )
                if ending in OF_FILMS and not can_write(ending):
                    raise BadInput(
                        f"{option}: {ending} needs ffmpeg, which is not installed; gif does not"
                    )
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

    def target(self, name: str, ending: str, folder: Folder | None) -> Target:
        """A figure's file.

        Raises:
            Occupied: something is there that may not be replaced.
        """
        if folder is None:
            return Target(self.to, _formats(name)[ending], self.overwrite, self.inputs)
        return folder.target(f"{self.name}_{name}.{ending}".removeprefix("_"), _formats(name)[ending])

    def write(
        self, drawings: Iterator[Drawing], made: Callable[[], tuple[Film, str]] | None
    ) -> list[Written]:
        """Write all figures, and the film if ``made`` is given; none where one cannot be written."""
        folder = None if self.ending else Folder(self.to, self.overwrite, self.inputs)
        files, said = [], []
        pictures = [
            (d.name, d.left_out, partial(content, d.figure, dpi=self.dpi or DPI)) for d in drawings
        ]
        if made:
            moving, left_out = made()
            film = partial(film_content, moving, dpi=self.dpi or FILM_DPI)
            pictures.append((FILM, left_out, film))
        for name, left_out, as_bytes in pictures:
            for ending in self.endings(name):
                target = self.target(name, ending, folder)
                files.append((target, as_bytes(ending)))
                said.append(Written(target.path, _noun(name), left_out))
        write(files)
        return said


#: The picture that moves.
FILM = "film"


def _formats(name: str) -> dict[str, Kind]:
    if name == FILM:
        return OF_FILMS
    return {ending: kind for ending, (_, kind) in FORMATS.items()}


def _noun(name: str) -> str:
    return "film" if name == FILM else "figure"


def _converted(ending: str) -> str:
    vector = ending in ("eps", "ps", "emf")
    return f"; convert a {'pdf' if vector else 'png'} for {ending}" if vector or ending in _PIXELS else ""


#: Formats that other programs make of PNG.
_PIXELS = ("jpg", "jpeg", "tif", "tiff", "bmp")
