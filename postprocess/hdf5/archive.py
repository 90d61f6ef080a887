"""Result archives in HDF5: their writer, the digest that seals them, and the one way of reading them.

An archive appears under its final name only when it is complete: it is written beside it, closed, sealed,
synchronised with the disk and renamed. HDF5 crashes where a disk refuses what it holds, so it writes to a
file that takes every write and remembers the refusal.

The digest stands in the room that HDF5 leaves to others at a file's start. It is of every byte that
follows, so names, shapes, types, units and attributes are covered like numbers. HDF5 itself crashes over
some damaged files: the digest is verified before HDF5 opens one.

All reading goes through :func:`opened` and :func:`read`: an archive that passes is as it was written, in
a layout that this program knows.
"""

import hashlib
import io
import json
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NoReturn

import h5py
import numpy as np
from numpy.typing import NDArray

from galinx.files import NewFile

from .. import schema
from ..errors import MissingDataset, UnreadableArchive, refused
from ..quantities import declared, large, of_states, table
from ..quantities.quantity import STATE
from ..quantities.runs import SCENE
from ..target import Target


class PatientFile(io.RawIOBase):
    """A new file that takes every write: where the disk refuses one, it goes on in memory.

    Attributes:
        refusal: why the disk refused, None as long as it did not.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._file: io.FileIO | io.BytesIO = io.FileIO(path, "w+")
        self.refusal: OSError | None = None

    def readable(self) -> bool:
        return True

    writable = seekable = readable

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        return self._file.tell()

    def write(self, data: Any) -> int:
        start, view, done = self._file.tell(), memoryview(data).cast("B"), 0
        try:
            while done < len(view):
                done += self._file.write(view[done:])  # a disk that becomes full takes a part
        except OSError as error:
            self._go_on_in_memory(error)
            self._file.seek(start)
            self._file.write(view)
        return len(view)

    def readinto(self, buffer: Any) -> int:
        start, view = self._file.tell(), memoryview(buffer).cast("B")
        count = self._file.readinto(view) or 0
        view[count:] = bytes(len(view) - count)
        self._file.seek(start + len(view))
        return len(view)

    def truncate(self, size: int | None = None) -> int:
        try:
            return self._file.truncate(size)
        except OSError as error:
            self._go_on_in_memory(error)
            return size or 0

    def _go_on_in_memory(self, refusal: OSError) -> None:
        self.refusal = refusal
        self._file.seek(0)
        with self._file as file:
            self._file = io.BytesIO(file.read())

    def close(self) -> None:
        self._file.close()
        super().close()


#: Bytes of the room for the digest, HDF5's user block; the smallest that there can be.
ROOM = 512
#: Text of the seal; its digest by hand: ``tail -c +513 ARCHIVE | sha256sum``.
_TITLE, _WORDS = "galinx archive\n", "sha256 of all bytes after the first 512:\n{}\n"
#: Beginning of a scene: a section or a key, after comments and a title, and no control character.
_SCENE = re.compile(rb"\A[^\0-\x08\x0e-\x1f]*^\s*(?:\[[\w.]+\]|\w+\s*=)", re.MULTILINE)


def put(path: Path) -> None:
    """Seal a closed file that was made with room for a seal.

    Raises:
        OSError: the file system refused.
    """
    seal = _made(path)
    with path.open("r+b") as file:
        file.write(seal)


def verify(path: Path) -> None:
    """Verify the seal of a file.

    Raises:
        OSError: the file cannot be read.
        UnreadableArchive: it has no seal, or one that does not fit what follows.
    """
    with path.open("rb") as file:
        start = file.read(ROOM)
    if b"\0" not in start and _SCENE.search(start):
        raise UnreadableArchive(
            f"{path} is a scene or another text, expected an archive of results; the command run makes "
            "one of a scene"
        )
    if not start.startswith(_TITLE.encode()):
        raise UnreadableArchive(
            f"{path} does not begin as an archive of galinx does: it is something else, or damaged; "
            "expected a file that galinx wrote"
        )
    if start != _made(path):
        raise UnreadableArchive(
            f"{path} is damaged: its bytes are not those that its digest is of; one was changed since it "
            "was written, or it was cut short; take another copy, or run again"
        )


def _made(path: Path) -> bytes:
    """Seal that fits a file, ``ROOM`` bytes."""
    with path.open("rb", buffering=0) as file:
        file.seek(ROOM)
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return (_TITLE + _WORDS.format(digest)).encode().ljust(ROOM, b"\0")


class Writer:
    """An archive in the making; use it as a context manager and end with :meth:`finish`.

    What is written can be larger than memory: datasets are reserved, then filled row by row. Without
    ``finish``, or after an error, nothing is left and an earlier file of that name stays.

    Args:
        target: the file.
        folder: where it is written, on the same file system; beside its final name if not given.

    Raises:
        UnwritableArchive: the file system refused.
        KeyError: the path of a dataset is not in the table of quantities.
    """

    def __init__(self, target: Target, folder: Path | None = None) -> None:
        self._target, self._new = target, NewFile(target.place, folder)
        self._bytes = 0
        self._names: list[str] = []
        #: Reserved datasets: opened anew for every write, they would read and write a chunk each time.
        self._open: dict[str, h5py.Dataset] = {}

    def __enter__(self) -> "Writer":
        with self._refusals():
            self._disk = PatientFile(self._new.__enter__().temporary)
            self._file = h5py.File(self._disk, "w", libver=("earliest", "v110"), userblock_size=ROOM)
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(OSError):
            self._close()
        self._new.__exit__()

    def put(self, name: str, value: Any, about: tuple[str, str] | None = None) -> None:
        """Write a whole dataset: numbers, texts or one text.

        Args:
            name: path of the dataset.
            value: what it holds.
            about: unit and long name; from the table of quantities if not given.
        """
        with self._refusals():
            text = isinstance(value, str) or not len(value) or np.asarray(value).dtype.kind in "UO"
            if text:
                data = value if isinstance(value, str) else list(value)
                dataset = self._file.create_dataset(name, data=data, dtype=h5py.string_dtype())
                self._describe(name, dataset, about)
            else:
                value = np.asarray(value)
                self.reserve(name, value.shape, value.dtype, about)
                self.write(name, slice(0, len(value)), value)

    def reserve(
        self,
        name: str,
        shape: tuple[int, ...],
        dtype: Any = float,
        about: tuple[str, str] | None = None,
    ) -> None:
        """Make room for a dataset that is written by rows."""
        with self._refusals():
            rows = max(1, min(shape[0], 2**17 // max(1, int(np.prod(shape[1:])))))
            # The checksum shows a flipped bit.
            dataset = self._file.create_dataset(
                name, shape, dtype, chunks=(rows, *shape[1:]), fletcher32=True
            )
            self._describe(name, dataset, about)
            self._open[name] = dataset
            self._bytes += dataset.size * dataset.dtype.itemsize

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        """Write rows of a reserved dataset."""
        with self._refusals():
            self._open[name][rows] = values

    def finish(self, attributes: dict[str, Any]) -> None:
        """Complete the archive, whose root gets these attributes, and give it its name."""
        with self._refusals():
            created = datetime.now(UTC).isoformat(timespec="seconds")
            common = {"program": "galinx", "created": created}
            layout = {
                "schema_version": schema.VERSION,
                "datasets": json.dumps(self._names),
                "complete": True,
            }
            self._file.attrs.update(common | attributes | layout)
            self._close()
            put(self._new.temporary)
            self._target.publish(self._new, self._bytes)

    def _describe(self, name: str, dataset: h5py.Dataset, about: tuple[str, str] | None) -> None:
        self._names.append(name)
        if about is None:
            row = declared(name)
            about = row.unit, row.about
        dataset.attrs["units"], dataset.attrs["long_name"] = about

    @contextmanager
    def _refusals(self) -> Iterator[None]:
        try:
            yield
        except (OSError, RuntimeError) as error:
            raise refused(self._target.path, error, self._bytes) from error
        if self._disk.refusal:
            raise refused(self._target.path, self._disk.refusal, self._bytes) from self._disk.refusal

    def _close(self) -> None:
        self._file.close()
        self._disk.close()
        if self._disk.refusal:
            raise self._disk.refusal


#: Faults that a message lists at most.
_LISTED = 8


class _Datasets(dict[str, Any]):
    """Datasets of an archive by path.

    Args:
        path: the archive.
        datasets: by path.

    Raises:
        MissingDataset: a dataset is asked for that the archive does not have.
    """

    def __init__(self, path: Path, datasets: Iterable[tuple[str, Any]]) -> None:
        super().__init__(datasets)
        self._archive = path

    def __missing__(self, name: str) -> NoReturn:
        raise MissingDataset(
            f"{self._archive}: {name!r} is missing, expected one of the datasets that the archive has; "
            "if it had it, take another copy or rerun"
        )


class Archive:
    """An open archive.

    Attributes:
        attributes: of the root.
        data: datasets by path, but for large ones.
        names: of all datasets.
    """

    def __init__(self, path: Path, file: h5py.File) -> None:
        self._path, self._file = path, file
        layouts: dict[str, schema.Layout] = {}

        def note(name: str, item: Any) -> None:
            if isinstance(item, h5py.Dataset):
                layouts[name] = schema.Layout(item.dtype.kind, item.shape, item.attrs.get("units"))

        with _reading(path):
            self.attributes = dict(file.attrs)
            _check_kind(path, self.attributes)
            file.visititems(note)
        self.names = [*layouts]
        scene = self._read(SCENE.path) if SCENE.path in layouts else ""
        if faults := schema.faults(self.attributes, layouts, scene):
            more = f"\n  and {len(faults) - _LISTED} more" if len(faults) > _LISTED else ""
            lines = "".join(f"\n  {fault}" for fault in faults[:_LISTED])
            raise UnreadableArchive(
                f"{path} is not as this galinx writes archives; take another copy or rerun{lines}{more}"
            )
        self.data = _Datasets(path, ((name, self._read(name)) for name in self.names if not large(name)))

    def all(self) -> dict[str, Any]:
        """Every dataset by path, large ones included."""
        each = ((name, self._read(name) if large(name) else self.data[name]) for name in self.names)
        return _Datasets(self._path, each)

    def rows(self, rows: slice | NDArray[np.int64], names: Iterable[str] | None = None) -> dict[str, Any]:
        """Datasets of some states by path, and positions that all states share.

        Args:
            rows: numbers of the states, growing.
            names: of the datasets; all of states if not given.
        """
        data, quantities = _Datasets(self._path, ()), table()
        for name in filter(of_states, self.names) if names is None else names:
            if large(name):
                data[name] = self._read(name, rows)
            else:
                data[name] = self.data[name][rows if STATE in quantities[name].over else slice(None)]
        return data

    def _read(self, name: str, rows: slice | NDArray[np.int64] = slice(None)) -> Any:
        with _reading(self._path):
            dataset = self._file[name]
            selection = rows if dataset.shape else ()
            is_text = h5py.check_string_dtype(dataset.dtype)
            return (dataset.asstr() if is_text else dataset)[selection]


@contextmanager
def opened(path: Path, verified: bool = False) -> Iterator[Archive]:
    """Archive that stays open within the context; for the arguments see :func:`read`.

    Raises:
        UnreadableArchive: no archive, a damaged one, or one that this program does not know.
    """
    with _reading(path):
        is_file, there = path.is_file(), path.exists()
    if not is_file:
        what = "is not a file" if there else "does not exist"
        raise UnreadableArchive(f"{path} {what}, expected an archive written by galinx")
    with _reading(path):
        if not verified:
            verify(path)
        file = h5py.File(path, "r")
    with file:
        yield Archive(path, file)


def read(
    path: Path, stresses: bool = True, verified: bool = False
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Datasets by path and attributes of an archive.

    Args:
        path: the file.
        stresses: also stresses on the surface and inside, which can be large.
        verified: this very process has sealed the archive, or verified its digest, before.

    Returns:
        Arrays and text by path, and the root's attributes.

    Raises:
        UnreadableArchive: no archive, a damaged one, or one that this program does not know.
    """
    with opened(path, verified) as archive:
        return archive.all() if stresses else archive.data, archive.attributes


def _check_kind(path: Path, attributes: dict[str, Any]) -> None:
    program, version = attributes.get("program"), attributes.get("schema_version")
    if not isinstance(program, str) or program != "galinx":
        raise UnreadableArchive(f"{path} is HDF5, but not an archive of galinx")
    if not isinstance(version, np.integer) or version < schema.FIRST:
        raise UnreadableArchive(
            f"{path}: attribute schema_version: found {version!r}, expected {schema.FIRST} to "
            f"{schema.VERSION}"
        )
    if version > schema.VERSION:
        raise UnreadableArchive(
            f"{path} has schema version {version}, this program reads up to {schema.VERSION}; install a "
            "newer one"
        )


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    """Context in which HDF5 reads: it raises any of several errors where a file is not what it seems."""
    try:
        yield
    except (OSError, RuntimeError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, OSError) and error.errno:
            raise UnreadableArchive(f"cannot read {path}: {error.strerror}") from error
        raise UnreadableArchive(
            f"{path} is not a whole HDF5 file ({error}); it is damaged or was cut short, run again"
        ) from error
