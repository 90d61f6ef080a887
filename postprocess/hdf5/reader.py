"""The one door to archives: what comes through is as it was written, and fits the schema."""

import os
import subprocess
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from galinx.postprocess import schema
from galinx.postprocess.errors import UnreadableArchive
from galinx.postprocess.hdf5 import seal, walk
from galinx.postprocess.quantities import large, of_states, table
from galinx.postprocess.quantities.quantity import STATE, TEXT
from galinx.postprocess.quantities.runs import FAILURES
from galinx.postprocess.quantities.stresses import SURFACE_X

#: Faults that a message tells.
_TOLD = 8
#: Seconds for a walk through a file without a seal, and bytes that it reads in another.
_PATIENCE, _PACE = 60.0, 1e7
#: How names begin of what MPI tells its processes; h5py starts MPI where it finds them.
_OF_MPI = ("OMPI_", "PMIX_", "PMI_", "PRTE_", "MPI_", "HYDI_", "HYDRA_")


class Archive:
    """An open archive without faults.

    Attributes:
        attributes: of the root.
        data: datasets by path, but for large ones.
        names: of all datasets.
    """

    def __init__(self, path: Path, file: h5py.File, sealed: bool) -> None:
        self._path, self._file = path, file
        self.attributes, described = _described(path, file)
        if not sealed and self.attributes["schema_version"] >= schema.SEALED:
            _refuse(path, ["its digest: missing, expected in its first bytes"])
        _refuse(path, schema.faults(self.attributes, described))
        self.names = list(described)
        self.data = {name: self._read(name) for name in self.names if not large(name)}
        _refuse(path, schema.faults_of_values(self.data, self.attributes))
        _refuse(path, [*schema.faults_between(self.data, self.attributes)])

    def all(self) -> dict[str, Any]:
        """Every dataset by path.

        Raises:
            UnreadableArchive: a large one does not fit the schema.
        """
        return {name: self._large(name) if large(name) else self.data[name] for name in self.names}

    def rows(self, rows: slice, names: Iterable[str] | None = None) -> dict[str, Any]:
        """Datasets of some states by path, and positions that all states share.

        Args:
            rows: numbers of the states.
            names: of the datasets; all of states if not given.

        Raises:
            UnreadableArchive: a large one does not fit the schema.
        """
        found, known = {}, table()
        for name in filter(of_states, self.names) if names is None else names:
            if large(name):
                found[name] = self._large(name, rows)
            else:
                found[name] = self.data[name][rows if STATE in known[name].over else slice(None)]
        return found

    def _large(self, name: str, rows: slice = slice(None)) -> Any:
        values = self._read(name, rows)
        needed = {row.path: self.data[row.path] for row in (SURFACE_X, FAILURES) if row.path in self.data}
        _refuse(self._path, schema.faults_of_values(needed | {name: values}, self.attributes))
        return values

    def _read(self, name: str, rows: slice = slice(None)) -> Any:
        with _told(self._path):
            dataset = self._file[name]
            wanted = rows if dataset.shape else ()
            return dataset.asstr()[wanted] if _type(dataset) == TEXT else dataset[wanted]


@contextmanager
def opened(path: Path, just_sealed: bool = False) -> Iterator[Archive]:
    """An archive as long as it is open; for the arguments see :func:`read`.

    Raises:
        UnreadableArchive: no archive, a damaged one, one that does not fit the schema, or of a newer one.
    """
    with _told(path):
        there = path.is_file()
    if not there:
        raise UnreadableArchive(f"{path} is not a file, expected an archive written by galinx")
    with _told(path):
        sealed = just_sealed or seal.is_sealed(path)
        if not sealed:
            _walk(path)
        file = h5py.File(path, "r")
    with file:
        yield Archive(path, file, sealed)


def read(
    path: Path, stresses: bool = True, just_sealed: bool = False
) -> tuple[dict[str, Any], dict[str, Any]]:
    """What an archive holds.

    Args:
        path: the file.
        stresses: also those on the surface and inside, which can be large.
        just_sealed: by this very process, which need not do the sum of all bytes once more.

    Returns:
        Arrays and text by path, and the root's attributes.

    Raises:
        UnreadableArchive: no archive, a damaged one, one that does not fit the schema, or of a newer one.
    """
    with opened(path, just_sealed) as archive:
        return archive.all() if stresses else archive.data, archive.attributes


def _walk(path: Path) -> None:
    """Let another process read all of a file first: it is that one which HDF5 makes crash."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(_OF_MPI)}
    patience = _PATIENCE + path.stat().st_size / _PACE
    try:
        done = subprocess.run(
            [sys.executable, "-P", walk.__file__, path], env=kept, capture_output=True, text=True,
            errors="replace", timeout=patience,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        raise OSError(f"HDF5 did not come to an end within {patience:.0f} s") from None
    if done.returncode:
        said = done.stderr.strip().splitlines()
        raise OSError(said[-1] if said and done.returncode > 0 else "HDF5 crashes over it")


def _described(path: Path, file: h5py.File) -> tuple[dict[str, Any], dict[str, schema.Described]]:
    found: dict[str, schema.Described] = {}

    def visit(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset):
            shape = item.shape or ()  # None: without any room
            found[name] = schema.Described(_type(item), shape, dict(item.attrs), _whole(item))

    with _told(path):
        attributes = dict(file.attrs)
        _check_kind(path, attributes)
        file.visititems(visit)
    return attributes, found


def _check_kind(path: Path, attributes: dict[str, Any]) -> None:
    program, version = attributes.get("program"), attributes.get("schema_version")
    if not isinstance(program, str) or program != "galinx":
        raise UnreadableArchive(f"{path} is HDF5, but not an archive of galinx")
    if not isinstance(version, np.integer) or version < 1:
        raise UnreadableArchive(
            f"{path}: attribute schema_version: found {version!r}, expected 1 to {schema.VERSION}"
        )
    if version > schema.VERSION:
        raise UnreadableArchive(
            f"{path} has schema version {version}, this program reads up to {schema.VERSION}; install a "
            "newer one"
        )


def _type(dataset: h5py.Dataset) -> str:
    return TEXT if h5py.check_string_dtype(dataset.dtype) else str(dataset.dtype)


def _whole(dataset: h5py.Dataset) -> bool:
    return walk.is_there(dataset) and (dataset.fletcher32 or _type(dataset) == TEXT)


def _refuse(path: Path, faults: list[str]) -> None:
    if faults:
        more = f"\n  and {len(faults) - _TOLD} more" if len(faults) > _TOLD else ""
        lines = "".join(f"\n  {fault}" for fault in faults[:_TOLD])
        raise UnreadableArchive(
            f"{path} is not as galinx writes archives: damaged, or changed; take another copy or rerun"
            f"{lines}{more}"
        )


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """For what meets HDF5: it raises any of these where a file is not what it seems."""
    try:
        yield
    except (OSError, RuntimeError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, OSError) and error.errno:
            raise UnreadableArchive(f"cannot read {path}: {error.strerror}") from error
        raise UnreadableArchive(
            f"{path} is not a whole HDF5 file ({error}); it is damaged or was cut short, run again"
        ) from error
