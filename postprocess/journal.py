"""Finished parts of a run, kept beside the archive until that is complete.

A killed HDF5 file cannot be opened again, so every part is a file of its own that appears at once or not
at all. It says itself which rows it has, of which run; one that is damaged, or bears another's name, is
not there. The folder's name is hidden: ``.NAME.work`` beside the archive ``NAME``.
"""

import fcntl
import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from galinx import files, sealed

from .compare import Comparison
from .errors import ArchiveInUse, LeftOver, refused

_SUFFIX = ".part"
#: Name of the file that identifies the archive that a run was about to publish.
_MARK = "published"


@dataclass(frozen=True)
class Part:
    """Results of some states.

    Attributes:
        rows: which rows of the archive.
        data: datasets by path.
        comparisons: figures of comparisons over these states.
        record: of the speed that ends with these rows, else None; numbers by name.
    """

    rows: slice
    data: dict[str, NDArray]
    comparisons: list[Comparison]
    record: dict[str, Any] | None


def joined(parts: Sequence[Part]) -> Part:
    """Single part from parts that follow one another, with the worst comparisons and the last record."""
    if len(parts) == 1:
        return parts[0]
    data = {name: np.concatenate([part.data[name] for part in parts]) for name in parts[0].data}
    worst: dict[tuple[str, str], float] = {}
    for comparison in (figure for part in parts for figure in part.comparisons):
        which = comparison.name, comparison.text
        worst[which] = float(np.max([worst.get(which, comparison.value), comparison.value]))  # NaN stays
    comparisons = [Comparison(*which, value) for which, value in worst.items()]
    return Part(slice(parts[0].rows.start, parts[-1].rows.stop), data, comparisons, parts[-1].record)


class Journal:
    """The parts of a run that are finished; use it as a context manager.

    An error leaves the parts where they are, and their lock is given up even by a killed process.

    Args:
        target: the archive's final name.
        key: what the parts depend on; parts of another key are not taken for these.
        resume: go on with what an interrupted run left.
        overwrite: give up what an interrupted run left.

    Raises:
        ArchiveInUse: another run writes the same archive.
        LeftOver: parts of an interrupted run are there, and neither ``resume`` nor ``overwrite`` says
            what is to become of them; or those to go on with belong to another key.
        UnwritableArchive: the file system refused.
    """

    def __init__(self, target: Path, key: str, resume: bool = False, overwrite: bool = False) -> None:
        self.target, self._key = target, key
        #: Where the parts are, and what else belongs to the unfinished run.
        self.folder = target.with_name(f".{target.name}.work")
        self._resume, self._overwrite = resume, overwrite
        self._lock: IO[bytes] | None = None
        #: How many of the parts to go on with are damaged, or another run's: as good as not kept.
        self.damaged = 0
        self._rows: set[tuple[int, int]] = set()
        self._complete = False

    def __enter__(self) -> "Journal":
        try:
            _sweep(self.target.parent)
            self.folder.mkdir(exist_ok=True)
            self._lock = open(files.open_file(self.folder / "lock", os.O_RDWR | os.O_CREAT), "r+b")
            try:
                fcntl.lockf(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise ArchiveInUse(
                    f"another run is writing {self.target}; wait for it, or name another file with -o"
                ) from None
            self._check_left_over()
        except OSError as error:
            self.__exit__()
            raise refused(self.target, error) from error
        return self

    def __exit__(self, *_: object) -> None:
        self.leave()
        if self._lock:
            self._lock.close()

    def leave(self) -> None:
        """Tidy up for a process that ends, in order or at once: what is finished stays."""
        if self._complete or not any(self._files()):
            for path in self._files():  # before the mark: it says that they are not needed
                path.unlink(missing_ok=True)
            shutil.rmtree(self.folder, ignore_errors=True)

    @property
    def states(self) -> int:
        """Number of states that are kept."""
        return sum(stop - start for start, stop in self._rows)

    def parts(self) -> Iterator[Part]:
        """The kept parts in order of their rows; damaged ones are left out and will be done again."""
        for key, part in filter(None, map(_load, self._files())):
            if key == self._key:
                yield part

    def keep(self, part: Part) -> None:
        """Keep a part.

        Raises:
            UnwritableArchive: the file system refused.
        """
        path = self.folder / _name(part.rows)
        try:
            with files.NewFile(path) as new:
                with new.temporary.open("wb") as file:
                    file.writelines(_packed(part, self._key))
                # Not synchronised: what a power cut tears does not fit its digest, and is computed again.
                os.replace(new.temporary, path)
        except OSError as error:
            raise refused(self.target, error) from error
        self._rows.add((part.rows.start, part.rows.stop))

    def about_to_publish(self, archive: Path) -> None:
        """Let whoever finds this folder know the archive that is to make it useless, should this end.

        Args:
            archive: the finished file, before it gets its name.

        Raises:
            OSError: the file system refused.
        """
        (self.folder / _MARK).write_text(_identity(archive), encoding="utf-8")

    def complete(self) -> None:
        """The archive holds everything; the parts are no longer needed."""
        self._complete = True

    def _files(self) -> list[Path]:
        return sorted(self.folder.glob(f"*{_SUFFIX}"))

    def _check_left_over(self) -> None:
        there = self._files()
        parts = [(key, part.rows) for key, part in filter(None, map(_load, there))]
        own = {(rows.start, rows.stop) for key, rows in parts if key == self._key}
        self.damaged = len(there) - len(own) if self._resume else 0
        if parts and self._resume:
            if not own:
                raise LeftOver(
                    f"what an interrupted run left of {self.target} belongs to another scene or version "
                    "of the program; give that back, or start anew with --overwrite"
                )
            self._rows = own
        elif parts and not self._overwrite:
            states = sum(rows.stop - rows.start for _, rows in parts)
            raise LeftOver(
                f"an interrupted run left {states} finished states of {self.target}; "
                "go on with --resume, or start anew with --overwrite"
            )
        else:
            for path in there:
                path.unlink()
        for path in (*self.folder.glob(".*.partial"), self.folder / _MARK):
            path.unlink(missing_ok=True)


def _sweep(folder: Path) -> None:
    """Remove what runs left beside archives that they had published when they were killed."""
    for mark in folder.glob(f".*.work/{_MARK}"):
        with suppress(OSError):
            archive = folder / mark.parent.name.removeprefix(".").removesuffix(".work")
            if mark.read_text(encoding="utf-8") == _identity(archive):
                shutil.rmtree(mark.parent, ignore_errors=True)


def _identity(archive: Path) -> str:
    """Device, number, size and time of a file, which tell it from all others whatever its name is."""
    about = archive.stat()
    return f"{about.st_dev} {about.st_ino} {about.st_size} {about.st_mtime_ns}"


def _name(rows: slice) -> str:
    return f"{rows.start:010d}-{rows.stop:010d}{_SUFFIX}"


def _packed(part: Part, key: str) -> Iterator[Any]:
    header = {
        "key": key,
        "rows": [part.rows.start, part.rows.stop],
        "comparisons": [asdict(figure) for figure in part.comparisons],
        "record": part.record,
    }
    return sealed.packed(header, part.data)


def _load(path: Path) -> tuple[str, Part] | None:
    """Key of a part's run, and the part; None where it is damaged or bears another's name."""
    header, data = sealed.read(path) or ({}, {})
    with suppress(Exception):  # whatever is wrong with a part, it is not there
        rows = slice(*header["rows"])
        if path.name == _name(rows):
            comparisons = [Comparison(**figure) for figure in header["comparisons"]]
            return header["key"], Part(rows, data, comparisons, header["record"])
    return None
