"""HDF5 result archives, the one place that meets h5py.

An archive appears under its final name only when it is complete: it is written beside it, closed,
opened again and compared, synchronised with the disk and renamed.
"""

import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from galinx.files import NewFile
from galinx.postprocess.disk import refused
from galinx.postprocess.errors import UnreadableArchive, UnwritableArchive
from galinx.postprocess.hdf5.patient import PatientFile
from galinx.postprocess.quantities import declared, large, of_states
from galinx.postprocess.quantities.states import RATIO
from galinx.postprocess.target import Target, as_target

#: Version of the layout; a reader refuses a newer one.
SCHEMA_VERSION = 1


class Writer:
    """An archive in the making; use it as a context manager and end with :meth:`finish`.

    What is written can be larger than memory: datasets are reserved, then filled row by row. Without
    ``finish``, or after an error, nothing is left and an earlier file of that name stays.

    Args:
        path: final name; nothing is replaced where it is a path alone.
        folder: where it is written, on the same file system; beside its final name if not given.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused, or what was read back differs.
        KeyError: the path of a dataset is not in the table of quantities.
    """

    def __init__(self, path: Path | Target, folder: Path | None = None) -> None:
        self._target = as_target(path)
        self.path = self._target.path
        self._new = NewFile(self._target.place, folder)
        self._bytes = 0
        self._written: list[tuple[str, slice, int]] = []

    def __enter__(self) -> "Writer":
        with self._told():
            self._disk = PatientFile(self._new.__enter__().temporary)
            self._file = h5py.File(self._disk, "w", libver=("earliest", "v110"))
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
            about: unit and long name; those of the table of quantities if not given.
        """
        with self._told():
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
        with self._told():
            rows = max(1, min(shape[0], 2**17 // max(1, int(np.prod(shape[1:])))))
            # The checksum is what makes a flipped bit seen.
            dataset = self._file.create_dataset(
                name, shape, dtype, chunks=(rows, *shape[1:]), fletcher32=True
            )
            self._describe(name, dataset, about)
            self._bytes += dataset.size * dataset.dtype.itemsize

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        """Write rows of a reserved dataset."""
        with self._told():
            self._file[name][rows] = values
            self._written.append((name, rows, _checksum(self._file[name].dtype, values)))

    def finish(self, attributes: dict[str, Any]) -> None:
        """Complete the archive and give it its name; ``attributes`` are the root's own."""
        with self._told():
            created = datetime.now(UTC).isoformat(timespec="seconds")
            common = {"program": "galinx", "schema_version": SCHEMA_VERSION, "created": created}
            self._file.attrs.update(common | attributes | {"complete": True})
            self._close()
            self._compare()
            self._target.publish(self._new, self._bytes)

    def _describe(self, name: str, dataset: h5py.Dataset, about: tuple[str, str] | None) -> None:
        if about is None:
            row = declared(name)
            about = row.unit, row.about
        dataset.attrs["units"], dataset.attrs["long_name"] = about

    def _compare(self) -> None:
        """A full disk can leave a file that opens and lists its datasets: compare the content."""
        with h5py.File(self._new.temporary, "r", locking=False) as file:
            for name, rows, checksum in self._written:
                if _checksum(file[name].dtype, file[name][rows]) != checksum:
                    raise UnwritableArchive(
                        f"cannot write {self.path}: {name} reads back differently; is the disk full?"
                    )

    @contextmanager
    def _told(self) -> Iterator[None]:
        try:
            yield
        except (OSError, RuntimeError) as error:
            raise refused(self.path, error, self._bytes) from error
        if self._disk.refusal:
            raise refused(self.path, self._disk.refusal, self._bytes) from self._disk.refusal

    def _close(self) -> None:
        self._file.close()
        self._disk.close()
        if self._disk.refusal:
            raise self._disk.refusal


def _checksum(dtype: np.dtype, values: NDArray) -> int:
    return zlib.crc32(np.ascontiguousarray(values, dtype=dtype).tobytes())


def read(path: Path, stresses: bool = True) -> tuple[dict[str, Any], dict[str, Any]]:
    """What an archive holds.

    Args:
        path: the file.
        stresses: also those on the surface and inside, which can be large.

    Returns:
        Arrays and text by path, and the root's attributes.

    Raises:
        UnreadableArchive: no archive, a damaged one, or one of a newer layout.
    """
    with _opened(path) as file:
        data = {
            name: _values(dataset, slice(None))
            for name, dataset in _datasets(file)
            if stresses or not large(name)
        }
        return data, dict(file.attrs)


def read_rows(path: Path, rows: slice) -> dict[str, Any]:
    """Datasets of some states by path, and those that all states share.

    Raises:
        UnreadableArchive: no archive, a damaged one, or one of a newer layout.
    """
    with _opened(path) as file:
        states = len(file[RATIO.path])
        return {
            name: _values(dataset, rows if dataset.shape[:1] == (states,) else slice(None))
            for name, dataset in _datasets(file)
            if of_states(name)
        }


def described(path: Path) -> dict[str, tuple[str, tuple[int, ...]]]:
    """Unit and shape of every dataset by path.

    Raises:
        UnreadableArchive: no archive, a damaged one, or one of a newer layout.
    """
    with _opened(path) as file:
        return {
            name: (str(dataset.attrs.get("units", "")), dataset.shape)
            for name, dataset in _datasets(file)
        }


@contextmanager
def _opened(path: Path) -> Iterator[h5py.File]:
    """An archive of this program whose layout this version knows."""
    if not path.is_file():
        raise UnreadableArchive(f"{path} is not a file, expected an archive written by galinx")
    try:
        with h5py.File(path, "r") as file:
            attributes = dict(file.attrs)
            if attributes.get("program") != "galinx":
                raise UnreadableArchive(f"{path} is HDF5, but not an archive of galinx")
            if attributes["schema_version"] > SCHEMA_VERSION:
                raise UnreadableArchive(
                    f"{path} has schema version {attributes['schema_version']}, this program reads up "
                    f"to {SCHEMA_VERSION}; install a newer one"
                )
            yield file
    except (OSError, RuntimeError, KeyError) as error:
        raise UnreadableArchive(
            f"{path} is not a whole HDF5 file ({error}); it is damaged or was cut short, run again"
        ) from error


def _datasets(file: h5py.File) -> list[tuple[str, h5py.Dataset]]:
    found: list[tuple[str, h5py.Dataset]] = []

    def visit(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset):
            found.append((name, item))

    file.visititems(visit)
    return found


def _values(dataset: h5py.Dataset, rows: slice) -> Any:
    wanted = rows if dataset.shape else ()
    text = h5py.check_string_dtype(dataset.dtype) is not None
    return dataset.asstr()[wanted] if text else dataset[wanted]
