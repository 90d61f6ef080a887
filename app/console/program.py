"""What the command is called."""

import os


def program() -> str:
    """How the user called the program: ``./run.sh`` in the tree, ``galinx`` elsewhere."""
    return os.environ.get("GALINX_COMMAND") or "galinx"
