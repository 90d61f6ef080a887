"""Fields on quadrilaterals as VTKHDF files, which ParaView opens.

The file grows piece by piece, so that no more than one needs to be in memory, and appears under its name
when all of it is on the disk.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from galinx.files import NewFile

from ..errors import refused
from ..target import Target
from .archive import PatientFile

#: Layouts: of one grid, which VTK reads from 9.1 on; of a series, which it reads from 9.3 on.
_ALONE, _SERIES = (1, 0), (2, 0)
#: VTK's numbers of triangles and quadrilaterals.
_TRIANGLE, _QUAD = 5, 9
#: Sizes of a grid, as VTK names them, and where in a series a grid's rows begin.
_SIZES = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")
_OFFSETS = ("PointOffsets", "CellOffsets", "ConnectivityIdOffsets")


@dataclass(frozen=True)
class Piece:
    """A part of an unstructured grid of quadrilaterals.

    Attributes:
        points: positions, (n, 2).
        quads: of the piece's points those of each quadrilateral in turn, (m, 4); a triangle's last is
            doubled.
        data: arrays at the points by name, (n,) or (n, 3); the same names in every piece.
    """

    points: NDArray
    quads: NDArray
    data: Mapping[str, NDArray]


@dataclass(frozen=True)
class Step:
    """A grid, alone or in a series.

    Attributes:
        value: what the series runs over.
        pieces: of the grid, one of them with a quadrilateral; each is made after the last is written.
        told: numbers and texts that hold for all of the grid, by name; the same names in every step.
    """

    value: float
    pieces: Iterable[Piece]
    told: Mapping[str, Any] = field(default_factory=dict)


def write(
    target: Target,
    steps: Iterable[Step],
    about: Mapping[str, tuple[str, str]],
    coloured: str = "",
    series: bool = False,
) -> None:
    """Write unstructured grids.

    Args:
        target: the file; ParaView knows its kind by the endings .hdf and .vtkhdf.
        steps: one grid, or several for a series; each is made after the last is written.
        about: unit and long name of every array by name.
        coloured: the array that viewers colour by unasked.
        series: is it one, with times?

    Raises:
        UnwritableArchive: the file system refused.
        KeyError: an array is not in ``about``.
    """
    needed = 0
    try:
        with NewFile(target.place) as new:
            with PatientFile(new.temporary) as disk:
                with h5py.File(disk, "w", libver=("earliest", "v110")) as file:
                    root = file.create_group("VTKHDF")
                    root.attrs["Version"] = np.array(_SERIES if series else _ALONE, dtype=np.int64)
                    _fill(root, steps, about, series)
                    if coloured:
                        _text(root[f"PointData/{coloured}"], "Attribute", "Scalars")
                    file.flush()
                    needed = file.id.get_filesize()
                if disk.refusal:
                    raise disk.refusal
            target.publish(new, needed)
    except OSError as error:
        raise refused(target.path, error, needed) from error


def _fill(
    root: h5py.Group, steps: Iterable[Step], about: Mapping[str, tuple[str, str]], series: bool
) -> None:
    _text(root, "Type", "UnstructuredGrid")
    first, count = np.zeros(3, dtype=np.int64), 0
    for step in steps:
        sizes = _grid(root, step.pieces, about)
        for name, size in zip(_SIZES, sizes):
            _append(root, name, np.array([size]))
        for name, value in step.told.items():
            _append(root, f"FieldData/{name}", _field(value))
        if series:
            _in_series(root, step, count, first, about)
        first, count = first + sizes, count + 1
    if series:
        root["Steps"].attrs["NSteps"] = np.int64(count)


def _in_series(
    root: h5py.Group, step: Step, count: int, first: NDArray, about: Mapping[str, tuple[str, str]]
) -> None:
    """Append the offsets at which a step's rows begin in every dataset."""
    _append(root, "Steps/Values", np.array([step.value]))
    _append(root, "Steps/PartOffsets", np.array([count]))
    _append(root, "Steps/NumberOfParts", np.array([1]))
    for name, begin in zip(_OFFSETS, first):
        at = np.array([begin])
        _append(root, f"Steps/{name}", at if name == _OFFSETS[0] else at[:, None])
    for name in root["PointData"]:
        _append(root, f"Steps/PointDataOffsets/{name}", first[:1])
    for name in step.told:
        _append(root, f"Steps/FieldDataOffsets/{name}", np.array([count]))


def _grid(
    root: h5py.Group, pieces: Iterable[Piece], about: Mapping[str, tuple[str, str]]
) -> NDArray[np.int64]:
    """Write a grid piece by piece; return its numbers of points, cells and corners of cells."""
    points = cells = corners = 0
    for piece in pieces:
        if not len(piece.quads):
            continue
        n = len(piece.points)
        _append(root, "Points", np.column_stack([piece.points, np.zeros(n)]).astype(np.float64))
        triangles = piece.quads[:, 2] == piece.quads[:, 3]
        there = np.ones(piece.quads.shape, dtype=bool)
        there[triangles, 3] = False
        _append(root, "Connectivity", points + piece.quads[there].astype(np.int64))
        # A cell ends where the next begins; the first begins at 0.
        ends = corners + np.cumsum(there.sum(axis=1))
        _append(root, "Offsets", ends if cells else np.append(0, ends))
        _append(root, "Types", np.where(triangles, _TRIANGLE, _QUAD).astype(np.uint8))
        for name, values in piece.data.items():
            dataset = _append(root, f"PointData/{name}", values)
            dataset.attrs["units"], dataset.attrs["long_name"] = about[name]
        points, cells, corners = points + n, cells + len(piece.quads), int(ends[-1])
    return np.array([points, cells, corners])


def _field(value: Any) -> NDArray:
    """A number or a text as VTK reads it: of texts those alone that call themselves ASCII."""
    if isinstance(value, str):
        return np.array([value.encode()], dtype=h5py.string_dtype("ascii"))
    return np.array([value])


def _text(item: h5py.HLObject, name: str, text: str) -> None:
    """An attribute; VTK reads texts of fixed length only."""
    item.attrs.create(name, text.encode(), dtype=h5py.string_dtype("ascii", len(text)))


def _append(root: h5py.Group, name: str, values: NDArray) -> h5py.Dataset:
    """Add rows to a dataset, which the first of them make."""
    if name not in root:
        rows = min(max(len(values), 1), 2**16)  # that lie together on the disk
        shape, chunks = (0, *values.shape[1:]), (rows, *values.shape[1:])
        root.create_dataset(name, shape, values.dtype, maxshape=(None, *shape[1:]), chunks=chunks)
    dataset = root[name]
    start = len(dataset)
    dataset.resize(start + len(values), axis=0)
    dataset[start:] = values
    return dataset
