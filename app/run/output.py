"""Is there room for an output? Asked before any work is done."""

from pathlib import Path

from galinx.app.errors import BadInput


def check_output(path: Path, overwrite: bool) -> None:
    """Refuse an output that exists or cannot be written.

    Raises:
        BadInput: it exists and ``overwrite`` does not allow to replace it, or its folder does not.
    """
    if path.is_dir():
        raise BadInput(f"{path} is a folder, expected a file name for the archive")
    if path.exists() and not overwrite:
        raise BadInput(f"{path} exists; name another file with -o, or add --overwrite")
    if not path.parent.is_dir():
        raise BadInput(f"the folder {path.parent} does not exist; make it, or choose another with -o")
