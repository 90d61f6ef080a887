"""Exceptions of archives and other files; HDF5, which is slow to import, is not needed for them."""

import shutil
from contextlib import suppress
from errno import EACCES, EPERM, EROFS
from pathlib import Path

from galinx.texts import bytes_in_words


class UnreadableArchive(Exception):
    """A file is no archive, or an archive that is damaged, changed or of a newer layout.

    The message says what to do.
    """


class MissingDataset(UnreadableArchive, KeyError):
    """An archive lacks a dataset that is asked for; in Python a KeyError, as of any mapping."""

    __str__ = Exception.__str__  # a KeyError shows its message in quotes


class UnwritableArchive(Exception):
    """The file system refused an archive or another file; the message says why."""


class Occupied(Exception):
    """A file cannot have this name: another one may not be replaced, or the ending is of another kind."""


class ArchiveInUse(UnwritableArchive):
    """Another run is writing the same archive."""


class LeftOver(UnwritableArchive):
    """An interrupted run left finished states; the message says how to use or discard them."""


def refused(target: Path, error: Exception, needed: int = 0) -> UnwritableArchive:
    """Exception for a file that the file system refuses: its message has the reason and the space.

    Args:
        target: the file.
        error: exception of the file system or of HDF5.
        needed: size of the file in bytes; 0 where it is unknown.

    Returns:
        The exception, to be raised by the caller.
    """
    reason = getattr(error, "strerror", None) or str(error)
    space = ""
    if getattr(error, "errno", None) not in (EACCES, EPERM, EROFS):  # room may be what is missing
        space = f"; it needs {bytes_in_words(needed)}" if needed else ""
        with suppress(OSError):
            space += f"; {bytes_in_words(shutil.disk_usage(target.parent).free)} are free"
    return UnwritableArchive(f"cannot write {target}: {reason}{space}")
