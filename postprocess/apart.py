"""What tells an archive's states apart."""

from typing import Any

from galinx.postprocess.quantities import Quantity, table
from galinx.postprocess.quantities.states import LOAD, MOTION, POSITION, SPEED


def parameters(data: dict[str, Any]) -> dict[str, Quantity]:
    """What tells an archive's states apart, by its dataset's path, slowest first.

    Args:
        data: datasets by path.
    """
    known = {path: row for path, row in table().items() if row.symbol and path in data}
    first, last = [SPEED.path, *({LOAD.path} & known.keys())], [MOTION.path, POSITION.path]
    own = [path for path in known if path not in (*first, *last)]
    return {path: known[path] for path in (*first, *own, *last)}
