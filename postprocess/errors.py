"""Failures of archives and other files, without the library that reads them, which is slow to import."""

import shutil
from contextlib import suppress
from pathlib import Path


class UnreadableArchive(Exception):
    """No archive, a damaged or changed one, or one of a newer layout; the message says what to do."""


class UnwritableArchive(Exception):
    """The file system refused an archive or another file; the message says why."""


class Occupied(Exception):
    """A file cannot have that name: what is there may not be replaced, or the ending is another's."""


class ArchiveInUse(UnwritableArchive):
    """Another run is writing the same archive."""


class LeftOver(UnwritableArchive):
    """An interrupted run left something; the message says what can be done with it."""


def refused(target: Path, error: Exception, needed: int = 0) -> UnwritableArchive:
    """Failure to raise where the file system refuses a file, with the reason, and space needed and free.

    Args:
        target: the file.
        error: what the file system or HDF5 raised.
        needed: size of the file in bytes; 0 where it is not known.
    """
    reason = getattr(error, "strerror", None) or str(error)
    space = f"; it needs {_size(needed)}" if needed else ""
    with suppress(OSError):
        space += f"; {_size(shutil.disk_usage(target.parent).free)} are free"
    return UnwritableArchive(f"cannot write {target}: {reason}{space}")


def _size(count: float) -> str:
    for unit in ("bytes", "kB", "MB"):
        if count < 999.5:
            return f"{count:.3g} {unit}"
        count /= 1000.0
    return f"{count:.3g} GB"
