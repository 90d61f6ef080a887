"""Result archives are written.

An archive appears under its final name only when it is complete: it is written beside it, closed,
opened again and compared, sealed, synchronised with the disk and renamed.
"""

import json
import zlib
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from galinx.files import NewFile
from galinx.postprocess.disk import refused
from galinx.postprocess.errors import UnwritableArchive
from galinx.postprocess.hdf5 import seal
from galinx.postprocess.hdf5.patient import PatientFile
from galinx.postprocess.quantities import declared
from galinx.postprocess.schema import VERSION
from galinx.postprocess.target import Target, as_target


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
        self._names: list[str] = []
        self._written: list[tuple[str, slice, int]] = []
        #: Reserved datasets: opened anew for every write, they would read and write a chunk each time.
        self._open: dict[str, h5py.Dataset] = {}

    def __enter__(self) -> "Writer":
        with self._told():
            self._disk = PatientFile(self._new.__enter__().temporary)
            self._file = h5py.File(self._disk, "w", libver=("earliest", "v110"), userblock_size=seal.ROOM)
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
            self._open[name] = dataset
            self._bytes += dataset.size * dataset.dtype.itemsize

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        """Write rows of a reserved dataset."""
        with self._told():
            dataset = self._open[name]
            dataset[rows] = values
            self._written.append((name, rows, _checksum(dataset.dtype, values)))

    def finish(
        self, attributes: dict[str, Any], before: Callable[[Path], None] = lambda path: None
    ) -> None:
        """Complete the archive and give it its name.

        Args:
            attributes: the root's own.
            before: is called with the finished file before it gets its name.
        """
        with self._told():
            created = datetime.now(UTC).isoformat(timespec="seconds")
            common = {"program": "galinx", "created": created}
            layout = {"schema_version": VERSION, "datasets": json.dumps(self._names), "complete": True}
            self._file.attrs.update(common | attributes | layout)
            self._close()
            with ThreadPoolExecutor(1) as beside:  # both read all of it, on two cores
                made = beside.submit(seal.made, self._new.temporary)
                self._compare()
                seal.put(self._new.temporary, made.result())
            before(self._new.temporary)
            self._target.publish(self._new, self._bytes)

    def _describe(self, name: str, dataset: h5py.Dataset, about: tuple[str, str] | None) -> None:
        self._names.append(name)
        if about is None:
            row = declared(name)
            about = row.unit, row.about
        dataset.attrs["units"], dataset.attrs["long_name"] = about

    def _compare(self) -> None:
        """A full disk can leave a file that opens and lists its datasets: compare the content."""
        with h5py.File(self._new.temporary, "r", locking=False) as file:
            datasets = {name: file[name] for name, _, _ in self._written}
            for name, rows, checksum in self._written:
                if _checksum(datasets[name].dtype, datasets[name][rows]) != checksum:
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
    return zlib.crc32(np.ascontiguousarray(values, dtype=dtype).data)
