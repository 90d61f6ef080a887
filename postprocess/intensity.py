"""Is a pressure singular at an end of the contact? Told from that end's neighbourhood alone.

Jacobi moments over the whole contact converge slowly where the pressure has a logarithm inside, at a kink
of the punch's slope. So the pressure between the end and the nearest kink is expanded, with a weight
that vanishes at the kink like a power: what is not smooth there is hardly seen.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.special import eval_jacobi, gammaln

#: Power of the weight at the kink, and terms of the expansion.
POWER, TERMS = 8, 12


def end_intensity(r: NDArray, kink: float, exponent: float, terms: int = TERMS) -> NDArray[np.float64]:
    """What multiplies nodal forces to give the limit of σ_YY/(1 - ρ)^α at the right end.

    Args:
        r: positions of the nodes over a, (n,); with a minus sign for the left end.
        kink: position of the nearest kink, on the same axis; -1 for none.
        exponent: α, in (-1, 0).
        terms: of the expansion; fewer tell how good it is.

    Returns:
        (n,), in the coordinate ρ that is -1 at the kink and 1 at the end.
    """
    ρ = np.clip(2.0 * (r - kink) / (1.0 - kink) - 1.0, -1.0, 1.0)
    n = np.arange(terms)
    α, q = exponent, float(POWER)
    logs = (
        (α + q + 1.0) * np.log(2.0) - np.log(2.0 * n + α + q + 1.0)
        + gammaln(n + α + 1.0) + gammaln(n + q + 1.0) - gammaln(n + 1.0) - gammaln(n + α + q + 1.0)
    )  # fmt: skip
    at_end = eval_jacobi(n, α, q, 1.0) / np.exp(logs)
    return (1.0 + ρ) ** POWER * (eval_jacobi(n, α, q, ρ[:, None]) @ at_end)
