"""Pressures that change fast towards the ends of the contact, as over thin layers, from moments.

Without its weight such a pressure varies over a length h next to the ends, and over the distance from the
end farther away. In

    ζ = [asinh((1 + r)/h) - asinh((1 - r)/h)]/asinh(2/h)

it is smooth all over, and few Chebyshev polynomials of ζ follow it, whatever h is. Under a solid that is
graded from the surface on it has terms d log d, d² log d and d² log² d of the distance d from an end
besides, which no polynomial follows; they stand before these.
"""

from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.postprocess.pressure import JacobiPressure, chebyshev
from galinx.solvers.layers.panelled import Panels

#: Longest panel of the rule for products of polynomials, over 1 and over h.
_FINE = 0.3
#: Polynomials that tell how well a pressure is resolved.
_LAST = 2


@dataclass(frozen=True)
class Stretch:
    """Functions that follow a pressure without its weight.

    Attributes:
        h: length over a.
        graded: is the solid graded from the surface on?
    """

    h: float
    graded: bool = False

    def __call__(self, r: ArrayLike) -> NDArray[np.float64]:
        """ζ."""
        r = np.asarray(r, dtype=float)
        found = np.arcsinh((1.0 + r) / self.h) - np.arcsinh((1.0 - r) / self.h)
        return np.asarray(np.clip(found / np.arcsinh(2.0 / self.h), -1.0, 1.0))

    def functions(self, r: NDArray, count: int) -> NDArray[np.float64]:
        """So many polynomials of ζ, after what belongs to the ends, (len(r), functions)."""
        if not self.graded:
            return chebyshev(self(r), count)
        return np.asarray(self.of_ends(r, count) @ _to_orthonormal(self, count))

    def of_ends(self, r: NDArray, count: int) -> NDArray[np.float64]:
        """What belongs to the ends, then polynomials: nearly dependent."""
        found = []
        for d in ((1.0 - r) / 2.0, (1.0 + r) / 2.0):
            d = np.clip(d, 0.0, 1.0)
            log = np.log(np.maximum(d, np.finfo(float).tiny))
            found += [d * log, d**2 * log, d**2 * log**2]
        return np.column_stack([*found, chebyshev(self(r), count)])

    def polynomials(self, functions: int) -> int:
        """How many of these functions are polynomials."""
        return functions - 6 * self.graded


@cache
def _to_orthonormal(stretch: Stretch, count: int) -> NDArray[np.float64]:
    """Combinations of a graded solid's functions that are orthonormal under the weight of no friction.

    Moments are taken with these: the functions themselves depend on one another so nearly that what
    rounds their moments would be seen in the pressure.
    """
    rule = _rule(-0.5, -0.5, stretch)
    f = stretch.of_ends(rule.t, count) * np.sqrt(rule.weights)[:, None]
    return np.asarray(np.linalg.inv(np.linalg.qr(f, mode="r")))


@dataclass(frozen=True)
class StretchedPressure(JacobiPressure):
    """σ_YY/(N/2a) = (1 - r)^α (1 + r)^β Σ c_k f_k(r) of several states, f of :class:`Stretch`."""

    stretch: Stretch = Stretch(1.0)

    def factor(self, r: NDArray) -> NDArray[np.float64]:
        count = self.stretch.polynomials(self.c.shape[1])
        return np.asarray(self.c @ self.stretch.functions(r, count).T)

    @property
    def unresolved(self) -> NDArray[np.float64]:
        """The last polynomials' share, relative to the largest of the factor at the ends, (states,)."""
        last = np.abs(self.c[:, -_LAST:]).sum(axis=1)
        return np.asarray(last / np.abs(self.factor(np.array([-1.0, 1.0]))).max(axis=1))


def from_moments(moments: NDArray, α: NDArray, β: NDArray, stretch: Stretch) -> StretchedPressure:
    """Pressure that has the given moments ∫ σ_YY f_k dr, (states, moments)."""
    c, f = np.empty_like(moments), _at_points(stretch, moments.shape[1])
    for i, one in enumerate(moments):
        weights = _rule(float(α[i]), float(β[i]), stretch).weights
        c[i] = np.linalg.solve((f * weights[:, None]).T @ f, one)
    return StretchedPressure(α, β, c, stretch)


def _rule(α: float, β: float, stretch: Stretch) -> Panels:
    """For products of functions under the weight of these exponents; all have the same points."""
    return Panels(α, β, _FINE * min(1.0, stretch.h))


@lru_cache(maxsize=8)
def _at_points(stretch: Stretch, count: int) -> NDArray[np.float64]:
    """So many functions at the points of the rule, (points, count)."""
    return stretch.functions(_rule(-0.5, -0.5, stretch).t, stretch.polynomials(count))
