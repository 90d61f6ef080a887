"""Free ends of contacts from finite elements.

A contact between two free ends follows from solutions of a few polynomial shapes. With
v = P - v₀ prescribed from m - h to m + h, the load and the intensities K at both ends are linear in P,
and v₀ follows from the load. A half-plane has no length, so the remaining intensities are

    B(P) = ∫ h P'(m + h s) b(s) ds - 2 K(1)/N(1),        s over h from m,

where b are two functions of s alone, one for each end. By the local analysis of the ends they are
(1 - s)^β (1 + s)^α times smooth functions, α and β the exponents of a flat punch. Shapes whose slopes are
Chebyshev polynomials give the moments of b, and thereby the smooth functions. B = 0 is solved for m and h
of any profile under any load, by quadrature.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..profiles import check_reach
from . import ends
from .panelled import Panels
from .recovery import products

#: Number of shapes: two determine the factors, the third measures their error.
SHAPES = 3

#: Longest panel of the quadrature of their conditions.
_FINEST = 0.7

#: First half-width tried [m].
_FIRST = 1e-3


def heights_of_shapes(s: NDArray, count: int = SHAPES) -> NDArray[np.float64]:
    """Heights of shapes at s, (count, n), whose slopes are T_0, T_1, …, and which are 0 at s = 0."""
    T = np.polynomial.chebyshev
    return np.array([T.chebval(s, T.chebint([0.0] * k + [1.0])) for k in range(count)])


def slopes_of_shapes(profile: Any, centre: float, half_width: float, count: int) -> NDArray[np.float64]:
    """Chebyshev coefficients of a profile's slope dP/ds [m] at X = centre + half_width·s, (count,).

    Args:
        profile: shape P of the punch.
        centre, half_width: of the contact [m].
        count: number of shapes.
    """

    def slope(s: NDArray) -> NDArray[np.float64]:
        return half_width * np.asarray(profile.slope(centre + half_width * s), dtype=float)

    return np.polynomial.chebyshev.chebinterpolate(slope, count - 1)  # type: ignore[arg-type]


def free_ends(local: Any, K: NDArray[np.float64], N: NDArray[np.float64]) -> "list[EndConditions]":
    """Conditions on both free ends of a contact, for each state's friction.

    Args:
        local: exponents α and β of a flat punch, (states,) each.
        K: intensities at both ends under a flat punch at v = -1 and under ``SHAPES`` shapes,
            (states, 2, 1 + shapes).
        N: loads under the same punches, (states, 1 + shapes).
    """
    share = K[..., :1] / N[:, None, :1]
    moments, constants = (K - share * N[:, None])[..., 1:], 2.0 * share[..., 0]
    return [
        EndConditions(*condition)
        for condition in zip(local.α.tolist(), local.β.tolist(), moments, constants)
    ]


@dataclass(frozen=True)
class EndConditions:
    """Conditions on both free ends of a contact at one friction and one speed.

    Attributes:
        α, β: exponents of a flat punch at the right and at the left end.
        moments: B without its constant part, of every shape at both ends, (2, ``SHAPES``).
        constants: 2 K(1)/N(1) at both ends, (2,).
    """

    α: float
    β: float
    moments: NDArray[np.float64]
    constants: NDArray[np.float64]

    @cached_property
    def factors(self) -> NDArray[np.float64]:
        """Chebyshev coefficients of the smooth factors of two combinations of b, (2, ``SHAPES``).

        The first combination is that in which 2 K(1)/N(1) of both ends cancels; it vanishes where the
        ends are in balance. The second gives the load that a contact carries.
        """
        c = np.linalg.solve(products(self.β, self.α, SHAPES), self.moments.T).T
        r = self.constants / (self.constants @ self.constants)
        lean = np.array([-r[1], r[0]]) @ c
        return np.array([lean / lean[0], r @ c])

    @property
    def unseen(self) -> float:
        """Relative size of the coefficients beyond the first two, which are 0 for a half-plane."""
        return float((np.abs(self.factors[:, 2:]).sum(axis=1) / np.abs(self.factors).max(axis=1)).max())

    def solve(
        self, profile: Any, unit: float, start: tuple[float, float] | None = None
    ) -> tuple[float, float]:
        """Middle and half-width of the contact [m], at which both conditions are satisfied.

        Args:
            profile: shape of the punch.
            unit: N/(2μ) [m].
            start: middle and half-width [m] of a similar contact; None without any.

        Raises:
            SolveError: no contact satisfies the conditions, or it reaches beyond the given profile.
        """
        m, h = start or (None, _FIRST)
        m, h = ends.free_ends(ends.Punch(profile, 1.0, 2.0 * unit), lambda _: self._rule, h, m)
        check_reach(profile, m - h, m + h, "finite elements found a contact")
        return m, h

    def _rule(self, kinks: tuple[float, ...]) -> tuple[NDArray, NDArray, NDArray]:
        """Quadrature of both conditions, see :data:`.ends.Rule`."""
        panels = Panels(self.β, self.α, _FINEST, kinks)
        lifting, carrying = np.polynomial.chebyshev.chebval(panels.t, self.factors.T) * panels.weights
        return panels.t, lifting, 2.0 * carrying
