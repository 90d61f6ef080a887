"""HDF5 result archives, the one place that meets h5py.

An archive appears under its final name only when it is complete: it is written beside it, closed,
opened again and compared, synchronised with the disk and renamed.
"""

import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from postprocess.errors import UnreadableArchive, UnwritableArchive
from postprocess.fields import FIELDS

#: Version of the layout; a reader refuses a newer one.
SCHEMA_VERSION = 1


def write(path: Path, data: dict[str, Any], attributes: dict[str, Any]) -> None:
    """Write an archive atomically; an earlier file of that name stays until the new one is whole.

    Args:
        path: final name.
        data: arrays, lists of text or text by path in the archive; each path is in ``FIELDS``.
        attributes: of the root, beside those every archive has.

    Raises:
        UnwritableArchive: the file system refused, or what was read back differs.
        KeyError: a path is not in ``FIELDS``.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        try:
            with h5py.File(temporary, "w", libver=("earliest", "v110")) as file:
                for name, value in data.items():
                    _dataset(file, name, value)
                created = datetime.now(UTC).isoformat(timespec="seconds")
                file.attrs.update(
                    program="galinx", schema_version=SCHEMA_VERSION, created=created, **attributes
                )
                file.attrs["complete"] = True
            _compare(temporary, data)
            _synchronise(temporary)
            os.replace(temporary, path)
            _synchronise(path.parent)
        except OSError as error:
            reason = os.strerror(error.errno) if error.errno else str(error)
            raise UnwritableArchive(f"cannot write {path}: {reason}") from error
    finally:
        temporary.unlink(missing_ok=True)


def _dataset(file: h5py.File, name: str, value: Any) -> None:
    unit, long_name = FIELDS[name]
    if isinstance(value, str):
        dataset = file.create_dataset(name, data=value, dtype=h5py.string_dtype())
    else:
        array = np.asarray(value)
        if array.dtype.kind == "U" or (array.size == 0 and array.dtype.kind != "i"):
            dataset = file.create_dataset(name, data=list(value), dtype=h5py.string_dtype())
        else:
            # The checksum is what makes a flipped bit seen.
            dataset = file.create_dataset(name, data=array, chunks=True, fletcher32=True)
    dataset.attrs["units"], dataset.attrs["long_name"] = unit, long_name


def _compare(path: Path, data: dict[str, Any]) -> None:
    """A full disk can leave a file that opens and lists its datasets: compare the content."""
    back, _ = read(path)
    for name, value in data.items():
        written, found = np.asarray(value), np.asarray(back[name])
        numbers = written.dtype.kind == "f" and written.size > 0
        if not np.array_equal(found, written, equal_nan=numbers):
            raise UnwritableArchive(
                f"cannot write {path}: {name} reads back differently; is the disk full?"
            )


def _synchronise(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def read(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Everything in an archive.

    Returns:
        Arrays and text by path, and the root's attributes.

    Raises:
        UnreadableArchive: no archive, a damaged one, or one of a newer layout.
    """
    if not path.is_file():
        raise UnreadableArchive(f"{path} is not a file, expected an archive written by galinx")
    data: dict[str, Any] = {}
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
            file.visititems(lambda name, item: _collect(data, name, item))
    except (OSError, RuntimeError, KeyError) as error:
        raise UnreadableArchive(
            f"{path} is not a whole HDF5 file ({error}); it is damaged or was cut short, run again"
        ) from error
    return data, attributes


def _collect(data: dict[str, Any], name: str, item: Any) -> None:
    if isinstance(item, h5py.Dataset):
        text = h5py.check_string_dtype(item.dtype) is not None
        data[name] = item.asstr()[()] if text else item[()]
