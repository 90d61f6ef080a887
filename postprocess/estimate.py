"""Error of a finite element result, measured on results of lower degree, no exact solution used."""

import numpy as np
from numpy.typing import NDArray

#: Range of the ratio of successive differences. Below it a lucky coincidence is not believed; at its
#: upper end convergence is too slow to be summed, and the estimate says that it is large.
RATIO = (0.2, 0.9)

#: The ratio of successive differences is not quite constant; this covers it.
SAFETY = 2.0


def differences(coarse: NDArray, fine: NDArray) -> NDArray[np.float64]:
    """Largest difference of each state's quantities between two degrees, (states,).

    Args:
        coarse, fine: (states, quantities).
    """
    return np.abs(fine - coarse).max(axis=1)


def remaining_share(first: NDArray, second: NDArray) -> float:
    """What is left of an error over the last difference: ``SAFETY`` times the geometric ρ/(1 - ρ).

    The ratio ρ of successive differences is that of their largest, because a single state's first
    difference may happen to vanish.

    Args:
        first, second: successive differences of several states, (states,).
    """
    ρ = np.clip(second.max() / max(first.max(), np.finfo(float).tiny), *RATIO)
    return float(SAFETY * ρ / (1.0 - ρ))
