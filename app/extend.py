"""Models of the user's own: a Python file that registers them, run before anything else."""

import runpy
from pathlib import Path
from traceback import extract_tb

from galinx.app.errors import BadInput
from galinx.app.process import stop


def extend(path: Path) -> None:
    """Run a file that registers laws, solids, profiles, meshes or quantities.

    Raises:
        BadInput: it cannot be read, or it fails; the message says where.
    """
    try:
        there = path.is_file()
    except OSError as error:
        raise BadInput(f"cannot read {path}: {error.strerror}") from None
    if not there:
        raise BadInput(f"cannot read {path}: expected a Python file that registers models")
    try:
        runpy.run_path(str(path))
    except stop.Asked:  # the process itself is to end
        raise
    except BaseException as error:  # whatever ends the file, sys.exit among it
        lines = [frame.lineno for frame in extract_tb(error.__traceback__) if frame.filename == str(path)]
        line = f", line {lines[-1]}" if lines else ""
        said = f": {error}" if str(error) else ""
        raise BadInput(f"{path} fails: {type(error).__name__}{said}{line}") from error
