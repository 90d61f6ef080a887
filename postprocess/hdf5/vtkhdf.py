"""Fields on quadrilaterals as VTKHDF files, which ParaView opens.

The file grows piece by piece, so that no more than one needs to be in memory, and appears under its name
when all of it is on the disk.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Protocol

import h5py
import numpy as np
from numpy.typing import NDArray

from galinx.files import NewFile
from galinx.postprocess.disk import refused
from galinx.postprocess.hdf5.patient import PatientFile
from galinx.postprocess.target import Target, as_target

#: Layout that VTK 9.1 knows.
_VERSION = (1, 0)
#: VTK's number of a quadrilateral.
_QUAD = 9
#: Rows of a dataset that lie together on the disk, at most.
_TOGETHER = 2**16


class Piece(Protocol):
    """A part of an unstructured grid of quadrilaterals.

    Attributes:
        points: positions, (n, 2).
        quads: of the piece's points those of each quadrilateral in turn, (m, 4).
        data: arrays at the points by name, (n,) or (n, 3); the same names in every piece.
    """

    @property
    def points(self) -> NDArray: ...
    @property
    def quads(self) -> NDArray: ...
    @property
    def data(self) -> Mapping[str, NDArray]: ...


def write(path: Path | Target, pieces: Iterable[Piece], about: Mapping[str, tuple[str, str]]) -> None:
    """Write an unstructured grid.

    Args:
        path: final name; ParaView knows the kind of file by the ending .hdf. Nothing is replaced where it
            is a path alone.
        pieces: of the grid, one of them with a quadrilateral; the next is asked for when one is written.
        about: unit and long name of every array by name.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
        KeyError: an array is not in ``about``.
    """
    target, needed = as_target(path), 0
    try:
        with NewFile(target.place) as new:
            with PatientFile(new.temporary) as disk:
                with h5py.File(disk, "w", libver=("earliest", "v110")) as file:
                    _fill(file.create_group("VTKHDF"), pieces, about)
                    file.flush()
                    needed = file.id.get_filesize()
                if disk.refusal:
                    raise disk.refusal
            target.publish(new, needed)
    except OSError as error:
        raise refused(target.path, error, needed) from error


def _fill(root: h5py.Group, pieces: Iterable[Piece], about: Mapping[str, tuple[str, str]]) -> None:
    root.attrs["Version"] = np.array(_VERSION, dtype=np.int64)
    # VTK reads a text of fixed length only.
    kind = b"UnstructuredGrid"
    root.attrs.create("Type", kind, dtype=h5py.string_dtype("ascii", len(kind)))
    points = cells = 0
    for piece in pieces:
        if not len(piece.quads):
            continue
        n, m = len(piece.points), len(piece.quads)
        _append(root, "Points", np.column_stack([piece.points, np.zeros(n)]).astype(np.float64))
        _append(root, "Connectivity", points + piece.quads.astype(np.int64).ravel())
        # A cell ends where the next begins; the first begins at 0.
        ends = 4 * np.arange(cells + (cells > 0), cells + m + 1, dtype=np.int64)
        _append(root, "Offsets", ends)
        _append(root, "Types", np.full(m, _QUAD, dtype=np.uint8))
        for name, values in piece.data.items():
            dataset = _append(root, f"PointData/{name}", values)
            dataset.attrs["units"], dataset.attrs["long_name"] = about[name]
        points, cells = points + n, cells + m
    sizes = {"NumberOfPoints": points, "NumberOfCells": cells, "NumberOfConnectivityIds": 4 * cells}
    for name, number in sizes.items():
        root[name] = np.array([number], dtype=np.int64)


def _append(root: h5py.Group, name: str, values: NDArray) -> h5py.Dataset:
    """Add rows to a dataset, which the first of them make."""
    if name not in root:
        rows = min(max(len(values), 1), _TOGETHER)
        shape, chunks = (0, *values.shape[1:]), (rows, *values.shape[1:])
        root.create_dataset(name, shape, values.dtype, maxshape=(None, *shape[1:]), chunks=chunks)
    dataset = root[name]
    start = len(dataset)
    dataset.resize(start + len(values), axis=0)
    dataset[start:] = values
    return dataset
