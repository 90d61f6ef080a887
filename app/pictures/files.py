"""Pictures as files: which formats, where to, and what is said of them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

from galinx.app.errors import BadInput
from galinx.app.pictures.drawing import Drawing
from galinx.postprocess.figures import canvas, film
from galinx.postprocess.figures.film import Film
from galinx.postprocess.target import Folder, Kind, Target

#: Dots per inch that a file may have.
_DPI = range(30, 2401)


class Written(NamedTuple):
    """A file that was written.

    Attributes:
        path: its name.
        noun: what it is.
        left_out: which states it does not show and how to get them.
    """

    path: Path
    noun: str
    left_out: str


@dataclass(frozen=True)
class Files:
    """Where pictures go.

    Attributes:
        to: a folder, or a file whose ending is its format.
        name: what the names of files in a folder begin with; with nothing they are the figures' own.
        formats: endings, chosen by themselves if none are given.
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
    def one(self) -> str:
        """The ending of a single file, nothing for a folder."""
        ending = self.to.suffix.removeprefix(".").lower()
        return "" if self.to.is_dir() or not ending.isalnum() or len(ending) > 4 else ending

    def check(self, names: Sequence[str]) -> None:
        """Refuse what cannot be written before anything is drawn.

        Args:
            names: of the figures.

        Raises:
            BadInput: a format, or a file for several figures; the message says what to do.
        """
        if self.dpi and self.dpi not in _DPI:
            raise BadInput(f"--dpi: found {self.dpi}, expected {_DPI[0]} to {_DPI[-1]}")
        for name in names:
            known, option = _formats(name), f"-o {self.to}" if self.one else "--format"
            for ending in (self.one,) if self.one else self.formats:
                if ending not in known:
                    raise BadInput(
                        f"{option}: found {ending!r} for the {_noun(name)} {name}, expected "
                        f"{', '.join(known)}{' or a folder' * bool(self.one)}{_converted(ending)}"
                    )
                if ending in film.FORMATS and not film.can(ending):
                    raise BadInput(
                        f"{option}: {ending} needs ffmpeg, which is not installed; gif does not"
                    )
        if self.one and self.formats not in ((), (self.one,)):
            raise BadInput(f"--format {','.join(self.formats)} is not the ending of {self.to}; give one")
        if self.one and len(names) != 1:
            raise BadInput(
                f"-o {self.to} is one file, found {len(names)} figures; choose one by --figure: "
                f"{', '.join(names)}; or name a folder"
            )

    def endings(self, name: str) -> tuple[str, ...]:
        """Formats of a figure."""
        usual = ("mp4" if film.can("mp4") else "gif",) if name == FILM else canvas.USUAL
        return (self.one,) if self.one else self.formats or usual

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
        """Write all figures and the film, if one is wanted; none where one of them cannot be written."""
        folder = None if self.one else Folder(self.to, self.overwrite, self.inputs)
        files, said = [], []
        for name, left_out, content in self._contents(drawings, made):
            for ending in self.endings(name):
                target = self.target(name, ending, folder)
                files.append((target, content(ending)))
                said.append(Written(target.path, _noun(name), left_out))
        canvas.write(files)
        return said

    def _contents(
        self, drawings: Iterator[Drawing], made: Callable[[], tuple[Film, str]] | None
    ) -> Iterator[tuple[str, str, Callable[[str], bytes]]]:
        """Of each picture its name, what it leaves out, and what makes a file of an ending."""
        for drawing in drawings:
            yield (
                drawing.name,
                drawing.left_out,
                partial(canvas.content, drawing.figure, dpi=self.dpi or canvas.DPI),
            )
        if made:
            moving, left_out = made()
            yield FILM, left_out, partial(film.content, moving, dpi=self.dpi or film.DPI)


#: The picture that moves.
FILM = "film"


def _formats(name: str) -> dict[str, Kind]:
    if name == FILM:
        return film.FORMATS
    return {ending: kind for ending, (_, kind) in canvas.FORMATS.items()}


def _noun(name: str) -> str:
    return "film" if name == FILM else "figure"


def _converted(ending: str) -> str:
    vector = ending in ("eps", "ps", "emf")
    return f"; convert a {'pdf' if vector else 'png'} for {ending}" if vector or ending in _PIXELS else ""


#: Formats that other programs make of PNG.
_PIXELS = ("jpg", "jpeg", "tif", "tiff", "bmp")
