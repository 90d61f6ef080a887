"""Finished parts of a run, kept beside the archive until the archive is complete.

An HDF5 file whose writer was killed cannot be opened again. So every part is a file of its own, written
whole or not at all: an NPZ file, whose checksums NumPy verifies. Each names its run and its rows; a file
that is damaged, or has the name of another part, is ignored. The files are in a hidden folder,
``.NAME.work`` beside the archive ``NAME``.
"""

import fcntl
import io
import json
import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from galinx import files

from .errors import ArchiveInUse, LeftOver, refused

_SUFFIX = ".part"
#: Array of a part that describes the others, as JSON.
_HEADER = "header"


@dataclass(frozen=True)
class Part:
    """Results of consecutive states.

    Attributes:
        rows: rows of the archive that the states fill.
        data: datasets of the states by path.
        comparisons: figures of comparisons over these states, by the rule's name.
        record: numbers by name on the computation of the speed that ends with these rows; None where no
            speed ends.
        whole: True where all states are solved. Others are tried again by a run that goes on, which then
            knows why they fail.
    """

    rows: slice
    data: dict[str, NDArray]
    comparisons: dict[str, float]
    record: dict[str, Any] | None
    whole: bool = True


def joined(parts: Sequence[Part]) -> Part:
    """Single part from consecutive parts, with the worst comparisons and the last record."""
    if len(parts) == 1:
        return parts[0]
    data = {name: np.concatenate([part.data[name] for part in parts]) for name in parts[0].data}
    worst: dict[str, float] = {}
    for name, value in (figure for part in parts for figure in part.comparisons.items()):
        worst[name] = float(np.max([worst.get(name, value), value]))  # NaN stays
    rows, whole = slice(parts[0].rows.start, parts[-1].rows.stop), all(part.whole for part in parts)
    return Part(rows, data, worst, parts[-1].record, whole)


class Journal:
    """Finished parts of a run, as a context manager that locks them.

    After an error the parts stay; the lock is released even if the process is killed.

    Args:
        target: final name of the archive.
        key: text that identifies the run; parts of other keys are ignored.
        resume: continue with the parts of an interrupted run.
        overwrite: discard the parts of an interrupted run.

    Raises:
        ArchiveInUse: another run writes the same archive.
        LeftOver: an interrupted run left parts, but neither ``resume`` nor ``overwrite`` is set; or
            ``resume`` is set, but all parts have other keys.
        UnwritableArchive: the file system refused.
    """

    def __init__(self, target: Path, key: str, resume: bool = False, overwrite: bool = False) -> None:
        self.target, self._key = target, key
        #: Folder of the parts, and of other files of the unfinished run.
        self.folder = target.with_name(f".{target.name}.work")
        self._resume, self._overwrite = resume, overwrite
        self._lock: IO[bytes] | None = None
        #: Number of parts that are damaged or of another run, and so are computed again.
        self.damaged = 0
        self._rows: set[tuple[int, int]] = set()
        self._complete = False

    def __enter__(self) -> "Journal":
        try:
            self.folder.mkdir(exist_ok=True)
            self._lock = open(self.folder / "lock", "ab")
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
        """Clean up at the end of a process, regular or not: finished parts of an unfinished run stay."""
        if self._complete or not any(self._files()):
            shutil.rmtree(self.folder, ignore_errors=True)

    @property
    def states(self) -> int:
        """Number of states in the kept parts."""
        return sum(stop - start for start, stop in self._rows)

    def parts(self) -> Iterator[Part]:
        """Kept parts in the order of their rows, without damaged ones, which are computed again."""
        for key, part in filter(None, map(_load, self._files())):
            if key == self._key:
                yield part

    def keep(self, part: Part) -> None:
        """Write a part to a file of its own.

        Raises:
            UnwritableArchive: the file system refused.
        """
        path = self.folder / _name(part.rows)
        header = {
            "key": self._key,
            "rows": [part.rows.start, part.rows.stop],
            "names": list(part.data),
            "comparisons": part.comparisons,
            "record": part.record,
        }
        content = io.BytesIO()  # a disk that is full would leave NumPy's own file half open
        np.savez(content, **{_HEADER: np.array(json.dumps(header))}, **part.data)
        try:
            with files.NewFile(path) as new:
                new.temporary.write_bytes(content.getbuffer())
                # Not synchronised: after a power cut a torn file fails its checksums and is ignored.
                os.replace(new.temporary, path)
        except OSError as error:
            raise refused(self.target, error) from error
        self._rows.add((part.rows.start, part.rows.stop))

    def complete(self) -> None:
        """Declare the archive complete; the parts are removed at the end."""
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
        for path in self.folder.glob(".*.partial"):
            path.unlink(missing_ok=True)


def _name(rows: slice) -> str:
    return f"{rows.start:010d}-{rows.stop:010d}{_SUFFIX}"


def _load(path: Path) -> tuple[str, Part] | None:
    """Key of a part's run, and the part; None if it is damaged or has the name of another part."""
    with suppress(Exception):  # a part with any fault is ignored
        files.expect_file(path)
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        header = json.loads(str(arrays.pop(_HEADER)))
        rows = slice(*header["rows"])
        if path.name == _name(rows) and header["names"] == list(arrays):
            return header["key"], Part(rows, arrays, header["comparisons"], header["record"])
    return None
