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
