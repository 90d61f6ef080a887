"""Pressures that change fast towards the ends of the contact, as over thin layers, from moments.

Without its weight such a pressure varies over a length h next to the ends, and over the distance from the
end farther away. In

    ζ = [asinh((1 + r)/h) - asinh((1 - r)/h)]/asinh(2/h)

it is smooth all over, and few Chebyshev polynomials of ζ follow it, whatever h is.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.postprocess.pressure import JacobiPressure, chebyshev
from galinx.solvers.layers.panelled import Panels

#: Longest panel of the rule for products of polynomials, over 1 and over h.
_FINE = 0.3


@dataclass(frozen=True)
class Stretch:
    """ζ of a length h over a."""

    h: float

    def __call__(self, r: ArrayLike) -> NDArray[np.float64]:
        r = np.asarray(r, dtype=float)
        found = np.arcsinh((1.0 + r) / self.h) - np.arcsinh((1.0 - r) / self.h)
        return np.asarray(np.clip(found / np.arcsinh(2.0 / self.h), -1.0, 1.0))


@dataclass(frozen=True)
class StretchedPressure(JacobiPressure):
    """σ_YY/(N/2a) = (1 - r)^α (1 + r)^β Σ c_k T_k(ζ(r)) of several states."""

    stretch: Stretch = Stretch(1.0)

    def factor(self, r: NDArray) -> NDArray[np.float64]:
        return np.asarray(self.c @ chebyshev(self.stretch(r), self.c.shape[1]).T)


def from_moments(moments: NDArray, α: NDArray, β: NDArray, stretch: Stretch) -> StretchedPressure:
    """Pressure that has the given moments ∫ σ_YY T_k(ζ) dr, (states, moments)."""
    c = np.empty_like(moments)
    for i, one in enumerate(moments):
        rule = Panels(float(α[i]), float(β[i]), _FINE * min(1.0, stretch.h))
        T = chebyshev(stretch(rule.t), len(one))
        c[i] = np.linalg.solve((T * rule.weights[:, None]).T @ T, one)
    return StretchedPressure(α, β, c, stretch)
