"""Flat punch on a uniform half-plane whose friction varies along the contact: closed form.

With g(X) = σ_XY/σ_YY, N̂ = n + g n₁₂ and τ = N̂ σ_YY the integral equation is

    H[τ] - cot(πα) τ = 0,   cot πα(X) = g q/N̂,   -1 < α < 0,

and its solution, with H[τ] = cot(πα) τ below the punch and A e^(E)/(1 + X) beside it,

    τ = A sin(πα) e^(E)/(1 + X),   E(X) = ⨍ α(t)/(t - X) dt.

Next to the ends it goes with α(1) and β = -1 - α(-1). The transform of σ_XY differs from g times that of
σ_YY by the regular integral C = (1/π) ∫ (g(t) - g(X)) σ_YY(t)/(t - X) dt.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from ..friction.along import Along, Piecewise
from ..solids.solid import Response
from .edges import EdgeExponents, from_edge, under_punch
from .pressure import Pressure
from .residual import Rule

#: Distance from an end within which E less its logarithms is that of the end.
_NEXT_TO_END = 1e-13
#: Size of the smallest panel towards a break of friction, in x = log((1 + t)/(1 - t)).
_BESIDE_BREAK = 1e-8


@dataclass(frozen=True)
class FlatAlong(Pressure):
    """Pressure of a flat punch with friction that varies along the contact, at one speed.

    Attributes:
        response: of the half-plane at that speed.
        along: σ_XY/σ_YY over X/a.
    """

    response: Response
    along: Along

    @cached_property
    def _exponent(self) -> Piecewise:
        """α over X/a."""
        return Piecewise(lambda X: EdgeExponents(self.response, self.along(X)).α, self.along.breaks)

    @cached_property
    def α(self) -> float:  # type: ignore[override]
        return float(EdgeExponents(self.response, self.along(np.ones(1))).α[0])

    @cached_property
    def β(self) -> float:  # type: ignore[override]
        return float(EdgeExponents(self.response, self.along(-np.ones(1))).β[0])

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return self._amplitude * self._shape(np.asarray(r, dtype=float))

    def _shape(self, r: NDArray) -> NDArray[np.float64]:
        """Pressure without its weight and amplitude."""
        local = EdgeExponents(self.response, self.along(r))
        return np.asarray(local._sin / self._compliance(r) * np.exp(self._bounded(r)))

    def _compliance(self, r: NDArray) -> NDArray[np.float64]:
        """N̂ = n + g n₁₂ at r."""
        return np.asarray(self.response.n + self.along(r) * self.response.n12)

    def _bounded(self, r: NDArray) -> NDArray[np.float64]:
        """E without its logarithms of the distances from both ends, in the shape of r."""
        r = np.asarray(r, dtype=float)
        inside = np.clip(r, _NEXT_TO_END - 1.0, 1.0 - _NEXT_TO_END)
        at = np.where(np.abs(r) > 1.0 + _NEXT_TO_END, r, inside).ravel()
        E = self._exponent.cauchy(_off(at, self._exponent.ends)).reshape(r.shape)
        at = at.reshape(r.shape)
        return E - self.α * np.log(np.abs(1.0 - at)) - (1.0 + self.β) * np.log(np.abs(1.0 + at))

    @cached_property
    def _rule(self) -> Rule:
        ends, breaks = self._exponent.ends[1:-1], self.along.breaks
        sizes = [1.0] * len(ends) + [_BESIDE_BREAK] * len(breaks)
        return Rule([*ends.tolist(), *breaks], sizes)

    @cached_property
    def _unit_forces(self) -> NDArray[np.float64]:
        """∫ σ_YY dt of each place of the rule for the amplitude 1, (n,)."""
        exponents = np.array([self.α]), np.array([self.β])
        return np.asarray(self._rule.weights(*exponents)[0] * self._shape(self._rule.t))

    @cached_property
    def _amplitude(self) -> float:
        return -2.0 / float(self._unit_forces.sum())

    @property
    def _forces(self) -> NDArray[np.float64]:
        return self._amplitude * self._unit_forces

    @property
    def friction(self) -> float:
        """Resultant of σ_XY over that of σ_YY."""
        return float(self._forces @ self.along(self._rule.t)) / -2.0

    @property
    def centre(self) -> float:
        """Centre of pressure over a."""
        return float(self._forces @ self._rule.t) / -2.0

    def hilbert(self, r: NDArray) -> NDArray[np.float64]:
        """(1/π) ⨍ σ_YY(t)/(t - r) dt on the whole surface; NaN at an end."""
        return self.transforms(None, np.asarray(r, dtype=float))[1][0]

    def transforms(self, g: Any, r: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        ratio, t, apart = self.along(r), self._rule.t, self._rule.t - r[:, None]
        difference = (self.along(t) - ratio[:, None]) / np.where(apart == 0.0, np.inf, apart)
        C = difference @ self._forces / np.pi
        local = EdgeExponents(self.response, ratio)
        with np.errstate(invalid="ignore", divide="ignore"):
            size = np.abs(1.0 - r) ** self.α * np.abs(1.0 + r) ** self.β * np.exp(self._bounded(r))
        τ = self._amplitude * size * np.where(under_punch(r), local._cot * local._sin, np.sign(r))
        τ = np.where(from_edge(r) == 0.0, np.nan, τ)
        return ratio[None], ((τ - self.response.n12 * C) / self._compliance(r))[None], C[None]


def _off(t: NDArray, ends: NDArray) -> NDArray[np.float64]:
    """Positions moved off the ends of panels, where logarithms of two panels cancel."""
    on = ends[np.clip(np.searchsorted(ends, t), 0, len(ends) - 1)] == t
    return np.where(on, t + 1e-15, t)


@dataclass(frozen=True)
class Recovered(Pressure):
    """Pressures with given moments, of several states: each a polynomial times that of the closed form.

    The form of the pressure between the ends is that of the surface's local analysis, as are exponents
    elsewhere; its polynomial is a constant where moments are those of the closed form.

    Attributes:
        forms: pressures of the states in closed form.
        c: Chebyshev coefficients, (states, moments).
    """

    forms: tuple[FlatAlong, ...]
    c: NDArray[np.float64]

    @classmethod
    def of(cls, response: Response, along: Sequence[Along], moments: NDArray) -> "Recovered":
        """Pressures at one speed with moments ∫ σ_YY T_k dr over N/(2a), (states, moments)."""
        forms, c = tuple(FlatAlong(response, each) for each in along), np.empty_like(moments)
        for i, form in enumerate(forms):
            T = chebvander(form._rule.t, moments.shape[1] - 1)
            c[i] = np.linalg.solve((form._forces[:, None] * T).T @ T, moments[i])
        return cls(forms, c)

    @property
    def α(self) -> NDArray[np.float64]:  # type: ignore[override]
        return np.array([[form.α] for form in self.forms])

    @property
    def β(self) -> NDArray[np.float64]:  # type: ignore[override]
        return np.array([[form.β] for form in self.forms])

    def series(self, r: NDArray) -> NDArray[np.float64]:
        polynomials = np.tensordot(
            self.c, chebvander(np.clip(r, -1.0, 1.0), self.c.shape[1] - 1), (-1, -1)
        )
        return polynomials * np.array([form.series(r) for form in self.forms])

    @property
    def unresolved(self) -> NDArray[np.float64]:
        """Relative error measured on the last of the functions, 0, (states,)."""
        return np.zeros(len(self.c))

    def moved_edges(self, r: NDArray, length: float) -> NDArray[np.float64]:
        """Change of the smooth factor where both edges are misplaced, 0: no edge of the mesh is."""
        return np.zeros((len(self.c), len(r)))
