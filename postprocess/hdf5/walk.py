"""Reads all that an HDF5 file holds, as a program of its own: HDF5 crashes over some damaged files.

``python walk.py FILE`` ends with status 0 where HDF5 can read all of it.
"""

import sys

import h5py


def walk(path: str) -> None:
    """Read every attribute and every value of a file.

    Raises:
        Exception: whatever HDF5 has to say.
    """
    with h5py.File(path, "r") as file:
        items: list[h5py.HLObject] = [file]
        file.visititems(lambda _, item: items.append(item))
        for item in items:
            dict(item.attrs)
            # A size that was made up is no reason to read for ever; the schema sees it.
            if isinstance(item, h5py.Dataset) and is_there(item):
                _read(item)


def _read(dataset: h5py.Dataset) -> None:
    if not dataset.chunks:
        dataset[()]
        return
    for part in dataset.iter_chunks():
        # Where its index has lost a part HDF5 gives zeros; reading the part itself raises an error.
        dataset.id.read_direct_chunk(tuple(rows.start for rows in part))
        dataset[part]


def is_there(dataset: h5py.Dataset) -> bool:
    """True where the file has room for all values of a dataset."""
    room = dataset.id.get_storage_size()
    return dataset.shape is not None and room >= dataset.size * dataset.dtype.itemsize


if __name__ == "__main__":
    walk(sys.argv[1])
