"""Archives that are changed on purpose: what may be done to one that is opened for writing."""

import json
from contextlib import contextmanager

import h5py

from galinx.postprocess.hdf5 import archive


def archived(result, folder):
    """The bytes of a result's archive."""
    path = folder / "a.h5"
    result.save(path)
    return path.read_bytes()


@contextmanager
def opened(path, sealed=True):
    """An archive that may be changed in the block; then its digest is made again, if it is to be."""
    with h5py.File(path, "r+") as file:
        yield file
    if sealed:
        archive.put(path)


def value(name, found, at=0):
    def apply(file):
        file[name][at] = found

    return apply


def attribute(name, found):
    def apply(file):
        file.attrs[name] = found

    return apply


def gone(name):
    def apply(file):
        del (file.attrs if name in file.attrs else file)[name]

    return apply


def lost(name):
    """The archive without one of its datasets, which it does not list either."""

    def apply(file):
        del file[name]
        names = json.loads(file.attrs["datasets"])
        file.attrs["datasets"] = json.dumps([each for each in names if each != name])

    return apply


def renamed(old, new):
    return lambda file: file.move(old, new)


def another(name, made):
    """Another dataset in the place of one, of what it held."""

    def apply(file):
        held, about = file[name][()], dict(file[name].attrs)
        del file[name]
        file[name] = made(held)
        file[name].attrs.update(about)

    return apply


def unit(name, found):
    def apply(file):
        file[name].attrs["units"] = found

    return apply
