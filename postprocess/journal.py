"""Finished parts of a run, kept beside the archive until that is complete.

A killed HDF5 file cannot be opened again, so every part is a file of its own that appears at once or not
at all. The folder's name is hidden: ``.NAME.work`` beside the archive ``NAME``.
"""

import fcntl
import json
import os
import shutil
import zipfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.compare import Comparison
from galinx.postprocess.disk import refused
from galinx.postprocess.errors import ArchiveInUse, LeftOver


@dataclass(frozen=True)
class Part:
    """Some states' results.

    Attributes:
        rows: which rows of the archive.
        data: datasets by path.
        comparisons: what comparing them found.
        record: of the speed that ends with these rows, else None; numbers by name.
    """

    rows: slice
    data: dict[str, NDArray]
    comparisons: list[Comparison]
    record: dict[str, Any] | None


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
        self._lock: IO[str] | None = None
        self._complete = False

    def __enter__(self) -> "Journal":
        try:
            self.folder.mkdir(exist_ok=True)
            self._lock = (self.folder / "lock").open("w", encoding="utf-8")
            try:
                fcntl.lockf(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise ArchiveInUse(
                    f"another run is writing {self.target}; wait for it, or name another file with -o"
                ) from None
            self._check_left_over()
            (self.folder / "key").write_text(self._key, encoding="utf-8")
        except OSError as error:
            raise refused(self.target, error) from error
        return self

    def __exit__(self, *_: object) -> None:
        self.leave()
        if self._lock:
            self._lock.close()

    def leave(self) -> None:
        """Tidy up for a process that ends, in order or at once: what is finished stays."""
        if self._complete or not any(self._files()):
            shutil.rmtree(self.folder, ignore_errors=True)

    @property
    def states(self) -> int:
        """Number of states that are kept."""
        return sum(stop - start for start, stop in map(_bounds, self._files()))

    def parts(self) -> Iterator[Part]:
        """The kept parts in order of their rows; damaged ones are left out and will be done again."""
        for path in sorted(self._files()):
            with suppress(OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
                yield _load(path)

    def keep(self, part: Part) -> None:
        """Keep a part.

        Raises:
            UnwritableArchive: the file system refused.
        """
        told = {"comparisons": [asdict(found) for found in part.comparisons], "record": part.record}
        path = self.folder / f"{part.rows.start:010d}-{part.rows.stop:010d}.npz"
        temporary = self.folder / "part.npz"
        try:
            arrays: dict[str, Any] = part.data | {"told": np.array(json.dumps(told))}
            np.savez(temporary, **arrays)
            os.replace(temporary, path)
        except OSError as error:
            raise refused(self.target, error) from error

    def complete(self) -> None:
        """The archive holds everything; the parts are no longer needed."""
        self._complete = True

    def _files(self) -> Iterator[Path]:
        return self.folder.glob("*-*.npz")

    def _check_left_over(self) -> None:
        left, key = self.states, self.folder / "key"
        if left and self._resume:
            if key.read_text(encoding="utf-8") != self._key:
                raise LeftOver(
                    f"what an interrupted run left of {self.target} belongs to another scene or version "
                    "of the program; give that back, or start anew with --overwrite"
                )
        elif left and not self._overwrite:
            raise LeftOver(
                f"an interrupted run left {left} finished states of {self.target}; go on with --resume, "
                "or start anew with --overwrite"
            )
        else:
            for path in self._files():
                path.unlink()
        for path in self.folder.glob(".*.partial"):
            path.unlink()


def _bounds(path: Path) -> tuple[int, int]:
    start, stop = path.stem.split("-")
    return int(start), int(stop)


def _load(path: Path) -> Part:
    with np.load(path) as file:
        data = {name: file[name] for name in file.files}
    told = json.loads(str(data.pop("told")))
    comparisons = [Comparison(**found) for found in told["comparisons"]]
    return Part(slice(*_bounds(path)), data, comparisons, told["record"])
