"""Error of a finite element result, measured on results of lower degree, no exact solution used."""

import numpy as np
from numpy.typing import NDArray

#: Range of the ratio of successive differences. Below it a lucky coincidence is not believed; at its
#: upper end convergence is too slow to be summed, and the estimate says that it is large.
RATIO = (0.28, 0.9)

#: Share of the largest first difference below which a state's own is not believed.
TYPICAL = 0.25

#: The ratio of successive differences is not quite constant; this covers it.
SAFETY = 2.0


def remaining(first: NDArray, second: NDArray, sample: tuple[NDArray, NDArray]) -> NDArray[np.float64]:
    """What is left of the errors after two successive differences, by a geometric series.

    d₁ ρ/(1 - ρ), with ``SAFETY``. A state's own ratio ρ = d₁/d₀ shows where its singularity is too strong
    for the degree; but its first difference may happen to vanish, so that it is not taken for smaller
    than a share ``TYPICAL`` of the sample's largest, nor ρ for smaller than the sample's.

    Args:
        first, second: successive differences of each state, (states,).
        sample: the same of states that stand for all of them.

    Returns:
        Errors of the last degree, (states,).
    """
    largest = max(sample[0].max(), np.finfo(float).tiny)
    common = sample[1].max() / largest
    own = second / np.maximum(first, TYPICAL * largest)
    ρ = np.clip(np.maximum(common, own), *RATIO)
    return SAFETY * second * ρ / (1.0 - ρ)
