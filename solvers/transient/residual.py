"""Residual of a motion in time in its integral equation, by steps and tests that it was not computed by.

The pressure's coefficients are interpolated to the stages of fewer steps, and the displacements that they
cause then are tested with more polynomials than the pressure has. Against the indentation these show what
steps, polynomials or a wrong number of the solution leave.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..solids.half_plane import HalfPlane
from .march import Radau
from .transform import Basis, Transformed

#: Steps over those of the solution, and polynomials of the tests besides as many as the pressure has.
_STEPS, _MORE = 0.7, 8


class Residual:
    """Residuals of motions at one speed.

    Args:
        response: of steady motion at that speed.
        rayleigh: speed of the wave along the surface over c_s.
        t: times over a/c_s of the solution, > 0, equal steps apart, (times,).
        terms: polynomials of the pressure.
        way: ±1, in which the punch moves along X.
    """

    def __init__(
        self, response: HalfPlane, rayleigh: float, t: NDArray, terms: int, way: int = 1
    ) -> None:
        self._response, self._t, self._terms = response, np.append(0.0, t), terms
        self._scheme = Radau(float(t[-1]), max(round(_STEPS * len(t)), 1))
        self._transformed = Transformed(response, rayleigh, self._scheme.s, terms, way=way)

    def of(self, bases: Sequence[Basis], a: NDArray, v0: NDArray) -> float:
        """Largest tested displacement under the punch besides its indentation, over the largest of that.

        Args:
            bases: polynomials of the pressure.
            a: coefficients of their σ_YY, less those before t = 0, (times, bases·terms).
            v0: indentation since t = 0, (times,).
        """
        # The mean of their frictions changes sign in the mirror image, as they do.
        g = float(np.mean([basis.g for basis in bases]))
        tests = Basis(self._response, g, self._terms + _MORE).tests
        rows = np.concatenate([self._transformed.sinking(basis, tests) for basis in bases], axis=2)
        v = self._scheme.answered(rows, self._interpolated(a, self._scheme.times))
        v[:, 0] += tests.integral * self._interpolated(v0, self._scheme.times[:, -1])
        largest = float(np.linalg.norm(v, axis=1).max())
        return largest / max(tests.integral * float(np.abs(v0).max()), np.finfo(float).tiny)

    def _interpolated(self, values: NDArray, t: NDArray) -> NDArray[np.float64]:
        """Values (times, ...), 0 at t = 0, at other times."""
        from scipy.interpolate import CubicSpline  # a slow import

        return np.asarray(CubicSpline(self._t, np.concatenate([0.0 * values[:1], values]))(t))
