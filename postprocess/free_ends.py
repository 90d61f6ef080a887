"""Where a contact between two free ends ends, from solutions of a few polynomial shapes.

With v = P - v₀ held from m - h to m + h the load and the intensities K at both ends are linear in P, and
v₀ follows from the load. A half-plane has no length, so what is then left of the intensities is

    B(P) = ∫ h P'(m + h s) b(s) ds - 2 K(1)/N(1),        s over h from m,

where b are two functions of s alone. By the local analysis of the ends they are (1 - s)^β (1 + s)^α times
smooth ones, α and β the exponents of a flat punch; shapes whose slopes are Chebyshev polynomials give the
moments of b, and thereby these. B = 0 is solved for m and h of any profile under any load, by quadrature.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from galinx.postprocess.pressure import jacobi_in_chebyshev, jacobi_norms
from galinx.solvers.errors import SolveError
from galinx.solvers.profiles import check_reach, kinks

#: Shapes: of two the factors would be known, the third says how good they are.
SHAPES = 3

#: Gauss points of a panel; sizes of panels towards a kink and towards an end, over the next larger one's.
_POINTS, _RATIO, _TO_KINK, _TO_END = 14, 0.2, 11, 3

#: First half-width that is tried [m], doublings of it, and of the middle over it; halvings.
_FIRST, _DOUBLINGS, _FARTHER, _HALVINGS = 1e-3, 100, 12, 12
#: Steps of Newton's method, the largest of m/h and of log h, difference for derivatives; residuals that
#: are met, and those that are rounding.
_STEPS, _LARGEST, _ε, _MET, _ROUNDING = 60, 0.4, 1e-5, 1e-14, 1e-11


def heights_of_shapes(s: NDArray, count: int = SHAPES) -> NDArray[np.float64]:
    """Shapes whose slopes are T_0, T_1, …, and which are 0 at s = 0, at s, (count, n)."""
    T = np.polynomial.chebyshev
    return np.array([T.chebval(s, T.chebint([0.0] * k + [1.0])) for k in range(count)])


def slopes_of_shapes(profile: Any, centre: float, half_width: float, count: int) -> NDArray[np.float64]:
    """How much of each of so many shapes a profile is: dP/ds [m] at centre + half_width·s, (count,)."""
    s = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    slope = half_width * np.asarray(profile.slope(centre + half_width * s), dtype=float)
    T = np.cos(np.outer(np.arange(count), np.arccos(s)))
    found = 2.0 / count * (T @ slope)
    found[0] /= 2.0
    return found


def free_ends(local: Any, K: NDArray[np.float64], N: NDArray[np.float64]) -> "list[FreeEnds]":
    """The conditions of some frictions.

    Args:
        local: exponents α and β of a flat punch, (states,) each.
        K: intensities at both ends, of the flat punch at v = -1 and of ``SHAPES`` shapes,
            (states, 2, parts).
        N: loads of these, (states, parts).
    """
    share = K[..., :1] / N[:, None, :1]
    moments, wanted = (K - share * N[:, None])[..., 1:], 2.0 * share[..., 0]
    return [FreeEnds(*one) for one in zip(local.α.tolist(), local.β.tolist(), moments, wanted)]


@dataclass(frozen=True)
class FreeEnds:
    """The conditions of one friction at one speed.

    Attributes:
        α, β: exponents of a flat punch at the right and at the left end.
        moments: B without its constant part, of every shape at both ends, (2, ``SHAPES``).
        wanted: 2 K(1)/N(1) at both ends, (2,).
    """

    α: float
    β: float
    moments: NDArray[np.float64]
    wanted: NDArray[np.float64]

    @cached_property
    def factors(self) -> NDArray[np.float64]:
        """Chebyshev coefficients of smooth factors, (2, ``SHAPES``): of the combination of both ends that
        does not know the load, and of the one that is 1 under it."""
        known = np.s_[0, :SHAPES, :SHAPES]
        ends = np.array([self.β]), np.array([self.α])
        P, norms = jacobi_in_chebyshev(*ends)[known], jacobi_norms(*ends)[0, :SHAPES]
        c = (self.moments @ P.T / norms) @ P
        r = self.wanted / (self.wanted @ self.wanted)
        lean = np.array([-r[1], r[0]]) @ c
        return np.array([lean / lean[0], r @ c])

    @property
    def unseen(self) -> float:
        """What is left beyond the first two coefficients, relative: of a half-plane nothing is."""
        return float((np.abs(self.factors[:, 2:]).sum(axis=1) / np.abs(self.factors).max(axis=1)).max())

    def found(
        self, profile: Any, unit: float, start: tuple[float, float] | None = None
    ) -> tuple[float, float]:
        """Middle and half-width of the contact [m].

        Args:
            profile: of the punch.
            unit: N/(2μ) [m].
            start: middle and half-width near by.

        Raises:
            SolveError: there is none, or it reaches beyond what is known of the punch.
        """
        point = self._first(profile, unit) if start is None else np.array(start) / [start[1], 1.0]
        point[1] = np.log(point[1])
        value = self._residual(profile, unit, point)
        for _ in range(_STEPS):
            size = np.abs(value).max()
            if size <= _MET:
                break
            step = self._newton(profile, unit, point, value)
            moved = point + step
            after = self._residual(profile, unit, moved)
            while not np.abs(after).max() < size and np.abs(step).max() > _MET:
                step /= 2.0
                moved = point + step
                after = self._residual(profile, unit, moved)
            if not np.abs(after).max() < size:
                break
            point, value = moved, after
        if not np.abs(value).max() <= _ROUNDING:
            if start is not None:
                return self.found(profile, unit)
            raise SolveError(
                f"finite elements did not find the ends of the contact of a {profile.words()}: its "
                f"conditions are left at {np.abs(value).max():.3g}, wanted {_ROUNDING:g}"
            )
        h = float(np.exp(point[1]))
        left, right = (float(point[0]) - 1.0) * h, (float(point[0]) + 1.0) * h
        check_reach(profile, left, right, "finite elements found a contact")
        return float(point[0]) * h, h

    def _newton(self, profile: Any, unit: float, point: NDArray, value: NDArray) -> NDArray[np.float64]:
        J = np.empty((2, 2))
        for i, d in enumerate(np.eye(2) * _ε):
            after, before = (self._residual(profile, unit, point + sign * d) for sign in (1.0, -1.0))
            J[:, i] = (after - before) / (2.0 * _ε)
        if not np.all(np.isfinite(J)) or abs(np.linalg.det(J)) < 1e-12:
            return np.array([0.0, 0.1])
        step = np.linalg.solve(J, -value)
        return step / max(1.0, np.abs(step).max() / _LARGEST)

    def _residual(self, profile: Any, unit: float, point: NDArray) -> NDArray[np.float64]:
        """Both conditions at m/h and log h, 0 where they are met; infinite where nothing is carried."""
        lifted, carried = self._conditions(profile, unit, float(point[0]), float(np.exp(point[1])))
        return np.array([lifted, np.log(carried) if carried > 0.0 else np.inf])

    def _conditions(self, profile: Any, unit: float, lean: float, h: float) -> tuple[float, float]:
        """How far the ends are from balance, over what they could be, and the load over that wanted."""
        at = np.array(kinks(profile), dtype=float) / h - lean
        s, weights = _rule(at[np.abs(at) < 1.0], self.α, self.β)
        slope = np.asarray(profile.slope(h * (lean + s)), dtype=float)
        factors = np.polynomial.chebyshev.chebval(s, self.factors.T)
        lifted, carried = (factors * weights) @ slope
        whole = (factors[0] * weights) @ np.abs(slope)
        return float(lifted / whole) if whole > 0.0 else 0.0, float(h * carried / unit)

    def _first(self, profile: Any, unit: float) -> NDArray[np.float64]:
        """A contact that carries about the load: m/h and h."""
        h, narrow, wide = _FIRST, 0.0, np.inf
        for _ in range(_DOUBLINGS):
            lean = self._lean(profile, unit, h)
            carried = self._conditions(profile, unit, lean, h)[1]
            if 0.2 < carried < 5.0:
                return np.array([lean, h])
            narrow, wide = (h, wide) if carried < 1.0 else (narrow, h)
            h = 2.0 * narrow if np.isinf(wide) else wide / 2.0 if not narrow else np.sqrt(narrow * wide)
        raise SolveError(
            f"no contact of a {profile.words()} carries the load: half-widths up to {h:.3g} m were "
            "tried; the profile has to be convex"
        )

    def _lean(self, profile: Any, unit: float, h: float) -> float:
        """m/h at which the ends are in balance, roughly; in the middle of such places in a flat part."""
        far = 1.0
        while far < 2.0**_FARTHER and not (
            self._conditions(profile, unit, -far, h)[0] < 0.0 < self._conditions(profile, unit, far, h)[0]
        ):
            far *= 2.0
        edges = []
        for below in (np.less, np.less_equal):
            low, high = -far, far
            for _ in range(_HALVINGS):
                middle = (low + high) / 2.0
                below_it = below(self._conditions(profile, unit, middle, h)[0], 0.0)
                low, high = (middle, high) if below_it else (low, middle)
            edges.append((low + high) / 2.0)
        return float(np.mean(edges))


@lru_cache(maxsize=64)
def _towards(exponent: float, panels: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points in [0, 1] and weights of ∫ t^exponent F(t) dt, finer and finer towards 0."""
    τ, w = np.polynomial.legendre.leggauss(_POINTS)
    x = (τ + 1.0) / 2.0
    ends = _RATIO ** np.arange(panels + 1)
    t = ends[1:, None] + (ends[:-1] - ends[1:])[:, None] * x
    weights = (ends[:-1] - ends[1:])[:, None] * w / 2.0 * t**exponent
    inner, of_inner = roots_jacobi(_POINTS, 0.0, exponent)
    size = ends[-1]
    t = np.append(t.ravel(), size * (inner + 1.0) / 2.0)
    return t, np.append(weights.ravel(), of_inner * (size / 2.0) ** (exponent + 1.0))


def _rule(at: NDArray, α: float, β: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points and weights of ∫ (1 - s)^β (1 + s)^α F(s) ds, F smooth between the places ``at``."""
    places = np.concatenate([[-1.0], np.unique(at), [1.0]])
    last, s, weights = len(places) - 2, [], []
    for i, half in enumerate(np.diff(places) / 2.0):
        for x, sign, exponent in ((places[i], 1.0, α * (i == 0)), (places[i + 1], -1.0, β * (i == last))):
            t, w = _towards(exponent, _TO_END if exponent else _TO_KINK)
            points = x + sign * half * t
            w = w * half ** (exponent + 1.0)
            right = 1.0 if exponent and sign < 0.0 else (1.0 - points) ** β
            left = 1.0 if exponent and sign > 0.0 else (1.0 + points) ** α
            s.append(points)
            weights.append(w * left * right)
    return np.concatenate(s), np.concatenate(weights)
