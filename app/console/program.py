"""What the command is called."""

import os
import re


def program() -> str:
    """How the user called the program: ``./run.sh`` in the tree, ``galinx`` elsewhere."""
    return _called() or "galinx"


def as_called(text: str) -> str:
    """A text whose commands begin with ``./run.sh``, as the user would type them.

    An installed galinx is started on several ranks by mpirun itself.
    """
    if not _called():
        text = re.sub(r"\./run\.sh -n (\d+)", r"mpirun -n \1 galinx", text)
    return text.replace("./run.sh", program())


def _called() -> str:
    return os.environ.get("GALINX_COMMAND", "")
