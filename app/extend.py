"""Models of the user's own: a Python file that registers them, run before anything else."""

import runpy
from pathlib import Path

from galinx.app.errors import BadInput


def extend(path: Path) -> None:
    """Run a file that registers laws, solids, profiles, meshes or quantities.

    Raises:
        BadInput: it cannot be read, or it fails; the message says where.
    """
    if not path.is_file():
        raise BadInput(f"cannot read {path}: expected a Python file that registers models")
    try:
        runpy.run_path(str(path))
    except Exception as error:
        where = error.__traceback__
        while where and where.tb_next:
            where = where.tb_next
        line = f", line {where.tb_lineno}" if where else ""
        raise BadInput(f"{path} fails: {type(error).__name__}: {error}{line}") from error
