"""Files that a command writes: existing ones are not lost, and inputs are not overwritten."""

import mmap
import os
import re
import stat
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from galinx import files

from .errors import Occupied, UnwritableArchive, refused


@dataclass(frozen=True)
class Kind:
    """Kind of file that a command makes, and so may replace by a new one.

    Attributes:
        noun: name of such a file in messages.
        looks: regular expression that the bytes of such a file match from their beginning.
        option: option of the command line by which the file is named.
        replaceable: True where --overwrite may replace a file of another kind.
        endings: endings that names may have, by which other programs recognise the kind; none for any.
    """

    noun: str
    looks: bytes
    option: str = "-o"
    replaceable: bool = True
    endings: tuple[str, ...] = ()

    def of(self, path: Path) -> bool:
        """True where the file of a path is of this kind."""
        files.expect_file(path)
        with open(path, "rb") as file:
            if not os.fstat(file.fileno()).st_size:  # which cannot be mapped
                return bool(re.match(self.looks, b"", re.DOTALL))
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
                return bool(re.match(self.looks, data, re.DOTALL))


#: First bytes of HDF5 files, and names in the root of one whose only group is VTK's.
_HDF5, _VTK = rb"\x89HDF\r\n\x1a\n", rb".{,2000}HEAP.{,60}\0VTKHDF\0"
#: Archives begin with their digest, or with HDF5's own bytes.
ARCHIVE = Kind("an archive of galinx", rb"galinx archive\n|" + _HDF5 + rb"(?!" + _VTK + rb").*galinx")
FIELDS = Kind("a file of fields of galinx", _HDF5 + _VTK, endings=(".hdf", ".vtkhdf"))
PAGE = Kind(
    "a report of galinx",
    rb'<!doctype html>.{,500}<meta name="generator" content="galinx',
    endings=(".html", ".htm"),
)
PDF = Kind("a figure of galinx", rb"%PDF-.*galinx")
PNG = Kind("a figure of galinx", rb"\x89PNG\r\n\x1a\n.{,200}galinx")
#: How heads of tables begin: of states and their points, of loops, starts and sliders.
_OF_TABLES = (
    rb"state,(motion|interface,speed|interface,c|c \[1\]|speed \[.{1,3}/s\]),|loop,X_over_L|start,t \["
    rb"|law,time \["
)
SVG = Kind("a figure of galinx", rb"<\?xml .{,1500}<dc:title>galinx</dc:title>")
GIF = Kind("a film of galinx", rb"GIF8.*galinx")
MP4 = Kind("a film of galinx", rb".{4}ftyp.*galinx")
TABLE = Kind("a table of galinx", _OF_TABLES, endings=(".csv", ".txt"))
SECTION = Kind("a section fitted by galinx", rb"# Fitted by galinx", endings=(".toml",))
TABLES = Kind("tables of galinx", rb"\s*(Table 1\. Dahl|Statements of the study)")
LOG = Kind("a log of galinx", rb"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d,\d{3} |\Z", "--log", False)

#: Endings of files that are no archives.
NO_ARCHIVES = {".pdf", ".png", ".svg", ".html", ".csv", ".txt", ".vtkhdf", ".vtu", ".toml"}


def check_archive_name(path: Path) -> None:
    """Check that a name is not that of another kind of file.

    Raises:
        Occupied: it is.
    """
    if path.suffix.lower() in NO_ARCHIVES:
        raise Occupied(
            f"{path}: found a name that ends with {path.suffix}, expected an archive's, as "
            f"{path.stem.removesuffix('.h5')}.h5; other commands make tables, figures and pages of it"
        )


class Target:
    """File to be written. Permission to write it is checked when it is named, before any work is done.

    Args:
        path: name of the file; a link stands for the file to which it points.
        kind: kind of file that may be replaced without --overwrite; None for no file at all.
        overwrite: replace any file.
        inputs: files that are read, and never replaced.

    Attributes:
        path: the name as it was given.
        place: the name at the end of all links.

    Raises:
        Occupied: a file of this name may not be replaced, the folder does not exist, or the name has the
            ending of another kind of file.
    """

    def __init__(
        self,
        path: Path,
        kind: Kind | None = None,
        overwrite: bool = False,
        inputs: Iterable[Path] = (),
    ) -> None:
        self.path, self._kind, self._overwrite = path, kind, overwrite
        option = kind.option if kind else "-o"
        self._another = f"name another file with {option}"
        self.place = self._followed()
        self._earlier = self._there()
        if not self._earlier and not self.place.parent.is_dir():
            raise Occupied(f"the folder {self.place.parent} does not exist; make it, or {self._another}")
        if any(_same(self.place, file) for file in inputs):
            raise Occupied(f"{path} is also a file that this command reads or writes; {self._another}")
        if self._earlier:
            self._check_replaceable()
        if kind and kind.endings and path.suffix and path.suffix.lower() not in kind.endings:
            raise Occupied(
                f"{path} ends with {path.suffix}, expected {' or '.join(kind.endings)} for {kind.noun}; "
                f"{self._another}"
            )

    def write(self, data: bytes | Iterable[bytes]) -> None:
        """Write the file, whole or not at all.

        Args:
            data: all bytes, or consecutive pieces, each of which is made when the last is written.

        Raises:
            UnwritableArchive: the file system refused, or another file of this name has appeared.
        """
        needed = len(data) if isinstance(data, bytes) else 0
        try:
            with files.NewFile(self.place) as new:
                with new.temporary.open("wb") as file:
                    file.writelines([data] if isinstance(data, bytes) else data)
                self.publish(new, needed)
        except OSError as error:
            raise refused(self.path, error, needed) from error

    def publish(self, new: files.NewFile, needed: int = 0) -> None:
        """Give a finished file its name.

        Args:
            new: the finished file, to be named :attr:`place`.
            needed: size of the file in bytes, for messages; 0 where it is unknown.

        Raises:
            UnwritableArchive: the file system refused, or another file of this name has appeared.
        """
        try:
            now = self._there()
            if now != self._earlier and not self._overwrite:
                raise FileExistsError
            new.publish(replace=self._overwrite or now is not None)
        except (FileExistsError, Occupied):
            raise UnwritableArchive(
                f"cannot write {self.path}: something appeared there meanwhile, and was left as it is; "
                "move it away, or name another file"
            ) from None
        except OSError as error:
            raise refused(self.path, error, needed) from error

    def _followed(self) -> Path:
        """Path at the end of all links."""
        if not os.path.islink(self.path):  # a path that cannot be examined is refused later
            return self.path
        try:
            return self.path.resolve(strict=True)
        except (OSError, RuntimeError):  # the second for links that point to one another
            raise Occupied(
                f"{self.path} is a link to {os.readlink(self.path)}, which cannot be reached; remove the "
                f"link, or {self._another}"
            ) from None

    def _there(self) -> tuple[int, ...] | None:
        """Device, number, size and time of the file at :attr:`place`; None if there is none."""
        try:
            about = os.lstat(self.place)
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            raise refused(self.path, error) from error
        if not stat.S_ISREG(about.st_mode):
            raise Occupied(
                f"{self.path} is {files.noun(about.st_mode)}, expected a file; {self._another}"
            )
        return about.st_dev, about.st_ino, about.st_size, about.st_mtime_ns

    def _check_replaceable(self) -> None:
        if not os.access(self.place, os.W_OK):
            raise Occupied(f"{self.path} is protected against writing; {self._another}")
        if self._overwrite:
            return
        or_else = ", or add --overwrite" if not self._kind or self._kind.replaceable else ""
        if not self._kind:
            raise Occupied(f"{self.path} exists; {self._another}{or_else}")
        try:
            if self._kind.of(self.place):
                return
        except OSError as error:
            raise refused(self.path, error) from error
        raise Occupied(f"{self.path} exists and is not {self._kind.noun}; {self._another}{or_else}")


class Folder:
    """Folder for several files, which is made if it does not exist.

    Args:
        path: name of the folder.
        overwrite: replace files of any kind.
        inputs: files that are read, and never replaced.

    Attributes:
        path, overwrite, inputs: as given.

    Raises:
        Occupied: a file has this name.
        UnwritableArchive: the file system refused.
    """

    def __init__(self, path: Path, overwrite: bool = False, inputs: Iterable[Path] = ()) -> None:
        self.path, self.overwrite, self.inputs = path, overwrite, tuple(inputs)
        try:
            path.mkdir(parents=True, exist_ok=True)
        except (FileExistsError, NotADirectoryError):
            raise Occupied(f"{path} is not a folder, expected one; name another with -o") from None
        except OSError as error:
            raise refused(path, error) from error

    def target(self, name: str, kind: Kind) -> Target:
        """Target of a file of some kind in the folder.

        Raises:
            Occupied: a file of this name may not be replaced.
        """
        return Target(self.path / name, kind, self.overwrite, self.inputs)


def _same(path: Path, other: Path) -> bool:
    """True where two names stand for the same file, existing or not."""
    try:
        return path.samefile(other)
    except OSError:
        return os.path.realpath(path) == os.path.realpath(other)
