"""How far two methods agree on starts from rest; their rules are among those of all comparisons."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.postprocess.compare import RULES, Rule
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.quantity import FEM, SIE

#: Rules by name: of both methods, and of finite elements.
BOTH, OF_FEM = "over time", "estimate over time"

#: Centre of the pressure over a that is as good as none.
_NO_LEAN = 1e-2
#: Indentation over N/(2μ) that is as good as none.
_NO_SINKING = 1e-2

#: What both methods tell.
TOLD = rows.V0, rows.CENTRE, rows.K_I_LEFT, rows.K_I_RIGHT


def largest_change(
    found: Sequence[NDArray], expected: Sequence[NDArray], load: NDArray, lean: ArrayLike = 0.0
) -> float:
    """How far v₀, centre, K_I left and right (starts, times) are apart, over the largest of a start.

    The centre is multiplied by the load: where there is hardly any, it says hardly anything. K_I is over
    that of the stronger end, and left out where it is NaN.

    Args:
        found, expected: of both methods.
        load: share of N, (times,).
        lean: centre of steady motion, (starts, times), which counts among those of which the largest is
            taken.
    """
    off, sizes = [], []
    for n, (one, other) in enumerate(zip(found, expected)):
        share = load if n == 1 else np.ones_like(load)
        off.append(np.abs((one - other) * share).max(axis=-1))
        sizes.append(np.abs(other * share).max(axis=-1))
    sizes[0] = np.maximum(sizes[0], _NO_SINKING)
    sizes[1] = np.maximum(np.maximum(sizes[1], _NO_LEAN), np.abs(np.atleast_1d(lean)).max(axis=-1))
    sizes[2] = sizes[3] = np.maximum(sizes[2], sizes[3])
    return float(np.nanmax(np.array(off) / np.array(sizes)))


def _both(data: Mapping[str, Any], _: Any) -> float:
    """Up to where the integral equation knows them."""
    known = np.isfinite(data[rows.V0[SIE].path]).all(axis=0)
    if not known.any():
        return np.inf
    fem, sie = ([data[row[method].path][:, known] for row in TOLD] for method in (FEM, SIE))
    return largest_change(fem, sie, data[rows.LOAD.path][known], lean_of_steady(data)[:, known])


def lean_of_steady(data: Mapping[str, Any]) -> NDArray[np.float64]:
    """Centre of steady motion where friction changes, 0 elsewhere, (starts, times).

    Friction that changes faster than waves run has a steady lean that the pressure never comes to.
    """
    changing = np.ptp(data[rows.RATIOS.path], axis=-1) > 0.0
    return np.asarray(np.where(changing[:, None], data[rows.CENTRES.path], 0.0))


def _estimate(data: Mapping[str, Any], _: Any) -> float:
    return float(data[rows.ESTIMATE.path].max())


RULES.register(
    BOTH,
    Rule(
        "v₀, centre times load and K_I over time against the integral equation, over the largest",
        (rows.LOAD, rows.RATIOS, rows.CENTRES, *(row[method] for row in TOLD for method in (FEM, SIE))),
        _both, tolerances=1.0,
    ),
)  # fmt: skip
RULES.register(
    OF_FEM,
    Rule("estimated error over time, over the largest", (rows.ESTIMATE,), _estimate, tolerances=1.0),
)
