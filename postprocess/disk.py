"""What the file system says when it refuses."""

import shutil
from contextlib import suppress
from pathlib import Path

from galinx.postprocess.errors import UnwritableArchive


def refused(target: Path, error: Exception, needed: int = 0) -> UnwritableArchive:
    """The failure to raise, with the reason, and the space that is needed and free.

    Args:
        target: the file.
        error: what the file system or HDF5 raised.
        needed: bytes, where they are known.
    """
    reason = getattr(error, "strerror", None) or str(error)
    space = f"; it needs {needed / 1e6:.3g} MB" if needed else ""
    with suppress(OSError):
        space += f"; {shutil.disk_usage(target.parent).free / 1e6:.3g} MB are free"
    return UnwritableArchive(f"cannot write {target}: {reason}{space}")
