"""Error of a finite element result, measured on results of lower degree, no exact solution used."""

import numpy as np
from numpy.typing import NDArray

#: Range of the ratio of successive differences. Below it a lucky coincidence is not believed; at its
#: upper end convergence is too slow to be summed, and the estimate says that it is large.
RATIO = (0.2, 0.9)


def extrapolated(coarse: NDArray, middle: NDArray, fine: NDArray) -> NDArray[np.float64]:
    """Error of ``fine``, from three successive degrees whose errors fall like a geometric series.

    With differences d₀ = |middle - coarse| and d₁ = |fine - middle| and ρ = d₁/d₀ what is left is
    d₁ ρ/(1 - ρ).

    Args:
        coarse, middle, fine: quantities of each state, (states, quantities).

    Returns:
        Largest over the quantities, (states,).
    """
    d0 = np.abs(middle - coarse).max(axis=1)
    d1 = np.abs(fine - middle).max(axis=1)
    ρ = np.clip(d1 / np.maximum(d0, np.finfo(float).tiny), *RATIO)
    return d1 * ρ / (1.0 - ρ)
