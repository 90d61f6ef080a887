"""Fields on quadrilaterals as VTKHDF files, which ParaView opens.

The file is put together in memory, where no disk can be full, and appears under its name when all of it
is on the disk.
"""

import io
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray

from postprocess.disk import refused

#: Layout that VTK 9.1 knows.
_VERSION = (1, 0)
#: VTK's number of a quadrilateral.
_QUAD = 9


def write(
    path: Path,
    points: NDArray,
    quads: NDArray,
    point_data: Mapping[str, NDArray],
    about: Mapping[str, tuple[str, str]],
    cell_data: Mapping[str, NDArray] | None = None,
) -> None:
    """Write an unstructured grid of quadrilaterals; an earlier file of that name is replaced.

    Args:
        path: final name; ParaView knows the kind of file by the ending .hdf.
        points: positions, (n, 2) or (n, 3).
        quads: points of each quadrilateral in turn, (m, 4).
        point_data: arrays by name, (n,) or (n, 3).
        about: unit and long name of every array by name.
        cell_data: arrays by name, (m,) or (m, 3).

    Raises:
        UnwritableArchive: the file system refused.
        KeyError: an array is not in ``about``.
    """
    content = _content(points, quads, {"PointData": point_data, "CellData": cell_data or {}}, about)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        with open(temporary, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except OSError as error:
        raise refused(path, error, len(content)) from error
    finally:
        with suppress(OSError):  # the folder itself may be what is wrong
            temporary.unlink()


def _content(
    points: NDArray,
    quads: NDArray,
    data: Mapping[str, Mapping[str, NDArray]],
    about: Mapping[str, tuple[str, str]],
) -> bytes:
    """The file's bytes."""
    n, m = len(points), len(quads)
    memory = io.BytesIO()
    with h5py.File(memory, "w", libver=("earliest", "v110")) as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array(_VERSION, dtype=np.int64)
        # VTK reads a text of fixed length only.
        kind = b"UnstructuredGrid"
        root.attrs.create("Type", kind, dtype=h5py.string_dtype("ascii", len(kind)))
        for name, number in (
            ("NumberOfPoints", n),
            ("NumberOfCells", m),
            ("NumberOfConnectivityIds", quads.size),
        ):
            root[name] = np.array([number], dtype=np.int64)
        depth = np.zeros((n, 3 - points.shape[1]))
        root["Points"] = np.column_stack([points, depth]).astype(np.float64)
        root["Connectivity"] = quads.astype(np.int64).ravel()
        root["Offsets"] = 4 * np.arange(m + 1, dtype=np.int64)
        root["Types"] = np.full(m, _QUAD, dtype=np.uint8)
        for group, arrays in data.items():
            place = root.create_group(group)
            for name, values in arrays.items():
                place[name] = values
                place[name].attrs["units"], place[name].attrs["long_name"] = about[name]
    return memory.getvalue()
