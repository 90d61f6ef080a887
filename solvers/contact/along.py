"""Flat punch on a uniform half-plane whose friction varies along the contact: closed form.

With g(X) = σ_XY/σ_YY, N̂ = n + g n₁₂ and τ = N̂ σ_YY the integral equation is

    H[τ] - cot(πα) τ = 0,   cot πα(X) = g q/N̂,   -1 < α < 0,

and its solution, with H[τ] = cot(πα) τ below the punch and A e^E/(1 + X) beside it,

    τ = A sin(πα) e^E/(1 + X),   E(X) = ⨍ α(t)/(t - X) dt.

Next to the ends it goes with α(1) and β = -1 - α(-1). The transform of σ_XY differs from g times that of
σ_YY by the regular integral C = (1/π) ∫ (g(t) - g(X)) σ_YY(t)/(t - X) dt; E less its logarithms is such
an integral, too.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import xlogy

from ..friction.along import Along, constant
from ..solids.half_plane import HalfPlane
from .edges import EdgeExponents, from_edge, under_punch
from .panels import Panels, stretched
from .pressure import ENDS, Expansion, Functions, Pressure
from .residual import Rule

#: Distance from an end within which the pressure less its power is that of the end; distance of places,
#: over that from the ends, at which a quotient is a derivative, and the step of that.
_NEXT_TO_END, _SAME, _STEP = 1e-13, 1e-9, 1e-6
#: Longest panel of a pressure by its values, and number of those towards kinks of friction.
_LONGEST, _TO_KINKS = 0.5, 12
#: Integrals that are held in memory at once.
_AT_ONCE = 500


class Varying(Pressure):
    """Pressure of one state whose friction varies along the contact.

    Attributes:
        friction: σ_XY/σ_YY over X/a.
    """

    friction: Along

    def _transforms(self, r: NDArray) -> tuple[NDArray, NDArray]:
        """H[σ_YY] and H[σ_XY] beyond the product with σ_XY/σ_YY, at r (n,): (n,) each."""
        raise NotImplementedError

    def transforms(self, g: Any, r: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        shape = np.atleast_2d(r).shape
        H, C = self._transforms(r.ravel())
        return self.friction(r).reshape(shape), H.reshape(shape), C.reshape(shape)

    def ratios(self, g: NDArray, t: NDArray) -> tuple[NDArray, NDArray]:
        return np.ones_like(g), self.friction(t)


@dataclass(frozen=True)
class FlatAlong(Varying):
    """Pressure of a flat punch with friction that varies along the contact, at one speed.

    Attributes:
        response: of the half-plane at that speed.
        friction: σ_XY/σ_YY over X/a.
    """

    response: HalfPlane
    friction: Along

    def _local(self, r: NDArray) -> EdgeExponents:
        """Exponents of sharp edges with the friction at r."""
        return EdgeExponents(self.response, self.friction(r))

    @cached_property
    def α(self) -> float:  # type: ignore[override]
        return float(self._local(np.ones(1)).α[0])

    @cached_property
    def β(self) -> float:  # type: ignore[override]
        return float(self._local(-np.ones(1)).β[0])

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return self._amplitude * self._shape(r.ravel()).reshape(r.shape)

    def _shape(self, r: NDArray) -> NDArray[np.float64]:
        """Pressure without its weight and amplitude, (n,)."""
        return np.asarray(self._local(r)._sin / self._compliance(r) * np.exp(self._bounded(r)))

    def _compliance(self, r: NDArray) -> NDArray[np.float64]:
        """N̂ = n + g n₁₂ at r."""
        return np.asarray(self.response.n + self.friction(r) * self.response.n12)

    def _bounded(self, r: NDArray) -> NDArray[np.float64]:
        """E without its logarithms of the distances from both ends, (n,)."""
        at = np.where(np.abs(np.abs(r) - 1.0) < _NEXT_TO_END, np.sign(r), r)
        α, none = self._local(at).α, np.zeros(1)
        E = self._divided(lambda t: self._local(t).α, at, self.rule.weights(none, none)[0])
        # At an end the factor of its logarithm is 0, but for rounding.
        right, left = (np.log(np.maximum(np.abs(1.0 - end * at), 1e-300)) for end in (1.0, -1.0))
        return np.asarray(E + (α - self.α) * right - (α + 1.0 + self.β) * left)

    @cached_property
    def rule(self) -> Rule:
        """Quadrature over the contact, graded towards kinks of friction."""
        return Rule(self.friction.jumps)

    def _divided(self, function: Callable[[NDArray], NDArray], r: NDArray, dμ: NDArray) -> NDArray:
        """∫ (f(t) - f(r))/(t - r) dμ(t) at places r, (n,)."""
        t, room = self.rule.t, np.abs(1.0 - np.abs(r))
        step = _STEP * room
        slope = (function(r + step) - function(r - step)) / (2.0 * step + np.finfo(float).tiny)
        of_t, of_r, result = function(t), function(r), np.empty(len(r))
        for first in range(0, len(r), _AT_ONCE):
            block = slice(first, first + _AT_ONCE)
            apart = t - r[block, None]
            # Next to an end positions are rounded, distances from it are not.
            for end, distance in ((1.0, -self.rule.right), (-1.0, self.rule.left)):
                apart[r[block] == end] = distance
            same = np.abs(apart) <= _SAME * room[block, None]
            quotient = (of_t - of_r[block, None]) / np.where(same, 1.0, apart)
            result[block] = np.where(same, slope[block, None], quotient) @ dμ
        return result

    @cached_property
    def _unit_forces(self) -> NDArray[np.float64]:
        """∫ σ_YY dt of each place of the rule for the amplitude 1, (n,)."""
        ends = np.array([self.α]), np.array([self.β])
        return np.asarray(self.rule.weights(*ends)[0] * self._shape(self.rule.t))

    @cached_property
    def _amplitude(self) -> float:
        return -2.0 / float(self._unit_forces.sum())

    @property
    def forces(self) -> NDArray[np.float64]:
        """∫ σ_YY dt of each place of the rule, (n,)."""
        return self._amplitude * self._unit_forces

    @property
    def resultant_ratio(self) -> float:
        """Resultant of σ_XY over that of σ_YY."""
        return float(self.forces @ self.friction(self.rule.t)) / -2.0

    @property
    def pressure_centre(self) -> float:
        """Centre of pressure over a."""
        return float(self.forces @ self.rule.t) / -2.0

    def hilbert(self, r: NDArray) -> NDArray[np.float64]:
        return self._transforms(np.asarray(r, dtype=float))[0]

    @property
    def opposed(self) -> Pressure:
        return self._on_panels.opposed

    @cached_property
    def _on_panels(self) -> "ExpansionAlong":
        """The pressure by its values, with the field below it."""
        panels = Panels(self.α, self.β, _LONGEST, self.friction.jumps, _TO_KINKS)
        return ExpansionAlong(self.α, self.β, self.series(panels.t), panels, friction=self.friction)

    def inside(self, response: Any, g: Any, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        return self._on_panels.inside(response, g, X, Y)

    def _transforms(self, r: NDArray) -> tuple[NDArray, NDArray]:
        local, C = self._local(r), self._divided(self.friction, r, self.forces) / np.pi
        with np.errstate(invalid="ignore", divide="ignore"):
            size = np.abs(1.0 - r) ** self.α * np.abs(1.0 + r) ** self.β * np.exp(self._bounded(r))
        τ = self._amplitude * size * np.where(under_punch(r), local._cot * local._sin, np.sign(r))
        τ = np.where(from_edge(r) == 0.0, np.nan, τ)
        return (τ - self.response.n12 * C) / self._compliance(r), C


class BentExpansion(Expansion):
    """Pressure that is not smooth at the kinks of its functions."""

    @property
    def kinks(self) -> tuple[float, ...]:  # type: ignore[override]
        return tuple(self.functions.kinks)


@dataclass(frozen=True)
class ExpansionAlong(Varying, BentExpansion):
    """Pressure by its values on panels with friction that varies along the contact.

    Attributes:
        friction: σ_XY/σ_YY over X/a.
    """

    friction: Along = constant(0.0)

    def ending(self, free: tuple[bool, bool]) -> "ExpansionAlong":
        r = np.outer(ENDS, [1.0, 1.0 - _STEP])
        g, at_kinks = self.friction(r), np.abs(ENDS[:, None] - self.kinks).min(axis=1, initial=1.0)
        spread = np.ptp(self.friction(self.functions.t)) or 1.0
        slope = np.abs(np.diff(g)[:, 0]) / _STEP / spread
        lengths = np.minimum(1.0 / np.maximum(slope, 1.0), at_kinks)
        c = self.functions.continued(self.c, free, tuple(lengths.tolist()))
        return replace(self, c=c, ends=free)

    @cached_property
    def _shear(self) -> NDArray[np.float64]:
        """Values of σ_XY over the weight."""
        return np.asarray(self.c * self.friction(self.functions.t))

    def _hilbert(self, c: NDArray, r: NDArray) -> NDArray[np.float64]:
        H, under, beside = self.functions.rest(c, r, 1.0), np.abs(r) < 1.0, np.abs(r) > 1.0
        x = stretched(r[under])
        of_weight = self.functions.weight(x) * self.functions.hilbert_of_weight(x)
        H[under] += self.functions.interpolated(c, x) * of_weight
        H[beside] = replace(self, c=c).at(r[beside] - 0.0j).real
        infinite = (from_edge(r) == 0.0) & np.where(r < 0.0, *~self.free)
        return np.where(infinite, np.nan, H)

    def hilbert(self, r: NDArray) -> NDArray[np.float64]:
        return self._hilbert(self.c, r)

    def _transforms(self, r: NDArray) -> tuple[NDArray, NDArray]:
        H = self.hilbert(r)
        return H, self._hilbert(self._shear, r) - self.friction(r) * H

    def inside(self, response: Any, g: Any, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        shear = replace(self, c=self._shear)
        of_shear = response.inside(shear, 1.0, X, Y) - response.inside(shear, 0.0, X, Y)
        return np.asarray(response.inside(self, 0.0, X, Y) + of_shear)

    @property
    def opposed(self) -> "ExpansionAlong":
        return replace(self, friction=self.friction.opposed)

    def strain(self, g: NDArray, kernel: Any, r: NDArray) -> NDArray[np.float64]:
        of_shear = replace(self, c=self._shear).integral(kernel, r, kernel.length)[:, 0]
        return (self.integral(kernel, r, kernel.length)[:, 1] + of_shear)[None]

    @property
    def resultant_ratio(self) -> float:
        """Resultant of σ_XY over that of σ_YY."""
        return float(self._shear @ self.functions.weights / (self.c @ self.functions.weights))

    @property
    def pressure_centre(self) -> float:
        """Centre of pressure over a."""
        forces = self.c * self.functions.weights
        return float(forces @ self.functions.t / forces.sum())


@dataclass(frozen=True)
class Splines(Functions):
    """Splines that follow a pressure without its weight where friction or a solid varies.

    Next to ends and kinks the pressure less its weight has terms like x log x, so knots gather there; at
    kinks splines are continuous only, elsewhere as smooth as they can be.

    Attributes:
        knots: positions over a, those of the ends among them.
        kinks: those at which splines are continuous only.
        degree: of the polynomials.
        logarithms: add x log x for each end, as solids have it that are graded from the surface on.
    """

    knots: tuple[float, ...]
    kinks: tuple[float, ...]
    degree: int
    logarithms: bool = False

    @cached_property
    def _knots(self) -> NDArray[np.float64]:
        """Knots as often as the splines' smoothness asks for."""
        more = [-1.0] * self.degree, list(self.kinks) * (self.degree - 1), [1.0] * self.degree
        return np.sort(np.concatenate([self.knots, *more]))

    def values(self, r: NDArray, count: int = 0) -> NDArray[np.float64]:
        if not len(r):  # SciPy takes none
            return np.empty((0, len(self._knots) - self.degree - 1 + 2 * self.logarithms))
        return np.asarray(self.sparse(r).toarray())

    def sparse(self, r: NDArray) -> Any:
        """Values at r as a sparse matrix, (points, splines): few splines are not 0 at a place."""
        from scipy.interpolate import BSpline  # slow imports
        from scipy.sparse import hstack

        splines = BSpline.design_matrix(np.clip(r, -1.0, 1.0), self._knots, self.degree)
        return hstack([splines, self._of_ends(r)], "csr") if self.logarithms else splines

    def _of_ends(self, r: NDArray) -> NDArray[np.float64]:
        """Part of x log x that is no spline, x the distance from an end over the next knot's, (n, 2).

        It is all but the first terms of the series at x = 1, and 0 beyond.
        """
        ends, next_ = np.array(self.knots)[[[0, -1], [1, -2]]]
        x = np.clip((r[:, None] - ends) / (next_ - ends), 0.0, 1.0)
        terms = (((1.0 - x) ** k) / (k * (k - 1.0)) for k in range(2, self.degree + 1))
        return np.asarray(xlogy(x, x) + (1.0 - x) - sum(terms))

    def sum(self, c: NDArray, r: NDArray) -> NDArray[np.float64]:
        return c @ self.values(np.ravel(r)).T


class FittedSplines:
    """Pressures of splines by their moments.

    Args:
        splines: as many as tests.
        nodal: their values at the nodes, a sparse matrix (nodes, splines), which tests interpolate.
        interpolation: values at r by those at the nodes, a sparse matrix (points, nodes).
    """

    def __init__(self, splines: Splines, nodal: Any, interpolation: Callable[[NDArray], Any]) -> None:
        self.nodal, self._splines, self._rule = nodal, splines, Rule(splines.knots, 1.0)
        self._f, self._tests = splines.sparse(self._rule.t), interpolation(self._rule.t) @ nodal

    def pressure(self, moments: NDArray, α: NDArray, β: NDArray) -> Expansion:
        """Pressure with given moments.

        Args:
            moments: integrals of σ_YY of each state over N/(2a) times the tests, (states, splines).
            α, β: exponents at X = a and X = -a, (states,).
        """
        from scipy.sparse import diags
        from scipy.sparse.linalg import splu

        c = np.empty_like(moments)
        exponents, which = np.unique(np.column_stack([α, β]), axis=0, return_inverse=True)
        for i, w in enumerate(self._rule.weights(*exponents.T)):
            states, scale = which == i, diags(1.0 / np.sqrt(w @ self._f.power(2)))
            gram = scale @ self._tests.T @ diags(w) @ self._f @ scale
            c[states] = (scale @ splu(gram.tocsc()).solve((moments[states] @ scale).T)).T
        return BentExpansion(α[:, None], β[:, None], c, self._splines)
