"""Where energy goes over time: do works and energies balance, and do both methods tell the same works?"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.compare import RULES, Rule
from galinx.postprocess.quantities import energy_over_time as rows
from galinx.postprocess.quantities.quantity import FEM, SIE, Quantity
from galinx.postprocess.quantities.work_over_time import OF_FRICTION, OF_LOAD

#: Rules by name.
WORKS, BALANCE = "works over time", "energy over time"

_DONE = OF_LOAD[FEM], OF_FRICTION[FEM], rows.CARRIED
_HELD = rows.STRAIN, rows.KINETIC, rows.RADIATED


def left_over(data: Mapping[str, Any]) -> NDArray[np.float64]:
    """Work that is nowhere to be found, over the largest work of a motion, (motions, times)."""
    done, held = (sum(data[row.path] for row in some) for some in (_DONE, _HELD))
    return np.asarray((done - held) / np.abs(done).max(axis=1, keepdims=True))


def _balance(data: Mapping[str, Any], _: Any) -> float:
    return float(np.abs(left_over(data)).max())


def _works(data: Mapping[str, Any], _: Any) -> float | None:
    return off_until_turn(data, (OF_LOAD, OF_FRICTION))


def off_until_turn(data: Mapping[str, Any], rows: tuple[dict[str, Quantity], ...]) -> float | None:
    """How far both methods' histories are apart up to the first turn, over the largest of a motion.

    Args:
        data: datasets by path.
        rows: histories by method, (motions, times) each.

    Returns:
        None where the integral equation knows none of them.
    """
    fem, sie = (np.array([data[row[method].path] for row in rows]) for method in (FEM, SIE))
    known = np.isfinite(sie).all(axis=(0, 1))
    if not known.any():
        return None
    off, size = (np.abs(of[..., known]).max(axis=(0, 2)) for of in (fem - sie, sie))
    return float((off / size).max())


RULES.register(
    WORKS,
    Rule(
        "works of load and friction over time against the integral equation, over the largest",
        tuple(row[method] for row in (OF_LOAD, OF_FRICTION) for method in (FEM, SIE)), _works,
        tolerances=1.0,
    ),
)  # fmt: skip
RULES.register(
    BALANCE,
    Rule(
        "work without its energy over time, over the largest work",
        (*_DONE, *_HELD),
        _balance,
        tolerances=1.0,
    ),
)
