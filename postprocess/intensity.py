"""A pressure near the ends of the contact, from there alone: is it singular, how does it fall?

Jacobi moments over the whole contact converge slowly where the pressure has a logarithm inside, at a kink
of the punch's slope. So the pressure between the end and the nearest kink is expanded, with a weight
that vanishes at the kink like a power: what is not smooth there is hardly seen.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.special import eval_jacobi, gammaln

#: Power of the weight at the kink, and terms of the expansion.
POWER, TERMS = 8, 12


#: Distances from an end, over that of the nearest kink, between which its pressure is looked at; places
#: there, and the degree of the polynomial through them.
_LOOKED_AT, _PLACES, _DEGREE = (0.02, 0.25), 12, 5


def places_at_end(gap: float) -> NDArray[np.float64]:
    """Distances over a from an end at which the pressure tells how it falls to it, growing.

    Args:
        gap: distance of the nearest kink, or of the other end.
    """
    near, far = (share * min(gap, 1.0) for share in _LOOKED_AT)
    t = np.cos(np.pi * (2.0 * np.arange(_PLACES)[::-1] + 1.0) / (2.0 * _PLACES))
    return (near + far) / 2.0 + (far - near) / 2.0 * t


def towards_end(d: NDArray, known: NDArray, σ_YY: NDArray, exponent: float) -> NDArray[np.float64]:
    """A pressure d^a times a smooth function, nearer to the end than where it is known.

    Args:
        d: distances that are wanted, over a.
        known: those of :func:`places_at_end`.
        σ_YY: at these.
        exponent: a, at the free end.
    """
    smooth = np.polynomial.Chebyshev.fit(known, σ_YY / known**exponent, _DEGREE)
    return d**exponent * smooth(d)


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
