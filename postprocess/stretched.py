"""Pressures that change fast towards the ends of the contact, as over thin layers, from moments.

Without its weight such a pressure varies over a length h next to the ends, and over the distance from the
end farther away. In

    ζ = [asinh((1 + r)/h) - asinh((1 - r)/h)]/asinh(2/h)

it is smooth all over, and few Chebyshev polynomials of ζ follow it, whatever h is. Under a solid that is
graded from the surface on it has terms dⁿ logᵐ d, 1 <= m <= n, of the distance d from an end besides,
which no polynomial follows; the first of them, of u = d/(d + h/4) for d, stand before these. Where
constants change much within h the powers left out fall slowly with the number of functions, and the last
of these tell what they add to the intensities.
"""

from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.postprocess.pressure import JacobiPressure, chebyshev
from galinx.solvers.layers.panelled import Panels

#: Longest panel of the rule for products of polynomials, over 1 and over h.
_FINE = 0.3
#: Polynomials that tell how well a pressure is resolved, and over graded solids, where what is left falls
#: like a power of their number.
_LAST, _LAST_GRADED = 2, 4
#: What is left there over what these add, measured on layers whose moduli grow three to a hundred times.
_TAIL = 4.0
#: Highest power of the distance from an end that stands before polynomials with its logarithms.
_POWERS = 3
#: Share of h beyond which these are nearly constant: the larger it is, the more nearly functions depend
#: on one another.
_SHARE = 0.25
#: Functions of both ends.
_OF_ENDS = _POWERS * (_POWERS + 1)
#: How often functions are made orthonormal: rounding leaves them so but for a share the first time.
_TIMES = 2


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
        with np.errstate(divide="ignore"):
            x = np.log1p(r) - np.log1p(-r)
        return _rule(-0.5, -0.5, self).values(_orthonormal(self, count), x)

    def of_ends(self, r: NDArray, count: int) -> NDArray[np.float64]:
        """What belongs to the ends, then polynomials: nearly dependent."""
        found = []
        for d in (1.0 - r, 1.0 + r):
            d = np.maximum(d, 0.0)
            u = d / (d + _SHARE * self.h)
            log = np.log(np.maximum(u, np.finfo(float).tiny))
            found += [u**n * log**m for n in range(1, _POWERS + 1) for m in range(1, n + 1)]
        return np.column_stack([*found, chebyshev(self(r), count)])

    def polynomials(self, functions: int) -> int:
        """How many of these functions are polynomials."""
        return functions - _OF_ENDS * self.graded


@cache
def _orthonormal(stretch: Stretch, count: int) -> NDArray[np.float64]:
    """Combinations of a graded solid's functions that are orthonormal under the weight of no friction.

    The functions depend on one another nearly, and what rounds their combinations is different at every
    place. So combinations are those polynomials on panels that have these values at the rule's points,
    wherever they are asked for: pressure and tests then know the same functions.

    Returns:
        Values at the points of the rule, (points, functions).
    """
    rule = _rule(-0.5, -0.5, stretch)
    f, root = stretch.of_ends(rule.t, count), np.sqrt(rule.weights)[:, None]
    for _ in range(_TIMES):
        f = f @ np.linalg.inv(np.linalg.qr(f * root, mode="r"))
    return np.asarray(f)


@dataclass(frozen=True)
class StretchedPressure(JacobiPressure):
    """σ_YY/(N/2a) = (1 - r)^α (1 + r)^β Σ c_k f_k(r) of several states, f of :class:`Stretch`."""

    stretch: Stretch = Stretch(1.0)

    def factor(self, r: NDArray) -> NDArray[np.float64]:
        count = self.stretch.polynomials(self.c.shape[1])
        return np.asarray(self.c @ self.stretch.functions(r, count).T)

    @property
    def unresolved(self) -> NDArray[np.float64]:
        """The last functions' share of the factor at the ends, of the larger one, (states,)."""
        ends, last = np.array([-1.0, 1.0]), _LAST_GRADED if self.stretch.graded else _LAST
        f = self.stretch.functions(ends, self.stretch.polynomials(self.c.shape[1]))
        added = np.abs(self.c[:, None, -last:] * f[:, -last:]).sum(axis=2)
        share = added.max(axis=1) / np.abs(self.factor(ends)).max(axis=1)
        return np.asarray((_TAIL if self.stretch.graded else 1.0) * share)


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
