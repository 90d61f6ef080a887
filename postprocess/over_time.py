"""What is read off contact forces that change in time: centre of the pressure, and K_I at both ends."""

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray
from scipy.special import eval_jacobi, gammaln, roots_jacobi, xlogy

#: Moments of the pressure that elements tell, over their degree: what they are tested with has to be held
#: by them, too. And how many fewer polynomials the smooth factor has: a wave that runs little faster than
#: the punch is short under it.
_MOMENTS, _FEWER = 2.5, 4
#: Points that give moments of r log r.
_POINTS = 400


@dataclass(frozen=True)
class Told:
    """Of nodal forces at several times, (times,) each.

    Attributes:
        load: over N.
        centre: of the pressure over a.
        K_left, K_right: normalised intensities at X = -a and X = a over the final load, by the exponents
            of steady motion.
    """

    load: NDArray[np.float64]
    centre: NDArray[np.float64]
    K_left: NDArray[np.float64]
    K_right: NDArray[np.float64]


def told(X: NDArray, forces: NDArray, α: float, β: float, degree: int) -> Told:
    """What consistent nodal forces of σ_YY say; tested with smooth functions they give its moments.

    Args:
        X: contact nodes over a, (nodes,).
        forces: over N/2, (times, nodes), ∫σ_YY = -2 where all of the load is there.
        α, β: exponents of the pressure at X = a and X = -a, α + β = -1.
        degree: of the elements.
    """
    moments = ceil(_MOMENTS * degree)
    polynomials = moments - _FEWER
    a = forces @ _tests(X, α, β, moments)
    with np.errstate(
        invalid="ignore", divide="ignore"
    ):  # SciPy divides 0 by 0 where α + β = -1, and replaces that
        r, w = roots_jacobi(_POINTS, α, β)
    known = np.column_stack([np.eye(moments, polynomials), _tests(r, α, β, moments).T @ (w * _logs(r)).T])
    factors = np.linalg.lstsq(known, a.T, rcond=None)[0]
    ends = np.array([-1.0, 1.0])
    left, right = -0.5 * np.column_stack([_tests(ends, α, β, polynomials), _logs(ends).T]) @ factors
    total = forces.sum(axis=1)
    return Told(-total / 2.0, (forces @ X) / total, left, right)


def _tests(X: NDArray, α: float, β: float, count: int) -> NDArray[np.float64]:
    """Jacobi's polynomials with unit weighted squares, (points, count)."""
    return np.asarray(
        eval_jacobi(np.arange(count), α, β, X[:, None]) / np.exp(0.5 * _squares(α, β, count))
    )


def _logs(X: NDArray) -> NDArray[np.float64]:
    """r log r of the distances from both ends, (2, points): what inertia adds there."""
    return np.array([xlogy(r, r) for r in (1.0 + X, 1.0 - X)])


def _squares(α: float, β: float, count: int) -> NDArray[np.float64]:
    """Logarithm of ∫ w P_j² where α + β = -1."""
    j = np.arange(1, count)
    first = gammaln(α + 1.0) + gammaln(β + 1.0)
    rest = gammaln(j + α + 1.0) + gammaln(j + β + 1.0) - gammaln(j + 1.0) - gammaln(j) - np.log(2.0 * j)
    return np.concatenate([[first], rest])
